#include "PlanePolygon.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace coplane
{
namespace
{
/// Whether two sides cross. @param normal of any length
bool crossesItself(const std::vector<Vec3>& corners, const Vec3& normal)
{
  const std::size_t count = corners.size();
  const auto side = [&](const Vec3& a, const Vec3& b, const Vec3& c)
  { return dot(cross(b - a, c - a), normal); };
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i + 2; j < count; ++j)
    {
      if ((j + 1) % count == i)
        continue;
      const Vec3 &a = corners[i], &b = corners[i + 1], &c = corners[j],
                 &d = corners[(j + 1) % count];
      if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0)
        return true;
    }
  return false;
}
} // namespace

std::string problemOfPolygon(const std::vector<Vec3>& corners)
{
  const std::size_t count = corners.size();
  Vec3 twiceArea{};
  Real longest = 0;
  for (std::size_t k = 0; k < count; ++k)
  {
    const Vec3 &a = corners[k], &b = corners[(k + 1) % count];
    if (norm(b - a) == 0)
      return fmt::format("has the corner {} twice running; each stands once, also the first, which "
                         "is not repeated at the end.",
                         k + 1);
    longest = std::max(longest, norm(b - a));
    twiceArea = twiceArea + cross(a - corners[0], b - corners[0]);
  }
  // The halves of a figure of eight cancel.
  if (!(norm(twiceArea) > 1e-9 * longest * longest))
    return "has no area: its corners lie on a line, or it crosses itself.";
  return crossesItself(corners, twiceArea) ? "crosses itself." : "";
}
} // namespace coplane
