#pragma once

#include <coplane_material/Invariants.hpp>
#include <coplane_material/LinearElastic.hpp>
#include <coplane_material/RateEffect.hpp>

namespace coplane
{
/// Concrete that crushes, yields and cracks: one porosity-like state decides its strength.
/// Compaction of pores raises the cap; dilatancy opens porosity, and takes cohesion and tensile
/// strength away. The cap only scales the shear strength and drives compaction: it is no associated
/// surface. The idea is that of Rubin, Vorobiev and Glenn (2000); the strength on the compression
/// meridian follows Malvar et al. (1997), that over the Lode angle Willam and Warnke (1975), the
/// softening Bazant and Oh's crack band (1983). docs/theory/materials.md has all formulas.
///
/// The pressure is a function of volume and porosity, so it has no drift; the deviator is
/// hypoelastic. Compression is positive in pressures and volume strains here.
struct PseudoCap
{
  LinearElastic elastic;      ///< of the intact, porous material: K0, G
  Real strength;              ///< fc, in uniaxial compression [Pa]
  Real tensileStrength;       ///< ft [Pa]
  Real fractureEnergy;        ///< G_F, per area of a crack [J/m^2]
  Real porosity;              ///< phi0 [-]
  Real grainModulus;          ///< Ks, bulk modulus without pores [Pa]
  Real grainSlope;            ///< s of the grains' shock speed over particle speed [-]
  Real crushPressure;         ///< pc0, at which pores start to close [Pa]
  Real crushHardening;        ///< Ph: by which pc grows as the pores fall to 1/e [Pa]
  Real capRatio;              ///< Rc: from Rc pc on, shear compacts [-]
  Real shearCompaction;       ///< mu_c: volume per plastic shear strain at pc [-]
  Real tensileDilation = 1.5; ///< opening per plastic shear strain under tension (mode I) [-]
  Real biaxialRatio = 1.15;   ///< biaxial over uniaxial compressive strength [-]
  Real damageExponent = 1.6;  ///< b1: dilation under pressure does less damage [-]
  RateEffect rates;           ///< by which fast strain raises the strengths

  enum
  {
    Damage,
    PlasticStrain,
    Porosity,
    Compaction,    // e_c
    Bulking,       // e_d
    Opening,       // e_t
    Precompression // of the stress-free reference volume [-]
  };
  static constexpr int historyCount = 7;
  static constexpr const char* historyNames[] = {"damage",        "equivalent_plastic_strain",
                                                 "porosity",      "compaction",
                                                 "bulking",       "crack_opening",
                                                 "precompression"};
  static constexpr bool usesVolume = true, changesTangent = true, hasStrength = true;

  /// Pores are full of grains from here on: 1 - ec/ecm = exp(-closedPores).
  static constexpr Real closedPores = 25;

  /// e_c when no pore is left.
  KOKKOS_INLINE_FUNCTION Real fullCompaction() const { return -std::log(1.0 - porosity); }

  /// p_s, of the grains compressed by the logarithmic volume strain ee.
  template <class T>
  KOKKOS_INLINE_FUNCTION T grainPressure(const T& ee) const
  {
    const T stretch = branchFree::exponential(ee), one(1.0);
    const T x = one - one / stretch; // compression over the compressed volume
    const T room = branchFree::larger(one - T(grainSlope) * x, T(0.1));
    return T(grainModulus) * branchFree::choose(ee > T(0.0), x / (room * room), stretch - one);
  }

  /// d p_s / d ee.
  template <class T>
  KOKKOS_INLINE_FUNCTION T grainTangent(const T& ee) const
  {
    const T stretch = branchFree::exponential(ee), one(1.0);
    const T x = one - one / stretch;
    const T room = branchFree::larger(one - T(grainSlope) * x, T(0.1));
    const T compressed = (one + T(grainSlope) * x) / (stretch * room * room * room);
    return T(grainModulus) * branchFree::choose(ee > T(0.0), compressed, stretch);
  }

  /// Porosity after the inelastic volume strain v = ec - ed - et (positive: compaction).
  template <class T>
  KOKKOS_INLINE_FUNCTION T porosityOf(const T& v) const
  {
    return T(1.0) - T(1.0 - porosity) * branchFree::exponential(v);
  }

