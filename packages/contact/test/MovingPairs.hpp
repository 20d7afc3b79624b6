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

/// Pairs of warped quadrilaterals and triangles of about 1 m, or of segments in two dimensions,
/// whose nodes go their ways and stray from them: in all positions to each other, or beside each
/// other as on a joint.
struct MovingPairs
{
  enum class Place
  {
    Anywhere,
    Beside
  };

  explicit MovingPairs(int count, unsigned seed, Real swiftness, Real stray,
                       Place place = Place::Anywhere, int itsDimension = 3)
      : dimension(itsDimension), x("x", 8 * count), v("v", 8 * count), now("now", 8 * count),
        nowV("nowV", 8 * count), faces("faces", 2 * count), slots("slots", count), stray_(stray),
        random_(seed)
  {
    const bool beside = place == Place::Beside;
    rules.turning = 0.1;
    rules.motion = {v, ahead, {}};
    for (int p = 0; p < count; ++p)
    {
      const Vec3 apart = beside ? Vec3{1 + 0.1 * any(), any(), 0.05 * any()}
                                : Vec3{1.2 * any(), 1.2 * any(), 0.6 * any()};
      const Mat3 all = rotation(axis(), 3 * any()),
                 tilted = rotation(axis(), (beside ? 0.1 : 1.6) * any());
      const Vec3 drift[2] = {swiftness * vector(), swiftness * vector()};
      for (int f = 0; f < 2; ++f)
      {
        Face& face = faces(2 * p + f);
        face.count = dimension == 2 ? 2 : random_() % 3 == 0 ? 3 : 4;
        for (int k = 0; k < face.count; ++k)
        {
          const int node = face.nodes[k] = 8 * p + 4 * f + k;
          const Real side = f == 0 ? 1 : -1; // the second one faces the first
          Vec3 corner{k == 1 || k == 2 ? 0.5 : -0.5, side * (k > 1 ? 0.5 : -0.5), 0};
          if (dimension == 2)
            corner = {side * (k == 0 ? 0.5 : -0.5), 0, 0};
          corner += (beside ? 0.01 : 0.1) * vector();
          if (f == 1)
            corner = tilted * corner + (dimension == 2 ? Vec3{apart.x, apart.z, 0} : apart);
          set(x, node, all * corner);
          set(v, node, drift[f] + 0.2 * swiftness * vector());
        }
        slots(p).face[f] = 2 * p + f;
      }
    }
    planes = Array<FacePlane>("planes", faces.extent(0));
    for (std::size_t f = 0; f < faces.extent(0); ++f)
      planes(f) = rules.planeOf(faces(f), x, dimension);
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

  /// @param later time for which nodes go on [s]
  HalfStepFace faceNow(int f, Real later = 0) const
  {
    FaceNodes nodes;
    nodes.count = faces(f).count;
    for (int k = 0; k < nodes.count; ++k)
    {
      nodes.x[k] = at(now, faces(f).nodes[k]) + later * at(nowV, faces(f).nodes[k]);
      nodes.v[k] = at(nowV, faces(f).nodes[k]);
    }
    return dimension == 2 ? stepA_faceAtEnd<2>(nodes) : stepA_faceAtEnd<3>(nodes);
  }

  int dimension;
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
    return {a, b, dimension == 2 ? 0 : c};
  }
  Vec3 axis() { return dimension == 2 ? Vec3{0, 0, 1} : vector(); }

  Real stray_;
  std::mt19937 random_;
};

/// What a cycle makes of a pair that has never touched, or that is a plane already.
Plane looked(const HalfStepFace& a, const HalfStepFace& b, int dimension = 3,
             PlaneState state = PlaneState::Slot);

inline bool actsOrMay(const Plane& plane)
{
  return plane.isBorn() || plane.area > 0 || plane.nodeStiffness > 0;
}
} // namespace coplane::movingpairs
