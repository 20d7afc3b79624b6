#include "Rig.hpp"

#include <coplane_dynamics/AirBlast.hpp>
#include <coplane_partition/Partition.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace coplane
{
namespace
{
/// exp of a polynomial in ln Z.
Real simplified(std::initializer_list<Real> coefficients, Real scaled)
{
  Real sum = 0, power = 1;
  for (const Real c : coefficients)
  {
    sum += c * power;
    power *= std::log(scaled);
  }
  return std::exp(sum);
}

/// The integral of a pressure by the rule of the middles [Pa s].
template <class Wave>
Real integralOf(const Wave& wave, Real from, Real to)
{
  const int steps = 200000;
  Real sum = 0;
  for (int i = 0; i < steps; ++i)
    sum += wave.pressure(from + (i + 0.5) * (to - from) / steps);
  return sum * (to - from) / steps;
}
} // namespace

TEST(AirBlast, hemisphereAgreesWithTheSimplifiedFitsOfTheSameData)
{
  // Swisdak 1994, table 1, in kPa, kPa ms / kg^(1/3) and ms / kg^(1/3), within 1 % of Kingery and
  // Bulmash but where two fits meet.
  const Real mass = 27, size = 3;
  for (const Real z : {0.21, 0.3, 0.5, 0.8, 1.2, 1.7, 2.2, 3.5, 5.0, 8.0, 12.0, 20.0, 23.0})
  {
    const BlastValues v = blastValuesAt(Burst::Surface, mass, z * size);
    const Real incident = z < 2.9 ? simplified({7.2106, -2.1069, -0.3229, 0.1117, 0.0685}, z)
                                  : simplified({7.5938, -3.0523, 0.40977, 0.0261, -0.01267}, z);
    EXPECT_NEAR(v.incidentPressure, 1e3 * incident, 0.02 * 1e3 * incident) << z;
    const Real reflected =
        z < 2 ? simplified({9.006, -2.6893, -0.6295, 0.1011, 0.29255, 0.13505, 0.019736}, z)
              : simplified({8.8396, -1.733, -2.64, 2.293, -0.8232, 0.14247, -0.0099}, z);
    EXPECT_NEAR(v.reflectedPressure, 1e3 * reflected, 0.02 * 1e3 * reflected) << z;
    const Real incidentImpulse = z < 0.96 ? simplified({5.522, 1.117, 0.6, -0.292, -0.087}, z)
                                 : z < 2.38
                                     ? simplified({5.465, -0.308, -1.464, 1.362, -0.432}, z)
                                     : simplified({5.2749, -0.4677, -0.2499, 0.0588, -0.00554}, z);
    EXPECT_NEAR(v.incidentImpulse, size * incidentImpulse, 0.02 * size * incidentImpulse) << z;
    const Real reflectedImpulse = simplified({6.7853, -1.3466, 0.101, -0.01123}, z);
    EXPECT_NEAR(v.reflectedImpulse, size * reflectedImpulse, 1e-3 * size * reflectedImpulse) << z;
    const Real arrival = z < 1.5
                             ? simplified({-0.7604, 1.8058, 0.1257, -0.0437, -0.031, -0.00669}, z)
                             : simplified({-0.7137, 1.5732, 0.5561, -0.4213, 0.1054, -0.00929}, z);
    EXPECT_NEAR(v.arrival, 1e-3 * size * arrival, 0.01e-3 * size * arrival) << z;
    const Real duration =
        z < 1.02  ? simplified({0.5426, 3.2299, -1.5931, -5.9667, -4.0815, -0.9149}, z)
        : z < 2.8 ? simplified({0.544, 2.7082, -9.7354, 14.3425, -9.7791, 2.8535}, z)
                  : simplified({-2.4608, 7.1639, -5.6215, 2.2711, -0.44994, 0.03486}, z);
    EXPECT_NEAR(v.duration, 1e-3 * size * duration, 0.02e-3 * size * duration) << z;
  }
}

TEST(AirBlast, sphereAgreesWithTheFitsInPoundsAndFeet)
{
  // The same report, psi, psi ms / lb^(1/3), ms / lb^(1/3) over ft / lb^(1/3).
  const Real pound = 0.45359237, foot = 0.3048, psi = 6894.757293168;
  const auto fit = [](std::initializer_list<Real> coefficients, Real u)
  {
    Real sum = 0, power = 1;
    for (const Real c : coefficients)
    {
      sum += c * power;
      power *= u;
    }
    return std::pow(10, sum);
  };
  for (const Real z : {0.5, 1.0, 1.9, 2.1, 3.0, 5.0, 6.0, 10.0, 30.0, 90.0})
  {
    const Real t = std::log10(z), u = -0.756579301809 + 1.35034249993 * t;
    const BlastValues v = blastValuesAt(Burst::Air, pound, z * foot);
    const Real incident =
        fit({1.77284970457, -1.69012801396, 0.00804973591951, 0.336743114941, -0.00516226351334,
             -0.0809228619888, -0.00478507266747, 0.00793030472242, 0.0007684469735},
            u);
    EXPECT_NEAR(v.incidentPressure, psi * incident, 1e-3 * psi * incident) << z;
    const Real reflected = fit({2.39106134946, -2.21400538997, 0.035119031446, 0.657599992109,
                                0.0141818951887, -0.243076636231, -0.0158699803158, 0.0492741184234,
                                0.00227639644004, -0.00397126276058},
                               u);
    EXPECT_NEAR(v.reflectedPressure, psi * reflected, 1e-3 * psi * reflected) << z;
    const Real reflectedImpulse =
        1e-3 * psi *
        fit({1.60579280091, -0.903118886091, 0.101771877942, -0.0242139751146},
            -0.757659920369 + 1.37882996018 * t);
    EXPECT_NEAR(v.reflectedImpulse, reflectedImpulse, 1e-3 * reflectedImpulse) << z;
    const Real arrival =
        1e-3 * fit({-0.0423733936826, 1.36456871214, -0.0570035692784, -0.182832224796,
                    0.0118851436014, 0.0432648687627, -0.0007997367834, -0.00436073555033},
                   -0.80501734056 + 1.37407043777 * t);
    EXPECT_NEAR(v.arrival, arrival, 1e-3 * arrival) << z;
    const Real duration =
        1e-3 * (z < 2.24 ? fit({-0.801052722864, 0.164953518069, 0.127788499497, 0.00291430135946,
                                0.00187957449227, 0.0173413962543, 0.00269739758043,
                                -0.00361976502798, -0.00100926577934},
                               0.209440059933 + 5.11588554305 * t)
                : z < 5.75
                    ? fit({0.115874238335, -0.0297944268969, 0.0306329542941, 0.018340557407,
                           -0.0173964666286, -0.00106321963576, 0.0056206003128, 0.0001618217499,
                           -0.0006860188944},
                          -5.06778493835 + 9.2996288611 * t)
                    : fit({0.50659210403, 0.0967031995552, -0.00801302059667, 0.00482705779732,
                           0.00187587272287, -0.00246738509321, -0.000841116668, 0.0006193291052},
                          -4.39590184126 + 3.1524725264 * t));
    EXPECT_NEAR(v.duration, duration, 2e-3 * duration) << z;
  }
}

TEST(AirBlast, theCurveHasItsImpulse)
{
  for (const Burst burst : {Burst::Surface, Burst::Air})
    for (const Real z : {0.2, 0.6, 1.0, 3.0, 10.0, 40.0})
    {
      const BlastValues v = blastValuesAt(burst, 1, z);
      for (const auto& [peak, impulse] : {std::pair{v.incidentPressure, v.incidentImpulse},
                                          {v.reflectedPressure, v.reflectedImpulse}})
      {
        const Friedlander curve = friedlanderOf(peak, impulse, v.duration);
        EXPECT_EQ(curve.pressure(0), peak);
        EXPECT_GE(curve.decay, 0);
        EXPECT_NEAR(curve.impulse(), impulse, 1e-10 * impulse) << z;
        EXPECT_NEAR(integralOf(curve, 0, curve.duration), impulse, 1e-6 * impulse) << z;
      }
    }
}

TEST(AirBlast, anImpulseBeyondAStraightDecayMakesThePhaseLonger)
{
  const Friedlander curve = friedlanderOf(1e5, 600, 0.01); // 0.6 of peak and duration
  EXPECT_EQ(curve.decay, 0);
  EXPECT_DOUBLE_EQ(curve.duration, 0.012);
  EXPECT_DOUBLE_EQ(curve.impulse(), 600);
  EXPECT_DOUBLE_EQ(curve.pressure(0.006), 0.5e5);
  // And nothing jumps on the way there.
  const Friedlander before = friedlanderOf(1e5, 499.999, 0.01);
  EXPECT_NEAR(before.decay, 0, 1e-4);
  EXPECT_EQ(before.duration, 0.01);
}

TEST(AirBlast, theAngleDecidesBetweenReflectedAndIncidentPressure)
{
  const BlastCharge charge{Burst::Surface, 100, {0, 0, 0}, 1e-3};
  const BlastValues v = blastValuesAt(charge.burst, 100, 10);
  const auto peak = [&](Real angle)
  {
    const BlastWave wave = blastWaveOn(charge, {10, 0, 0}, {-std::cos(angle), std::sin(angle), 0});
    EXPECT_DOUBLE_EQ(wave.arrival, 1e-3 + v.arrival);
    EXPECT_EQ(wave.pressure(0.999 * wave.arrival), 0);
    return wave.pressure(wave.arrival);
  };
  EXPECT_DOUBLE_EQ(peak(0), v.reflectedPressure);
  EXPECT_NEAR(peak(pi / 2), v.incidentPressure, 1e-9 * v.incidentPressure);
  EXPECT_DOUBLE_EQ(peak(pi), v.incidentPressure); // turned away
  // p_r cos^2 + p_i (1 + cos - 2 cos^2) with cos = 1/2: a quarter of the one, the other whole.
  EXPECT_NEAR(peak(pi / 3), 0.25 * v.reflectedPressure + v.incidentPressure,
              1e-9 * v.reflectedPressure);
}

TEST(AirBlast, stepsThatFollowEachOtherGiveTheWholeImpulse)
{
  for (const Real decay : {0.0, 1e-9, 0.3, 4.0, 30.0})
  {
    BlastWave wave;
    wave.arrival = 1;
    wave.incident = {80, 2, decay};
    wave.reflected = {500, 1.5, 2 * decay};
    wave.reflection = 0.7;
    wave.incidence = 0.4;
    const Real all = 0.4 * wave.incident.impulse() + 0.7 * wave.reflected.impulse();
    for (const Real dt : {0.01, 0.37, 5.0})
      for (const Real phase : {0.0, 0.3, 0.9})
      {
        Real sum = 0;
        for (int i = -1; i * dt < 12; ++i)
          sum += dt * wave.meanPressure((i + phase) * dt, dt);
        EXPECT_NEAR(sum, all, 1e-11 * all) << decay << " " << dt << " " << phase;
      }
    EXPECT_NEAR(wave.meanPressure(1.8, 1e-5), wave.pressure(1.8), 1e-7 * wave.pressure(1.8));
    EXPECT_EQ(wave.meanPressure(0.5, 0.9), 0);
    EXPECT_EQ(wave.meanPressure(4, 0.9), 0);
  }
}

TEST(AirBlast, loadsFacesUntilTheyDie)
{
  const Comm comm;
  const Mesh mesh = unitBox(2, 3, 2);
  const RankMesh part = distribute(mesh, nodeOwners(mesh, comm, "rcb"), comm.rank());
  NodalState state(part);
  Conditions conditions;
  BlastWave wave;
  wave.arrival = 1;
  wave.incident = {80, 2, 0};
  AirBlast blast;
  for (const LoadedSide& side : sidesWhere(part, [](const Vec3& x) { return x.z == 2; }))
    blast.sides.push_back({side, wave});
  conditions.airBlasts = {blast};
  const auto force = [&](Real t)
  {
    conditions.applyLoads(3, part.ownedNodes, t, 0, state);
    return sumOverRanks(state.external, part.ownedNodes, comm);
  };
  EXPECT_EQ(force(0.9).z, 0);
  EXPECT_NEAR(force(1).z, -80 * 6, 1e-12);
  EXPECT_NEAR(force(2).z, -40 * 6, 1e-12); // half way along the straight decay
  std::vector<GlobalId> dead;
  for (const auto& block : part.blocks)
    dead.insert(dead.end(), block.elementIds.begin(), block.elementIds.end());
  std::sort(dead.begin(), dead.end());
  conditions.endLoadsOn(dead);
  EXPECT_EQ(force(1).z, 0);
}
} // namespace coplane
