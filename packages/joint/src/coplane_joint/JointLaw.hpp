#pragma once

#include <coplane_joint/BartonBandis.hpp>
#include <coplane_joint/Bond.hpp>
#include <coplane_joint/ClosureCurve.hpp>
#include <coplane_joint/JointState.hpp>

#include <cmath>
#include <type_traits>

namespace coplane
{
/// Law of a joint card: traction on a common plane per unit of its area. A table of laws is shared
/// by all planes; each plane has its own JointFit and JointState.
///
/// Closure c > 0 when the joint closes [m]; normal traction sigma > 0 in compression [Pa]; the
/// shear traction acts on the face with the higher id and opposes its slip. Compression follows the
/// closure curve; a bonded joint also carries tension and cohesion until it is broken. Shear is
/// elastic up to a strength of cohesion and friction.
struct JointLaw
{
  enum class Strength : std::uint8_t
  {
    Coulomb,
    BartonBandis
  };

  /// Penalty contact takes its normal stiffness from the elements behind the faces: fraction /
  /// (h0/M0 + h1/M1), which is `fraction` times the stiffness of the two elements in series. With 2
  /// contact is half as compliant as the elements: a ball of 32 elements in its radius is within
  /// 3 % of Hertz, and the pressure at the depth limit is above what bodies bear.
  bool penalty = true;
  Real stiffnessFraction = 2; ///< [-]
  Real initialStiffness = 0;  ///< [Pa/m], unless penalty or a table
  ClosureCurve curve;
  Real stiffnessCap = 0;    ///< of curves [Pa/m]; 0: 0.5 M/h of the softer element
  Real shearStiffness = -1; ///< [Pa/m]; negative: shearRatio times the initial stiffness
  Real shearRatio = 0.5;    ///< [-]

  Strength strength = Strength::Coulomb;
  Real friction = 0;         ///< at rest [-]
  Real dynamicFriction = -1; ///< of fast slip [-]; negative: as at rest
  Real slipSpeed = 1;        ///< v_c of mu_d + (mu_s - mu_d) exp(-v / v_c) [m/s]
  Real cohesion = 0;         ///< shear strength of a closed or bonded joint; does not soften [Pa]
  Real dilation = 0;         ///< tangent of the dilation angle of Coulomb friction [-]
  Real dilationSlip = infinity; ///< slip path after which nothing dilates any more [m]
  BartonBandis rough;
  Bond bond;

  /// h: thickness of the elements behind the faces at birth [m]; M: their undamaged P-wave modulus
  /// [Pa].
  JointFit fittedTo(Real h0, Real M0, Real h1, Real M1) const
  {
    JointFit fit;
    fit.normalStiffness = penalty            ? stiffnessFraction / (h0 / M0 + h1 / M1)
                          : curve.points > 0 ? curve.tableSlope(0)
                                             : initialStiffness;
    if (curve.stiffens())
    {
      const Real soft = M0 / h0 < M1 / h1 ? M0 / h0 : M1 / h1;
      const Real cap = stiffnessCap > 0 ? stiffnessCap : 0.5 * soft;
      fit.stiffnessCap = cap > fit.normalStiffness ? cap : fit.normalStiffness;
    }
    fit.shearStiffness = shearStiffness >= 0 ? shearStiffness : shearRatio * fit.normalStiffness;
    return fit;
  }

  /// Whether what is pressed harder at one end is crushed more there, as far as forces come from a
  /// potential and no bond holds: a stiffness that is lost with the crushing would be uneven, too.
  KOKKOS_INLINE_FUNCTION bool crushesUnevenly() const
  {
    return curve.crushing.acts() && !(curve.crushing.loss > 0);
  }

  /// Whether compression may crush a joint further with a shear traction, of which friction holds
  /// no more than it can.
  /// @param crushed so far [m]
  /// @param sigma compression, shear: size of the traction before friction limits it [Pa]
  KOKKOS_INLINE_FUNCTION bool mayBeCrushed(Real crushed, Real sigma, Real shear) const
  {
    if (remembersSlip()) // slip lifts the faces, and presses them more
      return true;
    const Real mu = friction > dynamicFriction ? friction : dynamicFriction;
    const Real most = cohesion + mu * sigma, tau = shear < most ? shear : most;
    const Real strength = (1 - 1e-9) * curve.crushing.strengthAt(crushed);
    return sigma * sigma + curve.crushing.shearWeight * (tau * tau) > strength * strength;
  }

