#pragma once

#include <coplane_contact/ContactPotential.hpp>

// Steps of PairPotential: the gradient along the border of the part in contact.

namespace coplane
{
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void
PairPotential<Dim, T>::addRims(const Owned& q, const EnergyDensity<T>& density,
                               Vec2Of<T> (&rim)[2][4], bool ofRing) const
{
  if constexpr (Dim == 2 && branchFree::widthOf<T> != 1)
    addRimsOfSegments(density, rim);
  else
    for (int k = 0; k < q.sides.size; ++k)
      if (q.owner[k] >= 0)
      {
        if constexpr (Dim == 3)
          addRimOfSide(q, k, density, rim);
        else if (moments.area > 0)
          addRimOfEnd(q, k, density, ofRing, rim);
      }
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void
PairPotential<Dim, T>::addRimOfEnd(const Owned& q, int end, const EnergyDensity<T>& density,
                                   bool ofRing, Vec2Of<T> (&rim)[2][4]) const
{
  using namespace branchFree;
  const auto at = [&](const T& c)
  { return density.constant + c * (density.linear + c * density.square); };
  const int f = q.owner[end] / 4, node = q.owner[end] % 4;
  const T x = q.sides.from[end].x;
  T whole = (end == 0 ? -1.0 : 1.0) * at(closureIn(q, {x, 0}));
  if (ofRing)
    whole *= around(x);
  T change = 2 / kappa_ * closureTilt_.x * size_;
  if constexpr (widthOf<T> == 1)
    if (q.crushed)
      change += crushed_.slope.x * size_;
  T kept = 1;
  for (int other = 0; other < 2; ++other)
  {
    const T near = absolute(shadow[1 - f].p[other].x - x);
    const bool upper = shadow[1 - f].p[other].x > shadow[1 - f].p[1 - other].x;
    const SharedRim<T> shared =
        shareRim(q.owner[end], 4 * (1 - f) + other, upper == (end == 1), change);
    if (!(near < shared.reach))
      continue;
    const T given = shared.part * (1 - apartness(near / shared.reach));
    kept -= given;
    rim[1 - f][other].x += given * whole;
  }
  rim[f][node].x += kept * whole;
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void
PairPotential<Dim, T>::addRimOfSide(const Owned& q, int k, const EnergyDensity<T>& density,
                                    Vec2Of<T> (&rim)[2][4]) const
{
  using namespace branchFree;
  const int f = q.owner[k] / 4, e = q.owner[k] % 4, g = 1 - f;
  const Vec2Of<T>&from = q.sides.from[k], &to = q.sides.to[k];
  const auto there = q.sides.isThere(k) && moments.area > 0.0;
  if (!anyOf(there))
    return;
  const T u = closureIn(q, from), v = closureIn(q, to);
  const T total = density.square / 3.0 * (u * u + u * v + v * v) + density.linear / 2.0 * (u + v) +
                  density.constant;
  const T second = density.square / 12.0 * (u * u + 2.0 * u * v + 3.0 * v * v) +
                   density.linear / 6.0 * (u + 2.0 * v) + 0.5 * density.constant;
  const Vec2Of<T> d = to - from;
  const Vec2Of<T> own = shadow[f].p[nodeOfEdge(f, e, 1)] - shadow[f].p[nodeOfEdge(f, e, 0)];
  T kept(1.0);
  for (int o = 0; o < face_[g]->count; ++o)
  {
    const Vec2Of<T>& start = shadow[g].p[nodeOfEdge(g, o, 0)];
    const Vec2Of<T> edge = shadow[g].p[nodeOfEdge(g, o, 1)] - start;
    const T near = larger(absolute(cross(edge, from - start)), absolute(cross(edge, to - start)));
    if (!anyOf(near < size_ * scale_.oneBorder))
      continue;
    const T along = dot(edge, d);
    const T longer = larger(dot(edge, edge), dot(own, own));
    T change = 2.0 / kappa_ * cross(closureTilt_, d) * size_ / squareRoot(dot(d, d) * longer);
    if constexpr (widthOf<T> == 1)
      if (q.crushed)
        change += cross(crushed_.slope, d) * size_ / squareRoot(dot(d, d) * longer);
    const SharedRim<T> shared = shareRim(q.owner[k], 4 * g + o, along > 0.0, change);
    const auto close =
        near < shared.reach && along * along > 0.5 * dot(edge, edge) * dot(d, d) && there;
    if (!anyOf(close))
      continue;
    const T given = choose(close, shared.part * (1.0 - apartness(near / shared.reach)), T(0.0));
    kept = kept - given;
    addRim(g, o, close, from, to, total, second, given, rim);
  }
  addRim(f, e, there, from, to, total, second, kept, rim);
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION SharedRim<T>
PairPotential<Dim, T>::shareRim(int mine, int its, const Mask& sameWay, const T& change) const
{
  using namespace branchFree;
  const auto turns = edges_.turns[mine] > 0.0, itTurns = edges_.turns[its] > 0.0;
  const auto border = turns && itTurns;
  const T tilted = absolute(change) * moments.area, closed = absolute(moments.volume);
  const T flatness =
      choose(closed > 0.0, 1.0 - SmoothStep<T>(2.0 * tilted / closed - 1.0).value, T(0.0));
  const T even = 0.5 * flatness;
  const auto isEdge = turns || edges_.seams[mine] > 0.0, itIs = itTurns || edges_.seams[its] > 0.0;
  const T ofLine = choose(isEdge, even, choose(itIs, 1.0 - even, T(0.5)));
  const T wider = choose(border, flatness * (scale_.oneBorder - scale_.oneEdge), T(0.0));
  return {size_ * (scale_.oneEdge + wider),
          choose(border, choose(sameWay, T(0.5), T(0.0)), ofLine)};
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void
PairPotential<Dim, T>::addRim(int f, int e, const Mask& there, const Vec2Of<T>& from,
                              const Vec2Of<T>& to, const T& total, const T& second, const T& part,
                              Vec2Of<T> (&rim)[2][4]) const
{
  using namespace branchFree;
  const int i0 = nodeOfEdge(f, e, 0), i1 = nodeOfEdge(f, e, 1);
  const Vec2Of<T>& start = shadow[f].p[i0];
  const Vec2Of<T> edge = shadow[f].p[i1] - start, outward{to.y - from.y, from.x - to.x};
  // A side of the length of round-off has any direction.
  const T crossing = cross(edge, outward);
  const auto beside = crossing * crossing > 0.25 * dot(edge, edge) * dot(outward, outward);
  const T inverse = choose(beside, 1.0 / crossing, T(0.0));
  const T la = inverse * cross(from - start, outward), lb = inverse * cross(to - start, outward);
  const T none(0.0);
  const T atEnd = choose(there, part * ((total - second) * la + second * lb), none);
  const T atStart = choose(there, part * total - atEnd, none);
  rim[f][i1] = rim[f][i1] + atEnd * outward;
  rim[f][i0] = rim[f][i0] + atStart * outward;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::addStrip(const Real& scale, Real& push,
                                                            Vec2& first, Vec2 (&rim)[2][4])
{
  for (int i = 0; i < pieces_; ++i)
    for (int k = 0; k < piece_[i].sides.size; ++k)
      if (const int owner = piece_[i].owner[k]; owner >= 0 && edges_.exits[owner] > 0)
        addBorder(piece_[i], k, slopeOfWay(owner), push, first, rim);
  addFacing(rim);
  const Real shared = overlap / size_;
  const SmoothStep<Real> together(4 * shared - 2);
  if (!(together.slope > 0))
    return;
  const Real perShare = -4 * alongStrip_ * together.slope / (1 - together.value);
  for (int i = 0; i < pieces_; ++i)
    addRims(whole_[i], {0, 0, perShare / size_}, rim, false);
  const int smallest = face_[0]->area < face_[1]->area ? 0 : 1;
  byVectorArea(smallest, (-scale * perShare * shared / size_) * face_[smallest]->normal);
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::weighGrowing(const Real& stored, Real& slope)
{
  const SoftStep<Real> part(overlap * perShare() / grownAt);
  alongShare_ = stored * wayOut * part.slope / grownAt;
  wayOut *= part.value;
  slope *= part.value;
  alongStrip_ *= part.value;
  if constexpr (canFold)
    for (Folded& folded : folded_)
      folded.slope *= part.value;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::addGrowth(const Real& scale, Vec2 (&rim)[2][4])
{
  for (int i = 0; i < pieces_; ++i)
    addRims(whole_[i], {0, 0, alongShare_ * perShare()}, rim, false);
  for (int f = 0; f < 2; ++f)
  {
    const Real area = face_[f]->area;
    byVectorArea(f, (-0.5 * scale * alongShare_ * overlap / (area * area * area * perShare())) *
                        face_[f]->normal);
  }
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Real PairPotential<Dim, T>::growthStiffness(Real deepest) const
{
  if (!growing_ || !(overlap * perShare() < grownAt))
    return 0;
  Real border = Dim == 2 ? 1 : 0; // the square of its length
  for (int f = 0; f < 2 && Dim == 3; ++f)
    for (int i = 0; i < face_[f]->count && face_[f]->area == size_; ++i)
    {
      const Vec3 edge = face_[f]->x[i + 1 == face_[f]->count ? 0 : i + 1] - face_[f]->x[i];
      border = branchFree::larger(dot(edge, edge), border);
    }
  return 1.69 / grownAt * deepest * deepest * border / size_;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::addFacing(Vec2 (&rim)[2][4]) const
{
  if constexpr (Dim == 3)
    for (int i = 0; i < 16; ++i)
    {
      const int owners[2] = {i / 4, 4 + i % 4};
      const Strip strip = stripBetween(owners[0], owners[1]);
      const Real part = strip.facing * strip.closure / strips_, square = part * part;
      if (!(part > 0))
        continue;
      const Real slope = 2 * alongStrip_ * square * square / facing(owners[0], owners[1]);
      for (int f = 0; f < 2; ++f)
      {
        const int i0 = nodeOfEdge(f, owners[f] % 4, 0), i1 = nodeOfEdge(f, owners[f] % 4, 1);
        const Vec2 along = shadow[f].p[i1] - shadow[f].p[i0];
        const Vec2 turn = (slope * dot(along, outwardOf(owners[1 - f])) / dot(along, along)) *
                          outwardOf(owners[f]);
        rim[f][i1] = rim[f][i1] + turn;
        rim[f][i0] = rim[f][i0] - turn;
      }
    }
}

namespace detail
{
/// A place is that of a node when the square of its distance is below this part of that of the
/// border beside it [-], 1e-10 of its length: places come from nodes by cuts, with round-off.
constexpr Real squareOfSameNode = 1e-20;
/// Borders that meet at a flatter angle than this go on in each other, and have no corner [-].
constexpr Real leastSine = 1e-6;
} // namespace detail

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::addBorder(const Owned& q, int k, Real slope,
                                                             Real& push, Vec2& first,
                                                             Vec2 (&rim)[2][4])
{
  Vec2 falls = (2 / kappa_) * closureTilt_; // closure, along the plane
  if (q.crushed)
    falls = falls + crushed_.slope;
  const int owner = q.owner[k];
  if constexpr (Dim == 2)
  {
    const Vec2& at = q.sides.from[k];
    const Real depth = around(at.x);
    if (q.crushed)
      carryCrushing(slope * depth, (slope * depth) * at, rim);
    push += slope * depth;
    first = first + (slope * depth) * at;
    rim[owner / 4][owner % 4].x -= slope * depth * falls.x;
    if constexpr (canRevolve)
      if (scale_.axisymmetric)
      {
        const Real ofDepth = slope * closureIn(q, at);
        rim[owner / 4][owner % 4].x += ofDepth * (radius_[0].slope + radius_[1].slope);
        addHoop(at.x, ofDepth);
      }
    return;
  }
  const Vec2 along = q.sides.to[k] - q.sides.from[k];
  const Real length = std::sqrt(dot(along, along));
  if (!(length > 0) || !q.sides.isThere(k))
    return;
  const Vec2 t = (1 / length) * along, n{t.y, -t.x};
  const Vec2 middle = 0.5 * (q.sides.from[k] + q.sides.to[k]);
  push += slope * length;
  first = first + (slope * length) * middle;
  if (q.crushed)
    carryCrushing(slope * length, (slope * length) * middle, rim);
  pushEdge(owner, middle, (-slope * length * dot(falls, n)) * n, rim);
  for (int end = 0; end < 2; ++end)
  {
    const Vec2 p = end == 0 ? q.sides.from[k] : q.sides.to[k];
    int next = -1;
    Real nearest = infinity;
    for (int j = 0; j < q.sides.size; ++j)
    {
      const Vec2 r = (end == 0 ? q.sides.to[j] : q.sides.from[j]) - p;
      if (j == k || !q.sides.isThere(j) || !(dot(r, r) < nearest))
        continue;
      nearest = dot(r, r);
      next = j;
    }
    // Where a joint ceases to be crushed, the two sides cancel.
    if (next < 0 || q.owner[next] == Owned::closureLine || q.owner[next] == Owned::crushedLine)
      continue;
    const Real further = (end == 0 ? -slope : slope) * closureIn(q, p);
    if (q.owner[next] == Owned::noEdge)
    {
      // A diagonal: it ends at a node of its own face, and cuts the other face for both pieces.
      const int node = nodeOfEdge(owner / 4, owner % 4, end);
      const Vec2 off = p - shadow[owner / 4].p[node];
      if (dot(off, off) < detail::squareOfSameNode * length * length)
        rim[owner / 4][node] = rim[owner / 4][node] + further * t;
      continue;
    }
    const Vec2 other = outwardOf(q.owner[next]);
    const Real sine = dot(other, t);
    if (!(std::abs(sine) > detail::leastSine))
      continue;
    const Real ofOther = further / sine;
    pushEdge(owner, p, (-ofOther * dot(other, n)) * n, rim);
    pushEdge(q.owner[next], p, ofOther * other, rim);
  }
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::weighFolded(const Real& stored, Real& slope)
{
  const SmoothStep<Real> parts[2] = {SmoothStep<Real>(folded_[0].share),
                                     SmoothStep<Real>(folded_[1].share)};
  for (int f = 0; f < 2; ++f)
    folded_[f].slope = stored * wayOut * parts[1 - f].value * parts[f].slope;
  const Real both = parts[0].value * parts[1].value;
  wayOut *= both;
  slope *= both;
  alongStrip_ *= both;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::addFolded(int f, Vec2 (&rim)[2][4]) const
{
  const Folded& folded = folded_[f];
  const Real perArea = folded.slope / folded.area;
  const ShadowOf<T>& s = shadow[f];
  const Real half = f == 0 ? 0.5 : -0.5; // corners of the higher face go round the other way
  for (int i = 0; i < 4; ++i)
  {
    const Vec2 across = s.p[(i + 1) % 4] - s.p[(i + 3) % 4];
    rim[f][i] = rim[f][i] + (perArea * half) * Vec2{across.y, -across.x};
  }
  for (int k = 0; k < 3; ++k)
    addRim(f, folded.edge[k], true, folded.corner[k], folded.corner[(k + 1) % 3], 1.0, 0.5,
           -perArea * folded.share, rim);
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Vec2Of<T> PairPotential<Dim, T>::outwardOf(int owner) const
{
  const int f = owner / 4, e = owner % 4;
  const Vec2Of<T> d = shadow[f].p[nodeOfEdge(f, e, 1)] - shadow[f].p[nodeOfEdge(f, e, 0)];
  return (1.0 / branchFree::squareRoot(dot(d, d))) * Vec2Of<T>{d.y, -d.x};
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::pushEdge(int owner, const Vec2& at,
                                                            const Vec2& slope,
                                                            Vec2 (&rim)[2][4]) const
{
  const int f = owner / 4, e = owner % 4;
  const int i0 = nodeOfEdge(f, e, 0), i1 = nodeOfEdge(f, e, 1);
  const Vec2 d = shadow[f].p[i1] - shadow[f].p[i0];
  const Real part = dot(at - shadow[f].p[i0], d) / dot(d, d);
  rim[f][i0] = rim[f][i0] + (1 - part) * slope;
  rim[f][i1] = rim[f][i1] + part * slope;
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION T PairPotential<Dim, T>::apartness(const T& distance) const
{
  return SmoothStep<T>(2.0 * distance - 1.0).value;
}
} // namespace coplane
