#pragma once

#include <ctime>

namespace coplane
{
/// Adds the processor time of the calling thread, as long as it lives, to a sum [s]. Unlike
/// wall-clock time it does not grow when other programs use the same core. Two calls of the
/// operating system, about half a microsecond: for regions, not for loops.
class WorkWatch
{
public:
  explicit WorkWatch(double& sum) : sum_(sum), start_(now()) {}
  ~WorkWatch() { sum_ += now() - start_; }
  WorkWatch(const WorkWatch&) = delete;
  WorkWatch& operator=(const WorkWatch&) = delete;

private:
  static double now()
  {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
  }

  double& sum_;
  double start_;
};
} // namespace coplane
