#include "MaterialCards.hpp"

#include <coplane_core/Error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
LinearElastic elasticOf(const MaterialCard& card)
{
  return makeLinearElastic(card.youngsModulus, card.poissonRatio, card.density);
}

EquationOfState eosOf(const MaterialCard& card)
{
  EquationOfState eos;
  if (card.eos == "none")
    return eos;
  if (card.eos == "linear" && card.model != "fluid")
  {
    eos.kind = EquationOfState::Kind::Linear;
    eos.stiffness = elasticOf(card).bulkModulus;
    return eos;
  }
  const auto demand = [&](bool good, const char* key, Real value, const char* accepted)
  {
    if (!good)
      fail(ExitCode::Deck, "material: {} is {}, but eos: {} needs {}.", key, value, card.eos,
           accepted);
  };
  demand(card.soundSpeed > 0, "sound_speed", card.soundSpeed, "a positive one [m/s]");
  const bool porous = card.eos == "p_alpha";
  eos.kind = porous                 ? EquationOfState::Kind::PAlpha
             : card.eos == "linear" ? EquationOfState::Kind::Linear
                                    : EquationOfState::Kind::MieGrueneisen;
  eos.slope = card.shockSlope;
  eos.gamma = card.grueneisen;
  if (porous)
  {
    demand(card.distension > 1, "distension", card.distension, "one above 1");
    demand(card.crushStart > 0, "crush_start", card.crushStart, "a positive one [Pa]");
    demand(card.crushEnd > card.crushStart, "crush_end", card.crushEnd, "one above crush_start");
    eos.distension = card.distension;
    eos.crushStart = card.crushStart;
    eos.crushEnd = card.crushEnd;
  }
  eos.stiffness = card.density * eos.distension * card.soundSpeed * card.soundSpeed;
  return eos;
}

/// The elastic constants with the bulk modulus of the equation of state.
LinearElastic elasticWith(const EquationOfState& eos, const MaterialCard& card)
{
  LinearElastic elastic = elasticOf(card);
  if (eos.kind != EquationOfState::Kind::None)
    elastic.bulkModulus = eos.stiffness / eos.distension;
  return elastic;
}

Material j2Of(const MaterialCard& card)
{
  if (card.yieldStresses.empty() && card.kinematicModulus == 0 && card.eos == "none")
    return makeJ2Plasticity(card.youngsModulus, card.poissonRatio, card.density, card.yieldStress,
                            card.hardeningModulus);
  const EquationOfState eos = eosOf(card);
  std::vector<Real> strains = card.plasticStrains, stresses = card.yieldStresses;
  if (stresses.empty())
  {
    strains = {0, 1000}; // a straight line as far as any strain goes
    stresses = {card.yieldStress, card.yieldStress + 1000 * card.hardeningModulus};
  }
  return makeHardeningPlasticity(elasticWith(eos, card), eos, strains, stresses,
                                 card.kinematicModulus);
}

Material johnsonCookOf(const MaterialCard& card)
{
  JohnsonCook law{};
  law.eos = eosOf(card);
  law.elastic = elasticWith(law.eos, card);
  law.strength = card.yieldStress;
  law.hardening = card.hardeningModulus;
  law.exponent = card.hardeningExponent;
  law.rateFactor = card.rateFactor;
  law.thermalExponent = card.thermalExponent;
  law.meltingTemperature = card.meltingTemperature;
  law.roomTemperature = card.roomTemperature;
  law.heatCapacity = card.heatCapacity;
  law.heatFraction = card.heatFraction;
  std::copy(card.fracture.begin(), card.fracture.end(), law.damage);
  return checked(law);
}

Material hjcOf(const MaterialCard& card)
{
  HolmquistJohnsonCook law{};
  law.elastic = {card.density, 0, card.shearModulus};
  law.strength = card.compressiveStrength;
  law.cohesion = card.cohesiveFactor;
  law.pressureFactor = card.pressureFactor;
  law.pressureExponent = card.pressureExponent;
  law.rateFactor = card.rateFactor;
  law.mostStrength = card.largestStrength;
  law.tension = card.tensileStrength;
  law.leastFracture = card.leastFractureStrain;
  law.damage1 = card.damageFactor;
  law.damage2 = card.damageExponent;
  law.crushPressure = card.crushPressure;
  law.crushCompression = card.crushCompression;
  law.lockPressure = card.lockPressure;
  law.lockCompression = card.lockCompression;
  std::copy(card.lockModuli.begin(), card.lockModuli.end(), law.locked);
  return completed(law);
}
} // namespace

