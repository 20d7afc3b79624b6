// Faces per second of a whole contact search on one rank, as the solver makes it: step 1, and step
// 5, which sorts into bins as step 2 does (steps 3 and 4 are for several ranks):
//   flat      two planes of N x N and (N+1) x (N+1) quadrilaterals that lie on each other
//   huge      the same, and one face as large as both
//   graded    the same, where the sides of the quadrilaterals grow a hundredfold along both axes
// The memory bandwidth of the same machine at the same time is measured beside them.
// Options: those of Google Benchmark, and --threads N. Times are wall times.
#include "Benchmarks.hpp"

#include <coplane_contact/Search.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_core/Memory.hpp>
#include <coplane_mesh/ElementTopology.hpp>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace coplane
{
namespace
{
struct Scene
{
  std::vector<Face> faces; ///< sorted by id
  std::vector<Vec3> x;
  Real smallest = infinity; ///< [m]

  /// A plane of n x n quadrilaterals over the unit square; `grading` is the ratio of the largest to
  /// the smallest side.
  void addPlane(int n, Real z, bool up, Real grading)
  {
    const auto place = [&](int i)
    { return grading == 1 ? Real(i) / n : (std::pow(grading, Real(i) / n) - 1) / (grading - 1); };
    const int first = int(x.size());
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
        x.push_back({place(i), place(j), z});
    const GlobalId firstElement = GlobalId(faces.size());
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
      {
        const int corner = first + j * (n + 1) + i;
        add({corner, corner + 1, corner + n + 2, corner + n + 1}, up, firstElement + j * n + i);
      }
    smallest = std::min(smallest, place(1));
  }

  void add(const std::array<int, 4>& nodes, bool up, GlobalId element)
  {
    Face face;
    face.id = faceId(element, 0);
    face.count = 4;
    for (int k = 0; k < 4; ++k)
      face.nodes[k] = nodes[up ? k : 3 - k];
    // Of an element as thick as the face is wide.
    const Vec3 diagonal = x[nodes[2]] - x[nodes[0]];
    face.thickness = std::sqrt(0.5) * norm(diagonal);
    face.modulus = 1;
    face.local = face.ownedHere = true;
    faces.push_back(face);
  }
};

Scene twoPlanes(int n, Real grading)
{
  Scene scene;
  scene.addPlane(n, 0, true, grading);
  scene.addPlane(n + 1, 0.02 * scene.smallest, false, grading);
  return scene;
}

Scene flat(int n)
{
  return twoPlanes(n, 1);
}

Scene graded(int n)
{
  return twoPlanes(n, 100);
}

Scene huge(int n)
{
  Scene scene = flat(n);
  const int first = int(scene.x.size());
  for (const Vec3& corner :
       {Vec3{-0.1, -0.1, 0}, Vec3{1.1, -0.1, 0}, Vec3{1.1, 1.1, 0}, Vec3{-0.1, 1.1, 0}})
    scene.x.push_back(corner + Vec3{0, 0, 0.01 * scene.smallest});
  scene.add({first, first + 1, first + 2, first + 3}, false, GlobalId(scene.faces.size()));
  return scene;
}

void search(benchmark::State& state, Backend backend, Scene (*make)(int))
{
  setBackend(backend);
  const Scene scene = make(int(state.range(0)));
  NodeVectors x("x", scene.x.size());
  for (int n = 0; n < int(scene.x.size()); ++n)
    set(x, n, scene.x[n]);
  const Comm comm;
  CandidateRules rules;
  rules.skin = rules.reach = 0.1 * scene.smallest;
  std::size_t pairs = 0;
  for (auto _ : state)
  {
    const Bins bins = step1_globalSpaceLimits(scene.faces, x, rules, comm);
    const SortedFaces sorted = step2_sortIntoBins(bins, scene.faces, x, 3, rules);
    pairs = step5_candidatePairs(sorted, scene.faces, x, rules).size();
  }
  const auto rate = [](std::size_t count)
  { return benchmark::Counter(Real(count), benchmark::Counter::kIsIterationInvariantRate); };
  state.counters["faces"] = Real(scene.faces.size());
  state.counters["faces/s"] = rate(scene.faces.size());
  state.counters["pairs"] = Real(pairs);
  state.counters["pairs/s"] = rate(pairs);
  state.counters["threads"] = threadCount();
}

} // namespace
} // namespace coplane

int main(int argc, char** argv)
{
  using namespace coplane;
  keepFreedMemory(); // as the solver does
  return runBenchmarks(
      argc, argv,
      [](Backend backend)
      {
        const auto add = [&](const char* what, Scene (*make)(int), std::initializer_list<int> sizes)
        {
          for (const int n : sizes)
            addBenchmark(what, backend,
                         [make](benchmark::State& state, Backend b) { search(state, b, make); })
                ->Arg(n);
        };
        add("flat", flat, {70, 200, 707});
        add("huge", huge, {200});
        add("graded", graded, {200});
      });
}