  KOKKOS_INLINE_FUNCTION bool isCrushed(const JointFit& fit, const JointState& state) const
  {
    return curve.crushing.acts() &&
           state.maximumClosure > curve.crushing.onset(fit.normalStiffness);
  }

  /// Whether a declared joint with this law starts bonded.
  KOKKOS_INLINE_FUNCTION bool cohesive() const { return bond.kind != Bond::Kind::None; }
  /// Whether faces may come to act on each other that are farther apart than any were when the
  /// joint was closed: bonds hold while they open, and dilation moves the place where faces touch.
  bool mayReachOut() const { return cohesive() || remembersSlip(); }
  /// Whether what the joint does hangs on how far it has slipped.
  KOKKOS_INLINE_FUNCTION bool remembersSlip() const
  {
    return strength == Strength::BartonBandis || dilation > 0;
  }

  /// 0: as at the start, 1: a bond that is broken, or never was. A joint without bond has none.
  KOKKOS_INLINE_FUNCTION Real damage(const JointState& state) const
  {
    if (bond.kind == Bond::Kind::None)
      return 0;
    if (!state.bonded)
      return 1;
    return bond.softens() ? 1 - bond.share(state) : 0;
  }

  /// One step: closure at its end, tangential displacement increment of the higher face relative to
  /// the lower one during it [m], its length [s]. The stored shear traction has been turned into
  /// the plane by the caller. The caller raises the plane's offset, hence the closure, by the
  /// dilation of the response.
  /// @param shrunk where the caller keeps the shear energy of an area that changes: by what it has
  ///        multiplied the stored traction for that, r, and the increment by (r + 1) / 2. What it
  ///        raised slips back where it is beyond the strength, but nothing has moved for it. [-]
  /// @param bending how the closure is spread, for bonds that resist bending; none: evenly
  KOKKOS_INLINE_FUNCTION JointResponse operator()(const JointFit& fit, Real closure,
                                                  const Vec3& tangentialIncrement, Real dt,
                                                  JointState& state, Real shrunk = 1,
                                                  const BondBending* bending = nullptr) const
  {
    if (!(strength == Strength::Coulomb && bond.kind == Bond::Kind::None && dynamicFriction < 0 &&
          dilation <= 0))
      return general(fit, closure, tangentialIncrement, dt, state, shrunk, bending);
    JointResponse response;
    close(fit, closure, state, response);
    if (response.normalTraction > 0)
      shear(fit, tangentialIncrement, cohesion + friction * response.normalTraction, shrunk, state,
            response);
    else
      response.frictionWork = release(fit, tangentialIncrement, state);
    return response;
  }

  /// Whether a bond has worn, or may wear in this step: where it has half of its strength, or gets
  /// all of it by sliding on.
  /// @param opened where it is most open [m]
  /// @param slid by how much the faces slide past each other in this step, at most [m]
  KOKKOS_INLINE_FUNCTION bool mayWear(const JointFit& fit, const JointState& state, Real opened,
                                      Real slid) const
  {
    const Real held = bond.softens() ? bond.cohesion : cohesion;
    const Real shear = norm(state.shearTraction);
    return state.opening > 0 || state.shearing > 0 ||
           fit.normalStiffness * opened > 0.5 * bond.tensileStrength || shear > 0.5 * held ||
           shear + fit.shearStiffness * slid > held;
  }

