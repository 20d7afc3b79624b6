#include <coplane_core/Memory.hpp>

#include <cstdlib>

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
} // namespace coplane
