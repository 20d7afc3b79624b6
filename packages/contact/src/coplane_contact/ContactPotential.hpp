#pragma once

#include <coplane_contact/AreaOfContact.hpp>
#include <coplane_contact/ContactEnergy.hpp>
#include <coplane_contact/FacePairSteps.hpp>
#include <coplane_contact/OwnedSides.hpp>

#include <type_traits>

// The energy of a pair of faces and its gradient (docs/theory/contact-potential.md). Everything is
// a function of the positions at one time, so the forces are those of a potential to round-off. T
// is Real, or Lanes for several pairs side by side.

namespace coplane
{
/// Part of a rim that an edge gets which lies beside another one, if it is nearer than the reach.
template <class T>
struct SharedRim
{
  T reach, part;
};

/// What the edges of both outlines are, 1 or 0 each, as in Plane: 0..3 of face 0, 4..7 of face 1.
template <class T>
struct EdgesOf
{
  T exits[8] = {}, turns[8] = {}, covered[8] = {};
};

/// A pair of faces on its common plane, the part of it in contact, and the gradient of an energy
/// over that part.
template <int Dim, class T>
class PairPotential
{
public:
  using Mask = branchFree::MaskOf<T>;
  static constexpr int maxPieces = branchFree::widthOf<T> == 1 ? 4 : 1;

  /// Faces at the time of the forces. `regular` tells the lanes where a shadow is not convex, which
  /// only T = Real can do.
  KOKKOS_INLINE_FUNCTION PairPotential(const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b,
                                       const ContactPotentialScale& scale)
      : face_{&a, &b}, scale_(scale)
  {
    using namespace branchFree;
    plane = stepB_trialPointOfContact<Dim>(a, b);
    xi_ = -dot(a.normal, b.normal);
    plane.opposed = plane.opposed && xi_ > scale.opposedFrom;
    if (!anyOf(plane.opposed))
      return;
    shadow[0] = stepC_projectOntoPlane<Dim>(plane, a, 0);
    shadow[1] = stepC_projectOntoPlane<Dim>(plane, b, 0);
    plane.opposed = plane.opposed && !coplane::shadowsApart(shadow[0], shadow[1]);
  }

  TrialPlaneOf<T> plane; ///< its `opposed` tells which pairs can touch at all
  ShadowOf<T> shadow[2];
  Mask regular{true};
  T overlap{};               ///< whole overlap of the shadows [m^2]
  T mostClosure{};           ///< over the overlap [m]; minus infinity without overlap
  ContactMoments<T> moments; ///< of the part in contact
  T wayOut = T(1.0);         ///< chi
  Mask hidden{false};        ///< the part in contact begins at covered edges only
  T ways[2]{};               ///< closure along the border over which each body can be left [m^2]
  T opposedness{};           ///< phi
  T materialArea = T(1.0);   ///< gamma: area of the faces at birth over area now
  Vec3Of<T> gradient[2][4];  ///< of the energy [N]

  /// Overlap of the shadows, closures in it, the part in contact.
  /// @param offset gap at which the closure is zero [m]
  /// @param whole the whole overlap carries: a bond
  KOKKOS_INLINE_FUNCTION void meet(const T& offset, const Mask& whole, const EdgesOf<T>& edges)
  {
    using namespace branchFree;
    const HalfStepFaceOf<T>&a = *face_[0], &b = *face_[1];
    kappa_ = dot(plane.normal, a.normal);
    const Vec3Of<T> tilt = 0.5 * (a.normal + b.normal), apart = b.center - a.center;
    tilt_ = inPlane(tilt);
    apart_ = inPlane(apart);
    atPoint_ = offset - dot(plane.normal, apart);
    const SmoothStep<T> opposed((xi_ - scale_.opposedFrom) *
                                (1.0 / (scale_.opposedTo - scale_.opposedFrom)));
    opposedness = opposed.value;
    opposednessSlope_ = opposed.slope * (1.0 / (scale_.opposedTo - scale_.opposedFrom));
    const T least = smaller(a.area, b.area);
    size_ = least;
    edges_ = edges;
    findOverlap();
    pressAll(whole);
    if constexpr (Dim == 3 && widthOf<T> == 1)
      if (!regular)
      {
        findPieces();
        pressAll(whole);
      }
    findStrip(whole);
    hidden = !whole && ((coveredSides_[0] > 0.0 && openSides_[0] == 0.0) ||
                        (coveredSides_[1] > 0.0 && openSides_[1] == 0.0));
  }

