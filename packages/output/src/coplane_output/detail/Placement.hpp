#pragma once

#include <coplane_core/Comm.hpp>

#include <sched.h>
#include <string>
#include <vector>

namespace coplane
{
/// Where a rank runs.
struct Placement
{
  char host[64] = {};
  cpu_set_t cores; ///< that its threads may run on
  int threads = 1;
};

/// Of this rank: the union of the masks of all its threads, because OpenMP may have bound the
/// calling one to a single core.
Placement myPlacement();

/// Core numbers as ranges, e.g. "0-3,8".
std::string coreList(const cpu_set_t& cores);

/// A sentence for every host whose cores are fewer than the threads that run on them; empty when
/// all is well. `ranks` holds the placement of every rank.
std::vector<std::string> placementProblems(const std::vector<Placement>& ranks);
} // namespace coplane
