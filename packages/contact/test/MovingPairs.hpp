// Pairs of warped faces that go their ways, and what a cycle makes of them.
#pragma once

#include "FacePairs.hpp"

#include <coplane_contact/Search.hpp>

#include <algorithm>
#include <random>

namespace coplane::movingpairs
{
using namespace facepairs;

inline constexpr Real ahead = 0.5, lookAhead = 0.02, dt = 0.01; // [s]

/// Pairs of warped quadrilaterals and triangles of about 1 m, in all positions to each other, whose
/// nodes go their ways and stray from them.
struct MovingPairs
{
  explicit MovingPairs(int count, unsigned seed, Real swiftness, Real stray)
      : x("x", 8 * count), v("v", 8 * count), now("now", 8 * count), nowV("nowV", 8 * count),
        faces("faces", 2 * count), slots("slots", count), stray_(stray), random_(seed)
  {
    rules.turning = 0.1;
    rules.motion = {v, ahead, {}};
    for (int p = 0; p < count; ++p)
    {
      const Vec3 apart{1.2 * any(), 1.2 * any(), 0.6 * any()};
      const Mat3 all = rotation(vector(), 3 * any()), tilted = rotation(vector(), 1.6 * any());
      const Vec3 drift[2] = {swiftness * vector(), swiftness * vector()};
      for (int f = 0; f < 2; ++f)
      {
        Face& face = faces(2 * p + f);
        face.count = random_() % 3 == 0 ? 3 : 4;
        for (int k = 0; k < face.count; ++k)
        {
          const int node = face.nodes[k] = 8 * p + 4 * f + k;
          const Real side = f == 0 ? 1 : -1; // the second one faces the first
          Vec3 corner{k == 1 || k == 2 ? 0.5 : -0.5, side * (k > 1 ? 0.5 : -0.5), 0};
          corner += 0.1 * vector();
          if (f == 1)
            corner = tilted * corner + apart;
          set(x, node, all * corner);
          set(v, node, drift[f] + 0.2 * swiftness * vector());
        }
        slots(p).face[f] = 2 * p + f;
      }
    }
    planes = Array<FacePlane>("planes", faces.extent(0));
    for (std::size_t f = 0; f < faces.extent(0); ++f)
      planes(f) = rules.planeOf(faces(f), x, 3);
  }

  /// Nodes at that time since the search [s].
  void goOn(Real since)
  {
    for (int n = 0; n < int(x.extent(0)); ++n)
    {
      set(now, n, at(x, n) + std::min(since, ahead) * at(v, n) + stray_ * vector());
      set(nowV, n, at(v, n) + stray_ / ahead * vector());
    }
  }

  HalfStepFace faceNow(int f) const
  {
    FaceNodes nodes;
    nodes.count = faces(f).count;
    for (int k = 0; k < nodes.count; ++k)
    {
      nodes.x[k] = at(now, faces(f).nodes[k]);
      nodes.v[k] = at(nowV, faces(f).nodes[k]);
    }
    return stepA_faceAtEnd<3>(nodes);
  }

  NodeVectors x, v, now, nowV;
  Array<Face> faces;
  Kokkos::View<SlotFaces*, Kokkos::HostSpace> slots;
  CandidateRules rules;
  Array<FacePlane> planes; ///< by these rules

private:
  Real any() { return std::uniform_real_distribution<Real>(-1, 1)(random_); }
  Vec3 vector()
  {
    const Real a = any(), b = any(), c = any();
    return {a, b, c};
  }

  Real stray_;
  std::mt19937 random_;
};

/// What a cycle makes of a pair that has never touched.
Plane looked(const HalfStepFace& a, const HalfStepFace& b);

inline bool actsOrMay(const Plane& plane)
{
  return plane.isBorn() || plane.area > 0 || plane.nodeStiffness > 0;
}
} // namespace coplane::movingpairs
