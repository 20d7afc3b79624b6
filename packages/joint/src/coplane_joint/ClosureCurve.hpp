#pragma once

#include <coplane_joint/Crushing.hpp>
#include <coplane_joint/JointState.hpp>

#include <cmath>

namespace coplane
{
/// Normal traction over closure at first loading; closure c > 0 closes [m], traction sigma > 0 is
/// compression [Pa]. Unloading and reloading go along the tangent at the largest closure
/// (Vorobiev 2006: "the load-unload curve included one history-dependent parameter, the maximum
/// joint closure, to describe tangent unloading").
///
/// A straight line; or a hyperbola sigma = k c / (1 - c / c_m) (Goodman, Bandis); or a table of
/// points from (0, 0) with rising slopes, which goes on straight beyond its last point. Where a
/// curve would get steeper than the cap, it goes on with the slope of the cap. Or a straight line
/// up to a strength that falls: then the slope of unloading is the elastic one, or a secant.
struct ClosureCurve
{
  static constexpr int capacity = 16;

  Real inverseMaximumClosure = 0; ///< 1 / c_m of the hyperbola [1/m]; 0: straight line
  int points = 0;                 ///< of the table without (0, 0); 0: no table
  Real closure[capacity] = {};    ///< [m]
  Real traction[capacity] = {};   ///< [Pa]
  Crushing crushing;

  KOKKOS_INLINE_FUNCTION bool straight() const { return !stiffens() && !crushing.acts(); }
  /// Whether it gets steeper as it closes.
  KOKKOS_INLINE_FUNCTION bool stiffens() const { return inverseMaximumClosure > 0 || points > 0; }

  /// Closure at which the hyperbola becomes straight: at once if the cap is below the initial
  /// slope.
  KOKKOS_INLINE_FUNCTION Real cappedFrom(const JointFit& fit) const
  {
    if (inverseMaximumClosure <= 0 || !(fit.stiffnessCap < infinity))
      return infinity;
    return std::fmax(0.0, 1 - std::sqrt(fit.normalStiffness / fit.stiffnessCap)) /
           inverseMaximumClosure;
  }

  struct Point
  {
    Real traction = 0;  ///< [Pa]
    Real stiffness = 0; ///< of unloading [Pa/m]
  };

  /// Traction and slope at closure c >= 0.
  KOKKOS_INLINE_FUNCTION Point at(const JointFit& fit, Real c) const
  {
    if (crushing.acts())
    {
      const Real k = crushing.crushedAt(c, fit.normalStiffness);
      return {k > 0 ? crushing.strengthAt(k) : fit.normalStiffness * c,
              crushing.unloading(k, fit.normalStiffness)};
    }
    if (points > 0)
      return atTable(fit, c);
    const Real q = 1 - c * inverseMaximumClosure;
    if (inverseMaximumClosure <= 0 || !(fit.stiffnessCap < infinity) ||
        (q > 0 && fit.normalStiffness < fit.stiffnessCap * (q * q)))
      return {fit.normalStiffness * c / q, fit.normalStiffness / (q * q)};
    const Real limit = cappedFrom(fit);
    return {hyperbola(fit, limit) + fit.stiffnessCap * (c - limit), fit.stiffnessCap};
  }

  /// Work of loading to closure c [J/m^2].
  KOKKOS_INLINE_FUNCTION Real work(const JointFit& fit, Real c) const
  {
    if (points > 0)
      return tableWork(fit, c);
    if (crushing.acts())
    {
      const Real elastic = at(fit, c).traction;
      return crushing.workTo(crushing.crushedAt(c, fit.normalStiffness)) +
             0.5 * elastic * elastic / fit.normalStiffness;
    }
    if (inverseMaximumClosure <= 0)
      return 0.5 * fit.normalStiffness * c * c;
    const Real limit = cappedFrom(fit);
    const Real curved = c < limit ? c : limit;
    const Real x = curved * inverseMaximumClosure;
    // -x - ln(1-x) cancels for small x: there a series is used instead.
    const Real bracket =
        x < 1e-2 ? x * x *
                       (0.5 + x * (1.0 / 3 +
                                   x * (0.25 + x * (0.2 + x * (1.0 / 6 + x * (1.0 / 7 + x / 8))))))
                 : -x - std::log1p(-x);
    Real work = fit.normalStiffness * bracket / (inverseMaximumClosure * inverseMaximumClosure);
    if (c > limit)
      work += (hyperbola(fit, limit) + 0.5 * fit.stiffnessCap * (c - limit)) * (c - limit);
    return work;
  }

