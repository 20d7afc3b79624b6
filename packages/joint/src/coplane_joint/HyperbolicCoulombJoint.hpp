#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>

#include <cmath>

namespace coplane
{
/// Joint with a load-unload closure curve of one history variable, and Coulomb friction (Vorobiev
/// 2006: "the load-unload curve included one history-dependent parameter, the maximum joint
/// closure, to describe tangent unloading").
///
/// Closure c > 0 when the joint closes [m]; normal traction sigma > 0 in compression [Pa]; shear
/// traction acts on the face with the higher id and opposes its slip. Loading (c at its maximum):
/// hyperbola sigma = k c / (1 - c / c_m) (Goodman, Bandis), continued with slope `stiffnessCap`
/// where it would get steeper. Unloading and reloading: along the tangent at the largest closure,
/// down to zero. inverseMaximumClosure = 0 is the linear joint, for which loading and unloading
/// coincide.
struct HyperbolicCoulombJoint
{
  Real initialStiffness = 0;      ///< slope at zero closure [Pa/m]
  Real inverseMaximumClosure = 0; ///< 1 / c_m [1/m]
  Real stiffnessCap = infinity;   ///< largest slope [Pa/m]
  Real shearStiffness = 0;        ///< [Pa/m]
  Real friction = 0;              ///< [-]
  Real cohesion = 0;              ///< [Pa]

  struct State
  {
    Real maximumClosure = 0; ///< largest closure so far [m]
    Vec3 shearTraction{};    ///< [Pa]
    Real slip = 0;           ///< length of the slip path [m]
  };

  struct Response
  {
    Real normalTraction = 0;  ///< [Pa]
    Real normalStiffness = 0; ///< slope of the branch in use [Pa/m]
    bool slipping = false;
    Real frictionWork = 0; ///< dissipated by slip in this step [J/m^2]
  };

  /// Closure at which the curve becomes straight: at once if the cap is below the initial slope.
  KOKKOS_INLINE_FUNCTION Real cappedFrom() const
  {
    if (inverseMaximumClosure <= 0 || !(stiffnessCap < infinity))
      return infinity;
    return std::fmax(0.0, 1 - std::sqrt(initialStiffness / stiffnessCap)) / inverseMaximumClosure;
  }

  KOKKOS_INLINE_FUNCTION Real hyperbola(Real c) const
  {
    return initialStiffness * c / (1 - c * inverseMaximumClosure);
  }

  /// Loading curve f(c), c >= 0 [Pa].
  KOKKOS_INLINE_FUNCTION Real loadingTraction(Real c) const
  {
    const Real limit = cappedFrom();
    return c <= limit ? hyperbola(c) : hyperbola(limit) + stiffnessCap * (c - limit);
  }

  /// f'(c) [Pa/m].
  KOKKOS_INLINE_FUNCTION Real loadingStiffness(Real c) const
  {
    if (c >= cappedFrom())
      return stiffnessCap;
    const Real q = 1 - c * inverseMaximumClosure;
    return initialStiffness / (q * q);
  }

  /// Work of loading to closure c [J/m^2].
  KOKKOS_INLINE_FUNCTION Real loadingWork(Real c) const
  {
    if (inverseMaximumClosure <= 0)
      return 0.5 * initialStiffness * c * c;
    const Real limit = cappedFrom();
    const Real curved = c < limit ? c : limit;
    const Real x = curved * inverseMaximumClosure;
    // -x - ln(1-x) cancels for small x: there a series is used instead.
    const Real bracket =
        x < 1e-2 ? x * x *
                       (0.5 + x * (1.0 / 3 +
                                   x * (0.25 + x * (0.2 + x * (1.0 / 6 + x * (1.0 / 7 + x / 8))))))
                 : -x - std::log1p(-x);
    Real work = initialStiffness * bracket / (inverseMaximumClosure * inverseMaximumClosure);
    if (c > limit)
      work += (hyperbola(limit) + 0.5 * stiffnessCap * (c - limit)) * (c - limit);
    return work;
  }

  /// Part of loadingWork(c) that unloading along the tangent does not give back [J/m^2].
  KOKKOS_INLINE_FUNCTION Real hysteresisWork(Real c) const
  {
    if (inverseMaximumClosure <= 0 || c <= 0)
      return 0;
    const Real sigma = loadingTraction(c);
    return loadingWork(c) - 0.5 * sigma * sigma / loadingStiffness(c);
  }

  /// Closure under a compressive traction on the loading curve [m].
  KOKKOS_INLINE_FUNCTION Real closureUnder(Real sigma) const
  {
    if (sigma <= 0)
      return 0;
    const Real c = sigma / (initialStiffness + sigma * inverseMaximumClosure);
    const Real limit = cappedFrom();
    return c <= limit ? c : limit + (sigma - hyperbola(limit)) / stiffnessCap;
  }

  /// Traction at closure c; raises the maximum closure.
  KOKKOS_INLINE_FUNCTION Response normal(Real c, State& state) const
  {
    Response response;
    if (c > state.maximumClosure)
      state.maximumClosure = c;
    const Real most = state.maximumClosure;
    response.normalStiffness = loadingStiffness(most);
    const Real sigma = loadingTraction(most) - response.normalStiffness * (most - c);
    response.normalTraction = sigma > 0 ? sigma : 0;
    return response;
  }

  /// One step: closure at its end, tangential displacement increment of the higher face relative to
  /// the lower one during it. The stored shear traction has been turned into the plane by the
  /// caller.
  KOKKOS_INLINE_FUNCTION Response operator()(Real c, const Vec3& tangentialIncrement,
                                             State& state) const
  {
    Response response = normal(c, state);
    if (response.normalTraction <= 0 && cohesion <= 0)
    {
      state.shearTraction = {};
      return response;
    }
    const Vec3 before = state.shearTraction;
    const Vec3 trial = before - shearStiffness * tangentialIncrement;
    const Real size = norm(trial);
    const Real strength = cohesion + friction * response.normalTraction;
    if (size > strength)
    {
      response.slipping = true;
      state.shearTraction = (strength / size) * trial;
      const Vec3 slip = (1 / shearStiffness) * (state.shearTraction - trial);
      state.slip += (size - strength) / shearStiffness;
      response.frictionWork = -0.5 * dot(before + state.shearTraction, slip);
    }
    else
      state.shearTraction = trial;
    return response;
  }
};
} // namespace coplane
