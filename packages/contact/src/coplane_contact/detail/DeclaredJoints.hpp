#pragma once

#include <coplane_core/Real.hpp>

#include <cmath>

// Which faces lie on each other, so that a declared joint between them is closed at the start.

namespace coplane
{
/// Faces of a joint are opposed to within 25.8 degrees ...
constexpr Real opposedAcrossJoint = 0.9;
/// ... and nearer to each other than this part of the size of the smaller one.
constexpr Real widestJoint = 0.25;
/// Faces beside each other on both sides of a joint that is bent are opposed by more than this: 45
/// degrees.
constexpr Real opposedBesideJoint = 0.7;

/// @param cosine of the faces' outward normals; gap: where they overlap, size: of the smaller one
/// [m]
inline bool lieOnEachOther(Real cosine, Real gap, Real size)
{
  return cosine < -opposedAcrossJoint && std::abs(gap) <= widestJoint * size;
}
inline bool lieBesideEachOther(Real cosine, Real gap, Real size)
{
  return cosine < -opposedBesideJoint && std::abs(gap) <= widestJoint * size;
}
} // namespace coplane