  /// Recoverable energy of the normal traction [J/m^2]; the closure after dilation.
  KOKKOS_INLINE_FUNCTION Real storedNormally(const JointFit& fit, Real closure,
                                             const JointState& state) const
  {
    const ClosureCurve::Point top = curve.at(fit, state.maximumClosure);
    const Real c = closure + bond.permanentOpening(state);
    const Real sigma = top.traction - top.stiffness * (state.maximumClosure - c);
    if (sigma > 0)
      return 0.5 * sigma * sigma / top.stiffness;
    if (!state.bonded)
      return 0;
    const Real opened = -sigma / top.stiffness;
    return 0.5 * bond.tensionStiffness(fit.normalStiffness, state) * opened * opened;
  }
  /// Recoverable energy of the normal and the shear traction [J/m^2]; the closure after dilation.
  KOKKOS_INLINE_FUNCTION Real stored(const JointFit& fit, Real closure,
                                     const JointState& state) const
  {
    Real energy = storedNormally(fit, closure, state);
    if (fit.shearStiffness > 0)
      energy += 0.5 * dot(state.shearTraction, state.shearTraction) / fit.shearStiffness;
    return energy;
  }

  /// Whether the closure curve has reached the cap, so that it is softer than the card says.
  bool capped(const JointFit& fit, const JointState& state) const
  {
    return curve.stiffens() && curve.slopeAhead(fit, state.maximumClosure) >= fit.stiffnessCap;
  }

  /// Irrecoverable part of the work of first loading to a closure [J/m^2].
  KOKKOS_INLINE_FUNCTION Real hysteresis(const JointFit& fit, Real maximumClosure) const
  {
    return curve.hysteresis(fit, maximumClosure);
  }

  /// Closure under a compressive traction at first loading; under tension that of an undamaged
  /// bond, at most its strength [m].
  KOKKOS_INLINE_FUNCTION Real closureUnder(const JointFit& fit, Real compression) const
  {
    if (compression < 0 && cohesive())
      return std::fmax(compression, -bond.tensileStrength) / fit.normalStiffness;
    return curve.closureUnder(fit, compression);
  }

  /// Largest slope that the next step can see, of the normal or the shear traction, for the stable
  /// step [Pa/m]. Slip with dilation couples both; its largest eigenvalue is a mean of the two.
  /// @param ahead closure that may be reached until then [m]
  KOKKOS_INLINE_FUNCTION Real stiffnessBound(const JointFit& fit, const JointState& state,
                                             Real ahead = 0) const
  {
    return std::fmax(curve.slopeAhead(fit, std::fmax(state.maximumClosure, ahead)),
                     fit.shearStiffness);
  }

  /// Shear strength by friction over normal traction.
  KOKKOS_INLINE_FUNCTION Real frictionAt(Real sigma, Real slipPath, Real speed) const
  {
    if (strength == Strength::BartonBandis)
      return rough.friction(sigma, slipPath);
    if (dynamicFriction < 0)
      return friction;
    return dynamicFriction + (friction - dynamicFriction) * std::exp(-speed / slipSpeed);
  }

private:
  /// Compression at closure c; raises the maximum closure. Returns how far a joint is open beyond
  /// the closure at which it carries nothing [m]; negative: it is pressed.
  KOKKOS_INLINE_FUNCTION Real close(const JointFit& fit, Real c, JointState& state,
                                    JointResponse& response) const
  {
    const Real before = state.maximumClosure;
    const bool loading = c > before;
    if (loading)
      state.maximumClosure = c;
    const ClosureCurve::Point top = curve.at(fit, state.maximumClosure);
    response.normalStiffness = top.stiffness;
    const Real sigma = top.traction - top.stiffness * (state.maximumClosure - c);
    response.normalTraction = sigma > 0 ? sigma : 0;
    if (loading && curve.crushing.acts())
      crush(fit.normalStiffness, curve.crushing.crushedAt(before, fit.normalStiffness),
            curve.crushing.crushedAt(c, fit.normalStiffness), response);
    else if (loading && curve.stiffens())
      response.curveWork +=
          std::fmax(0.0, curve.hysteresis(fit, c) - curve.hysteresis(fit, before));
    return -sigma / top.stiffness;
  }

  /// Books that compression crushes the joint.
  KOKKOS_INLINE_FUNCTION void crush(Real kn, Real from, Real to, JointResponse& response) const
  {
    response.crushed += (1 - curve.crushing.loss) * (to - from);
    response.softened += curve.crushing.softened(from, to, kn);
  }

