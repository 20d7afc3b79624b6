#include "TwoCubes.hpp"

#include <coplane_output/ResultsObserver.hpp>
#include <coplane_output/TextFile.hpp>

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
    first.finish(solver, "completed");
  }
  if (comm.isRoot())
    for (const int part : {2, 3, 4})
      replaceFile(resultsPart(file, part), "of a run that was left behind");
  comm.barrier();
  options.part = 3;
  options.position = positions.at("results");
  const ResultsObserver third(comm, slice, options);
  comm.barrier();
  EXPECT_TRUE(std::filesystem::exists(file));
  for (const int part : {2, 3, 4})
    EXPECT_FALSE(std::filesystem::exists(resultsPart(file, part))) << part;
}
} // namespace coplane
