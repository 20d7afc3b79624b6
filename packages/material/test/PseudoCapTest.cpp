#include "Paths.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_material/PseudoCap.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

// The table of docs/theory/materials.md for the set C40, by its tolerances: strengths 0.5 %, values
// at a strain 1 %, energies 3 %. Steps are small enough for a change of 0.2 % when they are halved.

using namespace coplane;
using namespace coplane::testing;

namespace
{
const PseudoCap c40 = makeLaw(concreteC40());
const Material concrete = c40;
constexpr Real elementSize = 0.01; // [m]

struct Value
{
  Real strain, megapascals;
};

/// Leads the probe by `follow`, and compares `stressOf` at the strains of the table, which are
/// reached by `strainOf`.
template <class Follow, class StrainOf, class StressOf>
void compare(const std::vector<Value>& table, Real share, const Follow& follow,
             const StrainOf& strainOf, const StressOf& stressOf)
{
  std::size_t next = 0;
  follow(
      [&](const MaterialProbe& probe)
      {
        if (next < table.size() && strainOf(probe) >= table[next].strain * (1 - 1e-9))
        {
          EXPECT_NEAR(stressOf(probe) / 1e6, table[next].megapascals,
                      share * std::abs(table[next].megapascals))
              << "at strain " << table[next].strain;
          ++next;
        }
      });
  EXPECT_EQ(next, table.size());
}

Real axialCompression(const MaterialProbe& probe)
{
  return -probe.stress().xx;
}
Real axialShortening(const MaterialProbe& probe)
{
  return -probe.strain().xx;
}

/// Largest compression along x while it is shortened at constant stress on the sides.
Real peakUnder(Real lateral, Real strain, int steps)
{
  MaterialProbe probe(concrete, elementSize);
  if (lateral > 0)
  {
    ProbeStep step;
    step.stressGiven.fill(true);
    for (int i = 1; i <= 400; ++i)
    {
      step.value = {-lateral * i / 400, -lateral * i / 400, -lateral * i / 400, 0, 0, 0};
      probe.advance(step);
    }
  }
  Real peak = 0;
  uniaxialStress(
      probe, -strain, steps,
      [&](const MaterialProbe& p) { peak = std::max(peak, axialCompression(p)); }, -lateral);
  return peak;
}
} // namespace

TEST(PseudoCap, uniaxialCompressionPeaksAtItsStrengthAndSoftens)
{
  MaterialProbe probe(concrete, elementSize);
  Real peak = 0, strainAtPeak = 0, volumeStrain = 0;
  compare(
      {{.002, 39.22}, {.005, 36.11}, {.01, 30.71}, {.02, 20.41}, {.05, 5.42}}, 0.01,
      [&](const Record& record)
      {
        uniaxialStress(probe, -0.05, 10000,
                       [&](const MaterialProbe& p)
                       {
                         record(p);
                         if (axialCompression(p) > peak)
                         {
                           peak = axialCompression(p);
                           strainAtPeak = axialShortening(p);
                         }
                         if (axialShortening(p) < 0.005 + 1e-9)
                           volumeStrain = std::log(p.volumeRatio());
                       });
      },
      axialShortening, axialCompression);
  EXPECT_NEAR(peak, 40e6, 0.005 * 40e6);
  EXPECT_NEAR(strainAtPeak, 40e6 / 33e9, 2 * 0.05 / 10000); // elastic up to the peak
  EXPECT_NEAR(volumeStrain, 0.00235, 0.01 * 0.00235);       // it grows: dilatancy
}

TEST(PseudoCap, aLargerElementSoftensFasterPerStrain)
{
  MaterialProbe probe(concrete, 0.08);
  compare(
      {{.002, 31.46}, {.005, 8.77}, {.01, 2.33}}, 0.01,
      [&](const Record& record) { uniaxialStress(probe, -0.01, 10000, record); }, axialShortening,
      axialCompression);
}

