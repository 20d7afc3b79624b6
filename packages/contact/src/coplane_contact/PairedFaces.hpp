#pragma once

#include <coplane_contact/Faces.hpp>
#include <coplane_contact/HalfStepFace.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_core/NodeViews.hpp>

namespace coplane
{
/// Step A for the faces that have a slot: what all their pairs have in common in a cycle.
class PairedFaces
{
public:
  /// After a search. @param slots of the planes; faceCount: of the table of faces
  void mark(const Kokkos::View<SlotFaces*, Kokkos::HostSpace>& slots, std::size_t faceCount);
  /// Every cycle; in three dimensions several faces side by side where they have the same number of
  /// nodes.
  /// @param x at the end of the step [m]; v in its middle [m/s]; dt [s]
  void stepA(const Array<Face>& faces, int dimension, const ConstNodeVectors& x,
             const ConstNodeVectors& v, ContactOptions::Forces forces, Real dt) const;
  /// By place in the table of faces; those without a slot are not set.
  const HalfStepFace* data() const { return halfStep_.data(); }

private:
  Array<bool> paired_;
  Kokkos::View<HalfStepFace*, Kokkos::HostSpace> halfStep_;
};
} // namespace coplane
