#include <coplane_contact/NearPairs.hpp>
#include <coplane_contact/detail/FacePairLanes.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
constexpr int stretch = 512; ///< slots that one thread looks through at once

/// Of the slots from `first` on those that have to be looked at, to `near`. @returns how many
int listStretch(const PairTables& pairs, int first, int last, int* near)
{
  std::uint8_t far[stretch] = {};
  if (pairs.distances != nullptr && pairs.distances->known())
    pairs.distances->areFar(first, last - first, far);
  int count = 0;
  for (int p = first; p < last; ++p)
  {
    if (far[p - first] != 0 && pairs.carriesNothing(p))
      pairs.putApart(p);
    else if (pairs.slots[p].face[0] >= 0)
      near[count++] = p;
  }
  return count;
}
} // namespace

void NearPairs::list(const PairTables& pairs, int slots, std::size_t faces)
{
  const int stretches = (slots + stretch - 1) / stretch;
  slots_.resize(std::size_t(slots));
  listed_.resize(std::size_t(stretches));
  if (isNear_.extent(0) != faces)
    isNear_ = Array<std::uint8_t>("coplane::contact::isNear", faces);
  else
    std::fill(isNear_.data(), isNear_.data() + faces, std::uint8_t(0));
  parallelFor("coplane::contact::nearPairs", stretches,
              [&](const int s)
              {
                const int first = s * stretch, last = std::min(first + stretch, slots);
                int* const near = slots_.data() + first;
                const int count = listed_[std::size_t(s)] = listStretch(pairs, first, last, near);
                for (int i = 0; i < count; ++i)
                  for (const std::int32_t face : pairs.slots[near[i]].face)
                    __atomic_store_n(&isNear_(face), std::uint8_t(1), __ATOMIC_RELAXED);
              });
  int count = 0;
  for (int s = 0; s < stretches; ++s)
  {
    const auto first = slots_.begin() + s * stretch;
    if (first != slots_.begin() + count)
      std::copy(first, first + listed_[std::size_t(s)], slots_.begin() + count);
    count += listed_[std::size_t(s)];
  }
  slots_.resize(std::size_t(count));
  faces_.clear();
  for (std::size_t f = 0; f < faces; ++f)
    if (isNear_(f) != 0)
      faces_.push_back(int(f));
}
} // namespace coplane