TEST(PseudoCap, tensionOpensACrackThatTakesItsFractureEnergy)
{
  MaterialProbe probe(concrete, elementSize);
  Real peak = 0;
  compare(
      {{.001, 2.9535}, {.002, 2.0981}, {.004, 1.0660}, {.008, .2788}}, 0.01,
      [&](const Record& record)
      {
        uniaxialStress(probe, 0.012, 12000,
                       [&](const MaterialProbe& p)
                       {
                         record(p);
                         peak = std::max(peak, p.stress().xx);
                       });
      },
      [](const MaterialProbe& p) { return p.strain().xx; },
      [](const MaterialProbe& p) { return p.stress().xx; });
  EXPECT_NEAR(peak, 4e6, 0.005 * 4e6);
  EXPECT_NEAR(probe.energy() * elementSize, 117.8, 0.03 * 117.8);      // [J/m^2]; 120 in the end
  EXPECT_NEAR(probe.dissipation() * elementSize, 117.8, 0.03 * 117.8); // all of it is lost
  // Mode I: no lateral inelastic strain, so the sides are back where they started.
  EXPECT_LT(std::abs(probe.strain().yy), 1e-5);
}

TEST(PseudoCap, confinementRaisesThePeakToTheFractureSurface)
{
  // Peak: root of q = Yh(s3 + q / 3). Beyond 20 MPa the cap is followed to its end.
  const std::vector<std::array<Real, 4>> table = {// confinement, peak [MPa], strain, steps
                                                  {2, 53.07, 0.01, 2000},  {5, 70.34, 0.01, 2000},
                                                  {10, 95.04, 0.02, 2000}, {20, 135.43, 0.2, 4000},
                                                  {50, 224.55, 0.3, 6000}, {100, 332.32, 0.4, 8000},
                                                  {200, 496.43, 0.5, 8000}};
  for (const auto& [confinement, peak, strain, steps] : table)
    EXPECT_NEAR(peakUnder(confinement * 1e6, strain, int(steps)) / 1e6, peak, 0.005 * peak)
        << confinement << " MPa";
}

TEST(PseudoCap, biaxialStrengthIsItsRatioOfTheUniaxialOne)
{
  // Equal shortening along x and y, z free.
  MaterialProbe probe(concrete, elementSize);
  ProbeStep step;
  step.stressGiven = {false, false, true, false, false, false};
  step.value = {-1e-6, -1e-6, 0, 0, 0, 0};
  Real peak = 0;
  for (int i = 0; i < 3000; ++i)
  {
    probe.advance(step);
    peak = std::max(peak, axialCompression(probe));
  }
  EXPECT_NEAR(peak, 46e6, 0.005 * 46e6);
}

TEST(PseudoCap, pureShearStrengthFollowsTheLodeAngle)
{
  // p held at 0 by stresses of 0 along the axes: q = r(30 deg) m_t ft = 0.73251 * 40 / (40/3 + 4) *
  // 4 = 6.762 MPa, tau = q / sqrt3.
  MaterialProbe probe(concrete, elementSize);
  ProbeStep step;
  step.stressGiven = {true, true, true, false, false, false};
  step.value = {0, 0, 0, 1e-6, 0, 0};
  Real peak = 0;
  for (int i = 0; i < 400; ++i)
  {
    probe.advance(step);
    peak = std::max(peak, probe.stress().xy);
  }
  EXPECT_NEAR(peak, 3.904e6, 0.005 * 3.904e6);
}

TEST(PseudoCap, hydrostatFollowsTheCrushCurveUntilThePoresAreClosed)
{
  MaterialProbe probe(concrete, elementSize);
  const std::vector<std::pair<Value, Real>> table = {
      {{.002, 36.85}, .0800},  {{.004, 74.07}, .0800},  {{.01, 98.65}, .07536},
      {{.02, 134.79}, .06711}, {{.04, 223.47}, .05037}, {{.06, 346.46}, .03372},
      {{.08, 537.75}, .01797}, {{.10, 898.63}, .00543}, {{.12, 1624.8}, .00048}};
  for (const auto& [value, porosity] : table)
  {
    const Real e = -value.strain / 3;
    strainPath(probe, {e, e, e, 0, 0, 0}, 200, [](const MaterialProbe&) {});
    EXPECT_NEAR(probe.pressure() / 1e6, value.megapascals, 0.01 * value.megapascals);
    EXPECT_NEAR(probe.history("porosity"), porosity, 1e-5);
    EXPECT_NEAR(-std::log(probe.volumeRatio()), value.strain, 1e-6);
  }
}

