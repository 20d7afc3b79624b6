#include "ShapeModel.hpp"

#include <cmath>

namespace coplane
{
using namespace schema;

namespace
{
struct CrossVaultParameters
{
  int dimension = 0;
  Real innerRadius = 0, outerRadius = 0; ///< [m]
  Real from = 0;                         ///< [degrees]
  Real length = 0;                       ///< of a side of the bay [m]
  int count = 0, rows = 0;
  std::vector<int> divisions;
};

/// Where the outer ends of the lowest courses meet the groins: half of the least bay [m].
Real leastHalf(const CrossVaultParameters& p)
{
  return p.outerRadius * std::cos(p.from * pi / 180);
}

void checkCrossVault(const CrossVaultParameters& p, const CardPlace& place)
{
  if (!(p.outerRadius > p.innerRadius))
    place.problem("outer_radius", fmt::format("= {} m must be greater than inner_radius = {} m.",
                                              p.outerRadius, p.innerRadius));
  else if (!(p.length / 2 > leastHalf(p)))
    place.problem("length",
                  fmt::format("= {} m must be more than 2 outer_radius cos(from) = {:.6g} m, where "
                              "the groins reach the lowest courses.",
                              p.length, 2 * leastHalf(p)));
  if (p.count % 2 == 0)
    place.problem("count", fmt::format("= {}: an arch needs an odd count, so that a stone lies on "
                                       "its crown.",
                                       p.count));
  demandEven(place, "divisions", p.divisions[1],
             "elements around a stone, so that nodes lie on the crown");
}

std::vector<Body> makeLaw(const CrossVaultParameters& p)
{
  return crossVault(p.innerRadius, p.outerRadius, p.from, p.count, p.length, p.rows,
                    toCounts(p.divisions));
}
} // namespace

std::vector<Body> crossVault(Real inner, Real outer, Real from, int count, Real length, int rows,
                             const std::array<int, 3>& n)
{
  demandCountable(4.0 * count * (rows + 1.0) * nodesOfGrid(3, n));
  std::vector<Body> bodies;
  const std::vector<Real> radii = gradedLine(inner, outer, n[0], 1);
  const int around = count * n[1];
  const Real half = length / 2, stone = half / rows;
  // Measured from the crown: both halves of an arch are the same to the bit.
  const auto angle = [&](int step)
  { return (90 - from) * (around - 2 * step) / around * pi / 180; };
  const auto groin = [&](int i, int step) { return std::abs(radii[i] * std::sin(angle(step))); };
  for (int arm = 0; arm < 4; ++arm)
    for (int course = 0; course < count; ++course)
    {
      Real farthest = 0; // of the groin, in this course
      for (const int step : {course * n[1], (course + 1) * n[1]})
        farthest = std::max(farthest, groin(n[0], step));
      // Joints across the course, from the wall arch inwards; the stone at the groin is no shorter
      // than half of another one at its short side, unless it is the only one.
      std::vector<Real> ends{half};
      for (Real z = half - (course % 2 == 1 ? 0.5 : 1.0) * stone; z - farthest >= 0.5 * stone;
           z -= stone)
        ends.insert(ends.begin(), z);
      for (std::size_t k = 0; k < ends.size(); ++k)
      {
        const Real middle = groin(n[0] / 2, (course * n[1]) + n[1] / 2);
        const Real size = ends[k] - (k == 0 ? middle : ends[k - 1]);
        const int along = std::max(1, int(std::lround(n[2] * size / stone)));
        bodies.push_back(mappedGrid(
            3, {n[0], n[1], along},
            [&](int i, int j, int l)
            {
              const int step = course * n[1] + j;
              const Real start = k == 0 ? groin(i, step) : ends[k - 1];
              const Real x = radii[i] * std::sin(angle(step)), y = radii[i] * std::cos(angle(step));
              // Exact at both ends.
              const Real z = l == 0       ? start
                             : l == along ? ends[k]
                                          : (start * (along - l) + ends[k] * l) / along;
              switch (arm) // turned about the vertical, by quarters
              {
              case 0:
                return Vec3{x, y, z};
              case 1:
                return Vec3{z, y, -x};
              case 2:
                return Vec3{-x, y, -z};
              default:
                return Vec3{-z, y, x};
              }
            }));
      }
    }
  return bodies;
}

ShapeModel crossVaultModel()
{
  using P = CrossVaultParameters;
  return ShapeModelOf<P>("cross_vault",
                         "two equal barrel vaults that cross at right angles over a square bay "
                         "about the origin, axis y; they meet in groins, mitred")
      .existsIn(3, "sector")
      .has({
          length<P>("inner_radius", &P::innerRadius).like("2").means("of the barrels"),
          length<P>("outer_radius", &P::outerRadius).like("2.3").means("of the barrels"),
          number("from", &P::from)
              .needed()
              .in("degrees")
              .atLeast(0)
              .atMost(80)
              .like("20")
              .means("elevation of the springings above y = 0, seen from the axes of the barrels"),
          count("count", &P::count)
              .in("courses")
              .like("15")
              .means("courses from springing to springing of each arch; odd: one lies on the "
                     "crown"),
          length<P>("length", &P::length)
              .like("4.6")
              .means("side of the bay; more than 2 outer_radius cos(from)"),
          count("rows", &P::rows)
              .in("stones")
              .like("4")
              .means("stones along half of the bay at the crown; every other course is shifted by "
                     "half a stone"),
          divisions<P>("of one stone: radial, around (even), along"),
      })
      .demands(checkCrossVault);
}
} // namespace coplane
