#pragma once

#include <chrono>
#include <map>
#include <string>

namespace coplane
{
/// Wall seconds by label, e.g. "coplane::contact::step4_copyGhostFaces". One registry per rank.
std::map<std::string, double>& timers();

/// Adds the time of its life to timers()[label] and marks a region for Kokkos' profiling tools.
class TimedRegion
{
public:
  explicit TimedRegion(const char* label);
  ~TimedRegion();
  TimedRegion(const TimedRegion&) = delete;
  TimedRegion& operator=(const TimedRegion&) = delete;

private:
  const char* label_;
  std::chrono::steady_clock::time_point start_;
};
} // namespace coplane
