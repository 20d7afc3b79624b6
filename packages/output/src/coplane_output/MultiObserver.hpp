#pragma once

#include <coplane_dynamics/Observer.hpp>

#include <memory>
#include <string>
#include <vector>

namespace coplane
{
/// Forwards every call to its observers in the order in which they were added, finish() the other
/// way round.
class MultiObserver : public Observer
{
public:
  void add(std::unique_ptr<Observer> observer);

  void start(const Solver& solver) override;
  void endOfCycle(const Solver& solver) override;
  void repartitioned(const Solver& solver) override;
  void savePosition(std::map<std::string, std::string>& positions) const override;
  /// Finishes all observers even when one fails, then throws the first error.
  void finish(const Solver& solver, const Ending& ending) override;

private:
  std::vector<std::unique_ptr<Observer>> observers_;
};
} // namespace coplane
