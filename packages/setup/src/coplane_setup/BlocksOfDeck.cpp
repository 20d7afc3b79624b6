#include <coplane_core/Error.hpp>
#include <coplane_input/MaterialCards.hpp>
#include <coplane_schema/TimeFunctionEvaluator.hpp>
#include <coplane_setup/Lookups.hpp>
#include <coplane_setup/detail/BlocksOfDeck.hpp>

#include <memory>

namespace coplane
{
ErosionCriteria erosionOf(const ErosionCard& card)
{
  ErosionCriteria erosion;
  erosion.damage = card.damage;
  if (card.plasticStrain)
    erosion.variables.push_back({"equivalent_plastic_strain", *card.plasticStrain});
  for (const ErosionVariableCard& variable : card.variables)
    erosion.variables.push_back(
        {variable.name, variable.above.value_or(infinity), variable.below.value_or(-infinity)});
  if (card.volumeRatio.size() == 2)
    erosion.volumeRatio = {card.volumeRatio[0], card.volumeRatio[1]};
  erosion.stableStep = card.stableStep;
  return erosion;
}

namespace
{
ElementOptions elementOptionsOf(const Deck& deck, const BlockCard& card, const Mesh::Block& block)
{
  ElementOptions options;
  options.form = card.element == "assumed_strain"           ? ElementForm::AssumedStrain
                 : card.element == "full_integration"       ? ElementForm::FullIntegration
                 : card.element == "full_integration_plain" ? ElementForm::FullIntegrationPlain
                 : card.element == "nodal_pressure"         ? ElementForm::NodalPressure
                                                            : ElementForm::OnePoint;
  options.rate = card.objectiveRate == "jaumann"        ? ObjectiveRate::Jaumann
                 : card.objectiveRate == "green_naghdi" ? ObjectiveRate::GreenNaghdi
                                                        : ObjectiveRate::HughesWinget;
  if (deck.geometry == "axisymmetric")
    options.geometry = Geometry::Axisymmetric;
  const ElementTopology& shape = topology(block.type);
  const bool simplex = shape.nodes == shape.dimension + 1;
  const bool forSimplices = options.form == ElementForm::NodalPressure;
  if (options.form != ElementForm::OnePoint && simplex != forSimplices)
    failOnAllRanks(
        ExitCode::Deck,
        "{}: blocks.{}.element = '{}' is for {}, but the block has {}; accepted: one_point{}.",
        card.where, card.name, card.element, forSimplices ? "TRI3 and TETRA4" : "QUAD4 and HEX8",
        shape.exodusName, simplex ? ", nodal_pressure" : ", assumed_strain, full_integration");
  return options;
}

SymTensor tensorOf(const std::array<Real, 6>& s)
{
  return {s[0], s[1], s[2], s[3], s[4], s[5]};
}

void setStart(const InitialCard& card, BlockSetup& setup)
{
  setup.velocity = card.velocity;
  setup.angularVelocity = card.angularVelocity;
  setup.center = card.center;
  if (card.velocityField)
  {
    const auto field = std::make_shared<std::array<PlaceFunctionEvaluator, 3>>(
        std::array{PlaceFunctionEvaluator((*card.velocityField)[0]),
                   PlaceFunctionEvaluator((*card.velocityField)[1]),
                   PlaceFunctionEvaluator((*card.velocityField)[2])});
    setup.velocityField = [field](const Vec3& x) {
      return Vec3{(*field)[0](x), (*field)[1](x), (*field)[2](x)};
    };
  }
  setup.stress = tensorOf(card.stress);
  setup.stressGradient = {tensorOf(card.stressGradient), card.stressPoint,
                          normalised(card.stressAxis)};
}
/// The law with the Maxwell elements that the block asks for.
Material dampedLaw(const Material& law, const BlockCard& card)
{
  const MaxwellCard& damping = card.damping;
  if (!(damping.ratio > 0) || card.rigid)
    return law;
  try
  {
    return withMaxwell(
        law, fitMaxwell(damping.ratio, *damping.low, *damping.high, damping.elements).elements,
        damping.volumetric);
  }
  catch (const Error& error)
  {
    failOnAllRanks(error.code(), "{}: blocks.{}.damping: {}", card.where, card.name, error.what());
  }
}
} // namespace

BlockSetup setupOf(const Deck& deck, const Mesh::Block& block)
{
  const BlockCard& card = cardOf(deck, block);
  BlockSetup setup;
  setup.name = block.name;
  setup.materialName = card.material;
  setup.material = dampedLaw(materialOf(materialCardOf(deck, card)), card);
  setup.hourglass = {card.hourglassStiffness, card.hourglassViscosity};
  setup.element = elementOptionsOf(deck, card, block);
  setup.erosion = erosionOf(card.erosion);
  setup.rigid = card.rigid;
  for (const InitialCard& initial : deck.initial)
    if (initial.block == block.name)
      setStart(initial, setup);
  return setup;
}
} // namespace coplane
