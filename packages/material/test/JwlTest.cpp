#include "Laws.hpp"
#include "Paths.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/Lanes.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace coplane;
using namespace coplane::testing;

namespace
{
JwlParameters tnt()
{
  JwlParameters p;
  p.density = 1630;
  p.a = 371.2e9;
  p.b = 3.231e9;
  p.r1 = 4.15;
  p.r2 = 0.95;
  p.omega = 0.3;
  p.detonationEnergy = 7e9;
  p.detonationSpeed = 6930;
  p.detonationPressure = 21e9;
  return p;
}

/// The front is less than one and a half elements of 1 mm away.
JwlParameters litSoon()
{
  JwlParameters p = tnt();
  p.lightingPoints = {{0, 0, 0}};
  p.lightingTimes = {1e-7};
  return p;
}

JwlParameters litFarAway()
{
  JwlParameters p = tnt();
  p.lightingPoints = {{1000, 0, 0}};
  return p;
}

/// To the volume ratio `to` from `from` in one step, along x.
Mat3 stretch(Real from, Real to)
{
  return Mat3{{{2 * (to - from) / (to + from), 0, 0}, {0, 0, 0}, {0, 0, 0}}};
}

/// What stays constant along an isentrope of the products: C of p = A e^-R1V + B e^-R2V +
/// C V^-(1+omega) [Pa].
Real isentropeOf(const JwlParameters& p, Real volume, Real pressure)
{
  return (pressure - p.a * std::exp(-p.r1 * volume) - p.b * std::exp(-p.r2 * volume)) *
         std::pow(volume, 1 + p.omega);
}

Real energyOn(const JwlParameters& p, Real c, Real volume)
{
  return p.a / p.r1 * std::exp(-p.r1 * volume) + p.b / p.r2 * std::exp(-p.r2 * volume) +
         c / p.omega * std::pow(volume, -p.omega);
}
} // namespace

TEST(Jwl, stateBehindADetonationIsWhereRayleighsLineTouchesTheIsentrope)
{
  const JwlParameters p = tnt();
  const DetonationState state = detonationState(makeLaw(p));
  const Real c = isentropeOf(p, state.volume, state.pressure);
  const Real slope = p.a * p.r1 * std::exp(-p.r1 * state.volume) +
                     p.b * p.r2 * std::exp(-p.r2 * state.volume) +
                     (1 + p.omega) * c * std::pow(state.volume, -2 - p.omega); // -dp/dV
  const Real rayleigh = state.pressure / (1 - state.volume);
  EXPECT_NEAR(slope, rayleigh, 1e-6 * rayleigh);
  EXPECT_NEAR(p.density * state.speed * state.speed, rayleigh, 1e-9 * rayleigh);
  // Hugoniot: the energy behind is that of the explosive and the work of the shock.
  const Real energy = p.detonationEnergy + 0.5 * state.pressure * (1 - state.volume);
  EXPECT_NEAR(energyOn(p, c, state.volume), energy, 1e-9 * energy);
  // What the handbook says of TNT.
  EXPECT_NEAR(state.pressure, 21e9, 0.01e9);
  EXPECT_NEAR(state.speed, 6930, 2);
}

TEST(Jwl, oneStepToTheDensityBehindADetonationBurnsAllAndGivesItsPressure)
{
  // The trapezoid of the energy over one step from rest is Hugoniot's. All is beta burn.
  const Jwl law = makeLaw(litSoon());
  const DetonationState state = detonationState(law);
  MaterialProbe probe(law, 1e-3);
  const Real volume = law.detonationVolume - 1e-9;
  probe.advance(stretch(1, volume), 1e-9);
  EXPECT_EQ(probe.history("burn_fraction"), 1);
  EXPECT_NEAR(probe.pressure(), state.pressure, 1e-3 * state.pressure);
  EXPECT_NEAR(probe.energy(), 0.5 * probe.pressure() * (1 - volume), 1e-3);
  // There matter leaves the front at the speed of sound, rho c = rho0 D.
  EXPECT_NEAR(probe.stiffening(), 1, 2e-3);
}

