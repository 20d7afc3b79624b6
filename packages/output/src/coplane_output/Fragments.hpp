#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_core/Vec3.hpp>
#include <coplane_dynamics/Observer.hpp>
#include <coplane_output/OutputSchedule.hpp>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace coplane
{
/// A connected body, or what belongs to none.
struct Fragment
{
  GlobalId id = 0; ///< least id of its elements; 0: elements that are dead or crushed
  std::int64_t elements = 0;
  Real mass = 0; ///< of its elements, at their nodes [kg]
  Vec3 center{}, velocity{};
  Vec3 angularMomentum{}; ///< about its centre [kg m^2/s]
  Vec3 spin{};            ///< angular velocity of a rigid body with this momentum [rad/s]
  Vec3 lowest{}, highest{};
};

/// The bodies at the end of a cycle.
struct ConnectedBodies
{
  std::vector<std::vector<GlobalId>> ofElement; ///< [block][element] of this rank; 0: of none
  std::vector<GlobalId> onSeveralRanks; ///< of those here, ascending: that others may have, too
};

/// Elements are connected where they share a node, and where a declared joint between them still
/// has a bond that carries. Dead elements, and those whose `damage` has reached the threshold,
/// connect nothing and belong to no body. The same bits on any ranks. Collective.
ConnectedBodies findBodies(const Solver& solver, Real damage);

/// Sums over each body, by id, on rank 0; nothing on the others. The same bits on any ranks.
/// Collective.
std::vector<Fragment> sumsOf(const Solver& solver, const ConnectedBodies& bodies);

/// Finds the bodies once in a cycle, for all outputs that ask.
class BodiesOfCycle
{
public:
  explicit BodiesOfCycle(Real damage) : damage_(damage) {}
  /// Collective when it is the first call of a cycle.
  const ConnectedBodies& at(const Solver& solver);
  /// The ranks have other elements now.
  void forget() { cycle_ = -1; }

private:
  Real damage_; ///< from which an element connects nothing [-]
  std::int64_t cycle_ = -1;
  ConnectedBodies bodies_;
};

struct FragmentsOptions
{
  std::string file; ///< CSV
  OutputTimes when;
  std::shared_ptr<BodiesOfCycle> bodies;
  std::map<std::string, std::string> positions = {}; ///< of the run that is continued
};

/// Writes a line for every fragment at each output time.
class FragmentsObserver : public Observer
{
public:
  /// Creates the file. Collective.
  FragmentsObserver(const Comm& comm, FragmentsOptions options);

  void start(const Solver& solver) override;
  void endOfCycle(const Solver& solver) override;
  void endOfStage(const Solver& solver) override;
  void repartitioned(const Solver&) override { options_.bodies->forget(); }
  void savePosition(std::map<std::string, std::string>& positions) const override;
  void finish(const Solver& solver, const Ending& ending) override;

private:
  void write(const Solver& solver); ///< collective

  FragmentsOptions options_;
  OutputSchedule schedule_;
  TextTable table_;             ///< open on rank 0
  std::int64_t lastCycle_ = -1; ///< that was written
};
} // namespace coplane
