#include "BuildModel.hpp"

#include <coplane_input/DeckChecks.hpp>
#include <coplane_input/JointCards.hpp>
#include <coplane_input/TimeFunctionEvaluator.hpp>

#include <algorithm>
#include <map>
#include <memory>
#include <set>

namespace coplane
{
namespace
{
Material materialOf(const MaterialCard& card)
{
  if (card.model == "j2")
    return makeJ2Plasticity(card.youngsModulus, card.poissonRatio, card.density, card.yieldStress,
                            card.hardeningModulus);
  return makeLinearElastic(card.youngsModulus, card.poissonRatio, card.density);
}

ContactOptions optionsOf(const ContactCard& card)
{
  ContactOptions options;
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
  options.cosOpposed = card.cosOpposed;
  options.depthMax = card.depthMax;
  options.areaMin = card.areaMin;
  options.dampNormal = card.dampNormal;
  options.dampShear = card.dampShear;
  return options;
}

/// Fills the table of rules and the groups of faces. Side sets that contact.pairs names split the
/// faces of a block into groups; all ranks find the same ones, because they look at the whole mesh.
void addContactRules(const Deck& deck, const Mesh& mesh, Model& model)
{
  ContactRules& rules = model.contactRules;
  JointRecipe builtIn;
  builtIn.name = "penalty (built in)";
  rules.joints.push_back(builtIn);
  const auto jointIndex = [&](const std::string& name)
  {
    const auto found = std::find_if(rules.joints.begin(), rules.joints.end(),
                                    [&](const JointRecipe& recipe) { return recipe.name == name; });
    return int(found - rules.joints.begin());
  };
  for (const JointCard& card : deck.joints)
    rules.joints.push_back({card.name, jointLawOf(card)});

  std::vector<ContactTraits> groups;
  for (const Mesh::Block& block : mesh.blocks)
  {
    const auto card = std::find_if(deck.blocks.begin(), deck.blocks.end(),
                                   [&](const BlockCard& b) { return b.name == block.name; });
    groups.push_back({block.name, card->material, {}});
  }
  std::set<std::string> named;
  for (const ContactPairCard& pair : deck.contact.pairs)
    named.insert({pair.sideSets[0], pair.sideSets[1], pair.jointSet});
  std::map<GlobalId, std::pair<int, std::vector<std::string>>> setsOfFace; // block, side sets
  for (const Mesh::SideSet& set : mesh.sideSets)
  {
    if (named.count(set.name) == 0)
      continue;
    for (std::size_t i = 0; i < set.elements.size(); ++i)
    {
      int block = 0, element = set.elements[i];
      for (; element >= mesh.blocks[block].elements(); ++block)
        element -= mesh.blocks[block].elements();
      auto& face = setsOfFace[faceId(mesh.blocks[block].elementIds[element], set.sides[i])];
      face.first = block;
      face.second.push_back(set.name);
    }
  }
  std::map<std::pair<int, std::vector<std::string>>, int> groupOf;
  for (const auto& [id, sets] : setsOfFace)
  {
    const auto [place, isNew] = groupOf.emplace(sets, int(groups.size()));
    if (isNew)
    {
      ContactTraits traits = groups[sets.first];
      traits.sideSets = sets.second;
      groups.push_back(traits);
    }
    model.faceGroups.emplace_back(id, place->second);
  }

  rules.groups = int(groups.size());
  ContactRule general;
  general.joint = deck.contact.defaultJoint.empty() ? 0 : jointIndex(deck.contact.defaultJoint);
  rules.table.assign(std::size_t(rules.groups) * rules.groups, general);
  for (int a = 0; a < rules.groups; ++a)
    for (int b = 0; b < rules.groups; ++b)
      if (const ContactPairCard* card = contactPairFor(deck.contact, groups[a], groups[b]))
      {
        ContactRule& rule = rules.table[a * rules.groups + b];
        if (!card->joint.empty())
          rule.joint = jointIndex(card->joint);
        rule.declared = card->declared;
        rule.excluded = card->excluded;
      }
}

OfTime functionOf(const TimeFunction& card)
{
  if (card.expression.empty())
    return [value = card.constant](Real) { return value; };
  const auto evaluator = std::make_shared<TimeFunctionEvaluator>(card);
  return [evaluator](Real t) { return (*evaluator)(t); };
}

template <class Sets>
int indexOf(const Sets& sets, const std::string& name)
{
  for (int i = 0; i < int(sets.size()); ++i)
    if (sets[i].name == name)
      return i;
  return -1;
}

Conditions conditionsOf(const Deck& deck, const Mesh& mesh, const RankMesh& part)
{
  Conditions conditions;
  conditions.gravity = deck.gravity;
  conditions.massDamping = deck.massDamping;
  if (deck.massDampingUntil)
    conditions.massDampingUntil = *deck.massDampingUntil;
  for (const ConditionCard& card : deck.conditions)
  {
    if (card.type == "pressure")
    {
      FacePressure load;
      load.pressure = functionOf(card.pressure);
      for (const RankMesh::Side& side : part.sideSets[indexOf(mesh.sideSets, card.set)])
      {
        const RankMesh::Block& block = part.blocks[side.block];
        const ElementTopology& shape = topology(block.type);
        FacePressure::Side face;
        face.id = faceId(block.elementIds[side.element], side.side);
        face.count = shape.nodesPerSide;
        face.nodes = {-1, -1, -1, -1};
        for (int k = 0; k < face.count; ++k)
          face.nodes[k] =
              block.connectivity[side.element * shape.nodes + shape.sideNodes[side.side][k]];
        load.sides.push_back(face);
      }
      std::sort(load.sides.begin(), load.sides.end(),
                [](const auto& a, const auto& b) { return a.id < b.id; });
      conditions.pressures.push_back(std::move(load));
      continue;
    }
    const std::vector<int>& nodes = part.nodeSets[indexOf(mesh.nodeSets, card.set)];
    if (card.type == "symmetry")
      conditions.symmetries.push_back({nodes, normalised(card.normal)});
    else
    {
      PrescribedVelocity condition;
      condition.nodes = nodes;
      condition.components = card.components;
      if (card.type == "velocity")
        for (int c = 0; c < 3; ++c)
          condition.velocity[c] = functionOf(card.velocity[c]);
      conditions.velocities.push_back(std::move(condition));
    }
  }
  return conditions;
}
} // namespace

Model buildModel(const Deck& deck, const Mesh& mesh, RankMesh part)
{
  Model model;
  model.conditions = conditionsOf(deck, mesh, part);
  for (const Mesh::Block& block : mesh.blocks)
  {
    const auto card = std::find_if(deck.blocks.begin(), deck.blocks.end(),
                                   [&](const BlockCard& b) { return b.name == block.name; });
    const auto material =
        std::find_if(deck.materials.begin(), deck.materials.end(),
                     [&](const MaterialCard& m) { return m.name == card->material; });
    BlockSetup setup;
    setup.name = block.name;
    setup.material = materialOf(*material);
    setup.hourglass = {card->hourglassStiffness, card->hourglassViscosity};
    for (const InitialCard& initial : deck.initial)
      if (initial.block == block.name)
      {
        setup.velocity = initial.velocity;
        setup.angularVelocity = initial.angularVelocity;
        setup.center = initial.center;
        const auto& s = initial.stress;
        setup.stress = {s[0], s[1], s[2], s[3], s[4], s[5]};
      }
    model.blocks.push_back(std::move(setup));
  }
  model.viscosity = {deck.viscosityLinear, deck.viscosityQuadratic};
  model.contactEnabled = deck.contact.enabled;
  model.contact = optionsOf(deck.contact);
  addContactRules(deck, mesh, model);
  model.skin = deck.contact.skin;
  model.searchEvery = deck.contact.searchEvery;
  model.time.end = deck.time.end;
  model.time.stepFactor = deck.time.stepFactor;
  model.time.maximumStep = deck.time.maximumStep;
  model.time.fixedStep = deck.time.fixedStep;
  model.time.energyTolerance = deck.time.energyTolerance;
  model.mesh = std::move(part);
  return model;
}
} // namespace coplane