  /// w, by which pores reduce the modulus of the grains.
  template <class T>
  KOKKOS_INLINE_FUNCTION T poreFactor(const T& phi) const
  {
    const Real intact = elastic.bulkModulus / grainModulus;
    const T closing = T(1.0) - phi * T((1.0 - intact) / porosity);
    const T opening =
        T(intact) * branchFree::larger(T(1.0) - (phi - T(porosity)) * T(1 / 0.3), T(0.05));
    return branchFree::choose(phi > T(porosity), opening, closing);
  }

  /// p at the total strain ebar = ln(density / reference density) and inelastic volume strain v.
  template <class T>
  KOKKOS_INLINE_FUNCTION T pressure(const T& ebar, const T& v) const
  {
    return poreFactor(porosityOf(v)) * grainPressure(ebar - v);
  }

  /// pc after the compaction ec.
  template <class T>
  KOKKOS_INLINE_FUNCTION T crushCurve(const T& ec) const
  {
    return T(crushPressure) -
           T(crushHardening) * branchFree::logarithm(T(1.0) - ec * T(1.0 / fullCompaction()));
  }

  /// Yh: fracture surface of the intact material over p >= 0 (compression meridian).
  template <class T>
  KOKKOS_INLINE_FUNCTION T intactStrength(const T& p) const
  {
    return T(0.2956 * strength) + p / (T(0.4463) + T(0.0808 / strength) * p);
  }

  /// Ys: strength on the compression meridian, without the cap.
  template <class T>
  KOKKOS_INLINE_FUNCTION T meridian(const T& p, const T& damage) const
  {
    const T one(1.0), compression = branchFree::positivePart(p);
    const T intact = one - damage;
    const T tension =
        T(strength / (strength / 3 + tensileStrength)) * (p + intact * T(tensileStrength));
    const T residual = compression / (T(0.4417) + T(0.1183 / strength) * compression);
    const T sheared = intact * intactStrength(compression) + damage * residual;
    const T both = branchFree::choose(p > T(0.0), branchFree::smaller(tension, sheared), tension);
    return branchFree::positivePart(both);
  }

  /// psi: strength on the meridian of triaxial tension over that of compression.
  template <class T>
  KOKKOS_INLINE_FUNCTION T meridianRatio(const T& p) const
  {
    const Real knee = strength / 3, biaxial = 2 * biaxialRatio * strength / 3;
    const Real first = 0.5 + 1.5 * tensileStrength / strength;
    const Real second = biaxialRatio * strength / intactStrength(biaxial);
    const Real far = 3 * strength, round = 8.45 * strength;
    const auto line = [&](Real p0, Real v0, Real p1, Real v1)
    { return T(v0) + (p - T(p0)) * T((v1 - v0) / (p1 - p0)); };
    T psi = branchFree::choose(p < T(round), line(far, 0.753, round, 1.0), T(1.0));
    psi = branchFree::choose(p < T(far), line(biaxial, second, far, 0.753), psi);
    psi = branchFree::choose(p < T(biaxial), line(knee, first, biaxial, second), psi);
    return branchFree::choose(p < T(knee), T(first), psi);
  }

  /// r(theta) of Willam and Warnke; c = cos(theta).
  template <class T>
  KOKKOS_INLINE_FUNCTION static T lodeFactor(const T& c, const T& psi)
  {
    const T one(1.0), two(2.0), four(4.0);
    const T a = four * (one - psi * psi) * c * c;
    const T root = branchFree::squareRoot(a + T(5.0) * psi * psi - four * psi);
    return (two * (one - psi * psi) * c + (two * psi - one) * root) /
           (a + (one - two * psi) * (one - two * psi));
  }

