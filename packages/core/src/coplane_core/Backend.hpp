#pragma once

#include <coplane_core/Real.hpp>

#include <Kokkos_Core.hpp>

#include <string>

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
