#pragma once

#include <coplane_core/Error.hpp>

#include <map>
#include <string>

namespace coplane
{
class Solver;

/// How a run ended.
struct Ending
{
  std::string how = "completed"; ///< or "interrupted", "interrupted after a checkpoint", "failed"
  ExitCode code = ExitCode::Success;
  std::string reason = {}; ///< why it failed
};

/// Looks at the solver at the end of cycles and never changes it. Calls that take the solver
/// are collective: every rank makes each of them.
class Observer
{
public:
  virtual ~Observer() = default;
  /// The state at t = 0, before the first cycle.
  virtual void start(const Solver& solver) = 0;
  virtual void endOfCycle(const Solver& solver) = 0;
  /// The ranks have other parts of the mesh now: what is kept by local number has to be found anew.
  virtual void repartitioned(const Solver&) {}
  /// Puts down by name what another run has to know to go on with this output, on any rank.
  virtual void savePosition(std::map<std::string, std::string>&) const {}
  /// After the last cycle, also when the run failed or was interrupted.
  virtual void finish(const Solver& solver, const Ending& ending) = 0;
};
} // namespace coplane
