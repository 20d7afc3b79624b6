#include "TwoCubes.hpp"

#include <coplane_core/DraftName.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_output/HistoryObserver.hpp>
#include <coplane_output/MultiObserver.hpp>
#include <coplane_output/PlanesObserver.hpp>
#include <coplane_output/ResultsObserver.hpp>
#include <coplane_output/TablesObserver.hpp>

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <new>
#include <sys/resource.h>

namespace coplane
{
namespace
{
const std::string nowhere = "/nowhere/to/be/found/";

/// Every rank must get the error, with the file and the system's reason.
template <class F>
void expectOutputError(const F& action, const std::string& file)
{
  try
  {
    action();
    ADD_FAILURE() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Output);
    EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("No such file or directory"), std::string::npos)
        << error.what();
  }
}

struct Recorder : Observer
{
  enum class End
  {
    Well,
    ErrorOfAllRanks,
    OwnError,
    OwnMemory
  };
  std::string& calls;
  End end;
  Recorder(std::string& c, End e) : calls(c), end(e) {}
  void start(const Solver&) override { calls += "s"; }
  void endOfCycle(const Solver&) override { calls += "c"; }
  void finish(const Solver&, const std::string&) override
  {
    calls += "f";
    if (end == End::ErrorOfAllRanks)
      failOnAllRanks(ExitCode::Output, "disk full");
    if (end == End::OwnError)
      fail(ExitCode::Output, "disk full");
    if (end == End::OwnMemory)
      throw std::bad_alloc();
  }
};
} // namespace

TEST(MissingFolder, ofResultsIsAnErrorOnAllRanks)
{
  const Comm comm;
  const ResultsOptions options{nowhere + "a.e", {}, false, {}};
  const MeshSlice slice = sliceOf(twoCubes(), comm.rank(), comm.size());
  expectOutputError([&] { ResultsObserver(comm, slice, options); }, nowhere + "a.e");
}

TEST(MissingFolder, ofPlanesIsAnErrorOnAllRanks)
{
  const Comm comm;
  expectOutputError([&] { PlanesObserver(comm, {nowhere + "a", {}}); }, nowhere + "a_planes.pvd");
}

TEST(MissingFolder, ofTheHistoryIsAnErrorOnAllRanks)
{
  const Comm comm;
  const HistoryOptions options{nowhere + "a.csv", 0, {}, {}, false};
  expectOutputError([&] { HistoryObserver(comm, options); }, nowhere + "a.csv");
}

TEST(MissingFolder, ofTheTablesIsAnErrorOnAllRanks)
{
  const Comm comm;
  const TablesOptions options{nowhere + "a", 0, true, false};
  expectOutputError([&] { TablesObserver(comm, options); }, nowhere + "a_blocks.csv");
}

TEST(ReplaceFile, leavesNoDraftBehind)
{
  const Comm comm;
  const TestFolder folder(comm);
  if (comm.isRoot())
  {
    replaceFile(folder / "a.txt", "first");
    replaceFile(folder / "a.txt", "second");
    EXPECT_EQ(contentOf(folder / "a.txt"), "second");
    EXPECT_FALSE(std::filesystem::exists(draftOf(folder / "a.txt")));
  }
}

TEST(ReplaceFile, aFileThatIsTooLargeIsAnErrorAndKeepsTheOldText)
{
  const Comm comm;
  const TestFolder folder(comm);
  if (!comm.isRoot())
    GTEST_SKIP() << "rank 0 writes";
  replaceFile(folder / "a.txt", "old");
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto signalBefore = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 1000;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string said;
  try
  {
    replaceFile(folder / "a.txt", std::string(100000, 'x'));
  }
  catch (const Error& error)
  {
    said = error.what();
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, signalBefore);
  EXPECT_NE(said.find("File too large"), std::string::npos) << said;
  EXPECT_EQ(contentOf(folder / "a.txt"), "old");
  EXPECT_FALSE(std::filesystem::exists(draftOf(folder / "a.txt")));
}

TEST(MultiObserver, finishesAllObserversWhenOneFailsAndThrowsItsError)
{
  const Comm comm;
  const Mesh mesh = twoCubes();
  const Solver solver(cubesInContact(mesh, comm), comm);
  std::string calls;
  MultiObserver observers;
  observers.add(std::make_unique<Recorder>(calls, Recorder::End::Well));
  observers.add(
      std::make_unique<Recorder>(calls, Recorder::End::ErrorOfAllRanks)); // is the first to finish
  observers.start(solver);
  observers.endOfCycle(solver);
  EXPECT_THROW(observers.finish(solver, "completed"), Error);
  EXPECT_EQ(calls, "ssccff");
}

TEST(MultiObserver, anErrorOfOneRankLeavesAtOnce)
{
  // The other ranks are still in this observer: what the next one would send is not for them.
  const Comm comm;
  const Mesh mesh = twoCubes();
  const Solver solver(cubesInContact(mesh, comm), comm);
  for (const Recorder::End end : {Recorder::End::OwnError, Recorder::End::OwnMemory})
  {
    std::string calls;
    MultiObserver observers;
    observers.add(std::make_unique<Recorder>(calls, Recorder::End::Well));
    observers.add(std::make_unique<Recorder>(calls, end)); // is the first to finish
    EXPECT_THROW(observers.finish(solver, "completed"), std::exception);
    EXPECT_EQ(calls, "f");
  }
}
} // namespace coplane
