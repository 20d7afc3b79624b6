#include "TwoCubes.hpp"

#include <coplane_core/DraftName.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_output/HistoryObserver.hpp>
#include <coplane_output/MultiObserver.hpp>
#include <coplane_output/PlanesObserver.hpp>
#include <coplane_output/ResultsObserver.hpp>
#include <coplane_output/RunRecord.hpp>
#include <coplane_output/TablesObserver.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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
  Ending ended = {};
  Recorder(std::string& c, End e) : calls(c), end(e) {}
  void start(const Solver&) override { calls += "s"; }
  void endOfCycle(const Solver&) override { calls += "c"; }
  void finish(const Solver&, const Ending& ending) override
  {
    ended = ending;
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
  expectOutputError([&] { PlanesObserver(comm, {nowhere + "a", {}}); }, nowhere + "a_planes.xmf3");
  PlanesOptions inManyFiles;
  inManyFiles.base = nowhere + "a";
  inManyFiles.format = PlanesFormat::Vtp;
  expectOutputError([&] { PlanesObserver(comm, inManyFiles); }, nowhere + "a_planes.pvd");
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

TEST(PlanesInOneFile, loseNoStepOnADiskThatIsFullForAWhile)
{
  const Comm world;
  const TestFolder folder(world);
  if (!world.isRoot())
    GTEST_SKIP() << "one rank is enough";
  const Comm comm(MPI_COMM_SELF);
  const Mesh mesh = twoCubes();
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto signalBefore = std::signal(SIGXFSZ, SIG_IGN);
  // A step in every cycle until one fails, or so many; then the end, with room again.
  const auto run = [&](const std::string& base, rlim_t most, int& cycles)
  {
    Solver solver(cubesInContact(mesh, comm), comm);
    PlanesOptions options;
    options.base = folder / base;
    options.when.every = 1e-12;
    options.format = PlanesFormat::VtkHdf;
    PlanesObserver planes(comm, options);
    solver.prepare();
    planes.start(solver);
    rlimit limit = before;
    limit.rlim_cur = most;
    EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
    std::string said;
    int done = 0;
    try
    {
      while (done < cycles)
      {
        solver.advance();
        ++done;
        planes.endOfCycle(solver);
      }
    }
    catch (const Error& error)
    {
      said = error.what();
    }
    EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    planes.finish(solver, {});
    cycles = done;
    return said;
  };
  for (const rlim_t most : {60000, 100000, 200000, 300000})
  {
    int cycles = 100;
    const std::string said = run("limited", most, cycles);
    EXPECT_NE(said.find("limited_planes."), std::string::npos) << said;
    EXPECT_NE(said.find("File too large"), std::string::npos) << said;
    EXPECT_EQ(run("free", before.rlim_cur, cycles), "");
    EXPECT_TRUE(contentOf(folder / "limited_planes.vtkhdf") ==
                contentOf(folder / "free_planes.vtkhdf"))
        << most << " bytes, " << cycles << " cycles";
  }
  std::signal(SIGXFSZ, signalBefore);
}

TEST(RunRecord, thatCannotBeRenewedIsAWarningAndIsRenewedWhenThereIsRoom)
{
  const Comm world;
  const TestFolder folder(world);
  if (!world.isRoot())
    GTEST_SKIP() << "one rank is enough";
  const Comm comm(MPI_COMM_SELF);
  Solver solver(cubesInContact(twoCubes(), comm), comm);
  solver.prepare();
  RunRecord record(comm, {folder / "a.run.json", "two cubes", "test", "a.yaml", "abc", "a.g"});
  record.start(solver);
  const auto read = [&] { return nlohmann::json::parse(contentOf(folder / "a.run.json")); };
  const std::string before = contentOf(folder / "a.run.json");
  rlimit limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  rlimit small = limit;
  small.rlim_cur = 100;
  const auto signalBefore = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  record.noteLimit("something else");
  EXPECT_NO_THROW(record.renew(3));
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, signalBefore);
  EXPECT_EQ(contentOf(folder / "a.run.json"), before);
  EXPECT_FALSE(std::filesystem::exists(draftOf(folder / "a.run.json")));
  record.renew(2);
  const auto renewed = read();
  EXPECT_EQ(renewed["ending"], "running");
  EXPECT_EQ(renewed["seconds_left"], 2);
  EXPECT_EQ(renewed["warnings"]["the record was not renewed"], 1);
  EXPECT_NE(renewed["messages"].back().get<std::string>().find("File too large"),
            std::string::npos);
  ASSERT_EQ(renewed["step_limits"].size(), 2U);
  EXPECT_EQ(renewed["step_limits"][1]["limited_by"], "something else");
  record.finish(solver, {"failed", ExitCode::Computation, "it broke"});
  const auto ended = read();
  EXPECT_EQ(ended["ending"], "failed");
  EXPECT_EQ(ended["exit_code"], 6);
  EXPECT_EQ(ended["reason"], "it broke");
  EXPECT_FALSE(ended.contains("seconds_left"));
  EXPECT_EQ(ended["step_limits"][0]["limited_by"], "something else"); // the other one was seen last
  EXPECT_EQ(ended["step_limits"][1]["looks"], 2);
}

TEST(RunRecord, keepsTheLastOfManyLimits)
{
  const Comm world;
  const TestFolder folder(world);
  if (!world.isRoot())
    GTEST_SKIP() << "one rank is enough";
  const Comm comm(MPI_COMM_SELF);
  Solver solver(cubesInContact(twoCubes(), comm), comm);
  solver.prepare();
  RunRecord record(comm, {folder / "a.run.json", "two cubes", "test", "a.yaml", "abc", "a.g"});
  record.start(solver);
  for (int n = 0; n < 100; ++n)
    record.noteLimit(std::to_string(n));
  record.renew(infinity);
  const auto json = nlohmann::json::parse(contentOf(folder / "a.run.json"));
  ASSERT_EQ(json["step_limits"].size(), 50U);
  EXPECT_EQ(json["step_limits"][0]["limited_by"], "50");
  EXPECT_EQ(json["step_limits"][49]["limited_by"], "99");
  EXPECT_FALSE(json.contains("seconds_left"));
}

TEST(MultiObserver, finishesAllObserversWhenOneFailsAndThrowsItsError)
{
  const Comm comm;
  const Mesh mesh = twoCubes();
  const Solver solver(cubesInContact(mesh, comm), comm);
  std::string calls;
  MultiObserver observers;
  auto record = std::make_unique<Recorder>(calls, Recorder::End::Well);
  const Recorder& last = *record;
  observers.add(std::move(record));
  observers.add(
      std::make_unique<Recorder>(calls, Recorder::End::ErrorOfAllRanks)); // is the first to finish
  observers.start(solver);
  observers.endOfCycle(solver);
  EXPECT_THROW(observers.finish(solver, {}), Error);
  EXPECT_EQ(calls, "ssccff");
  EXPECT_EQ(last.ended.how, "failed"); // so that a record does not say that all went well
  EXPECT_EQ(last.ended.code, ExitCode::Output);
  EXPECT_EQ(last.ended.reason, "disk full");
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
    EXPECT_THROW(observers.finish(solver, {}), std::exception);
    EXPECT_EQ(calls, "f");
  }
}
} // namespace coplane
