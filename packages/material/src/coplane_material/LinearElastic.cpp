#include <coplane_core/Error.hpp>
#include <coplane_material/MaterialModel.hpp>

#include <cmath>

namespace coplane
{
LinearElastic makeLaw(const ElasticParameters& parameters)
{
  const auto& [density, youngsModulus, poissonRatio] = parameters;
  if (!(youngsModulus > 0) || !std::isfinite(youngsModulus))
    fail(ExitCode::Deck,
         "material: Young's modulus is {} Pa, but must be positive. Give E in pascals, e.g. 200e9.",
         youngsModulus);
  if (!(poissonRatio > -1 && poissonRatio < 0.5))
    fail(ExitCode::Deck,
         "material: Poisson's ratio is {}, but must lie between -1 and 0.5 (0.5 would be "
         "incompressible). Use 0.49 at most for nearly incompressible solids.",
         poissonRatio);
  if (!(density > 0) || !std::isfinite(density))
    fail(ExitCode::Deck,
         "material: density is {} kg/m^3, but must be positive. Give it in SI units, e.g. 7850.",
         density);
  return {density, youngsModulus / (3 * (1 - 2 * poissonRatio)),
          youngsModulus / (2 * (1 + poissonRatio))};
}

LinearElastic makeLinearElastic(Real youngsModulus, Real poissonRatio, Real density)
{
  return makeLaw(ElasticParameters{density, youngsModulus, poissonRatio});
}

MaterialModel LinearElasticParameters::model()
{
  return MaterialModelOf<LinearElasticParameters>("linear_elastic", "Hooke")
      .elsewhere({"elastic", "mat_elastic", "hooke"})
      .has(schema::elasticKeys<LinearElasticParameters>())
      .comesAs(R"(
granite: {model: linear_elastic, density: 2650, youngs_modulus: 60e9, poisson_ratio: 0.25}
)");
}
} // namespace coplane
