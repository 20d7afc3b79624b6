#include "SampleMeshes.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_exodus/ReadMesh.hpp>
#include <coplane_exodus/ResultsFile.hpp>

#include <exodusII.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <sys/resource.h>

namespace coplane
{
namespace
{
const ResultsVariables sampleVariables{
    {"displacement_x", "displacement_y"}, {"von_mises"}, {"energy_kinetic"}, {"slip"}};

// Values that tell step, variable and position apart, exactly representable.
Real nodalValue(int step, int variable, int node)
{
  return 1000 * step + 100 * variable + node;
}
Real elementValue(int step, int block, int element)
{
  return -1000 * step - 100 * block - element - 0.5;
}

Real sideValue(int step, int set, int position)
{
  return 0.125 + 1000 * step + 100 * set + position;
}

void writeStep(
    ResultsFile& results, int step, int blocks, const std::function<void()>& afterTheNodes = [] {})
{
  results.beginStep(0.25 * step);
  for (int variable = 0; variable < 2; ++variable)
  {
    std::vector<Real> mine;
    for (int i = 0; i < results.myNodes().count; ++i)
      mine.push_back(nodalValue(step, variable, results.myNodes().first + i));
    results.putNodal(variable, mine);
  }
  afterTheNodes();
  for (int block = 0; block < blocks; ++block)
  {
    std::vector<Real> mine;
    for (int i = 0; i < results.myElements(block).count; ++i)
      mine.push_back(elementValue(step, block, results.myElements(block).first + i));
    results.putElement(0, block, mine);
  }
  for (int set = 0; set < results.sideSets(); ++set)
  {
    std::vector<Real> mine;
    for (const int position : results.mySides(set))
      mine.push_back(sideValue(step, set, position));
    results.putSide(0, set, mine);
  }
  results.putGlobals({7.0 * step});
  results.endStep();
}

void writeSample(const std::string& file, const Comm& comm, bool filePerRank = false)
{
  const Mesh mesh = sampleMesh2d();
  ResultsFile results(file, comm, sliceOf(mesh, comm.rank(), comm.size()), sampleVariables,
                      {"backend: serial", std::string(100, 'x')}, filePerRank);
  for (int step = 0; step < 3; ++step)
    writeStep(results, step, int(mesh.blocks.size()));
  results.close();
}

/// An open results file for checks by rank 0.
class Results
{
public:
  explicit Results(const std::string& file)
  {
    int memoryWord = 8, fileWord = 0;
    float version = 0;
    exoid_ = ex_open(file.c_str(), EX_READ, &memoryWord, &fileWord, &version);
    EXPECT_GE(exoid_, 0) << file;
  }
  ~Results() { ex_close(exoid_); }
  int steps() const { return int(ex_inquire_int(exoid_, EX_INQ_TIME)); }
  std::vector<Real> values(int step, ex_entity_type type, int variable, int id, int count) const
  {
    std::vector<Real> list(count);
    EXPECT_GE(ex_get_var(exoid_, step + 1, type, variable + 1, id, count, list.data()), 0);
    return list;
  }
  Real time(int step) const
  {
    Real t = -1;
    ex_get_time(exoid_, step + 1, &t);
    return t;
  }
  int infoLines() const { return int(ex_inquire_int(exoid_, EX_INQ_INFO)); }

private:
  int exoid_;
};

void expectSampleSteps(const std::string& file, int steps)
{
  const Mesh mesh = sampleMesh2d();
  const Results results(file);
  ASSERT_EQ(results.steps(), steps);
  for (int step = 0; step < steps; ++step)
  {
    EXPECT_EQ(results.time(step), 0.25 * step);
    for (int variable = 0; variable < 2; ++variable)
    {
      const auto values = results.values(step, EX_NODAL, variable, 1, mesh.nodes());
      for (int node = 0; node < mesh.nodes(); ++node)
        EXPECT_EQ(values[node], nodalValue(step, variable, node));
    }
    for (int block = 0; block < 2; ++block)
    {
      const int n = mesh.blocks[block].elements();
      const auto values = results.values(step, EX_ELEM_BLOCK, 0, int(mesh.blocks[block].id), n);
      for (int e = 0; e < n; ++e)
        EXPECT_EQ(values[e], elementValue(step, block, e));
    }
    for (int set = 0; set < int(mesh.sideSets.size()); ++set)
    {
      const int n = int(mesh.sideSets[set].sides.size());
      const auto values = results.values(step, EX_SIDE_SET, 0, int(mesh.sideSets[set].id), n);
      for (int i = 0; i < n; ++i)
        EXPECT_EQ(values[i], sideValue(step, set, i));
    }
    EXPECT_EQ(results.values(step, EX_GLOBAL, 0, 1, 1)[0], 7.0 * step);
  }
}
} // namespace

TEST(ContiguousRange, rangesCoverAllItemsOnceAndKnowTheirRank)
{
  for (const int n : {0, 1, 3, 10})
    for (const int ranks : {1, 2, 4, 7})
    {
      int next = 0;
      for (int r = 0; r < ranks; ++r)
      {
        const IndexRange range = contiguousRange(n, r, ranks);
        EXPECT_EQ(range.first, next);
        for (int i = range.first; i < range.first + range.count; ++i)
          EXPECT_EQ(rankOfItem(i, n, ranks), r);
        next += range.count;
      }
      EXPECT_EQ(next, n);
    }
}

// 3 elements in blocks of 2 and 1: on 4 ranks most ranges are empty.
TEST(ResultsFile, whatAllRanksWroteIsReadBackEqual)
{
  const Comm comm;
  const std::string file = temporaryFile("results.e");
  writeSample(file, comm);
  if (comm.isRoot())
  {
    expectSampleSteps(file, 3);
    std::filesystem::remove(file);
  }
  comm.barrier();
}

TEST(ResultsFile, idsNamesSetsAndBodiesOfTheMeshAreKept)
{
  const Comm comm;
  const std::string file = temporaryFile("kept.e");
  writeSample(file, comm);
  if (comm.isRoot())
  {
    const Mesh mesh = sampleMesh2d(), read = readMesh(file);
    EXPECT_EQ(read.nodeIds, mesh.nodeIds);
    for (int b = 0; b < 2; ++b)
    {
      EXPECT_EQ(read.blocks[b].name, mesh.blocks[b].name);
      EXPECT_EQ(read.blocks[b].elementIds, mesh.blocks[b].elementIds);
      EXPECT_EQ(read.blocks[b].connectivity, mesh.blocks[b].connectivity);
      EXPECT_EQ(read.blocks[b].bodyIds, mesh.blocks[b].bodyIds);
    }
    EXPECT_EQ(read.nodeSets[0].nodes, mesh.nodeSets[0].nodes);
    EXPECT_EQ(read.sideSets[0].elements, mesh.sideSets[0].elements);
    EXPECT_EQ(read.sideSets[0].sides, mesh.sideSets[0].sides);
    ASSERT_EQ(read.qaRecords.size(), 2u);
    EXPECT_EQ(read.qaRecords[0], mesh.qaRecords[0]);
    EXPECT_EQ(read.qaRecords[1][0], "coplane");
    // "backend: serial", then 100 characters as 80 and "> " with the remaining 20.
    EXPECT_EQ(Results(file).infoLines(), 3);
    std::filesystem::remove(file);
  }
  comm.barrier();
}

TEST(ResultsFile, hexahedraAndIdsBeyond32BitsAreWritten)
{
  const Comm comm;
  const std::string file = temporaryFile("hexes.e");
  Mesh mesh = sampleMesh3d();
  mesh.nodeIds[3] = 5000000000;
  {
    ResultsFile results(file, comm, sliceOf(mesh, comm.rank(), comm.size()), sampleVariables, {});
    writeStep(results, 0, 1);
  }
  if (comm.isRoot())
  {
    EXPECT_EQ(readMesh(file).nodeIds, mesh.nodeIds);
    EXPECT_EQ(Results(file).values(0, EX_ELEM_BLOCK, 0, 1, 3)[2], elementValue(0, 0, 2));
    std::filesystem::remove(file);
  }
  comm.barrier();
}

TEST(ResultsFile, exodiffFindsNoDifferenceToTheFileOfOneRank)
{
  const Comm comm;
  const std::string many = temporaryFile("many.e"), one = temporaryFile("one.e");
  writeSample(many, comm);
  if (comm.isRoot())
  {
    writeSample(one, Comm(MPI_COMM_SELF));
    const std::string command = std::string(COPLANE_TRILINOS_BIN) +
                                "/exodiff -quiet -tolerance 0 -Floor 0 " + one + " " + many +
                                " > /dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0);
    std::filesystem::remove(one);
    std::filesystem::remove(many);
  }
  comm.barrier();
}

TEST(ResultsFile, filesPerRankJoinToTheSharedFile)
{
  const Comm comm;
  const std::string shared = temporaryFile("shared.e"), base = temporaryFile("split.e");
  writeSample(shared, comm);
  writeSample(base, comm, true);
  comm.barrier();
  if (comm.isRoot())
  {
    const std::filesystem::path first = base + "." + std::to_string(comm.size()) + ".0";
    ASSERT_TRUE(std::filesystem::exists(first));
    const std::string folder = first.parent_path().string();
    const std::string bin = COPLANE_TRILINOS_BIN;
    if (comm.size() == 1) // for which epu does nothing
      std::filesystem::copy(first, base);
    else
      EXPECT_EQ(std::system(("cd " + folder + " && " + bin + "/epu -auto " +
                             first.filename().string() + " > /dev/null")
                                .c_str()),
                0);
    // epu sorts by ids; -map compares entities by place.
    EXPECT_EQ(std::system((bin + "/exodiff -quiet -map -tolerance 0 -Floor 0 " + shared + " " +
                           base + " > /dev/null")
                              .c_str()),
              0);
  }
  comm.barrier();
  std::filesystem::remove(base + "." + std::to_string(comm.size()) + "." +
                          std::to_string(comm.rank()));
  if (comm.isRoot())
  {
    std::filesystem::remove(shared);
    std::filesystem::remove(base);
  }
}

TEST(ResultsFile, aMissingFolderIsAnOutputErrorOnAllRanks)
{
  const Comm comm;
  try
  {
    ResultsFile("/no/such/folder/results.e", comm,
                sliceOf(sampleMesh2d(), comm.rank(), comm.size()), sampleVariables, {});
    FAIL() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Output);
    EXPECT_EQ(
        std::string(error.what()),
        "/no/such/folder/results.e: the results file cannot be created: No such file or directory. "
        "Check that the folder '/no/such/folder' exists and can be written to.");
  }
}

