#pragma once

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
/// shear traction acts on the face with the higher id and opposes its slip.
struct JointLaw
{
  /// Penalty contact takes its normal stiffness from the elements behind the faces: fraction /
  /// (h0/M0 + h1/M1), which is `fraction` times the stiffness of the two elements in series.
  bool penalty = true;
  Real stiffnessFraction = 0.5; ///< [-]
  Real initialStiffness = 0;    ///< [Pa/m], unless penalty or a table
  ClosureCurve curve;
  Real stiffnessCap = 0;    ///< of curves [Pa/m]; 0: 0.5 M/h of the softer element
  Real shearStiffness = -1; ///< [Pa/m]; negative: shearRatio times the initial stiffness
  Real shearRatio = 0.5;    ///< [-]
  Real friction = 0;        ///< [-]
  Real cohesion = 0;        ///< shear strength without normal traction of a closed joint [Pa]

  /// h: thickness of the elements behind the faces at birth [m]; M: their undamaged P-wave modulus
  /// [Pa].
  JointFit fittedTo(Real h0, Real M0, Real h1, Real M1) const
  {
    JointFit fit;
    fit.normalStiffness = penalty            ? stiffnessFraction / (h0 / M0 + h1 / M1)
                          : curve.points > 0 ? curve.tableSlope(0)
                                             : initialStiffness;
    if (!curve.straight())
    {
      const Real soft = M0 / h0 < M1 / h1 ? M0 / h0 : M1 / h1;
      const Real cap = stiffnessCap > 0 ? stiffnessCap : 0.5 * soft;
      fit.stiffnessCap = cap > fit.normalStiffness ? cap : fit.normalStiffness;
    }
    fit.shearStiffness = shearStiffness >= 0 ? shearStiffness : shearRatio * fit.normalStiffness;
    return fit;
  }

  /// Whether a declared joint with this law starts bonded.
  KOKKOS_INLINE_FUNCTION bool cohesive() const { return false; }

  /// One step: closure at its end, tangential displacement increment of the higher face relative to
  /// the lower one during it [m], its length [s]. The stored shear traction has been turned into
  /// the plane by the caller.
  KOKKOS_INLINE_FUNCTION JointResponse operator()(const JointFit& fit, Real closure,
                                                  const Vec3& tangentialIncrement, Real /*dt*/,
                                                  JointState& state) const
  {
    JointResponse response = close(fit, closure, state);
    if (response.normalTraction > 0)
      shear(fit, tangentialIncrement, cohesion + friction * response.normalTraction, state,
            response);
    else
      release(fit, tangentialIncrement, state, response);
    return response;
  }

  /// Recoverable energy of the normal and the shear traction [J/m^2].
  KOKKOS_INLINE_FUNCTION Real stored(const JointFit& fit, Real closure,
                                     const JointState& state) const
  {
    Real energy = 0;
    const ClosureCurve::Point top = curve.at(fit, state.maximumClosure);
    const Real sigma = top.traction - top.stiffness * (state.maximumClosure - closure);
    if (sigma > 0)
      energy = 0.5 * sigma * sigma / top.stiffness;
    if (fit.shearStiffness > 0)
      energy += 0.5 * dot(state.shearTraction, state.shearTraction) / fit.shearStiffness;
    return energy;
  }

  /// Irrecoverable part of the work of first loading to a closure [J/m^2].
  KOKKOS_INLINE_FUNCTION Real hysteresis(const JointFit& fit, Real maximumClosure) const
  {
    return curve.hysteresis(fit, maximumClosure);
  }

  /// Closure under a compressive traction at first loading [m].
  KOKKOS_INLINE_FUNCTION Real closureUnder(const JointFit& fit, Real compression) const
  {
    return curve.closureUnder(fit, compression);
  }

  /// Largest slope that the next step can see, of the normal or the shear traction, for the stable
  /// step [Pa/m].
  KOKKOS_INLINE_FUNCTION Real stiffnessBound(const JointFit& fit, const JointState& state) const
  {
    return std::fmax(curve.slopeAhead(fit, state.maximumClosure), fit.shearStiffness);
  }

private:
  /// Compression at closure c; raises the maximum closure.
  KOKKOS_INLINE_FUNCTION JointResponse close(const JointFit& fit, Real c, JointState& state) const
  {
    JointResponse response;
    const Real before = state.maximumClosure;
    const bool loading = c > before;
    if (loading)
      state.maximumClosure = c;
    const ClosureCurve::Point top = curve.at(fit, state.maximumClosure);
    response.normalStiffness = top.stiffness;
    const Real sigma = top.traction - top.stiffness * (state.maximumClosure - c);
    response.normalTraction = sigma > 0 ? sigma : 0;
    if (loading && !curve.straight())
      response.hysteresisWork = curve.hysteresis(fit, c) - curve.hysteresis(fit, before);
    return response;
  }

  /// Elastic shear up to the strength, slip beyond. Work of the mean traction of the step is stored
  /// or dissipated to round-off, whatever the strength does.
  KOKKOS_INLINE_FUNCTION void shear(const JointFit& fit, const Vec3& increment, Real strength,
                                    JointState& state, JointResponse& response) const
  {
    const Vec3 before = state.shearTraction;
    const Vec3 trial = before - fit.shearStiffness * increment;
    const Real size = norm(trial);
    if (!(size > strength))
    {
      state.shearTraction = trial;
      return;
    }
    response.slipping = true;
    state.shearTraction = (strength / size) * trial;
    if (!(fit.shearStiffness > 0))
      return;
    const Vec3 slip = (1 / fit.shearStiffness) * (state.shearTraction - trial);
    state.slip += (size - strength) / fit.shearStiffness;
    const Real work = -0.5 * dot(before + state.shearTraction, slip);
    response.frictionWork = work > 0 ? work : 0;
  }

  /// The joint is open: its shear traction is gone, and what it had stored counts as friction.
  KOKKOS_INLINE_FUNCTION void release(const JointFit& fit, const Vec3& increment, JointState& state,
                                      JointResponse& response) const
  {
    if (fit.shearStiffness > 0)
    {
      const Vec3 before = state.shearTraction;
      const Real work = 0.5 * (dot(before, before) / fit.shearStiffness - dot(before, increment));
      response.frictionWork = work > 0 ? work : 0;
    }
    state.shearTraction = {};
  }
};

static_assert(std::is_trivially_copyable_v<JointLaw>, "a table of laws lies in a view");
} // namespace coplane
