#pragma once

#include <coplane_material/Invariants.hpp>
#include <coplane_material/LinearElastic.hpp>
#include <coplane_material/Principal.hpp>

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
    if (fractureEnergy <= 0)
      return T(tensileStrength);
    return T(tensileStrength) *
           branchFree::exponential(T(-tensileStrength / fractureEnergy) * opening * size);
  }

  enum Surface : int
  {
    Face13, // s1 - s3
    Face12, // s1 - s2, beside Face13 where s2 = s3
    Face23, // s2 - s3, beside Face13 where s1 = s2
    Cut1,
    Cut2,
    Cut3
  };

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    using branchFree::choose;
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
        T(1e-11) * (curve.unit + branchFree::absolute(s[0]) + branchFree::absolute(s[2]));
    const T cutStrength = curve.strengthAt(cut);
    const T cutDilation = dilationAt(curve, cutStrength / curve.unit);
    T slips(0.0), openings(0.0), flow[3] = {zero, zero, zero};
    auto open = yields;
    // From the fewest surfaces to the most; the corner of pure tension is the last resort.
    constexpr int sets[10][3] = {
        {Face13, -1, -1},     {Cut1, -1, -1},    {Face13, Face23, -1},   {Face13, Face12, -1},
        {Face13, Cut1, -1},   {Cut1, Cut2, -1},  {Face13, Face12, Cut1}, {Face13, Face23, Cut1},
        {Face13, Cut1, Cut2}, {Cut1, Cut2, Cut3}};
    for (int k = 0; k < 10 && branchFree::anyOf(open); ++k)
    {
      int count = 0;
      bool slides = false, cuts = false;
      for (; count < 3 && sets[k][count] >= 0; ++count)
        (sets[k][count] >= Cut1 ? cuts : slides) = true;
      T multiplier[3] = {zero, zero, zero}, result[3];
      T slope = cutDilation;
      if (cuts) // s1 is known, and with it the strength: linear equations
        solve(sets[k], count, trial, slope, cutStrength, cut, multiplier);
      else
        slope = slide(sets[k][1], trial, curve, tolerance, open, multiplier);
      for (int i = 0; i < 3; ++i)
        result[i] = trial[i];
      T setFlow[3] = {zero, zero, zero};
      for (int i = 0; i < count; ++i)
      {
        T g[3], dg[3];
        flowOf(sets[k][i], slope, g, dg);
        for (int j = 0; j < 3; ++j)
        {
          result[j] -= dg[j] * multiplier[i];
          setFlow[j] += g[j] * multiplier[i];
        }
      }
      auto good = open && result[0] - result[1] > -tolerance && result[1] - result[2] > -tolerance;
      if (!slides)
        good = good && result[0] - result[2] - cutStrength < tolerance;
      if (!cuts)
        good = good && result[0] - cut < tolerance;
      for (int i = 0; i < count; ++i)
        good = good && multiplier[i] >= zero;
      if (k == 9)
        good = open;
      for (int i = 0; i < 3; ++i)
      {
        s[i] = choose(good, result[i], s[i]);
        flow[i] = choose(good, setFlow[i], flow[i]);
      }
      for (int i = 0; i < count; ++i)
      {
        const bool opens = sets[k][i] >= Cut1;
        slips += choose(good, opens ? zero : (T(1.0) + slope) * multiplier[i], zero);
        openings += choose(good, opens ? multiplier[i] : zero, zero);
      }
      open = open && !good;
    }
    point.bendingScale =
        scaleOf(bending, choose(q > zero, vonMisesOf(s) / q, T(1.0)), s, curve, cut);
    const SymTensorOf<T> returned = tensorOf(principal);
    point.stress = {
        choose(yields, returned.xx, point.stress.xx), choose(yields, returned.yy, point.stress.yy),
        choose(yields, returned.zz, point.stress.zz), choose(yields, returned.xy, point.stress.xy),
        choose(yields, returned.yz, point.stress.yz), choose(yields, returned.zx, point.stress.zx)};
    const T mean = T(1.0 / 3.0) * (flow[0] + flow[1] + flow[2]);
    T squares = zero;
    for (int i = 0; i < 3; ++i)
      squares += (flow[i] - mean) * (flow[i] - mean);
    // Not negative but for rounding where the strength is 0.
    point.dissipation += branchFree::positivePart(s[0] * flow[0] + s[1] * flow[1] + s[2] * flow[2]);
    h[0] += branchFree::squareRoot(T(2.0 / 3.0) * squares);
    h[1] += slips;
    h[2] += openings;
  }