  /// Compression that a closure would give.
  KOKKOS_INLINE_FUNCTION Real pressedAt(const JointFit& fit, Real c, const JointState& state) const
  {
    const Real most = c > state.maximumClosure ? c : state.maximumClosure;
    const ClosureCurve::Point top = curve.at(fit, most);
    const Real sigma = top.traction - top.stiffness * (most - c);
    return sigma > 0 ? sigma : 0;
  }

  /// Elastic shear up to the strength, slip beyond. Work of the mean traction of the step is stored
  /// or dissipated to round-off, whatever the strength does.
  KOKKOS_INLINE_FUNCTION void shear(const JointFit& fit, const Vec3& increment, Real most,
                                    Real shrunk, JointState& state, JointResponse& response) const
  {
    const Vec3 before = state.shearTraction;
    const Vec3 trial = before - fit.shearStiffness * increment;
    const Real size = norm(trial);
    if (size > most)
      response.frictionWork = slip(fit, before, trial, size, most,
                                   raised(fit, before, increment, size, shrunk), state, response);
    else
      state.shearTraction = trial;
  }

  /// What of the trial traction nothing has moved for: it came with an area that shrinks [Pa].
  KOKKOS_INLINE_FUNCTION Real raised(const JointFit& fit, const Vec3& before, const Vec3& increment,
                                     Real size, Real shrunk) const
  {
    if (!(shrunk > 1))
      return 0;
    const Real moved =
        norm((1 / shrunk) * before - (2 * fit.shearStiffness / (1 + shrunk)) * increment);
    return size > moved ? size - moved : 0;
  }

  /// Brings the traction from its trial back to the strength; work of the slip [J/m^2].
  KOKKOS_INLINE_FUNCTION Real slip(const JointFit& fit, const Vec3& before, const Vec3& trial,
                                   Real size, Real most, Real raised, JointState& state,
                                   JointResponse& response) const
  {
    response.slipping = true;
    state.shearTraction = (most / size) * trial;
    if (!(fit.shearStiffness > 0))
      return 0;
    const Vec3 path = (1 / fit.shearStiffness) * (state.shearTraction - trial);
    if (size - raised > most)
      state.slip += (size - raised - most) / fit.shearStiffness;
    const Real work = -0.5 * dot(before + state.shearTraction, path);
    return work > 0 ? work : 0;
  }

  /// The joint is open: its shear traction is gone. Returns what it had stored and the work done on
  /// it in this step, which are dissipated [J/m^2].
  KOKKOS_INLINE_FUNCTION Real release(const JointFit& fit, const Vec3& increment,
                                      JointState& state) const
  {
    const Vec3 before = state.shearTraction;
    state.shearTraction = {};
    if (!(fit.shearStiffness > 0))
      return 0;
    const Real work = 0.5 * (dot(before, before) / fit.shearStiffness - dot(before, increment));
    return work > 0 ? work : 0;
  }

  /// Tension of a bonded joint that is open by `opened`; it may break.
  KOKKOS_INLINE_FUNCTION void pull(const JointFit& fit, Real opened, JointState& state,
                                   JointResponse& response) const
  {
    const Real k = fit.normalStiffness;
    if (bond.kind == Bond::Kind::Brittle)
    {
      response.normalStiffness = k;
      response.normalTraction = -k * opened;
      if (k * opened <= bond.tensileStrength)
        return;
      response.normalTraction = 0;
      response.fractureWork += 0.5 * bond.tensileStrength * bond.tensileStrength / k;
      state.bonded = false;
      return;
    }
    const Real elastic = opened - bond.loss * state.opening;
    const Real q = bond.wear(state);
    if (k * elastic > bond.tensileStrength * bond.share(q))
    {
      const Real jump =
          bond.inelasticJump(k * elastic, k, 0, bond.tensileStrength, bond.openingLength, q);
      response.fractureWork += bond.openingWork(q, state.opening, jump);
      state.opening += jump;
      response.normalTraction = -bond.tensileStrength * bond.share(state);
      response.normalStiffness = bond.tensionStiffness(k, state);
    }
    else
    {
      response.normalStiffness = bond.tensionStiffness(k, state);
      response.normalTraction = -response.normalStiffness * opened;
    }
  }

