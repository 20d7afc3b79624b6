#pragma once

#include <coplane_contact/ContactRules.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_core/Backend.hpp>

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace coplane
{
struct PairTables;
class Preparation;

/// The slots of the last search with their planes, sorted by key, and beside them the tables that
/// every cycle looks through.
class PlaneTable
{
public:
  using Planes = Kokkos::View<Plane*, Kokkos::HostSpace>;
  using Slots = Kokkos::View<SlotFaces*, Kokkos::HostSpace>;
  using Todos = Array<std::uint8_t>; ///< by slot: what it has not been told yet (Preparation::Todo)

  explicit PlaneTable(const ContactRules& rules);

  const Planes& planes() const { return planes_; }
  std::size_t count() const { return planes_.extent(0); }
  const Slots& slotFaces() const { return slotFaces_; }
  const Array<Activity>& activity() const { return activity_; }
  /// Whether planes have changed what they pass on since the last search.
  bool passedOnHasChanged() const { return passedOnHasChanged_; }

  /// For the steps A to H. @param incremental closures are sums of increments
  PairTables forKernels(bool incremental);

  /// What a search has found; `preparation` tells planes the rest when they come near.
  void take(const Planes& planes, const Todos& todo,
            std::shared_ptr<const Preparation> preparation);
  /// Planes that know everything already, of a checkpoint.
  void take(const Planes& planes) { take(planes, {}, nullptr); }
  /// Without what the last search had left to tell: for the time of the next one.
  void forgetPreparation();
  /// Leaves those at these places only; a search has to follow, which tells them anew.
  void keepOnly(const std::vector<std::size_t>& places);
  /// Tells all planes what the last search knows of them.
  void prepareAll();
  /// A plane as it is when it has been told: not the same for those that nothing has come near yet.
  Plane prepared(std::size_t p) const;

private:
  Planes planes_;
  Slots slotFaces_;
  Array<Activity> activity_;
  Todos todo_;
  std::shared_ptr<const Preparation> preparation_; ///< of the last search
  Array<JointLaw> laws_;                           ///< by joint card
  std::atomic<bool> passedOnHasChanged_{false};
};
} // namespace coplane