  /// The law: k/2 chi H Int c^2, as the density whose integral changes as that does when the
  /// moments change, and its value.
  /// chi: where the way out is sideways, over an edge of each body, nothing is in contact. Uniform
  /// closure c over a strip of width w between such edges: a function of w / 2c. An edge counts by
  /// the closure along it, so that a strip begins smoothly when the closed part grows up to one.
  /// H: PenaltyHardening.
  /// @param inverseDepth 1 / depth, 0: no hardening [1/m]
  KOKKOS_INLINE_FUNCTION T press(const T& stiffness, const T& inverseDepth,
                                 EnergyDensity<T>& density)
  {
    using namespace branchFree;
    const T& v = moments.volume;
    const T& s = moments.squares;
    const T mean = s / v;
    const T z = inverseDepth * mean, z4 = z * z * z * z, grown = z4 / (1.0 + z4);
    const T hard = 1.0 + PenaltyHardening::part * grown;
    const T hardSlope = 4.0 * PenaltyHardening::part * grown * (1.0 - grown);
    wayOut = T(1.0);
    T slope(0.0);
    if constexpr (widthOf<T> == 1)
      if (strip_)
      {
        const Real width = 1 / (scale_.wayOutTo - scale_.wayOutFrom);
        const Real ratio = v * v / (s * acrossStrip());
        const SmoothStep<Real> share((ratio - scale_.wayOutFrom) * width);
        wayOut = share.value;
        slope = share.slope * width * ratio;
        alongStrip_ = -0.5 * stiffness * hard * s * slope;
      }
    density.square = 0.5 * stiffness * (wayOut * (hard + hardSlope) - slope * hard);
    density.linear = 0.5 * stiffness * mean * (2.0 * slope * hard - wayOut * hardSlope);
    density.constant = T(0.0);
    return 0.5 * stiffness * wayOut * hard * s;
  }

  /// Gradient of gamma phi (energy), where the energy is the integral of a density over the part in
  /// contact: forces are minus that. Returns the sum of the forces along the normals [N].
  /// @param energy that integral [J]
  /// @param birth area of both faces when the plane was born [m^2]
  KOKKOS_INLINE_FUNCTION T differentiate(const T& energy, const EnergyDensity<T>& density,
                                         const T& birth0, const T& birth1)
  {
    using namespace branchFree;
    const HalfStepFaceOf<T>&a = *face_[0], &b = *face_[1];
    materialArea = 0.5 * (birth0 / a.area + birth1 / b.area);
    T push = 2.0 * density.square * moments.volume + density.linear * moments.area;
    Vec2Of<T> first =
        (2.0 * density.square) * moments.volumeMoment + density.linear * moments.areaMoment;
    Vec2Of<T> rim[2][4];
    for (int i = 0; i < pieces_; ++i)
      addRims(piece_[i], density, rim);
    const T scale = materialArea * opposedness;
    if constexpr (widthOf<T> == 1)
      if (alongStrip_ != 0)
        addStrip(scale, push, first, rim);

    // Through the normal of the plane: turning it at fixed nodes is turning all nodes and normals
    // back.
    const T inverse = 1.0 / kappa_;
    Vec2Of<T> turn = (push * dot(tilt_, apart_) * inverse * inverse) * tilt_;
    for (int f = 0; f < 2; ++f)
      for (int i = 0; i < face_[f]->count; ++i)
        turn = turn - shadow[f].height[i] * rim[f][i];
    turn = (0.5 * inverse) * turn;

    const T birth[2] = {birth0, birth1};
    for (int f = 0; f < 2; ++f)
    {
      const HalfStepFaceOf<T>& mine = *face_[f];
      const Real sign = f == 0 ? 1 : -1;
      const Vec2Of<T> about = first + (sign * 0.5 * push) * apart_; // this face's centre
      const Vec2Of<T> q = sign * turn - inverse * about;
      const Vec3Of<T> slopes =
          scale * (spatial(q) + (sign * inverse * inverse * dot(tilt_, about)) * plane.normal) -
          (materialArea * opposednessSlope_ * energy) * face_[1 - f]->normal;
      const Vec3Of<T> inFace = slopes - dot(mine.normal, slopes) * mine.normal;
      const T area = 1.0 / mine.area;
      byVectorArea(f, area * inFace -
                          (0.5 * opposedness * energy * birth[f] * area * area) * mine.normal);
      const Vec3Of<T> even = (scale * push * inverse / mine.count) * mine.normal;
      for (int i = 0; i < mine.count; ++i)
        gradient[f][i] += even + scale * spatial(rim[f][i]);
    }
    return scale * push;
  }

