#include <coplane_core/PlaceText.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace coplane
{
std::string coordinateText(Real x, Real resolution)
{
  int digits = 4;
  if (x != 0 && std::isfinite(x))
  {
    const int first = int(std::floor(std::log10(std::abs(x))));
    digits = std::max(digits, first + 1); // no powers of ten for whole metres
    if (resolution > 0)
      digits = std::max(digits, first - int(std::floor(std::log10(resolution))) + 1);
  }
  return fmt::format("{:.{}g}", x, std::min(digits, 16));
}

std::string placeText(const Vec3& x, Real resolution)
{
  return fmt::format("({}, {}, {})", coordinateText(x.x, resolution),
                     coordinateText(x.y, resolution), coordinateText(x.z, resolution));
}
} // namespace coplane
