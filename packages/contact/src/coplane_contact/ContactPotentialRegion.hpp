#pragma once

#include <coplane_contact/ContactPotential.hpp>

// Steps of PairPotential: the overlap of two shadows, the part of it in contact, and its moments.

namespace coplane
{
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::findOverlap()
{
  using namespace branchFree;
  pieces_ = 0;
  inOrder_ = false;
  if constexpr (Dim == 2 && widthOf<T> != 1)
    findOverlapOfSegments();
  else if constexpr (Dim == 2)
  {
    // A segment as a polygon without width: two "sides" that are its ends.
    pieces_ = 1;
    Owned& q = piece_[0];
    q.crushed = false;
    q.sides.size = 2;
    T low[2], high[2];
    for (int f = 0; f < 2; ++f)
    {
      const T &p = shadow[f].p[0].x, &r = shadow[f].p[1].x;
      low[f] = smaller(p, r);
      high[f] = larger(p, r);
    }
    const bool lowIs0 = low[0] > low[1], highIs0 = high[0] < high[1];
    const T from = lowIs0 ? low[0] : low[1], to = highIs0 ? high[0] : high[1];
    q.sides.from[0] = q.sides.to[0] = {from, T(0.0)};
    q.sides.from[1] = q.sides.to[1] = {to, T(0.0)};
    const auto nodeAt = [&](int f, bool upper)
    { return (shadow[f].p[1].x > shadow[f].p[0].x) == upper ? 1 : 0; };
    q.owner[0] = lowIs0 ? nodeAt(0, false) : 4 + nodeAt(1, false);
    q.owner[1] = highIs0 ? nodeAt(0, true) : 4 + nodeAt(1, true);
    overlap = positivePart(to - from);
    mostClosure = overlap > 0 ? larger(closureAt({from, 0}), closureAt({to, 0})) : -infinity;
    depth = around(0.5 * (from + to));
  }
  else
  {
    const detail::Outline<T> a(shadow[0], false), b(shadow[1], true);
    regular = isConvex(a.p, a.count) && isConvex(b.p, b.count);
    Owned& q = piece_[0];
    q.crushed = false;
    q.sides.size = a.count;
    for (int i = 0; i < a.count; ++i)
    {
      q.sides.from[i] = a.p[i];
      q.sides.to[i] = a.p[i + 1 == a.count ? 0 : i + 1];
      q.owner[i] = i;
    }
    for (int e = 0; e < b.count; ++e)
    {
      const Vec2Of<T> start = b.p[e];
      const Vec2Of<T> edge = b.p[e + 1 == b.count ? 0 : e + 1] - start;
      T from[PolygonSides<T>::capacity], to[PolygonSides<T>::capacity];
      for (int k = 0; k < q.sides.size; ++k)
      {
        from[k] = cross(edge, q.sides.from[k] - start);
        to[k] = cross(edge, q.sides.to[k] - start);
      }
      detail::cutOwned(q, from, to, 4 + e);
    }
    regular = regular && !q.sides.crossed;
    pieces_ = 1;
    measureOverlap();
  }
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::measureOverlap()
{
  using namespace branchFree;
  overlap = T(0.0);
  mostClosure = T(-infinity);
  for (int i = 0; i < pieces_; ++i)
  {
    const PolygonSides<T>& sides = piece_[i].sides;
    const T area = areaAndCentroid(sides).area;
    overlap += positivePart(area);
    for (int k = 0; k < sides.size; ++k)
      mostClosure = choose(sides.isThere(k) && area > 0.0,
                           larger(closureAt(sides.from[k]), mostClosure), mostClosure);
  }
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION T PairPotential<Dim, T>::leastClosure() const
{
  using namespace branchFree;
  T least(infinity);
  if constexpr (Dim == 2 && widthOf<T> != 1)
    for (const T& at : segment_.at)
      least = choose(moments.area > 0.0, smaller(closureAt({at, T(0.0)}), least), least);
  else
    for (int i = 0; i < pieces_; ++i)
    {
      const PolygonSides<T>& sides = piece_[i].sides;
      for (int k = 0; k < sides.size; ++k)
      {
        const Mask there = Dim == 2 ? Mask(true) : sides.isThere(k);
        least = choose(there, smaller(closureAt(sides.from[k]), least), least);
      }
    }
  return least;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::findPieces(bool whole)
{
  const detail::Outline<T> a(shadow[0], false), b(shadow[1], true);
  pieces_ = 0;
  inOrder_ = true;
  Owned partsA[2], partsB[2];
  int countA = convexParts(a, 0, partsA), countB = convexParts(b, 4, partsB);
  if (!whole)
  {
    countA = countA > 0 ? countA : foldedPart(a, 0, partsA[0]);
    countB = countB > 0 ? countB : foldedPart(b, 4, partsB[0]);
  }
  for (int i = 0; i < countA; ++i)
    for (int j = 0; j < countB; ++j)
    {
      Owned& q = piece_[pieces_++];
      q = partsA[i];
      for (int e = 0; e < partsB[j].sides.size; ++e)
      {
        const Vec2 start = partsB[j].sides.from[e], edge = partsB[j].sides.to[e] - start;
        Real at[PolygonSides<Real>::capacity];
        for (int k = 0; k < q.sides.size; ++k)
          at[k] = cross(edge, q.sides.from[k] - start);
        detail::cutOwnedInOrder(q, at, partsB[j].owner[e]);
      }
    }
  measureOverlap();
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION int PairPotential<Dim, T>::convexParts(const detail::Outline<T>& outline,
                                                              int firstOwner, Owned (&parts)[2])
{
  const auto fill = [&](Owned& part, const int* corners, int count)
  {
    part.sides.size = count;
    for (int i = 0; i < count; ++i)
    {
      const int c = corners[i], d = corners[i + 1 == count ? 0 : i + 1];
      part.sides.from[i] = outline.p[c];
      part.sides.to[i] = outline.p[d];
      part.owner[i] = d == (c + 1 == outline.count ? 0 : c + 1) ? firstOwner + c : Owned::noEdge;
    }
  };
  if (isConvex(outline.p, outline.count))
  {
    const int all[4] = {0, 1, 2, 3};
    fill(parts[0], all, outline.count);
    return 1;
  }
  for (int d = 0; d < 2 && outline.count == 4; ++d)
  {
    const int first[3] = {d, d + 1, d + 2}, second[3] = {d, d + 2, (d + 3) % 4};
    const auto convex = [&](const int* c)
    { return cross(outline.p[c[1]] - outline.p[c[0]], outline.p[c[2]] - outline.p[c[1]]) > 0; };
    if (!convex(first) || !convex(second))
      continue;
    fill(parts[0], first, 3);
    fill(parts[1], second, 3);
    return 2;
  }
  return 0; // folded
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION int PairPotential<Dim, T>::foldedPart(const detail::Outline<T>& outline,
                                                             int firstOwner, Owned& part)
{
  if (outline.count != 4)
    return 0;
  for (int e = 0; e < 2; ++e)
  {
    const int f = e + 2, afterE = e + 1, afterF = (e + 3) % 4;
    const Vec2 a = outline.p[e], c = outline.p[f];
    const Vec2 along = outline.p[afterE] - a, other = outline.p[afterF] - c;
    const Real sine = cross(along, other);
    const Real onE = cross(c - a, other), onF = cross(c - a, along); // times sine
    const Real sign = sine > 0 ? 1 : -1;
    if (!(sine != 0 && sign * onE >= 0 && sign * (onE - sine) <= 0 && sign * onF >= 0 &&
          sign * (onF - sine) <= 0))
      continue;
    // From the crossing to the end of f, along the edge after f, and along e back to it; or the
    // other way round.
    const Vec2 crossing = a + (onE / sine) * along;
    const bool upright = cross(crossing - a, outline.p[afterF] - a) > 0;
    Folded& folded = folded_[firstOwner / 4];
    const Vec2 corners[3] = {crossing, upright ? outline.p[afterF] : outline.p[afterE],
                             upright ? a : c};
    const int edges[3] = {upright ? f : e, upright ? afterF : afterE, upright ? e : f};
    part.sides.size = 3;
    for (int i = 0; i < 3; ++i)
    {
      folded.corner[i] = part.sides.from[i] = corners[i];
      part.sides.to[i] = corners[i == 2 ? 0 : i + 1];
      folded.edge[i] = edges[i];
      part.owner[i] = firstOwner + edges[i];
    }
    folded.area = 0.5 * cross(corners[1] - crossing, corners[2] - crossing);
    const Real whole = 0.5 * cross(outline.p[2] - outline.p[0], outline.p[3] - outline.p[1]);
    folded.share = folded.area > 0 ? whole / folded.area : 0;
    return folded.area > 0 ? 1 : 0;
  }
  return 0;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::pressAll(const Mask& whole)
{
  moments = {};
  if constexpr (branchFree::widthOf<T> == 1)
    ofCrushed_ = {};
  for (T& way : ways_)
    way = T(0.0);
  for (int f = 0; f < 2; ++f)
    coveredSides_[f] = openSides_[f] = T(0.0);
  for (int i = 0; i < pieces_; ++i)
  {
    if constexpr (branchFree::widthOf<T> == 1)
      whole_[i] = piece_[i];
    cutAndIntegrate(piece_[i], whole);
  }
  joinStrips();
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void PairPotential<Dim, T>::cutAndIntegrate(Owned& q, const Mask& whole)
{
  if constexpr (Dim == 2 && branchFree::widthOf<T> != 1)
    integrateSegments(whole);
  else if constexpr (Dim == 2)
  {
    if (overlap > 0)
      integrateSegment(q, whole);
  }
  else
  {
    cutPolygon(q, whole);
    integratePolygon(q, whole);
  }
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void PairPotential<Dim, T>::integrateSegment(Owned& q,
                                                                         const Mask& whole)
{
  T &from = q.sides.from[0].x, &to = q.sides.from[1].x;
  const T c0 = closureIn(q, {from, 0}), c1 = closureIn(q, {to, 0});
  if (!whole && !(c0 > 0 || c1 > 0))
  {
    q.sides.size = 0;
    return;
  }
  const T cut = from + (to - from) * c0 / (c0 - c1);
  if (!whole && c0 < 0)
  {
    from = cut;
    q.owner[0] = Owned::closureLine;
  }
  if (!whole && c1 < 0)
  {
    to = cut;
    q.owner[1] = Owned::closureLine;
  }
  const T u = closureIn(q, {from, 0}), v = closureIn(q, {to, 0}), width = to - from;
  if (!(width > 0))
  {
    q.sides.size = 0;
    return;
  }
  ContactMoments<T> sum;
  sum.area = width;
  sum.volume = 0.5 * width * (u + v);
  sum.squares = width / 3.0 * (u * u + u * v + v * v);
  sum.areaMoment.x = 0.5 * width * (from + to);
  sum.volumeMoment.x = width / 6.0 * (2.0 * (u * from + v * to) + u * to + v * from);
  if constexpr (canRevolve)
    if (scale_.axisymmetric)
      sum = momentsOfRing(q);
  moments.add(sum);
  if constexpr (branchFree::widthOf<T> == 1)
    if (q.crushed)
      ofCrushed_.add(sum);
  for (int k = 0; k < 2; ++k)
    if (const int owner = q.owner[k]; owner >= 0)
    {
      if (edges_.exits[owner] > 0)
        ways_[wayOf(owner)] += around(q.sides.from[k].x) * closureIn(q, q.sides.from[k]);
      addSide(owner, true);
    }
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void PairPotential<Dim, T>::cutPolygon(Owned& q, const Mask& whole)
{
  using namespace branchFree;
  T from[PolygonSides<T>::capacity], to[PolygonSides<T>::capacity];
  for (int k = 0; k < q.sides.size; ++k)
  {
    from[k] = choose(whole, T(1.0), closureIn(q, q.sides.from[k]));
    to[k] = choose(whole, T(1.0), closureIn(q, q.sides.to[k]));
  }
  if constexpr (widthOf<T> == 1)
  {
    if (inOrder_)
      detail::cutOwnedInOrder(q, from, Owned::closureLine);
    else
    {
      detail::cutOwned(q, from, to, Owned::closureLine);
      regular = regular && !q.sides.crossed;
    }
  }
  else
  {
    detail::cutOwned(q, from, to, Owned::closureLine);
    regular = regular && !q.sides.crossed;
  }
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void PairPotential<Dim, T>::integratePolygon(const Owned& q,
                                                                         const Mask& whole)
{
  using namespace branchFree;
  Vec2Of<T> apex;
  for (int k = 0; k < q.sides.size; ++k)
    apex = coplane::choose(q.sides.isThere(k), q.sides.from[k], apex);
  const T atApex = closureIn(q, apex);
  ContactMoments<T> sum;
  T border[waysOfEdges ? 8 : 2]{};
  for (int k = 0; k < q.sides.size; ++k)
  {
    const Vec2Of<T>&p = q.sides.from[k], &r = q.sides.to[k];
    sum.add(apex, p, r, atApex, closureIn(q, p), closureIn(q, r));
    if (q.owner[k] >= 0)
    {
      addSide(q.owner[k], q.sides.isThere(k));
      const T& exit = edges_.exits[q.owner[k]];
      if (anyOf(exit > 0.0))
        border[wayOf(q.owner[k])] +=
            0.5 * exit * squareRoot(dot(r - p, r - p)) * (closureIn(q, p) + closureIn(q, r));
    }
  }
  const auto there = sum.area > 0.0 && plane.opposed && (whole || sum.volume > 0.0);
  const T none(0.0);
  moments.area += choose(there, sum.area, none);
  moments.volume += choose(there, sum.volume, none);
  moments.squares += choose(there, sum.squares, none);
  moments.areaMoment =
      moments.areaMoment + coplane::choose(there, sum.areaMoment, Vec2Of<T>{none, none});
  moments.volumeMoment =
      moments.volumeMoment + coplane::choose(there, sum.volumeMoment, Vec2Of<T>{none, none});
  for (int i = 0; i < int(sizeof border / sizeof *border); ++i)
    ways_[i] += choose(there, border[i], none);
  if constexpr (widthOf<T> == 1)
    if (q.crushed && there)
      ofCrushed_.add(sum);
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION T PairPotential<Dim, T>::facing(int ownerOf0, int ownerOf1) const
{
  if constexpr (Dim == 2)
    return T(1.0); // both ends of a segment, or they would not be there both
  else
    return -dot(outwardOf(ownerOf0), outwardOf(ownerOf1));
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION typename PairPotential<Dim, T>::Strip
PairPotential<Dim, T>::stripBetween(int ownerOf0, int ownerOf1) const
{
  using namespace branchFree;
  const T &a = ways_[ownerOf0], &b = ways_[ownerOf1];
  const Mask both = a > 0.0 && b > 0.0;
  Strip strip;
  if (!anyOf(both))
    return strip;
  const T cosine = positivePart(facing(ownerOf0, ownerOf1)), none(0.0);
  strip.facing = choose(both, cosine * cosine, none);
  strip.closure = choose(both, 4.0 * a * b / (a + b), none);
  return strip;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::joinStrips()
{
  using namespace branchFree;
  if constexpr (waysOfEdges)
  {
    strips_ = T(0.0);
    T each[16], most(0.0);
    for (int i = 0; i < 16; ++i)
    {
      const Strip strip = stripBetween(i / 4, 4 + i % 4);
      each[i] = strip.facing * strip.closure;
      most = larger(each[i], most);
    }
    const Mask any = most > 0.0;
    if (!anyOf(any))
      return;
    T sum(0.0);
    for (const T& closure : each)
    {
      const T part = choose(any, closure / most, T(0.0)), square = part * part;
      sum += square * square;
    }
    strips_ = most * squareRoot(squareRoot(sum));
  }
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Real PairPotential<Dim, T>::slopeOfWay(int owner) const
{
  Real slope = 0; // of the logarithm
  for (int e = 0; e < 4; ++e)
  {
    const int other = owner < 4 ? 4 + e : e;
    const Strip strip = stripBetween(owner < 4 ? owner : other, owner < 4 ? other : owner);
    const Real part = strip.facing * strip.closure / strips_;
    if (!(part > 0))
      continue;
    const Real share = 2 * ways_[other] / (ways_[owner] + ways_[other]);
    slope += part * part * part * strip.facing * share * share / strips_;
  }
  return alongStrip_ * slope;
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void PairPotential<Dim, T>::addSide(int owner, const Mask& isThere)
{
  using namespace branchFree;
  const T none(0.0);
  const T& covered = edges_.covered[owner];
  coveredSides_[owner / 4] += choose(isThere, covered, none);
  openSides_[owner / 4] += choose(isThere && !(covered > 0.0), edges_.turns[owner], none);
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION T PairPotential<Dim, T>::acrossStrip() const
{
  const T apart = 1.0 - SmoothStep<T>(4.0 * overlap / size_ - 2.0).value;
  if constexpr (waysOfEdges)
    return strips_ * apart;
  else // all of one face against all of the other; one border against several would be 1.42 times
       // that
    return 1.5 * (4.0 * ways_[0] * ways_[1] / (ways_[0] + ways_[1])) * apart;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::findStrip(const Mask& whole)
{
  const T &v = moments.volume, &s = moments.squares;
  Mask between = !whole && v > 0.0;
  if constexpr (waysOfEdges)
    between = between && strips_ > 0.0;
  else
    between = between && ways_[0] > 0.0 && ways_[1] > 0.0;
  strip_ = between && v * v < scale_.wayOutTo * s * acrossStrip();
  nothing_ = Mask(false);
  if (!branchFree::anyOf(strip_))
    return;
  if constexpr (waysOfEdges)
    nothing_ = strip_ && !(v * v / (s * acrossStrip()) > scale_.wayOutFrom);
  if constexpr (branchFree::widthOf<T> != 1)
    regular = regular && !(strip_ && !nothing_);
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION typename PairPotential<Dim, T>::Mask
PairPotential<Dim, T>::isWithinASurface() const
{
  using namespace branchFree;
  constexpr Real least = 0.25;
  T all(2.0), open[2] = {coveredSides_[0] + openSides_[0], coveredSides_[1] + openSides_[1]};
  if constexpr (Dim == 3)
  {
    all = open[0] = open[1] = T(0.0);
    for (int i = 0; i < pieces_; ++i)
      for (int k = 0; k < piece_[i].sides.size; ++k)
      {
        const PolygonSides<T>& sides = piece_[i].sides;
        const Vec2Of<T> side = sides.to[k] - sides.from[k];
        const T length = choose(sides.isThere(k), squareRoot(dot(side, side)), T(0.0));
        all += length;
        if (const int owner = piece_[i].owner[k]; owner >= 0)
          open[owner / 4] +=
              choose(edges_.turns[owner] + edges_.covered[owner] > 0.0, length, T(0.0));
      }
  }
  return smaller(open[0], open[1]) < least * all;
}
} // namespace coplane
