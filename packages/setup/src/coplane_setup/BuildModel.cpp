#include <coplane_dynamics/RigidBodies.hpp>
#include <coplane_input/DeckChecks.hpp>
#include <coplane_setup/BuildModel.hpp>
#include <coplane_setup/ConditionsOfDeck.hpp>
#include <coplane_setup/Lookups.hpp>
#include <coplane_setup/detail/BlocksOfDeck.hpp>
#include <coplane_setup/detail/ContactRulesOfDeck.hpp>
#include <coplane_setup/detail/LastChange.hpp>
#include <coplane_setup/detail/LinesOfDeck.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
using Forces = ContactOptions::Forces;
static_assert(ContactCard::cosOpposedOfPotential ==
                      ContactOptions::usualCosOpposed(Forces::Potential) &&
                  ContactCard::cosOpposedOfCommonNormal ==
                      ContactOptions::usualCosOpposed(Forces::CommonNormal),
              "what the reference of decks says of cos_opposed is what contact takes");

ContactOptions optionsOf(const Deck& deck)
{
  const ContactCard& card = deck.contact;
  const bool potential = card.forces != "common_normal" && commonNormalBecauseOf(deck).empty();
  ContactOptions options =
      ContactOptions::with(potential ? Forces::Potential : Forces::CommonNormal);
  options.area =
      card.area == "full" ? ContactOptions::Area::Full : ContactOptions::Area::Penetrating;
  options.weights = card.weights == "centroid"  ? ContactOptions::Weights::Centroid
                    : card.weights == "average" ? ContactOptions::Weights::Average
                                                : ContactOptions::Weights::Pressure;
  options.closure = card.closure == "incremental" ? ContactOptions::Closure::Incremental
                                                  : ContactOptions::Closure::Total;
  options.couple = card.couple;
  options.areaRule = card.areaRule;
  options.inherit = card.inherit;
  options.sharedNodes = card.shareNode == "allow";
  options.cosOpposed = card.cosOpposed.value_or(options.cosOpposed);
  options.depthMax = card.depthMax;
  options.areaMin = card.areaMin;
  options.followsPath = card.impulses == "path";
  options.dampNormal = card.dampNormal;
  options.dampShear = card.dampShear;
  return options;
}

std::vector<int> blocksNamed(const Mesh& mesh, const std::vector<std::string>& names)
{
  std::vector<int> blocks;
  for (const std::string& name : names)
    blocks.push_back(indexOf(mesh.blocks, name));
  return blocks;
}
} // namespace

Model buildModel(const Deck& deck, const MeshSlice& slice, RankMesh part, const Comm& comm)
{
  const Mesh& mesh = slice.mine; // names and shapes of blocks and sets
  Model model;
  std::vector<char> rigidBlocks;
  for (const Mesh::Block& block : mesh.blocks)
  {
    model.blocks.push_back(setupOf(deck, block));
    rigidBlocks.push_back(model.blocks.back().rigid);
  }
  if (std::count(rigidBlocks.begin(), rigidBlocks.end(), 1) > 0)
    model.rigidBodyOfNode = rigidBodiesOf(part, rigidBlocks, comm);
  model.conditions = conditionsOf(deck, mesh, part, model.blocks);
  if (model.conditions.relaxation.looksForRest())
    findLastChange(deck, mesh, part, comm, model.conditions);
  model.lines = linesOf(deck);
  model.viscosity = {deck.viscosityLinear, deck.viscosityQuadratic};
  model.contactEnabled = deck.contact.enabled;
  model.stopWhereContactIsLost = deck.contact.lostContact == "stop";
  model.contact = optionsOf(deck);
  if (deck.geometry == "axisymmetric")
  {
    revolve(part, deck, comm, model.conditions);
    model.contact.axisymmetric = true;
  }
  model.inStages = deck.stages.size() > 1;
  model.blocksComeOrGo = std::any_of(deck.stages.begin(), deck.stages.end(),
                                     [](const StageCard& stage)
                                     { return !stage.remove.empty() || !stage.add.empty(); });
  model.absentBlocks = blocksNamed(mesh, absentAtStart(deck));
  model.mesh = std::move(part);
  addContactRules(deck, mesh, comm, model);
  model.debris = deck.contact.debris == "points";
  model.skin = deck.contact.skin;
  model.searchEvery = deck.contact.searchEvery;
  model.time.end = deck.time.end;
  model.time.stepFactor = deck.time.stepFactor;
  model.time.maximumStep = deck.time.maximumStep;
  model.time.fixedStep = deck.time.fixedStep;
  if (deck.time.scaledStep)
    model.time.massScaling = MassScalingOptions{*deck.time.scaledStep, deck.time.scalingLimit};
  model.time.subcyclingLevels = deck.time.subcyclingLevels;
  model.time.endAtRest = deck.time.endAtRest;
  model.time.energyTolerance = deck.time.energyTolerance;
  model.time.contactGainTolerance = deck.time.contactGainTolerance;
  return model;
}

Stage stageOf(const Deck& deck, int index, const MeshSlice& mesh, RankMesh part, const Comm& comm)
{
  const StageCard& card = deck.stages[std::size_t(index)];
  Stage stage;
  stage.index = index;
  stage.model = buildModel(deck, mesh, std::move(part), comm);
  stage.remove = blocksNamed(mesh.mine, card.remove);
  stage.add = blocksNamed(mesh.mine, card.add);
  stage.zeroDisplacements = card.zeroDisplacements;
  return stage;
}
} // namespace coplane
