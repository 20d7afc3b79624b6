#include <coplane_material/MaterialModel.hpp>
#include <coplane_material/detail/Demand.hpp>

#include <cmath>

namespace coplane
{
J2Plasticity makeJ2Plasticity(const LinearElastic& elastic, Real yieldStress, Real hardeningModulus)
{
  if (!(yieldStress > 0))
    fail(ExitCode::Deck,
         "material: yield stress is {} Pa, but must be positive. Use the model linear_elastic for "
         "a material that does not yield.",
         yieldStress);
  if (!(hardeningModulus >= 0) || !std::isfinite(hardeningModulus))
    fail(ExitCode::Deck,
         "material: hardening modulus is {} Pa, but must not be negative. Softening depends on the "
         "mesh and is not offered; use 0 for perfect plasticity.",
         hardeningModulus);
  return {elastic, yieldStress, hardeningModulus};
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

Material makeLaw(const J2Parameters& p)
{
  const LinearElastic elastic = makeLaw(static_cast<const ElasticParameters&>(p));
  if (p.yieldStresses.empty() && p.kinematicModulus == 0 && p.eos == EquationOfState::Kind::None)
    return makeJ2Plasticity(elastic, p.yieldStress, p.hardeningModulus);
  const EquationOfState eos = equationOfState(p, p.density, elastic.bulkModulus);
  std::vector<Real> strains = p.plasticStrains, stresses = p.yieldStresses;
  if (stresses.empty())
  {
    strains = {0, 1000}; // a straight line as far as any strain goes
    stresses = {p.yieldStress, p.yieldStress + 1000 * p.hardeningModulus};
  }
  return makeHardeningPlasticity(withPressureOf(eos, elastic), eos, strains, stresses,
                                 p.kinematicModulus);
}

namespace
{
void checkJ2(const J2Parameters& p, const CardPlace& card)
{
  const bool table = card.gives("yield_stresses") || card.gives("plastic_strains");
  if (table == card.gives("yield_stress"))
    card.problems.add(card.node,
                      fmt::format("{}.yield_stress {}; accepted: either yield_stress (with "
                                  "hardening_modulus) or a table, plastic_strains and "
                                  "yield_stresses.",
                                  card.path, table ? "stands beside a table" : "is missing"));
  else if (table && card.gives("hardening_modulus"))
    card.problem("hardening_modulus", "has no effect beside a table; remove it.");
  checkEquationOfState(p, card);
}
} // namespace

MaterialModel J2Parameters::model()
{
  using P = J2Parameters;
  using namespace schema;
  return MaterialModelOf<P>("j2", "von Mises with hardening")
      .elsewhere({"von_mises", "mises", "plastic", "plastic_kinematic", "elastoplastic"})
      .has(elasticKeys<P>())
      .has({
          number("yield_stress", &P::yieldStress)
              .in("Pa")
              .usually(usual::strength)
              .elsewhere({"sigy", "yield", "sy", "yield_strength"})
              .above(0)
              .defaultIs("none")
              .like("1e9")
              .means("uniaxial stress at first yield; or a table"),
          number("hardening_modulus", &P::hardeningModulus)
              .in("Pa")
              .atLeast(0)
              .like("1e9")
              .means("slope of the yield stress over equivalent plastic strain"),
          numbers("plastic_strains", &P::plasticStrains)
              .in("-")
              .atLeast(0)
              .like("[0, 0.01, 0.1]")
              .means("equivalent plastic strains of a table, rising from 0; at most 16"),
          numbers("yield_stresses", &P::yieldStresses)
              .in("Pa")
              .usually(usual::strength)
              .above(0)
              .like("[300e6, 340e6, 400e6]")
              .means("yield stresses at plastic_strains, not falling; the last one stays beyond "
                     "the table"),
          number("kinematic_modulus", &P::kinematicModulus)
              .in("Pa")
              .atLeast(0)
              .like("2e9")
              .means("uniaxial back stress over plastic strain (Prager)"),
      })
      .has(equationOfStateKeys<P>())
      .demands(checkJ2)
      .comesAs(R"(
steel_generic: {model: j2, density: 7850, youngs_modulus: 200e9, poisson_ratio: 0.3,
                yield_stress: 1e9, hardening_modulus: 1e9}
)");
}
} // namespace coplane
