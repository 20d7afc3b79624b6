#pragma once

#include <Kokkos_Core.hpp>

#include <cstddef>
#include <numeric>
#include <vector>

namespace coplane
{
/// A stretch of entries, to loop over.
template <class Entry>
struct Stretch
{
  const Entry *first, *last; ///< the last is not of it

  KOKKOS_FORCEINLINE_FUNCTION const Entry* begin() const { return first; }
  KOKKOS_FORCEINLINE_FUNCTION const Entry* end() const { return last; }
};

/// The entries of each list, for kernels; lives while the lists do.
template <class Entry>
struct ListsView
{
  const int* start;     ///< of each list, and the end of the last one
  const Entry* entries; ///< list after list

  KOKKOS_FORCEINLINE_FUNCTION Stretch<Entry> operator[](std::size_t list) const
  {
    return {entries + start[list], entries + start[list + 1]};
  }
};

/// Many lists in one stretch of memory: the elements of every node, say.
template <class Entry>
class Lists
{
public:
  Lists() = default;
  /// @param forEach calls the visitor it is given for every entry, visit(list, entry); asked twice,
  ///        both times for the same. Entries of a list keep that order.
  template <class ForEach>
  Lists(std::size_t count, const ForEach& forEach) : start_(count + 1, 0)
  {
    forEach([&](std::size_t list, const Entry&) { ++start_[list + 1]; });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    entries_.resize(std::size_t(start_.back()));
    std::vector<int> next(start_.begin(), start_.end() - 1);
    forEach([&](std::size_t list, const Entry& entry)
            { entries_[std::size_t(next[list]++)] = entry; });
  }

  std::size_t count() const { return start_.size() - 1; }
  /// Of all lists together, one after another.
  const std::vector<Entry>& entries() const { return entries_; }
  ListsView<Entry> view() const { return {start_.data(), entries_.data()}; }
  Stretch<Entry> operator[](std::size_t list) const { return view()[list]; }

private:
  std::vector<int> start_{0};
  std::vector<Entry> entries_;
};
} // namespace coplane
