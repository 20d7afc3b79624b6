#pragma once

#include <coplane_core/BranchFree.hpp>
#include <coplane_core/Vec3.hpp>
#include <coplane_geometry/VectorArea.hpp>

// Step A, and what it gives. T is Real, or Lanes for several faces with the same number of nodes
// side by side; every lane has the bits of the scalar.

namespace coplane
{
/// What the kernel needs of a face: nodes at the end of the step and velocities in the middle of
/// it.
template <class T>
struct FaceNodesOf
{
  int count = 0;
  Vec3Of<T> x[4];  ///< x(n+1) [m]
  Vec3Of<T> v[4];  ///< v(n+1/2) [m/s]
  T mass = T(1.0); ///< that moves with the face [kg]; used by contact damping only
};
using FaceNodes = FaceNodesOf<Real>;

/// Corners of a face, or of a pair of faces, relative to their mean, and the tensor
/// sum |r|^2 I - r (x) r that turns a spin into a moment; in two dimensions only its zz entry is
/// used.
template <int Dim, class T, int Corners = 4>
struct FaceInertia
{
  Vec3Of<T> r[Corners];
  T xx{}, yy{}, zz{}, xy{}, yz{}, zx{};
  int count = 0;

  KOKKOS_INLINE_FUNCTION FaceInertia(const Vec3Of<T>* x, int n) : count(n)
  {
    Vec3Of<T> mean{};
    for (int i = 0; i < n; ++i)
      mean += x[i];
    mean = (1.0 / n) * mean;
    for (int i = 0; i < n; ++i)
    {
      r[i] = x[i] - mean;
      const Vec3Of<T>& q = r[i];
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
  KOKKOS_INLINE_FUNCTION Vec3Of<T> solve(const Vec3Of<T>& m) const
  {
    if constexpr (Dim == 2)
      return {T(0.0), T(0.0), m.z / zz};
    else
    {
      const T cxx = yy * zz - yz * yz, cyy = zz * xx - zx * zx, czz = xx * yy - xy * xy;
      const T cxy = yz * zx - xy * zz, cyz = zx * xy - yz * xx, czx = xy * yz - zx * yy;
      const T determinant = xx * cxx + xy * cxy + zx * czx;
      const T trace = xx + yy + zz;
      const auto regular = determinant > 1e-8 * trace * trace * trace;
      const T s = branchFree::choose(regular, 1.0 / determinant, T(0.0));
      return {s * (cxx * m.x + cxy * m.y + czx * m.z), s * (cxy * m.x + cyy * m.y + cyz * m.z),
              s * (czx * m.x + cyz * m.y + czz * m.z)};
    }
  }

  KOKKOS_INLINE_FUNCTION Vec3Of<T> momentOf(const Vec3Of<T>* v) const
  {
    Vec3Of<T> moment{};
    for (int i = 0; i < count; ++i)
      moment += cross(r[i], v[i]);
    return moment;
  }
};

/// Step A's result: all that the pairs of a face have in common in a cycle.
template <class T>
struct HalfStepFaceOf
{
  int count = 0;
  Vec3Of<T> x[4]; ///< x(n+1/2); x(n+1) for forces that come from a potential [m]
  Vec3Of<T> v[4]; ///< v(n+1/2) [m/s]
  Vec3Of<T> center{};
  Vec3Of<T> normal{}; ///< outward unit normal; zero for a degenerate face
  T area{};           ///< [m^2]
  Vec3Of<T> spin{};   ///< of the rigid motion nearest to the corner velocities [1/s]
  T massPerArea{};    ///< that moves with it [kg/m^2]; used by contact damping only
};
using HalfStepFace = HalfStepFaceOf<Real>;

namespace detail
{
/// Centre, area, normal and mass per area of a face from its corners and its mass. A degenerate one
/// gets no normal, and no mass; returns where there is one.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION branchFree::MaskOf<T> measureFace(HalfStepFaceOf<T>& face, const T& mass)
{
  using namespace branchFree;
  for (int i = 0; i < face.count; ++i)
    face.center += face.x[i];
  face.center = (1.0 / face.count) * face.center;
  const Vec3Of<T> area = vectorArea<Dim>(face.x, face.count);
  face.area = norm(area);
  T longest{};
  for (int i = 0; i < face.count; ++i)
  {
    const Vec3Of<T> edge = face.x[i + 1 == face.count ? 0 : i + 1] - face.x[i];
    longest = larger(dot(edge, edge), longest);
  }
  const auto proper = Dim == 2 ? face.area > 0.0 : face.area > 1e-12 * longest;
  const T inverse = choose(proper, 1.0 / face.area, T(0.0));
  face.normal = inverse * area;
  face.massPerArea = inverse * mass;
  return proper;
}
} // namespace detail

/// Step A: the face half a step ahead of the last known positions, x(n+1/2) = x(n+1) - dt/2
/// v(n+1/2).
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION HalfStepFaceOf<T> stepA_halfStepFace(const FaceNodesOf<T>& nodes, Real dt)
{
  using namespace branchFree;
  HalfStepFaceOf<T> face;
  face.count = nodes.count;
  for (int i = 0; i < nodes.count; ++i)
  {
    face.x[i] = nodes.x[i] - (0.5 * dt) * nodes.v[i];
    face.v[i] = nodes.v[i];
  }
  const auto proper = detail::measureFace<Dim>(face, nodes.mass);
  const FaceInertia<Dim, T> inertia(face.x, face.count);
  const Vec3Of<T> spin = inertia.solve(inertia.momentOf(face.v));
  const T none(0.0);
  face.spin = {choose(proper, spin.x, none), choose(proper, spin.y, none),
               choose(proper, spin.z, none)};
  return face;
}

/// The same where the dimension is known only when the program runs.
inline HalfStepFace stepA_halfStepFace(const FaceNodes& nodes, Real dt, int dimension)
{
  return dimension == 2 ? stepA_halfStepFace<2>(nodes, dt) : stepA_halfStepFace<3>(nodes, dt);
}

/// Step A for forces that come from a potential: the face at the end of the step, without spin.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION HalfStepFaceOf<T> stepA_faceAtEnd(const FaceNodesOf<T>& nodes)
{
  HalfStepFaceOf<T> face;
  face.count = nodes.count;
  for (int i = 0; i < nodes.count; ++i)
  {
    face.x[i] = nodes.x[i];
    face.v[i] = nodes.v[i];
  }
  detail::measureFace<Dim>(face, nodes.mass);
  return face;
}
} // namespace coplane
