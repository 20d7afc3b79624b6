#pragma once

#include <coplane_core/Vec3.hpp>

namespace coplane
{
/// Moments of inertia from sum m r r^T: xx yy zz xy yz zx [kg m^2].
Mat3 inertiaFromMoments(const Real* moments);

/// The inverse; in two dimensions of the part that turns.
Mat3 inverseInertia(const Mat3& inertia, int dimension);
} // namespace coplane