  /// Breaks the bond: its tension is gone. A joint that is pressed keeps what opened inelastically
  /// between its faces, as dilation.
  KOKKOS_INLINE_FUNCTION void breakBond(const JointFit& fit, const BondBending& bending,
                                        JointState& state, JointResponse& response) const
  {
    if (bond.resistsBending)
      bond.weakenBent(fit.normalStiffness, bending, 0, response);
    else if (response.normalTraction > 0)
      response.dilation += bond.permanentOpening(state);
    else if (response.normalTraction < 0)
    {
      response.fractureWork +=
          0.5 * response.normalTraction * response.normalTraction / response.normalStiffness;
      response.normalTraction = 0;
    }
    state.bonded = false;
  }

  /// What a slip begins with.
  struct SlipStart
  {
    Vec3 before, trial; ///< shear traction before the step, and as if nothing slipped [Pa]
    Real size;          ///< of the trial [Pa]
    Real raised;        ///< what of it nothing has moved for [Pa]
    Real closure;       ///< with what a bond keeps open [m]
    Real opened;        ///< beyond the closure at which nothing is carried [m]
    Real pressed;       ///< compression [Pa]
    Real speed;         ///< [m/s]
    Real slip;          ///< path until now [m]
    bool softening;
    Real wear; ///< of the bond, if it softens
    Real held; ///< strength without friction [Pa]
    Real friction;
    BondBending bending;
  };

  /// All laws; operator() has a shorter way for dry joints with constant friction.
  KOKKOS_FUNCTION JointResponse general(const JointFit& fit, Real closure, const Vec3& increment,
                                        Real dt, JointState& state, Real shrunk,
                                        const BondBending* bending) const
  {
    JointResponse response;
    const bool wasBonded = state.bonded;
    SlipStart s;
    s.closure = closure + bond.permanentOpening(state);
    s.opened = close(fit, s.closure, state, response);
    if (bond.resistsBending)
      s.bending = bending ? *bending : BondBending::even(closure);
    if (wasBonded && bond.resistsBending)
      bond.bend(fit.normalStiffness, s.bending, state, response);
    else if (wasBonded && response.normalTraction <= 0)
    {
      const Real open = bond.permanentOpening(state);
      pull(fit, s.opened, state, response);
      s.opened -= bond.permanentOpening(state) - open;
    }
    if (state.bonded && bond.softens() && bond.share(state) < Bond::brokenAt)
      breakBond(fit, s.bending, state, response);
    if (response.normalTraction <= 0 && !state.bonded)
    {
      (wasBonded ? response.fractureWork : response.frictionWork) += release(fit, increment, state);
      return response;
    }

    s.softening = state.bonded && bond.softens();
    s.wear = s.softening ? bond.wear(state) : 0;
    s.pressed = response.normalTraction > 0 ? response.normalTraction : 0;
    s.speed = dt > 0 ? 2 / (1 + shrunk) * norm(increment) / dt : 0;
    s.slip = state.slip;
    s.friction = s.pressed > 0 ? frictionAt(s.pressed, s.slip, s.speed) : 0;
    s.held = s.softening ? bond.cohesion * bond.share(s.wear) : cohesion;
    s.before = state.shearTraction;
    s.trial = s.before - fit.shearStiffness * increment;
    s.size = norm(s.trial);
    if (!(s.size > s.held + s.friction * s.pressed))
    {
      state.shearTraction = s.trial;
      crushInShear(fit, s, state, response);
      return response;
    }
    if (state.bonded && bond.kind == Bond::Kind::Brittle)
    {
      breakBond(fit, s.bending, state, response);
      if (s.pressed <= 0)
      {
        response.fractureWork += release(fit, increment, state);
        return response;
      }
    }
    s.raised = raised(fit, s.before, increment, s.size, shrunk);
    slide(fit, s, state, response);
    if (s.softening)
      wearBySlip(fit, s, state, response);
    crushInShear(fit, s, state, response);
    return response;
  }

