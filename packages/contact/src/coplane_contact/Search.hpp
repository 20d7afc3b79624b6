#pragma once

#include <coplane_contact/Bins.hpp>
#include <coplane_contact/Faces.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_core/Comm.hpp>
#include <coplane_core/NodeViews.hpp>

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

// Steps 1 to 5 of the Simple Common Plane algorithm (Vorobiev 2006): who may touch whom.

namespace coplane
{
/// Centre and outward unit normal of a face; the normal of a degenerate face is zero, so it opposes
/// nothing.
struct FacePlane
{
  Vec3 center{}, normal{};
  /// By which a product with the normal may change as the face goes on [-]; for faces narrower than
  /// those that CandidateRules::turning is for, also by what is not foreseen.
  Real turning = 0;
  Real warp = 0; ///< by which nodes lie beside the plane, on its way, too [m]
};
FacePlane facePlane(const Face& face, const ConstNodeVectors& x, int dimension);

/// How faces move until the next search can come.
struct Motion
{
  ConstNodeVectors v;
  Real ahead = 0; ///< for how long [s]
  Vec3 frame{};   ///< velocity that all bodies may share: it brings nobody together [m/s]
};

struct CandidateRules
{
  Real skin = 0;   ///< largest gap of a candidate [m]
  Real offset = 0; ///< largest gap at which a joint is closed: such planes touch that far apart [m]
  Real reach = 0;  ///< by which boxes may be apart, not below skin and offset together [m]
  Real cosOpposed = ContactOptions().cosOpposed;
  Real turning = 0;         ///< by which n0.n1 may fall until the next search [-]
  Real smallestFace = 0;    ///< faces that are no narrower turn by no more [m]
  Real strays = 0;          ///< by which nodes may move without being foreseen [m]
  Real depthMax = 0.6;      ///< largest depth of a candidate over the thinner element's thickness
  bool sharedNodes = false; ///< pairs of faces that share a node as well
  std::function<bool(int, int)> excluded; ///< by group
  std::function<bool(int, int)> declared; ///< by group: joints that are closed at the start
  /// Faces across a declared joint are candidates up to this gap, too, over the extent of the
  /// smaller one [-].
  Real jointGap = 0;
  Motion motion;
  /// By which boxes take a face to turn at most [-]. Which faces may oppose each other counts all
  /// of it: one that is crushed through no area turns over.
  static constexpr Real mostTurningAhead = 0.2;

  /// Candidates have n0.n1 below this.
  Real mostCosine(const FacePlane& a, const FacePlane& b) const
  {
    return turning - cosOpposed + a.turning + b.turning;
  }

  /// What the normal of a face turns by beyond `turning`: one that is crushed to almost no width
  /// has any normal after the next step. @param width of the face, across its longest edge [m]
  Real turningOfNarrow(Real width) const
  {
    constexpr Real over = 2; // it looks the other way
    if (!(turning > 0 && smallestFace > 0) || width >= smallestFace)
      return 0;
    return std::min(over, strays * (1 / width - 1 / smallestFace)); // of no width at all: over;
  }

