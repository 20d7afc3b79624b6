// Element-cycles per second of one fused element update: a cube of hexahedra with J2 plasticity,
// hourglass stiffness and bulk viscosity (the law is branch-free: yielding costs nothing extra).
// Options: those of Google Benchmark, and --threads N.
#include <coplane_core/Backend.hpp>
#include <coplane_element/ElementBlock.hpp>

#include <Kokkos_Core.hpp>
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace coplane
{
namespace
{
std::vector<int> cubeConnectivity(int n)
{
  const auto node = [n](int i, int j, int k) { return (k * (n + 1) + j) * (n + 1) + i; };
  std::vector<int> nodes;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        for (const int corner : {node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k),
                                 node(i, j + 1, k), node(i, j, k + 1), node(i + 1, j, k + 1),
                                 node(i + 1, j + 1, k + 1), node(i, j + 1, k + 1)})
          nodes.push_back(corner);
  return nodes;
}

void elementUpdate(benchmark::State& state, Backend backend)
{
  setBackend(backend);
  const int n = int(state.range(0));
  const Real h = 0.01;
  const int nodes = (n + 1) * (n + 1) * (n + 1);
  NodeVectors x("x", nodes), v("v", nodes);
  for (int node = 0; node < nodes; ++node)
  {
    const int i = node % (n + 1), j = node / (n + 1) % (n + 1), k = node / (n + 1) / (n + 1);
    x(node, 0) = h * (i + 0.1 * std::sin(Real(7 * i + 3 * j + 5 * k)));
    x(node, 1) = h * (j + 0.1 * std::sin(Real(2 * i + 9 * j + 4 * k)));
    x(node, 2) = h * (k + 0.1 * std::sin(Real(8 * i + 6 * j + 3 * k)));
    v(node, 0) = 100 * std::sin(0.7 * i + 0.2 * k);
    v(node, 1) = 100 * std::cos(0.4 * j - 0.3 * i);
    v(node, 2) = -100 * std::sin(0.5 * k + 0.1 * j);
  }
  ElementBlock block(ElementType::Hex8, makeJ2Plasticity(200e9, 0.3, 7850, 400e6, 100e6), {}, {},
                     cubeConnectivity(n));
  block.initialise(x);
  Real dt = 1e-8; // the positions stay: only the rates matter for the time
  for (auto _ : state)
  {
    block.update(x, v, dt);
    benchmark::DoNotOptimize(dt);
  }
  state.counters["elements/s"] =
      benchmark::Counter(Real(block.count()), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["threads"] = threadCount();
}
} // namespace
} // namespace coplane

int main(int argc, char** argv)
{
  Kokkos::InitArguments arguments;
  arguments.num_threads = 1;
  for (int i = 1; i + 1 < argc; ++i)
    if (std::strcmp(argv[i], "--threads") == 0)
    {
      arguments.num_threads = std::atoi(argv[i + 1]);
      for (int j = i; j + 2 < argc; ++j)
        argv[j] = argv[j + 2];
      argc -= 2;
      break;
    }
  const Kokkos::ScopeGuard kokkos(arguments);
  benchmark::RegisterBenchmark("elementUpdate/serial", coplane::elementUpdate,
                               coplane::Backend::Serial)
      ->Arg(48)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("elementUpdate/threads", coplane::elementUpdate,
                               coplane::Backend::Threads)
      ->Arg(48)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv))
    return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
