#include <coplane_core/Error.hpp>
#include <coplane_core/Memory.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <string>
#include <sys/resource.h>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <vector>

#ifdef __GLIBC__
#include <limits>
#include <malloc.h>
#endif

namespace coplane
{
void keepFreedMemory()
{
#ifdef __GLIBC__
  ::mallopt(M_MMAP_MAX, 0);
  ::mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

std::int64_t peakMemory()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t(usage.ru_maxrss) * 1024;
}

void limitMemoryToMachine()
{
#if defined(__SANITIZE_ADDRESS__)
  return; // its shadow is larger than any machine: nothing could be had any more
#endif
  const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || page <= 0)
    return;
  rlim_t bytes = rlim_t(pages) * rlim_t(page);
  for (const char* file :
       {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
  {
    std::ifstream stream(file);
    unsigned long long limit = 0;
    if (stream >> limit) // "max": none
      bytes = std::min(bytes, rlim_t(limit));
  }
  rlimit now{};
  if (::getrlimit(RLIMIT_DATA, &now) == 0 && bytes < now.rlim_cur)
  {
    now.rlim_cur = bytes;
    ::setrlimit(RLIMIT_DATA, &now); // where it is refused all is as before
  }
}

void demandOpenFiles()
{
  constexpr rlim_t needed = 64;
  rlimit now{};
  if (::getrlimit(RLIMIT_NOFILE, &now) != 0 || now.rlim_cur >= needed)
    return;
  rlimit more = now;
  more.rlim_cur = std::min(needed, now.rlim_max);
  if (::setrlimit(RLIMIT_NOFILE, &more) != 0 || more.rlim_cur < needed)
    fail(ExitCode::Machine,
         "the process may have {} files open, and a run needs up to {}. Nothing was written. Raise "
         "the limit: ulimit -n {}.",
         now.rlim_cur, needed, needed);
}

void demandThreads(int count)
{
  std::vector<std::thread> threads;
  std::string reason;
  std::mutex wait;
  {
    const std::lock_guard<std::mutex> all(wait);
    try
    {
      threads.reserve(std::size_t(count));
      for (int i = 1; i < count; ++i)
        threads.emplace_back([&] { const std::lock_guard<std::mutex> mine(wait); });
    }
    catch (const std::system_error& error)
    {
      reason = error.what();
    }
  }
  for (std::thread& thread : threads)
    thread.join();
  if (!reason.empty())
    fail(
        ExitCode::Machine,
        "{} threads cannot be made: {}. Ask for fewer (--threads), or raise the limit of processes "
        "(ulimit -u, or that of the container).",
        count, reason);
}
} // namespace coplane
