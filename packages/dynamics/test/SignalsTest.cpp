#include "Rig.hpp"

#include <coplane_dynamics/Signals.hpp>

#include <gtest/gtest.h>

#include <csignal>

namespace coplane
{
namespace
{
/// Sends this process a signal at the end of one cycle and notes the cycles with requested results.
struct Signaller : Recorder
{
  int signal;
  bool sends;
  std::vector<std::int64_t> requested;
  Signaller(int s, bool here) : signal(s), sends(here) {}
  void endOfCycle(const Solver& solver) override
  {
    Recorder::endOfCycle(solver);
    if (solver.resultsRequested())
      requested.push_back(solver.clock().cycle);
    if (sends && solver.clock().cycle == 3)
      std::raise(signal);
  }
};

Model shortRun(const Comm& comm)
{
  Model model = rockModel(unitBox(1, 1, 1), comm);
  model.time.fixedStep = 1e-4;
  model.time.end = 9.5e-4; // 10 cycles
  return model;
}
} // namespace

TEST(TakeRequests, tellsEachSignalOnce)
{
  std::signal(SIGHUP, SIG_DFL); // the tests may run under nohup
  listenToSignals();
  const auto all = [](bool results, bool checkpoint, bool stop) {
    return Requests{results, checkpoint, stop};
  };
  EXPECT_EQ(takeRequests(), all(false, false, false));
  std::raise(SIGUSR1);
  EXPECT_EQ(takeRequests(), all(true, true, false));
  EXPECT_EQ(takeRequests(), all(false, false, false));
  std::raise(SIGUSR2);
  EXPECT_EQ(takeRequests(), all(false, true, true));
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU})
  {
    std::raise(signal);
    EXPECT_EQ(takeRequests(), all(false, false, true)) << "signal " << signal;
    EXPECT_EQ(takeRequests(), all(false, false, false));
  }
}

TEST(TakeRequests, aTerminalThatClosesIsIgnoredUnderNohup)
{
  const auto before = std::signal(SIGHUP, SIG_IGN);
  listenToSignals();
  std::raise(SIGHUP);
  EXPECT_EQ(takeRequests(), Requests{});
  std::signal(SIGHUP, before);
}

TEST(TakeRequests, whatIsHeldComesWhenItIsListenedTo)
{
  // As a library does that begins in between.
  const auto lost = [](int) {};
  holdRequests();
  std::signal(SIGUSR2, lost);
  std::raise(SIGUSR2);
  listenToRequests();
  EXPECT_EQ(takeRequests(), (Requests{false, true, true}));
}

TEST(TakeRequests, addsUpWhatSignalsAndObserversAskFor)
{
  listenToSignals();
  std::raise(SIGTERM);
  request({true, false, false});
  EXPECT_EQ(takeRequests(), (Requests{true, false, true}));
  EXPECT_EQ(takeRequests(), Requests{});
}

TEST(Run, doesInTheFirstCycleWhatWasAskedForBeforeIt)
{
  const Comm comm;
  listenToRequests();
  if (comm.rank() == comm.size() - 1)
    std::raise(SIGUSR2);
  Solver solver(shortRun(comm), comm);
  solver.prepare();
  Recorder observer;
  EXPECT_EQ(solver.run(observer), ExitCode::Resumable);
  EXPECT_EQ(solver.clock().cycle, 1);
}

TEST(Run, withoutSignalsCompletes)
{
  const Comm comm;
  Solver solver(shortRun(comm), comm);
  solver.prepare();
  Recorder observer;
  EXPECT_EQ(solver.run(observer), ExitCode::Success);
  EXPECT_EQ(observer.starts, 1);
  EXPECT_EQ(observer.ends, 10);
  EXPECT_EQ(observer.ending.how, "completed");
}

TEST(Run, stopsOnAllRanksWhenOneOfThemIsToldTo)
{
  // The signal comes after cycle 3; the end of cycle 4 hears of it.
  listenToSignals();
  const Comm comm;
  Solver solver(shortRun(comm), comm);
  solver.prepare();
  Signaller observer(SIGTERM, comm.rank() == comm.size() - 1);
  EXPECT_EQ(solver.run(observer), ExitCode::Interrupted);
  EXPECT_EQ(observer.ends, 4);
  EXPECT_EQ(observer.ending.how, "interrupted");
}

TEST(Run, endsOnAllRanksToGoOnLaterWhenOneOfThemIsToldTo)
{
  listenToSignals();
  const Comm comm;
  Solver solver(shortRun(comm), comm);
  solver.prepare();
  Signaller observer(SIGUSR2, comm.rank() == comm.size() - 1);
  EXPECT_EQ(solver.run(observer), ExitCode::Resumable);
  EXPECT_TRUE(solver.checkpointRequested());
  EXPECT_EQ(observer.ends, 4);
}

TEST(Run, asksAllRanksForResultsInTheSameCycle)
{
  listenToSignals();
  const Comm comm;
  Solver solver(shortRun(comm), comm);
  solver.prepare();
  Signaller observer(SIGUSR1, comm.rank() == comm.size() - 1);
  EXPECT_EQ(solver.run(observer), ExitCode::Success);
  EXPECT_EQ(observer.ends, 10);
  EXPECT_EQ(observer.requested, (std::vector<std::int64_t>{4}));
}
} // namespace coplane
