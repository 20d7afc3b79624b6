#pragma once

#include <coplane_material/Invariants.hpp>
#include <coplane_material/MaterialPoint.hpp>

#include <string>
#include <utility>
#include <vector>

namespace coplane
{
/// Pressure of volume and internal energy. Energies are per reference volume, so that of a unit of
/// mass times the reference density. All forms are linear in the energy, which therefore is taken
/// at the end of the step (trapezoid) without iteration.
struct EquationOfState
{
  enum class Kind : int
  {
    None,          ///< rate form: dp = -K tr(de)
    Linear,        ///< p = K mu, mu = density / reference density - 1
    MieGrueneisen, ///< about the shock line Us = c0 + s up
    PAlpha,        ///< the same for the solid of a porous material (Herrmann 1969)
    IdealGas       ///< p = (gamma - 1) e; e at the start follows from the initial stress
  };
  Kind kind = Kind::None;
  Real stiffness = 0;  ///< K, or rho0 c0^2 of the solid [Pa]
  Real slope = 0;      ///< s [-]
  Real gamma = 0;      ///< Grueneisen's Gamma0, or the ratio of specific heats [-]
  Real distension = 1; ///< alpha0: density of the solid over that of the porous material [-]
  Real crushStart = 0; ///< p_e, from which pores close [Pa]
  Real crushEnd = 0;   ///< p_s, at which none is left [Pa]

  /// Rows of the history that a law keeps for its equation of state.
  enum
  {
    Offset, ///< pressure (ideal gas: energy) that belongs to the initial stress [Pa]
    Distension,
    rows
  };

  void startFrom(const SymTensor& stress, Real* history) const
  {
    const Real p = -meanOf(stress);
    history[Offset] = kind == Kind::IdealGas ? p / (gamma - 1) : p;
    history[Distension] = distension;
  }

  /// p = a + b e; c = -J da/dJ at constant energy.
  template <class T>
  struct Line
  {
    T a, b, c;
  };

  /// @param ratio volume over reference volume
  /// @param alpha distension now
  template <class T>
  KOKKOS_INLINE_FUNCTION Line<T> lineOf(const T& ratio, const T& alpha) const
  {
    const T one(1.0), two(2.0);
    if (kind == Kind::IdealGas)
    {
      const T b = T(gamma - 1) / ratio;
      return {T(0.0), b, T(0.0)};
    }
    const T density = alpha / (T(distension) * ratio); // of the solid, over its reference
    const T mu = density - one;
    if (kind != Kind::MieGrueneisen && kind != Kind::PAlpha)
      return {T(stiffness) * mu, T(0.0), T(stiffness) * density};
    const T room = branchFree::larger(one - T(slope - 1) * mu, T(0.1));
    const T numerator = mu * (one + T(1 - gamma / 2) * mu);
    const T inverse = one / (room * room);
    const T tangent = ((one + T(2 - gamma) * mu) + two * T(slope - 1) * numerator / room) * inverse;
    const auto compressed = mu > T(0.0);
    return {T(stiffness) * branchFree::choose(compressed, numerator * inverse, mu) / alpha,
            T(gamma * distension) / alpha,
            T(stiffness) * branchFree::choose(compressed, tangent, one) * density / alpha};
  }

  /// Pressure on the crush curve, alpha = 1 + (alpha0 - 1) ((p_s - p) / (p_s - p_e))^2.
  template <class T>
  KOKKOS_INLINE_FUNCTION T crushPressure(const T& alpha) const
  {
    return T(crushEnd) - T(crushEnd - crushStart) *
                             branchFree::squareRoot(branchFree::positivePart(alpha - T(1.0)) *
                                                    T(1 / (distension - 1)));
  }

  /// The pressure at the end of the step, with the energy that the step adds: half of it is done by
  /// the pressure itself.
  /// @param deviator of the stress at the end of the step [Pa]
  /// @param history the law's rows for the equation of state
  /// @param bulk out: -J dp/dJ without heat flow [Pa]
  template <class T>
  KOKKOS_INLINE_FUNCTION T advance(const MaterialPoint<T>& point, const SymTensorOf<T>& deviator,
                                   T* history, Real bulkModulus, T& bulk) const
  {
    const SymTensorOf<T>& de = point.strainIncrement;
    const T oldPressure = -meanOf(point.oldStress), dilatation = de.xx + de.yy + de.zz;
    if (kind == Kind::None)
    {
      bulk = T(bulkModulus);
      return oldPressure - bulk * dilatation;
    }
    const T half(0.5), one(1.0);
    const SymTensorOf<T> sum = sumOf(deviatorOf(point.oldStress), one, deviator);
    const T share = half * point.halfVolumeRatio * dilatation; // of the pressures in the energy
    const T start = kind == Kind::IdealGas ? history[Offset] : T(0.0);
    const T offset = kind == Kind::IdealGas ? T(0.0) : history[Offset];
    const T known = point.energy + start + half * point.halfVolumeRatio * contract(sum, de) -
                    share * oldPressure;
    const auto solve = [&](const Line<T>& line)
    { return (line.a + offset + line.b * known) / (one + line.b * share); };
    T alpha = history[Distension];
    Line<T> line = lineOf(point.volumeRatio, alpha);
    T p = solve(line);
    if (kind == Kind::PAlpha)
    {
      const T over = p - crushPressure(alpha);
      const auto crushes = over > T(0.0) && alpha > one;
      if (branchFree::anyOf(crushes))
      {
        const auto excess = [&](const T& closed) {
          return solve(lineOf(point.volumeRatio, alpha - closed)) - crushPressure(alpha - closed);
        };
        const T all = alpha - one;
        const T closed = branchFree::fallingRoot(excess, T(0.0) * alpha, all, over, excess(all),
                                                 T(1e-11 * crushEnd), crushes);
        alpha = branchFree::choose(crushes, alpha - closed, alpha);
        history[Distension] = alpha;
        line = lineOf(point.volumeRatio, alpha);
        p = solve(line);
      }
    }
    const T energy = known - share * p;
    // b ratio is constant for the gas, b itself for the others.
    const T ofEnergy = kind == Kind::IdealGas ? line.b * energy : T(0.0);
    bulk = line.c + ofEnergy + point.volumeRatio * line.b * p;
    return p;
  }
};

/// What a user says of an equation of state.
struct EosParameters
{
  EquationOfState::Kind eos = EquationOfState::Kind::None;
  Real soundSpeed = 0; ///< c0 of the solid [m/s]
  Real shockSlope = 0; ///< s [-]
  Real grueneisen = 0; ///< Gamma0 [-]
  Real distension = 1; ///< alpha0 [-]
  Real crushStart = 0; ///< p_e [Pa]
  Real crushEnd = 0;   ///< p_s [Pa]
};

/// Their words in decks.
const std::vector<std::pair<std::string, EquationOfState::Kind>>& eosWords();

/// Throws Error(ExitCode::Deck) with what is missing.
/// @param bulkModulus of the linear form of a solid [Pa]; 0: from density and sound speed
EquationOfState equationOfState(const EosParameters& parameters, Real density, Real bulkModulus);
} // namespace coplane
