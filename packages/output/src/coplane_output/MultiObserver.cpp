#include <coplane_core/Error.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_output/MultiObserver.hpp>

#include <exception>

namespace coplane
{
void MultiObserver::add(std::unique_ptr<Observer> observer)
{
  observers_.push_back(std::move(observer));
}

void MultiObserver::start(const Solver& solver)
{
  for (const auto& observer : observers_)
    observer->start(solver);
}

void MultiObserver::endOfCycle(const Solver& solver)
{
  for (const auto& observer : observers_)
    observer->endOfCycle(solver);
}

void MultiObserver::repartitioned(const Solver& solver)
{
  for (const auto& observer : observers_)
    observer->repartitioned(solver);
}

void MultiObserver::savePosition(std::map<std::string, std::string>& positions) const
{
  for (const auto& observer : observers_)
    observer->savePosition(positions);
}

void MultiObserver::finish(const Solver& solver, const Ending& ending)
{
  // After an error of all ranks all go on with the next observer. One of this rank alone leaves at
  // once: the others are still in this observer, and what the next one would send is not for them.
  std::exception_ptr first;
  Ending now = ending;
  // Backwards: a checkpoint at the end has to know where outputs ended before their last lines.
  for (auto observer = observers_.rbegin(); observer != observers_.rend(); ++observer)
    try
    {
      (*observer)->finish(solver, now);
    }
    catch (const Error& error)
    {
      if (!error.onAllRanks())
        throw;
      if (!first)
        first = std::current_exception();
      else
        logError(error.what());
      if (now.how != "failed")
        now = {"failed", error.code(), error.what()};
    }
  if (first)
    std::rethrow_exception(first);
}
} // namespace coplane
