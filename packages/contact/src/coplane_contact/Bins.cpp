#include <coplane_contact/Bins.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
/// Edge of bins over the largest face of their level [-]. A box as long as the edge less the reach
/// is in at most two bins along an axis, and faces that lie askew have longer boxes when they have
/// turned: larger bins hold more pairs that are far apart, smaller ones more entries of a face.
/// Which pairs are found does not hang on it.
constexpr Real edgeOverFace = 1.4;
/// Nothing is as small [m]; the logarithm of zero is not asked for.
constexpr Real leastSize = 1e-37;
/// At most so many bins along an axis.
constexpr int mostBins = 1 << 28;
} // namespace

void SizeHistogram::add(const SizeHistogram& other)
{
  for (int c = 0; c < classes; ++c)
    counts[c] += other.counts[c];
}

int SizeHistogram::classOf(Real size)
{
  int exponent = 0;
  const Real fraction = std::frexp(std::max(size, leastSize), &exponent); // in [1/2, 1)
  // 2^(-3/4), 2^(-1/2), 2^(-1/4).
  constexpr Real borders[3] = {0.5946035575013605, 0.7071067811865476, 0.8408964152537145};
  const int quarter =
      (fraction >= borders[0]) + (fraction >= borders[1]) + (fraction >= borders[2]);
  return std::clamp(4 * (exponent - 1) + quarter + classes / 2, 0, classes - 1);
}

Real SizeHistogram::upperBound(int sizeClass)
{
  return std::exp2((sizeClass + 1 - classes / 2) / 4.0);
}

std::vector<Bins::Level> SizeHistogram::levels(Real reach, Real extent) const
{
  // A level holds four classes, a factor of two in size. Where levels begin is chosen such that few
  // faces have levels above them, in whose bins they are entered too, and that the largest sizes of
  // the levels are near those of their faces.
  const auto levelOfClass = [](int c, int shift) { return (c + shift) / 4; };
  int best = 0;
  std::int64_t least = -1;
  for (int shift = 0; shift < 4; ++shift)
  {
    std::int64_t cost = 0, above = 0;
    int last = -1;
    for (int c = classes - 1; c >= 0; --c)
      if (counts[c] > 0)
      {
        const int level = levelOfClass(c, shift);
        above += last >= 0 && level != last;
        last = level;
        cost += counts[c] * (4 * above + (4 * level + 3 - shift - c));
      }
    if (least < 0 || cost < least)
    {
      least = cost;
      best = shift;
    }
  }

  // Not more than 32 levels either: faces that are smaller still join the first one.
  const Real smallest = extent / mostBins;
  std::vector<Bins::Level> levels;
  int last = -1;
  for (int c = 0; c < classes; ++c)
    if (counts[c] > 0 && levelOfClass(c, best) != last)
    {
      last = levelOfClass(c, best);
      Bins::Level level;
      level.largestFace = upperBound(4 * last + 3 - best);
      level.edge = edgeOverFace * level.largestFace + reach;
      if (level.largestFace >= smallest && level.edge < infinity)
        levels.push_back(level);
    }
  if (levels.empty())
  {
    const Real edge = smallest + reach;
    levels.push_back({infinity, edge > 0 && edge < infinity ? edge : 1});
  }
  levels.back().largestFace = infinity;
  return levels;
}
} // namespace coplane
