#pragma once

#include <coplane_core/Rotate.hpp>

namespace coplane
{
// Small results that stay in memory are written component by component: a copy of the whole has to
// wait for the components in flight.

template <class T>
KOKKOS_FORCEINLINE_FUNCTION void assign(const SymTensorOf<T>& from, SymTensorOf<T>& to)
{
  to.xx = from.xx;
  to.yy = from.yy;
  to.zz = from.zz;
  to.xy = from.xy;
  to.yz = from.yz;
  to.zx = from.zx;
}

/// D dt of a displacement gradient.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION void findSymmetricPart(const Mat3Of<T>& l, SymTensorOf<T>& d)
{
  const T half(0.5);
  d.xx = l(0, 0);
  d.yy = l(1, 1);
  d.zz = l(2, 2);
  d.xy = half * (l(0, 1) + l(1, 0));
  d.yz = half * (l(1, 2) + l(2, 1));
  d.zx = half * (l(2, 0) + l(0, 2));
}

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

/// The same from the displacement gradient of the step.
template <class T>
KOKKOS_INLINE_FUNCTION Mat3Of<T> hughesWinget(const Mat3Of<T>& l)
{
  const T quarter(0.25);
  return hughesWinget(Vec3Of<T>{quarter * (l(2, 1) - l(1, 2)), quarter * (l(0, 2) - l(2, 0)),
                                quarter * (l(1, 0) - l(0, 1))});
}

/// The same about z.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION void hughesWingetInPlane(const Mat3Of<T>& l, Mat3Of<T>& r)
{
  const T a = T(0.25) * (l(1, 0) - l(0, 1));
  const T f = T(2.0) / (T(1.0) + a * a);
  const T cosine = T(1.0) - f * a * a, sine = f * a, zero(0.0);
  r = {{{cosine, -sine, zero}, {sine, cosine, zero}, {zero, zero, T(1.0)}}};
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
