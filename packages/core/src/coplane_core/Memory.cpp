#include <coplane_core/Memory.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <sys/resource.h>
#include <unistd.h>

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

void limitMemoryToMachine()
{
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
} // namespace coplane
