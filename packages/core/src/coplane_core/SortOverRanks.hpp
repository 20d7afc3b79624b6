#pragma once

#include <coplane_core/Comm.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace coplane
{
/// Ranges of integer keys, of equal width and ascending with the rank: who finds what by its key.
class KeyRanges
{
public:
  /// Of the keys of all ranks. Collective.
  template <class T, class Key>
  KeyRanges(const std::vector<T>& items, const Key& key, const Comm& comm)
  {
    std::int64_t lowest = INT64_MAX, highest = INT64_MIN;
    for (const T& item : items)
    {
      lowest = std::min(lowest, std::int64_t(key(item)));
      highest = std::max(highest, std::int64_t(key(item)));
    }
    lowest_ = comm.min(lowest);
    highest = comm.max(highest);
    // Unsigned: the difference of two keys may be too large for a sign.
    if (highest >= lowest_ && comm.size() > 1)
      width_ = (std::uint64_t(highest) - std::uint64_t(lowest_)) / std::uint64_t(comm.size()) + 1;
  }
  std::int64_t lowest() const { return lowest_; } ///< of all keys
  int rankOf(std::int64_t key) const
  {
    return width_ == 0 ? 0 : int((std::uint64_t(key) - std::uint64_t(lowest_)) / width_);
  }

private:
  std::int64_t lowest_ = 0;
  std::uint64_t width_ = 0; ///< 0: all on one rank
};

/// Items of all ranks sorted by an integer key: every rank gets those of its range. Items with one
/// key stand in the order of the ranks that had them. Shares are as even as the keys are.
/// Collective.
template <class T, class Key>
std::vector<T> sortOverRanks(const std::vector<T>& items, const Key& key, const KeyRanges& ranges,
                             const Comm& comm)
{
  std::vector<std::vector<T>> toRank(comm.size());
  for (const T& item : items)
    toRank[ranges.rankOf(key(item))].push_back(item);
  std::vector<T> mine = comm.exchange(toRank);
  std::stable_sort(mine.begin(), mine.end(),
                   [&](const T& a, const T& b) { return key(a) < key(b); });
  return mine;
}

/// How many items the ranks before this one have, and how many there are. Collective.
struct Share
{
  Share(std::size_t mine, const Comm& comm)
  {
    const auto counts = comm.allGather(std::vector<std::int64_t>{std::int64_t(mine)});
    for (int r = 0; r < comm.size(); ++r)
    {
      before += r < comm.rank() ? counts[r] : 0;
      total += counts[r];
    }
  }
  std::int64_t before = 0, total = 0;
};
} // namespace coplane
