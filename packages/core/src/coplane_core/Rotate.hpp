#pragma once

#include <coplane_core/Vec3.hpp>

namespace coplane
{
/// R s R^T.
template <class T>
KOKKOS_INLINE_FUNCTION SymTensorOf<T> rotated(const SymTensorOf<T>& s, const Mat3Of<T>& r)
{
  const T full[3][3] = {{s.xx, s.xy, s.zx}, {s.xy, s.yy, s.yz}, {s.zx, s.yz, s.zz}};
  T half[3][3]; // R s
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      half[i][j] = r.a[i][0] * full[0][j] + r.a[i][1] * full[1][j] + r.a[i][2] * full[2][j];
  const auto entry = [&](int i, int j)
  { return half[i][0] * r.a[j][0] + half[i][1] * r.a[j][1] + half[i][2] * r.a[j][2]; };
  return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(2, 0)};
}

/// A strain increment turned from the middle of the step, where it is found, to its end, by half of
/// the rotation of the step, up to the square of its angle. With it the rule is the same forwards
/// and backwards: without, bodies that vibrate in shear gain energy in every cycle.
template <class T>
KOKKOS_INLINE_FUNCTION SymTensorOf<T> turnedToEnd(const SymTensorOf<T>& de, const Mat3Of<T>& dR)
{
  const T quarter(0.25), two(2.0); // w = (dR - dR^T) / 4; de + w de - de w
  const T wxy = quarter * (dR(0, 1) - dR(1, 0)), wyz = quarter * (dR(1, 2) - dR(2, 1)),
          wzx = quarter * (dR(2, 0) - dR(0, 2));
  return {de.xx + two * (wxy * de.xy - wzx * de.zx),
          de.yy + two * (wyz * de.yz - wxy * de.xy),
          de.zz + two * (wzx * de.zx - wyz * de.yz),
          de.xy + wxy * (de.yy - de.xx) - wzx * de.yz + wyz * de.zx,
          de.yz + wyz * (de.zz - de.yy) - wxy * de.zx + wzx * de.xy,
          de.zx + wzx * (de.xx - de.zz) - wyz * de.xy + wxy * de.yz};
}
} // namespace coplane
