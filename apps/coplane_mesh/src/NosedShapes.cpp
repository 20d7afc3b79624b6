#include "Ogive.hpp"
#include "ShapeModel.hpp"

#include <algorithm>
#include <cmath>

namespace coplane
{
using namespace schema;

namespace
{
struct ProjectileParameters
{
  int dimension = 0;
  Real width = 0, length = 0; ///< [m]
  int across = 0;
  int along = 0; ///< 0: elements about as long as wide
  std::string section = "round";
};

struct OgiveParameters
{
  int dimension = 0;
  Real width = 0, length = 0; ///< [m]
  Real caliber = 0;           ///< [-]
  int across = 0;
  int nose = 0, along = 0; ///< 0: elements about twice as long as wide
};

void checkProjectile(const ProjectileParameters& p, const CardPlace& place)
{
  if (!(p.length > p.width / 2))
    place.problem("length", fmt::format("= {} m must be greater than the nose, which is half the "
                                        "width = {} m.",
                                        p.length, p.width / 2));
  demandEven(place, "across", p.across, "elements");
}

/// More lie on the axis of the nose.
int leastInNose(const OgiveParameters& p)
{
  return p.across / 4 + 1;
}

void checkOgive(const OgiveParameters& p, const CardPlace& place)
{
  if (const Real nose = ogiveLength(p.width, p.caliber); !(p.length > nose))
    place.problem("length", fmt::format("= {} m must be greater than the nose, which is {} m long.",
                                        p.length, nose));
  demandEven(place, "across", p.across, "elements");
  if (place.gives("nose") && p.nose < leastInNose(p))
    place.problem("nose", fmt::format("= {} must be at least {}, more than across / 4.", p.nose,
                                      leastInNose(p)));
}

std::vector<Body> makeLaw(const ProjectileParameters& p)
{
  const int along =
      p.along > 0
          ? p.along
          : std::max(1, countable(std::round((p.length - p.width / 2) / (p.width / p.across))));
  if (p.dimension == 2)
    return {roundNosed(p.width, p.length, p.across, along)};
  if (p.section == "round")
    return {roundBar(p.width, p.length, p.across, along)};
  std::vector<Real> depth;
  for (int k = 0; k <= p.across; ++k)
    depth.push_back(p.width * (2 * k - p.across) / (2 * p.across));
  return {extruded(roundNosed(p.width, p.length, p.across, along), depth)};
}

std::vector<Body> makeLaw(const OgiveParameters& p)
{
  const Real nose = ogiveLength(p.width, p.caliber);
  const auto divisions = [&](int given, Real part, int lowest)
  {
    return given > 0 ? given
                     : std::max(lowest, countable(std::round(part / (2 * p.width / p.across))));
  };
  return {ogiveNosed(p.dimension, p.width, p.caliber, p.length, p.across,
                     divisions(p.nose, nose, leastInNose(p)),
                     divisions(p.along, p.length - nose, 1))};
}
} // namespace

ShapeModel projectileModel()
{
  using P = ProjectileParameters;
  return ShapeModelOf<P>("projectile",
                         "axis x, tip of the round nose at the origin, body towards -x")
      .has({
          length("width", &P::width).like("0.0125").means("twice the radius of the nose"),
          length("length", &P::length).like("0.05").means("with the nose"),
          across<P>(),
          integer("along", &P::along)
              .in("elements")
              .atLeast(1)
              .defaultIs("about as long as wide")
              .like("20")
              .means("elements on the straight part"),
          text("section", &P::section)
              .oneOf({"round", "square"})
              .onlyInDimension(3)
              .like("square")
              .means("round with half a ball, or square with half a cylinder across z as nose"),
      })
      .demands(checkProjectile);
}

ShapeModel ogiveModel()
{
  using P = OgiveParameters;
  return ShapeModelOf<P>("ogive",
                         "axis y, tip at the origin, body towards +y; 2D: half section x >= 0 of "
                         "a body of revolution, 3D: quarter x >= 0, z >= 0")
      .has({
          length("width", &P::width).like("0.0254").means("diameter of the shank"),
          length("length", &P::length).like("0.1437").means("with the nose"),
          number("caliber", &P::caliber)
              .needed()
              .in("-")
              .atLeast(0.5)
              .like("3")
              .means("radius of the nose's outline over the width (CRH); 0.5 is half a ball"),
          across<P>(),
          integer("nose", &P::nose)
              .in("elements")
              .atLeast(1)
              .defaultIs("about twice as long as wide")
              .like("6")
              .means("elements on the axis of the nose; more than across / 4"),
          integer("along", &P::along)
              .in("elements")
              .atLeast(1)
              .defaultIs("about twice as long as wide")
              .like("9")
              .means("elements on the shank"),
      })
      .demands(checkOgive);
}
} // namespace coplane