TEST(PseudoCap, unloadingAfterCompactionIsElasticAndEndsInTension)
{
  MaterialProbe probe(concrete, elementSize);
  const auto lead = [&](Real e) {
    strainPath(probe, {-e / 3, -e / 3, -e / 3, 0, 0, 0}, 400, [](const MaterialProbe&) {});
  };
  lead(.04);
  const std::vector<Value> table = {
      {.038, 168.80}, {.036, 114.67}, {.034, 61.08}, {.032, 8.02}, {.030, -2.35}};
  for (const Value& value : table)
  {
    lead(value.strain);
    EXPECT_NEAR(probe.pressure() / 1e6, value.megapascals, 0.01 * std::abs(value.megapascals));
  }
}

TEST(PseudoCap, uniaxialStrainCompacts)
{
  MaterialProbe probe(concrete, elementSize);
  const std::vector<std::array<Real, 3>> table = {
      {.001, 36.71, 9.21},   {.002, 73.52, 18.52}, {.003, 110.41, 27.91},
      {.004, 131.69, 34.58}, {.01, 157.2, 51.4},   {.02, 203.8, 77.2},
      {.04, 310.6, 141.7},   {.06, 447.1, 235.6},  {.1, 1038, 687}};
  for (const auto& [strain, axial, lateral] : table)
  {
    strainPath(probe, {-strain, 0, 0, 0, 0, 0}, 500, [](const MaterialProbe&) {});
    EXPECT_NEAR(axialCompression(probe) / 1e6, axial, 0.01 * axial) << strain;
    EXPECT_NEAR(-probe.stress().yy / 1e6, lateral, 0.01 * lateral) << strain;
  }
}

TEST(PseudoCap, hydrostaticTensionFallsWithTheCrack)
{
  MaterialProbe probe(concrete, elementSize);
  Real peak = 0;
  compare(
      {{.0005, -3.618}, {.001, -3.030}, {.002, -2.136}}, 0.01,
      [&](const Record& record)
      {
        strainPath(probe, {.002 / 3, .002 / 3, .002 / 3, 0, 0, 0}, 4000,
                   [&](const MaterialProbe& p)
                   {
                     record(p);
                     peak = std::max(peak, -p.pressure());
                   });
      },
      [](const MaterialProbe& p) { return std::log(p.volumeRatio()); },
      [](const MaterialProbe& p) { return p.pressure(); });
  EXPECT_NEAR(peak, 4e6, 0.005 * 4e6);
}

TEST(PseudoCap, crackClosesAtZeroPressureAndThenBearsAgain)
{
  // Hydrostatic: opened by 1e-3, closed again: free of stress on the way back, and after it
  // elastic with the modulus of the intact material, as the pores are back where they were.
  MaterialProbe probe(concrete, elementSize);
  const auto lead = [&](Real e) {
    strainPath(probe, {e / 3, e / 3, e / 3, 0, 0, 0}, 1000, [](const MaterialProbe&) {});
  };
  lead(1e-3);
  lead(2e-4);
  EXPECT_NEAR(probe.pressure(), 0, 1e-5); // rounding of the strain times K
  lead(-1e-3);
  EXPECT_NEAR(probe.history("crack_opening"), 0, 1e-12);
  EXPECT_NEAR(probe.pressure(), c40.pressure(1e-3, 0.0), 1e-6 * 18e6);
}

