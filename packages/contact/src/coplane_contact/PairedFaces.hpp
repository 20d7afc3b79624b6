#pragma once

#include <coplane_contact/Faces.hpp>
#include <coplane_contact/HalfStepFace.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_core/NodeViews.hpp>

#include <cstdint>
#include <vector>

namespace coplane
{
/// Step A for the faces that have a slot: what all their pairs have in common in a cycle.
class PairedFaces
{
public:
  /// Where faces are, and how they move. @param x at the end of the step [m]; v in its middle
  /// [m/s]; dt [s]
  struct Motion
  {
    Array<Face> faces;
    int dimension = 3;
    ConstNodeVectors x, v;
    ContactOptions::Forces forces = ContactOptions::Forces::Potential;
    Real dt = 0;
  };

  /// After a search. @param slots of the planes; faceCount: of the table of faces
  void mark(const Kokkos::View<SlotFaces*, Kokkos::HostSpace>& slots, std::size_t faceCount);
  /// Every cycle, for some of the faces that have a slot; in three dimensions several side by side
  /// where they have the same number of nodes. @param places in the table of faces,
  /// ascending
  void stepA(const Motion& motion, const std::vector<int>& places);
  /// The same for all.
  void stepA(const Motion& motion);
  /// By place in the table of faces; those that the last step A was not for are not set.
  const HalfStepFace* data() const { return halfStep_.data(); }
  /// The same after the others have followed, if nodes are where they were then. Not for several
  /// threads at once.
  const HalfStepFace* all() const;

private:
  void find(const std::vector<int>& places) const;

  std::vector<int> paired_; ///< places of those that have a slot, ascending
  Kokkos::View<HalfStepFace*, Kokkos::HostSpace> halfStep_;
  Motion motion_;                  ///< of the last step A
  mutable std::vector<int> found_; ///< those that it was for, ascending
};
} // namespace coplane
