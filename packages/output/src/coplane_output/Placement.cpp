#include <coplane_core/Backend.hpp>
#include <coplane_output/detail/Placement.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <unistd.h>

namespace coplane
{
Placement myPlacement()
{
  Placement placement;
  ::gethostname(placement.host, sizeof placement.host - 1);
  placement.threads = threadCount();
  CPU_ZERO(&placement.cores);
  sched_getaffinity(0, sizeof placement.cores, &placement.cores);
  std::error_code ignored;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", ignored))
  {
    cpu_set_t cores;
    if (sched_getaffinity(std::atoi(task.path().filename().c_str()), sizeof cores, &cores) == 0)
      CPU_OR(&placement.cores, &placement.cores, &cores);
  }
  return placement;
}

std::string coreList(const cpu_set_t& cores)
{
  std::string text;
  for (int first = 0; first < CPU_SETSIZE; ++first)
  {
    if (!CPU_ISSET(first, &cores))
      continue;
    int last = first;
    while (last + 1 < CPU_SETSIZE && CPU_ISSET(last + 1, &cores))
      ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ",", first);
    if (last > first)
      text += fmt::format("-{}", last);
    first = last;
  }
  return text;
}

std::vector<std::string> placementProblems(const std::vector<Placement>& ranks)
{
  struct Host
  {
    cpu_set_t cores;
    int threads = 0, ranks = 0;
    bool crowded = false; ///< one rank alone has more threads than cores
    Host() { CPU_ZERO(&cores); }
  };
  std::map<std::string, Host> hosts;
  for (const Placement& rank : ranks)
  {
    Host& host = hosts[rank.host];
    CPU_OR(&host.cores, &host.cores, &rank.cores);
    host.threads += rank.threads;
    ++host.ranks;
    host.crowded = host.crowded || rank.threads > CPU_COUNT(&rank.cores);
  }
  std::vector<std::string> problems;
  for (const auto& [name, host] : hosts)
    if (host.crowded || host.threads > CPU_COUNT(&host.cores))
      problems.push_back(fmt::format(
          "host {}: {} ranks with {} threads in all share cores {}. Threads that share a core are "
          "slow; use fewer ranks or threads, or launch with mpirun --map-by slot:PE=<threads> "
          "--bind-to core (or --bind-to none).",
          name, host.ranks, host.threads, coreList(host.cores)));
  return problems;
}
} // namespace coplane
