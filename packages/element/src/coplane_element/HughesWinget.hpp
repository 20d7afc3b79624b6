#pragma once

#include <coplane_core/Rotate.hpp>

namespace coplane
{
/// Rotation over a step, dR = (I - dt W/2)^-1 (I + dt W/2) (Hughes and Winget 1980), from a = dt/2
/// times the spin vector (half the curl of the velocity). Orthogonal to round-off for any a; the
/// identity, exactly, for a = 0.
template <class T>
KOKKOS_INLINE_FUNCTION Mat3Of<T> hughesWinget(const Vec3Of<T>& a)
{
  // With the cross product matrix [a]: dR = I + f ([a] + [a][a]), f = 2 / (1 + a.a).
  const T aa = dot(a, a);
  const T f = T(2.0) / (T(1.0) + aa);
  const T diagonal = T(1.0) - f * aa;
  const T fx = f * a.x, fy = f * a.y, fz = f * a.z;
  Mat3Of<T> r;
  r.a[0][0] = diagonal + fx * a.x;
  r.a[1][1] = diagonal + fy * a.y;
  r.a[2][2] = diagonal + fz * a.z;
  r.a[0][1] = fx * a.y - fz;
  r.a[1][0] = fx * a.y + fz;
  r.a[1][2] = fy * a.z - fx;
  r.a[2][1] = fy * a.z + fx;
  r.a[2][0] = fz * a.x - fy;
  r.a[0][2] = fz * a.x + fy;
  return r;
}

/// turnedToEnd() for a rotation about z.
template <class T>
KOKKOS_INLINE_FUNCTION SymTensorOf<T> turnedToEndInPlane(const SymTensorOf<T>& de, const T& sine)
{
  const T across = sine * de.xy;
  return {de.xx - across, de.yy + across, de.zz, de.xy + T(0.5) * sine * (de.xx - de.yy),
          de.yz,          de.zx};
}

/// rotated() for a rotation about z of a tensor without yz and zx.
template <class T>
KOKKOS_INLINE_FUNCTION SymTensorOf<T> rotatedInPlane(const SymTensorOf<T>& s, const T& cosine,
                                                     const T& sine)
{
  const T hxx = cosine * s.xx - sine * s.xy, hxy = cosine * s.xy - sine * s.yy;
  const T hyx = sine * s.xx + cosine * s.xy, hyy = sine * s.xy + cosine * s.yy;
  return {cosine * hxx - sine * hxy,
          sine * hyx + cosine * hyy,
          s.zz,
          cosine * hyx - sine * hyy,
          s.yz,
          s.zx};
}
} // namespace coplane
