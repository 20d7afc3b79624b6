#pragma once

#include <coplane_core/ElementaryFunctions.hpp>
#include <coplane_material/Invariants.hpp>
#include <coplane_material/PrincipalReturn.hpp>

#include <cmath>
#include <optional>

namespace coplane
{
/// The generalised criterion of Hoek and Brown for rock masses (Hoek, Carranza-Torres and Corkum
/// 2002) with a tension cut-off: s1 - s3 <= sigma_ci (s - m s1 / sigma_ci)^a and s1 <= ft, for
/// principal stresses s1 >= s2 >= s3, tension positive. Plastic flow with N_psi as in MohrCoulomb,
/// normal to the cut-off. Returns to the curved face, its two edges, the cut-off and their corners
/// solve for the stress on the surface itself. The constants fall from those of the peak to those
/// of the residual strength with the slip that is smeared over the element, such that the uniaxial
/// strength falls exponentially: an unconfined test dissipates the same energy per area in an
/// element of any size. Strengths are those at the start of the step.
/// docs/theory/materials.md has all formulas.
struct HoekBrown
{
  /// Of a rock mass [-].
  struct Constants
  {
    Real m; ///< m_b
    Real s;
    Real a;
    Real strength; ///< s^a, uniaxial strength over sigma_ci
  };

  LinearElastic elastic;
  Real intactStrength;  ///< sigma_ci, uniaxial, of pieces without joints [Pa]
  Constants peak;       ///< of the rock mass before it slips
  Constants residual;   ///< after much slip
  Real dilation;        ///< N_psi [-]; flow takes at most the slope of the criterion
  Real tensileStrength; ///< ft [Pa]; at most the tip of the criterion, s sigma_ci / m
  Real shearEnergy;     ///< G_II, by which the uniaxial strength falls [J/m^2]; 0: it stays
  Real fractureEnergy;  ///< G_I, by which ft falls [J/m^2]; 0: it does not fall

  static constexpr int historyCount = 3;
  static constexpr const char* historyNames[] = {"equivalent_plastic_strain", "plastic_shear",
                                                 "crack_opening"};
  static constexpr bool usesVolume = true, changesTangent = false, hasStrength = true;

  /// The cut-off stays this part before the tip, where the slope of the criterion is not finite.
  static constexpr Real beforeTip = 1e-10;

  /// sigma_ci s^a [Pa].
  Real uniaxialStrength(const Constants& c) const { return intactStrength * c.strength; }
  /// s1 = s2 = s3 on the criterion [Pa].
  Real tip(const Constants& c) const { return c.s * intactStrength / c.m; }

  /// The criterion after some slip; unit is sigma_ci.
  template <class T>
  struct Curve
  {
    T unit, m, s, a, inverse; ///< inverse: 1 / a

    /// The largest s1 - s3.
    KOKKOS_INLINE_FUNCTION T strengthAt(const T& s1) const
    {
      return unit * powerOf(branchFree::positivePart(s - m * (s1 / unit)), a);
    }
    /// u = s - m s1 / unit where the strength is r unit.
    KOKKOS_INLINE_FUNCTION T roomAt(const T& r) const { return powerOf(r, inverse); }
    /// s1 there.
    KOKKOS_INLINE_FUNCTION T stressAt(const T& u) const { return (s - u) / m * unit; }
    /// -d s3 / d s1 on the criterion, N of the plane that touches it; infinite at the tip.
    KOKKOS_INLINE_FUNCTION T slopeAt(const T& r, const T& u) const
    {
      return T(1.0) + a * m * (r / u);
    }
  };