  /// Shear crushes a joint, too: brings both tractions back to the ellipse of the strength, along
  /// its normal at the trial. What the falling compression takes from the strength of shear slips.
  KOKKOS_INLINE_FUNCTION void crushInShear(const JointFit& fit, const SlipStart& s,
                                           JointState& state, JointResponse& response) const
  {
    const Crushing& crushing = curve.crushing;
    const Real sigma = response.normalTraction, tau = norm(state.shearTraction);
    if (!(crushing.acts() && crushing.shearWeight > 0 && sigma > 0 && tau > 0))
      return;
    const Real kn = fit.normalStiffness, ks = fit.shearStiffness, weight = crushing.shearWeight;
    const Real before = crushing.crushedAt(state.maximumClosure, kn);
    const Real weak = crushing.strengthAt(before);
    const Real size = std::sqrt(sigma * sigma + weight * weight * (tau * tau));
    const Real elastic = sigma / crushing.unloading(before, kn);
    const Real closing = (1 - crushing.loss) * (sigma / size), sliding = weight * tau / size;
    const bool wears = state.bonded && bond.softens();
    const Real held = wears ? bond.cohesion * bond.share(state) : s.held;
    const auto normalAt = [&](Real x)
    { return crushing.unloading(before + x, kn) * std::fmax(elastic - closing * x, 0.0); };
    const auto shearAt = [&](Real x, Real normal)
    { return std::fmin(std::fmax(tau - ks * sliding * x, 0.0), held + s.friction * normal); };
    const auto beyond = [&](Real x)
    {
      const Real normal = normalAt(x), shear = shearAt(x, normal);
      return std::sqrt(normal * normal + weight * (shear * shear)) -
             crushing.strengthAt(before + x);
    };
    Real atLow = beyond(0);
    if (!(atLow > 1e-12 * weak))
      return;

    // False position that halves the value of an end that stays (Illinois).
    Real low = 0, high = atLow / kn, atHigh = beyond(high), x = high;
    for (int i = 0; i < 200 && atHigh > 0; ++i)
    {
      low = high;
      atLow = atHigh;
      high *= 2;
      x = high;
      atHigh = beyond(high);
    }
    for (int i = 0, stays = 0; i < 100 && high > low; ++i)
    {
      x = low + (high - low) * (atLow / (atLow - atHigh));
      const Real at = beyond(x);
      if (std::fabs(at) <= 1e-14 * weak)
        break;
      const int side = at > 0 ? 1 : -1;
      (at > 0 ? low : high) = x;
      (at > 0 ? atLow : atHigh) = at;
      if (side == stays)
        (at > 0 ? atHigh : atLow) *= 0.5;
      stays = side;
    }

    const Real crushed = before + x, strong = crushing.strengthAt(crushed);
    const Real normal = normalAt(x), shear = shearAt(x, normal);
    response.crushed += closing * x;
    response.softened += crushing.softened(before, crushed, kn);
    // Work of all slip of the step, less what of it is booked.
    const Real carried = dot(s.before, s.trial) / s.size;
    const Real more = (carried + shear) * (s.size - shear) - (carried + tau) * (s.size - tau);
    if (ks > 0)
    {
      const Real slipped = (tau - shear) / ks;
      state.slip += slipped;
      if (wears)
        state.shearing += std::fmax(slipped - sliding * x, 0.0);
      response.frictionWork = std::fmax(response.frictionWork + 0.5 * more / ks, 0.0);
    }
    state.shearTraction = (shear / tau) * state.shearTraction;
    state.maximumClosure = crushed + strong / kn;
    response.normalTraction = normal;
    response.normalStiffness = crushing.unloading(crushed, kn);
    response.crushedByShear = true;
    response.dilation += (1 - crushing.loss) * x - closing * x; // what is crushed and not closed
    response.slipping = true;
  }