  /// Part of work(c) that unloading along the tangent does not give back [J/m^2].
  KOKKOS_INLINE_FUNCTION Real hysteresis(const JointFit& fit, Real c) const
  {
    if (straight() || c <= 0)
      return 0;
    const Point p = at(fit, c);
    return work(fit, c) - 0.5 * p.traction * p.traction / p.stiffness;
  }

  /// Closure under a compressive traction [m].
  KOKKOS_INLINE_FUNCTION Real closureUnder(const JointFit& fit, Real sigma) const
  {
    if (sigma <= 0)
      return 0;
    if (points > 0)
      return tableClosureUnder(fit, sigma);
    if (crushing.acts())
      return crushing.closureUnder(sigma, fit.normalStiffness);
    const Real c = sigma / (fit.normalStiffness + sigma * inverseMaximumClosure);
    const Real limit = cappedFrom(fit);
    return c <= limit ? c : limit + (sigma - hyperbola(fit, limit)) / fit.stiffnessCap;
  }

  /// Slope of segment i of the table as given; the one after the last point is the last one.
  KOKKOS_INLINE_FUNCTION Real tableSlope(int i) const
  {
    if (i == 0)
      return traction[0] / closure[0];
    const int j = i < points ? i : points - 1;
    return j == 0 ? tableSlope(0) : (traction[j] - traction[j - 1]) / (closure[j] - closure[j - 1]);
  }

  /// Largest slope that a small step from closure c meets: at a corner of the table the next one.
  KOKKOS_INLINE_FUNCTION Real slopeAhead(const JointFit& fit, Real c) const
  {
    if (crushing.acts())
      return fit.normalStiffness;
    if (points == 0)
      return at(fit, c).stiffness;
    const Real slope = tableSlope(segment(c) + 1);
    return slope < fit.stiffnessCap ? slope : fit.stiffnessCap;
  }

private:
  KOKKOS_INLINE_FUNCTION Real hyperbola(const JointFit& fit, Real c) const
  {
    return fit.normalStiffness * c / (1 - c * inverseMaximumClosure);
  }

  KOKKOS_INLINE_FUNCTION int segment(Real c) const
  {
    int i = 0;
    while (i < points && c >= closure[i])
      ++i;
    return i;
  }

  KOKKOS_INLINE_FUNCTION Real cappedSlope(const JointFit& fit, int i) const
  {
    const Real slope = tableSlope(i);
    return slope < fit.stiffnessCap ? slope : fit.stiffnessCap;
  }

  KOKKOS_INLINE_FUNCTION Point atTable(const JointFit& fit, Real c) const
  {
    const int last = segment(c);
    Real from = 0, sigma = 0;
    for (int i = 0; i < last; ++i)
    {
      sigma += cappedSlope(fit, i) * (closure[i] - from);
      from = closure[i];
    }
    const Real slope = cappedSlope(fit, last);
    return {sigma + slope * (c - from), slope};
  }

  KOKKOS_INLINE_FUNCTION Real tableWork(const JointFit& fit, Real c) const
  {
    const int last = segment(c);
    Real from = 0, sigma = 0, work = 0;
    for (int i = 0; i <= last; ++i)
    {
      const Real length = (i < last ? closure[i] : c) - from;
      const Real slope = cappedSlope(fit, i);
      work += (sigma + 0.5 * slope * length) * length;
      sigma += slope * length;
      from += length;
    }
    return work;
  }

  KOKKOS_INLINE_FUNCTION Real tableClosureUnder(const JointFit& fit, Real traction0) const
  {
    Real from = 0, sigma = 0;
    for (int i = 0; i < points; ++i)
    {
      const Real slope = cappedSlope(fit, i);
      const Real next = sigma + slope * (closure[i] - from);
      if (traction0 <= next)
        return from + (traction0 - sigma) / slope;
      sigma = next;
      from = closure[i];
    }
    return from + (traction0 - sigma) / cappedSlope(fit, points);
  }
};
} // namespace coplane