Material materialOf(const MaterialCard& card)
{
  if (card.model == "j2")
    return j2Of(card);
  if (card.model == "neo_hookean")
    return NeoHookean{elasticOf(card)};
  if (card.model == "drucker_prager")
    return makeDruckerPrager(
        elasticOf(card), std::atan(card.friction), std::atan(card.dilation), card.cohesion,
        card.fit == "plane_strain" ? DruckerPragerFit::PlaneStrain : DruckerPragerFit::Compression);
  if (card.model == "mohr_coulomb")
    return makeMohrCoulomb(
        elasticOf(card), {std::atan(card.friction), std::atan(card.dilation), card.cohesion,
                          card.residualCohesion, card.tensileStrength, card.shearEnergy,
                          card.fractureEnergy, card.plasticShears, card.cohesions, card.frictions});
  if (card.model == "johnson_cook")
    return johnsonCookOf(card);
  if (card.model == "pseudo_cap")
    return makePseudoCap({card.density, card.youngsModulus, card.poissonRatio,
                          card.compressiveStrength, card.tensileStrength, card.fractureEnergy,
                          card.porosity, card.grainModulus, card.grainSlope, card.crushPressure,
                          card.crushHardening, card.capRatio, card.shearCompaction,
                          card.rateEffects ? card.largestRate : 0});
  if (card.model == "hjc")
    return hjcOf(card);
  if (card.model == "fluid")
    return makeFluid(card.density, eosOf(card));
  if (card.model == "ideal_gas")
    return makeIdealGas(card.density, card.heatRatio, card.pressure);
  return elasticOf(card);
}

void checkMaterials(const std::vector<MaterialCard>& materials, const DeckNode& root,
                    Problems& problems)
{
  for (const MaterialCard& card : materials)
  {
    const DeckNode& node = nodeAt(root, {"materials", card.name});
    const std::string path = "materials." + card.name;
    if (!problems.empty() && card.model.empty())
      continue; // reported where it was read
    if (card.model == "j2")
    {
      const bool table = node.find("yield_stresses") || node.find("plastic_strains");
      if (table == (node.find("yield_stress") != nullptr))
      {
        problems.add(node, fmt::format("{}.yield_stress {}; accepted: either yield_stress (with "
                                       "hardening_modulus) or a table, plastic_strains and "
                                       "yield_stresses.",
                                       path, table ? "stands beside a table" : "is missing"));
        continue;
      }
      if (table && node.find("hardening_modulus"))
        problems.add(
            *node.find("hardening_modulus"),
            fmt::format("{}.hardening_modulus has no effect beside a table; remove it.", path));
    }
    if (const DeckNode* given = node.find("largest_rate");
        given && card.model == "pseudo_cap" && !card.rateEffects)
      problems.add(*given, path + ".largest_rate has no effect without rate_effects: true; remove "
                                  "it or add that.");
    if (card.model == "fluid" && card.eos == "none")
    {
      problems.add(node, path +
                             ".eos is missing; a fluid has nothing else. Accepted: one of linear, "
                             "mie_grueneisen, p_alpha, with sound_speed.");
      continue;
    }
    if (card.model == "mohr_coulomb")
    {
      const bool table =
          !card.plasticShears.empty() || !card.cohesions.empty() || !card.frictions.empty();
      for (const char* key : {"cohesion", "friction", "residual_cohesion", "shear_energy"})
        if (const DeckNode* given = node.find(key); given && table)
          problems.add(*given, fmt::format("{}.{} has no effect beside a table (plastic_shears, "
                                           "cohesions, frictions); remove it.",
                                           path, key));
      if (table && card.plasticShears.empty())
        problems.add(node, path + ".plastic_shears is missing; accepted: 2 to 8 numbers that rise "
                                  "from 0, one for each of cohesions and frictions.");
    }
    if (card.eos != "mie_grueneisen" && card.eos != "p_alpha")
      for (const char* key : {"sound_speed", "shock_slope", "grueneisen"})
        if (const DeckNode* given = node.find(key);
            given && !(card.model == "fluid" && std::string(key) == "sound_speed"))
          problems.add(*given, fmt::format("{}.{} has no effect with eos: {}; remove it or choose "
                                           "mie_grueneisen or p_alpha.",
                                           path, key, card.eos));
    if (card.eos != "p_alpha")
      for (const char* key : {"distension", "crush_start", "crush_end"})
        if (const DeckNode* given = node.find(key))
          problems.add(*given, fmt::format("{}.{} has no effect with eos: {}; remove it or choose "
                                           "p_alpha.",
                                           path, key, card.eos));
    if (!problems.empty())
      continue; // a law is only made of values that were accepted
    try
    {
      materialOf(card);
    }
    catch (const Error& error)
    {
      std::string text = error.what();
      if (text.rfind("material: ", 0) == 0)
        text = text.substr(10);
      problems.add(node, path + ": " + text);
    }
  }
}

Real largestElement(const MaterialCard& card)
{
  const bool softens = card.fractureEnergy > 0 && card.tensileStrength > 0 &&
                       (card.model == "pseudo_cap" || card.model == "mohr_coulomb");
  return softens ? card.fractureEnergy * card.youngsModulus /
                       (card.tensileStrength * card.tensileStrength)
                 : infinity;
}
} // namespace coplane
