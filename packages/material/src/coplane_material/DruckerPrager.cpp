#include <coplane_material/MaterialModel.hpp>
#include <coplane_material/detail/Demand.hpp>

#include <cmath>

namespace coplane
{
DruckerPrager makeLaw(const DruckerPragerParameters& p)
{
  const Real friction = std::atan(p.friction), dilation = std::atan(p.dilation);
  demand(friction >= 0 && friction < pi / 2, "friction angle", friction, "rad",
         "0 or more, and below a right angle");
  demand(dilation >= 0 && dilation <= friction, "dilation angle", dilation, "rad",
         fmt::format("0 or more, and at most the friction angle ({:.6g} rad)", friction));
  demand(p.cohesion >= 0 && p.cohesion + friction > 0, "cohesion", p.cohesion, "Pa",
         "0 or more; positive without friction");
  DruckerPrager law{makeLaw(static_cast<const ElasticParameters&>(p)), 0, 0, 0};
  if (p.fit == DruckerPragerFit::Compression)
  {
    const auto slope = [](Real angle) { return 6 * std::sin(angle) / (3 - std::sin(angle)); };
    law.strength = 6 * p.cohesion * std::cos(friction) / (3 - std::sin(friction));
    law.frictionSlope = slope(friction);
    law.dilationSlope = slope(dilation);
  }
  else
  {
    const auto root = [](Real angle)
    { return std::sqrt(9 + 12 * std::tan(angle) * std::tan(angle)); };
    law.strength = 3 * std::sqrt(3.0) * p.cohesion / root(friction);
    law.frictionSlope = 3 * std::sqrt(3.0) * std::tan(friction) / root(friction);
    law.dilationSlope = 3 * std::sqrt(3.0) * std::tan(dilation) / root(dilation);
  }
  return law;
}

MaterialModel DruckerPragerParameters::model()
{
  using P = DruckerPragerParameters;
  using namespace schema;
  return MaterialModelOf<P>("drucker_prager", "Drucker and Prager")
      .costs(1.3)
      .has(elasticKeys<P>())
      .has(frictionKeys<P>())
      .has({
          choice("fit", &P::fit,
                 {{"compression", DruckerPragerFit::Compression},
                  {"plane_strain", DruckerPragerFit::PlaneStrain}})
              .like("plane_strain")
              .means("the cone touches Mohr and Coulomb's planes in triaxial compression, or has "
                     "their limit in plane strain"),
      });
}
} // namespace coplane
