// results_writer write <file>          writes steps until it is killed; prints "pid <n>" per rank
// and "step <n>" for each finished step results_writer check <file> <steps>  0 if the file holds at
// least the first <steps> steps, complete
#include <coplane_core/Comm.hpp>
#include <coplane_exodus/ReadMesh.hpp>
#include <coplane_exodus/ResultsFile.hpp>

#include <exodusII.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <unistd.h>

using namespace coplane;

namespace
{
constexpr int elements = 50000;

/// A row of squares: 0.4 MB per variable.
Mesh rowOfSquares()
{
  Mesh mesh;
  mesh.dimension = 2;
  Mesh::Block block{1, "row", ElementType::Quad4, {}, {}, {}};
  for (int i = 0; i <= elements; ++i)
    for (int j = 0; j < 2; ++j)
    {
      mesh.nodeIds.push_back(GlobalId(mesh.nodeIds.size()) + 1);
      mesh.coordinates.push_back({Real(i), Real(j), 0});
    }
  for (int e = 0; e < elements; ++e)
  {
    block.elementIds.push_back(e + 1);
    block.bodyIds.push_back(1);
    block.connectivity.insert(block.connectivity.end(), {2 * e, 2 * e + 2, 2 * e + 3, 2 * e + 1});
  }
  mesh.blocks.push_back(block);
  return mesh;
}

void write(const std::string& file)
{
  const Comm comm;
  std::printf("pid %d\n", int(getpid()));
  std::fflush(stdout);
  ResultsFile results(file, comm, sliceOf(rowOfSquares(), comm.rank(), comm.size()),
                      {{"a", "b"}, {"c"}, {"d"}, {}}, {});
  for (int step = 0; step < 2000; ++step)
  {
    results.beginStep(step);
    const std::vector<Real> nodal(results.myNodes().count, step + 0.25),
        element(results.myElements(0).count, step + 0.75);
    results.putNodal(0, nodal);
    results.putNodal(1, nodal);
    results.putElement(0, 0, element);
    results.putGlobals({step + 0.5});
    results.endStep();
    if (comm.isRoot())
    {
      std::printf("step %d\n", step + 1);
      std::fflush(stdout);
    }
  }
}

int check(const std::string& file, int wanted)
{
  readMesh(file);
  int memoryWord = 8, fileWord = 0;
  float version = 0;
  const int exoid = ex_open(file.c_str(), EX_READ, &memoryWord, &fileWord, &version);
  const int steps = int(ex_inquire_int(exoid, EX_INQ_TIME));
  int wrong = steps < wanted ? 1 : 0;
  for (int step = 0; step < steps; ++step)
  {
    std::vector<Real> nodal(2 * elements + 2), element(elements);
    Real time = -1, global = -1;
    ex_get_time(exoid, step + 1, &time);
    ex_get_var(exoid, step + 1, EX_GLOBAL, 1, 1, 1, &global);
    wrong += time != step || global != step + 0.5;
    for (int variable = 1; variable <= 2; ++variable)
    {
      ex_get_var(exoid, step + 1, EX_NODAL, variable, 1, int64_t(nodal.size()), nodal.data());
      for (const Real value : nodal)
        wrong += value != step + 0.25;
    }
    ex_get_var(exoid, step + 1, EX_ELEM_BLOCK, 1, 1, elements, element.data());
    for (const Real value : element)
      wrong += value != step + 0.75;
  }
  std::printf("%d finished steps announced, %d in the file, %d wrong values\n", wanted, steps,
              wrong);
  ex_close(exoid);
  return wrong == 0 ? 0 : 1;
}
} // namespace

int main(int argc, char** argv)
{
  const std::string mode = argc > 1 ? argv[1] : "";
  if (mode == "check" && argc == 4)
    return check(argv[2], std::atoi(argv[3]));
  if (mode != "write" || argc != 3)
    return 2;
  MPI_Init(&argc, &argv);
  write(argv[2]);
  MPI_Finalize();
}