  /// Y: von Mises stress that the material bears.
  template <class T>
  KOKKOS_INLINE_FUNCTION T shearStrength(const T& p, const T& pc, const T& damage,
                                         const T& cosTheta) const
  {
    const T one(1.0), start = T(capRatio) * pc;
    const T reach = (p - start) / (pc - start);
    const T cap = branchFree::squareRoot(branchFree::positivePart(one - reach * reach));
    return lodeFactor(cosTheta, meridianRatio(p)) * meridian(p, damage) *
           branchFree::choose(p > start, branchFree::choose(p < pc, cap, T(0.0)), one);
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    using branchFree::choose;
    const T zero(0.0), one(1.0);
    T* const h = point.history;
    const T damage = h[Damage], intact = one - damage;
    T ec = h[Compaction], ed = h[Bulking], et = h[Opening];
    const T ebar = h[Precompression] - branchFree::logarithm(point.volumeRatio);

    // Cracks close at zero pressure before anything else is compressed.
    const T closed = branchFree::positivePart(branchFree::smaller(et, ebar - ec + ed + et));
    et -= closed;
    T v = ec - ed - et;

    const T inelasticBefore = v;

    // Pores close along the crush curve. In y, the logarithm of the pores left, the curve is
    // straight.
    const Real full = fullCompaction();
    T p = pressure(ebar, v), pc = crushCurve(ec);
    T dissipation(0.0);
    const Real tolerance = 1e-11 * strength;
    if (const auto crushes = p > pc; branchFree::anyOf(crushes))
    {
      const T y = (pc - T(crushPressure)) * T(1.0 / crushHardening);
      const T most = branchFree::smaller(
          (grainPressure(ebar - v) - T(crushPressure)) * T(1.0 / crushHardening), T(closedPores));
      const auto compactionOf = [&](const T& at)
      { return T(full) * (one - branchFree::exponential(-at)); };
      const auto excess = [&](const T& at)
      {
        return pressure(ebar, v + (compactionOf(at) - ec)) -
               (T(crushPressure) + T(crushHardening) * at);
      };
      const T root =
          branchFree::fallingRoot(excess, y, branchFree::larger(most, y), p - pc,
                                  excess(branchFree::larger(most, y)), T(tolerance), crushes);
      const T crushed = choose(crushes, compactionOf(root) - ec, zero);
      ec += crushed;
      v += crushed;
      p = choose(crushes, pressure(ebar, v), p);
      pc = choose(crushes, T(crushPressure) + T(crushHardening) * root, pc);
      dissipation += p * crushed;
    }

    // Shear: the deviator returns along itself to the strength, and the volume follows.
    const SymTensorOf<T> s =
        deviatorOf(sumOf(point.stress, T(2.0 * elastic.shearModulus), point.strainIncrement));
    const T q = vonMisesOf(s, point.bendingSquared);
    const T cosTheta =
        branchFree::cosine(T(1.0 / 3.0) * branchFree::arcCosine(cosineOfLode(s, vonMisesOf(s))));
    const T mean = partOfMean(q, point.bendingSquared);

    // Fast strain makes the surface of strength larger about the origin, r Y(p / r): r is that of
    // tension up to no pressure, that of compression from a third of fc on. The cap stays.
    T faster(1.0), fasterTension(1.0);
    if (rates.counts())
    {
      const T rate = largestPrincipal(point.strainIncrement) * T(1 / point.dt);
      fasterTension = rates.tension(rate);
      const T share = branchFree::smaller(branchFree::positivePart(p) * T(3 / strength), one);
      faster = fasterTension + share * (rates.compression(rate) - fasterTension);
    }
    const auto strengthAt = [&](const T& at, const T& crush)
    {
      if (!rates.counts())
        return shearStrength(at, crush, damage, cosTheta);
      return faster * shearStrength(at / faster, crush / faster, damage, cosTheta);
    };

    const T threeG(3 * elastic.shearModulus);
    const T start = T(capRatio) * pc, knee(strength / 3);
    const auto pulled = p < zero, compacts = p >= start;
    const T dilatant =
        choose(p < knee, T(tensileDilation) + (T(0.6) - T(tensileDilation)) * p / knee,
               T(0.6) * (start - p) / (start - knee));
    // Volume strain v per plastic shear strain.
    const T rate = choose(
        pulled, T(-tensileDilation),
        choose(compacts, T(shearCompaction) * branchFree::smaller((p - start) / (pc - start), one),
               -intact * branchFree::positivePart(dilatant)));
    const Real fullest = full * (1 - std::exp(-closedPores));
    const auto compactionAt = [&](const T& dl)
    { return branchFree::smaller(ec + branchFree::positivePart(rate) * dl, T(fullest)); };
    // Opening under tension ends at no pressure: against a pressure it would give work back.
    const T widest = branchFree::smaller(v, ebar);
    const auto volumeAt = [&](const T& dl)
    {
      const T moved = v + choose(compacts, compactionAt(dl) - ec, rate * dl);
      return choose(pulled, branchFree::larger(moved, widest), moved);
    };
    const auto excess = [&](const T& dl)
    {
      return q - threeG * dl -
             strengthAt(pressure(ebar, volumeAt(dl)), crushCurve(compactionAt(dl)));
    };
    const T over = q - strengthAt(p, pc);
    T plastic(0.0), dilated(0.0), opened(0.0), scale(1.0);
    if (const auto yields = over > T(tolerance); branchFree::anyOf(yields))
    {
      const T most = q / threeG;
      const T root =
          branchFree::fallingRoot(excess, zero * q, most, over, excess(most), T(tolerance), yields);
      plastic = choose(yields, root, zero);
      const T compacted = choose(yields && compacts, compactionAt(plastic) - ec, zero);
      opened = choose(yields && pulled, v - volumeAt(plastic), zero);
      dilated = choose(yields && !pulled && !compacts, -rate * plastic, zero);
      ec += compacted;
      et += opened;
      ed += dilated;
      v = choose(yields, volumeAt(plastic), v);
      p = choose(yields, pressure(ebar, v), p);
      pc = choose(yields, crushCurve(ec), pc);
      scale = choose(yields, one - threeG * plastic / q, one);
      dissipation += scale * q * plastic * mean + p * (compacted - dilated - opened);
    }

    // No mean tension above the strength: cracks open.
    const T least = -intact * T(tensileStrength) * fasterTension;
    if (const auto cracks = p < least - T(tolerance); branchFree::anyOf(cracks))
    {
      const T most = v - ebar; // then the grains are free of stress
      const auto lack = [&](const T& x) { return least - pressure(ebar, v - x); };
      const T root =
          branchFree::fallingRoot(lack, zero * v, most, least - p, least, T(tolerance), cracks);
      const T cracked = choose(cracks, root, zero);
      et += cracked;
      v -= cracked;
      opened += cracked;
      p = choose(cracks, pressure(ebar, v), p);
      dissipation -= p * cracked;
    }

    // A strength that falls with the rate lets the stress go at once, so the work of the inelastic
    // strain is that at the mean stress of the step, as in the energy of the element.
    if (rates.counts())
    {
      const T shear =
          choose(plastic > zero,
                 plastic * (T(1.5) * contract(point.stress, s) / q + scale * q * mean), zero);
      const T volume = (p - meanOf(point.stress)) * (v - inelasticBefore);
      dissipation = branchFree::positivePart(T(0.5) * (shear + volume));
    }

    // Opening takes strength away: exponentially, by the fracture energy per width of the element.
    const T hindered =
        branchFree::logarithm(one + branchFree::positivePart(p) * T(1.0 / tensileStrength));
    const T grown = (dilated + opened) * branchFree::exponential(T(-damageExponent) * hindered);
    const T decay = T(tensileStrength / fractureEnergy) * point.size;
    h[Damage] = one - intact * branchFree::exponential(-grown * decay);
    h[PlasticStrain] += plastic;
    h[Porosity] = porosityOf(v);
    h[Compaction] = ec;
    h[Bulking] = ed;
    h[Opening] = et;
    point.stress = stressOf(s, scale, -p);
    point.dissipation = dissipation;
    point.bendingScale = scale;
    point.integrity = branchFree::larger(one - h[Damage], T(0.02));
    const T bulk = poreFactor(h[Porosity]) * grainTangent(ebar - v);
    const Real shear = 4.0 / 3.0 * elastic.shearModulus;
    point.stiffening =
        branchFree::larger((bulk + T(shear)) * T(1.0 / (elastic.bulkModulus + shear)), T(0.02));
  }

  /// History at the start, under a stress: the reference volume is that of the stressed material.
  void startFrom(const SymTensor& stress, Real* history) const;
};

/// What a user says of a concrete.
struct PseudoCapParameters : ElasticParameters
{
  Real compressiveStrength = 0; ///< fc [Pa]
  Real tensileStrength = 0;     ///< ft [Pa]
  Real fractureEnergy = 0;      ///< G_F [J/m^2]
  Real porosity = 0;            ///< [-]
  Real grainModulus = 0;        ///< Ks [Pa]
  Real grainSlope = 1.5;        ///< s [-]
  Real crushPressure = 0;       ///< [Pa]
  Real crushHardening = 0;      ///< Ph [Pa]
  Real capRatio = 0.5;          ///< Rc [-]
  Real shearCompaction = 2;     ///< mu_c [-]
  bool rateEffects = false;
  Real largestRate = 300; ///< of rate effects [1/s]

  static MaterialModel model();
};

/// Concrete of 40 MPa, the set C40 of docs/theory/materials.md.
PseudoCapParameters concreteC40();

/// Throws Error(ExitCode::Deck) with what is wrong.
PseudoCap makeLaw(const PseudoCapParameters& parameters);
} // namespace coplane
