#pragma once

#include <Kokkos_Core.hpp>

#include <cstddef>

namespace coplane
{
namespace detail
{
/// A line of the cache for every 64 bytes from the address on. The last line of what does not begin
/// with one may be left out.
template <int toWrite, class T>
KOKKOS_FORCEINLINE_FUNCTION void prefetchLines(const T* from, std::size_t count)
{
  constexpr std::size_t line = 64;
  const char* const first = reinterpret_cast<const char*>(from);
  for (std::size_t at = 0; at < count * sizeof(T); at += line)
    __builtin_prefetch(first + at, toWrite);
  // GCC takes a function that does nothing else for one without effect, and leaves out its calls.
  asm volatile("");
}
} // namespace detail

/// Brings numbers or records into the cache, to be read soon.
/// @param count of T
template <class T>
KOKKOS_FORCEINLINE_FUNCTION void prefetch(const T* from, std::size_t count = 1)
{
  detail::prefetchLines<0>(from, count);
}
/// The same, to be written: by no other thread at the same time.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION void prefetchToWrite(const T* from, std::size_t count = 1)
{
  detail::prefetchLines<1>(from, count);
}
} // namespace coplane
