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
} // namespace coplane
