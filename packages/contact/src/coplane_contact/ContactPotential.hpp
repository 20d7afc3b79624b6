#pragma once

#include <coplane_contact/AffineFrame.hpp>
#include <coplane_contact/AreaOfContact.hpp>
#include <coplane_contact/ContactEnergy.hpp>
#include <coplane_contact/FacePairSteps.hpp>
#include <coplane_contact/OwnedSides.hpp>
#include <coplane_geometry/AffineWeights.hpp>

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
  T exits[8] = {}, turns[8] = {}, covered[8] = {}, seams[8] = {};
};

/// A pair of faces on its common plane, the part of it in contact, and the gradient of an energy
/// over that part.
template <int Dim, class T>
class PairPotential
{
public:
  using Mask = branchFree::MaskOf<T>;
  static constexpr int maxPieces = branchFree::widthOf<T> == 1 ? 8 : 1;

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
    kappa_ = dot(plane.normal, a.normal);
    shadow[0] = stepC_projectOntoPlane<Dim>(plane, a, 0);
    shadow[1] = stepC_projectOntoPlane<Dim>(plane, b, 0);
    plane.opposed = plane.opposed && !coplane::shadowsApart(shadow[0], shadow[1]);
    if constexpr (canRevolve)
      if (scale.axisymmetric)
        revolve();
  }

  TrialPlaneOf<T> plane; ///< its `opposed` tells which pairs can touch at all
  ShadowOf<T> shadow[2];
  Mask regular{true};
  T overlap{};               ///< whole overlap of the shadows; of rings per metre of depth [m^2]
  T depth = T(1.0);          ///< mean depth of the overlap: 1 m, of rings pi (r0 + r1)
  T mostClosure{};           ///< over the overlap [m]; minus infinity without overlap
  ContactMoments<T> moments; ///< of the part in contact
  T wayOut = T(1.0);         ///< chi, times what folded faces and growing pairs have of it
  Mask hidden{false};        ///< the part in contact begins at covered edges only
  /// At three quarters of the border of what is in contact, by length, or more there is no edge of
  /// one of the faces at which its surface turns or another body covers it: the surface goes on
  /// there, over lines of the mesh. Then it is not between two edges at which both bodies end.
  KOKKOS_INLINE_FUNCTION Mask isWithinASurface() const;
  /// Sideways is the shorter way out, or nearly: chi < 1.
  KOKKOS_FORCEINLINE_FUNCTION const Mask& isStrip() const { return strip_; }
  /// Sideways is so much shorter that the way out leaves nothing of the energy.
  KOKKOS_FORCEINLINE_FUNCTION const Mask& hasNothing() const { return nothing_; }
  T opposedness{};          ///< phi
  T materialArea = T(1.0);  ///< gamma: area of the faces at birth over area now
  Vec3Of<T> gradient[2][4]; ///< of the energy [N]

  /// Overlap of the shadows, closures in it, the part in contact.
  /// @param offset gap at which the closure is zero [m]
  /// @param whole the whole overlap carries: a bond
  KOKKOS_INLINE_FUNCTION void meet(const T& offset, const Mask& whole, const EdgesOf<T>& edges)
  {
    using namespace branchFree;
    const HalfStepFaceOf<T>&a = *face_[0], &b = *face_[1];
    const Vec3Of<T> tilt = 0.5 * (a.normal + b.normal), apart = b.center - a.center;
    tilt_ = closureTilt_ = inPlane(tilt);
    apart_ = inPlane(apart);
    atPoint_ = offset - dot(plane.normal, apart);
    if (laid_ != nullptr)
      putOnLayers();
    bonded_ = whole;
    const T least = smaller(a.area, b.area);
    size_ = least;
    edges_ = edges;
    findOverlap();
    if constexpr (widthOf<T> == 1)
      if (uneven_)
        splitWhereCrushed();
    pressAll(whole);
    if constexpr (Dim == 3 && widthOf<T> == 1)
      if (!regular)
      {
        findPieces(whole);
        if (uneven_)
          splitWhereCrushed();
        pressAll(whole);
      }
    findStrip(whole);
    hidden = !whole && ((coveredSides_[0] > 0.0 && openSides_[0] == 0.0) ||
                        (coveredSides_[1] > 0.0 && openSides_[1] == 0.0));
  }

  /// The pair has begun deep within a surface: it carries less until its faces share `grownAt` of
  /// the smaller one. At its border it would push with k c^2 / 2 per length as soon as it shares
  /// anything, and what carried beside it need not lose the same there. Before press(); T = Real.
  KOKKOS_FORCEINLINE_FUNCTION void growIn() { growing_ = true; }
  /// What the growth adds to the stiffness at a node, over k: of k/2 c^2 A times a SoftStep of A
  /// over grownAt times a face of area S, whose border of length L moves [m^2].
  KOKKOS_INLINE_FUNCTION Real growthStiffness(Real deepest) const;

  /// phi, and what it changes by. The energy E = U phi(xi, U) rises with U at any angle: phi falls
  /// no faster than 1/U, since phi begins as the square of xi and the range grows no faster
  /// than the root of U.
  /// @param stored U over that of a closure as large as the smaller face is, smoothly [-]
  KOKKOS_FORCEINLINE_FUNCTION void oppose(const T& stored)
  {
    const Real narrow = scale_.opposedTo - scale_.opposedFrom;
    const T wanted = (scale_.widening * scale_.widening) * stored;
    const T rest = 1.0 / (1.0 + (1.0 / (scale_.widest * scale_.widest)) * wanted);
    const T wider = wanted * rest;
    const T square = wider + narrow * narrow, inverse = 1.0 / branchFree::squareRoot(square);
    const SoftStep<T> opposed(inverse * (xi_ - scale_.opposedFrom));
    opposedness = opposed.value;
    opposednessSlope_ = inverse * opposed.slope;
    falling_ = -0.5 * opposed.power * wider * rest / square;
  }

  /// The law: k/2 chi H Int c^2, as the density whose integral changes as that does when the
  /// moments change, and its value.
  /// chi: where the way out is sideways, over an edge of each body, nothing is in contact. Uniform
  /// closure c over a strip of width w between such edges: a function of w / 2c. An edge counts by
  /// the closure along it, so that a strip begins smoothly when the closed part grows up to one.
  /// H: HardenedPenalty.
  /// @param inverseDepth 1 / depth, 0: no hardening [1/m]
  KOKKOS_INLINE_FUNCTION T press(const T& stiffness, const T& inverseDepth,
                                 EnergyDensity<T>& density)
  {
    using namespace branchFree;
    const T& v = moments.volume;
    const T& s = moments.squares;
    const T mean = choose(v > 0.0, s / v, T(0.0)); // shear may have lifted all of it
    const HardenedPenalty<T> hardened(inverseDepth * mean);
    const T &hard = hardened.value, &hardSlope = hardened.slope;
    wayOut = T(1.0);
    alongStrip_ = T(0.0);
    T slope(0.0);
    if constexpr (widthOf<T> != 1)
      wayOut = choose(nothing_, T(0.0), T(1.0));
    else if (strip_)
    {
      const Real width = 1 / (scale_.wayOutTo - scale_.wayOutFrom);
      const Real ratio = v * v / (s * acrossStrip());
      const SmoothStep<Real> share((ratio - scale_.wayOutFrom) * width);
      wayOut = share.value;
      slope = share.slope * width * ratio;
      alongStrip_ = -0.5 * stiffness * hard * s * slope;
    }
    if constexpr (canFold)
      if (folded_[0].area > 0 || folded_[1].area > 0)
        weighFolded(0.5 * stiffness * hard * s, slope);
    if constexpr (widthOf<T> == 1)
      if (growing_)
        weighGrowing(0.5 * stiffness * hard * s, slope);
    density.square = 0.5 * stiffness * (wayOut * (hard + hardSlope) - slope * hard);
    density.linear = 0.5 * stiffness * mean * (2.0 * slope * hard - wayOut * hardSlope);
    density.constant = T(0.0);
    const T stored = wayOut * hard * s;
    for (int f = 0; f < 2; ++f)
    {
      const T inverse = 1.0 / face_[f]->area;
      sizes_[f] = inverse * inverse * (Dim == 2 ? inverse : T(1.0));
    }
    if constexpr (canRevolve)
      if (scale_.axisymmetric)
        for (int f = 0; f < 2; ++f)
          sizes_[f] /= around_[f];
    const T perSize = 0.5 * (sizes_[0] + sizes_[1]);
    for (T& size : sizes_)
      size = ((Dim == 2 ? 1.5 : 1.0) / perSize) * size;
    oppose(choose(bonded_, T(0.0), stored * perSize));
    density.square = rising() * density.square;
    density.linear = rising() * density.linear;
    if constexpr (widthOf<T> == 1)
    {
      alongStrip_ = rising() * alongStrip_;
      alongShare_ *= rising();
    }
    if constexpr (canFold)
      for (Folded& folded : folded_)
        folded.slope *= rising();
    return 0.5 * stiffness * stored;
  }

  /// Areas of both faces when the plane was born [m^2]: gamma.
  KOKKOS_FORCEINLINE_FUNCTION void growFrom(const T& birth0, const T& birth1)
  {
    birth_[0] = birth0;
    birth_[1] = birth1;
    if constexpr (canRevolve)
      if (scale_.axisymmetric)
        for (int f = 0; f < 2; ++f)
          birth_[f] /= around_[f];
    materialArea = 0.5 * (birth_[0] / face_[0]->area + birth_[1] / face_[1]->area);
  }
  /// The depth by which the overlap counts for the stable step [m]. A node of a ring at the axis
  /// may have a little more of it than of a strip, and what lies as deep as its radius is the
  /// stiffer the less is left of that: the energy goes with the mean of both circumferences, gamma
  /// with each.
  /// @param deepest closure [m]
  KOKKOS_FORCEINLINE_FUNCTION T depthOfStep(const T& deepest) const;
  /// Area of a face, of a ring over its whole turn [m^2].
  KOKKOS_FORCEINLINE_FUNCTION T faceArea(int f) const
  {
    if constexpr (canRevolve)
      if (scale_.axisymmetric)
        return around_[f] * face_[f]->area;
    return face_[f]->area;
  }

  /// 1 + psi, d ln(phi U) / d ln U: what the energy rises with U, over phi; 0 to 1. After press().
  KOKKOS_FORCEINLINE_FUNCTION T rising() const { return 1.0 + falling_; }

  /// Gradient of gamma phi (energy), where the energy is the integral of a density over the part in
  /// contact: forces are minus that. Returns the sum of the forces along the normals [N]. After
  /// growFrom().
  /// @param energy that integral [J]
  KOKKOS_INLINE_FUNCTION T differentiate(const T& energy, const EnergyDensity<T>& density)
  {
    using namespace branchFree;
    T push = 2.0 * density.square * moments.volume + density.linear * moments.area;
    Vec2Of<T> first =
        (2.0 * density.square) * moments.volumeMoment + density.linear * moments.areaMoment;
    Vec2Of<T> rim[2][4];
    for (int i = 0; i < pieces_; ++i)
      addRims(piece_[i], density, rim);
    const T scale = materialArea * opposedness;
    if constexpr (widthOf<T> == 1)
    {
      if (alongStrip_ != 0)
        addStrip(scale, push, first, rim);
      if (alongShare_ != 0)
        addGrowth(scale, rim);
    }
    if constexpr (canFold)
      for (int f = 0; f < 2; ++f)
        if (folded_[f].slope != 0)
          addFolded(f, rim);
    if constexpr (widthOf<T> == 1)
      if (uneven_)
        addCrushing(density, rim);
    if (laid_ != nullptr)
      carryLayers(push, first, rim);
    if constexpr (canRevolve)
      if (scale_.axisymmetric)
        addRadii(energy, density, scale, rim);

    // Through the normal of the plane: turning it at fixed nodes is turning all nodes and normals
    // back.
    const T inverse = 1.0 / kappa_;
    Vec2Of<T> turn = (push * dot(tilt_, apart_) * inverse * inverse) * tilt_;
    for (int f = 0; f < 2; ++f)
      for (int i = 0; i < face_[f]->count; ++i)
        turn = turn - shadow[f].height[i] * rim[f][i];
    turn = (0.5 * inverse) * turn;

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
                          (opposedness * energy * area *
                           (0.5 * birth_[f] * area + materialArea * falling_ * sizes_[f])) *
                              mine.normal);
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

  /// Weights of the nodes of a face that reproduce a place in the plane (evenWeights).
  KOKKOS_INLINE_FUNCTION void weightsAt(int face, const Vec2Of<T>& at, T (&weights)[4]) const
  {
    const ShadowOf<T>& s = shadow[face];
    for (int i = 0; i < 4; ++i)
      weights[i] = T(0.0);
    if constexpr (Dim == 2)
    {
      weights[1] = (at.x - s.p[0].x) / (s.p[1].x - s.p[0].x);
      weights[0] = 1.0 - weights[1];
    }
    else
      evenWeights(s.p, s.count, at, weights);
  }

  KOKKOS_FORCEINLINE_FUNCTION T closureAt(const Vec2Of<T>& p) const
  {
    return atPoint_ - (2.0 / kappa_) * dot(closureTilt_, p);
  }

  // Joints that have absorbed gaps which change along their faces (ContactPotentialCrushing.hpp).
  /// Before meet(): the gap at which the joint is just closed at a place is the offset less lengths
  /// that are linear over the faces, each carried along by its face.
  /// @param of the lanes that have some; laid as Plane::laid, has to live on [m]
  KOKKOS_INLINE_FUNCTION void lay(const Mask& of, const T (&laid)[2][3])
  {
    laid_ = laid;
    laidLanes_ = of && plane.opposed;
  }
  /// A gap of the faces at a place, with what the layers there have of it [m].
  KOKKOS_INLINE_FUNCTION T overLayers(T gap, const Vec2Of<T>& place) const
  {
    for (int f = 0; f < 2 && laid_ != nullptr; ++f)
      gap = branchFree::choose(laidLanes_, gap + layer(f).at(place), gap);
    return gap;
  }
  /// After meet(), with the offset 0: what lay() needs for a joint whose closure is the same all
  /// over the faces as at a place, and by how much that changes over a face, at most [m].
  KOKKOS_INLINE_FUNCTION Real unevenGap(const Vec2& place, LinearOnFace (&laid)[2]) const;

  // Joints that are crushed unevenly (ContactPotentialCrushing.hpp), T = Real only. The closure
  // counts from where the joint is crushed to, max(0, L) with L linear over face 0, which carries
  // it along.
  /// Before meet(), whose offset then is that of the joint as it was made.
  KOKKOS_INLINE_FUNCTION void beCrushed(const LinearOnFace& crushing)
  {
    uneven_ = true;
    frame_ = AffineFrame(shadow[0]);
    crushed_ = frame_.onPlane(crushing);
  }
  KOKKOS_INLINE_FUNCTION void notCrushed() { uneven_ = false; }
  /// How a joint is crushed that the closures of now crush further, after meet(). What each point
  /// would be crushed to by itself, fitted by a linear function of the closure, or, where the joint
  /// is crushed more than that in places, a chord of both that nowhere in contact is less.
  /// @param law, stiffness of the joint [Pa/m]
  /// @param even crushing, off the offset, of a joint that has not been crushed unevenly yet [m]
  /// @returns whether it is crushed further
  KOKKOS_INLINE_FUNCTION bool crushFurther(const Crushing& law, Real stiffness, Real even,
                                           LinearOnFace& to) const;
  /// What it costs to crush it from one state to another one against the tractions of now, after
  /// press() and growFrom() [J].
  KOKKOS_INLINE_FUNCTION Real lostBy(const LinearOnFace& from, const LinearOnFace& to,
                                     const EnergyDensity<T>& density) const;
  /// Of a joint that is crushed unevenly: mean of the crushing over the part in contact [m].
  KOKKOS_INLINE_FUNCTION Real meanCrushing() const;
  /// Closure beyond what it is crushed to, the most of it over the overlap [m].
  KOKKOS_INLINE_FUNCTION Real mostBeyondCrushing() const;

  /// Least closure over the part in contact, which is the whole overlap of a bond; infinity without
  /// any [m].
  KOKKOS_INLINE_FUNCTION T leastClosure() const;

  /// The pair with what is closed of a bond for its part in contact.
  /// @param offset as in meet() [m]
  KOKKOS_INLINE_FUNCTION PairPotential<Dim, Real> closedPart(const Real& offset) const
  {
    PairPotential<Dim, Real> closed(*face_[0], *face_[1], scale_);
    EdgesOf<Real> edges = edges_;
    for (Real& exit : edges.exits)
      exit = 0;
    if constexpr (branchFree::widthOf<T> == 1)
    {
      closed.laid_ = laid_;
      closed.laidLanes_ = laidLanes_;
    }
    closed.meet(offset, false, edges);
    return closed;
  }

