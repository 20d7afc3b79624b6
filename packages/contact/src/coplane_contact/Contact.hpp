#pragma once

#include <coplane_checkpoint/StateTables.hpp>
#include <coplane_contact/ContactRules.hpp>
#include <coplane_contact/EndedPlanes.hpp>
#include <coplane_contact/FaceTable.hpp>
#include <coplane_contact/Faces.hpp>
#include <coplane_contact/ForceSums.hpp>
#include <coplane_contact/NearPairs.hpp>
#include <coplane_contact/PairDistances.hpp>
#include <coplane_contact/PairLife.hpp>
#include <coplane_contact/PairedFaces.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_contact/PlaneTable.hpp>
#include <coplane_contact/Search.hpp>
#include <coplane_contact/SearchReach.hpp>
#include <coplane_contact/SubsteppedPairs.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_core/Comm.hpp>
#include <coplane_core/NodeViews.hpp>
#include <coplane_mesh/NodeLayout.hpp>

#include <array>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace coplane
{
/// Numbers of planes over all ranks.
struct ContactCounts
{
  std::int64_t slots = 0;
  std::int64_t lookedAt = 0; ///< slots that are not left out because their faces are far apart
  std::int64_t carrying = 0; ///< planes with traction
  std::int64_t planes = 0, open = 0, stick = 0, slip = 0, tooDeep = 0, released = 0, missed = 0;

  std::array<std::int64_t*, 10> all()
  {
    return {&slots, &lookedAt, &carrying, &planes,   &open,
            &stick, &slip,     &tooDeep,  &released, &missed};
  }
  void add(ContactCounts others)
  {
    for (std::size_t i = 0; i < all().size(); ++i)
      *all()[i] += *others.all()[i];
  }
};

/// Simple Common Plane contact between all exterior faces of this rank and their neighbours
/// elsewhere.
///
/// A search (steps 1-5) runs in two halves, because the nodes of ghost faces must be known to the
/// layout in between: findGhosts(), then pairUp(). The update (step 6, A-H) runs every cycle.
class Contact
{
public:
  /// skin: how far apart faces may be to become candidates [m]; smallestFace: smallestFaceSize()
  /// [m]. Collective.
  Contact(const Comm& comm, int dimension, std::vector<Face> localFaces, ContactOptions options,
          ContactRules rules, Real skin, Real smallestFace);

  /// Steps 1 to 4, for faces at x that go on with v for the time `ahead`: the pairs that meet by
  /// then are found. Returns the ids of the nodes of ghost faces. Collective.
  std::vector<GlobalId> findGhosts(const ConstNodeVectors& x, const std::vector<GlobalId>& nodeIds,
                                   const ConstNodeVectors& v = {}, Real ahead = 0);
  /// Step 5, and slots for all pairs. `again`: repeats the last search, and is not counted. Call
  /// when the layout knows the ghosts' nodes, and x and v hold what they are there. Collective.
  void pairUp(const ConstNodeVectors& x, const NodeLayout& layout, bool again = false,
              const ConstNodeVectors& v = {});
  /// Between searches: pairs that have not touched yet learn what living planes have to give now.
  /// Collective.
  void passOnAnew(const ConstNodeVectors& x, const NodeLayout& layout);
  /// Declared joints become planes that are closed and carry the initial stress of their blocks
  /// at the point of contact [Pa, tension positive], less the pressure on their faces. What is
  /// pressed beyond its compressive strength carries the strength, out of equilibrium.
  using StressOfBlock = std::function<SymTensor(int block, const Vec3& x)>;
  /// Planes of all ranks of which that is so, and that which is furthest beyond.
  struct Overpressed
  {
    std::int64_t planes = 0;
    int joint = 0;         ///< position of its card
    Real compression = 0;  ///< that the initial stress asks for [Pa]
    Vec3 pointOfContact{}; ///< [m]
    GlobalId faceId[2] = {0, 0};
  };
  /// Collective: the planes of all ranks are summed.
  /// Needs a search with seekDeclaredJoints(true) before, and one without after.
  Overpressed closeDeclaredJoints(const ConstNodeVectors& x, const StressOfBlock& stressOfBlock);
  /// The same of joints of blocks that have just come in, free of stress. Collective.
  void closeJointsOfAdded(const ConstNodeVectors& x, const std::vector<int>& blocks);

  /// Ends the planes of faces of these elements and of these faces (both sorted), with their energy
  /// booked as eroded: the elements have died, the faces have been covered, on the way to x. Every
  /// rank needs the same lists.
  /// @param last step of the pairs that have several in a cycle
  void endPlanesOf(const std::vector<GlobalId>& deadElements, const std::vector<GlobalId>& faces,
                   const ConstNodeVectors& x, const ConstNodeVectors& v, Real dt,
                   const Substep& last);
  /// Other local faces, sorted by id; those that were there before keep their planes. A search has
  /// to follow.
  void replaceLocalFaces(std::vector<Face> localFaces);

  /// Contact's part of a checkpoint. Collective.
  void save(StateTables& out) const;
  // And back, in two halves like a search; the local faces have to be those of that time.
  // Collective.
  /// Returns the ids of the nodes of ghost faces.
  std::vector<GlobalId> restoreFaces(const StateSource& in, const std::vector<GlobalId>& nodeIds);
  /// Call when the layout knows the ghosts' nodes.
  void restorePlanes(const StateSource& in, const NodeLayout& layout);
  /// What cycles know from the last search, at whose time nodes were at x and had v; it looked so
  /// far ahead [s]. Collective.
  void restoreDistances(const ConstNodeVectors& x, const ConstNodeVectors& v, Real ahead);
  /// Where faces are between updates. @param sinceSearch, lookAhead as in step 6 [s]
  void followFaces(const ConstNodeVectors& x, const ConstNodeVectors& v, Real sinceSearch,
                   Real lookAhead)
  {
    distances_.follow(x, v, sinceSearch, lookAhead);
  }
  /// Step A where faces stand still: for those who look at them before the next update.
  void findFaces(const ConstNodeVectors& x, const ConstNodeVectors& v);

  /// Step 6: steps A to H for the slots whose faces are near. lookAhead: what may touch within this
  /// time counts for the stable step; at least the two largest steps that may follow; sinceSearch:
  /// time since then [s]; last: step of the pairs that have several in a cycle
  void step6_updateCommonPlanes(const ConstNodeVectors& x, const ConstNodeVectors& v, Real dt,
                                Real lookAhead, Real sinceSearch, const Substep& last = {});

  /// Which pairs have several steps in a cycle: those at a node that has. To be told after each
  /// search, too. @param steps in a cycle, by node of the layout; 1: one
  void substepPairsAt(const Array<Real>& steps, int ownedNodes)
  {
    substepped_.list(planes_.slots().faces, faces(), localFaces().size(), ownedNodes, steps);
  }
  const SubsteppedPairs& substepped() const { return substepped_; }
  /// Which of these pairs have to be looked at in the cycle that begins, after the first of its
  /// substeps. @param sinceSearch, lookAhead as in step 6 [s]
  void beginSubsteps(const ConstNodeVectors& x, const Substep& step, Real sinceSearch,
                     Real lookAhead);
  /// Steps A to H for those, at x. Until the next update faces are known for nobody else.
  void updateSubstepped(const ConstNodeVectors& x, const Substep& step);
  /// Adds their forces to owned nodes [N].
  void addSubsteppedForces(const NodeVectors& force) const
  {
    substepped_.addForces(planes_.slots().plane.data(), planes_.slots().activity, force);
  }
  /// Calls f(face, face) for all pairs of the last search.
  template <class F>
  void forEachPair(F&& f) const
  {
    for (std::size_t p = 0; p < planes_.count(); ++p)
      if (const SlotFaces& pair = planes_.slots().faces(p); pair.face[0] >= 0)
        f(faces()[pair.face[0]], faces()[pair.face[1]]);
  }

  /// Adds the planes' forces to owned nodes, face by face in the order of ids and plane by plane in
  /// the order of keys, and bounds the contact stiffness that each node feels [N/m].
  void addForces(const NodeVectors& f, const Array<Real>& stiffness) const
  {
    forceSums_.add(planes_.slots().plane.data(), planes_.slots().activity, f, stiffness);
  }

  const std::vector<Face>& faces() const { return faces_.all(); }
  const std::vector<Face>& localFaces() const { return faces_.local(); }
  /// Those that nothing has come near since the last search do not know yet what it found beside
  /// their faces; prepared() tells what they are when they do, which checkpoints and hashes have.
  const PlaneList& planes() const { return planes_.planes(); }
  /// The same with the gaps and overlaps of this cycle, for those who show them: cycles do not look
  /// at open planes whose faces are far from each other. Until the next update or search.
  const PlaneList& planesNow() const;
  /// The planes, of which some are copies that are kept here.
  struct Shown
  {
    PlaneList list;
    Kokkos::View<Plane*, Kokkos::HostSpace> copies;
  };
  /// The same list, where only planes that are asked for have gaps and overlaps of this cycle;
  /// others have those of the last cycle that looked at them.
  Shown planesNow(const std::function<bool(const Plane&)>& isAskedFor) const;
  /// All pairs of the last search, most of which have no plane: how many, the plane that each has
  /// or would get, and the same prepared.
  std::size_t slots() const { return planes_.count(); }
  Plane planeOf(std::size_t slot) const { return planes_.planeOf(slot); }
  Plane prepared(std::size_t slot) const { return planes_.prepared(slot); }
  const ContactOptions& options() const { return options_; }
  const ContactRules& rules() const { return rules_; }
  /// Largest gap of the pairs that the last search took [m].
  Real skin() const { return reach_.skin(); }
  /// How the next search looks for what moves by `motion` in a step [m] (SearchReach::coverMotion).
  /// @returns for how long ahead [s]
  Real coverMotion(Real motion, Real step) { return reach_.coverMotion(motion, step); }
  /// Whether the last search foresees the motion in all of that time.
  bool foresees() const { return reach_.foresees(); }
  void setSkin(Real skin) { reach_.setSkin(skin); } ///< [m]
  /// Whether the next searches find all faces across declared joints, whatever the skin.
  void seekDeclaredJoints(bool seek) { reach_.seekJoints(seek); }
  /// Largest stiffness that contact of a face with any other can begin with, or stiffen to [Pa/m].
  Real stiffestOn(const Face& face) const;
  int dimension() const { return dimension_; }
  const Comm& comm() const { return *comm_; }
  /// Whether since pairs last learned what planes have to give, planes of this rank have changed
  /// it, as far as it matters (detail/PassedOn.hpp).
  bool passedOnHasChanged() const { return planes_.passedOnHasChanged(); }
  /// The same for how deep they lie, which pairs beside them have to know in the next cycle.
  bool depthsHaveChanged() const { return planes_.depthsHaveChanged(); }
  std::int64_t searches() const { return searches_.count; }
  /// What this rank has worked in searches since the last call, without waiting for others [s].
  double takeSearchSeconds() { return std::exchange(searches_.seconds, 0.0); }

  // Over all ranks, the same bits on all; collective.
  ContactEnergy energy() const;
  ContactCounts counts() const;

  /// What the planes of this rank have gained by their remainders, in bits that depend on ranks and
  /// threads [J].
  Real gainHere() const { return planes_.gain(); }
  /// Energies of the planes that have ended and were counted on this rank.
  const EndedPlanes& ended() const { return ended_; }
  /// What the planes of this rank that are counted here add up to.
  struct Tally
  {
    ContactCounts counts;                  ///< of planes, not of slots
    std::vector<PlaneEnergySums> energies; ///< by joint card, without those that have ended

    void add(const Tally& others);
  };
  /// Found once until the planes change: records ask for its parts one after the other.
  const Tally& tally() const;

  /// Law of a plane.
  const JointLaw& lawOf(const Plane& plane) const { return rules_.joints[plane.joint].law; }

  /// Whether the faces of a candidate pair opposed each other in the last update. With the
  /// potential those that may begin to before the next search are candidates, too.
  bool isOpposed(const Plane& plane) const { return opposition(plane) > options_.cosOpposed; }
  /// Cosine of the angle by which the faces of a candidate pair miss being parallel in the last
  /// update: 1 where they look straight at each other [-].
  Real opposition(const Plane& plane) const
  {
    const HalfStepFace* const faces = pairedFaces_.all();
    return -dot(faces[plane.face[0]].normal, faces[plane.face[1]].normal);
  }

  /// This rank's planes to count and to write: those whose lower face it owns, that exist and
  /// overlap.
  bool isWrittenHere(const Plane& plane) const
  {
    return plane.countedHere && plane.isBorn() && plane.face[0] >= 0;
  }

  /// Default skin: a fraction of the smallest face [m]. Collective.
  static Real smallestFaceSize(const std::vector<Face>& faces, const ConstNodeVectors& x,
                               int dimension, const Comm& comm);

private:
  PairedFaces::Motion motionOf(const ConstNodeVectors& x, const ConstNodeVectors& v, Real dt) const;
  /// A pair of a checkpoint that has no plane, and nothing to remember but this.
  struct BarePair
  {
    GlobalId faceId[2];
    Activity activity;
    EdgesOfPair edges;
  };
  /// What the first half of a search leaves to the second.
  struct FirstHalf
  {
    Bins bins;
    Ghosts ghosts;
    // Of the nodes of the table of faces that was made by the search before.
    std::vector<GlobalId> nodeIds;
    ConstNodeVectors x;
    // Of a checkpoint, whose slots need no search; sorted by key.
    std::vector<Plane> restored;
    std::vector<BarePair> bare;

    std::vector<GlobalId> nodesOfGhosts() const;
  };
  /// A face on which another one lies, corner by corner.
  struct Coinciding
  {
    GlobalId face, other;

    bool operator<(const Coinciding& o) const
    {
      return face != o.face ? face < o.face : other < o.other;
    }
    bool operator==(const Coinciding& o) const { return face == o.face && other == o.other; }
  };
  /// Faces by their places, and the gap between them [m].
  struct FacesOnEachOther
  {
    std::int32_t face[2];
    Real gap;
  };
  /// That a body lies on a face.
  struct BodyOnFace
  {
    GlobalId face;
    int body;
    Real gap;       ///< between them [m]
    Real thickness; ///< of its element there [m]

    auto key() const { return std::tuple(face, body, gap, thickness); }
    bool operator<(const BodyOnFace& o) const { return key() < o.key(); }
    bool operator==(const BodyOnFace& o) const { return key() == o.key(); }
  };
  /// A face of this rank that another one has a copy of.
  struct WantedFace
  {
    GlobalId face;
    int byRank;

    bool operator<(const WantedFace& o) const
    {
      return face != o.face ? face < o.face : byRank < o.byRank;
    }
  };
  struct GhostsElsewhere
  {
    bool known = false;            ///< else they are found when somebody asks
    std::vector<WantedFace> faces; ///< sorted
  };
  struct Searches
  {
    std::int64_t count = 0;
    std::int64_t missed = 0; ///< pairs that a search had to find before, and did not
    double seconds = 0;      ///< see takeSearchSeconds()
    bool sinceUpdate = false;
  };

  // Of a search.
  void findLimits(const ConstNodeVectors& x, const ConstNodeVectors& v,
                  Real ahead);                                     ///< Collective.
  Motion motionAhead(const ConstNodeVectors& v, Real ahead) const; ///< Collective.
  /// @param nodeIds, x of the nodes of the table of faces
  std::vector<Donor> livingPlanes(const std::vector<GlobalId>& nodeIds,
                                  const ConstNodeVectors& x) const;
  Heritage::Place placeOfFaces(const ConstNodeVectors& x, const NodeLayout& layout) const;
  /// Living planes of the faces of other ranks, of those that are this rank's. Collective.
  std::vector<Donor> donorsOfGhosts(const std::vector<Donor>& mine);
  /// Copies of faces far away to whom living planes hold on. Collective.
  void addGhostsOfLivingPlanes(const std::vector<GlobalId>& nodeIds);
  /// Tells the owners of faces who wants them: what this rank is asked for. Collective.
  std::vector<WantedFace> askOwners(const std::vector<GlobalId>& wanted) const;
  /// The faces with these ids, from their owners; those that nobody has are left out. Collective.
  std::vector<GhostFace> fetchGhosts(const std::vector<GlobalId>& wanted,
                                     const std::vector<GlobalId>& nodeIds) const;
  /// Candidates that an item of contact.pairs declares.
  std::vector<std::size_t> declaredSlots() const;
  /// Of the faces of these slots those that coincide with another one, sorted: all that this rank
  /// has pairs of. Only the owner of a ghost may have the face on which it lies. Collective.
  std::vector<Coinciding> coincidingFaces(const ConstNodeVectors& x,
                                          const std::vector<std::size_t>& slots) const;
  /// @param addedBlocks whose joints are closed; empty: all. Collective.
  Overpressed closeJoints(const ConstNodeVectors& x, const std::vector<int>& addedBlocks,
                          const StressOfBlock& stressOfBlock);
  /// The bodies that lie on the faces in question, by pairs of faces that lie on each other,
  /// sorted. Only the owner of a ghost may know all of those. Collective.
  std::vector<BodyOnFace> bodiesOn(std::vector<int> asked,
                                   const std::vector<FacesOnEachOther>& pairs) const;
  void listSlotsOfFaces(int ownedNodes);
  void planesHaveChanged()
  {
    shown_.reset();
    tally_.reset();
  }
  bool isIncremental() const { return options_.closure == ContactOptions::Closure::Incremental; }
  PairTables pairTables();
  void listSubsteppedNear();
  void updatePairs(const std::vector<int>& slots, Real dt);
  /// Pairs counted here that are not left out because their faces are far apart.
  std::int64_t lookedAtHere() const;
  /// Whether the last update may have left out an open plane.
  bool wasPassedOver(std::size_t slot) const;
  /// How far the pairs of a search are from each other. @param planes of the faces, x (a copy) and
  /// v of the nodes at that time
  void measureDistances(const ConstNodeVectors& x, const ConstNodeVectors& v);
  /// Law of a pair of faces.
  const JointLaw& lawOf(const SlotFaces& pair) const
  {
    return rules_
        .joints[rules_.between(faces()[pair.face[0]].group, faces()[pair.face[1]].group).joint]
        .law;
  }
  bool wasMissed(const Plane& plane, const ConstNodeVectors& x) const;
  /// Slots of a checkpoint that have a face here; members of planes that only mean something on one
  /// rank are left as they are in a new plane, but face[0] is 0 where the pair is a candidate.
  /// Collective.
  void readSlots(const StateSource& in);

  // What contact is between ...
  const Comm* comm_;
  int dimension_;
  ContactOptions options_;
  ContactRules rules_;
  FaceTable faces_;
  // ... what searches find ...
  SearchReach reach_;
  Searches searches_;
  FirstHalf firstHalf_; ///< empty between searches
  GhostsElsewhere ghostsElsewhere_;
  // ... and what cycles work on.
  PlaneTable planes_;
  PairedFaces pairedFaces_;
  NearPairs near_;
  SubsteppedPairs substepped_;
  Real lookAhead_ = 0; ///< of this cycle [s]
  PairDistances distances_;
  ForceSums forceSums_;
  EndedPlanes ended_;
  mutable std::optional<Shown> shown_; ///< planesNow()
  mutable std::optional<Tally> tally_;
};
} // namespace coplane
