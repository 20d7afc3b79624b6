// Runs out of memory in a function that may not throw: the program must end with the code of the
// machine (10), not with that of a defect.
#include <coplane_core/Abort.hpp>

#include <new>

namespace
{
void* volatile taken; // so that the compiler does not leave the call out

void take(std::size_t bytes) noexcept
{
  taken = ::operator new(bytes);
}
} // namespace

int main(int count, char**)
{
  coplane::abortAllRanksOnTerminate();
  take(std::size_t(count) << 60);
  return 0;
}
