#pragma once

#include <coplane_core/Real.hpp>

#include <Kokkos_Core.hpp>

#include <string>
#include <utility>
#include <vector>

namespace coplane
{
/// Where kernels run. Chosen once, at run time; all views live in host memory, so no class carries
/// a back-end parameter.
enum class Backend
{
  Serial, ///< Kokkos::Serial: one thread
  Threads ///< the host-parallel space of Kokkos: OpenMP here
};

using HostParallel = Kokkos::DefaultHostExecutionSpace;

Backend currentBackend();
void setBackend(Backend backend);
const char* name(Backend backend);
/// Threads that a kernel uses: 1 for Serial.
int threadCount();

template <class T>
using Array = Kokkos::View<T*, Kokkos::LayoutRight, Kokkos::HostSpace>;
template <class T>
using ConstArray = Kokkos::View<const T*, Kokkos::LayoutRight, Kokkos::HostSpace>;
template <class T>
using Table = Kokkos::View<T**, Kokkos::LayoutRight, Kokkos::HostSpace>;
template <class T>
using ConstTable = Kokkos::View<const T**, Kokkos::LayoutRight, Kokkos::HostSpace>;

/// Runs body(i) for i in [0, n) on the current back end and waits. The body writes only what
/// belongs to i.
template <class Body>
void parallelFor(const std::string& label, int n, const Body& body)
{
  if (currentBackend() == Backend::Serial)
    Kokkos::parallel_for(label, Kokkos::RangePolicy<Kokkos::Serial>(0, n), body);
  else
    Kokkos::parallel_for(label, Kokkos::RangePolicy<HostParallel>(0, n), body);
  Kokkos::fence();
}

/// The same where some i take far longer than others: threads take one i after the other.
template <class Body>
void parallelForUneven(const std::string& label, int n, const Body& body)
{
  using OneAfterTheOther = Kokkos::RangePolicy<HostParallel, Kokkos::Schedule<Kokkos::Dynamic>>;
  if (currentBackend() == Backend::Serial)
    Kokkos::parallel_for(label, Kokkos::RangePolicy<Kokkos::Serial>(0, n), body);
  else
    Kokkos::parallel_for(label, OneAfterTheOther(0, n, Kokkos::ChunkSize(1)), body);
  Kokkos::fence();
}

/// Calls body(chunk, begin, end) for `chunks` equal parts of [0, n).
template <class Body>
void forEachChunk(const char* label, std::size_t n, int chunks, const Body& body)
{
  parallelFor(label, chunks, [&](const int c) { body(c, n * c / chunks, n * (c + 1) / chunks); });
}

/// What take(sum, i) adds for all i in [0, n): each thread begins with `none`, and add() brings
/// them together. The order depends on the number of threads: sums have to be exact, or their bits
/// must not matter.
template <class Sum, class Take>
Sum sumInParts(const char* label, std::size_t n, const Sum& none, const Take& take)
{
  const int chunks = n < 512 ? 1 : threadCount();
  std::vector<Sum> parts(chunks);
  forEachChunk(label, n, chunks,
               [&](int chunk, std::size_t begin, std::size_t end)
               {
                 Sum mine = none; // no memory that threads share
                 for (std::size_t i = begin; i < end; ++i)
                   take(mine, i);
                 parts[chunk] = std::move(mine);
               });
  for (int chunk = 1; chunk < chunks; ++chunk)
    parts[0].add(parts[chunk]);
  return std::move(parts[0]);
}

/// The smallest of body(i), infinity when n is 0. Exact, hence the same on any back end.
template <class Body>
Real parallelMin(const std::string& label, int n, const Body& body)
{
  Real least = infinity;
  const auto update = KOKKOS_LAMBDA(const int i, Real& value)
  {
    const Real candidate = body(i);
    value = candidate < value ? candidate : value;
  };
  if (n == 0)
    return least;
  if (currentBackend() == Backend::Serial)
    Kokkos::parallel_reduce(label, Kokkos::RangePolicy<Kokkos::Serial>(0, n), update,
                            Kokkos::Min<Real>(least));
  else
    Kokkos::parallel_reduce(label, Kokkos::RangePolicy<HostParallel>(0, n), update,
                            Kokkos::Min<Real>(least));
  Kokkos::fence();
  // Kokkos::Min starts from the largest finite number.
  return least < std::numeric_limits<Real>::max() ? least : infinity;
}
} // namespace coplane
