#pragma once

#include <Kokkos_Core.hpp>

#include <cstddef>

namespace coplane
{
/// Brings numbers or records into the cache, to be read and written soon.
/// @param count of T
template <class T>
KOKKOS_FORCEINLINE_FUNCTION void prefetch(const T* from, std::size_t count = 1)
{
  constexpr std::size_t line = 64;
  const char* const first = reinterpret_cast<const char*>(from);
  for (std::size_t at = 0; at < count * sizeof(T); at += line)
    __builtin_prefetch(first + at, 1);
  // GCC takes a function that does nothing else for one without effect, and leaves out its calls.
  asm volatile("");
}
} // namespace coplane
