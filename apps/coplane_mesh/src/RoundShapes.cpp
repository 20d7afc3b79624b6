#include "ShapeModel.hpp"

namespace coplane
{
using namespace schema;

namespace
{
/// How far a section goes along z in three dimensions.
struct Sweep
{
  Real length = 0; ///< [m]
  int along = 0;
};

struct CylinderParameters : Sweep
{
  int dimension = 0;
  Real radius = 0; ///< [m]
  int across = 0;
};

struct SphereParameters
{
  int dimension = 0;
  Real radius = 0; ///< [m]
  int across = 0;
};

struct SectorParameters
{
  int dimension = 0;
  Real innerRadius = 0, outerRadius = 0; ///< [m]
  Real from = 0, to = 0;                 ///< [degrees]
  int count = 1;
  std::vector<int> divisions;
  Real bias = 1;
  Real length = 0; ///< [m]
  int rows = 1;
};

struct DomeParameters
{
  int dimension = 0;
  Real innerRadius = 0, outerRadius = 0; ///< [m]
  Real from = 0, to = 0;                 ///< [degrees]
  int courses = 0, count = 0;
  std::vector<int> divisions;
};

struct HalfDiscParameters : Sweep
{
  int dimension = 0;
  Real radius = 0, fine = 0, fineRadius = 0; ///< [m]
};

template <class P>
Key sweepLength()
{
  return length<P>("length", &P::length)
      .onlyInDimension(3)
      .like("0.5")
      .means("along z, from z = 0");
}

template <class P>
Key sweepAlong()
{
  return count<P>("along", &P::along)
      .onlyInDimension(3)
      .in("elements")
      .like("5")
      .means("elements along z");
}

/// A plane body as it is in two dimensions, swept from z = 0 in three.
std::vector<Body> planeOrSwept(const Body& section, int dimension, const Sweep& sweep)
{
  if (dimension == 2)
    return {section};
  demandCountable(Real(section.points.size()) * (Real(sweep.along) + 1));
  std::vector<Real> heights;
  for (int k = 0; k <= sweep.along; ++k)
    heights.push_back(sweep.length * k / sweep.along);
  return {extruded(section, heights)};
}

template <class P>
void demandEvenAcross(const P& p, const CardPlace& place)
{
  demandEven(place, "across", p.across, "elements");
}

template <class P>
void demandThick(const P& p, const CardPlace& place)
{
  if (!(p.outerRadius > p.innerRadius))
    place.problem("outer_radius", fmt::format("= {} m must be greater than inner_radius = {} m.",
                                              p.outerRadius, p.innerRadius));
}

void checkDome(const DomeParameters& p, const CardPlace& place)
{
  demandThick(p, place);
  if (!(p.to > p.from))
    place.problem(
        "to", fmt::format("= {} degrees must be greater than from = {} degrees.", p.to, p.from));
  demandEven(place, "divisions", p.divisions[2],
             "elements around a stone, so that nodes of courses meet");
  if (const Real element = 360.0 / (p.count * p.divisions[2]); !(element <= 90))
    place.problem("divisions",
                  fmt::format("make elements of {} degrees around; 90 is the most.", element));
}

void checkSector(const SectorParameters& p, const CardPlace& place)
{
  demandThick(p, place);
  if (p.rows > 1)
    demandEven(place, "divisions", p.divisions[2],
               "elements along a stone, and half a stone takes half of them");
  const Real angle = p.to - p.from;
  if (!(angle > 0) || angle > 360)
    return place.problem("to", fmt::format("= {} degrees must be greater than from = {} degrees, "
                                           "by 360 at most.",
                                           p.to, p.from));
  if (const Real element = angle / (p.count * p.divisions[1]); !(element <= 90))
    place.problem(
        "divisions",
        fmt::format("make elements of {} degrees; 90 is the most. Take more around.", element));
}

void checkHalfDisc(const HalfDiscParameters& p, const CardPlace& place)
{
  if (!(p.fineRadius <= p.radius / 4))
    place.problem("fine_radius", fmt::format("= {} m must not exceed a quarter of the radius = {} "
                                             "m.",
                                             p.fineRadius, p.radius / 4));
  if (!(p.fine <= p.fineRadius))
    place.problem("fine",
                  fmt::format("= {} m must not exceed fine_radius = {} m.", p.fine, p.fineRadius));
}

std::vector<Body> makeLaw(const CylinderParameters& p)
{
  return planeOrSwept(disk(p.radius, p.across), p.dimension, p);
}

std::vector<Body> makeLaw(const SphereParameters& p)
{
  return {ball(p.radius, p.across)};
}

std::vector<Body> makeLaw(const SectorParameters& p)
{
  if (p.rows > 1)
    return barrelVault(p.innerRadius, p.outerRadius, p.from, p.to, p.count, p.length, p.rows,
                       toCounts(p.divisions), p.bias);
  return sectors(p.dimension, p.innerRadius, p.outerRadius, p.from, p.to, p.count, p.length,
                 toCounts(p.divisions), p.bias);
}

std::vector<Body> makeLaw(const DomeParameters& p)
{
  return dome(p.innerRadius, p.outerRadius, p.from, p.to, p.courses, p.count,
              toCounts(p.divisions));
}

std::vector<Body> makeLaw(const HalfDiscParameters& p)
{
  return planeOrSwept(halfDisc(p.radius, p.fine, p.fineRadius), p.dimension, p);
}
} // namespace

ShapeModel cylinderModel()
{
  using P = CylinderParameters;
  return ShapeModelOf<P>("cylinder",
                         "2D disk, 3D cylinder along z from z = 0; centred on the origin")
      .has({
          length<P>("radius", &P::radius).like("0.5").means("of the circle"),
          across<P>(),
          sweepLength<P>(),
          sweepAlong<P>(),
      })
      .demands(demandEvenAcross<P>);
}

ShapeModel sphereModel()
{
  using P = SphereParameters;
  return ShapeModelOf<P>("sphere", "a ball, centred on the origin")
      .has({
          length<P>("radius", &P::radius).like("0.15").means("of the sphere"),
          across<P>(),
      })
      .existsIn(3, "cylinder")
      .demands(demandEvenAcross<P>);
}

ShapeModel sectorModel()
{
  using P = SectorParameters;
  return ShapeModelOf<P>("sector",
                         "ring sectors about the origin (arch stones), in 3D swept from z = 0")
      .has({
          length("inner_radius", &P::innerRadius).like("9.4").means("of the ring"),
          length("outer_radius", &P::outerRadius).like("10.6").means("of the ring"),
          number("from", &P::from)
              .needed()
              .in("degrees")
              .like("0")
              .means("first angle, from x towards y"),
          number("to", &P::to)
              .needed()
              .in("degrees")
              .like("180")
              .means("last angle; at most 360 more"),
          integer("count", &P::count)
              .in("bodies")
              .atLeast(1)
              .like("27")
              .means("bodies of equal angle; they touch and do not share nodes"),
          divisions<P>("of one body: radial, around, along z"),
          number("bias", &P::bias)
              .in("-")
              .above(0)
              .like("2")
              .means("outermost over innermost radial length, those between in geometric "
                     "progression"),
          sweepLength<P>(),
          integer("rows", &P::rows)
              .onlyInDimension(3)
              .in("stones")
              .atLeast(1)
              .like("6")
              .means("a barrel vault: so many stones along z in each sector, in running bond; "
                     "divisions are then those of a stone, even along z"),
      })
      .demands(checkSector);
}

ShapeModel domeModel()
{
  using P = DomeParameters;
  return ShapeModelOf<P>("dome",
                         "part of a spherical shell about the origin, axis y, in courses of equal "
                         "stones; every other course is turned by half a stone")
      .existsIn(3, "sector")
      .has({
          length("inner_radius", &P::innerRadius).like("4").means("of the shell"),
          length("outer_radius", &P::outerRadius).like("4.4").means("of the shell"),
          number("from", &P::from)
              .needed()
              .in("degrees")
              .atLeast(-80)
              .atMost(80)
              .like("0")
              .means("elevation of the lowest course above y = 0"),
          number("to", &P::to)
              .needed()
              .in("degrees")
              .atLeast(-80)
              .atMost(85)
              .like("75")
              .means("elevation of the ring that closes it, an open eye"),
          count("courses", &P::courses).in("courses").like("12").means("from one to the other"),
          count("count", &P::count).in("stones").like("24").means("stones in each course"),
          divisions<P>("of one stone: radial, along the meridian, around"),
      })
      .demands(checkDome);
}

ShapeModel halfDiscModel()
{
  using P = HalfDiscParameters;
  return ShapeModelOf<P>("half_disc",
                         "lower half of a disc of centre (0, radius): lowest point at the origin, "
                         "fine there; in 3D swept from z = 0")
      .has({
          length("radius", &P::radius).like("0.1").means("of the circle"),
          length("fine", &P::fine).like("2e-4").means("of elements at the lowest point"),
          length("fine_radius", &P::fineRadius)
              .like("5e-3")
              .means("so far reach such elements (at most radius / 4); beyond, they grow with the "
                     "distance"),
          sweepLength<P>(),
          sweepAlong<P>(),
      })
      .demands(checkHalfDisc);
}
} // namespace coplane
