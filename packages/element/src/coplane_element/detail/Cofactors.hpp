#pragma once

#include <coplane_core/Vec3.hpp>

namespace coplane
{
/// (A^-1)^T from cofactors. Returns the determinant of A.
template <int dim, class T>
KOKKOS_INLINE_FUNCTION T inverseTransposed(const T (&a)[dim][dim], T (&c)[dim][dim])
{
  if constexpr (dim == 2)
  {
    const T det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    const T scale = T(1.0) / det;
    c[0][0] = scale * a[1][1];
    c[0][1] = -scale * a[1][0];
    c[1][0] = -scale * a[0][1];
    c[1][1] = scale * a[0][0];
    return det;
  }
  else
  {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        c[i][j] = a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
      }
    const T det = a[0][0] * c[0][0] + a[0][1] * c[0][1] + a[0][2] * c[0][2];
    const T scale = T(1.0) / det;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        c[i][j] *= scale;
    return det;
  }
}
} // namespace coplane
