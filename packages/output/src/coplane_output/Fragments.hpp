#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_core/Vec3.hpp>
#include <coplane_dynamics/Observer.hpp>
#include <coplane_output/OutputSchedule.hpp>

#include <map>
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
struct Fragments
{
  std::vector<std::vector<GlobalId>> ofElement; ///< [block][element] of this rank; 0: of none
  std::vector<Fragment> all;                    ///< by id, the same on every rank
};

/// Elements are connected where they share a node, and where a declared joint between them still
/// has a bond. Dead elements, and those whose `damage` has reached the threshold, connect nothing
/// and belong to no body. The same bits on any ranks. Collective.
Fragments findFragments(const Solver& solver, Real damage);

struct FragmentsOptions
{
  std::string file; ///< CSV
  OutputTimes when;
  Real damage = 0.99;                                ///< from which an element connects nothing [-]
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