TEST(PseudoCap, volumeFollowsShearAsThePressureAtTheEndOfTheStepAsks)
{
  // Isochoric shear in steps of 0.3 % from pressures below the knee, below the cap and on it.
  for (const Real start : {5e6, 25e6, 60e6})
  {
    MaterialProbe probe(concrete, elementSize, {-start, -start, -start, 0, 0, 0});
    Mat3 shear;
    shear(0, 1) = 3e-3;
    for (int i = 0; i < 6; ++i)
    {
      const MaterialProbe before = probe;
      probe.advance(shear, 1);
      const auto change = [&](const char* name)
      { return probe.history(name) - before.history(name); };
      const Real p = probe.pressure(), plastic = change("equivalent_plastic_strain");
      const Real pc = c40.crushCurve(probe.history("compaction")), cap = 0.5 * pc, knee = 40e6 / 3;
      const Real intact = 1 - before.history("damage");
      const Real bulking =
          p < knee ? 1.5 - 0.9 * p / knee : std::max(0.6 * (cap - p) / (cap - knee), 0.0);
      EXPECT_GT(plastic, i > 1 ? 1e-4 : -1e-15);
      EXPECT_NEAR(change("bulking"), intact * bulking * plastic, 1e-12) << start << " " << i;
      EXPECT_NEAR(change("compaction"), std::max(2 * (p - cap) / (pc - cap), 0.0) * plastic, 1e-12)
          << start << " " << i;
    }
  }
}

TEST(PseudoCap, shearAtNoPressureFillsOpenCracksBeforeItMeetsOne)
{
  // A crack of 2e-3, closed by half: no pressure, and none under shear until bulking has filled it.
  // Bulking is 1.5 (1 - D) per shear, and breaks what is left.
  MaterialProbe probe(concrete, elementSize);
  for (const Real e : {2e-3, 1e-3})
    strainPath(probe, {e, 0, 0, 0, 0, 0}, 200, [](const MaterialProbe&) {});
  strainPath(probe, {1e-3, 1e-5, -1e-5, 0, 0, 0}, 1, [](const MaterialProbe&) {});
  const Real opened = probe.history("crack_opening"), intact = 1 - probe.history("damage");
  ASSERT_GT(opened, 5e-4);
  ASSERT_NEAR(probe.pressure(), 0, 1e-5);
  const MaterialProbe before = probe;
  Mat3 shear;
  shear(1, 2) = 4e-4;
  probe.advance(shear, 1);
  const Real plastic =
      probe.history("equivalent_plastic_strain") - before.history("equivalent_plastic_strain");
  const Real bulking = probe.history("bulking") - before.history("bulking");
  EXPECT_NEAR(probe.pressure(), 0, 1e-5);
  EXPECT_GT(plastic, 1e-4);
  EXPECT_NEAR(bulking, 1.5 * intact * plastic, 1e-12);
  EXPECT_NEAR(probe.history("crack_opening"), opened - bulking, 1e-12);
  EXPECT_NEAR(1 - probe.history("damage"), intact * std::exp(-bulking * 4e6 * elementSize / 120),
              1e-9);
  shear(1, 2) = 0.02;
  for (int i = 0; i < 5; ++i)
    probe.advance(shear, 1);
  EXPECT_GT(probe.pressure(), 1e5);
  EXPECT_NEAR(probe.history("crack_opening"), 0, 1e-15);
}

TEST(PseudoCap, strengthConstantsReproduceTheUniaxialStrengthsExactly)
{
  // On the compression meridian at p = fc / 3, Yh = fc; on the tension meridian at p = -ft / 3, q =
  // ft. r(0) = psi and r(60 deg) = 1.
  EXPECT_NEAR(c40.surfaces().intactStrength(40e6 / 3), 40e6,
              3e-5 * 40e6); // constants have four digits
  EXPECT_NEAR(c40.meridian(-4e6 / 3, 0.0, 0.0) * c40.surfaces().meridianRatio(-4e6 / 3), 4e6, 1e-6);
  EXPECT_NEAR(ConcreteSurfaces::lodeFactor(1.0, 0.65), 0.65, 1e-15);
  EXPECT_NEAR(ConcreteSurfaces::lodeFactor(0.5, 0.65), 1, 1e-15);
  EXPECT_NEAR(ConcreteSurfaces::lodeFactor(std::cos(pi / 6), 0.65), 0.73251, 5e-6);
}

