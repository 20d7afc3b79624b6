#pragma once

#include <coplane_core/BranchFree.hpp>
#include <coplane_core/Vec3.hpp>

namespace coplane
{
/// Two unit vectors in a plane; with its normal they make a right-handed system e1, e2, normal. In
/// two dimensions e2 is along z and left at zero. T is Real, or Lanes for several planes side by
/// side.
template <class T>
struct PlaneAxesOf
{
  Vec3Of<T> e1{}, e2{};
};
using PlaneAxes = PlaneAxesOf<Real>;

/// In three dimensions e1 is the axis with the smallest component of the normal, less that
/// component, so that it never is short.
/// @param n unit normal
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION PlaneAxesOf<T> planeAxes(const Vec3Of<T>& n)
{
  using namespace branchFree;
  PlaneAxesOf<T> axes;
  if constexpr (Dim == 2)
    axes.e1 = {-n.y, n.x, T(0.0)};
  else
  {
    const Vec3Of<T> size{absolute(n.x), absolute(n.y), absolute(n.z)};
    const auto isX = size.x <= size.y && size.x <= size.z;
    const auto isZ = !isX && size.z < size.y;
    const T none(0.0), one(1.0);
    const Vec3Of<T> axis{choose(isX, one, none), choose(isX || isZ, none, one),
                         choose(isZ, one, none)};
    const T along = choose(isX, n.x, choose(isZ, n.z, n.y));
    axes.e1 = normalised(axis - along * n);
    axes.e2 = cross(n, axes.e1);
  }
  return axes;
}

/// The same where the dimension is known only when the program runs.
inline PlaneAxes planeAxes(const Vec3& n, int dimension)
{
  return dimension == 2 ? planeAxes<2>(n) : planeAxes<3>(n);
}
} // namespace coplane
