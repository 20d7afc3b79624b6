#pragma once

#include <cstdint>
#include <vector>

namespace coplane
{
/// Seconds that this rank has worked for cycles, by kind of work, without the time in which it
/// waits for other ranks or writes results (WorkWatch). What is dealt out anew when a run is
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
} // namespace coplane
