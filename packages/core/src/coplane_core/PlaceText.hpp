#pragma once

#include <coplane_core/Vec3.hpp>

#include <string>

namespace coplane
{
/// A coordinate with so many digits that the resolution shows, four at least: near the origin
/// "7.625", at the offsets of maps "512340.375". @param resolution [m]
std::string coordinateText(Real x, Real resolution);

/// "(x, y, z)" of such coordinates.
std::string placeText(const Vec3& x, Real resolution);
} // namespace coplane