private:
  using Owned = detail::OwnedSides<T>;
  static constexpr bool canRevolve = Dim == 2 && branchFree::widthOf<T> == 1;

  // Bodies of revolution (ContactPotentialRings.hpp), T = Real only: lengths along the plane count
  // by the mean of the circumferences of both faces there, which is linear along it.
  KOKKOS_INLINE_FUNCTION void revolve();
  /// The depth at a place along the plane: 1, of rings 2 pi r [m].
  KOKKOS_FORCEINLINE_FUNCTION T around(const T& s) const
  {
    if constexpr (canRevolve)
      if (scale_.axisymmetric)
        return radius_[0].atOrigin + radius_[1].atOrigin +
               (radius_[0].slope + radius_[1].slope) * s;
    return T(1.0);
  }
  /// Calls visit(s, part) for places on a segment that stand for parts of its length, exactly for
  /// cubics.
  template <class Visit>
  static KOKKOS_FORCEINLINE_FUNCTION void alongSegment(Real from, Real to, const Visit& visit)
  {
    const Real half = 0.5 * (to - from), middle = 0.5 * (from + to);
    visit(middle - gaussPlace * half, half);
    visit(middle + gaussPlace * half, half);
  }
  /// Moments of a ring between two places.
  KOKKOS_INLINE_FUNCTION ContactMoments<T> momentsOfRing(const Owned& q) const;
  /// Books in hoop_ an energy per depth at a place, which changes with the radii of all nodes.
  KOKKOS_INLINE_FUNCTION void addHoop(Real s, Real perDepth);
  /// Adds the gradient of what hangs on the radii of the nodes.
  KOKKOS_INLINE_FUNCTION void addRadii(const Real& energy, const EnergyDensity<T>& density,
                                       const Real& scale, Vec2 (&rim)[2][4]);

  /// The closure that counts in a piece: beyond what the joint is crushed to.
  KOKKOS_FORCEINLINE_FUNCTION T closureIn(const Owned& q, const Vec2Of<T>& p) const
  {
    if constexpr (branchFree::widthOf<T> == 1)
      if (q.crushed)
        return closureAt(p) - crushed_.at(p);
    return closureAt(p);
  }

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

  // Segments side by side (ContactPotentialSegments.hpp): an end of what they share is one of face
  // 0 or of face 1, by lane, or where their closure is zero.
  struct SharedSegment
  {
    T at[2];       ///< its ends, the lower one first [m]
    Mask of[2][2]; ///< by end and face: whether it is an end of that
  };
  /// Node of a face at its lower or upper end.
  static constexpr int nodeAtEnd(int f, int end) { return f == 0 ? end : 1 - end; }
  KOKKOS_INLINE_FUNCTION void findOverlapOfSegments();
  KOKKOS_INLINE_FUNCTION void integrateSegments(const Mask& whole);
  KOKKOS_INLINE_FUNCTION void addRimsOfSegments(const EnergyDensity<T>& density,
                                                Vec2Of<T> (&rim)[2][4]) const;

  // What of the overlap is in contact (ContactPotentialRegion.hpp).
  KOKKOS_INLINE_FUNCTION void findOverlap();
  KOKKOS_INLINE_FUNCTION void measureOverlap();
  /// For shadows that are not convex, and where round-off asks for the order of the sides: convex
  /// pieces, cut in order. A diagonal belongs to no edge: what both its sides have there cancels.
  /// @param whole a bond: folded faces have no piece
  KOKKOS_INLINE_FUNCTION void findPieces(bool whole);
  static KOKKOS_INLINE_FUNCTION int convexParts(const detail::Outline<T>& outline, int firstOwner,
                                                Owned (&parts)[2]);
  /// Of a quadrilateral two of whose edges cross: the triangle that lies right side up. It begins
  /// as what a quadrilateral with a reentrant corner is when that corner passes an edge, so that
  /// the energy does not jump when a face folds.
  /// @returns how many parts there are, 1 or 0
  KOKKOS_INLINE_FUNCTION int foldedPart(const detail::Outline<T>& outline, int firstOwner,
                                        Owned& part);
  /// Takes into chi how far faces have folded, which counts less the more of a face lies upside
  /// down, and nothing when that is as much as lies right side up: then its normal turns over.
  /// @param stored without chi [J]; slope: of chi with the logarithm of rho
  KOKKOS_INLINE_FUNCTION void weighFolded(const Real& stored, Real& slope);
  /// Takes into chi how little the faces share of a pair that has begun deep.
  /// @param stored without chi [J]; slope: of chi with the logarithm of rho
  KOKKOS_INLINE_FUNCTION void weighGrowing(const Real& stored, Real& slope);
  /// One over the area of the smaller face, smoothly: faces of a size count alike [1/m^2].
  KOKKOS_INLINE_FUNCTION Real perShare() const
  {
    return std::sqrt(
        0.5 * (1 / (face_[0]->area * face_[0]->area) + 1 / (face_[1]->area * face_[1]->area)));
  }
  /// Adds the gradient of what hangs on how much of them the faces share.
  KOKKOS_INLINE_FUNCTION void addGrowth(const Real& scale, Vec2 (&rim)[2][4]);
  /// Adds the gradient of what hangs on how far a face has folded.
  KOKKOS_INLINE_FUNCTION void addFolded(int f, Vec2 (&rim)[2][4]) const;
  KOKKOS_INLINE_FUNCTION void pressAll(const Mask& whole);
  /// Cuts off what is not closed, and integrates.
  KOKKOS_FORCEINLINE_FUNCTION void cutAndIntegrate(Owned& q, const Mask& whole);
  KOKKOS_FORCEINLINE_FUNCTION void integrateSegment(Owned& q, const Mask& whole);
  KOKKOS_FORCEINLINE_FUNCTION void cutPolygon(Owned& q, const Mask& whole);
  KOKKOS_FORCEINLINE_FUNCTION void integratePolygon(const Owned& q, const Mask& whole);
  KOKKOS_FORCEINLINE_FUNCTION void addSide(int owner, const Mask& isThere);
  /// Whether ways_ are known by edge; segments side by side have the sum of each face.
  static constexpr bool waysOfEdges = Dim == 3 || branchFree::widthOf<T> == 1;
  /// Where the closure along the border of an edge is added up, in ways_.
  static KOKKOS_FORCEINLINE_FUNCTION int wayOf(int owner)
  {
    return waysOfEdges ? owner : owner / 4;
  }
  /// Two borders across from each other, one of each face, bound a strip.
  struct Strip
  {
    T facing = T(0.0);  ///< 1 where they face away from each other, 0 from a right angle on
    T closure = T(0.0); ///< along both: twice their harmonic mean [m^2]
  };
  KOKKOS_INLINE_FUNCTION Strip stripBetween(int ownerOf0, int ownerOf1) const;
  /// Minus the cosine between the normals of two borders.
  KOKKOS_FORCEINLINE_FUNCTION T facing(int ownerOf0, int ownerOf1) const;
  /// Of all strips the fourth root of the sum of the fourth powers: what gets away over the nearer
  /// borders needs no others, so the narrowest strip counts, and of two alike both, smoothly.
  KOKKOS_INLINE_FUNCTION void joinStrips();
  /// What the energy changes with the closure along a border [N/m].
  KOKKOS_INLINE_FUNCTION Real slopeOfWay(int owner) const;
  /// Adds the gradient of what hangs on how borders face each other.
  KOKKOS_INLINE_FUNCTION void addFacing(Vec2 (&rim)[2][4]) const;
  /// Closure along the edges that bound strips; faces that share most of what they have are no
  /// strip, however deep they lie in each other. Segments side by side have a bound of it [m^2].
  KOKKOS_FORCEINLINE_FUNCTION T acrossStrip() const;
  /// Whether sideways is the shorter way out. Lanes have what is as narrow as to carry nothing, as
  /// beside each other on a joint that has slid a little; what is between is left to T = Real, and
  /// so are segments.
  KOKKOS_INLINE_FUNCTION void findStrip(const Mask& whole);

  // Joints that are crushed unevenly (ContactPotentialCrushing.hpp).
  /// Pieces that are crushed all over or nowhere, from what they are.
  KOKKOS_INLINE_FUNCTION void splitWhereCrushed();
  /// What of a polygon, part in contact or not, has positive values.
  KOKKOS_INLINE_FUNCTION void cutWhereNegative(Owned& q, const LinearOnPlane& f) const;
  /// The slope of the energy, over gamma phi, times minus the closure, by max(0, crushing).
  KOKKOS_INLINE_FUNCTION Real resisted(const LinearOnPlane& crushing,
                                       const EnergyDensity<T>& density) const;
  /// Adds the gradient by the crushing, which face 0 carries along.
  KOKKOS_INLINE_FUNCTION void addCrushing(const EnergyDensity<T>& density, Vec2 (&rim)[2][4]) const;
  /// The same of what hangs on the closure of crushed places by its sum over them: `push`, and
  /// `first`, that times the place.
  KOKKOS_INLINE_FUNCTION void carryCrushing(Real push, const Vec2& first, Vec2 (&rim)[2][4]) const;
  KOKKOS_INLINE_FUNCTION LinearOnPlaneOf<T> layer(int f) const
  {
    return AffineFrameOf<T>(shadow[f]).onPlane(laid_[f][0], laid_[f][1], laid_[f][2]);
  }
  /// Takes the layers of an uneven gap into the closure.
  KOKKOS_INLINE_FUNCTION void putOnLayers();
  /// Adds what the energy changes with as faces carry their layers along. `push`: the sum of what
  /// it changes with the closure, `first`: that times the place.
  KOKKOS_INLINE_FUNCTION void carryLayers(const T& push, const Vec2Of<T>& first,
                                          Vec2Of<T> (&rim)[2][4]) const;
  /// What a length that is linear over a face changes the energy by as its nodes move along the
  /// plane: at a fixed place it changes by minus its slope times their weighted motion.
  static KOKKOS_INLINE_FUNCTION void carry(const AffineFrameOf<T>& frame, const Vec2Of<T>& slope,
                                           const T& push, const Vec2Of<T>& first,
                                           Vec2Of<T> (&rim)[4]);
  /// Calls f(place) for the corners of a polygon.
  template <class F>
  KOKKOS_INLINE_FUNCTION void forEachCorner(const Owned& q, const F& f) const;
  /// Calls f(from, to) for its sides; in two dimensions for the whole segment.
  template <class F>
  KOKKOS_INLINE_FUNCTION void forEachSide(const Owned& q, const F& f) const;
  /// Calls f(closure, area) for places in a polygon that stand for all of it where `from` is
  /// exceeded: by Gauss' rule between corners, along the slope of the closure.
  template <class F>
  KOKKOS_INLINE_FUNCTION void forEachSlice(const Owned& q, const LinearOnPlane& closure, Real from,
                                           const F& f) const;

  // The gradient along the border of the part in contact (ContactPotentialRims.hpp).
  /// The gradient of the area in contact times the density there, side by side. A side belongs to
  /// one edge; an edge of the other face that lies beside it gets a part (shareRim), so that
  /// round-off does not decide which of two edges that count as one is the owner, and slivers
  /// between them carry nothing at their borders.
  /// @param ofRing the density is that of the area of a ring, not of its length along the plane
  KOKKOS_FORCEINLINE_FUNCTION void addRims(const Owned& q, const EnergyDensity<T>& density,
                                           Vec2Of<T> (&rim)[2][4], bool ofRing = true) const;
  KOKKOS_FORCEINLINE_FUNCTION void addRimOfEnd(const Owned& q, int end,
                                               const EnergyDensity<T>& density, bool ofRing,
                                               Vec2Of<T> (&rim)[2][4]) const;
  KOKKOS_FORCEINLINE_FUNCTION void addRimOfSide(const Owned& q, int k,
                                                const EnergyDensity<T>& density,
                                                Vec2Of<T> (&rim)[2][4]) const;
  /// What an edge of the other face gets of the rim at an edge of this one. In three dimensions
  /// the reach is times the length of the other edge: the size of a face across it is its area over
  /// that.
  ///
  /// Two mesh lines share evenly, and so do two edges at which surfaces end: where both count as
  /// one, the mean of the gradients on both sides of it. What lies at such an edge beside a mesh
  /// line is shared evenly as long as the closure changes across a face by less than its mean, so
  /// that what is pressed evenly rests; at a corner that dips into a face all of it belongs to the
  /// corner, for what pairs on both sides of a mesh line have there cancels. At a seam it does not:
  /// its edges belong to two bodies, which the corner drives apart. They share as edges of surfaces
  /// do, beside such edges only what is pressed evenly. All of it is smooth, so that round-off
  /// decides nothing.
  /// @param change of the closure over the size of a face, out over its edge, the same whichever of
  ///        both edges is the owner [m]
  KOKKOS_FORCEINLINE_FUNCTION SharedRim<T> shareRim(int mine, int its, const Mask& sameWay,
                                                    const T& change) const;
  /// The gradient of the energy beside one edge: its nodes share a part of it. total, second: of
  /// the density along the side, and of that times 0..1 along it. Moments stay exact also where the
  /// edge lies beside the side: it is taken where the line of the force crosses it.
  KOKKOS_INLINE_FUNCTION void addRim(int f, int e, const Mask& there, const Vec2Of<T>& from,
                                     const Vec2Of<T>& to, const T& total, const T& second,
                                     const T& part, Vec2Of<T> (&rim)[2][4]) const;
  /// Adds the gradient of what hangs on the borders of the strip.
  KOKKOS_INLINE_FUNCTION void addStrip(const Real& scale, Real& push, Vec2& first,
                                       Vec2 (&rim)[2][4]);
  /// The gradient of the closure along a side, whose ends are where the lines of its neighbours
  /// cross that of its edge; at a line of no closure the end counts nothing.
  /// @param slope of the energy with that [N/m]
  KOKKOS_INLINE_FUNCTION void addBorder(const Owned& q, int k, Real slope, Real& push, Vec2& first,
                                        Vec2 (&rim)[2][4]);
  /// Unit normal of the line of an edge, out of the polygon.
  KOKKOS_INLINE_FUNCTION Vec2Of<T> outwardOf(int owner) const;
  /// A gradient with the motion of an edge at a place on it.
  KOKKOS_INLINE_FUNCTION void pushEdge(int owner, const Vec2& at, const Vec2& slope,
                                       Vec2 (&rim)[2][4]) const;
  /// 0 for edges that count as one, 1 for edges that do not.
  KOKKOS_FORCEINLINE_FUNCTION T apartness(const T& distance) const;

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
  T falling_{};  ///< d ln phi / d ln U, 0 to -1
  T sizes_[2]{}; ///< minus d ln Y / d ln of the area of each face, Y: what is stored as in oppose()
  T birth_[2]{}; ///< areas [m^2]; of rings over the circumference now
  Mask bonded_{false};
  EdgesOf<T> edges_;
  T ways_[waysOfEdges ? 8 : 2]{}; ///< closure along the borders over which bodies can be left [m^2]
  T strips_{};                    ///< closure along the borders of strips [m^2]; if waysOfEdges
  T coveredSides_[2]{};           ///< number of sides on covered edges of each face
  T openSides_[2]{};              ///< and on others at which its surface turns
  Vec2Of<T> tilt_, apart_;
  Vec2Of<T> closureTilt_; ///< tilt_ of faces between which the closure changes as it does
  bool inOrder_ = false;
  int pieces_ = 0;
  Owned piece_[maxPieces];
  struct Nothing
  {
  };
  /// A face two of whose edges cross.
  struct Folded
  {
    Real area = 0; ///< of what lies right side up on the plane [m^2]; 0: not folded
    Vec2 corner[3];
    int edge[3];    ///< of the face, from these corners to the next
    Real share = 1; ///< area of the shadow, less what lies upside down, over `area` [-]
    Real slope = 0; ///< of the energy with the share [J]
  };
  std::conditional_t<Dim == 2 && branchFree::widthOf<T> != 1, SharedSegment, Nothing> segment_;
  static constexpr bool canFold = Dim == 3 && branchFree::widthOf<T> == 1;
  std::conditional_t<canFold, Folded, Nothing> folded_[2];
  /// Before what is not closed is cut off.
  std::conditional_t<branchFree::widthOf<T> == 1, Owned, Nothing> whole_[maxPieces];
  /// Half of the circumference at a face, linear along the plane [m].
  struct Around
  {
    Real atOrigin = 0, slope = 0;
  };
  std::conditional_t<canRevolve, Around, Nothing> radius_[2];
  std::conditional_t<canRevolve, Real, Nothing> around_[2]; ///< circumference of each face [m]
  /// What the energy changes with the radii of the nodes, over gamma phi [N].
  std::conditional_t<canRevolve, Real, Nothing> hoop_[2][2]{};
  bool uneven_ = false; ///< crushed unevenly
  std::conditional_t<branchFree::widthOf<T> == 1, AffineFrame, Nothing> frame_; ///< of face 0
  std::conditional_t<branchFree::widthOf<T> == 1, LinearOnPlane, Nothing> crushed_;
  /// Of what is crushed of the part in contact.
  std::conditional_t<branchFree::widthOf<T> == 1, ContactMoments<T>, Nothing> ofCrushed_;
  const T (*laid_)[3] = nullptr; ///< null: no lane has any
  Mask laidLanes_{false};
  /// The share from which on such pairs carry fully [-].
  static constexpr Real grownAt = 0.2;
  bool growing_ = false;
  Real alongShare_ = 0; ///< what the energy changes with the share of the smaller face [J]
  Mask strip_{false}, nothing_{false};
  T alongStrip_{}; ///< what the energy changes with the logarithm of the closure along its borders
                   ///< [J]
};
} // namespace coplane

#include <coplane_contact/ContactPotentialCrushing.hpp>
#include <coplane_contact/ContactPotentialRegion.hpp>
#include <coplane_contact/ContactPotentialRims.hpp>
#include <coplane_contact/ContactPotentialRings.hpp>
#include <coplane_contact/ContactPotentialSegments.hpp>
