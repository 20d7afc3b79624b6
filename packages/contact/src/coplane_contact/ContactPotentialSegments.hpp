#pragma once

#include <coplane_contact/ContactPotential.hpp>

// Steps of PairPotential in two dimensions for several pairs side by side, with the bits of a
// single one.

namespace coplane
{
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::findOverlapOfSegments()
{
  using namespace branchFree;
  T ends[2][2];
  for (int f = 0; f < 2; ++f)
    for (int end = 0; end < 2; ++end)
      ends[f][end] = shadow[f].p[nodeAtEnd(f, end)].x;
  // Faces that oppose each other run against each other on their plane.
  regular = ends[0][0] < ends[0][1] && ends[1][0] < ends[1][1];
  segment_.of[0][0] = ends[0][0] > ends[1][0];
  segment_.of[1][0] = ends[0][1] < ends[1][1];
  for (int end = 0; end < 2; ++end)
  {
    segment_.of[end][1] = !segment_.of[end][0];
    segment_.at[end] = choose(segment_.of[end][0], ends[0][end], ends[1][end]);
  }
  pieces_ = 1;
  const T length = segment_.at[1] - segment_.at[0];
  overlap = positivePart(length);
  const T closures[2] = {closureAt({segment_.at[0], T(0.0)}), closureAt({segment_.at[1], T(0.0)})};
  mostClosure = choose(overlap > 0.0, larger(closures[0], closures[1]), T(-infinity));
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::integrateSegments(const Mask& whole)
{
  using namespace branchFree;
  const T none(0.0);
  T &from = segment_.at[0], &to = segment_.at[1];
  const T c0 = closureAt({from, none}), c1 = closureAt({to, none});
  auto there = overlap > 0.0 && plane.opposed && (whole || c0 > 0.0 || c1 > 0.0);
  const T cut = from + (to - from) * c0 / (c0 - c1);
  const Mask open[2] = {!whole && c0 < 0.0, !whole && c1 < 0.0};
  for (int end = 0; end < 2; ++end)
  {
    segment_.at[end] = choose(open[end], cut, segment_.at[end]);
    for (Mask& its : segment_.of[end])
      its = its && !open[end];
  }
  const T u = closureAt({from, none}), v = closureAt({to, none}), width = to - from;
  there = there && width > 0.0;
  const auto sum = [&](const T& value) { return choose(there, value, none); };
  moments.area += sum(width);
  moments.volume += sum(0.5 * width * (u + v));
  moments.squares += sum(width / 3.0 * (u * u + u * v + v * v));
  moments.areaMoment.x += sum(0.5 * width * (from + to));
  moments.volumeMoment.x += sum(width / 6.0 * (2.0 * (u * from + v * to) + u * to + v * from));
  for (int end = 0; end < 2; ++end)
    for (int f = 0; f < 2; ++f)
    {
      Mask& its = segment_.of[end][f];
      its = its && there;
      const int owner = 4 * f + nodeAtEnd(f, end);
      ways_[f] += choose(its && edges_.exits[owner] > 0.0, end == 0 ? u : v, none);
      addSide(owner, its);
    }
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void
PairPotential<Dim, T>::addRimsOfSegments(const EnergyDensity<T>& density,
                                         Vec2Of<T> (&rim)[2][4]) const
{
  using namespace branchFree;
  const T none(0.0), change = 2.0 / kappa_ * closureTilt_.x * size_;
  for (int end = 0; end < 2; ++end)
  {
    const T x = segment_.at[end], c = closureAt({x, none});
    const T whole =
        (end == 0 ? -1.0 : 1.0) * (density.constant + c * (density.linear + c * density.square));
    for (int f = 0; f < 2; ++f)
    {
      const Mask& its = segment_.of[end][f];
      if (!anyOf(its))
        continue;
      const int node = nodeAtEnd(f, end);
      T kept(1.0);
      for (int other = 0; other < 2; ++other)
      {
        const T near = absolute(shadow[1 - f].p[other].x - x);
        const Mask sameWay(nodeAtEnd(1 - f, end) == other);
        const SharedRim<T> shared = shareRim(4 * f + node, 4 * (1 - f) + other, sameWay, change);
        const T given =
            choose(near < shared.reach, shared.part * (1.0 - apartness(near / shared.reach)), none);
        kept = kept - given;
        rim[1 - f][other].x += choose(its, given * whole, none);
      }
      rim[f][node].x += choose(its, kept * whole, none);
    }
  }
}
} // namespace coplane
