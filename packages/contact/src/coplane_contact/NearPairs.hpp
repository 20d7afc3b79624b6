#pragma once

#include <coplane_core/Backend.hpp>

#include <cstdint>
#include <vector>

namespace coplane
{
struct PairTables;

/// The pairs of the last search that a cycle has to look at, which may be few of them, and their
/// faces.
class NearPairs
{
public:
  /// Puts those apart that cannot touch. @param slots, faces: how many there are
  void list(const PairTables& pairs, int slots, std::size_t faces);

  const std::vector<int>& slots() const { return slots_; } ///< ascending
  const std::vector<int>& faces() const { return faces_; } ///< places in their table, ascending

private:
  std::vector<int> slots_, faces_;
  std::vector<int> listed_;    ///< by stretch of slots: how many of it
  Array<std::uint8_t> isNear_; ///< by face
};
} // namespace coplane
