#pragma once

#include <coplane_material/Material.hpp>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

namespace coplane::testing
{
/// A law, and a strain that takes it far from its elastic range.
struct NamedLaw
{
  std::string name;
  Material law;
  Real strain;
};
inline std::ostream& operator<<(std::ostream& out, const NamedLaw& law)
{
  return out << law.name;
}

inline EquationOfState mieGrueneisen(Real density, Real soundSpeed, Real slope, Real gamma)
{
  EquationOfState eos;
  eos.kind = EquationOfState::Kind::MieGrueneisen;
  eos.stiffness = density * soundSpeed * soundSpeed;
  eos.slope = slope;
  eos.gamma = gamma;
  return eos;
}

/// Steel of 7850 kg/m^3 with the shock line of iron.
inline EquationOfState steelShock()
{
  return mieGrueneisen(7850, 4570, 1.49, 1.93);
}

/// Half solid, half pores.
inline EquationOfState porousShock()
{
  EquationOfState eos = mieGrueneisen(4000, 4570, 1.49, 1.93);
  eos.kind = EquationOfState::Kind::PAlpha;
  eos.distension = 2;
  eos.crushStart = 0.2e9;
  eos.crushEnd = 2e9;
  return eos;
}

inline LinearElastic withBulkModulus(LinearElastic elastic, Real bulkModulus)
{
  elastic.bulkModulus = bulkModulus;
  return elastic;
}

inline JohnsonCook steel4340()
{
  JohnsonCook law{};
  law.elastic = makeLinearElastic(201e9, 0.3, 7830);
  law.strength = 792e6;
  law.hardening = 510e6;
  law.exponent = 0.26;
  law.rateFactor = 0.014;
  law.thermalExponent = 1.03;
  law.meltingTemperature = 1793;
  law.heatCapacity = 477;
  const Real d[5] = {0.05, 3.44, -2.12, 0.002, 0.61};
  std::copy(d, d + 5, law.damage);
  return checked(law);
}

inline HolmquistJohnsonCook concreteHjc48()
{
  HolmquistJohnsonCook law{};
  law.elastic = {2440, 0, 14.86e9};
  law.strength = 48e6;
  law.cohesion = 0.79;
  law.pressureFactor = 1.6;
  law.pressureExponent = 0.61;
  law.rateFactor = 0.007;
  law.mostStrength = 7;
  law.tension = 4e6;
  law.leastFracture = 0.01;
  law.damage1 = 0.04;
  law.damage2 = 1;
  law.crushPressure = 16e6;
  law.crushCompression = 0.001;
  law.lockPressure = 800e6;
  law.lockCompression = 0.1;
  const Real k[3] = {85e9, -171e9, 208e9};
  std::copy(k, k + 3, law.locked);
  return completed(law);
}

/// The ceramic of the one-element tests of Johnson and Holmquist (1994), case C.
inline JohnsonHolmquistParameters ceramicJh2()
{
  JohnsonHolmquistParameters p;
  p.density = 3700;
  p.shearModulus = 90.16e9;
  p.bulkModuli = {130.95e9, 0, 0};
  p.elasticLimit = 1.46e9 + 2e9 / 1.5;
  p.elasticLimitPressure = 1.46e9;
  p.tensileStrength = 0.2e9;
  p.intactFactor = 0.93;
  p.intactExponent = 0.6;
  p.fracturedFactor = 0.31;
  p.fracturedExponent = 0.6;
  p.damageFactor = 0.005;
  return p;
}

/// Rock of 20 GPa with Mohr and Coulomb's strength; angles in radians.
inline MohrCoulombParameters rockOf(Real frictionAngle, Real dilationAngle, Real cohesion,
                                    Real residualCohesion, Real tensileStrength,
                                    Real shearEnergy = 0, Real fractureEnergy = 0)
{
  MohrCoulombParameters p;
  p.density = 2500;
  p.youngsModulus = 20e9;
  p.poissonRatio = 0.25;
  p.friction = std::tan(frictionAngle);
  p.dilation = std::tan(dilationAngle);
  p.cohesion = cohesion;
  p.residualCohesion = residualCohesion;
  p.tensileStrength = tensileStrength;
  p.shearEnergy = shearEnergy;
  p.fractureEnergy = fractureEnergy;
  return p;
}

/// The same rock with Drucker and Prager's cone.
inline DruckerPrager coneOf(Real frictionAngle, Real dilationAngle, Real cohesion,
                            DruckerPragerFit fit)
{
  DruckerPragerParameters p;
  p.density = 2500;
  p.youngsModulus = 20e9;
  p.poissonRatio = 0.25;
  p.friction = std::tan(frictionAngle);
  p.dilation = std::tan(dilationAngle);
  p.cohesion = cohesion;
  p.fit = fit;
  return makeLaw(p);
}

/// Cohesive planes that are weaker than the matrix, and dilate.
inline UbiquitousJointParameters jointedRock()
{
  UbiquitousJointParameters p;
  static_cast<MohrCoulombParameters&>(p) = rockOf(0.6, 0.2, 5e6, 5e6, 2e6);
  p.jointNormal = {1, -2, 3};
  p.jointCohesion = 1e6;
  p.jointFriction = 0.5;
  p.jointDilation = 0.2;
  p.jointTensileStrength = 0.5e6;
  return p;
}

/// The law with its directions turned: of a body that is turned before it is led along a path.
inline Material turnedLaw(const Material& law, const Mat3& rotation)
{
  Material turned = law;
  if (auto* joints = std::get_if<UbiquitousJoints>(&turned))
    joints->normal = rotation * joints->normal;
  return turned;
}

inline std::vector<NamedLaw> allLaws()
{
  const LinearElastic steel = makeLinearElastic(200e9, 0.3, 7850);
  const auto shocked = [&](const EquationOfState& eos)
  {
    return makeHardeningPlasticity(withBulkModulus(steel, eos.stiffness / eos.distension), eos, {0},
                                   {400e6}, 0);
  };
  PseudoCapParameters fast = concreteC40();
  fast.rateEffects = true;
  fast.largestRate = 300;
  PseudoCapParameters closing = concreteC40();
  closing.crackClosure = true;
  closing.damageExponent = 2.3;
  MohrCoulombParameters table = rockOf(0, 0.2, 0, 0, 2e6, 0, 100);
  table.plasticShears = {0, 0.002, 0.01};
  table.cohesions = {5e6, 3e6, 1e6};
  table.frictions = {0.7, 0.6, 0.4};
  HoekBrownParameters mass;
  mass.density = 2500;
  mass.youngsModulus = 20e9;
  mass.poissonRatio = 0.25;
  mass.intactStrength = 50e6;
  mass.intactConstant = 10;
  mass.gsi = 60;
  mass.dilation = 0.2;
  HoekBrownParameters softening = mass;
  softening.tensileStrength = 0.15e6;
  softening.residualGsi = 25;
  softening.shearEnergy = 5000;
  softening.fractureEnergy = 20;
  JohnsonCook hot = steel4340();
  hot.eos = mieGrueneisen(7830, 4570, 1.49, 1.93);
  hot.elastic.bulkModulus = hot.eos.stiffness;
  JohnsonHolmquistParameters ductile = ceramicJh2(); // with all there is
  ductile.bulkModuli = {130.95e9, 100e9, -50e9};
  ductile.largestFractured = 0.4;
  ductile.rateFactor = 0.01;
  ductile.leastFractureStrain = 1e-4;
  ductile.bulkingFraction = 0.7;
  KaragozianCaseParameters plain;
  plain.density = 2300;
  plain.compressiveStrength = 40e6;
  KaragozianCaseParameters plainFast = plain;
  plainFast.rateEffects = true;
  UbiquitousJointParameters loose = jointedRock(); // and a matrix that softens
  loose.residualCohesion = 1e6;
  loose.shearEnergy = 500;
  loose.fractureEnergy = 100;
  loose.jointCohesion = loose.jointDilation = loose.jointTensileStrength = 0;
  return {{"linearElastic", steel, 1e-3},
          {"j2Plasticity", makeJ2Plasticity(makeLinearElastic(200e9, 0.3, 7850), 400e6, 1e9), 0.01},
          {"hardeningPlasticity",
           makeHardeningPlasticity(steel, {}, {0, 0.002, 0.02}, {300e6, 350e6, 420e6}, 2e9), 0.01},
          {"j2MieGrueneisen", shocked(steelShock()), 0.05},
          {"j2PAlpha", shocked(porousShock()), 0.05},
          {"neoHookean", NeoHookean{makeLinearElastic(3e6, 0.4, 1000)}, 0.3},
          {"druckerPrager", coneOf(0.6, 0.2, 2e6, DruckerPragerFit::Compression), 0.005},
          {"mohrCoulomb", makeLaw(rockOf(0.6, 0.2, 5e6, 1e6, 2e6, 500, 100)), 0.005},
          {"mohrCoulombTresca", makeLaw(rockOf(0, 0, 5e6, 5e6, 20e6)), 0.005},
          {"mohrCoulombTable", makeLaw(table), 0.005},
          {"hoekBrown", makeLaw(mass), 0.005},
          {"hoekBrownSoftening", makeLaw(softening), 0.005},
          {"ubiquitousJoints", makeLaw(jointedRock()), 0.005},
          {"ubiquitousJointsLoose", makeLaw(loose), 0.001},
          {"johnsonCook", steel4340(), 0.05},
          {"johnsonCookMieGrueneisen", checked(hot), 0.05},
          {"pseudoCap", makeLaw(concreteC40()), 0.01},
          {"pseudoCapRates", makeLaw(fast), 0.01},
          {"pseudoCapCloses", makeLaw(closing), 0.01},
          {"hjc", concreteHjc48(), 0.01},
          {"jh2", makeLaw(ductile), 0.02},
          {"kcc", makeLaw(plain), 0.01},
          {"kccRates", makeLaw(plainFast), 0.01}};
}
} // namespace coplane::testing