namespace
{
/// Text of the error that all ranks get when the disk is full after three steps; a file-size limit
/// imitates the full disk.
std::string errorOfFullDisk(const std::string& base, const Comm& comm, bool filePerRank,
                            std::string& file)
{
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  std::string text = "no error";
  int finished = 0;
  {
    const Mesh mesh = sampleMesh2d();
    ResultsFile results(base, comm, sliceOf(mesh, comm.rank(), comm.size()), sampleVariables, {},
                        filePerRank);
    file = results.file();
    for (; finished < 3; ++finished)
      writeStep(results, finished, 2);
    comm.barrier();
    const rlimit limit{rlim_t(std::filesystem::file_size(file)) + 64, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    try
    {
      for (int step = 3; step < 6; ++step)
        writeStep(results, step, 2);
    }
    catch (const Error& error)
    {
      EXPECT_EQ(error.code(), ExitCode::Output);
      text = error.what();
    }
  }
  setrlimit(RLIMIT_FSIZE, &before);
  return text;
}
} // namespace

TEST(ResultsFile, aFullDiskIsAnErrorOnAllRanksAndFinishedStepsStay)
{
  const Comm comm;
  std::string file;
  const std::string text = errorOfFullDisk(temporaryFile("full.e"), comm, false, file);
  EXPECT_NE(text.find(file + ": writing the step at t = 0.75 s failed on rank 0: reserving "),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("File too large. The file keeps 3 finished time steps."), std::string::npos)
      << text;
  if (comm.isRoot())
  {
    expectSampleSteps(file, 3);
    std::filesystem::remove(file);
  }
  comm.barrier();
}

TEST(ResultsFile, aFullDiskIsAnErrorWithAFilePerRankToo)
{
  const Comm comm;
  std::string file;
  const std::string text = errorOfFullDisk(temporaryFile("fullsplit.e"), comm, true, file);
  EXPECT_NE(text.find(": writing the step at t = 0."), std::string::npos) << text;
  EXPECT_NE(text.find("The file keeps 3 finished time steps."), std::string::npos) << text;
  EXPECT_EQ(Results(file).steps(), 3);
  std::filesystem::remove(file);
}

TEST(ResultsFile, aFileThatIsCutOffIsToldAlsoWhileAStepIsWritten)
{
  const Comm comm;
  const std::string file = temporaryFile("cut.e");
  const Mesh mesh = sampleMesh2d();
  logSetup(comm.isRoot(), false);
  enum class Cut
  {
    Never,
    Between,
    Within
  };
  for (const Cut when : {Cut::Never, Cut::Between, Cut::Within})
  {
    ResultsFile results(file, comm, sliceOf(mesh, comm.rank(), comm.size()), sampleVariables, {});
    writeStep(results, 1, int(mesh.blocks.size()));
    testing::internal::CaptureStderr();
    const auto cutOff = [&]
    {
      comm.barrier();
      if (comm.isRoot())
        std::filesystem::resize_file(file, std::filesystem::file_size(file) / 4);
      comm.barrier();
    };
    if (when == Cut::Between)
      cutOff();
    writeStep(
        results, 2, int(mesh.blocks.size()),
        when == Cut::Within ? std::function<void()>(cutOff) : [] {});
    results.close();
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_EQ(said.find("somebody cut off the file") != std::string::npos,
              comm.isRoot() && when != Cut::Never)
        << int(when) << said;
  }
  if (comm.isRoot())
    std::filesystem::remove(file);
  comm.barrier();
}
} // namespace coplane
