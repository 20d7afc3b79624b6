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
               JohnsonHolmquistParameters, KaragozianCaseParameters, FluidParameters,
               IdealGasParameters, JwlParameters>();
  return models;
}
} // namespace coplane
