#include <coplane_material/MaterialModel.hpp>
#include <coplane_material/detail/Demand.hpp>

#include <cmath>

namespace coplane
{
namespace
{
/// The law without its table, of the table's first point, and the table.
MohrCoulomb withTable(const MohrCoulombParameters& p)
{
  const std::size_t points = p.plasticShears.size();
  demand(points >= 2 && points <= MohrCoulomb::capacity, "number of plastic shears", Real(points),
         "", fmt::format("2 to {}", MohrCoulomb::capacity));
  demand(p.cohesions.size() == points, "number of cohesions", Real(p.cohesions.size()), "",
         fmt::format("that of the plastic shears, {}", points));
  demand(p.frictions.size() == points, "number of frictions", Real(p.frictions.size()), "",
         fmt::format("that of the plastic shears, {}", points));
  demand(p.plasticShears[0] == 0, "first plastic shear", p.plasticShears[0], "", "0");
  demand(p.shearEnergy == 0, "shear energy", p.shearEnergy, "J/m^2",
         "left out beside a table, which softens cohesion itself");
  MohrCoulombParameters first = p;
  first.plasticShears.clear();
  first.cohesion = first.residualCohesion = p.cohesions[0];
  first.friction = p.frictions[0];
  MohrCoulomb law = makeLaw(first);
  law.points = int(points);
  for (std::size_t i = 0; i < points; ++i)
  {
    demand(i == 0 || p.plasticShears[i] > p.plasticShears[i - 1], "plastic shear",
           p.plasticShears[i], "", "above the one before");
    demand(p.cohesions[i] >= 0, "cohesion", p.cohesions[i], "Pa", "0 or more");
    demand(p.frictions[i] >= p.dilation && p.frictions[i] <= 14, "friction", p.frictions[i], "",
           fmt::format("at least the dilation ({:.6g}), and at most 14", p.dilation));
    law.shears[i] = p.plasticShears[i];
    law.cohesions[i] = p.cohesions[i];
    law.frictionTangents[i] = p.frictions[i];
  }
  return law;
}
} // namespace

MohrCoulomb makeLaw(const MohrCoulombParameters& p)
{
  if (!p.plasticShears.empty())
    return withTable(p);
  demand(p.friction >= 0 && p.friction <= 14, "friction", p.friction, "",
         "0 or more, and at most 14 (86 degrees)");
  demand(p.dilation >= 0 && p.dilation <= p.friction, "dilation", p.dilation, "",
         fmt::format("0 or more, and at most the friction ({:.6g})", p.friction));
  demand(p.cohesion > 0, "cohesion", p.cohesion, "Pa", "positive");
  demand(p.residualCohesion >= 0 && p.residualCohesion <= p.cohesion, "residual cohesion",
         p.residualCohesion, "Pa",
         fmt::format("0 or more, and at most the cohesion ({:.6g} Pa)", p.cohesion));
  const Real tip = p.friction > 0 ? p.cohesion / p.friction : infinity;
  demand(p.tensileStrength >= 0 && p.tensileStrength <= tip, "tensile strength", p.tensileStrength,
         "Pa",
         fmt::format(
             "0 or more, and at most cohesion / friction = {:.6g} Pa, the tip of the planes", tip));
  demand(p.shearEnergy >= 0, "shear energy", p.shearEnergy, "J/m^2", "0 (no softening) or more");
  demand(p.fractureEnergy >= 0, "fracture energy", p.fractureEnergy, "J/m^2",
         "0 (no softening) or more");
  const auto slope = [](Real tangent)
  {
    const Real angle = std::atan(tangent);
    return (1 + std::sin(angle)) / (1 - std::sin(angle));
  };
  MohrCoulomb law{};
  law.elastic = makeLaw(static_cast<const ElasticParameters&>(p));
  law.friction = slope(p.friction);
  law.dilation = slope(p.dilation);
  law.cohesion = p.cohesion;
  law.residualCohesion = p.residualCohesion;
  law.tensileStrength = p.tensileStrength;
  law.shearEnergy = p.shearEnergy;
  law.fractureEnergy = p.fractureEnergy;
  return law;
}

void checkTable(const MohrCoulombParameters& p, const CardPlace& card)
{
  const bool table = !p.plasticShears.empty() || !p.cohesions.empty() || !p.frictions.empty();
  for (const char* key : {"cohesion", "friction", "residual_cohesion", "shear_energy"})
    if (table && card.gives(key))
      card.problem(key, "has no effect beside a table (plastic_shears, cohesions, frictions); "
                        "remove it.");
  if (table && p.plasticShears.empty())
    card.problem("plastic_shears", "is missing; accepted: 2 to 8 numbers that rise from 0, one for "
                                   "each of cohesions and frictions.");
}

MaterialModel MohrCoulombParameters::model()
{
  using P = MohrCoulombParameters;
  using namespace schema;
  return MaterialModelOf<P>("mohr_coulomb", "Mohr and Coulomb")
      .elsewhere({"mohr"})
      .costs(3)
      .has(elasticKeys<P>())
      .has(frictionKeys<P>())
      .has(mohrCoulombKeys<P>())
      .demands(checkTable)
      .softensUpTo(elementThatCracks)
      .comesAs(R"(
clay_brick: {model: mohr_coulomb, density: 1800, youngs_modulus: 10e9, poisson_ratio: 0.15,
             cohesion: 4.66e6, friction: 0.84, dilation: 0.18, tensile_strength: 2e6,
             fracture_energy: 60, shear_energy: 600}
)");
}
} // namespace coplane
