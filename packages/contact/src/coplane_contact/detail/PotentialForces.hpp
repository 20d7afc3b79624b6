#pragma once

#include <coplane_contact/detail/PotentialKernel.hpp>

// Steps G and H of PotentialCycle: how the faces move, what the law of their joint makes of it, and
// the forces (docs/theory/contact-potential.md, "Laws").

namespace coplane::detail
{
template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void PotentialCycle<Dim, T>::lift(PerLane& lifts, T& pressed,
                                                              EnergyDensity<T>& density)
{
  bool any = false;
  for (int i = 0; i < planes_.count; ++i)
    any = any || lifts[i] > 0;
  if (!any)
    return;
  const auto meetLifted = [&] { pair_.meet(offset_ + all(lifts), bonded_, edgesOf(planes_)); };
  meetLifted();
  // Strips are left to T = Real, for which it is too late now.
  const Mask stays = pair_.regular && !pair_.isStrip();
  bool again = false;
  for (int i = 0; i < planes_.count; ++i)
    if (lifts[i] > 0 && !branchFree::lane(stays, i))
    {
      lifts[i] = 0;
      again = true;
    }
  if (again)
    meetLifted();
  deepest_ = deepest_ + all(lifts);
  pressed = pair_.press(slope_, branchFree::choose(bonded_, T(0.0), hardening_), density);
  growFromBirth();
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void PotentialCycle<Dim, T>::payLifts(const Response& response,
                                                                  const T& area,
                                                                  const T& normalForce) const
{
  for (int i = 0; i < planes_.count; ++i)
    if (response.lifts[i] > 0)
    {
      Plane& plane = *planes_.plane[i];
      const Real now = branchFree::lane(normalForce, i);
      plane.closure += response.lifts[i];
      plane.normalTraction = now / branchFree::lane(area, i);
      plane.frictionWork +=
          response.liftWork[i] - 0.5 * (response.before[i] + now) * response.lifts[i];
    }
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION typename PotentialCycle<Dim, T>::Relative
PotentialCycle<Dim, T>::stepG_motion() const
{
  const ContactMoments<T>& m = pair_.moments;
  const Vec3Of<T>& n = pair_.plane.normal;
  const Vec2Of<T> at =
      coplane::choose(bonded_, (1.0 / m.area) * m.areaMoment, (1.0 / m.volume) * m.volumeMoment);
  Relative r;
  for (int f = 0; f < 2; ++f)
    pair_.weightsAt(f, at, r.weights[f]);
  r.apart = apartAt(r.weights);
  r.gap = pair_.overLayers(r.apart, at);
  const Vec3Of<T> drift =
      weighted(r.weights[1], b_.v, b_.count) - weighted(r.weights[0], a_.v, a_.count);
  r.closing = -dot(n, drift);
  slideInStep(at, drift, r);
  return r;
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void PotentialCycle<Dim, T>::slideInStep(const Vec2Of<T>& at,
                                                                     const Vec3Of<T>& drift,
                                                                     Relative& relative) const
{
  using branchFree::choose;
  const auto& plane = pair_.plane;
  const Vec3Of<T> alongNow = drift + relative.closing * plane.normal;
  Vec3Of<T> along = alongNow;
  Vec3Of<T> turning = pair_.normalRate();
  T apart = relative.apart;
  relative.gained = {};
  const Mask held = planes_.each(
                        [](const Plane& p)
                        {
                          const Vec3& tau = p.history.shearTraction;
                          return p.area > 0 ? dot(tau, tau) : Real(0);
                        }) > 0.0;
  if (dt_ > 0 && branchFree::anyOf(held)) // not where a run begins
  {
    const T half = choose(held, T(0.5), T(0.0));
    const Vec3Of<T> normalThen = planes_.eachVector([](const Plane& p) { return p.normal; });
    const Vec3Of<T> offPoint = (0.5 * (relative.apart + dt_ * relative.closing)) * normalThen;
    const Vec3Of<T> point =
        planes_.eachVector([](const Plane& p) { return p.pointOfContact; }) - plane.point;
    T weights[2][4];
    for (int f = 0; f < 2; ++f)
    {
      const HalfStepFaceOf<T>& face = f == 0 ? a_ : b_;
      const Vec3Of<T> then = (f == 0 ? point - offPoint : point + offPoint) +
                             dt_ * weighted(relative.weights[f], face.v, face.count);
      const Vec2Of<T> thenAt{dot(plane.e1, then), Dim == 2 ? T(0.0) : dot(plane.e2, then)};
      pair_.weightsAt(f, at + half * (thenAt - at), weights[f]);
    }
    const T apartThere = apartAt(weights);
    apart = apartThere + choose(held, dt_ * relative.closing, T(0.0));
    along = weighted(weights[1], b_.v, b_.count) - weighted(weights[0], a_.v, a_.count);
    along = along - dot(plane.normal, along) * plane.normal;
    Vec3Of<T> turned = plane.normal - normalThen;
    turned = turned - dot(plane.normal, turned) * plane.normal;
    turning.x = choose(held, turned.x / dt_, turning.x);
    turning.y = choose(held, turned.y / dt_, turning.y);
    turning.z = choose(held, turned.z / dt_, turning.z);
    relative.gained = 2.0 * (alongNow - along - (relative.apart - apartThere) * turning);
  }
  relative.sliding = along - apart * turning;
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION T PotentialCycle<Dim, T>::apartAt(const T (&weights)[2][4]) const
{
  T apart{};
  for (int i = 0; i < b_.count; ++i)
    apart += weights[1][i] * pair_.shadow[1].height[i];
  for (int i = 0; i < a_.count; ++i)
    apart -= weights[0][i] * pair_.shadow[0].height[i];
  return apart;
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION Vec3Of<T> PotentialCycle<Dim, T>::shearAfter(const T& newArea,
                                                                         const Relative& relative,
                                                                         Vec3Of<T>& increment) const
{
  using branchFree::choose;
  const Vec3Of<T>& n = pair_.plane.normal;
  const T oldArea = planes_.each([](const Plane& p) { return p.area; });
  const T rootNew = branchFree::squareRoot(newArea);
  const T rootOld = choose(oldArea > 0.0, branchFree::squareRoot(oldArea), rootNew);
  const T perRoot = choose(newArea > 0.0, 1.0 / rootNew, T(0.0));
  const T spin = 0.5 * (spinAbout(n, a_) + spinAbout(n, b_));
  increment = (0.5 * dt_ * (rootOld + rootNew) * perRoot) * relative.sliding;
  return (rootOld * perRoot) *
         turnIntoPlane(planes_.eachVector([](const Plane& p) { return p.history.shearTraction; }),
                       planes_.eachVector([](const Plane& p) { return p.normal; }), n, spin * n,
                       dt_);
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void
PotentialCycle<Dim, T>::stepH_law(Plane& plane, int i, Real area, Real energyShare, Real loaded,
                                  const Vec3& tau, const Vec3& increment, const Relative& relative,
                                  Response& out) const
{
  const JointLaw& law = *planes_.law[i];
  const ContactMoments<T>& m = pair_.moments;
  const Real wholeArea = branchFree::lane(m.area, i);
  const bool wasBonded = plane.history.bonded;
  plane.normal = branchFree::lane(pair_.plane.normal, i);
  plane.closure = permanents_[i] + branchFree::lane(m.volume / m.area, i);
  plane.tooDeep = plane.isTooDeep();
  if (!(area > 0) && plane.area > 0)
    plane.frictionWork += endedShear(plane, i);
  plane.history.shearTraction = tau;

  const Real opposedness = branchFree::lane(pair_.opposedness, i);
  JointState state = plane.history;
  if (reached_[i] > 0)
    state.maximumClosure = reached_[i];
  // Where a way out is open sideways the area stands for what is left of the pressure.
  Real closed = wasBonded  ? plane.closure
                : area > 0 ? permanents_[i] + loaded * opposedness / (slopes_[i] * area)
                           : permanents_[i];
  Real crushing = permanents_[i];
  if (plane.crushedUnevenly && crushes_[i])
  {
    // The law sees an even crushing that bears the mean of the compression.
    const Real compression = slopes_[i] * (closed - permanents_[i]);
    crushing = law.curve.crushing.crushedUpTo(compression, permanents_[i]);
    state.maximumClosure = law.curve.crushing.closureOf(crushing, slopes_[i]);
    closed = crushing + compression / slopes_[i];
    closed = closed < state.maximumClosure ? closed : state.maximumClosure;
  }
  if (area > 0 && !(plane.area > 0) && plane.isInherited())
    state.shearTraction = heldAt(law, plane.fit, closed, state);
  const Real shrunk = area > 0 && plane.area > 0 ? std::sqrt(plane.area / area) : 1;
  const bool bends = branchFree::lane(bends_, i);
  const JointResponse response =
      law(plane.fit, closed, increment, dt_, state, shrunk, bends ? &bent_.lanes[i] : nullptr);
  out.slopes[i] = bends && bent_.lanes[i].opened > 0 ? response.bondStiffness : slopes_[i];
  if (wasBonded)
    plane.hysteresisWork += area * response.hysteresisWork(plane.normalTraction);
  else if (crushes_[i])
    keepCrushing(plane, i, crushing, response, state, out);
  else if (!law.curve.straight())
  {
    const ClosedPair pair = closedPair(i, energyShare);
    loadCurve(plane, law, pair, response, reached_[i], state);
    if (law.curve.crushing.acts())
      crushByShear(plane, pair, response, dt_ * branchFree::lane(relative.closing, i));
  }
  plane.history = state;
  if (!wasBonded && !law.curve.crushing.acts())
  {
    out.lifts[i] = response.lift;
    out.liftWork[i] = area * response.liftWork;
    out.before[i] = plane.area * plane.normalTraction;
  }
  Real friction = area * response.frictionWork;
  if (area > 0 && plane.area > 0 && !wasBonded &&
      (response.slipping || !(response.normalTraction > 0)))
  {
    friction += area * takenBesides(plane, i, tau, increment, shrunk, relative);
    friction = friction > 0 ? friction : 0;
  }
  plane.frictionWork += friction;
  out.tractions[i] = response.normalTraction;
  out.stored[i] =
      wasBonded ? law.storedNormally(plane.fit, plane.closure + response.dilation, plane.history)
                : 0;
  plane.area = area;
  plane.normalTraction = response.normalTraction;
  plane.state = !plane.history.bonded && response.normalTraction <= 0 ? PlaneState::Open
                : response.slipping                                   ? PlaneState::Slip
                                                                      : PlaneState::Stick;
  plane.offset += response.dilation;
  plane.fractureWork += area * response.fractureWork;
  if (wasBonded && !plane.history.bonded && !bends)
    plane.offset -= settlement<Dim>(plane, law, a_, b_, i, options_, out.stored[i] * wholeArea);
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION Real PotentialCycle<Dim, T>::takenBesides(
    const Plane& plane, int i, const Vec3& tau, const Vec3& increment, Real shrunk,
    const Relative& relative) const
{
  const Vec3& now = plane.history.shearTraction;
  const Vec3 gained = branchFree::lane(relative.gained, i);
  return -0.5 * (1 - shrunk) / (1 + shrunk) * dot(now - tau, increment) -
         0.25 * dt_ * dot(now - shrunk * tau, gained);
}

template <int Dim, class T>
KOKKOS_FUNCTION Real PotentialCycle<Dim, T>::endedShear(const Plane& plane, int i) const
{
  const Real stored = plane.shearEnergy();
  if (plane.history.bonded || !(stored > 0) || !(dt_ > 0))
    return stored;
  const HalfStepFace faces[2] = {placeBefore<Dim>(a_, i, dt_), placeBefore<Dim>(b_, i, dt_)};
  const PairPotential<Dim, Real> pair(faces[0], faces[1], ContactPotentialScale(options_));
  if (!pair.plane.opposed)
    return stored;
  const Vec3 from = plane.pointOfContact - pair.plane.point;
  const Vec2 at{dot(pair.plane.e1, from), Dim == 2 ? 0 : dot(pair.plane.e2, from)};
  Vec3 sliding;
  Real apart = 0;
  for (int f = 0; f < 2; ++f)
  {
    const HalfStepFace& face = faces[f];
    Real weights[4];
    pair.weightsAt(f, at, weights);
    const Real sign = f == 0 ? -1 : 1;
    sliding += sign * weighted(weights, face.v, face.count);
    for (int k = 0; k < face.count; ++k)
      apart += sign * weights[k] * pair.shadow[f].height[k];
  }
  sliding = sliding - apart * pair.normalRate();
  const Real taken = stored - 0.5 * dt_ * plane.area * dot(plane.history.shearTraction, sliding);
  return taken > 0 ? taken : 0;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Vec3 PotentialCycle<Dim, T>::heldAt(const JointLaw& law, const JointFit& fit,
                                                           Real closed, JointState state)
{
  const bool bonded = state.bonded;
  law(fit, closed, Vec3{}, 0, state);
  return state.bonded == bonded ? state.shearTraction : Vec3{};
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void
PotentialCycle<Dim, T>::keepCrushing(const Plane& plane, int i, Real crushing,
                                     const JointResponse& response, JointState& state,
                                     Response& out) const
{
  Real reached = mostWithoutCrushing(i);
  if (response.crushedByShear)
  {
    reached = state.maximumClosure;
    out.sheared[i] = planes_.law[i]->curve.crushing.crushedAt(reached, slopes_[i]) - crushing;
    out.parted[i] = out.sheared[i] - response.crushed;
  }
  else if (!plane.crushedUnevenly)
  {
    // Short of what would crush it, whatever round-off does.
    const Real closed = permanents_[i] + branchFree::lane(pair_.moments.squares, i) /
                                             branchFree::lane(pair_.moments.volume, i);
    reached *= 1 - 1e-9;
    reached = closed < reached ? closed : reached;
  }
  state.maximumClosure =
      plane.history.maximumClosure > reached ? plane.history.maximumClosure : reached;
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION ClosedPair PotentialCycle<Dim, T>::closedPair(int i,
                                                                          Real energyShare) const
{
  using branchFree::lane;
  const ContactMoments<T>& m = pair_.moments;
  return {lane(m.area, i), lane(m.volume, i), lane(m.squares, i), lane(pair_.rising(), i),
          energyShare,     permanents_[i],    slopes_[i]};
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION void
PotentialCycle<Dim, T>::stepH_forces(const Mask& touching, const T& area, const T& normalForce,
                                     const Relative& relative, const T& normalEnergy)
{
  const auto& weights = relative.weights;
  Vec3Of<T> tangential =
      area * planes_.eachVector([](const Plane& p) { return p.history.shearTraction; });
  T normalDamping{};
  if (options_.dampNormal > 0 || options_.dampShear > 0)
    tangential += damp(touching, area, normalForce, relative, normalDamping);
  for (int i = 0; i < planes_.count; ++i)
    if (branchFree::lane(touching, i))
      planes_.plane[i]->normalDamping = float(branchFree::lane(normalDamping, i));
  const Vec3Of<T> lever = (0.5 / pair_.kappa() * relative.apart) * tangential;
  pair_.addThroughNormal(0, lever);
  pair_.addThroughNormal(1, -lever);
  const Vec3Of<T> carried = tangential + normalDamping * pair_.plane.normal;
  Vec3Of<T> nodal[2][4];
  for (int i = 0; i < a_.count; ++i)
    nodal[0][i] = -pair_.gradient[0][i] - weights[0][i] * carried;
  for (int i = 0; i < b_.count; ++i)
    nodal[1][i] = weights[1][i] * carried - pair_.gradient[1][i];
  if (const Mask& none = pair_.hasNothing(); branchFree::anyOf(none))
    for (auto& ofFace : nodal) // zeros of one sign, whoever shares the lanes
      for (Vec3Of<T>& force : ofFace)
        for (T* const part : {&force.x, &force.y, &force.z})
          *part = branchFree::choose(none, T(0.0), *part);
  if (options_.followsPath && dt_ > 0)
    followPath(touching, normalEnergy, nodal);
  putForces(planes_, touching, nodal, a_, b_, dt_);
}

template <int Dim, class T>
KOKKOS_FORCEINLINE_FUNCTION Vec3Of<T>
PotentialCycle<Dim, T>::damp(const Mask& touching, const T& area, const T& normalForce,
                             const Relative& relative, T& normalDamping) const
{
  using branchFree::choose;
  // The stiffnesses are those of areas of the material, the masses those of areas now, of rings
  // per metre of the hoop as it was at the start.
  const T grown = 1.0 / pair_.materialArea;
  const T stiffness = grown * slope_;
  normalDamping = area * dashpotPerArea(options_.dampNormal, stiffness, a_, b_) * relative.closing;
  normalDamping = choose(!bonded_ && normalDamping < -normalForce, -normalForce,
                         normalDamping); // no tension
  const auto sticks =
      planes_.each([](const Plane& p) { return p.state == PlaneState::Stick; }) > 0.0;
  const T shearStiffness =
      grown * planes_.each([](const Plane& p) { return p.fit.shearStiffness; });
  const Vec3Of<T> damping = heldByFriction(
      planes_, normalForce,
      choose(sticks, -area * dashpotPerArea(options_.dampShear, shearStiffness, a_, b_), T(0.0)) *
          relative.sliding);
  // Along the normal, which bodies strike, by the trapezoid rule, as all work of nodes.
  const T before = planes_.each([](const Plane& p) { return p.normalDamping; });
  const T work =
      dt_ * (dot(damping, relative.sliding) - 0.5 * (before + normalDamping) * relative.closing);
  for (int i = 0; i < planes_.count; ++i)
    if (branchFree::lane(touching, i))
      planes_.plane[i]->dampingWork -= branchFree::lane(work, i);
  return damping;
}
} // namespace coplane::detail