  /// Adds q.dn to the gradient, for the change dn of a face's normal.
  KOKKOS_INLINE_FUNCTION void addThroughNormal(int f, const Vec3Of<T>& q)
  {
    const HalfStepFaceOf<T>& mine = *face_[f];
    byVectorArea(f, (1.0 / mine.area) * (q - dot(mine.normal, q) * mine.normal));
  }

  /// Rate of the plane's normal with the velocities of the nodes [1/s].
  KOKKOS_INLINE_FUNCTION Vec3Of<T> normalRate() const
  {
    Vec3Of<T> rate{};
    for (int f = 0; f < 2; ++f)
    {
      const HalfStepFaceOf<T>& m = *face_[f];
      Vec3Of<T> area;
      if constexpr (Dim == 2)
        area = {m.v[1].y - m.v[0].y, m.v[0].x - m.v[1].x, T(0.0)};
      else if (m.count == 3)
        area = 0.5 *
               (cross(m.v[1] - m.v[0], m.x[2] - m.x[0]) + cross(m.x[1] - m.x[0], m.v[2] - m.v[0]));
      else
        area = 0.5 *
               (cross(m.v[2] - m.v[0], m.x[3] - m.x[1]) + cross(m.x[2] - m.x[0], m.v[3] - m.v[1]));
      area = (1.0 / m.area) * (area - dot(m.normal, area) * m.normal);
      rate = f == 0 ? area : rate - area;
    }
    rate = (0.5 / kappa_) * rate;
    return rate - dot(plane.normal, rate) * plane.normal;
  }

  /// n . (mean normal of face f): what a face's normal has along the plane's.
  KOKKOS_INLINE_FUNCTION const T& kappa() const { return kappa_; }

  /// Weights of the nodes of both faces that reproduce a place in the plane: affine, of least norm.
  KOKKOS_INLINE_FUNCTION void weightsAt(const Vec2Of<T>& at, T (&weights)[2][4]) const
  {
    for (int f = 0; f < 2; ++f)
    {
      const ShadowOf<T>& s = shadow[f];
      for (int i = 0; i < 4; ++i)
        weights[f][i] = T(0.0);
      if constexpr (Dim == 2)
      {
        weights[f][1] = (at.x - s.p[0].x) / (s.p[1].x - s.p[0].x);
        weights[f][0] = 1.0 - weights[f][1];
      }
      else
      {
        Vec2Of<T> mean;
        for (int i = 0; i < s.count; ++i)
          mean = mean + s.p[i];
        mean = (1.0 / s.count) * mean;
        T xx{}, xy{}, yy{};
        for (int i = 0; i < s.count; ++i)
        {
          const Vec2Of<T> r = s.p[i] - mean;
          xx += r.x * r.x;
          xy += r.x * r.y;
          yy += r.y * r.y;
        }
        const T inverse = 1.0 / (xx * yy - xy * xy);
        const Vec2Of<T> d = at - mean;
        const Vec2Of<T> slope{inverse * (yy * d.x - xy * d.y), inverse * (xx * d.y - xy * d.x)};
        for (int i = 0; i < s.count; ++i)
          weights[f][i] = 1.0 / s.count + dot(s.p[i] - mean, slope);
      }
    }
  }

