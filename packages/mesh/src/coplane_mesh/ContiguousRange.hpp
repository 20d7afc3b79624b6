#pragma once

#include <algorithm>

namespace coplane
{
/// Part [first, first + count) of a list.
struct IndexRange
{
  int first = 0;
  int count = 0;
};

/// The contiguous range of n items that rank r of p takes: sizes differ by at most one, the longer
/// ones first; may be empty.
inline IndexRange contiguousRange(int n, int rank, int ranks)
{
  const int shortest = n / ranks;
  const int longer = n % ranks;
  return {rank * shortest + std::min(rank, longer), shortest + (rank < longer ? 1 : 0)};
}

/// The rank whose contiguousRange holds item i.
inline int rankOfItem(int i, int n, int ranks)
{
  const int shortest = n / ranks;
  const int longer = n % ranks;
  const int inLonger = longer * (shortest + 1);
  return i < inLonger ? i / (shortest + 1) : longer + (i - inLonger) / shortest;
}
} // namespace coplane
