#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>

#include <cmath>

namespace coplane
{
/// What the kernel needs of a face: nodes at the end of the step and velocities in the middle of
/// it.
struct FaceNodes
{
  int count = 0;
  Vec3 x[4];                   ///< x(n+1) [m]
  Vec3 v[4];                   ///< v(n+1/2) [m/s]
  Real mass[4] = {1, 1, 1, 1}; ///< [kg]; used by contact damping only
};

/// Corners of a face relative to their mean, and the tensor sum |r|^2 I - r (x) r that turns a spin
/// into a moment; in two dimensions only its zz entry is used.
template <int Dim>
struct FaceInertia
{
  Vec3 r[4];
  Real xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, zx = 0;
  int count = 0;

  KOKKOS_INLINE_FUNCTION FaceInertia(const Vec3* x, int n) : count(n)
  {
    Vec3 mean{};
    for (int i = 0; i < n; ++i)
      mean += x[i];
    mean = (1.0 / n) * mean;
    for (int i = 0; i < n; ++i)
    {
      r[i] = x[i] - mean;
      const Vec3& q = r[i];
      zz += q.x * q.x + q.y * q.y;
      if constexpr (Dim == 3)
      {
        xx += q.y * q.y + q.z * q.z;
        yy += q.z * q.z + q.x * q.x;
        xy -= q.x * q.y;
        yz -= q.y * q.z;
        zx -= q.z * q.x;
      }
    }
  }

  /// inertia^-1 * moment; nothing for a face 3000 times longer than wide: the forces of a couple
  /// about its axis grow without bound, and round-off with them.
  KOKKOS_INLINE_FUNCTION Vec3 solve(const Vec3& m) const
  {
    if constexpr (Dim == 2)
      return {0, 0, m.z / zz};
    else
    {
      const Real cxx = yy * zz - yz * yz, cyy = zz * xx - zx * zx, czz = xx * yy - xy * xy;
      const Real cxy = yz * zx - xy * zz, cyz = zx * xy - yz * xx, czx = xy * yz - zx * yy;
      const Real determinant = xx * cxx + xy * cxy + zx * czx;
      const Real trace = xx + yy + zz;
      if (!(determinant > 1e-8 * trace * trace * trace))
        return {};
      const Real s = 1 / determinant;
      return {s * (cxx * m.x + cxy * m.y + czx * m.z), s * (cxy * m.x + cyy * m.y + cyz * m.z),
              s * (czx * m.x + cyz * m.y + czz * m.z)};
    }
  }

  KOKKOS_INLINE_FUNCTION Vec3 momentOf(const Vec3* v) const
  {
    Vec3 moment{};
    for (int i = 0; i < count; ++i)
      moment += cross(r[i], v[i]);
    return moment;
  }
};

/// Step A's result: all that the pairs of a face have in common in a cycle.
struct HalfStepFace
{
  int count = 0;
  Vec3 x[4]; ///< x(n+1/2) [m]
  Vec3 v[4]; ///< v(n+1/2) [m/s]
  Vec3 center{};
  Vec3 normal{}; ///< outward unit normal; zero for a degenerate face
  Real area = 0; ///< [m^2]
  Vec3 spin{};   ///< of the rigid motion nearest to the corner velocities [1/s]
  /// The same by the corners at x(n) and at x(n+1), on which the forces of the old and the new time
  /// act: what a couple works on.
  Vec3 spinAtStart{}, spinAtEnd{};
  Real inverseMass[4] = {0, 0, 0, 0}; ///< [1/kg]; used by contact damping only
};

/// Vector area of a face: exact for the bilinear patch of a warped quadrilateral.
template <int Dim>
KOKKOS_INLINE_FUNCTION Vec3 vectorArea(const Vec3* x, int count)
{
  if constexpr (Dim == 2)
    return {x[1].y - x[0].y, x[0].x - x[1].x, 0};
  else
    return count == 3 ? 0.5 * cross(x[1] - x[0], x[2] - x[0])
                      : 0.5 * cross(x[2] - x[0], x[3] - x[1]);
}

/// Step A: the face half a step ahead of the last known positions, x(n+1/2) = x(n+1) - dt/2
/// v(n+1/2).
template <int Dim>
KOKKOS_INLINE_FUNCTION HalfStepFace stepA_halfStepFace(const FaceNodes& nodes, Real dt)
{
  HalfStepFace face;
  face.count = nodes.count;
  for (int i = 0; i < nodes.count; ++i)
  {
    face.x[i] = nodes.x[i] - (0.5 * dt) * nodes.v[i];
    face.v[i] = nodes.v[i];
    face.center += face.x[i];
    face.inverseMass[i] = 1 / nodes.mass[i];
  }
  face.center = (1.0 / nodes.count) * face.center;
  const Vec3 area = vectorArea<Dim>(face.x, face.count);
  face.area = norm(area);
  Real longest = 0;
  for (int i = 0; i < face.count; ++i)
  {
    const Vec3 edge = face.x[i + 1 == face.count ? 0 : i + 1] - face.x[i];
    longest = dot(edge, edge) > longest ? dot(edge, edge) : longest;
  }
  const bool degenerate = Dim == 2 ? !(face.area > 0) : !(face.area > 1e-12 * longest);
  if (degenerate)
    return face;
  face.normal = (1 / face.area) * area;

  const FaceInertia<Dim> inertia(face.x, face.count);
  const Vec3 moment = inertia.momentOf(face.v); // the same at all three times: v x v = 0
  face.spin = inertia.solve(moment);
  Vec3 start[4];
  for (int i = 0; i < face.count; ++i)
    start[i] = nodes.x[i] - dt * nodes.v[i];
  face.spinAtStart = FaceInertia<Dim>(start, face.count).solve(moment);
  face.spinAtEnd = FaceInertia<Dim>(nodes.x, face.count).solve(moment);
  return face;
}
} // namespace coplane
