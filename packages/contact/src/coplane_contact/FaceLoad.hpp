#pragma once

#include <coplane_contact/HalfStepFace.hpp>
#include <coplane_contact/Plane.hpp>

namespace coplane
{
/// What the forces of all planes of a face add to its nodes; a lane for each node.
struct FaceLoad
{
  static_assert(laneCount == 4, "a face has up to four nodes");
  Vec3Of<Lanes> forces{}; ///< [N]
  Lanes stiffnesses{};    ///< bound on the stiffness that a node feels [N/m]
  Vec3 moment{};          ///< to be balanced by the couples of both faces [N m]

  KOKKOS_FORCEINLINE_FUNCTION Vec3 force(int node) const { return branchFree::lane(forces, node); }
  KOKKOS_FORCEINLINE_FUNCTION Real stiffness(int node) const { return stiffnesses[node]; }

  /// Adds a plane of which this face is number `side`, 0 or 1. Stiffness: 2 k A |w| by Gershgorin's
  /// circles. The overlap's part of a node is at most all of it; 1.5/n covers uniform and mildly
  /// uneven patches, and the weights of the area in contact cover the uneven ones.
  KOKKOS_FORCEINLINE_FUNCTION void add(const Plane& plane, int side, int count)
  {
    const Lanes weights(plane.weights[side], stdx::element_aligned);
    const Lanes share = side == 0 ? -weights : weights;
    forces += Vec3Of<Lanes>{share * plane.force.x, share * plane.force.y, share * plane.force.z};
    const Lanes whole(plane.overlap * (1.5 / count < 1 ? 1.5 / count : 1.0));
    const Lanes part = plane.area * branchFree::absolute(weights);
    stiffnesses += 2 * Real(plane.stiffness) * branchFree::larger(whole, part);
    moment += plane.moment;
  }

  /// The couples: they make the moment of a plane's forces vanish and their power equal to force .
  /// jump. x: positions on which the forces act, x(n+1).
  template <int Dim>
  KOKKOS_INLINE_FUNCTION void balanceMoment(const Vec3* x, int count)
  {
    if (dot(moment, moment) == 0)
      return;
    const FaceInertia<Dim, Real> inertia(x, count);
    const Vec3 turn = -0.5 * inertia.solve(moment);
    const auto each = [&](const auto& get) {
      return branchFree::gathered<Lanes>([&](int i)
                                         { return i < count ? get(inertia.r[i]) : 0.0; });
    };
    const Vec3Of<Lanes> r{each([](const Vec3& q) { return q.x; }),
                          each([](const Vec3& q) { return q.y; }),
                          each([](const Vec3& q) { return q.z; })};
    forces += cross(Vec3Of<Lanes>{turn.x, turn.y, turn.z}, r);
  }
};
} // namespace coplane