  /// @param slip plastic shear [-]
  /// @param size of the element [m]
  template <class T>
  KOKKOS_INLINE_FUNCTION Curve<T> curveAfter(const T& slip, const T& size) const
  {
    Curve<T> c{T(intactStrength), T(peak.m), T(peak.s), T(peak.a), T(1 / peak.a)};
    if (shearEnergy <= 0)
      return c;
    const Real fall = peak.strength - residual.strength;
    const Real decay = fall * intactStrength / (shearEnergy * (1 + dilation));
    const T kept = branchFree::exponential(T(-decay) * slip * size);
    c.m = T(residual.m) + T(peak.m - residual.m) * kept;
    c.a = T(residual.a) + T(peak.a - residual.a) * kept;
    c.inverse = T(1.0) / c.a;
    c.s = powerOf(T(residual.strength) + T(fall) * kept, c.inverse);
    return c;
  }
  template <class T>
  KOKKOS_INLINE_FUNCTION T tensionAfter(const T& opening, const T& size) const
  {
    return principalReturn::tensionAfter(tensileStrength, fractureEnergy, opening, size);
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    using branchFree::choose;
    using principalReturn::Set;
    const T zero(0.0);
    T* const h = point.history;
    elastic.addElasticIncrement(point.strainIncrement, point.stress);
    Principal<T> principal = principalOf(point.stress);
    T(&s)[3] = principal.value;
    const Curve<T> curve = curveAfter(h[1], point.size);
    const T cut = branchFree::smaller(tensionAfter(h[2], point.size),
                                      T(1 - beforeTip) * curve.stressAt(zero));

    const auto yields = s[0] - s[2] - curve.strengthAt(s[0]) > zero || s[0] > cut;
    const T q = vonMisesOf(s), bending = branchFree::squareRoot(point.bendingSquared);
    if (!branchFree::anyOf(yields))
    {
      point.bendingScale = scaleOf(bending, T(1.0), s, curve, cut);
      return;
    }
    const T trial[3] = {s[0], s[1], s[2]};
    const T tolerance =
        T(toleranceShare) * (curve.unit + branchFree::absolute(s[0]) + branchFree::absolute(s[2]));
    const T cutStrength = curve.strengthAt(cut);
    const T cutDilation = dilationAt(curve, cutStrength / curve.unit);
    const auto multipliersOf = [&](const Set& set, const auto& open, T(&multiplier)[3])
    {
      if (!set.cuts())
        return slide(set, trial, curve, tolerance, open, multiplier);
      // s1 is known, and with it the strength: planes across the stresses, linear equations
      principalReturn::solve(elastic, set, trial, T(1.0), cutDilation, cutStrength, cut,
                             multiplier);
      return cutDilation;
    };
    const auto bears = [&](const Set& set, const T(&stress)[3])
    {
      branchFree::MaskOf<T> good(true);
      if (!set.slides())
        good = good && stress[0] - stress[2] - cutStrength < tolerance;
      if (!set.cuts())
        good = good && stress[0] - cut < tolerance;
      return good;
    };
    const auto flow =
        principalReturn::returnTo(elastic, s, yields, tolerance, multipliersOf, bears);
    point.bendingScale =
        scaleOf(bending, choose(q > zero, vonMisesOf(s) / q, T(1.0)), s, curve, cut);
    point.stress = chosen(yields, tensorOf(principal), point.stress);
    // Not negative but for rounding where the strength is 0.
    point.dissipation += branchFree::positivePart(s[0] * flow.strain[0] + s[1] * flow.strain[1] +
                                                  s[2] * flow.strain[2]);
    h[0] += flow.equivalent();
    h[1] += flow.slip;
    h[2] += flow.opening;
  }

private:
  /// Of stresses over sigma_ci and their own size.
  static constexpr Real toleranceShare = 1e-11;
  /// Of the tolerance of stresses, for the strength on the curve.
  static constexpr Real rootShare = 1e-3;

