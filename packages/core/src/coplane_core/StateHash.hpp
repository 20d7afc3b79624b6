#pragma once

#include <coplane_core/Real.hpp>

#include <cstdint>
#include <cstring>

namespace coplane
{
/// Mixes 64 bits (the finaliser of splitmix64: a bijection that spreads every bit).
inline std::uint64_t mix(std::uint64_t z)
{
  z += 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

/// Hash of a set of values that belong to global ids. Contributions are added modulo 2^64, so it
/// does not depend on the order or on which rank held what; one changed bit of one value changes
/// it.
class StateHash
{
public:
  /// `what` tells fields apart, `id` is the global id of the entity, `component` counts within the
  /// field.
  void add(std::uint64_t what, GlobalId id, std::uint64_t component, Real value)
  {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    add(what, id, component, bits);
  }
  void add(std::uint64_t what, GlobalId id, std::uint64_t component, std::uint64_t bits)
  {
    sum_ += mix(mix(mix(mix(what) ^ std::uint64_t(id)) ^ component) ^ bits);
  }
  /// This rank's part; the hash of the run is the sum of all parts modulo 2^64.
  std::uint64_t part() const { return sum_; }

private:
  std::uint64_t sum_ = 0;
};
} // namespace coplane