  /// Slip with dilation and softening; its work.
  KOKKOS_INLINE_FUNCTION void slide(const JointFit& fit, const SlipStart& s, JointState& state,
                                    JointResponse& response) const
  {
    // Slip x: size - k_s x = held + mu (pressed + k_n x tan(psi)).
    const Real size = s.size - s.raised, excess = size - s.held - s.friction * s.pressed;
    Real tangent = 0;
    if (s.pressed > 0 && s.slip < dilationSlip)
      tangent = strength == Strength::BartonBandis ? rough.dilation(s.pressed, s.slip) : dilation;
    const Real slope = fit.shearStiffness + s.friction * response.normalStiffness * tangent;
    Real x = 0;
    if (slope > 0 && excess > 0)
      x = s.softening ? bond.inelasticJump(size, slope, s.friction * s.pressed, bond.cohesion,
                                           bond.shearingLength, s.wear)
                      : excess / slope;
    Real sigma = s.pressed, mu = s.friction, held = s.held;
    if (tangent > 0 && x > 0)
    {
      const Real room = dilationSlip - s.slip;
      if (strength == Strength::BartonBandis || !curve.straight())
        x = slipOnCurve(fit, s, tangent, room, x, state);
      response.lift = tangent * (x < room ? x : room);
      close(fit, s.closure + response.lift, state, response);
      sigma = response.normalTraction;
      mu = frictionAt(sigma, s.slip, s.speed);
      response.dilation += response.lift;
    }
    if (s.softening)
    {
      state.shearing += x;
      held = bond.cohesion * bond.share(state);
    }
    const Real most = std::fmin(held + mu * sigma, s.size);
    const Real work = slip(fit, s.before, s.trial, s.size, most, s.raised, state, response);
    // Raising the offset stores energy, which the slip pays for.
    const Real paid = std::fmax(work - 0.5 * (s.pressed + sigma) * response.lift, 0.0);
    response.liftWork = work - paid;
    const Real fracture = s.softening && most > 0 ? paid * (held / most) : 0;
    response.fractureWork += fracture;
    response.frictionWork = paid - fracture;
  }

  /// Slip when the strength is no straight function of it: false position between 0 and x [m].
  /// @param tangent of the dilation angle; room: slip path over which it acts [m]
  KOKKOS_INLINE_FUNCTION Real slipOnCurve(const JointFit& fit, const SlipStart& s, Real tangent,
                                          Real room, Real x, const JointState& state) const
  {
    const Real size = s.size - s.raised, start = size - s.held - s.friction * s.pressed;
    for (int i = 0; i < 4; ++i)
    {
      const Real at = pressedAt(fit, s.closure + tangent * (x < room ? x : room), state);
      const Real left =
          s.softening ? bond.cohesion * bond.share(s.wear + x / bond.shearingLength) : s.held;
      const Real residual =
          size - fit.shearStiffness * x - left - at * frictionAt(at, s.slip, s.speed);
      if (residual < start)
        x *= start / (start - residual);
    }
    return x;
  }

  /// What slip does to the tension of a bond that softens: its secant is lower, and it may break.
  KOKKOS_INLINE_FUNCTION void wearBySlip(const JointFit& fit, const SlipStart& s, JointState& state,
                                         JointResponse& response) const
  {
    if (bond.resistsBending)
      bond.weakenBent(fit.normalStiffness, s.bending,
                      bond.tensionStiffness(fit.normalStiffness, state), response);
    else if (response.normalTraction < 0 && bond.loss > 0)
    {
      const Real secant = bond.tensionStiffness(fit.normalStiffness, state);
      const Real tension = -secant * s.opened;
      response.fractureWork += 0.5 * (tension - response.normalTraction) * s.opened;
      response.normalTraction = tension;
      response.normalStiffness = secant;
    }
    if (bond.share(state) < Bond::brokenAt)
    {
      breakBond(fit, s.bending, state, response);
      if (s.pressed <= 0)
        response.fractureWork += release(fit, {}, state);
    }
  }
};

static_assert(std::is_trivially_copyable_v<JointLaw>, "a table of laws lies in a view");
} // namespace coplane
