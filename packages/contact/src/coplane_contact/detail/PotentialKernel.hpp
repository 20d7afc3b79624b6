#pragma once

#include <coplane_contact/ContactPotential.hpp>
#include <coplane_contact/FacePairKernel.hpp>

// Steps B to H of a pair of faces whose forces come from one potential
// (docs/theory/contact-potential.md). Faces are those of the end of the step.

namespace coplane
{
namespace detail
{
/// Spin of a face about an axis along its normal or nearly so [1/s].
template <class T>
KOKKOS_INLINE_FUNCTION T spinAbout(const Vec3Of<T>& axis, const HalfStepFaceOf<T>& face)
{
  T moment{}, inertia{};
  for (int i = 0; i < face.count; ++i)
  {
    const Vec3Of<T> r = face.x[i] - face.center;
    moment += dot(axis, cross(r, face.v[i]));
    inertia += dot(r, r);
  }
  return moment / inertia;
}

template <class T>
KOKKOS_INLINE_FUNCTION EdgesOf<T> edgesOf(const PlaneBatch<T>& planes)
{
  EdgesOf<T> edges;
  unsigned any = 0;
  for (int i = 0; i < planes.count; ++i)
    any |= planes.plane[i]->turns | planes.plane[i]->covered; // exits turn
  for (int e = 0; e < 8 && any != 0; ++e)
  {
    edges.exits[e] = planes.each([&](const Plane& p) { return Real(p.exits >> e & 1); });
    edges.turns[e] = planes.each([&](const Plane& p) { return Real(p.turns >> e & 1); });
    edges.covered[e] = planes.each([&](const Plane& p) { return Real(p.covered >> e & 1); });
  }
  return edges;
}

/// Depth beyond which a first overlap is not taken for a contact; approach: of the faces in two
/// steps [m].
KOKKOS_INLINE_FUNCTION Real smallestStart(const Plane& plane, Real approach)
{
  if (plane.isNew() || plane.sighting == Sighting::Woken)
    return plane.depthLimit;
  const Real start = deepestBirth * plane.depthLimit;
  return approach > start ? approach : start;
}

/// Length of the shortest edge of both faces [m].
template <class T>
KOKKOS_INLINE_FUNCTION T shortestEdge(const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b)
{
  T shortest(infinity);
  for (const HalfStepFaceOf<T>* face : {&a, &b})
    for (int i = 0; i < face->count; ++i)
    {
      const Vec3Of<T> edge = face->x[i + 1 == face->count ? 0 : i + 1] - face->x[i];
      shortest = branchFree::smaller(dot(edge, edge), shortest);
    }
  return branchFree::squareRoot(shortest);
}

/// A bond carries by the mean closure, what is left of it where it is closed: half of a tilted
/// pair. The offset by which the joint settles when the bond breaks, so that this makes no energy
/// [m].
/// @param energy that is left at the mean closure [J]
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Real settlement(const Plane& plane, const JointLaw& law,
                                       const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b,
                                       int i, Real cosOpposed, Real energy)
{
  const HalfStepFace faces[2] = {placeOf(a, i), placeOf(b, i)};
  const ClosureCurve::Point top = law.curve.at(plane.fit, plane.history.maximumClosure);
  const Real permanent =
      law.curve.straight() ? 0 : plane.history.maximumClosure - top.traction / top.stiffness;
  const Real stiffness = law.curve.straight() ? plane.fit.normalStiffness : top.stiffness;
  Real low = 0, high = 0;
  for (int step = 0; step < 60; ++step)
  {
    const Real middle = 0.5 * (low + high);
    PairPotential<Dim, Real> pair(faces[0], faces[1], ContactPotentialScale(cosOpposed));
    if (!pair.plane.opposed)
      return 0;
    pair.meet(plane.offset - permanent - middle, false, {});
    if (step == 0)
      high = pair.mostClosure > 0 ? pair.mostClosure : 0;
    else
      (0.5 * stiffness * pair.moments.squares > energy ? low : high) = middle;
  }
  return low > 1e-12 * high ? high : 0;
}

/// What the closure curve's history loses when its maximum closure rises from `before` to now, with
/// the area in contact as it is [J]: the energy before less that after. The moments are those of
/// closures beyond the permanent closure of now.
KOKKOS_INLINE_FUNCTION Real lostByLoading(const JointLaw& law, const JointFit& fit, Real before,
                                          Real now, Real area, Real volume, Real squares)
{
  const ClosureCurve::Point old = law.curve.at(fit, before), point = law.curve.at(fit, now);
  const Real shift =
      (now - point.traction / point.stiffness) - (before - old.traction / old.stiffness);
  return 0.5 * (old.stiffness * (squares + 2 * shift * volume + shift * shift * area) -
                point.stiffness * squares);
}
} // namespace detail

/// Steps B to H of candidate pairs in one cycle. a and b: the faces at the end of the step.
/// @returns the lanes that are done. With Lanes, planes whose shadows are not regular are left
///          untouched; updatePotentialPlanes<Real> does them.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION branchFree::MaskOf<T>
updatePotentialPlanes(const PlaneBatch<T>& planes, const HalfStepFaceOf<T>& a,
                      const HalfStepFaceOf<T>& b, const ContactOptions& options, Real dt)
{
  using namespace branchFree;
  constexpr int width = PlaneBatch<T>::width;
  PairPotential<Dim, T> pair(a, b, ContactPotentialScale(options.cosOpposed));
  const auto& opposed = pair.plane.opposed;

  // The kernel is linear: a closure curve is its tangent at the largest closure so far, at which it
  // unloads, from the permanent closure on.
  const auto bonded = planes.each([](const Plane& p) { return p.history.bonded; }) > 0.0;
  Real slopes[width], permanents[width];
  for (int i = 0; i < width; ++i)
  {
    const Plane& plane = *planes.plane[i];
    const JointLaw& law = *planes.law[i];
    slopes[i] = plane.fit.normalStiffness;
    permanents[i] = 0;
    if (!law.curve.straight() && !plane.history.bonded)
    {
      const ClosureCurve::Point top = law.curve.at(plane.fit, plane.history.maximumClosure);
      slopes[i] = top.stiffness;
      permanents[i] = plane.history.maximumClosure - top.traction / top.stiffness;
    }
  }
  const T slope = gathered<T>([&](int i) { return slopes[i]; });
  const T permanent = gathered<T>([&](int i) { return permanents[i]; });
  const T hardening = gathered<T>(
      [&](int i) -> Real
      { return i < planes.count && planes.law[i]->penalty ? 1 / planes.plane[i]->depthLimit : 0; });
  const T offset = planes.each([](const Plane& p) { return p.offset; });
  if (anyOf(opposed))
    pair.meet(offset - permanent, bonded, detail::edgesOf(planes));
  const auto done = pair.regular || !opposed || MaskOf<T>(width == 1);
  bookOldForce(planes, done, a, b, dt);

  const T overlap = choose(opposed, pair.overlap, T(0.0));
  const auto overlaps = overlap > options.areaMin * smaller(a.area, b.area);
  const T deepest = pair.mostClosure + permanent; // negative: nearest
  const T speed = choose(overlaps, approachSpeed(pair.plane.normal, a, b), T(0.0));
  const T ahead = options.lookAhead * speed;
  const auto inContact =
      done && overlaps && pair.moments.area > 0.0 && (bonded || pair.moments.volume > 0.0);

  // Steps E and F.
  bool late[widthOf<T>] = {};
  const auto touching =
      gathered<T>(
          [&](int i) -> Real
          {
            if (i >= planes.count || !lane(done, i))
              return 0;
            Plane& plane = *planes.plane[i];
            plane.overlap = lane(overlap, i);
            late[i] = wasFoundLate(plane, lane(inContact, i));
            if (!lane(inContact, i))
            {
              plane.refusal = Refusal::None;
              return 0;
            }
            const bool carried = plane.area > 0;
            if (!carried && !(plane.declared && plane.isNew()) && !plane.history.bonded)
            {
              if (!plane.isRefused() && lane(pair.hidden, i))
                plane.refusal = Refusal::Hidden;
              // A contact begins at the surface, and begins there anew after its faces had no area
              // in common. Faces that come to share area while one lies deep behind the other did
              // not meet: they carry nothing until they share none. They have no energy yet, so
              // this costs none.
              const Real start = detail::smallestStart(plane, 2 * dt * lane(speed, i));
              // What slides on takes up where a neighbour leaves off, whose mean closure is no
              // less than a quarter of that at its border.
              const Real explained = (plane.lineage == Lineage::SlidesOn      ? 4
                                      : plane.isBorn() || plane.isInherited() ? 1
                                                                              : 0) *
                                     plane.closure;
              if (lane(deepest, i) - explained > start)
                plane.refusal = Refusal::Deep;
            }
            if (plane.isRefused())
              return 0;
            if (!(plane.birthArea[0] > 0))
            {
              plane.birthArea[0] = lane(a.area, i);
              plane.birthArea[1] = lane(b.area, i);
            }
            if (stepE_planeExists(plane) && (carried || plane.sighting != Sighting::Woken))
              return 1;
            // Overlap that exists when a pair is found has no energy.
            stepF_createPlane(plane, lane(pair.plane.normal, i), plane.offset - lane(deepest, i));
            plane.maximumBefore = plane.history.maximumClosure;
            return !((late[i] || plane.sighting == Sighting::Woken) && !plane.isInherited());
          }) > 0.0;

  if (anyOf(touching))
  {
    const ContactMoments<T>& m = pair.moments;
    const Vec3Of<T>& n = pair.plane.normal;
    const T mean = m.volume / m.area;
    EnergyDensity<T> density;
    const T pressed = pair.press(slope, choose(bonded, T(0.0), hardening), density);
    const T share = choose(bonded, T(1.0), pair.wayOut);
    const T newArea = choose(touching, pair.opposedness * share * m.area, T(0.0));

    // Motion at the centre of pressure.
    const Vec2Of<T> at =
        coplane::choose(bonded, (1.0 / m.area) * m.areaMoment, (1.0 / m.volume) * m.volumeMoment);
    T weights[2][4];
    pair.weightsAt(at, weights);
    T apart{};
    for (int i = 0; i < b.count; ++i)
      apart += weights[1][i] * pair.shadow[1].height[i];
    for (int i = 0; i < a.count; ++i)
      apart -= weights[0][i] * pair.shadow[0].height[i];
    const Vec3Of<T> drift = weighted(weights[1], b.v, b.count) - weighted(weights[0], a.v, a.count);
    const T closing = -dot(n, drift);
    const Vec3Of<T> sliding = drift + closing * n - apart * pair.normalRate();

    // The shear state is traction times the root of the area, so that its energy does not hang on
    // the area.
    const T oldArea = planes.each([](const Plane& p) { return p.area; });
    const T rootNew = squareRoot(newArea);
    const T rootOld = choose(oldArea > 0.0, squareRoot(oldArea), rootNew);
    const T perRoot = choose(newArea > 0.0, 1.0 / rootNew, T(0.0));
    const T spin = 0.5 * (detail::spinAbout(n, a) + detail::spinAbout(n, b));
    const Vec3Of<T> tau =
        (rootOld * perRoot) *
        turnIntoPlane(planes.eachVector([](const Plane& p) { return p.history.shearTraction; }),
                      planes.eachVector([](const Plane& p) { return p.normal; }), n, spin * n, dt);
    const Vec3Of<T> increment = (0.5 * dt * (rootOld + rootNew) * perRoot) * sliding;

    // The law, plane by plane: shear, bonds, dilation; history of the closure curve.
    const auto loaded = 2.0 * density.square * m.volume + density.linear * m.area;
    Real tractions[width] = {}, stored[width] = {};
    for (int i = 0; i < planes.count; ++i)
    {
      if (!lane(touching, i))
        continue;
      Plane& plane = *planes.plane[i];
      const JointLaw& law = *planes.law[i];
      const Real area = lane(newArea, i);
      const Real wholeArea = lane(m.area, i), volume = lane(m.volume, i),
                 squares = lane(m.squares, i);
      const bool wasBonded = plane.history.bonded;
      plane.normal = lane(n, i);
      plane.gap = lane(apart, i);
      plane.closure = permanents[i] + lane(mean, i);
      plane.tooDeep = plane.closure > plane.depthLimit;
      if (!(area > 0) && plane.area > 0)
        plane.frictionWork += plane.shearEnergy();
      plane.history.shearTraction = lane(tau, i);

      const Real before = plane.history.maximumClosure;
      JointState state = plane.history;
      // Where a way out is open sideways the area stands for what is left of the pressure.
      const Real closed = wasBonded  ? plane.closure
                          : area > 0 ? permanents[i] + lane(loaded, i) * lane(pair.opposedness, i) /
                                                           (slopes[i] * area)
                                     : permanents[i];
      const JointResponse response = law(plane.fit, closed, lane(increment, i), dt, state);
      if (!wasBonded)
      {
        // The maximum closure of the next cycle; what it costs is booked half with the area of this
        // cycle and half with that of the next.
        const Real energyShare = lane(pair.opposedness, i) * lane(share, i);
        if (!law.curve.straight())
        {
          state.maximumClosure = before;
          if (plane.maximumBefore < before)
            plane.hysteresisWork += plane.halfHysteresis +
                                    0.5 * energyShare *
                                        detail::lostByLoading(law, plane.fit, plane.maximumBefore,
                                                              before, wholeArea, volume, squares);
          plane.maximumBefore = before;
          plane.halfHysteresis = 0;
          const Real reached = permanents[i] + squares / volume;
          if (reached > before)
          {
            const ClosureCurve::Point next = law.curve.at(plane.fit, reached);
            const Real shift = reached - next.traction / next.stiffness - permanents[i];
            state.maximumClosure = reached;
            plane.halfHysteresis =
                0.5 * energyShare * 0.5 *
                (slopes[i] * squares -
                 next.stiffness * (squares - 2 * shift * volume + shift * shift * wholeArea));
          }
        }
      }
      else
      {
        plane.hysteresisWork += area * response.hysteresisWork;
        plane.maximumBefore = state.maximumClosure;
      }
      plane.history = state;
      tractions[i] = response.normalTraction;
      stored[i] = wasBonded ? law.storedNormally(plane.fit, plane.closure + response.dilation,
                                                 plane.history)
                            : 0;
      plane.area = area;
      plane.normalTraction = response.normalTraction;
      plane.state = !plane.history.bonded && response.normalTraction <= 0 ? PlaneState::Open
                    : response.slipping                                   ? PlaneState::Slip
                                                                          : PlaneState::Stick;
      plane.offset += response.dilation;
      plane.frictionWork += area * response.frictionWork;
      plane.fractureWork += area * response.fractureWork;
      if (wasBonded && !plane.history.bonded)
        plane.offset -=
            detail::settlement<Dim>(plane, law, a, b, i, options.cosOpposed, stored[i] * wholeArea);
    }
    const auto each = [&](const Real* values)
    { return gathered<T>([&](int i) { return values[i]; }); };

    // A bond pulls evenly, by the mean closure.
    const T sigma = each(tractions), perArea = each(stored);
    density.square = choose(bonded, T(0.0), density.square);
    density.constant = choose(bonded, perArea - sigma * mean, density.constant);
    density.linear = choose(bonded, sigma, density.linear);
    const T energy = choose(bonded, perArea * m.area, pressed);
    const T normalForce = pair.differentiate(
        energy, density, planes.each([](const Plane& p) { return p.birthArea[0]; }),
        planes.each([](const Plane& p) { return p.birthArea[1]; }));

    // Shear: its moment is carried by the turning of the plane.
    Vec3Of<T> tangential =
        newArea * planes.eachVector([](const Plane& p) { return p.history.shearTraction; });
    T normalDamping{}, dampingWork{};
    if (options.dampNormal > 0 || options.dampShear > 0)
    {
      T inverseMass{};
      for (int i = 0; i < a.count; ++i)
        inverseMass += weights[0][i] * weights[0][i] / a.mass[i];
      for (int i = 0; i < b.count; ++i)
        inverseMass += weights[1][i] * weights[1][i] / b.mass[i];
      normalDamping =
          2.0 * options.dampNormal * squareRoot(newArea * slope / inverseMass) * closing;
      normalDamping = choose(!bonded && normalDamping < -normalForce, -normalForce,
                             normalDamping); // no tension
      const auto sticks =
          planes.each([](const Plane& p) { return p.state == PlaneState::Stick; }) > 0.0;
      const T shearStiffness = planes.each([](const Plane& p) { return p.fit.shearStiffness; });
      const Vec3Of<T> damping =
          choose(sticks,
                 -2.0 * options.dampShear * squareRoot(newArea * shearStiffness / inverseMass),
                 T(0.0)) *
          sliding;
      dampingWork = dt * (dot(damping, sliding) - normalDamping * closing);
      tangential += damping;
    }
    const Vec3Of<T> lever = (0.5 / pair.kappa() * apart) * tangential;
    pair.addThroughNormal(0, lever);
    pair.addThroughNormal(1, -lever);
    const Vec3Of<T> carried = tangential + normalDamping * n;
    Vec3Of<T> nodal[2][4];
    for (int i = 0; i < a.count; ++i)
      nodal[0][i] = -pair.gradient[0][i] - weights[0][i] * carried;
    for (int i = 0; i < b.count; ++i)
      nodal[1][i] = weights[1][i] * carried - pair.gradient[1][i];
    putForces(planes, touching, nodal, a, b, dt);

    const T normalEnergy = pair.materialArea * pair.opposedness * energy;
    const Vec3Of<T> point =
        0.5 * (weighted(weights[0], a.x, a.count) + weighted(weights[1], b.x, b.count));
    for (int i = 0; i < planes.count; ++i)
      if (lane(touching, i))
      {
        Plane& plane = *planes.plane[i];
        plane.dampingWork -= lane(dampingWork, i);
        plane.pointOfContact = lane(point, i);
        plane.stored = lane(normalEnergy, i) + plane.shearEnergy();
      }
  }

  // The overlap counts for the stable step as soon as the faces could touch within the look-ahead.
  const auto near = overlaps && -pair.mostClosure <= ahead + 1e-8 * squareRoot(overlap) &&
                    !(planes.each([](const Plane& p) { return p.isRefused(); }) > 0.0);
  T nodeArea{};
  if (anyOf(near))
  {
    const int fewer = a.count < b.count ? a.count : b.count;
    // Rims make a contact stiffer that is deep for its width.
    const T deep = positivePart(deepest / detail::shortestEdge(a, b) - 0.02);
    const T z = hardening * positivePart(deepest + ahead), z2 = z * z;
    // The slope of the hardened law is largest at 0.3455, where it is 12.3: from there on it stays.
    const T grown = smaller(z2 * z2 / (1.0 + z2 * z2), T(0.3455));
    const T hardened =
        1.0 + PenaltyHardening::part * grown * (1.0 + (1.0 - grown) * (14.0 - 16.0 * grown));
    nodeArea = overlap * (1.0 + 3.0 * deep) * hardened *
               (2.000002 * (1.5 / fewer < 1 ? 1.5 / fewer : 1.0));
  }
  for (int i = 0; i < planes.count; ++i)
  {
    if (!lane(done, i))
      continue;
    Plane& plane = *planes.plane[i];
    if (!lane(touching, i))
    {
      if (plane.area > 0)
        plane.frictionWork += plane.shearEnergy();
      carryNothing(plane);
      if (plane.overlap > 0)
        plane.gap = plane.offset - lane(deepest, i);
    }
    plane.sighting = late[i] ? Sighting::FoundLate : Sighting::Known;
    plane.nodeStiffness =
        lane(near, i)
            ? float(plane.weightInStep() * planes.law[i]->stiffnessBound(plane.fit, plane.history) *
                    lane(nodeArea, i))
            : 0;
  }
  return done;
}

/// Steps B to H by the forces that the options ask for. Bodies of revolution have only those along
/// the common normal.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION branchFree::MaskOf<T>
updateByForces(const PlaneBatch<T>& planes, const HalfStepFaceOf<T>& a, const HalfStepFaceOf<T>& b,
               const ContactOptions& options, Real dt)
{
  return options.forces == ContactOptions::Forces::Potential
             ? updatePotentialPlanes<Dim, T>(planes, a, b, options, dt)
             : updatePlanes<Dim, T>(planes, a, b, options, dt);
}
template <int Dim>
KOKKOS_INLINE_FUNCTION void updateByForces(Plane& plane, const HalfStepFace& a,
                                           const HalfStepFace& b, const JointLaw& law,
                                           const ContactOptions& options, Real dt)
{
  PlaneBatch<Real> one;
  one.plane[0] = &plane;
  one.law[0] = &law;
  updateByForces<Dim, Real>(one, a, b, options, dt);
}
} // namespace coplane
