#pragma once

#include <coplane_contact/ContactRules.hpp>
#include <coplane_contact/Faces.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_contact/Preparation.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_core/Prefetch.hpp>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace coplane
{
struct PairTables;

/// What a plane that is counted here has gained, by its remainder [J].
inline Real gainOf(const Plane& plane)
{
  return plane.countedHere && plane.isBorn() ? -plane.remainder() : 0;
}

/// What cycles have changed, by any thread.
struct PassedOnChanges
{
  std::atomic<bool> changed{false}; ///< something that planes pass on
  std::atomic<bool> deeper{false};  ///< how deep they lie, as far as that matters

  void forget() { changed = deeper = false; }
};

/// The planes of those slots that have one, in the order of slots, which is that of their keys.
class PlaneList
{
public:
  std::size_t size() const { return planes_.size(); }
  Plane& operator[](std::size_t p) const { return *planes_[p]; }
  std::size_t slotOf(std::size_t p) const { return slots_[p]; }
  /// Brings a plane that will be read soon into the cache, without its forces.
  void prefetchAfter(std::size_t p) const
  {
    constexpr std::size_t ahead = 8;
    if (p + ahead >= planes_.size())
      return;
    const Plane& plane = *planes_[p + ahead];
    prefetch(&plane.faceId);
    prefetch(&plane.history);
    prefetch(&plane.stored);
  }

  void clear();
  void add(std::size_t slot, Plane* plane);

private:
  std::vector<Plane*> planes_;
  std::vector<std::size_t> slots_;
};

/// What the last search has seen at the edges of the faces of a pair, as in its plane.
struct EdgesOfPair
{
  std::uint8_t exits = 0, turns = 0, covered = 0, seams = 0;
};

/// The slots of the last search, sorted by key, in tables that every cycle looks through. Most
/// pairs that a search finds are edge neighbours whose shadows never meet: all that there is to
/// know of them are their faces, and whether they have been looked at. A slot gets its plane, of
/// hundreds of bytes, when its faces meet.
class PlaneTable
{
public:
  using SlotTable = Kokkos::View<SlotFaces*, Kokkos::HostSpace>;

  /// What a search fills, and cycles go on with.
  struct Slots
  {
    Slots() = default;
    /// @param planes how many have their plane at once
    Slots(std::size_t count, std::size_t planes);

    SlotTable faces;                 ///< as in the plane
    std::vector<Plane*> plane;       ///< null: none yet
    Array<Activity> activity;        ///< without a plane: not Awake once it has been looked at
    Array<std::uint8_t> todo;        ///< what it has not been told yet (Preparation::Todo)
    Array<std::uint8_t> countedHere; ///< 1: this rank owns face 0. Set by take()
    Array<std::uint8_t> born;        ///< 1 where renew() has found a plane that is born
    /// Minus the remainder of its plane, if that is born and counted here, since it was evaluated
    /// last [J]; gain() fills in the others.
    Array<Real> gains;
    Kokkos::View<Plane*, Kokkos::HostSpace> stored; ///< those that there are at once; to be made
    /// Of a checkpoint, for slots without a plane; empty: the preparation tells.
    std::vector<EdgesOfPair> edges;
  };

  /// @param rules that outlive this
  PlaneTable(const ContactRules& rules, Real depthMax);

  std::size_t count() const { return slots_.faces.extent(0); } ///< of slots
  const Slots& slots() const { return slots_; }
  const PlaneList& planes() const { return planes_; }
  std::int64_t countedHere() const { return countedHere_; } ///< slots
  /// Minus the remainders of the born planes that are counted here, in bits that depend on ranks
  /// and threads [J]. After the first time since the slots were made it looks at no plane.
  Real gain() const;
  /// Whether the pair of a slot has been looked at, and carries nothing.
  bool carriesNothing(std::size_t slot) const
  {
    return slots_.activity(slot) == Activity::Asleep || slots_.activity(slot) == Activity::Apart;
  }
  /// What a pair that has not touched yet has to be told of what others pass on.
  Preparation::Todo takeOver(std::size_t slot) const;
  /// Whether planes have changed what they pass on since pairs last learned it.
  bool passedOnHasChanged() const { return passedOn_.changed; }
  bool depthsHaveChanged() const { return passedOn_.deeper; }

  /// Ids of the faces of a slot; before all others for one whose plane has been taken away while
  /// its faces were no candidates.
  std::pair<GlobalId, GlobalId> keyOf(std::size_t slot) const;
  /// The plane of a slot, or the one it would get.
  Plane planeOf(std::size_t slot) const;
  /// The same when it has been told all that the last search knows.
  Plane prepared(std::size_t slot) const;
  /// Whether all that there is to know of a slot are its faces, whether they have been looked at,
  /// and what lies at their edges. @param prepared of the slot
  bool isBare(std::size_t slot, const Plane& prepared) const;

  /// For the steps A to H, after which listWoken() is due. @param incremental closures are sums of
  /// increments
  PairTables forKernels(bool incremental);
  const JointLaw* laws() const { return laws_.data(); } ///< by joint card

  /// What a search has found, with planes where there are some and what is known of the others.
  /// @param faces that slots refer to; preparation: tells planes the rest when they come near
  void take(Slots slots, const Array<Face>& faces, Preparation preparation);
  /// Pairs that have not touched yet take over what living planes have to give now.
  void renew(std::shared_ptr<const Heritage> heritage);
  /// Without what the last search had left to tell: for the time of the next one.
  void forgetPreparation();
  /// Takes the planes of these slots away; a search has to follow, which does not find the pairs.
  void drop(const std::vector<std::size_t>& slots);

  /// The plane of a slot, made where there is none, and told what the last search knows. By any
  /// thread, each for slots of its own.
  Plane& wake(std::size_t slot);
  /// Planes that have been made since the last time into the list.
  void listWoken();

private:
  Plane freshPlane(std::size_t slot) const;
  Plane* newPlace();
  void list();

  const ContactRules* rules_;
  Real depthMax_;
  Slots slots_;
  Array<Face> faces_;
  PlaneList planes_;
  std::int64_t countedHere_ = 0;
  Preparation preparation_; ///< of the last search
  Array<JointLaw> laws_;    ///< by joint card
  // Planes made since the last search.
  std::mutex waking_;
  std::vector<std::unique_ptr<Plane[]>> woken_;
  std::size_t wokenCount_ = 0, wokenListed_ = 0;
  PassedOnChanges passedOn_;           ///< since pairs last learned what others pass on
  mutable bool gainsAreKnown_ = false; ///< of all slots
};
} // namespace coplane