  KOKKOS_FORCEINLINE_FUNCTION T closureAt(const Vec2Of<T>& p) const
  {
    return atPoint_ - (2.0 / kappa_) * dot(tilt_, p);
  }

private:
  using Owned = detail::OwnedSides<T>;

  KOKKOS_FORCEINLINE_FUNCTION Vec2Of<T> inPlane(const Vec3Of<T>& a) const
  {
    return {dot(plane.e1, a), Dim == 2 ? T(0.0) : dot(plane.e2, a)};
  }
  KOKKOS_FORCEINLINE_FUNCTION Vec3Of<T> spatial(const Vec2Of<T>& a) const
  {
    if constexpr (Dim == 2)
      return a.x * plane.e1;
    else
      return a.x * plane.e1 + a.y * plane.e2;
  }

  /// Node at the start of edge e of the outline of face f, and at its end.
  KOKKOS_FORCEINLINE_FUNCTION int nodeOfEdge(int f, int e, int end) const
  {
    const int count = face_[f]->count;
    const int i = e + end == count ? 0 : e + end;
    return f == 0 ? i : count - 1 - i;
  }

  KOKKOS_INLINE_FUNCTION void findOverlap()
  {
    using namespace branchFree;
    pieces_ = 0;
    if constexpr (Dim == 2)
    {
      // A segment as a polygon without width: two "sides" that are its ends.
      pieces_ = 1;
      Owned& q = piece_[0];
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
    }
    else
    {
      const detail::Outline<T> a(shadow[0], false), b(shadow[1], true);
      regular = isConvex(a.p, a.count) && isConvex(b.p, b.count);
      Owned& q = piece_[0];
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

  KOKKOS_INLINE_FUNCTION void measureOverlap()
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

  /// For shadows that are not convex, and where round-off asks for the order of the sides: convex
  /// pieces, cut in order. A diagonal belongs to no edge: what both its sides have there cancels.
  KOKKOS_INLINE_FUNCTION void findPieces()
  {
    const detail::Outline<T> a(shadow[0], false), b(shadow[1], true);
    pieces_ = 0;
    inOrder_ = true;
    Owned partsA[2], partsB[2];
    const int countA = convexParts(a, 0, partsA), countB = convexParts(b, 4, partsB);
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

  static KOKKOS_INLINE_FUNCTION int convexParts(const detail::Outline<T>& outline, int firstOwner,
                                                Owned (&parts)[2])
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
    return 0; // folded: carries nothing
  }

  KOKKOS_INLINE_FUNCTION void pressAll(const Mask& whole)
  {
    moments = {};
    ways[0] = ways[1] = T(0.0);
    for (int f = 0; f < 2; ++f)
      coveredSides_[f] = openSides_[f] = T(0.0);
    for (int i = 0; i < pieces_; ++i)
    {
      if constexpr (branchFree::widthOf<T> == 1)
        whole_[i] = piece_[i];
      cutAndIntegrate(piece_[i], whole);
    }
  }

  /// Cuts off what is not closed, and integrates.
  KOKKOS_INLINE_FUNCTION void cutAndIntegrate(Owned& q, const Mask& whole)
  {
    using namespace branchFree;
    if constexpr (Dim == 2)
    {
      T &from = q.sides.from[0].x, &to = q.sides.from[1].x;
      if (!(overlap > 0))
        return;
      const T c0 = closureAt({from, 0}), c1 = closureAt({to, 0});
      if (!whole && !(c0 > 0 || c1 > 0))
        return;
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
      const T u = closureAt({from, 0}), v = closureAt({to, 0}), width = to - from;
      if (!(width > 0))
        return;
      moments.area = width;
      moments.volume = 0.5 * width * (u + v);
      moments.squares = width / 3.0 * (u * u + u * v + v * v);
      moments.areaMoment.x = 0.5 * width * (from + to);
      moments.volumeMoment.x = width / 6.0 * (2.0 * (u * from + v * to) + u * to + v * from);
      for (int k = 0; k < 2; ++k)
        if (const int owner = q.owner[k]; owner >= 0)
        {
          ways[owner / 4] += edges_.exits[owner] * closureAt(q.sides.from[k]);
          addSide(owner, true);
        }
    }
    else
    {
      T from[PolygonSides<T>::capacity], to[PolygonSides<T>::capacity];
      for (int k = 0; k < q.sides.size; ++k)
      {
        from[k] = choose(whole, T(1.0), closureAt(q.sides.from[k]));
        to[k] = choose(whole, T(1.0), closureAt(q.sides.to[k]));
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
      Vec2Of<T> apex;
      for (int k = 0; k < q.sides.size; ++k)
        apex = coplane::choose(q.sides.isThere(k), q.sides.from[k], apex);
      const T atApex = closureAt(apex);
      ContactMoments<T> sum;
      T border[2]{};
      for (int k = 0; k < q.sides.size; ++k)
      {
        const Vec2Of<T>&p = q.sides.from[k], &r = q.sides.to[k];
        sum.add(apex, p, r, atApex, closureAt(p), closureAt(r));
        if (q.owner[k] >= 0)
        {
          addSide(q.owner[k], q.sides.isThere(k));
          const T& exit = edges_.exits[q.owner[k]];
          if (anyOf(exit > 0.0))
            border[q.owner[k] / 4] +=
                0.5 * exit * squareRoot(dot(r - p, r - p)) * (closureAt(p) + closureAt(r));
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
      for (int f = 0; f < 2; ++f)
        ways[f] += choose(there, border[f], none);
    }
  }

  /// The gradient of the area in contact times the density there, side by side. A side belongs to
  /// one edge; an edge of the other face that lies beside it gets a part (shareRim), so that
  /// round-off does not decide which of two edges that count as one is the owner, and slivers
  /// between them carry nothing at their borders.
  KOKKOS_INLINE_FUNCTION void addRims(const Owned& q, const EnergyDensity<T>& density,
                                      Vec2Of<T> (&rim)[2][4]) const
  {
    using namespace branchFree;
    const auto at = [&](const T& c)
    { return density.constant + c * (density.linear + c * density.square); };
    if constexpr (Dim == 2)
    {
      if (!(moments.area > 0))
        return;
      for (int end = 0; end < 2; ++end)
      {
        if (q.owner[end] < 0)
          continue;
        const int f = q.owner[end] / 4, node = q.owner[end] % 4;
        const T x = q.sides.from[end].x;
        const T whole = (end == 0 ? -1.0 : 1.0) * at(closureAt({x, 0}));
        T kept = 1;
        for (int other = 0; other < 2; ++other)
        {
          const T near = absolute(shadow[1 - f].p[other].x - x);
          const bool upper = shadow[1 - f].p[other].x > shadow[1 - f].p[1 - other].x;
          const SharedRim<T> shared = shareRim(q.owner[end], 4 * (1 - f) + other,
                                               upper == (end == 1), 2 / kappa_ * tilt_.x * size_);
          if (!(near < shared.reach))
            continue;
          const T given = shared.part * (1 - apartness(near / shared.reach));
          kept -= given;
          rim[1 - f][other].x += given * whole;
        }
        rim[f][node].x += kept * whole;
      }
    }
    else
    {
      for (int k = 0; k < q.sides.size; ++k)
      {
        if (q.owner[k] < 0)
          continue;
        const int f = q.owner[k] / 4, e = q.owner[k] % 4, g = 1 - f;
        const Vec2Of<T>&from = q.sides.from[k], &to = q.sides.to[k];
        const auto there = q.sides.isThere(k) && moments.area > 0.0;
        if (!anyOf(there))
          continue;
        const T u = closureAt(from), v = closureAt(to);
        const T total = density.square / 3.0 * (u * u + u * v + v * v) +
                        density.linear / 2.0 * (u + v) + density.constant;
        const T second = density.square / 12.0 * (u * u + 2.0 * u * v + 3.0 * v * v) +
                         density.linear / 6.0 * (u + 2.0 * v) + 0.5 * density.constant;
        const Vec2Of<T> d = to - from;
        const Vec2Of<T> own = shadow[f].p[nodeOfEdge(f, e, 1)] - shadow[f].p[nodeOfEdge(f, e, 0)];
        T kept(1.0);
        for (int o = 0; o < face_[g]->count; ++o)
        {
          const Vec2Of<T>& start = shadow[g].p[nodeOfEdge(g, o, 0)];
          const Vec2Of<T> edge = shadow[g].p[nodeOfEdge(g, o, 1)] - start;
          const T near =
              larger(absolute(cross(edge, from - start)), absolute(cross(edge, to - start)));
          if (!anyOf(near < size_ * scale_.oneBorder))
            continue;
          const T along = dot(edge, d);
          const T longer = larger(dot(edge, edge), dot(own, own));
          const SharedRim<T> shared =
              shareRim(q.owner[k], 4 * g + o, along > 0.0,
                       2.0 / kappa_ * cross(tilt_, d) * size_ / squareRoot(dot(d, d) * longer));
          const auto close =
              near < shared.reach && along * along > 0.5 * dot(edge, edge) * dot(d, d) && there;
          if (!anyOf(close))
            continue;
          const T given =
              choose(close, shared.part * (1.0 - apartness(near / shared.reach)), T(0.0));
          kept = kept - given;
          addRim(g, o, close, from, to, total, second, given, rim);
        }
        addRim(f, e, there, from, to, total, second, kept, rim);
      }
    }
  }

  /// What an edge of the other face gets of the rim at an edge of this one. In three dimensions
  /// the reach is times the length of the other edge: the size of a face across it is its area over
  /// that.
  ///
  /// Two mesh lines share evenly, and so do two edges at which surfaces end: where both count as
  /// one, the mean of the gradients on both sides of it. What lies at such an edge beside a mesh
  /// line is shared evenly as long as the closure changes across a face by less than its mean, so
  /// that what is pressed evenly rests; at a corner that dips into a face all of it belongs to the
  /// corner, for what pairs on both sides of a mesh line have there cancels. All of it is smooth,
  /// so that round-off decides nothing.
  /// @param change of the closure over the size of a face, out over its edge, the same whichever of
  ///        both edges is the owner [m]
  KOKKOS_FORCEINLINE_FUNCTION SharedRim<T> shareRim(int mine, int its, const Mask& sameWay,
                                                    const T& change) const
  {
    using namespace branchFree;
    const auto turns = edges_.turns[mine] > 0.0, itTurns = edges_.turns[its] > 0.0;
    const auto border = turns && itTurns;
    const T tilted = absolute(change) * moments.area, closed = absolute(moments.volume);
    const T flatness =
        choose(closed > 0.0, 1.0 - SmoothStep<T>(2.0 * tilted / closed - 1.0).value, T(0.0));
    const T even = 0.5 * flatness;
    const T ofLine = choose(turns, even, choose(itTurns, 1.0 - even, T(0.5)));
    const T wider = choose(border, flatness * (scale_.oneBorder - scale_.oneEdge), T(0.0));
    return {size_ * (scale_.oneEdge + wider),
            choose(border, choose(sameWay, T(0.5), T(0.0)), ofLine)};
  }

  /// The gradient of the energy beside one edge: its nodes share a part of it. total, second: of
  /// the density along the side, and of that times 0..1 along it. Moments stay exact also where the
  /// edge lies beside the side: it is taken where the line of the force crosses it.
  KOKKOS_INLINE_FUNCTION void addRim(int f, int e, const Mask& there, const Vec2Of<T>& from,
                                     const Vec2Of<T>& to, const T& total, const T& second,
                                     const T& part, Vec2Of<T> (&rim)[2][4]) const
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

  KOKKOS_FORCEINLINE_FUNCTION void addSide(int owner, const Mask& isThere)
  {
    using namespace branchFree;
    const T none(0.0);
    const T& covered = edges_.covered[owner];
    coveredSides_[owner / 4] += choose(isThere, covered, none);
    openSides_[owner / 4] += choose(isThere && !(covered > 0.0), edges_.turns[owner], none);
  }

  /// Closure along the edges that bound a strip, the harmonic mean of both faces, twice; faces that
  /// share most of what they have are no strip, however deep they lie in each other [m^2].
  KOKKOS_FORCEINLINE_FUNCTION T acrossStrip() const
  {
    return 4.0 * ways[0] * ways[1] / (ways[0] + ways[1]) *
           (1.0 - SmoothStep<T>(4.0 * overlap / size_ - 2.0).value);
  }

  /// Whether sideways is the shorter way out. Rare: lanes leave such pairs to T = Real.
  KOKKOS_INLINE_FUNCTION void findStrip(const Mask& whole)
  {
    const T& v = moments.volume;
    const auto between = !whole && ways[0] > 0.0 && ways[1] > 0.0 && v > 0.0;
    strip_ = between && v * v < scale_.wayOutTo * moments.squares * acrossStrip();
    if constexpr (branchFree::widthOf<T> != 1)
      regular = regular && !strip_;
  }

  /// Adds the gradient of what hangs on the borders of the strip.
  KOKKOS_INLINE_FUNCTION void addStrip(const Real& scale, Real& push, Vec2& first,
                                       Vec2 (&rim)[2][4])
  {
    for (int i = 0; i < pieces_; ++i)
      for (int k = 0; k < piece_[i].sides.size; ++k)
        if (const int owner = piece_[i].owner[k]; owner >= 0 && edges_.exits[owner] > 0)
          addBorder(piece_[i], k, alongStrip_ * (1 / ways[owner / 4] - 1 / (ways[0] + ways[1])),
                    push, first, rim);
    const Real shared = overlap / size_;
    const SmoothStep<Real> together(4 * shared - 2);
    if (!(together.slope > 0))
      return;
    const Real perShare = -4 * alongStrip_ * together.slope / (1 - together.value);
    for (int i = 0; i < pieces_; ++i)
      addRims(whole_[i], {0, 0, perShare / size_}, rim);
    const int smallest = face_[0]->area < face_[1]->area ? 0 : 1;
    byVectorArea(smallest, (-scale * perShare * shared / size_) * face_[smallest]->normal);
  }

  /// The gradient of the closure along a side, whose ends are where the lines of its neighbours
  /// cross that of its edge; at a line of no closure the end counts nothing.
  /// @param slope of the energy with that [N/m]
  KOKKOS_INLINE_FUNCTION void addBorder(const Owned& q, int k, Real slope, Real& push, Vec2& first,
                                        Vec2 (&rim)[2][4]) const
  {
    const Vec2 falls = (2 / kappa_) * tilt_; // closure, along the plane
    const int owner = q.owner[k];
    if constexpr (Dim == 2)
    {
      push += slope;
      first = first + slope * q.sides.from[k];
      rim[owner / 4][owner % 4].x -= slope * falls.x;
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
      if (next < 0 || q.owner[next] == Owned::closureLine)
        continue;
      const Real further = (end == 0 ? -slope : slope) * closureAt(p);
      if (q.owner[next] == Owned::noEdge)
      {
        // A diagonal: it ends at a node of its own face, and cuts the other face for both pieces.
        const int node = nodeOfEdge(owner / 4, owner % 4, end);
        const Vec2 off = p - shadow[owner / 4].p[node];
        if (dot(off, off) < 1e-20 * length * length)
          rim[owner / 4][node] = rim[owner / 4][node] + further * t;
        continue;
      }
      const Vec2 other = outwardOf(q.owner[next]);
      const Real sine = dot(other, t);
      if (!(std::abs(sine) > 1e-6))
        continue;
      const Real ofOther = further / sine;
      pushEdge(owner, p, (-ofOther * dot(other, n)) * n, rim);
      pushEdge(q.owner[next], p, ofOther * other, rim);
    }
  }

  /// Unit normal of the line of an edge, out of the polygon.
  KOKKOS_INLINE_FUNCTION Vec2 outwardOf(int owner) const
  {
    const int f = owner / 4, e = owner % 4;
    const Vec2 d = shadow[f].p[nodeOfEdge(f, e, 1)] - shadow[f].p[nodeOfEdge(f, e, 0)];
    return (1 / std::sqrt(dot(d, d))) * Vec2{d.y, -d.x};
  }

  /// A gradient with the motion of an edge at a place on it.
  KOKKOS_INLINE_FUNCTION void pushEdge(int owner, const Vec2& at, const Vec2& slope,
                                       Vec2 (&rim)[2][4]) const
  {
    const int f = owner / 4, e = owner % 4;
    const int i0 = nodeOfEdge(f, e, 0), i1 = nodeOfEdge(f, e, 1);
    const Vec2 d = shadow[f].p[i1] - shadow[f].p[i0];
    const Real part = dot(at - shadow[f].p[i0], d) / dot(d, d);
    rim[f][i0] = rim[f][i0] + (1 - part) * slope;
    rim[f][i1] = rim[f][i1] + part * slope;
  }

  /// 0 for edges that count as one, 1 for edges that do not.
  KOKKOS_FORCEINLINE_FUNCTION T apartness(const T& distance) const
  {
    return SmoothStep<T>(2.0 * distance - 1.0).value;
  }

  /// Adds h.dN to the gradient, for the change dN of a face's vector area.
  KOKKOS_INLINE_FUNCTION void byVectorArea(int f, const Vec3Of<T>& h)
  {
    const HalfStepFaceOf<T>& m = *face_[f];
    Vec3Of<T>(&g)[4] = gradient[f];
    if constexpr (Dim == 2)
    {
      const Vec3Of<T> turned{-h.y, h.x, T(0.0)};
      g[1] += turned;
      g[0] -= turned;
      return;
    }
    const Vec3Of<T> half = 0.5 * h;
    if (m.count == 3)
    {
      const Vec3Of<T> one = cross(m.x[2] - m.x[0], half), two = cross(half, m.x[1] - m.x[0]);
      g[1] += one;
      g[2] += two;
      g[0] -= one + two;
      return;
    }
    const Vec3Of<T> even = cross(m.x[3] - m.x[1], half), odd = cross(half, m.x[2] - m.x[0]);
    g[2] += even;
    g[0] -= even;
    g[3] += odd;
    g[1] -= odd;
  }

  const HalfStepFaceOf<T>* face_[2];
  ContactPotentialScale scale_;
  T xi_{}, kappa_{}, atPoint_{}, opposednessSlope_{}, size_{};
  EdgesOf<T> edges_;
  T coveredSides_[2]{}; ///< number of sides on covered edges of each face
  T openSides_[2]{};    ///< and on others at which its surface turns
  Vec2Of<T> tilt_, apart_;
  bool inOrder_ = false;
  int pieces_ = 0;
  Owned piece_[maxPieces];
  struct Nothing
  {
  };
  /// Before what is not closed is cut off.
  std::conditional_t<branchFree::widthOf<T> == 1, Owned, Nothing> whole_[maxPieces];
  Mask strip_{false};
  T alongStrip_{}; ///< what the energy changes with the logarithm of the closure along its borders
                   ///< [J]
};
} // namespace coplane