  /// Way of a node of a face ahead. Steps are bound so that no face moves by a body's thickness:
  /// what is far beyond is none of this face's business, and would only fill the bins.
  /// @param longest way [m]
  Vec3 way(int node, Real longest) const
  {
    const Vec3 way = motion.ahead * (at(motion.v, node) - motion.frame);
    const Real size = norm(way);
    return size > longest ? (longest / size) * way : size >= 0 ? way : Vec3{};
  }
  /// How far the box of a face goes on into the body [m]. Points of two faces that lie at depth d
  /// in each other are apart by d (n0 - n1) / |n0 - n1|: moved inwards by d / |n0 - n1| the faces
  /// meet.
  Real depthInto(const Face& face, const FacePlane& plane) const
  {
    return depthMax * face.thickness / leastApart(plane);
  }
  /// The plane of a warped face stands for it, and lies beyond its nodes: by how much along the
  /// normal of any pair, which leans towards that of the face by half of |n0 - n1| [m].
  Real beyondNodes(const FacePlane& plane) const { return 2 * plane.warp / leastApart(plane); }
  /// jointGap of one face [m], no less than that fraction of its size.
  Real jointGapOf(const Face& face, const ConstNodeVectors& x) const;
  /// The plane of a face, with what motion makes of it.
  FacePlane planeOf(const Face& face, const ConstNodeVectors& x, int dimension) const;

private:
  /// Least of |n0 - n1| of a pair, with another face that turns as much as this one.
  Real leastApart(const FacePlane& plane) const
  {
    const FacePlane bounded{{}, {}, std::min(plane.turning, mostTurningAhead), 0};
    return std::sqrt(2 - 2 * std::max(0.0, mostCosine(bounded, bounded)));
  }
};

/// The planes of many faces, with what motion makes of them: those of CandidateRules::planeOf().
Array<FacePlane> facePlanes(const Face* faces, std::size_t count, const ConstNodeVectors& x,
                            int dimension, const CandidateRules& rules);

/// Where the face may be in contact before the next search: the face, the same at the largest depth
/// of a contact inside its body, both where its motion takes it, and around them half the reach and
/// what its plane lies beyond its nodes, and half of jointGapOf(). Two faces within that depth of
/// each other, or within the reach or that of a joint, have boxes that overlap.
Box contactBox(const Face& face, const FacePlane& plane, const ConstNodeVectors& x,
               const CandidateRules& rules);

/// The velocity half way between the least and the largest of the faces' nodes, by axis.
/// Collective.
Vec3 commonVelocity(const std::vector<Face>& faces, const ConstNodeVectors& v, const Comm& comm);

/// Faces in the bins that their grown boxes touch: those of their own level and of all coarser
/// levels, so that two faces that are near each other share a bin of the level of the larger one.
struct SortedFaces
{
  Bins bins;
  std::vector<Box> boxes;        ///< contactBox() per face
  Array<FacePlane> planes;       ///< per face
  std::vector<BinEntry> entries; ///< sorted by key, then face
};

struct InteractingRank
{
  int rank = 0;
  Box box;                               ///< of the boxes of all its faces
  std::vector<std::uint64_t> commonBins; ///< keys, sorted
};

struct CandidatePair
{
  int lower = 0, higher = 0; ///< positions in the table of faces; lower has the smaller id
};

/// Step 1: extent of all faces over all ranks and sizes of bins, by exact reductions. Collective.
Bins step1_globalSpaceLimits(const std::vector<Face>& faces, const ConstNodeVectors& x,
                             const CandidateRules& rules, const Comm& comm);

/// Step 2: faces into bins, by rules of which `excluded` and `declared` do not matter. A face that
/// is cut has an empty box, and is in no bin.
SortedFaces step2_sortIntoBins(const Bins& bins, const std::vector<Face>& faces,
                               const ConstNodeVectors& x, int dimension,
                               const CandidateRules& rules);

/// Step 3: ranks exchange boxes; those whose boxes overlap exchange the bins of the faces that
/// reach into both boxes. Never this rank itself. Collective.
std::vector<InteractingRank> step3_interactingRanks(const SortedFaces& sorted, const Comm& comm);

/// What step 4 brings: faces of other ranks in common bins, sorted by id, and the living planes
/// they carry.
struct Ghosts
{
  std::vector<GhostFace> faces;
  std::vector<Donor> donors; ///< sorted by key, each once
};

/// Step 4: copies the faces in common bins, as far as they reach into the other rank's box, from
/// the ranks that own them. Collective.
Ghosts step4_copyGhostFaces(const std::vector<InteractingRank>& ranks, const SortedFaces& sorted,
                            const std::vector<Face>& localFaces,
                            const std::vector<GlobalId>& nodeIds,
                            const std::vector<Donor>& livingPlanes, const Comm& comm);

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

/// The tests of step 5 for one pair, cheapest first. Labels: a has the smaller id.
Verdict judgePair(const Face& a, const Face& b, const Box& boxA, const Box& boxB,
                  const FacePlane& planeA, const FacePlane& planeB, const ConstNodeVectors& x,
                  const CandidateRules& rules);

/// Whether a search that did not find this pair was wrong, when since then nodes have moved
/// relative to each other by at most `moved` [m], and normals have turned by at most `turned`
/// [rad]. It was not where the pair may have been no candidate yet: not opposed enough, too deep,
/// or, on both sides of the tip of a joint, not folded onto each other.
bool hadToBeFound(const Face& a, const Face& b, const FacePlane& planeA, const FacePlane& planeB,
                  const CandidateRules& rules, Real moved, Real turned);

/// Step 5: all pairs of local and ghost faces that may touch before the next search, sorted by key.
/// @param sorted all of these faces, by the same reach and motion
std::vector<CandidatePair> step5_candidatePairs(const SortedFaces& sorted,
                                                const std::vector<Face>& faces,
                                                const ConstNodeVectors& x,
                                                const CandidateRules& rules);
} // namespace coplane
