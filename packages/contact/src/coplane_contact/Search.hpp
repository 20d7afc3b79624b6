#pragma once

#include <coplane_contact/Bins.hpp>
#include <coplane_contact/Faces.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_core/Comm.hpp>
#include <coplane_core/NodeViews.hpp>

#include <cstdint>
#include <functional>
#include <vector>

// Steps 1 to 5 of the Simple Common Plane algorithm (Vorobiev 2006): who may touch whom.

namespace coplane
{
/// Faces in the bins that their grown boxes touch: those of their own level and of all coarser
/// levels, so that two faces that are near each other share a bin of the level of the larger one.
struct SortedFaces
{
  Bins bins;
  std::vector<Box> boxes;        ///< per face, grown by half the reach
  std::vector<BinEntry> entries; ///< sorted by key, then face
};

struct InteractingRank
{
  int rank = 0;
  Box box;                               ///< of all its faces, grown by half the reach
  std::vector<std::uint64_t> commonBins; ///< keys, sorted
};

struct CandidatePair
{
  int lower = 0, higher = 0; ///< positions in the table of faces; lower has the smaller id
};

/// Faces whose boxes are within `reach` of each other share a bin: the skin, and the present depth
/// of contacts or opening of bonds, because the faces of a contact are apart by that much.

/// Step 1: extent of all faces over all ranks and sizes of bins, from exact reductions only.
Bins step1_globalSpaceLimits(const std::vector<Face>& faces, const ConstNodeVectors& x, Real reach,
                             const Comm& comm);

/// Step 2: local faces into bins.
SortedFaces step2_sortIntoBins(const Bins& bins, const std::vector<Face>& faces,
                               const ConstNodeVectors& x, Real reach);

/// Step 3: ranks exchange boxes; those whose boxes overlap exchange the bins of the faces that
/// reach into both boxes. Never this rank itself.
std::vector<InteractingRank> step3_interactingRanks(const SortedFaces& sorted, const Comm& comm);

/// What step 4 brings: faces of other ranks in common bins, sorted by id, and the living planes
/// they carry.
struct Ghosts
{
  std::vector<GhostFace> faces;
  std::vector<Donor> donors; ///< sorted by key, each once
};

/// Step 4: copies the faces in common bins, as far as they reach into the other rank's box, from
/// the ranks that own them. `localElements`: the elements behind the local faces, to go with them.
Ghosts step4_copyGhostFaces(const std::vector<InteractingRank>& ranks, const SortedFaces& sorted,
                            const std::vector<Face>& localFaces,
                            const std::vector<GlobalId>& nodeIds,
                            const std::vector<Donor>& livingPlanes, const Comm& comm,
                            const std::vector<FaceElement>& localElements = {});

struct CandidateRules
{
  Real skin = 0;  ///< largest gap of a candidate [m]
  Real reach = 0; ///< by which boxes may be apart, not below the skin [m]
  Real cosOpposed = 0.1;
  Real depthMax = 0.6;
  bool sharedNodes = false;               ///< pairs of faces that share a node as well
  std::function<bool(int, int)> excluded; ///< by group
  std::function<bool(int, int)> declared; ///< by group: joints that are closed at the start
  std::function<bool(GlobalId, GlobalId)>
      inContact; ///< pair keys that carry traction now: they stay candidates
};

/// Why a pair of faces is, or is not, a candidate.
enum class Verdict
{
  Candidate,
  SameElement,
  BothGhost,
  SharedNode,
  Excluded,
  NotOpposed,
  TooFarApart
};

/// Centre and outward unit normal of a face; the normal of a degenerate face is zero, so it opposes
/// nothing.
struct FacePlane
{
  Vec3 center{}, normal{};
};
FacePlane facePlane(const Face& face, const ConstNodeVectors& x, int dimension);

/// The tests of step 5 for one pair, cheapest first. Labels: a has the smaller id.
Verdict judgePair(const Face& a, const Face& b, const Box& boxA, const Box& boxB,
                  const FacePlane& planeA, const FacePlane& planeB, const ConstNodeVectors& x,
                  const CandidateRules& rules);

/// Step 5: all pairs of local and ghost faces that may touch before the next search, sorted by key.
std::vector<CandidatePair> step5_candidatePairs(const Bins& bins, const std::vector<Face>& faces,
                                                const ConstNodeVectors& x, int dimension,
                                                const CandidateRules& rules);
} // namespace coplane
