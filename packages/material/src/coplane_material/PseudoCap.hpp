#pragma once

#include <coplane_core/ElementaryFunctions.hpp>
#include <coplane_material/ConcreteSurfaces.hpp>
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
/// hypoelastic. Compression is positive in pressures and volume strains here. What a step gives is
/// a continuous function of what it gets, to 1e-11 of fc: nowhere does round-off choose a branch.
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
  bool cracksClose = false;   ///< and bear pressure again
  RateEffect rates;           ///< by which fast strain raises the strengths

  enum
  {
    Damage,
    PlasticStrain,
    Porosity,
    Compaction,     // e_c
    Bulking,        // e_d
    Opening,        // e_t
    Precompression, // of the stress-free reference volume [-]
    Crushing        // damage without that of cracks, D_c; 0 where cracks do not close
  };
  static constexpr int historyCount = 8;
  static constexpr const char* historyNames[] = {"damage",         "equivalent_plastic_strain",
                                                 "porosity",       "compaction",
                                                 "bulking",        "crack_opening",
                                                 "precompression", "crushing"};
  static constexpr bool usesVolume = true, changesTangent = true, hasStrength = true;

  /// Volume per plastic shear strain of intact material at p = fc / 3 [-].
  static constexpr Real kneeDilation = 0.6;
  /// Porosity that opens takes the modulus away, which is gone but for a rest at that much more.
  static constexpr Real openedPores = 0.3, leastOpened = 0.05;
  /// q / p that a closed crack bears on the compression meridian; of normal and shear stress that
  /// is a friction of 0.8.
  static constexpr Real slopeOfClosedCracks = 6;
  /// Pressure over fc from which strength does not grow with the rate; less so from fc on.
  static constexpr Real confinedFrom = 3;
  /// 1 - s x of the grains stays above, so that their pressure stays finite.
  static constexpr Real leastRoom = 0.1;
  /// s of their energy; below, its terms would cancel each other.
  static constexpr Real leastSlope = 1e-3;

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
    const T room = branchFree::larger(one - T(grainSlope) * x, T(leastRoom));
    return T(grainModulus) * branchFree::choose(ee > T(0.0), x / (room * room), stretch - one);
  }

  /// d p_s / d ee.
  template <class T>
  KOKKOS_INLINE_FUNCTION T grainTangent(const T& ee) const
  {
    const T stretch = branchFree::exponential(ee), one(1.0);
    const T x = one - one / stretch;
    const T room = branchFree::larger(one - T(grainSlope) * x, T(leastRoom));
    const T compressed = (one + T(grainSlope) * x) / (stretch * room * room * room);
    return T(grainModulus) * branchFree::choose(ee > T(0.0), compressed, stretch);
  }

  /// int p_s e^-ee d ee: energy that the grains store, per their volume without stress [J/m^3].
  template <class T>
  KOKKOS_INLINE_FUNCTION T grainEnergy(const T& ee) const
  {
    const T one(1.0), half(0.5), s(branchFree::larger(grainSlope, leastSlope));
    const T x = one - branchFree::exponential(-ee);
    const T room = branchFree::larger(one - s * x, T(leastRoom)), smooth = (one - room) / s;
    const T compressed = (branchFree::logarithm(room) + s * smooth / room) / (s * s) +
                         half * (x * x - smooth * smooth) / (room * room);
    return T(grainModulus) * branchFree::choose(ee > T(0.0), compressed, ee - x);
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
        T(intact) *
        branchFree::larger(T(1.0) - (phi - T(porosity)) * T(1 / openedPores), T(leastOpened));
    return branchFree::choose(phi > T(porosity), opening, closing);
  }

  /// p at the total strain ebar = ln(density / reference density) and inelastic volume strain v.
  template <class T>
  KOKKOS_INLINE_FUNCTION T pressure(const T& ebar, const T& v) const
  {
    return poreFactor(porosityOf(v)) * grainPressure(ebar - v);
  }

  /// By which storedEnergy weighs that of the grains, per volume at the density of reference.
  template <class T>
  KOKKOS_INLINE_FUNCTION T stiffnessOfPores(const T& v) const
  {
    return poreFactor(porosityOf(v)) * branchFree::exponential(-v);
  }

  /// Energy that volume stores, per volume at the density of reference [J/m^3]: p is its derivative
  /// by ebar, per volume now.
  template <class T>
  KOKKOS_INLINE_FUNCTION T storedEnergy(const T& ebar, const T& v) const
  {
    return stiffnessOfPores(v) * grainEnergy(ebar - v);
  }

  /// pc after the compaction ec.
  template <class T>
  KOKKOS_INLINE_FUNCTION T crushCurve(const T& ec) const
  {
    return T(crushPressure) -
           T(crushHardening) * branchFree::logarithm(T(1.0) - ec * T(1.0 / fullCompaction()));
  }

  KOKKOS_INLINE_FUNCTION ConcreteSurfaces surfaces() const
  {
    return {strength, tensileStrength, biaxialRatio};
  }

  /// Ys: strength on the compression meridian, without the cap. What cracks took counts under
  /// tension; from p = 0 on, the strength rises as closed cracks slide, up to that of the
  /// uncracked.
  /// @param crushing D_c; D where cracks do not close
  template <class T>
  KOKKOS_INLINE_FUNCTION T meridian(const T& p, const T& damage, const T& crushing) const
  {
    const T one(1.0), compression = branchFree::positivePart(p);
    const T intact = one - damage, uncrushed = one - crushing;
    const ConcreteSurfaces surface = surfaces();
    const T sheared = uncrushed * surface.intactStrength(compression) +
                      crushing * surface.residualStrength(compression);
    T line = surface.tensionLine(p, uncrushed);
    if (cracksClose)
      line = branchFree::smaller(line, surface.tensionLine(p - compression, intact) +
                                           T(slopeOfClosedCracks) * compression);
    return branchFree::positivePart(branchFree::smaller(line, sheared));
  }

  /// Y: von Mises stress that the material bears.
  template <class T>
  KOKKOS_INLINE_FUNCTION T shearStrength(const T& p, const T& pc, const T& damage,
                                         const T& crushing, const T& cosTheta) const
  {
    const T one(1.0), start = T(capRatio) * pc;
    const T reach = (p - start) / (pc - start);
    const T cap = branchFree::squareRoot(branchFree::positivePart(one - reach * reach));
    return ConcreteSurfaces::lodeFactor(cosTheta, surfaces().meridianRatio(p)) *
           meridian(p, damage, crushing) *
           branchFree::choose(p > start, branchFree::choose(p < pc, cap, T(0.0)), one);
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    State<T> state = stateOf(point);
    closeCracks(state);
    const T inelasticBefore = state.v;
    crushPores(state);
    Shear<T> shear = shearOf(point, state);
    returnShear(state, shear);
    openCracks(state, shear.fasterTension);
    T* const h = point.history;
    point.dissipation = dissipationOf(point, state, shear, inelasticBefore);
    const T share = shareThatDamages(state);
    h[Damage] = weakened(state.intact, (state.dilated + state.opened) * share, point.size);
    if (cracksClose)
      h[Crushing] = weakened(state.uncrushed, state.dilated * share, point.size);
    h[PlasticStrain] += shear.plastic;
    h[Porosity] = porosityOf(state.v);
    h[Compaction] = state.ec;
    h[Bulking] = state.ed;
    h[Opening] = state.et;
    point.stress = stressOf(shear.s, shear.scale, -state.p);
    point.bendingScale = shear.scale;
    point.integrity = branchFree::larger(T(1.0) - h[Damage], T(leastStiffness));
    point.stiffening =
        elastic.stiffeningOf(poreFactor(h[Porosity]) * grainTangent(state.ebar - state.v));
  }

  /// History at the start, under a stress: the reference volume is that of the stressed material.
  void startFrom(const SymTensor& stress, Real* history) const;

