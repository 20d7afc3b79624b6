#include <coplane_core/Error.hpp>
#include <coplane_material/MaterialModel.hpp>

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

NeoHookean makeLaw(const NeoHookeanParameters& parameters)
{
  return {makeLaw(static_cast<const ElasticParameters&>(parameters))};
}

MaterialModel NeoHookeanParameters::model()
{
  return MaterialModelOf<NeoHookeanParameters>("neo_hookean", "rubber")
      .elsewhere({"hyperelastic"})
      .costs(1.4)
      .has(schema::elasticKeys<NeoHookeanParameters>());
}
} // namespace coplane