TEST(PseudoCap, cracksThatCloseBearPressureAgain)
{
  PseudoCapParameters parameters = concreteC40();
  parameters.crackClosure = true;
  const PseudoCap closing = makeLaw(parameters);
  MaterialProbe probe(closing, elementSize);
  Real peak = 0;
  uniaxialStress(probe, 0.008, 20000, [](const MaterialProbe&) {});
  const Real cracked = probe.history("damage");
  EXPECT_GT(cracked, 0.9);
  EXPECT_EQ(probe.history("crushing"), 0);
  uniaxialStress(probe, -0.018, 20000,
                 [&](const MaterialProbe& p) { peak = std::max(peak, axialCompression(p)); });
  EXPECT_NEAR(peak, 40e6, 0.005 * 40e6);
  EXPECT_GT(probe.history("crushing"), 0.2);
  EXPECT_GT(probe.history("damage"), cracked);

  // As long as nothing but crushing has damaged, the surface is that of cracks that do not close.
  for (const Real damage : {0.0, 0.3, 1.0})
    for (const Real p : {-1e6, 0.0, 1e5, 5e6, 100e6})
      EXPECT_EQ(closing.meridian(p, damage, damage), c40.meridian(p, damage, damage)) << p;
  // Uniaxial compression, q = 3 p, is inside of it whatever the cracks, and outside otherwise.
  for (const Real p : {1e4, 1e6, 10e6})
  {
    EXPECT_GT(closing.meridian(p, 1.0, 0.0), 3 * p);
    EXPECT_LT(c40.meridian(p, 1.0, 1.0), 3 * p);
    // Shear stress over the normal stress is bounded.
    EXPECT_LE(closing.meridian(p, 1.0, 0.0), 6 * p);
  }
  EXPECT_EQ(closing.meridian(0.0, 1.0, 0.0), 0);

  // Pulled again, it bears what the crack has left.
  MaterialProbe again(closing, elementSize);
  uniaxialStress(again, 0.003, 5000, [](const MaterialProbe&) {});
  const Real left = (1 - again.history("damage")) * 4e6;
  uniaxialStress(again, -0.0005, 5000, [](const MaterialProbe&) {});
  EXPECT_LT(again.stress().xx, -10e6);
  Real pulled = 0;
  uniaxialStress(again, 0.004, 20000,
                 [&](const MaterialProbe& p) { pulled = std::max(pulled, p.stress().xx); });
  EXPECT_LT(pulled, 1.001 * left);
  EXPECT_GT(pulled, 0.8 * left);
}

TEST(PseudoCap, crushingIsMoreDuctileWithALargerExponent)
{
  // Energy that uniaxial compression takes, per area, up to a shortening of 0.8.
  const auto energyOf = [](Real exponent)
  {
    PseudoCapParameters parameters = concreteC40();
    parameters.damageExponent = exponent;
    MaterialProbe probe(makeLaw(parameters), 0.02);
    uniaxialStress(probe, -0.8, 20000, [](const MaterialProbe&) {});
    return probe.dissipation() * 0.02;
  };
  EXPECT_NEAR(energyOf(1.6), 13.6e3, 0.03 * 13.6e3);
  EXPECT_NEAR(energyOf(2.2), 22.4e3, 0.03 * 22.4e3);
  EXPECT_NEAR(energyOf(2.8), 40.3e3, 0.03 * 40.3e3);
}

TEST(PseudoCap, aCrackedSpecimenIsCrushedWhateverTheSteps)
{
  // What is free of stress on its sides bulges fast then: large steps are divided, and no far
  // answer is taken.
  const auto energyOf = [](int steps)
  {
    MaterialProbe probe(concrete, elementSize);
    uniaxialStress(probe, 0.003, steps, [](const MaterialProbe&) {});
    uniaxialStress(probe, -0.02, steps, [](const MaterialProbe&) {});
    EXPECT_NEAR(probe.stress().yy, 0, 1e3);
    EXPECT_LT(probe.volumeRatio(), 1.1);
    EXPECT_LE(probe.dissipation(), probe.energy());
    return probe.energy();
  };
  const Real fine = energyOf(5000);
  EXPECT_NEAR(energyOf(500), fine, 0.01 * fine);
  EXPECT_NEAR(energyOf(60), fine, 0.05 * fine);
}

