#pragma once

#include <coplane_contact/Contact.hpp>

#include <vector>

namespace coplane
{
/// Bodies of two blocks, or of one, that lie in each other before the first step, or when a stage
/// has added blocks.
struct InitialOverlap
{
  int block[2] = {0, 0};  ///< in the order of the mesh
  std::int64_t faces = 0; ///< of either that lie in the other, wholly or in part
  Real depth = 0;         ///< least way out at the deepest point found [m]
  Real volume = 0;        ///< estimate [m^3]; two dimensions: per metre of thickness
  GlobalId faceId[2] = {0,
                        0}; ///< where it is deepest, and the face through which the way leads out
};

/// All overlaps of bodies, sorted by blocks: also of those that lie wholly in another one, which
/// step 5 does not see. Not of faces that rules exclude.
/// @param bodyOfNode for every node of this rank's elements a number of its body, the same on all
///        ranks
/// @param declaredAbsorb without what declared joints absorb as they are closed, before the first
/// step The same on all ranks, for any number of them. Collective.
std::vector<InitialOverlap> initialOverlaps(const Contact& contact, const ConstNodeVectors& x,
                                            const std::vector<int>& bodyOfNode,
                                            bool declaredAbsorb = true);
} // namespace coplane
