#include "TwoCubes.hpp"

#include <coplane_core/TextFile.hpp>
#include <coplane_output/ResultsObserver.hpp>

#include <gtest/gtest.h>

namespace coplane
{
TEST(Series, aRestartLeavesOnlyThePartsThatItsCheckpointKnows)
{
  // The second part wrote a checkpoint before its first step, then a step, and was killed. The
  // restart is the third part, and what it goes on from is the end of the first.
  const Comm comm;
  const TestFolder folder(comm);
  const Mesh mesh = twoCubes();
  const MeshSlice slice = sliceOf(mesh, comm.rank(), comm.size());
  Solver solver(cubesInContact(mesh, comm), comm);
  solver.prepare();
  const std::string file = folder / "a.e";
  ResultsOptions options;
  options.file = file;
  std::map<std::string, std::string> positions;
  {
    ResultsObserver first(comm, slice, options);
    first.start(solver);
    first.savePosition(positions);
    first.finish(solver, {});
  }
  const std::string foreign = resultsPart(file, 4), text = "of the user, who calls files so";
  if (comm.isRoot())
  {
    std::filesystem::copy_file(file, resultsPart(file, 2)); // of a run that was left behind
    replaceFile(resultsPart(file, 3), "");                  // of one that was killed at once
    replaceFile(foreign, text);
  }
  comm.barrier();
  options.part = 3;
  options.position = positions.at("results");
  const ResultsObserver third(comm, slice, options);
  comm.barrier();
  EXPECT_TRUE(std::filesystem::exists(file));
  for (const int part : {2, 3, 4})
    EXPECT_FALSE(std::filesystem::exists(resultsPart(file, part))) << part;
  int kept = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    if (entry.path().string().rfind(foreign + ".old-", 0) == 0)
    {
      EXPECT_EQ(contentOf(entry.path()), text);
      ++kept;
    }
  EXPECT_EQ(kept, 1);
}

TEST(TextTable, tellsThatLinesWereCutOffAndGoesOnAtTheEnd)
{
  const TestFolder folder(Comm::alone());
  const std::string file = folder / "a.csv";
  TextTable table;
  EXPECT_FALSE(table.open(file, "a,b", {}));
  table.add("time\n");
  table.add("0.5\n");
  const TextPosition position = table.position(3);
  EXPECT_EQ(position.bytes, 9u);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  table.position(3);
  EXPECT_EQ(testing::internal::GetCapturedStderr() + testing::internal::GetCapturedStdout(), "");
  std::filesystem::resize_file(file, 2);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_EQ(table.position(3).bytes, 2u);
  const std::string said =
      testing::internal::GetCapturedStderr() + testing::internal::GetCapturedStdout();
  const bool speaks = Comm().isRoot();
  EXPECT_EQ(said.find("(2 of 9 bytes)") != std::string::npos, speaks) << said;
  table.add("1\n");
  EXPECT_EQ(contentOf(file), "ti1\n");

  // A restart from the checkpoint before finds its lines gone; one under another name begins anew.
  TextTable again;
  EXPECT_FALSE(again.open(file, "a,b", position));
  EXPECT_EQ(contentOf(file), "");
  again.add("time\n0.5\n1\n");
  TextTable third;
  EXPECT_TRUE(third.open(file, "a,b", position));
  EXPECT_EQ(contentOf(file), "time\n0.5\n");
}
} // namespace coplane
