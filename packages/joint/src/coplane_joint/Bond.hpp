#pragma once

#include <coplane_joint/JointState.hpp>

#include <cmath>
#include <cstdint>

namespace coplane
{
/// What holds a declared joint together until it breaks: mortar, glue, a healed crack.
///
/// Softening bonds (Lourenco and Rots 1997, isotropic softening): tensile strength f_t S(q) and
/// cohesion c S(q) fall together with q = opening / a_1 + shearing / a_2, the inelastic opening and
/// slip over their lengths. Exponential: S = exp(-q), a = G / strength. Linear: S = 1 - q, a = 2 G
/// / strength. Unloading in tension goes straight to where a part 1 - loss of the opening is left:
/// with loss = 0 along the elastic stiffness, with 1, as linear bonds do, towards zero (traction
/// (1 - D) k d); in shear with the elastic stiffness. G_I and G_II are the areas under the curves
/// of pure tension and of the cohesive part of pure shear. A brittle bond breaks at its tensile
/// strength, or when it slips.
struct Bond
{
  enum class Kind : std::uint8_t
  {
    None,
    Brittle,
    Exponential,
    Linear
  };

  /// A softening bond counts as broken when this share of its strength is left. The same share of
  /// the fracture energy is cut off exponential curves.
  static constexpr Real brokenAt = 1e-3;

  Kind kind = Kind::None;
  Real tensileStrength = 0; ///< f_t [Pa]
  Real cohesion = 0;        ///< c of a softening bond [Pa]
  Real openingLength = 1;   ///< a_1 [m]
  Real shearingLength = 1;  ///< a_2 [m]
  Real loss = 0;            ///< of stiffness in tension: 0 plastic, 1 damage only [-]
  bool resistsBending = false;

  /// Lengths from the fracture energies [J/m^2].
  static Bond softening(Kind kind, Real tensileStrength, Real cohesion, Real tensionEnergy,
                        Real shearEnergy)
  {
    Bond bond;
    bond.kind = kind;
    bond.tensileStrength = tensileStrength;
    bond.cohesion = cohesion;
    const Real factor = kind == Kind::Linear ? 2 : 1;
    bond.openingLength = factor * tensionEnergy / tensileStrength;
    bond.shearingLength = cohesion > 0 ? factor * shearEnergy / cohesion : infinity;
    bond.loss = kind == Kind::Linear ? 1 : 0;
    return bond;
  }

  KOKKOS_INLINE_FUNCTION bool softens() const
  {
    return kind == Kind::Exponential || kind == Kind::Linear;
  }

  KOKKOS_INLINE_FUNCTION Real wear(const JointState& state) const
  {
    return state.opening / openingLength + state.shearing / shearingLength;
  }

  /// S(q).
  KOKKOS_INLINE_FUNCTION Real share(Real q) const
  {
    if (kind == Kind::Exponential)
      return std::exp(-q);
    return q < 1 ? 1 - q : 0;
  }

  KOKKOS_INLINE_FUNCTION Real share(const JointState& state) const { return share(wear(state)); }

  /// Part of the closure that opened inelastically and is still between the faces [m].
  KOKKOS_INLINE_FUNCTION Real permanentOpening(const JointState& state) const
  {
    return state.bonded && kind == Kind::Exponential ? (1 - loss) * state.opening : 0;
  }

  /// Inelastic jump x that brings an elastic trial traction back to the strength, trial - k x =
  /// base + strength S(q + x / length); the trial is beyond it [m].
  KOKKOS_INLINE_FUNCTION Real inelasticJump(Real trial, Real k, Real base, Real strength,
                                            Real length, Real q) const
  {
    const Real whole = (trial - base) / k; // nothing of the strength is left
    if (kind == Kind::Linear)
    {
      const Real slope = k - strength / length;
      const Real x = slope > 0 ? (trial - base - strength * share(q)) / slope : whole;
      return q + x / length < 1 ? x : whole;
    }
    // The residual is concave and falls at its root: Newton's method from the right is monotone.
    Real x = whole;
    for (int i = 0; i < 50; ++i)
    {
      const Real left = strength * std::exp(-(q + x / length));
      const Real residual = trial - k * x - base - left;
      const Real step = residual / (k - left / length);
      x += step;
      if (!(-step > 1e-15 * whole))
        break;
    }
    return x > 0 ? x : 0;
  }

  /// Work of fracture while the bond opens from wear q by `jump` [J/m^2]; `opening`: before.
  KOKKOS_INLINE_FUNCTION Real openingWork(Real q, Real opening, Real jump) const
  {
    if (kind == Kind::Exponential)
    {
      const Real left = std::exp(-q), fall = -std::expm1(-jump / openingLength);
      // Less what the secant gives back more than the elastic stiffness.
      return tensileStrength * openingLength * left * fall -
             0.5 * loss * tensileStrength * left * ((1 - fall) * jump - fall * opening);
    }
    // Unloading towards zero: half of (traction times increment of opening - opening times
    // increment of traction).
    const Real most = 1 - q, wear = jump / openingLength;
    return 0.5 * tensileStrength * (openingLength * most + opening) * (wear < most ? wear : most);
  }

  /// Slope of the tension branch: a secant if stiffness is lost, else elastic [Pa/m].
  KOKKOS_INLINE_FUNCTION Real tensionStiffness(Real elastic, const JointState& state) const
  {
    if (!(loss > 0))
      return elastic;
    const Real strength = tensileStrength * share(state);
    return strength > 0 ? strength / (strength / elastic + loss * state.opening) : 0;
  }

  /// A bond that resists bending: what is open of it carries by its secant, which wears by the
  /// opening where that is largest. All openings grow together, so the work of fracture is that of
  /// even opening times the share of the open energy.
  KOKKOS_INLINE_FUNCTION void bend(Real k, const BondBending& bending, JointState& state,
                                   JointResponse& response) const
  {
    const Real most = bending.opened, strength = tensileStrength;
    const Real part = most > 0 ? bending.openSquares / (most * most) : 0;
    Real slope = k;
    if (kind == Bond::Kind::Brittle)
    {
      if (k * most > strength)
      {
        response.fractureWork += 0.5 * strength * strength / k * part;
        slope = 0;
        state.bonded = false;
      }
    }
    else
    {
      const Real q = wear(state), trial = k * (most - loss * state.opening);
      if (trial > strength * share(q))
      {
        const Real jump = inelasticJump(trial, k, 0, strength, openingLength, q);
        response.fractureWork += openingWork(q, state.opening, jump) * part;
        state.opening += jump;
      }
      slope = tensionStiffness(k, state);
    }
    carryBent(k, bending, slope, response);
  }

  /// Tractions of a bond that is bent, with a slope where it is open.
  KOKKOS_INLINE_FUNCTION void carryBent(Real k, const BondBending& bending, Real slope,
                                        JointResponse& response) const
  {
    response.bondStiffness = slope;
    response.normalTraction = k * bending.closedMean + slope * (bending.mean - bending.closedMean);
    response.normalStiffness = bending.mean > 0 ? k : slope;
  }

  /// What is open of it gives back what it has stored where its slope falls.
  KOKKOS_INLINE_FUNCTION void weakenBent(Real k, const BondBending& bending, Real slope,
                                         JointResponse& response) const
  {
    response.fractureWork += 0.5 * (response.bondStiffness - slope) * bending.openSquares;
    carryBent(k, bending, slope, response);
  }
};
} // namespace coplane
