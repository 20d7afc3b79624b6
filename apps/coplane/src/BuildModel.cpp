#include "BuildModel.hpp"

#include "ContactRulesOfDeck.hpp"

#include <coplane_core/Log.hpp>
#include <coplane_dynamics/RigidBodies.hpp>
#include <coplane_input/DeckChecks.hpp>
#include <coplane_input/MaterialCards.hpp>
#include <coplane_schema/TimeFunctionEvaluator.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace coplane
{
namespace
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

ContactOptions optionsOf(const Deck& deck)
{
  const ContactCard& card = deck.contact;
  ContactOptions options;
  options.forces = card.forces != "common_normal" && commonNormalBecauseOf(deck).empty()
                       ? ContactOptions::Forces::Potential
                       : ContactOptions::Forces::CommonNormal;
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
  options.cosOpposed =
      card.cosOpposed.value_or(options.forces == ContactOptions::Forces::Potential ? 0.004 : 0.1);
  options.depthMax = card.depthMax;
  options.areaMin = card.areaMin;
  options.dampNormal = card.dampNormal;
  options.dampShear = card.dampShear;
  return options;
}

OfTime functionOf(const TimeFunction& card)
{
  if (card.expression.empty() && card.times.empty())
    return [value = card.constant](Real) { return value; };
  const auto evaluator = std::make_shared<TimeFunctionEvaluator>(card);
  return [evaluator](Real t) { return (*evaluator)(t); };
}

OfTimeAndPlace fieldOf(const TimeFunction& card)
{
  const auto evaluator = std::make_shared<TimeFunctionEvaluator>(card);
  return [evaluator](Real t, const Vec3& place) { return (*evaluator)(t, place); };
}

template <class Sets>
int indexOf(const Sets& sets, const std::string& name)
{
  for (int i = 0; i < int(sets.size()); ++i)
    if (sets[i].name == name)
      return i;
  return -1;
}

VectorOfTime vectorOf(const std::array<TimeFunction, 3>& card)
{
  return VectorOfTime({functionOf(card[0]), functionOf(card[1]), functionOf(card[2])});
}

LoadedSide loadedSide(const RankMesh& part, const RankMesh::Side& side)
{
  const RankMesh::Block& block = part.blocks[side.block];
  const ElementTopology& shape = topology(block.type);
  LoadedSide face{
      faceId(block.elementIds[side.element], side.side), shape.nodesPerSide, {-1, -1, -1, -1}, {}};
  for (int k = 0; k < face.count; ++k)
  {
    face.nodes[k] = block.connectivity[side.element * shape.nodes + shape.sideNodes[side.side][k]];
    face.place += (1.0 / face.count) * part.coordinates[face.nodes[k]];
  }
  return face;
}

std::vector<LoadedSide> sidesOf(const RankMesh& part, const std::vector<RankMesh::Side>& set)
{
  std::vector<LoadedSide> sides;
  for (const RankMesh::Side& side : set)
    sides.push_back(loadedSide(part, side));
  std::sort(sides.begin(), sides.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return sides;
}

std::vector<AbsorbingSide> absorbingSidesOf(const RankMesh& part,
                                            const std::vector<RankMesh::Side>& set,
                                            const std::vector<BlockSetup>& blocks)
{
  std::vector<AbsorbingSide> sides;
  for (const RankMesh::Side& side : set)
  {
    const BlockSetup& setup = blocks[side.block];
    const LinearElastic& elastic = elasticity(setup.material);
    sides.push_back({loadedSide(part, side), std::sqrt(elastic.density * pWaveModulus(elastic)),
                     std::sqrt(elastic.density * elastic.shearModulus),
                     setup.stressOfSide(part, side)});
  }
  std::sort(sides.begin(), sides.end(),
            [](const auto& a, const auto& b) { return a.side.id < b.side.id; });
  return sides;
}

Conditions conditionsOf(const Deck& deck, const Mesh& mesh, const RankMesh& part,
                        const std::vector<BlockSetup>& blocks)
{
  Conditions conditions;
  conditions.gravity = vectorOf(deck.gravity);
  if (!deck.massDamping.expression.empty() || deck.massDamping.constant != 0)
    conditions.massDamping = [alpha = functionOf(deck.massDamping), card = deck.massDamping](Real t)
    {
      const Real value = alpha(t);
      if (value < 0)
        fail(ExitCode::Computation,
             "{}: damping.mass = '{}' is {} 1/s at t = {} s; accepted: not negative. Use max(0, "
             "...).",
             card.where, card.expression, value, t);
      return value;
    };
  conditions.localDamping = deck.localDamping;
  conditions.dampingFrom = deck.dampingFrom;
  conditions.relaxation = {deck.kineticDamping, deck.dampingEnergyRatio.value_or(0),
                           deck.dampingForceRatio.value_or(0)};
  if (deck.dampingUntil)
    conditions.dampingUntil = *deck.dampingUntil;
  for (const ConditionCard& card : deck.conditions)
  {
    if (card.onSides())
    {
      const auto& set = part.sideSets[indexOf(mesh.sideSets, card.set)];
      if (card.type == "pressure")
      {
        FacePressure load{sidesOf(part, set), {}, {}};
        if (card.pressure.ofPlace)
          load.field = fieldOf(card.pressure);
        else
          load.pressure = functionOf(card.pressure);
        conditions.pressures.push_back(std::move(load));
      }
      else if (card.type == "traction")
      {
        FaceTraction load{sidesOf(part, set), {}, {}};
        if (std::any_of(card.traction.begin(), card.traction.end(),
                        [](const TimeFunction& f) { return f.ofPlace; }))
          for (int c = 0; c < 3; ++c)
            load.field[c] = fieldOf(card.traction[c]);
        else
          load.traction = vectorOf(card.traction);
        conditions.tractions.push_back(std::move(load));
      }
      else
        conditions.absorbing.push_back(
            {absorbingSidesOf(part, set, blocks), vectorOf(card.incident)});
      continue;
    }
    if (card.type == "rigid_motion")
    {
      RigidMotion motion;
      motion.block = indexOf(mesh.blocks, card.set);
      for (int c = 0; c < 3 && card.translation; ++c)
        if (card.components[c])
        {
          motion.components[c] = true;
          motion.velocity[c] = functionOf((*card.translation)[c]);
        }
      if (card.spin)
        motion.spin = vectorOf(*card.spin);
      conditions.rigidMotions.push_back(std::move(motion));
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
      condition.isDisplacement = card.type == "displacement";
      const auto& motion = condition.isDisplacement ? card.displacement : card.velocity;
      for (int c = 0; c < 3 && card.type != "fixed"; ++c)
        if (motion[c].ofPlace && condition.components[c])
          condition.field[c] = fieldOf(motion[c]);
        else
          condition.velocity[c] = functionOf(motion[c]);
      if (condition.hasField())
        for (const int n : nodes)
          condition.places.push_back(part.coordinates[n]);
      conditions.velocities.push_back(std::move(condition));
    }
  }
  return conditions;
}

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

/// A body of revolution: x is the radius. Points on the axis stay there.
void revolve(const RankMesh& part, const Deck& deck, const Comm& comm, Conditions& conditions)
{
  if (part.dimension != 2)
    failOnAllRanks(
        ExitCode::Deck,
        "{}: geometry = 'axisymmetric', but the mesh has three dimensions; use a section in the "
        "plane x, y with x >= 0, or leave the key out.",
        deck.meshWhere);
  int wrong = 0; // first owned node beyond the axis
  while (wrong < part.ownedNodes && !(part.coordinates[wrong].x < 0))
    ++wrong;
  const std::int64_t mine = wrong < part.ownedNodes ? part.nodePositions[wrong] : INT64_MAX;
  if (const std::int64_t first = comm.min(mine); first < INT64_MAX)
    failOnAllRanks(
        ExitCode::Deck,
        "{}: geometry = 'axisymmetric', but node {} is at x = {:.6g} m; accepted: x >= 0, the "
        "distance from the axis. Move the mesh, or keep the half with x >= 0.",
        deck.meshWhere, comm.max(mine == first ? part.nodeIds[wrong] : 0),
        comm.min(mine == first ? part.coordinates[wrong].x : 0));
  conditions.axisymmetric = true;
  SymmetryPlane axis;
  axis.normal = {1, 0, 0};
  for (int n = 0; n < part.ownedNodes; ++n)
    if (part.coordinates[n].x == 0)
      axis.nodes.push_back(n);
  conditions.symmetries.insert(conditions.symmetries.begin(), axis);
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
} // namespace

std::vector<std::string> problemsOfLaws(const Deck& deck, int dimension)
{
  std::vector<std::string> problems;
  for (const BlockCard& card : deck.blocks)
  {
    const auto material =
        std::find_if(deck.materials.begin(), deck.materials.end(),
                     [&](const MaterialCard& m) { return m.name == card.material; });
    if (const std::string problem =
            dimension == 2 ? problemInTheFlat(*material, deck.geometry == "axisymmetric") : "";
        !problem.empty())
      problems.push_back(fmt::format("{}: blocks.{}: material '{}': {}.", card.where, card.name,
                                     material->name, problem));
    const std::vector<std::string> names = historyNames(materialOf(*material));
    for (const std::string& wanted : erosionOf(card.erosion).variableNames())
      if (std::find(names.begin(), names.end(), wanted) == names.end())
        problems.push_back(fmt::format(
            "{}: blocks.{}.erosion asks for '{}', but material '{}' ({}) {}.", card.where,
            card.name, wanted, material->name, material->model,
            names.empty() ? std::string("has no variables; use volume_ratio or stable_step")
                          : fmt::format("has only {}", fmt::join(names, ", "))));
  }
  return problems;
}

std::vector<std::string> problemsOfRigidBlocks(const Deck& deck, const MeshSlice& slice,
                                               const Comm& comm)
{
  std::vector<std::string> problems;
  const Mesh& mesh = slice.mine;
  std::vector<char> rigid; // by block
  for (const Mesh::Block& block : mesh.blocks)
  {
    const auto card = std::find_if(deck.blocks.begin(), deck.blocks.end(),
                                   [&](const BlockCard& b) { return b.name == block.name; });
    rigid.push_back(card != deck.blocks.end() && card->rigid);
  }
  for (const ConditionCard& card : deck.conditions)
    for (int c = 0; c < 2 && card.spin && mesh.dimension == 2; ++c)
      if (const TimeFunction& spin = (*card.spin)[c];
          spin.constant != 0 || !spin.expression.empty() || !spin.times.empty())
        problems.push_back(fmt::format(
            "{}: angular_velocity about {} of the rigid block '{}', but the mesh has two "
            "dimensions; accepted: 0 there, a spin about z.",
            card.where, "xy"[c], card.set));
  for (const ConditionCard& card : deck.conditions)
    if (card.type == "absorbing")
      if (const int set = indexOf(mesh.sideSets, card.set); set >= 0)
      {
        std::int64_t block = std::int64_t(rigid.size()); // lowest rigid one with a side in the set
        for (const int element : mesh.sideSets[set].elements)
          if (const int other = slice.placeOf(element).first; rigid[other])
            block = std::min(block, std::int64_t(other));
        block = comm.min(block);
        if (block < std::int64_t(rigid.size()))
          problems.push_back(fmt::format(
              "{}: absorbing side set '{}' has a side of the rigid block '{}', through which no "
              "waves run; take it out of the set, or remove rigid.",
              card.where, card.set, mesh.blocks[block].name));
      }
  return problems;
}

void warnOfDoubleConditions(const Deck& deck, const Mesh& mesh, const RankMesh& part,
                            const Comm& comm)
{
  const auto prescribes = [](const ConditionCard& card)
  { return card.type == "fixed" || card.type == "velocity" || card.type == "displacement"; };
  const std::size_t count = deck.conditions.size();
  std::vector<std::array<int, 3>> last(std::size_t(part.nodes()), {-1, -1, -1}); // condition
  std::vector<std::int64_t> nodes(count * count, 0);
  std::vector<std::int64_t> lowest(count * count, INT64_MAX);
  for (std::size_t i = 0; i < count; ++i)
  {
    const ConditionCard& card = deck.conditions[i];
    if (!prescribes(card))
      continue;
    for (const int node : part.nodeSets[std::size_t(indexOf(mesh.nodeSets, card.set))])
    {
      std::int64_t with = -1; // the condition whose component is taken over
      for (int c = 0; c < part.dimension; ++c)
        if (card.components[c])
        {
          int& before = last[std::size_t(node)][std::size_t(c)];
          if (before >= 0 &&
              !(card.type == "fixed" && deck.conditions[std::size_t(before)].type == "fixed"))
            with = before;
          before = int(i);
        }
      if (with < 0 || node >= part.ownedNodes)
        continue;
      const std::size_t pair = std::size_t(with) * count + i;
      ++nodes[pair];
      lowest[pair] = std::min(lowest[pair], std::int64_t(part.nodeIds[node]));
    }
  }
  comm.sum(nodes);
  for (std::size_t pair = 0; pair < nodes.size(); ++pair)
    if (nodes[pair] > 0)
    {
      const ConditionCard &first = deck.conditions[pair / count],
                          &second = deck.conditions[pair % count];
      logWarning("two conditions on one node",
                 fmt::format("{} ({} of '{}') and {} ({} of '{}') prescribe the same component of "
                             "{} nodes, the first of which is node {}: the second acts there. Take "
                             "these nodes out of one of the sets.",
                             first.where, first.type, first.set, second.where, second.type,
                             second.set, nodes[pair], comm.min(lowest[pair])));
    }
}

Model buildModel(const Deck& deck, const MeshSlice& slice, RankMesh part, const Comm& comm)
{
  const Mesh& mesh = slice.mine; // names and shapes of blocks and sets
  Model model;
  for (const Mesh::Block& block : mesh.blocks)
  {
    const auto card = std::find_if(deck.blocks.begin(), deck.blocks.end(),
                                   [&](const BlockCard& b) { return b.name == block.name; });
    const auto material =
        std::find_if(deck.materials.begin(), deck.materials.end(),
                     [&](const MaterialCard& m) { return m.name == card->material; });
    BlockSetup setup;
    setup.name = block.name;
    setup.materialName = card->material;
    setup.material = materialOf(*material);
    setup.hourglass = {card->hourglassStiffness, card->hourglassViscosity};
    setup.element = elementOptionsOf(deck, *card, block);
    setup.erosion = erosionOf(card->erosion);
    setup.rigid = card->rigid;
    for (const InitialCard& initial : deck.initial)
      if (initial.block == block.name)
        setStart(initial, setup);
    model.blocks.push_back(std::move(setup));
  }
  std::vector<char> rigidBlocks;
  for (const BlockSetup& setup : model.blocks)
    rigidBlocks.push_back(setup.rigid);
  if (std::count(rigidBlocks.begin(), rigidBlocks.end(), 1) > 0)
    model.rigidBodyOfNode = rigidBodiesOf(part, rigidBlocks, comm);
  model.conditions = conditionsOf(deck, mesh, part, model.blocks);
  model.viscosity = {deck.viscosityLinear, deck.viscosityQuadratic};
  model.contactEnabled = deck.contact.enabled;
  model.contact = optionsOf(deck);
  if (deck.geometry == "axisymmetric")
  {
    revolve(part, deck, comm, model.conditions);
    model.contact.axisymmetric = true;
  }
  model.mesh = std::move(part);
  addContactRules(deck, mesh, comm, model);
  model.skin = deck.contact.skin;
  model.searchEvery = deck.contact.searchEvery;
  model.time.end = deck.time.end;
  model.time.stepFactor = deck.time.stepFactor;
  model.time.maximumStep = deck.time.maximumStep;
  model.time.fixedStep = deck.time.fixedStep;
  model.time.energyTolerance = deck.time.energyTolerance;
  model.time.contactGainTolerance = deck.time.contactGainTolerance;
  return model;
}
} // namespace coplane
