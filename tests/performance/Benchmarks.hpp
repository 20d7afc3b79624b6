#pragma once

#include <coplane_core/Backend.hpp>

#include <Kokkos_Core.hpp>
#include <benchmark/benchmark.h>
#include <mpi.h>

#include <cstdlib>
#include <cstring>
#include <string>

// What the programs of this folder have in common: their start and end, and the memory bandwidth
// of the machine in the same run.
namespace coplane
{
/// Bytes per second of a = b + s c on arrays that no cache holds.
inline void triad(benchmark::State& state, Backend backend)
{
  setBackend(backend);
  const int n = 1 << 24;
  const Array<Real> a("a", n), b("b", n), c("c", n);
  for (auto _ : state)
  {
    parallelFor(
        "triad", n, KOKKOS_LAMBDA(const int i) { a(i) = b(i) + 3.0 * c(i); });
    benchmark::DoNotOptimize(a.data());
  }
  state.SetBytesProcessed(state.iterations() * 3 * sizeof(Real) * n);
  state.counters["threads"] = threadCount();
}

/// Registers body(state, backend) on both back ends; times are wall times.
template <class Body>
benchmark::internal::Benchmark* addBenchmark(const std::string& label, Backend backend,
                                             const Body& body)
{
  return benchmark::RegisterBenchmark((label + "/" + name(backend)).c_str(),
                                      [=](benchmark::State& state) { body(state, backend); })
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

/// Main program. Options: those of Google Benchmark, and --threads N.
/// @param addAll called for each back end
template <class AddAll>
int runBenchmarks(int argc, char** argv, const AddAll& addAll)
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
  MPI_Init(&argc, &argv);
  int status = 0;
  {
    const Kokkos::ScopeGuard kokkos(arguments);
    for (const Backend backend : {Backend::Serial, Backend::Threads})
    {
      addBenchmark("triad", backend, triad);
      addAll(backend);
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv))
      status = 2;
    else
      benchmark::RunSpecifiedBenchmarks();
  }
  MPI_Finalize();
  return status;
}
} // namespace coplane
