#pragma once

#include <coplane_core/Vec3.hpp>

namespace coplane
{
/// The inverse; in two dimensions of the part that turns.
Mat3 inverseInertia(const Mat3& inertia, int dimension);
} // namespace coplane