TEST(Jwl, productsExpandAlongTheirIsentrope)
{
  const JwlParameters p = tnt();
  MaterialProbe probe(makeLaw(p), 1e-3);
  probe.advance(Mat3{}, 1e-6); // at constant volume, long enough to burn all
  const Real atOnce = isentropeOf(p, 1, probe.pressure());
  EXPECT_NEAR(energyOn(p, atOnce, 1), p.detonationEnergy, 1e-9 * p.detonationEnergy);
  const int steps = 4000;
  const Real last = 8;
  for (int i = 0; i < steps; ++i)
    probe.advance(stretch(std::pow(last, Real(i) / steps), std::pow(last, Real(i + 1) / steps)),
                  1e-9);
  const Real v = probe.volumeRatio();
  EXPECT_NEAR(v, last, 1e-9);
  EXPECT_NEAR(isentropeOf(p, v, probe.pressure()), atOnce, 1e-5 * atOnce);
  EXPECT_NEAR(p.detonationEnergy + probe.energy(), energyOn(p, atOnce, v),
              1e-6 * p.detonationEnergy);
  // The tangent is that of the isentrope.
  const Real bulk = p.a * p.r1 * v * std::exp(-p.r1 * v) + p.b * p.r2 * v * std::exp(-p.r2 * v) +
                    (1 + p.omega) * atOnce * std::pow(v, -1 - p.omega);
  EXPECT_NEAR(probe.stiffening() * elasticity(probe.material()).bulkModulus, bulk, 1e-5 * bulk);
}

TEST(Jwl, theFirstFrontReachesAPlaceFirst)
{
  JwlParameters p = tnt();
  EXPECT_EQ(makeLaw(p).timeToBurn({1, 2, 3}), 0);
  p.lightingPoints = {{0, 0, 0}, {0.1, 0}};
  EXPECT_DOUBLE_EQ(makeLaw(p).timeToBurn({0.07, 0, 0}), 0.03 / 6930);
  EXPECT_DOUBLE_EQ(makeLaw(p).timeToBurn({0.03, 0.04, 0}), 0.05 / 6930);
  p.lightingTimes = {2e-6, 10e-6};
  EXPECT_DOUBLE_EQ(makeLaw(p).timeToBurn({0.07, 0, 0}), 0.07 / 6930 + 2e-6);
  EXPECT_DOUBLE_EQ(makeLaw(p).timeToBurn({0.1, 0, 0}), 10e-6);
  EXPECT_DOUBLE_EQ(initialHistory(makeLaw(p), {}, {0.1, 0, 0})[Jwl::TimeToBurn], 10e-6);
}

TEST(Jwl, timesCountFromTheStartOfTheRunAlsoForAChargeThatComesLater)
{
  JwlParameters p = tnt();
  EXPECT_EQ(makeLaw(p).timeToBurn({1, 2, 3}, 1), 0); // all of it, at once
  p.lightingPoints = {{0, 0, 0}, {0.1, 0}};
  p.lightingTimes = {2e-6, 10e-6};
  const Jwl law = makeLaw(p);
  EXPECT_DOUBLE_EQ(law.timeToBurn({0.1, 0, 0}, 4e-6), 6e-6);
  // Lit before it came: when it comes.
  EXPECT_DOUBLE_EQ(law.timeToBurn({0.01, 0, 0}, 4e-6), 0.01 / 6930);
  EXPECT_DOUBLE_EQ(initialHistory(law, {}, {0.1, 0, 0}, 4e-6)[Jwl::TimeToBurn], 6e-6);
}

TEST(Jwl, theFrontTakesOneAndAHalfElementsToPass)
{
  JwlParameters p = tnt();
  const Real size = 2e-3, passing = 1.5 * size / p.detonationSpeed;
  p.lightingPoints = {{0, 0, 0}};
  p.lightingTimes = {1e-6}; // a probe is at the origin
  MaterialProbe probe(makeLaw(p), size);
  probe.advance(Mat3{}, 1e-6);
  EXPECT_NEAR(probe.history("burn_fraction"), 0, 1e-12);
  EXPECT_EQ(probe.pressure(), 0);
  probe.advance(Mat3{}, 0.4 * passing);
  EXPECT_NEAR(probe.history("burn_fraction"), 0.4, 1e-12);
  const Real all = p.a * (1 - p.omega / p.r1) * std::exp(-p.r1) +
                   p.b * (1 - p.omega / p.r2) * std::exp(-p.r2) + p.omega * p.detonationEnergy;
  EXPECT_NEAR(probe.pressure(), 0.4 * all, 1e-9 * all);
  EXPECT_GE(probe.stiffening(), 1);
  probe.advance(Mat3{}, passing);
  EXPECT_EQ(probe.history("burn_fraction"), 1);
  EXPECT_NEAR(probe.pressure(), all, 1e-9 * all);
}