TEST(PseudoCap, workIsStoredOrLost)
{
  // The energy that the law says is lost leaves that which volume and deviator store, on any path;
  // to the square of the strain, by which the deviator of a stress per volume now has no potential.
  struct Path
  {
    const char* name;
    std::vector<SymTensor> strains; // corners of the path
  };
  const std::vector<Path> paths = {
      {"closes pores", {{-0.015, -0.015, -0.015, 0, 0, 0}, {-0.009, -0.009, -0.009, 0, 0, 0}}},
      {"is pressed along one axis, and back", {{-0.06, 0, 0, 0, 0, 0}, {-0.03, 0, 0, 0, 0, 0}}},
      {"bulks under pressure",
       {{-0.002, -0.002, -0.002, 0, 0, 0}, {-0.002, -0.002, -0.002, 0.02, 0, 0}}},
      {"is torn, unequally", {{0.004, 0.002, 0, 0, 0, 0}}},
      {"is torn, pressed and torn again",
       {{0.001, 0, 0, 0, 0, 0}, {-0.01, 0, 0, 0.003, 0, 0}, {0.01, 0.01, 0, 0, 0.002, 0}}},
      {"is shorn and closed again",
       {{0.002, 0, 0, 0.01, 0, 0}, {-0.02, -0.01, -0.02, 0.01, 0.01, 0}}},
  };
  for (const bool fast : {false, true})
    for (const Path& path : paths)
    {
      PseudoCapParameters parameters = concreteC40();
      parameters.rateEffects = fast;
      const PseudoCap law = makeLaw(parameters);
      MaterialProbe probe(law, elementSize);
      SymTensor from;
      Real largest = 0;
      for (const SymTensor& to : path.strains)
      {
        constexpr int steps = 2000;
        const SymTensor d = sumOf(to, -1.0, from);
        const Real per = 1.0 / steps;
        for (int i = 0; i < steps; ++i)
        {
          probe.advance(Mat3{{{d.xx * per, d.xy * per, d.zx * per},
                              {d.xy * per, d.yy * per, d.yz * per},
                              {d.zx * per, d.yz * per, d.zz * per}}},
                        1e-3 * per);
          const SymTensor s = deviatorOf(probe.stress());
          const Real ebar = -std::log(probe.volumeRatio());
          const Real inelastic = probe.history("compaction") - probe.history("bulking") -
                                 probe.history("crack_opening");
          const Real stored =
              law.storedEnergy(ebar, inelastic) + contract(s, s) / (4 * law.elastic.shearModulus);
          largest = std::max(largest, std::abs(probe.energy() - probe.dissipation() - stored));
          EXPECT_GE(probe.dissipation(), 0);
        }
        from = to;
      }
      EXPECT_LT(largest, 0.002 * probe.energy()) << path.name;
    }
}

TEST(PseudoCap, initialStressIsBorneWithoutStrain)
{
  for (const Real p : {-2e6, 0.0, 30e6, 200e6}) // the last has crushed pores
  {
    MaterialProbe probe(concrete, elementSize, {-p, -p, -p, 0, 0, 0});
    probe.advance(Mat3{}, 1);
    EXPECT_NEAR(probe.pressure(), p, 1e-6 * 40e6);
    EXPECT_NEAR(probe.history("damage"), 0, 1e-12);
  }
}

TEST(PseudoCap, badParametersAreRefusedWithTheNumber)
{
  const auto refused = [](auto&& change, const std::string& part)
  {
    PseudoCapParameters parameters = concreteC40();
    change(parameters);
    try
    {
      makeLaw(parameters);
      ADD_FAILURE() << part;
    }
    catch (const Error& error)
    {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refused([](auto& p) { p.compressiveStrength = -40e6; }, "compressive strength is -40000000 Pa");
  refused([](auto& p) { p.tensileStrength = 50e6; }, "tensile strength is 50000000 Pa");
  refused([](auto& p) { p.porosity = 0; }, "porosity is 0");
  refused([](auto& p) { p.grainModulus = 10e9; }, "bulk modulus of the grains is 10000000000 Pa");
  refused([](auto& p) { p.fractureEnergy = 0; }, "fracture energy is 0 J/m^2");
  refused([](auto& p) { p.crushPressure = 20e6; }, "crush pressure is 20000000 Pa");
  refused([](auto& p) { p.largestRate = -1; }, "largest rate is -1 1/s");
  refused([](auto& p) { p.damageExponent = 5; }, "damage exponent is 5");
}
