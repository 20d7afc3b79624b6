#include <coplane_core/Timers.hpp>

#include <Kokkos_Core.hpp>

namespace coplane
{
std::map<std::string, double>& timers()
{
  static std::map<std::string, double> registry;
  return registry;
}

TimedRegion::TimedRegion(const char* label)
    : label_(label), start_(std::chrono::steady_clock::now())
{
  Kokkos::Profiling::pushRegion(label);
}

TimedRegion::~TimedRegion()
{
  Kokkos::Profiling::popRegion();
  timers()[label_] +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}
} // namespace coplane
