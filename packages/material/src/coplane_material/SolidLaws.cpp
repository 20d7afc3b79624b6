#include <coplane_material/Demand.hpp>
#include <coplane_material/Material.hpp>

#include <cmath>

namespace coplane
{
void NeoHookean::startFrom(const SymTensor& stress, Real* history) const
{
  if (vonMisesOf(deviatorOf(stress)) > 0 || meanOf(stress) != 0)
    fail(ExitCode::Deck, "initial stress: a neo-Hookean material starts from its natural shape, "
                         "free of stress. Remove the initial stress of its blocks.");
  for (int k = 0; k < 3; ++k)
    history[k] = 1;
}

DruckerPrager makeDruckerPrager(const LinearElastic& elastic, Real frictionAngle,
                                Real dilationAngle, Real cohesion, DruckerPragerFit fit)
{
  demand(frictionAngle >= 0 && frictionAngle < pi / 2, "friction angle", frictionAngle, "rad",
         "0 or more, and below a right angle");
  demand(dilationAngle >= 0 && dilationAngle <= frictionAngle, "dilation angle", dilationAngle,
         "rad",
         fmt::format("0 or more, and at most the friction angle ({:.6g} rad)", frictionAngle));
  demand(cohesion >= 0 && cohesion + frictionAngle > 0, "cohesion", cohesion, "Pa",
         "0 or more; positive without friction");
  DruckerPrager law{elastic, 0, 0, 0};
  if (fit == DruckerPragerFit::Compression)
  {
    const auto slope = [](Real angle) { return 6 * std::sin(angle) / (3 - std::sin(angle)); };
    law.strength = 6 * cohesion * std::cos(frictionAngle) / (3 - std::sin(frictionAngle));
    law.frictionSlope = slope(frictionAngle);
    law.dilationSlope = slope(dilationAngle);
  }
  else
  {
    const auto root = [](Real angle)
    { return std::sqrt(9 + 12 * std::tan(angle) * std::tan(angle)); };
    law.strength = 3 * std::sqrt(3.0) * cohesion / root(frictionAngle);
    law.frictionSlope = 3 * std::sqrt(3.0) * std::tan(frictionAngle) / root(frictionAngle);
    law.dilationSlope = 3 * std::sqrt(3.0) * std::tan(dilationAngle) / root(dilationAngle);
  }
  return law;
}

namespace
{
/// The law without its table, of the table's first point, and the table.
MohrCoulomb withTable(const LinearElastic& elastic, const MohrCoulombParameters& p)
{
  const std::size_t points = p.shears.size();
  demand(points >= 2 && points <= MohrCoulomb::capacity, "number of plastic shears", Real(points),
         "", fmt::format("2 to {}", MohrCoulomb::capacity));
  demand(p.cohesions.size() == points, "number of cohesions", Real(p.cohesions.size()), "",
         fmt::format("that of the plastic shears, {}", points));
  demand(p.frictions.size() == points, "number of frictions", Real(p.frictions.size()), "",
         fmt::format("that of the plastic shears, {}", points));
  demand(p.shears[0] == 0, "first plastic shear", p.shears[0], "", "0");
  demand(p.shearEnergy == 0, "shear energy", p.shearEnergy, "J/m^2",
         "left out beside a table, which softens cohesion itself");
  MohrCoulombParameters first = p;
  first.shears.clear();
  first.cohesion = first.residualCohesion = p.cohesions[0];
  first.frictionAngle = std::atan(p.frictions[0]);
  MohrCoulomb law = makeMohrCoulomb(elastic, first);
  law.points = int(points);
  for (std::size_t i = 0; i < points; ++i)
  {
    demand(i == 0 || p.shears[i] > p.shears[i - 1], "plastic shear", p.shears[i], "",
           "above the one before");
    demand(p.cohesions[i] >= 0, "cohesion", p.cohesions[i], "Pa", "0 or more");
    demand(p.frictions[i] >= std::tan(p.dilationAngle), "friction", p.frictions[i], "",
           fmt::format("at least the dilation ({:.6g})", std::tan(p.dilationAngle)));
    law.shears[i] = p.shears[i];
    law.cohesions[i] = p.cohesions[i];
    law.frictionTangents[i] = p.frictions[i];
  }
  return law;
}
} // namespace

MohrCoulomb makeMohrCoulomb(const LinearElastic& elastic, const MohrCoulombParameters& p)
{
  if (!p.shears.empty())
    return withTable(elastic, p);
  demand(p.frictionAngle >= 0 && p.frictionAngle < 1.5, "friction angle", p.frictionAngle, "rad",
         "0 or more, and below a right angle");
  demand(p.dilationAngle >= 0 && p.dilationAngle <= p.frictionAngle, "dilation angle",
         p.dilationAngle, "rad",
         fmt::format("0 or more, and at most the friction angle ({:.6g} rad)", p.frictionAngle));
  demand(p.cohesion > 0, "cohesion", p.cohesion, "Pa", "positive");
  demand(p.residualCohesion >= 0 && p.residualCohesion <= p.cohesion, "residual cohesion",
         p.residualCohesion, "Pa",
         fmt::format("0 or more, and at most the cohesion ({:.6g} Pa)", p.cohesion));
  const Real tip = p.frictionAngle > 0 ? p.cohesion / std::tan(p.frictionAngle) : infinity;
  demand(p.tensileStrength >= 0 && p.tensileStrength <= tip, "tensile strength", p.tensileStrength,
         "Pa",
         fmt::format("0 or more, and at most cohesion / tan(friction angle) = {:.6g} Pa, the tip "
                     "of the planes",
                     tip));
  demand(p.shearEnergy >= 0, "shear energy", p.shearEnergy, "J/m^2", "0 (no softening) or more");
  demand(p.fractureEnergy >= 0, "fracture energy", p.fractureEnergy, "J/m^2",
         "0 (no softening) or more");
  const auto slope = [](Real angle) { return (1 + std::sin(angle)) / (1 - std::sin(angle)); };
  MohrCoulomb law{};
  law.elastic = elastic;
  law.friction = slope(p.frictionAngle);
  law.dilation = slope(p.dilationAngle);
  law.cohesion = p.cohesion;
  law.residualCohesion = p.residualCohesion;
  law.tensileStrength = p.tensileStrength;
  law.shearEnergy = p.shearEnergy;
  law.fractureEnergy = p.fractureEnergy;
  return law;
}

HardeningPlasticity makeHardeningPlasticity(const LinearElastic& elastic,
                                            const EquationOfState& eos,
                                            const std::vector<Real>& plasticStrains,
                                            const std::vector<Real>& yieldStresses,
                                            Real kinematicModulus)
{
  HardeningPlasticity law{};
  law.elastic = elastic;
  law.eos = eos;
  law.kinematicModulus = kinematicModulus;
  demand(kinematicModulus >= 0, "kinematic modulus", kinematicModulus, "Pa", "0 or more");
  const std::size_t points = plasticStrains.size();
  demand(points > 0 && points <= HardeningPlasticity::capacity, "number of plastic strains",
         Real(points), "", fmt::format("1 to {}", HardeningPlasticity::capacity));
  demand(yieldStresses.size() == points, "number of yield stresses", Real(yieldStresses.size()), "",
         fmt::format("that of the plastic strains, {}", points));
  demand(plasticStrains[0] == 0, "first plastic strain", plasticStrains[0], "", "0");
  demand(yieldStresses[0] > 0, "first yield stress", yieldStresses[0], "Pa", "positive");
  law.points = int(points);
  for (std::size_t i = 0; i < points; ++i)
  {
    law.plasticStrain[i] = plasticStrains[i];
    law.yieldStress[i] = yieldStresses[i];
    law.slope[i] = 0; // beyond the last point the yield stress stays
    if (i == 0)
      continue;
    demand(plasticStrains[i] > plasticStrains[i - 1], "a plastic strain", plasticStrains[i], "",
           fmt::format("above the one before it, {}", plasticStrains[i - 1]));
    demand(yieldStresses[i] >= yieldStresses[i - 1], "a yield stress", yieldStresses[i], "Pa",
           fmt::format("at least the one before it, {} Pa: softening depends on the mesh and is "
                       "not offered",
                       yieldStresses[i - 1]));
    law.slope[i - 1] =
        (yieldStresses[i] - yieldStresses[i - 1]) / (plasticStrains[i] - plasticStrains[i - 1]);
  }
  return law;
}

JohnsonCook checked(const JohnsonCook& law)
{
  demand(law.strength > 0, "strength A", law.strength, "Pa", "positive");
  demand(law.hardening >= 0, "hardening B", law.hardening, "Pa", "0 or more");
  demand(law.exponent > 0 && law.exponent <= 1, "hardening exponent n", law.exponent, "",
         "above 0 and at most 1");
  demand(law.rateFactor >= 0, "rate factor C", law.rateFactor, "", "0 or more");
  demand(law.thermalExponent > 0, "thermal exponent m", law.thermalExponent, "", "positive");
  demand(law.meltingTemperature == 0 || law.meltingTemperature > law.roomTemperature,
         "melting temperature", law.meltingTemperature, "K",
         fmt::format("above the room temperature, {} K", law.roomTemperature));
  demand(law.heatCapacity > 0, "heat capacity", law.heatCapacity, "J/(kg K)", "positive");
  demand(law.heatFraction >= 0 && law.heatFraction <= 1, "heat fraction", law.heatFraction, "",
         "between 0 and 1");
  return law;
}

Fluid makeIdealGas(Real density, Real ratio, Real pressure)
{
  demand(density > 0, "density", density, "kg/m^3", "positive");
  demand(ratio > 1, "ratio of specific heats", ratio, "", "above 1, e.g. 1.4");
  demand(pressure > 0, "reference pressure", pressure, "Pa",
         "positive: that of the initial stress of its blocks, from which the first sound speed "
         "comes");
  EquationOfState eos;
  eos.kind = EquationOfState::Kind::IdealGas;
  eos.gamma = ratio;
  return {{density, ratio * pressure, 0}, eos};
}

Fluid makeFluid(Real density, const EquationOfState& eos)
{
  demand(density > 0, "density", density, "kg/m^3", "positive");
  demand(eos.stiffness > 0, "bulk modulus", eos.stiffness, "Pa", "positive");
  return {{density, eos.stiffness / eos.distension, 0}, eos};
}

HolmquistJohnsonCook completed(HolmquistJohnsonCook law)
{
  demand(law.strength > 0, "compressive strength", law.strength, "Pa", "positive");
  demand(law.tension > 0 && law.tension < law.strength, "tensile limit", law.tension, "Pa",
         "positive and below the compressive strength");
  demand(law.cohesion > 0, "cohesive strength A", law.cohesion, "", "positive");
  demand(law.pressureFactor >= 0, "pressure factor B", law.pressureFactor, "", "0 or more");
  demand(law.pressureExponent > 0, "pressure exponent N", law.pressureExponent, "", "positive");
  demand(law.rateFactor >= 0, "rate factor C", law.rateFactor, "", "0 or more");
  demand(law.mostStrength > 0, "largest strength Smax", law.mostStrength, "", "positive");
  demand(law.leastFracture > 0, "least fracture strain EFmin", law.leastFracture, "", "positive");
  demand(law.damage1 > 0, "damage constant D1", law.damage1, "", "positive");
  demand(law.crushPressure > 0 && law.crushPressure < law.lockPressure, "crush pressure",
         law.crushPressure, "Pa",
         fmt::format("positive and below the locking pressure, {} Pa", law.lockPressure));
  demand(law.crushCompression > 0 && law.crushCompression < law.lockCompression,
         "compression at crushing", law.crushCompression, "",
         fmt::format("positive and below that of the locked material, {}", law.lockCompression));
  demand(law.locked[0] > 0, "locked modulus K1", law.locked[0], "Pa", "positive");
  law.elastic.bulkModulus = law.crushPressure / law.crushCompression;
  // Where the locked curve reaches the locking pressure.
  const auto lack = [&](Real mu) { return law.lockPressure - law.lockedPressure(mu); };
  const Real low = law.lockCompression, high = low + 1;
  demand(lack(high) < 0, "locking pressure", law.lockPressure, "Pa",
         "reached by the locked curve K1 m + K2 m^2 + K3 m^3");
  law.fullCompression = branchFree::fallingRoot(lack, low, high, lack(low), lack(high),
                                                1e-12 * law.lockPressure, true);
  return law;
}
} // namespace coplane
