#pragma once

#include <coplane_core/Backend.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace coplane
{
/// Bits that the numbers 0 ... largest need.
inline int bitsFor(std::uint64_t largest)
{
  int bits = 0;
  for (; largest > 0; largest >>= 1)
    ++bits;
  return bits;
}

/// Sorts items by code(item), a number below 2^bits; items with the same code keep their order. The
/// time grows linearly with their number. The result does not depend on the number of threads.
template <class Item, class Code>
void radixSort(std::vector<Item>& items, int bits, const Code& code)
{
  constexpr int widest = 11; // the ends of 2^11 buckets fit into the first-level cache
  const std::size_t n = items.size();
  if (n < 256)
  {
    std::stable_sort(items.begin(), items.end(),
                     [&](const Item& a, const Item& b) { return code(a) < code(b); });
    return;
  }
  const int passes = (bits + widest - 1) / widest;
  const int width = passes > 0 ? (bits + passes - 1) / passes : 0;
  const std::size_t buckets = std::size_t(1) << width;
  const int chunks = n < 8192 ? 1 : threadCount();
  std::vector<Item> other(passes > 0 ? n : 0);
  std::vector<std::size_t> ends(buckets * chunks);
  for (int pass = 0; pass < passes; ++pass)
  {
    const auto bucketOf = [&](const Item& item)
    { return (code(item) >> (pass * width)) & (buckets - 1); };
    std::fill(ends.begin(), ends.end(), 0);
    forEachChunk("coplane::contact::radixSort.count", n, chunks,
                 [&](int chunk, std::size_t begin, std::size_t end)
                 {
                   std::size_t* const count = &ends[buckets * chunk];
                   for (std::size_t i = begin; i < end; ++i)
                     ++count[bucketOf(items[i])];
                 });
    std::size_t sum = 0;
    for (std::size_t b = 0; b < buckets; ++b)
      for (int chunk = 0; chunk < chunks; ++chunk)
      {
        const std::size_t count = ends[buckets * chunk + b];
        ends[buckets * chunk + b] = sum;
        sum += count;
      }
    forEachChunk("coplane::contact::radixSort.move", n, chunks,
                 [&](int chunk, std::size_t begin, std::size_t end)
                 {
                   std::size_t* const place = &ends[buckets * chunk];
                   for (std::size_t i = begin; i < end; ++i)
                     other[place[bucketOf(items[i])]++] = items[i];
                 });
    items.swap(other);
  }
}
} // namespace coplane