private:
  /// a^b, with the bits of the scalar in every lane.
  template <class T>
  KOKKOS_INLINE_FUNCTION static T powerOf(const T& a, const T& b)
  {
    return branchFree::gathered<T>(
        [&](int i) { return std::pow(branchFree::lane(a, i), branchFree::lane(b, i)); });
  }
  template <class T>
  KOKKOS_INLINE_FUNCTION static T vonMisesOf(const T (&s)[3])
  {
    const T a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
    return branchFree::squareRoot(T(0.5) * (a * a + b * b + c * c));
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
    return branchFree::choose(kept * bending > most, most / bending, kept);
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
  /// Direction of plastic flow, and the stress that it takes away.
  template <class T>
  KOKKOS_INLINE_FUNCTION void flowOf(int surface, const T& slope, T (&g)[3], T (&dg)[3]) const
  {
    direction(surface, slope, g);
    const T lambda(elastic.bulkModulus - 2.0 / 3.0 * elastic.shearModulus);
    for (int i = 0; i < 3; ++i)
      dg[i] = lambda * (g[0] + g[1] + g[2]) + T(2 * elastic.shearModulus) * g[i];
  }
  template <class T>
  KOKKOS_INLINE_FUNCTION static void direction(int surface, const T& slope, T (&n)[3])
  {
    n[0] = n[1] = n[2] = T(0.0);
    if (surface >= Cut1)
      n[surface - Cut1] = T(1.0);
    else
    {
      n[surface == Face23 ? 1 : 0] = slope;
      n[surface == Face12 ? 1 : 2] = T(-1.0);
    }
  }

  /// Multipliers that bring the trial stress onto the face, or onto its edge with a second one.
  /// Seen from the mean of the stresses that an edge makes equal, an edge is a face. The unknown is
  /// r, the strength over its unit: the curve is smooth in it even at the tip. Stresses on the way
  /// back are s1 = T1 - A x, s3 = T3 - B x, and s1 - s3 = r unit; both sides of it rise and fall
  /// with r for good, whatever N_psi does, so there is one root.
  /// @param second Face23 (s1 = s2), Face12 (s2 = s3) or -1
  /// @return N_psi of the flow
  template <class T>
  KOKKOS_INLINE_FUNCTION T slide(int second, const T (&trial)[3], const Curve<T>& curve,
                                 const T& tolerance, branchFree::MaskOf<T> open,
                                 T (&multiplier)[3]) const
  {
    const T one(1.0), half(0.5), twoG(2 * elastic.shearModulus);
    const T lambda(elastic.bulkModulus - 2.0 / 3.0 * elastic.shearModulus);
    const bool upper = second == Face23, lower = second == Face12;
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
                                           T(1e-3) * tolerance, over);
    const T u = curve.roomAt(root), slope = dilationAt(curve, root, u);
    const T sum = branchFree::positivePart((t1 - curve.stressAt(u)) / away(slope));
    if (second < 0)
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

  /// Multipliers that bring the trial stress onto all surfaces of a set with the cut-off.
  template <class T>
  KOKKOS_INLINE_FUNCTION void solve(const int (&set)[3], int count, const T (&trial)[3],
                                    const T& slope, const T& strength, const T& cut,
                                    T (&multiplier)[3]) const
  {
    const T one(1.0), zero(0.0);
    Mat3Of<T> a{{{one, zero, zero}, {zero, one, zero}, {zero, zero, one}}};
    T over[3] = {T(0.0), T(0.0), T(0.0)};
    for (int i = 0; i < count; ++i)
    {
      T n[3]; // of the plane across the stresses, or of the cut-off
      direction<T>(set[i], one, n);
      over[i] =
          n[0] * trial[0] + n[1] * trial[1] + n[2] * trial[2] - (set[i] >= Cut1 ? cut : strength);
      for (int j = 0; j < count; ++j)
      {
        T g[3], dg[3];
        flowOf(set[j], slope, g, dg);
        a.a[i][j] = n[0] * dg[0] + n[1] * dg[1] + n[2] * dg[2];
      }
    }
    const Mat3Of<T> b = inverse(a);
    for (int i = 0; i < count; ++i)
      multiplier[i] = b.a[i][0] * over[0] + b.a[i][1] * over[1] + b.a[i][2] * over[2];
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
