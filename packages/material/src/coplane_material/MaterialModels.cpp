#include <coplane_material/MaterialModel.hpp>

namespace coplane
{
namespace
{
template <class... Parameters>
std::vector<MaterialModel> modelsOf()
{
  return {Parameters::model()...};
}
} // namespace

const std::vector<MaterialModel>& materialModels()
{
  static const auto models =
      modelsOf<LinearElasticParameters, J2Parameters, NeoHookeanParameters, DruckerPragerParameters,
               MohrCoulombParameters, UbiquitousJointParameters, HoekBrownParameters,
               JohnsonCookParameters, PseudoCapParameters, HolmquistJohnsonCookParameters,
               FluidParameters, IdealGasParameters>();
  return models;
}

const MaterialModel* findMaterialModel(const std::string& name)
{
  for (const MaterialModel& model : materialModels())
    if (model.name == name)
      return &model;
  return nullptr;
}

void CardPlace::problem(const std::string& key, const std::string& text) const
{
  const DeckNode* const given = node.find(key);
  problems.add(given ? *given : node, path + "." + key + " " + text);
}
} // namespace coplane
