#pragma once

#include <coplane_contact/ContactPotential.hpp>

#include <cmath>

// Steps of PairPotential for joints that are crushed unevenly (docs/theory/joints.md, "Uneven
// crushing"), and for joints that have absorbed uneven gaps (docs/theory/scp.md, "Declared
// joints").

namespace coplane
{
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::splitWhereCrushed()
{
  const int before = pieces_;
  for (int i = 0; i < before; ++i)
  {
    Owned& q = piece_[i];
    Real least = infinity, most = -infinity;
    forEachCorner(q,
                  [&](const Vec2& p)
                  {
                    least = branchFree::smaller(crushed_.at(p), least);
                    most = branchFree::larger(crushed_.at(p), most);
                  });
    q.crushed = most > 0;
    if (!(most > 0 && least < 0))
      continue;
    Owned& rest = piece_[pieces_++];
    rest = q;
    rest.crushed = false;
    cutWhereNegative(q, crushed_);
    cutWhereNegative(rest, {-crushed_.atOrigin, -1 * crushed_.slope});
    regular = regular && !q.sides.crossed && !rest.sides.crossed;
  }
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::addCrushing(const EnergyDensity<T>& density,
                                                               Vec2 (&rim)[2][4]) const
{
  const ContactMoments<Real>& m = ofCrushed_;
  carryCrushing(2 * density.square * m.volume + density.linear * m.area,
                (2 * density.square) * m.volumeMoment + density.linear * m.areaMoment, rim);
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::carryCrushing(Real push, const Vec2& first,
                                                                 Vec2 (&rim)[2][4]) const
{
  carry(frame_, crushed_.slope, push, first, rim[0]);
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void
PairPotential<Dim, T>::carry(const AffineFrameOf<T>& frame, const Vec2Of<T>& slope, const T& push,
                             const Vec2Of<T>& first, Vec2Of<T> (&rim)[4])
{
  const Vec2Of<T> about = first - push * frame.center;
  for (int i = 0; i < frame.count; ++i)
  {
    const T part = push / frame.count + dot(frame.weightSlope(i), about);
    rim[i] = rim[i] + part * slope;
  }
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::putOnLayers()
{
  using branchFree::choose;
  const T half = 0.5 * kappa_;
  for (int f = 0; f < 2; ++f)
  {
    const LinearOnPlaneOf<T> one = layer(f);
    atPoint_ = choose(laidLanes_, atPoint_ - one.atOrigin, atPoint_);
    closureTilt_.x = choose(laidLanes_, closureTilt_.x + half * one.slope.x, closureTilt_.x);
    closureTilt_.y = choose(laidLanes_, closureTilt_.y + half * one.slope.y, closureTilt_.y);
  }
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::carryLayers(const T& push,
                                                               const Vec2Of<T>& first,
                                                               Vec2Of<T> (&rim)[2][4]) const
{
  using branchFree::choose;
  for (int f = 0; f < 2; ++f)
  {
    Vec2Of<T> carried[4];
    for (int i = 0; i < face_[f]->count; ++i)
      carried[i] = rim[f][i];
    carry(AffineFrameOf<T>(shadow[f]), layer(f).slope, push, first, carried);
    for (int i = 0; i < face_[f]->count; ++i)
      rim[f][i] = {choose(laidLanes_, carried[i].x, rim[f][i].x),
                   choose(laidLanes_, carried[i].y, rim[f][i].y)};
  }
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Real PairPotential<Dim, T>::unevenGap(const Vec2& place,
                                                             LinearOnFace (&laid)[2]) const
{
  const Vec2 slope = (-1 / kappa_) * tilt_; // of half of the closure
  const LinearOnPlane half{-dot(slope, place), slope};
  Real change = 0;
  for (int f = 0; f < 2; ++f)
  {
    laid[f] = AffineFrame(shadow[f]).onFace(half);
    for (const Real along : laid[f].along)
      change = branchFree::larger(2 * std::fabs(along), change);
  }
  return change;
}

template <int Dim, class T>
template <class F>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::forEachCorner(const Owned& q, const F& f) const
{
  for (int k = 0; k < q.sides.size; ++k)
    if (Dim == 2 || q.sides.isThere(k))
      f(q.sides.from[k]);
}

template <int Dim, class T>
template <class F>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::forEachSide(const Owned& q, const F& f) const
{
  if (Dim == 2 && q.sides.size > 0)
    f(q.sides.from[0], q.sides.from[1]);
  for (int k = 0; Dim == 3 && k < q.sides.size; ++k)
    if (q.sides.isThere(k))
      f(q.sides.from[k], q.sides.to[k]);
}

template <int Dim, class T>
template <class F>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::forEachSlice(const Owned& q,
                                                                const LinearOnPlane& closure,
                                                                Real from, const F& f) const
{
  constexpr Real places[4] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                              0.8611363115940526};
  constexpr Real weights[4] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                               0.3478548451374538};
  const Real steepness = std::sqrt(dot(closure.slope, closure.slope));
  const Vec2 up = (1 / steepness) * closure.slope;
  // Corners by how far up they are.
  Real at[PolygonSides<Real>::capacity];
  int count = 0;
  forEachCorner(q,
                [&](const Vec2& p)
                {
                  const Real height = dot(up, p);
                  int i = count++;
                  for (; i > 0 && at[i - 1] > height; --i)
                    at[i] = at[i - 1];
                  at[i] = height;
                });
  const auto widthAt = [&](Real height)
  {
    if (Dim == 2)
      return around(height * up.x);
    Real low = infinity, high = -infinity;
    for (int k = 0; k < q.sides.size; ++k)
    {
      const Real a = dot(up, q.sides.from[k]), b = dot(up, q.sides.to[k]);
      if ((a < height) == (b < height))
        continue;
      const Real ofA = cross(up, q.sides.from[k]), ofB = cross(up, q.sides.to[k]);
      const Real across = ofA + (height - a) / (b - a) * (ofB - ofA);
      low = branchFree::smaller(across, low);
      high = branchFree::larger(across, high);
    }
    return high > low ? high - low : 0.0;
  };
  const Real start = (from - closure.atOrigin) / steepness;
  for (int k = 0; k + 1 < count; ++k)
  {
    const Real low = branchFree::larger(at[k], start), high = at[k + 1];
    if (!(high > low))
      continue;
    const Real middle = 0.5 * (low + high), half = 0.5 * (high - low);
    for (int g = 0; g < 4; ++g)
    {
      const Real height = middle + half * places[g];
      f(closure.atOrigin + steepness * height, weights[g] * half * widthAt(height));
    }
  }
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION bool PairPotential<Dim, T>::crushFurther(const Crushing& law, Real stiffness,
                                                                Real even, LinearOnFace& to) const
{
  const Real onset = law.onset(stiffness);
  const LinearOnPlane closure{atPoint_ + even, (-2 / kappa_) * closureTilt_};
  Real least = infinity, most = -infinity;
  for (int i = 0; i < pieces_; ++i)
    forEachCorner(whole_[i],
                  [&](const Vec2& p)
                  {
                    least = branchFree::smaller(closure.at(p), least);
                    most = branchFree::larger(closure.at(p), most);
                  });
  if (!(most > onset))
    return false;

  // The line of least squares through what the points are crushed to, over their closures; both
  // counted from those of the deepest point.
  const Real deepest = law.crushedAt(most, stiffness), roundOff = 1e-9 * onset;
  LinearOnPlane line{deepest, {}};
  if (most - least > roundOff)
  {
    Real area = 0, ofClosure = 0, ofCrushed = 0, squares = 0, products = 0;
    for (int i = 0; i < pieces_; ++i)
      forEachSlice(whole_[i], closure, onset,
                   [&](Real at, Real part)
                   {
                     const Real c = at - most, k = law.crushedAt(at, stiffness) - deepest;
                     area += part;
                     ofClosure += part * c;
                     ofCrushed += part * k;
                     squares += part * (c * c);
                     products += part * (c * k);
                   });
    if (!(area > 0))
      return false;
    const Real c = ofClosure / area, k = ofCrushed / area;
    const Real variance = squares / area - c * c;
    const Real slope = variance > roundOff * roundOff ? (products / area - c * k) / variance : 0;
    line = {deepest + k + slope * (closure.atOrigin - most - c), slope * closure.slope};
  }

  const LinearOnPlane old = uneven_ ? crushed_ : LinearOnPlane{even, {}};
  bool further = false;
  const auto compare = [&](const Vec2& p)
  { further = further || line.at(p) > branchFree::positivePart(old.at(p)) + roundOff; };
  for (int i = 0; i < pieces_; ++i)
    forEachSide(whole_[i],
                [&](const Vec2& p, const Vec2& r)
                {
                  const Real a = closure.at(p) - onset, b = closure.at(r) - onset;
                  if (a >= 0)
                    compare(p);
                  if (b >= 0)
                    compare(r);
                  if ((a < 0) != (b < 0))
                    compare(p + (a / (a - b)) * (r - p));
                });
  if (!further)
    return false;
  if (uneven_ || even > 0)
  {
    // Where neither is positive nothing is crushed before or after.
    Real low = infinity, high = -infinity;
    const auto include = [&](const Vec2& p)
    {
      const Real above = old.at(p) - line.at(p);
      low = branchFree::smaller(above, low);
      high = branchFree::larger(above, high);
    };
    for (int i = 0; i < pieces_; ++i)
    {
      // What is crushed stays so, also where the faces are apart now.
      const bool all = whole_[i].crushed || !uneven_;
      const Owned& q = all ? whole_[i] : piece_[i];
      forEachSide(q,
                  [&](const Vec2& p, const Vec2& r)
                  {
                    const Real a = line.at(p), b = line.at(r);
                    if (all || a >= 0)
                      include(p);
                    if (all || b >= 0)
                      include(r);
                    if (!all && (a < 0) != (b < 0))
                      include(p + (a / (a - b)) * (r - p));
                  });
    }
    if (low >= 0)
      return false;
    if (high > 0)
    {
      const Real part = high / (high - low);
      line = {line.atOrigin + part * (old.atOrigin - line.atOrigin - low),
              line.slope + part * (old.slope - line.slope)};
    }
  }
  to = AffineFrame(shadow[0]).onFace(line).asKept();
  return true;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Real PairPotential<Dim, T>::lostBy(const LinearOnFace& from,
                                                          const LinearOnFace& to,
                                                          const EnergyDensity<T>& density) const
{
  const AffineFrame frame(shadow[0]);
  return materialArea * opposedness *
         (resisted(frame.onPlane(to), density) - resisted(frame.onPlane(from), density));
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Real PairPotential<Dim, T>::resisted(const LinearOnPlane& crushing,
                                                            const EnergyDensity<T>& density) const
{
  Real sum = 0;
  for (int i = 0; i < pieces_; ++i)
  {
    Owned q = piece_[i];
    Real least = infinity, most = -infinity;
    forEachCorner(q,
                  [&](const Vec2& p)
                  {
                    least = branchFree::smaller(crushing.at(p), least);
                    most = branchFree::larger(crushing.at(p), most);
                  });
    if (!(most > 0))
      continue;
    if (least < 0)
      cutWhereNegative(q, crushing);
    const auto traction = [&](const Vec2& p)
    { return 2 * density.square * closureIn(q, p) + density.linear; };
    Vec2 apex;
    forEachCorner(q, [&](const Vec2& p) { apex = p; });
    const Real tApex = traction(apex), kApex = crushing.at(apex);
    forEachSide(q,
                [&](const Vec2& p, const Vec2& r)
                {
                  const Real t0 = traction(p), t1 = traction(r);
                  const Real k0 = crushing.at(p), k1 = crushing.at(r);
                  if (Dim == 2 && scale_.axisymmetric)
                    alongSegment(p.x, r.x,
                                 [&](Real s, Real part) {
                                   sum += part * around(s) * traction({s, 0}) * crushing.at({s, 0});
                                 });
                  else if (Dim == 2)
                    sum += (r.x - p.x) / 6 * (2 * (t0 * k0 + t1 * k1) + t0 * k1 + t1 * k0);
                  else
                    sum +=
                        0.5 * cross(p - apex, r - apex) / 12 *
                        ((t0 + t1 + tApex) * (k0 + k1 + kApex) + t0 * k0 + t1 * k1 + tApex * kApex);
                });
    for (int k = 0; k < q.sides.size && alongStrip_ != 0; ++k)
      if (const int owner = q.owner[k]; owner >= 0 && edges_.exits[owner] > 0)
      {
        const Vec2 along = q.sides.to[k] - q.sides.from[k];
        const Real length = Dim == 2 ? around(q.sides.from[k].x) : std::sqrt(dot(along, along));
        sum += slopeOfWay(owner) * length * crushing.at(0.5 * (q.sides.from[k] + q.sides.to[k]));
      }
  }
  return sum;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION void PairPotential<Dim, T>::cutWhereNegative(Owned& q,
                                                                    const LinearOnPlane& f) const
{
  if constexpr (Dim == 2)
  {
    const Real from = q.sides.from[0].x, to = q.sides.from[1].x;
    const Real u = f.at({from, 0}), v = f.at({to, 0});
    const int end = u > 0 ? 1 : 0;
    q.sides.from[end] = q.sides.to[end] = {from + (to - from) * u / (u - v), 0};
    q.owner[end] = Owned::crushedLine;
    return;
  }
  Real from[PolygonSides<Real>::capacity], to[PolygonSides<Real>::capacity];
  for (int k = 0; k < q.sides.size; ++k)
  {
    from[k] = f.at(q.sides.from[k]);
    to[k] = f.at(q.sides.to[k]);
  }
  if (inOrder_)
    detail::cutOwnedInOrder(q, from, Owned::crushedLine);
  else
    detail::cutOwned(q, from, to, Owned::crushedLine);
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Real PairPotential<Dim, T>::meanCrushing() const
{
  const ContactMoments<Real>& m = ofCrushed_;
  const Real sum = crushed_.atOrigin * m.area + dot(crushed_.slope, m.areaMoment);
  return sum > 0 ? sum / moments.area : 0;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Real PairPotential<Dim, T>::mostBeyondCrushing() const
{
  Real most = -infinity;
  for (int i = 0; i < pieces_; ++i)
    forEachCorner(whole_[i],
                  [&](const Vec2& p)
                  {
                    const Real beyond = closureAt(p) - branchFree::positivePart(crushed_.at(p));
                    most = branchFree::larger(beyond, most);
                  });
  return most;
}
} // namespace coplane
