#include <coplane_core/Backend.hpp>

namespace coplane
{
namespace
{
Backend backendInUse = Backend::Serial;
}

Backend currentBackend()
{
  return backendInUse;
}

void setBackend(Backend backend)
{
  backendInUse = backend;
}

const char* name(Backend backend)
{
  return backend == Backend::Serial ? "serial" : "threads";
}

int threadCount()
{
  return currentBackend() == Backend::Serial ? 1 : HostParallel().concurrency();
}
} // namespace coplane