private:
  /// Volume, pressure and damage on the way through a step.
  template <class T>
  struct State
  {
    T damage, intact;      ///< D and 1 - D at the start of the step
    T crushing, uncrushed; ///< D_c and 1 - D_c; D where cracks do not close
    T ebar;                ///< ln(density / reference density)
    T ec, ed, et;          ///< compaction, bulking, opening
    T v;                   ///< ec - ed - et
    T p, pc;               ///< pressure and crush pressure [Pa]
    T dilated = T(0.0);    ///< increment of ed
    T opened = T(0.0);     ///< increment of et that takes strength away
  };

  /// The deviator on the way through a step.
  template <class T>
  struct Shear
  {
    SymTensorOf<T> s;         ///< trial deviator [Pa]
    T q;                      ///< its von Mises stress, with bending [Pa]
    T cosTheta;               ///< of its Lode angle
    T partOfMean;             ///< of the plastic work, not of bending
    T faster = T(1.0);        ///< strength at the rate of strain over that of slow tests
    T fasterTension = T(1.0); ///< the same of tension
    T plastic = T(0.0);       ///< plastic shear strain of the step
    T scale = T(1.0);         ///< of the trial deviator
  };

  /// How the volume changes in a step that yields: pores close, or cracks open, or it bulks.
  template <class T>
  struct Way
  {
    branchFree::MaskOf<T> compacts;
    branchFree::MaskOf<T> opens; ///< and some tension is left at the end of the step
    T start;                     ///< v from where on it does
    T passed = T(0.0);           ///< cracks opened before, until there was no tension
    T cracks;                    ///< open ones, which bulking fills before it meets a pressure
    T lack;                      ///< that of returnShear at the start [Pa]
    T most;                      ///< bound of the change of v from there on
  };

  /// Of stresses over fc.
  static constexpr Real toleranceShare = 1e-11;
  KOKKOS_INLINE_FUNCTION Real tolerance() const { return toleranceShare * strength; }

  template <class T>
  KOKKOS_INLINE_FUNCTION State<T> stateOf(const MaterialPoint<T>& point) const
  {
    const T* const h = point.history;
    State<T> state;
    state.damage = h[Damage];
    state.intact = T(1.0) - state.damage;
    state.crushing = cracksClose ? h[Crushing] : h[Damage];
    state.uncrushed = T(1.0) - state.crushing;
    state.ec = h[Compaction];
    state.ed = h[Bulking];
    state.et = h[Opening];
    state.ebar = h[Precompression] - branchFree::logarithm(point.volumeRatio);
    return state;
  }

  /// Cracks close at zero pressure before anything else is compressed.
  template <class T>
  KOKKOS_INLINE_FUNCTION void closeCracks(State<T>& state) const
  {
    const T closed = branchFree::positivePart(
        branchFree::smaller(state.et, state.ebar - state.ec + state.ed + state.et));
    state.et -= closed;
    state.v = state.ec - state.ed - state.et;
    state.p = pressure(state.ebar, state.v);
    state.pc = crushCurve(state.ec);
  }

  /// Pores close along the crush curve. In y, the logarithm of the pores left, the curve is
  /// straight.
  template <class T>
  KOKKOS_INLINE_FUNCTION void crushPores(State<T>& state) const
  {
    using branchFree::choose;
    const auto crushes = state.p > state.pc;
    if (!branchFree::anyOf(crushes))
      return;
    const T zero(0.0), one(1.0), start(crushPressure), perHardening(1.0 / crushHardening);
    const T full(fullCompaction());
    const T y = (state.pc - start) * perHardening;
    const T most = branchFree::smaller((grainPressure(state.ebar - state.v) - start) * perHardening,
                                       T(closedPores));
    const auto compactionOf = [&](const T& at)
    { return full * (one - branchFree::exponential(-at)); };
    const auto excess = [&](const T& at)
    {
      return pressure(state.ebar, state.v + (compactionOf(at) - state.ec)) -
             (start + T(crushHardening) * at);
    };
    const T upper = branchFree::larger(most, y);
    const T root = branchFree::fallingRoot(excess, y, upper, state.p - state.pc, excess(upper),
                                           T(tolerance()), crushes);
    const T crushed = choose(crushes, compactionOf(root) - state.ec, zero);
    state.ec += crushed;
    state.v += crushed;
    state.p = choose(crushes, pressure(state.ebar, state.v), state.p);
    state.pc = choose(crushes, start + T(crushHardening) * root, state.pc);
  }

  /// The elastic deviator, and what its rate of strain makes of the strength: fast strain makes the
  /// surface larger about the origin, r Y(p / r); r is that of tension up to no pressure, that of
  /// compression from a third of fc on, up to fc, and 1 from 3 fc on. The cap stays.
  template <class T>
  KOKKOS_INLINE_FUNCTION Shear<T> shearOf(const MaterialPoint<T>& point,
                                          const State<T>& state) const
  {
    Shear<T> shear;
    shear.s = deviatorOf(sumOf(point.stress, T(2.0 * elastic.shearModulus), point.strainIncrement));
    shear.q = vonMisesOf(shear.s, point.bendingSquared);
    shear.cosTheta = branchFree::cosineOfThird(cosineOfLode(shear.s, vonMisesOf(shear.s)));
    shear.partOfMean = partOfMean(shear.q, point.bendingSquared);
    if (rates.counts())
    {
      const T rate = largestPrincipal(point.strainIncrement) * T(1 / point.dt);
      shear.fasterTension = rates.tension(rate);
      const T one(1.0), pressure = branchFree::positivePart(state.p) * T(1 / strength);
      const T share = branchFree::smaller(pressure * T(3.0), one);
      const T inTest =
          shear.fasterTension + share * (rates.compression(rate) - shear.fasterTension);
      const T confined = branchFree::smaller(
          branchFree::positivePart(pressure - one) * T(1 / (confinedFrom - 1)), one);
      shear.faster = inTest + confined * (one - inTest);
    }
    return shear;
  }

  /// Volume strain v per plastic shear strain where there is no tension. It never falls with the
  /// pressure and is 0 where the cap begins.
  template <class T>
  KOKKOS_INLINE_FUNCTION T volumePerShear(const T& p, const T& pc, const T& uncrushed) const
  {
    using branchFree::choose;
    const T start = T(capRatio) * pc, knee(strength / 3);
    const T dilatant =
        choose(p < knee, T(tensileDilation) + T(kneeDilation - tensileDilation) * p / knee,
               T(kneeDilation) * (start - p) / (start - knee));
    const T compacting =
        T(shearCompaction) * branchFree::smaller((p - start) / (pc - start), T(1.0));
    return choose(p > start, compacting, -uncrushed * branchFree::positivePart(dilatant));
  }

  /// Y of the step, at a pressure and a crush pressure.
  template <class T>
  KOKKOS_INLINE_FUNCTION T strengthAt(const T& p, const T& pc, const State<T>& state,
                                      const Shear<T>& shear) const
  {
    if (!rates.counts())
      return shearStrength(p, pc, state.damage, state.crushing, shear.cosTheta);
    const T& faster = shear.faster;
    return faster *
           shearStrength(p / faster, pc / faster, state.damage, state.crushing, shear.cosTheta);
  }

  /// Under tension cracks open, until there is none: against a pressure they would give work back.
  /// There bulking takes over, or the flow stays where bulking would fall behind.
  /// @param over q - Y at the start of the step [Pa]
  template <class T>
  KOKKOS_INLINE_FUNCTION Way<T> wayOf(const State<T>& state, const Shear<T>& shear,
                                      const T& over) const
  {
    using branchFree::choose;
    const T zero(0.0), threeG(3 * elastic.shearModulus), opening(tensileDilation);
    const T toNone = branchFree::positivePart(state.v - state.ebar);
    Way<T> way;
    way.compacts = state.p > T(capRatio) * state.pc;
    way.opens = toNone > zero;
    const T perShear =
        choose(way.opens, opening,
               branchFree::absolute(volumePerShear(state.p, state.pc, state.uncrushed)));
    way.lack = perShear * over;
    way.start = state.v;
    if (branchFree::anyOf(way.opens))
    {
      const T needed = threeG * toNone,
              overAtNone = shear.q - strengthAt(zero, state.pc, state, shear);
      const auto passes = way.opens && opening * overAtNone > needed;
      way.opens = way.opens && !passes;
      way.passed = choose(passes, toNone, zero);
      way.start = choose(passes, state.ebar, state.v);
      way.lack = choose(passes, state.uncrushed * opening * overAtNone - needed, way.lack);
    }
    way.cracks = state.et + way.passed;
    // Strength does not fall while cracks open or the volume bulks; it may while pores close.
    way.most = choose(way.compacts, perShear * shear.q, way.lack) / threeG;
    return way;
  }

  /// The deviator returns along itself to the strength and the volume follows, by as much per shear
  /// as belongs to the pressure at the end. Sought is the change of volume, of which pressure,
  /// strength Y and plastic shear (q - Y) / 3G are functions. All flow leads to the start of the
  /// cap, where no volume follows; so what the change lacks falls on the way, and its root is a
  /// continuous function of the trial stress.
  template <class T>
  KOKKOS_INLINE_FUNCTION void returnShear(State<T>& state, Shear<T>& shear) const
  {
    using branchFree::choose, branchFree::smaller, branchFree::larger, branchFree::positivePart;
    const T zero(0.0), one(1.0), threeG(3 * elastic.shearModulus), q = shear.q;
    const T over = q - strengthAt(state.p, state.pc, state, shear);
    const auto yields = over > zero;
    if (!branchFree::anyOf(yields))
      return;
    const Way<T> way = wayOf(state, shear, over);
    const T fullest = larger(state.ec, T(fullCompaction() * (1 - std::exp(-closedPores))));
    const auto compactionAfter = [&](const T& gone)
    { return choose(way.compacts, smaller(state.ec + gone, fullest), state.ec); };
    const auto volumeAfter = [&](const T& gone)
    {
      const T open = way.start - gone;
      const T filled = larger(open, smaller(state.ebar, open + way.cracks));
      return choose(way.compacts, way.start + (compactionAfter(gone) - state.ec),
                    choose(way.opens, open, filled));
    };
    const auto lack = [&](const T& gone)
    {
      const T p = pressure(state.ebar, volumeAfter(gone)), pc = crushCurve(compactionAfter(gone));
      const T follows = volumePerShear(p, pc, state.uncrushed);
      const T perShear = choose(way.opens, T(tensileDilation),
                                positivePart(choose(way.compacts, follows, -follows)));
      return perShear * (q - strengthAt(p, pc, state, shear)) - threeG * (way.passed + gone);
    };
    const T root = branchFree::fallingRoot(lack, zero * q, way.most, way.lack, lack(way.most),
                                           T(tolerance()), yields);

    const T gone = choose(yields, root, zero);
    const auto bulks = yields && !way.opens && !way.compacts;
    state.opened = choose(yields, choose(way.opens, gone, way.passed), zero);
    state.dilated = choose(bulks, gone, zero);
    state.et +=
        state.opened -
        choose(bulks, positivePart(smaller(state.ebar - (way.start - gone), way.cracks)), zero);
    state.ed += state.dilated;
    state.ec = compactionAfter(gone);
    state.v = choose(yields, volumeAfter(gone), state.v);
    state.p = choose(yields, pressure(state.ebar, state.v), state.p);
    state.pc = choose(yields, crushCurve(state.ec), state.pc);
    const T borne = smaller(strengthAt(state.p, state.pc, state, shear), q);
    shear.plastic = choose(yields, (q - borne) / threeG, zero);
    shear.scale = choose(yields, borne / q, one);
  }

  /// No mean tension above the strength: cracks open.
  template <class T>
  KOKKOS_INLINE_FUNCTION void openCracks(State<T>& state, const T& fasterTension) const
  {
    using branchFree::choose;
    const T zero(0.0), least = -state.intact * T(tensileStrength) * fasterTension;
    const auto cracks = state.p < least - T(tolerance());
    if (!branchFree::anyOf(cracks))
      return;
    const T most = state.v - state.ebar; // then the grains are free of stress
    const auto lack = [&](const T& x) { return least - pressure(state.ebar, state.v - x); };
    const T root = branchFree::fallingRoot(lack, zero * state.v, most, least - state.p, least,
                                           T(tolerance()), cracks);
    const T cracked = choose(cracks, root, zero);
    state.et += cracked;
    state.v -= cracked;
    state.opened += cracked;
    state.p = choose(cracks, pressure(state.ebar, state.v), state.p);
  }

  /// Work of the inelastic strain of the step at the mean of the stresses at its ends, as in the
  /// energy of the element, less what pores that close make the grains store [J/m^3]. Where a large
  /// step turns the stress round, that is less than nothing and counts as nothing.
  template <class T>
  KOKKOS_INLINE_FUNCTION T dissipationOf(const MaterialPoint<T>& point, const State<T>& state,
                                         const Shear<T>& shear, const T& inelasticBefore) const
  {
    const T zero(0.0), half(0.5), closed = state.v - inelasticBefore;
    const T ofShear =
        branchFree::choose(shear.plastic > zero,
                           shear.plastic * (T(1.5) * contract(point.stress, shear.s) / shear.q +
                                            shear.scale * shear.q * shear.partOfMean),
                           zero);
    if (!branchFree::anyOf(branchFree::absolute(closed) > zero))
      return half * branchFree::positivePart(ofShear);
    const T* const h = point.history;
    const T ebarBefore = state.ebar + T(3.0) * meanOf(point.strainIncrement);
    const T start = energyAt(ebarBefore, h[Compaction] - h[Bulking] - h[Opening]);
    const T stored = (stiffnessOfPores(state.v) - stiffnessOfPores(inelasticBefore)) *
                     (energyAt(state.ebar, state.v) + start);
    return half *
           branchFree::positivePart(ofShear + (state.p - meanOf(point.stress)) * closed - stored);
  }

  /// grainEnergy per volume now, times the volume at the density of reference.
  template <class T>
  KOKKOS_INLINE_FUNCTION T energyAt(const T& ebar, const T& v) const
  {
    return grainEnergy(ebar - v) * branchFree::exponential(ebar);
  }

  /// Under pressure the same bulking does less damage.
  template <class T>
  KOKKOS_INLINE_FUNCTION T shareThatDamages(const State<T>& state) const
  {
    const T grown = branchFree::logarithm(T(1.0) + branchFree::positivePart(state.p) *
                                                       T(1.0 / tensileStrength));
    return branchFree::exponential(T(-damageExponent) * grown);
  }

  /// Damage: opening takes strength away, exponentially, by the fracture energy per width of the
  /// element.
  template <class T>
  KOKKOS_INLINE_FUNCTION T weakened(const T& left, const T& opening, const T& size) const
  {
    const T decay = T(tensileStrength / fractureEnergy) * size;
    return T(1.0) - left * branchFree::exponential(-opening * decay);
  }
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
  Real damageExponent = 1.6;    ///< b1 [-]
  bool crackClosure = false;
  bool rateEffects = false;
  Real largestRate = 0; ///< of rate effects [1/s]; 0: where inertia begins

  static MaterialModel model();
};

/// Concrete of 40 MPa, the set C40 of docs/theory/materials.md.
PseudoCapParameters concreteC40();

/// Throws Error(ExitCode::Deck) with what is wrong.
PseudoCap makeLaw(const PseudoCapParameters& parameters);
} // namespace coplane