  /// a^b, with the bits of the scalar in every lane.
  template <class T>
  KOKKOS_INLINE_FUNCTION static T powerOf(const T& a, const T& b)
  {
    return branchFree::gathered<T>(
        [&](int i) { return std::pow(branchFree::lane(a, i), branchFree::lane(b, i)); });
  }
  /// Bending falls by the factor of the return, and ends where fibres beside the mean stress shear
  /// in compression or reach the cut-off. It flows by itself: faces and edges know no other
  /// component.
  template <class T>
  KOKKOS_INLINE_FUNCTION static T scaleOf(const T& bending, const T& factor, const T (&s)[3],
                                          const Curve<T>& curve, const T& cut)
  {
    const T kept = branchFree::smaller(factor, T(1.0));
    if (!branchFree::anyOf(kept * bending > T(0.0)))
      return kept;
    // q = r unit in triaxial compression at the mean stress: s1 = mean + q/3 is on the curve where
    // r^(1/a) + (m/3) r = room. The root for a = 1/2, and Newton's steps, which end above the root.
    const T mean = T(1.0 / 3.0) * (s[0] + s[1] + s[2]);
    const T room = branchFree::positivePart(curve.s - curve.m * (mean / curve.unit));
    const T third = T(1.0 / 3.0) * curve.m, half = T(0.5) * third;
    T r = room / (half + branchFree::squareRoot(half * half + room));
    for (int i = 0; i < 3; ++i)
    {
      const T u = curve.roomAt(r);
      const T next = r - (u + third * r - room) / (curve.inverse * (u / r) + third);
      r = branchFree::choose(r > T(0.0), branchFree::positivePart(next), r);
    }
    const T most = branchFree::positivePart(branchFree::smaller(r * curve.unit, cut - mean));
    return principalReturn::bendingKept(kept, bending, most);
  }
  /// N_psi of the flow where the strength is r unit: work at the stress on a convex surface that
  /// has the origin inside is never negative when the flow dilates no more than its normal.
  template <class T>
  KOKKOS_INLINE_FUNCTION T dilationAt(const Curve<T>& curve, const T& r, const T& u) const
  {
    return branchFree::smaller(curve.slopeAt(r, u), T(dilation));
  }
  template <class T>
  KOKKOS_INLINE_FUNCTION T dilationAt(const Curve<T>& curve, const T& r) const
  {
    return dilationAt(curve, r, curve.roomAt(r));
  }
  /// Multipliers that bring the trial stress onto the face, or onto its edge with a second one.
  /// Seen from the mean of the stresses that an edge makes equal, an edge is a face. The unknown is
  /// r, the strength over its unit: the curve is smooth in it even at the tip. Stresses on the way
  /// back are s1 = T1 - A x, s3 = T3 - B x, and s1 - s3 = r unit; both sides of it rise and fall
  /// with r for good, whatever N_psi does, so there is one root.
  /// @param set Face13, alone or beside Face23 (s1 = s2) or Face12 (s2 = s3)
  /// @return N_psi of the flow
  template <class T>
  KOKKOS_INLINE_FUNCTION T slide(const principalReturn::Set& set, const T (&trial)[3],
                                 const Curve<T>& curve, const T& tolerance,
                                 branchFree::MaskOf<T> open, T (&multiplier)[3]) const
  {
    const T one(1.0), half(0.5), twoG(2 * elastic.shearModulus);
    const T lambda(elastic.bulkModulus - 2.0 / 3.0 * elastic.shearModulus);
    const bool upper = set.surface[set.count - 1] == principalReturn::Face23;
    const bool lower = set.surface[set.count - 1] == principalReturn::Face12;
    const T t1 = upper ? half * (trial[0] + trial[1]) : trial[0];
    const T t3 = lower ? half * (trial[1] + trial[2]) : trial[2];
    const T w1(upper ? 0.5 : 1.0), w3(lower ? 0.5 : 1.0);
    const auto away = [&](const T& slope) // A
    { return lambda * (slope - one) + twoG * w1 * slope; };
    const auto excess = [&](const T& r)
    {
      const T u = curve.roomAt(r);
      const T slope = dilationAt(curve, r, u);
      // 1 - B / A: by which s1 - s3 falls as s1 falls
      const T share = twoG * (w1 * slope + w3) / away(slope);
      return t1 - t3 - r * curve.unit - (t1 - curve.stressAt(u)) * share;
    };
    const T least = curve.strengthAt(t1) / curve.unit, most = (t1 - t3) / curve.unit;
    const auto over = open && most > least;
    const T root = branchFree::fallingRoot(excess, least, most, excess(least), excess(most),
                                           T(rootShare) * tolerance, over);
    const T u = curve.roomAt(root), slope = dilationAt(curve, root, u);
    const T sum = branchFree::positivePart((t1 - curve.stressAt(u)) / away(slope));
    if (set.count == 1)
    {
      multiplier[0] = sum;
      return slope;
    }
    const T difference =
        upper ? (trial[0] - trial[1]) / (twoG * slope) : (trial[1] - trial[2]) / twoG;
    multiplier[0] = half * (sum + difference);
    multiplier[1] = half * (sum - difference);
    return slope;
  }
};

/// m_b, s and a of a rock mass.
/// @param intactConstant m_i of pieces without joints [-]
/// @param gsi geological strength index [-], above 0 up to 100
/// @param disturbance D [-], 0 to 1
HoekBrown::Constants hoekBrownConstants(Real intactConstant, Real gsi, Real disturbance);

/// What a user says of a rock mass.
struct HoekBrownParameters : ElasticParameters ///< of the rock mass
{
  Real intactStrength = 0;             ///< sigma_ci [Pa]
  Real intactConstant = 0;             ///< m_i [-]
  Real gsi = 0;                        ///< geological strength index [-]
  Real disturbance = 0;                ///< D: 0 as found, 1 blasted [-]
  Real dilation = 0;                   ///< tan(psi) [-]
  std::optional<Real> tensileStrength; ///< [Pa]; without: the tip of the criterion
  std::optional<Real> residualGsi;     ///< [-]; without: gsi, no softening
  Real shearEnergy = 0;                ///< G_II, with a residual GSI below the first [J/m^2]
  Real fractureEnergy = 0;             ///< G_I [J/m^2]; 0: the cut-off does not fall

  static MaterialModel model();
};
/// Throws Error(ExitCode::Deck) with what is wrong.
HoekBrown makeLaw(const HoekBrownParameters& parameters);
} // namespace coplane