TEST(Jwl, unburntExplosiveHasItsOwnStiffnessAndNoTension)
{
  JwlParameters p = litFarAway();
  p.bulkModulus = 9e9;
  MaterialProbe probe(makeLaw(p), 1e-3, {-5e6, -5e6, -5e6, 0, 0, 0});
  probe.advance(stretch(1, 1 - 1e-6), 1e-9);
  EXPECT_NEAR(probe.pressure(), 5e6 + 9e3, 1);
  // A blow as hard as a detonation: the front has not come.
  probe.advance(stretch(1 - 1e-6, 0.7), 1e-9);
  EXPECT_NEAR(probe.pressure(), 5e6 + 9e9 * (1 / 0.7 - 1), 1e3);
  probe.advance(stretch(0.7, 1.01), 1e-9);
  EXPECT_EQ(probe.pressure(), 0);
  EXPECT_EQ(probe.history("burn_fraction"), 0);
  EXPECT_NEAR(makeLaw(tnt()).unburntModulus, 1630 * 2310.0 * 2310.0, 1);
}

TEST(Jwl, everyLaneHasTheBitsOfTheScalar)
{
  const Jwl law = makeLaw(litSoon());
  MaterialPoint<Real> one[laneCount];
  for (int lane = 0; lane < laneCount; ++lane)
  {
    // Unburnt, in the front, burnt and compressed, expanded.
    const Real volumes[] = {0.999, 0.9, 0.7, 3};
    MaterialPoint<Real>& point = one[lane];
    point.dt = 1e-9;
    point.volumeRatio = volumes[lane % 4];
    point.halfVolumeRatio = 1.001 * point.volumeRatio;
    const Real de = (lane - 1.5) * 1e-3;
    point.strainIncrement = {de, 0.5 * de, -de, 0.1, 0.2, 0.3};
    point.energy = 1e8 * lane;
    point.size = 1e-3 * (lane + 1);
    point.oldStress = {-1e9, -1e9, -1e9, 0, 0, 0};
    for (int k = 0; k < Jwl::historyCount; ++k)
      point.history[k] = 0;
    point.history[Jwl::TimeToBurn] = lane == 0 ? 1 : -1e-8;
    point.history[Jwl::BurnFraction] = lane == 3 ? 1 : 0;
  }
  const auto gather = [&](auto member)
  { return Lanes([&](auto i) { return member(one[int(i)]); }); };
  using P = MaterialPoint<Real>;
  MaterialPoint<Lanes> all;
  all.dt = 1e-9;
  all.volumeRatio = gather([](const P& p) { return p.volumeRatio; });
  all.halfVolumeRatio = gather([](const P& p) { return p.halfVolumeRatio; });
  all.energy = gather([](const P& p) { return p.energy; });
  all.size = gather([](const P& p) { return p.size; });
  all.strainIncrement.xx = gather([](const P& p) { return p.strainIncrement.xx; });
  all.strainIncrement.yy = gather([](const P& p) { return p.strainIncrement.yy; });
  all.strainIncrement.zz = gather([](const P& p) { return p.strainIncrement.zz; });
  all.oldStress.xx = all.oldStress.yy = all.oldStress.zz = Lanes(-1e9);
  for (int k = 0; k < Jwl::historyCount; ++k)
    all.history[k] = gather([&](const P& p) { return p.history[k]; });
  law(all);
  for (int lane = 0; lane < laneCount; ++lane)
  {
    law(one[lane]);
    EXPECT_EQ(Real(all.stress.xx[lane]), one[lane].stress.xx);
    EXPECT_EQ(Real(all.stiffening[lane]), one[lane].stiffening);
    for (int k = 0; k < Jwl::historyCount; ++k)
      EXPECT_EQ(Real(all.history[k][lane]), one[lane].history[k]);
  }
}

TEST(Jwl, refusesAFrontThatIsNotThatOfItsProducts)
{
  const auto messageOf = [](const JwlParameters& p)
  {
    try
    {
      makeLaw(p);
    }
    catch (const Error& error)
    {
      return std::string(error.what());
    }
    return std::string();
  };
  JwlParameters p = tnt();
  p.detonationSpeed = 7400;
  EXPECT_NE(messageOf(p).find("within 5 % of 6929"), std::string::npos) << messageOf(p);
  p = tnt();
  p.detonationPressure = 26e9;
  EXPECT_NE(messageOf(p).find("within 15 % of 2.1"), std::string::npos) << messageOf(p);
  p = tnt();
  p.detonationEnergy = 7e6; // per mass
  EXPECT_NE(messageOf(p).find("detonation speed"), std::string::npos) << messageOf(p);
  p = tnt();
  p.lightingTimes = {0};
  EXPECT_NE(messageOf(p).find("lighting times"), std::string::npos) << messageOf(p);
  p = tnt();
  p.r2 = 5;
  EXPECT_NE(messageOf(p).find("R1"), std::string::npos) << messageOf(p);
}
