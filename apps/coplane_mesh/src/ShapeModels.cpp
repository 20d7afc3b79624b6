#include "ShapeModel.hpp"

namespace coplane
{
const std::vector<ShapeModel>& shapeModels()
{
  static const std::vector<ShapeModel> models{
      boxModel(),    quadrilateralModel(), hexahedronModel(), wallModel(),       imbricateModel(),
      rockModel(),   cylinderModel(),      sphereModel(),     projectileModel(), ogiveModel(),
      sectorModel(), domeModel(),          crossVaultModel(), halfDiscModel()};
  return models;
}

std::vector<Vec3> toPoints(const std::vector<std::vector<Real>>& points)
{
  std::vector<Vec3> vectors;
  for (const auto& point : points)
    vectors.push_back(toVec3(point));
  return vectors;
}

void demandEven(const CardPlace& place, const std::string& key, int count, const std::string& why)
{
  if (count % 2 != 0)
    place.problem(key, fmt::format("has {} {}; it must be even.", count, why));
}
} // namespace coplane
