#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

namespace coplane
{
/// Wall-clock seconds that this rank has worked for cycles, by kind of work, without the time in
/// which it waits for other ranks or writes results. What is dealt out anew when a run is
/// rebalanced.
struct WorkTimes
{
  std::vector<double> elements; ///< by block [s]
  double search = 0;            ///< sorting faces and finding pairs [s]
  double planes = 0;            ///< step 6 and its forces [s]
  double nodes = 0;             ///< what is done node by node [s]
  std::int64_t cycles = 0;

  double total() const
  {
    double sum = search + planes + nodes;
    for (const double block : elements)
      sum += block;
    return sum;
  }
};

/// Adds the time of its life to a sum.
class Stopwatch
{
public:
  explicit Stopwatch(double& sum) : sum_(sum), start_(std::chrono::steady_clock::now()) {}
  ~Stopwatch()
  {
    sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

private:
  double& sum_;
  std::chrono::steady_clock::time_point start_;
};
} // namespace coplane
