#include "DeckChecks.hpp"

#include "ContactRoles.hpp"
#include "JointCards.hpp"
#include "MaterialCards.hpp"
#include "detail/Names.hpp"

#include <coplane_core/Suggestion.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
void checkPairs(const Deck& deck, const DeckNode& root, const Names& joints, Problems& problems)
{
  const auto& pairs = deck.contact.pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i)
  {
    const auto& pair = pairs[i];
    const std::string path = fmt::format("contact.pairs.{}", i);
    const auto at = [&](const std::string& key) -> const DeckNode& {
      return nodeAt(root, {"contact", "pairs", std::to_string(i), key});
    };
    if (!pair.joint.empty() && !contains(joints, pair.joint))
      problems.add(at("joint"), unknown(path + ".joint", pair.joint, "a card in joints", joints));
    if (pair.excluded && (pair.declared || !pair.joint.empty()))
      problems.add(at("excluded"), fmt::format("{0}.excluded: true leaves {0}.{1} without effect; "
                                               "remove one of them.",
                                               path, pair.declared ? "declared" : "joint"));
    if (pair.blocks[0].empty() && pair.materials[0].empty() && pair.sideSets[0].empty() &&
        pair.jointSet.empty())
      problems.add(
          nodeAt(root, {"contact", "pairs", std::to_string(i)}),
          fmt::format("{} does not say between which faces it acts; accepted: one of "
                      "blocks: [a, b], materials: [a, b], side_sets: [a, b], joint_set: a.",
                      path));
    const Names materials = namesOf(deck.materials);
    for (std::size_t k = 0; k < 2; ++k)
      if (const auto& name = pair.materials[k];
          !name.empty() && name != "*" && !contains(materials, name))
        problems.add(at("materials"), unknown(fmt::format("{}.materials.{}", path, k), name,
                                              "a card in materials", materials));
    for (std::size_t k = 0; k < i && !pair.blocks[0].empty(); ++k)
      if (coverNames(pairs[k].blocks, pair.blocks[0], pair.blocks[1]))
      {
        problems.add(at("blocks"), fmt::format("{}.blocks is covered already by contact.pairs.{}; "
                                               "the first item that fits counts. Remove this one "
                                               "or put it first.",
                                               path, k));
        break;
      }
  }
}

/// Nothing may be prescribed along axes that are left free.
void checkComponent(const ConditionCard& card, const DeckNode& node, const std::string& path,
                    const std::string& key, const TimeFunction& value, int c, Problems& problems)
{
  if (!card.components[c] &&
      (!value.expression.empty() || value.constant != 0 || !value.times.empty()))
    problems.add(nodeAt(node, {key, std::to_string(c)}),
                 fmt::format("{0}.{3}.{1} has no effect because {0}.components does not have {2}; "
                             "write 0 or add {2} to components.",
                             path, c, "xyz"[c], key));
}

/// Warns of a time at which something begins, but which the run does not come to.
void warnOfLateFrom(Real from, Real end, const DeckNode& node, const std::string& path,
                    Problems& problems)
{
  if (from >= end && end > 0)
    problems.warn(
        nodeAt(node, {"from"}),
        fmt::format("{}.from = {:g} s, but the run ends at time.end = {:g} s.", path, from, end));
}

/// Warns of a table that varies, but not while it acts.
void warnOfIdleTable(const TimeFunction& table, Real from, Real until, const DeckNode& node,
                     const std::string& path, Problems& problems)
{
  const auto& values = table.values;
  bool varies = false, acts = false;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] != values[i - 1])
    {
      varies = true;
      acts |= table.times[i] > from && table.times[i - 1] < until;
    }
  if (varies && !acts && from < until)
    problems.warn(node, fmt::format("{}: the table has times from {:g} to {:g} s and is constant "
                                    "from {:g} to {:g} s, while it acts. Times are in s, from the "
                                    "start of the run on.",
                                    path, table.times.front(), table.times.back(), from, until));
}

void checkDamping(const Deck& deck, const DeckNode& root, Problems& problems)
{
  const DeckNode& node = nodeAt(root, {"damping"});
  const bool some = node.find("mass") || node.find("local") || node.find("kinetic");
  for (const char* key : {"from", "until", "until_energy_ratio", "until_force_ratio"})
    if (const DeckNode* given = node.find(key); given && !some)
      problems.add(*given, fmt::format("damping.{} has no effect without damping.mass, "
                                       "damping.local or damping.kinetic; remove it or give one "
                                       "of them.",
                                       key));
  if (deck.time.endAtRest && !deck.dampingEnergyRatio && !deck.dampingForceRatio)
    problems.add(nodeAt(root, {"time", "end_at_rest"}),
                 "time.end_at_rest has no effect without damping.until_energy_ratio or "
                 "damping.until_force_ratio, which say what rest is; give one of them.");
  if (deck.dampingUntil && *deck.dampingUntil <= deck.dampingFrom)
    problems.add(nodeAt(node, {"until"}),
                 fmt::format("damping.until = {} s is not after damping.from = {} s; accepted: a "
                             "later time.",
                             *deck.dampingUntil, deck.dampingFrom));
  else
    warnOfLateFrom(deck.dampingFrom, deck.time.end, node, "damping", problems);
  warnOfIdleTable(deck.massDamping, deck.dampingFrom,
                  std::min(deck.dampingUntil.value_or(infinity), deck.time.end),
                  nodeAt(node, {"mass"}), "damping.mass", problems);
}

void checkMassScaling(const Deck& deck, const DeckNode& root, Problems& problems)
{
  if (!deck.time.scaledStep)
    return;
  const DeckNode& node = nodeAt(root, {"time", "mass_scaling"});
  if (deck.time.fixedStep)
    problems.add(node, "time.mass_scaling and time.fixed_step give two steps; accepted: one of "
                       "them. Masses follow mass_scaling.step.");
  if (deck.time.maximumStep && *deck.time.maximumStep < *deck.time.scaledStep)
    problems.add(nodeAt(node, {"step"}),
                 fmt::format("time.mass_scaling.step = {:g} s is above time.maximum_step = {:g} s: "
                             "mass would be added for nothing; accepted: at most that.",
                             *deck.time.scaledStep, *deck.time.maximumStep));
  for (std::size_t i = 0; i < deck.stages.size(); ++i)
    for (const char* key : {"remove", "add"})
      if (const DeckNode* given = nodeAt(root, {"stages", std::to_string(i)}).find(key))
        problems.add(*given,
                     fmt::format("stages.{}.{} does not go with time.mass_scaling: what blocks "
                                 "have of an added mass is not known when they come or leave; "
                                 "accepted: stages that change conditions, loads and strengths.",
                                 i, key));
  for (std::size_t i = 0; i < deck.conditions.size(); ++i)
  {
    const std::string& type = deck.conditions[i].type;
    if (!deck.time.scalingWithWaves &&
        (type == "absorbing" || type == "free_field" || type == "acceleration"))
      problems.add(node,
                   fmt::format("time.mass_scaling with conditions.{} of type {}: added mass slows "
                               "waves down and sends them back, so what the condition is for comes "
                               "out wrong. Remove mass_scaling, or set "
                               "time.mass_scaling.with_waves: true if no wave passes where mass is "
                               "added.",
                               i, type));
  }
}

void checkSubcycling(const Deck& deck, const DeckNode& root, Problems& problems)
{
  if (deck.time.subcyclingLevels == 1)
    return;
  const DeckNode& node = nodeAt(root, {"time", "subcycling"});
  const auto exclude = [&](bool given, const char* key, const char* why)
  {
    if (given)
      problems.add(node, fmt::format("time.subcycling does not go with {}: {}; accepted: one of "
                                     "them.",
                                     key, why));
  };
  exclude(deck.time.fixedStep.has_value(), "time.fixed_step",
          "the cycle is as long as a few substepped elements make worth while");
  exclude(deck.time.scaledStep.has_value(), "time.mass_scaling",
          "masses would be raised for a step that nothing needs");
  exclude(deck.contact.debris == "points", "contact.debris: points",
          "what pushes the points would act once in a cycle only");
  exclude(deck.localDamping > 0, "damping.local",
          "it goes by the forces of a cycle, and those of substeps come between");
  exclude(deck.kineticDamping, "damping.kinetic", "it stops all motion at once, within a cycle");
  exclude(deck.dampingEnergyRatio || deck.dampingForceRatio,
          "damping.until_energy_ratio and until_force_ratio",
          "those are for runs to a state of rest, whose steps mass_scaling makes longer");
  for (std::size_t i = 0; i < deck.stages.size(); ++i)
    for (const char* key : {"remove", "add"})
      exclude(nodeAt(root, {"stages", std::to_string(i)}).find(key) != nullptr,
              fmt::format("stages.{}.{}", i, key).c_str(),
              "blocks come and leave with the velocities of whole cycles");
}

void checkConditions(const Deck& deck, const DeckNode& root, Problems& problems)
{
  for (std::size_t i = 0; i < deck.conditions.size(); ++i)
  {
    const auto& card = deck.conditions[i];
    const std::string path = fmt::format("conditions.{}", i);
    const DeckNode& node = nodeAt(root, {"conditions", std::to_string(i)});
    if (card.until && *card.until <= card.from)
      problems.add(nodeAt(node, {"until"}),
                   fmt::format("{0}.until = {1} s is not after {0}.from = {2} s; accepted: a later "
                               "time.",
                               path, *card.until, card.from));
    else
      warnOfLateFrom(card.from, deck.time.end, node, path, problems);
    const Real until = std::min(card.until.value_or(infinity), deck.time.end);
    const auto look = [&](const char* key, const TimeFunction& function, int c)
    {
      const DeckNode& at = c < 0 ? nodeAt(node, {key}) : nodeAt(node, {key, std::to_string(c)});
      const std::string component = c < 0 ? "" : fmt::format(".{}", c);
      warnOfIdleTable(function, card.from, until, at, path + "." + key + component, problems);
    };
    look("value", card.pressure, -1);
    for (int c = 0; c < 3; ++c)
    {
      for (const auto* value :
           {&card.velocity, &card.displacement, &card.acceleration, &card.traction})
        look("value", (*value)[c], c);
      look("incident", card.incident[c], c);
      if (card.translation)
        look("velocity", (*card.translation)[c], c);
      if (card.spin)
        look("angular_velocity", (*card.spin)[c], c);
    }
    if (card.type == "rigid_motion")
    {
      if (!card.translation && !card.spin)
        problems.add(node, fmt::format("{0} prescribes nothing; accepted: {0}.velocity, "
                                       "{0}.angular_velocity or both.",
                                       path));
      const auto block = std::find_if(deck.blocks.begin(), deck.blocks.end(),
                                      [&](const auto& b) { return b.name == card.set; });
      if (block != deck.blocks.end() && !block->rigid)
        problems.add(nodeAt(node, {"block"}),
                     fmt::format("{0}.block = '{1}' is not rigid; set blocks.{1}.rigid, or use "
                                 "type velocity with a node set.",
                                 path, card.set));
      for (int c = 0; c < 3 && card.translation; ++c)
        checkComponent(card, node, path, "velocity", (*card.translation)[c], c, problems);
      if (const DeckNode* given = node.find("components"); given && !card.translation)
        problems.add(*given, fmt::format("{0}.components has no effect without {0}.velocity; "
                                         "remove it or give that.",
                                         path));
      for (std::size_t k = 0; k < i; ++k)
        if (deck.conditions[k].type == "rigid_motion" && deck.conditions[k].set == card.set)
          problems.add(nodeAt(node, {"block"}),
                       fmt::format("{}.block = '{}' is held by conditions.{} already; accepted: "
                                   "one item for each block.",
                                   path, card.set, k));
    }
    if (card.type == "velocity" || card.type == "displacement" || card.type == "acceleration")
      for (int c = 0; c < 3; ++c)
        checkComponent(card, node, path, "value", card.motion()[c], c, problems);
  }
}

void checkErosion(const Deck& deck, const DeckNode& root, Problems& problems)
{
  for (const BlockCard& block : deck.blocks)
  {
    const std::string path = "blocks." + block.name + ".erosion";
    const DeckNode& node = nodeAt(root, {"blocks", block.name, "erosion"});
    if (block.rigid && block.erosion.any())
      problems.add(node, fmt::format("{} has no effect because blocks.{}.rigid is true; remove one "
                                     "of them.",
                                     path, block.name));
    const auto& ratio = block.erosion.volumeRatio;
    if (ratio.size() == 2 && !(ratio[0] < 1 && ratio[1] > 1))
      problems.add(nodeAt(node, {"volume_ratio"}),
                   fmt::format("{}.volume_ratio = [{}, {}] would take out elements as they are at "
                               "the start; accepted: the first below 1, the second above 1.",
                               path, ratio[0], ratio[1]));
    for (const auto& variable : block.erosion.variables)
      if (!variable.above && !variable.below)
        problems.add(nodeAt(node, {"variables", variable.name}),
                     fmt::format("{0}.variables.{1} has no limit; accepted: above, below or both, "
                                 "as in {1}: {{above: 0.5}}.",
                                 path, variable.name));
  }
}

void checkBlockDamping(const Deck& deck, const DeckNode& root, Problems& problems)
{
  for (const BlockCard& block : deck.blocks)
  {
    const std::string path = "blocks." + block.name + ".damping";
    const DeckNode& node = nodeAt(root, {"blocks", block.name, "damping"});
    const MaxwellCard& damping = block.damping;
    const bool any = damping.ratio > 0 || damping.low || damping.high || damping.elements != 3 ||
                     damping.volumetric;
    if (block.rigid && any)
      problems.add(node, fmt::format("{} has no effect because blocks.{}.rigid is true; remove one "
                                     "of them.",
                                     path, block.name));
    else if (any && !(damping.ratio > 0 && damping.low && damping.high))
      problems.add(node, fmt::format("{0} needs ratio (above 0), low and high; accepted: {0}: "
                                     "{{ratio: 0.02, low: 0.5, high: 20}}.",
                                     path));
    else if (any && !(*damping.low < *damping.high))
      problems.add(node, fmt::format("{}: low = {} Hz is not below high = {} Hz.", path,
                                     *damping.low, *damping.high));
  }
}

void checkForces(const Deck& deck, const DeckNode& root, Problems& problems)
{
  if (const std::string reason = commonNormalBecauseOf(deck);
      deck.contact.forces == "potential" && !reason.empty())
    problems.add(nodeAt(root, {"contact", "forces"}),
                 fmt::format("contact.forces = 'potential' does not go with {}; leave that out, or "
                             "use common_normal.",
                             reason));
  const std::string other = deck.contact.forces == "common_normal"
                                ? std::string("contact.forces = 'common_normal'")
                                : commonNormalBecauseOf(deck);
  if (!other.empty() && deck.contact.impulses == "path")
    problems.add(nodeAt(root, {"contact", "impulses"}),
                 fmt::format("contact.impulses = 'path' does not go with {}, whose forces change "
                             "no energy along a path; remove one of them.",
                             other));
  if (!other.empty())
    for (const JointCard& joint : deck.joints)
      if (jointLawOf(joint).bond.resistsBending)
        problems.add(nodeAt(root, {"joints", joint.name, "resists_bending"}),
                     fmt::format("joints.{}.resists_bending does not go with {}, whose forces act "
                                 "at one point of a face; remove one of them.",
                                 joint.name, other));
  if (deck.geometry == "axisymmetric")
    for (const auto& block : deck.blocks)
      if (block.rigid)
        problems.add(nodeAt(root, {"blocks", block.name, "rigid"}),
                     fmt::format("blocks.{}.rigid is not offered with geometry = 'axisymmetric'; "
                                 "use a stiff material.",
                                 block.name));
}

/// Debris needs something to come from and something that stops it.
void checkDebris(const Deck& deck, const DeckNode& root, Problems& problems)
{
  if (deck.contact.debris != "points")
    return;
  const DeckNode& node = nodeAt(root, {"contact", "debris"});
  if (!deck.contact.enabled)
    problems.add(node, "contact.debris = 'points' has no effect with contact.enabled: false; "
                       "remove one of the two.");
  if (std::none_of(deck.blocks.begin(), deck.blocks.end(),
                   [](const auto& block) { return block.erosion.any(); }))
    problems.add(node, "contact.debris = 'points' has no effect without blocks.<name>.erosion: no "
                       "element dies. Add that or remove this.");
}

bool allZero(const std::array<Real, 6>& values)
{
  return std::all_of(values.begin(), values.end(), [](Real value) { return value == 0; });
}

void checkInitial(const Deck& deck, const DeckNode& root, Problems& problems)
{
  Names seen;
  for (std::size_t i = 0; i < deck.initial.size(); ++i)
  {
    const auto& initial = deck.initial[i];
    const DeckNode& card = nodeAt(root, {"initial", std::to_string(i)});
    const auto block = std::find_if(deck.blocks.begin(), deck.blocks.end(),
                                    [&](const auto& b) { return b.name == initial.block; });
    if (block != deck.blocks.end() && block->rigid &&
        !(allZero(initial.stress) && allZero(initial.stressGradient)))
      problems.add(card, fmt::format("initial.{}: block '{}' is rigid and carries no stress; "
                                     "remove stress and stress_gradient, or rigid.",
                                     i, initial.block));
    if (allZero(initial.stressGradient))
      for (const char* key : {"stress_axis", "stress_point"})
        if (const DeckNode* given = card.find(key))
          problems.add(*given, fmt::format("initial.{0}.{1} has no effect without "
                                           "initial.{0}.stress_gradient; remove it or give that.",
                                           i, key));
    if (!initial.block.empty() && contains(seen, initial.block))
      problems.add(nodeAt(root, {"initial", std::to_string(i), "block"}),
                   fmt::format("initial.{}.block = '{}' has a card already; accepted: one for each "
                               "block.",
                               i, initial.block));
    seen.push_back(initial.block);
  }
}

/// Names of a list such as history.joints: "*" or those that there are.
void checkListed(const std::string& key, const Names& listed, const std::string& what,
                 const Names& there, const DeckNode& root, Problems& problems)
{
  for (std::size_t i = 0; i < listed.size(); ++i)
    if (listed[i] != "*" && !contains(there, listed[i]))
      problems.add(nodeAt(root, {"history", key, std::to_string(i)}),
                   unknown(fmt::format("history.{}.{}", key, i), listed[i], what, there));
}

/// Names under which the motion of a probe is known.
Names motionsOf(const ProbeCard& probe)
{
  Names names;
  if (probe.plane)
    return names;
  if (probe.between.empty())
    names.push_back(probe.name);
  else
    for (int k = 1; k <= probe.count; ++k)
      names.push_back(fmt::format("{}_{}", probe.name, k));
  return names;
}

void checkRelative(const Deck& deck, const ProbeCard& probe, const std::string& path,
                   const DeckNode& node, Problems& problems)
{
  if (probe.relativeTo.empty())
    return;
  if (probe.plane)
  {
    problems.add(nodeAt(node, {"relative_to"}),
                 path + ".relative_to belongs to probes of a motion, which plane has not; remove "
                        "one of the two.");
    return;
  }
  Names others;
  for (const ProbeCard& other : deck.history.probes)
    if (other.name != probe.name)
      for (const std::string& name : motionsOf(other))
        others.push_back(name);
  if (!contains(others, probe.relativeTo))
    problems.add(nodeAt(node, {"relative_to"}),
                 unknown(path + ".relative_to", probe.relativeTo,
                         "another probe with a node_set, block or point", others));
}

/// Of planes and points on a line.
void checkProbe(const Deck& deck, std::size_t i, const Names& joints, const DeckNode& node,
                Problems& problems)
{
  const ProbeCard& probe = deck.history.probes[i];
  const std::string path = fmt::format("history.probes.{}", i);
  if (probe.plane && !probe.variables.empty())
    problems.add(nodeAt(node, {"variables"}),
                 path + ".variables does not belong to plane, which has columns of its own; "
                        "remove it.");
  if (!probe.joint.empty() && !probe.plane)
    problems.add(nodeAt(node, {"joint"}),
                 path + ".joint belongs to plane; name a point there, or remove it.");
  else if (!probe.joint.empty() && !contains(joints, probe.joint))
    problems.add(nodeAt(node, {"joint"}),
                 unknown(path + ".joint", probe.joint, "a card in joints", joints));
  if (probe.plane && !deck.contact.enabled)
    problems.add(nodeAt(node, {"plane"}),
                 path + ".plane: there are no planes, as contact.enabled is false; remove one of "
                        "the two.");
  checkRelative(deck, probe, path, node, problems);
  if (node.find("count") && probe.between.empty())
    problems.add(nodeAt(node, {"count"}),
                 path + ".count belongs to between; name the ends of a line there, or remove it.");
  if (probe.between.empty())
    return;
  if (probe.between.size() != 2 || probe.between[0].size() != probe.between[1].size() ||
      probe.between[0] == probe.between[1])
    problems.add(nodeAt(node, {"between"}),
                 path + ".between: accepted: two different points, [[x, y, z], [x, y, z]].");
  for (const ProbeCard& other : deck.history.probes)
    for (int k = 1; k <= probe.count; ++k)
      if (other.name == fmt::format("{}_{}", probe.name, k))
        problems.add(nodeAt(node, {"name"}),
                     fmt::format("{}: point {} would be called '{}', as another probe is; "
                                 "accepted: names of their own.",
                                 path, k, other.name));
}

void checkHistory(const Deck& deck, const DeckNode& root, const Names& joints, Problems& problems)
{
  Names seen;
  for (std::size_t i = 0; i < deck.history.probes.size(); ++i)
  {
    const auto& name = deck.history.probes[i].name;
    if (!name.empty() && contains(seen, name))
      problems.add(nodeAt(root, {"history", "probes", std::to_string(i), "name"}),
                   fmt::format("history.probes.{}.name = '{}' is taken; accepted: each name once.",
                               i, name));
    seen.push_back(name);
    checkProbe(deck, i, joints, nodeAt(root, {"history", "probes", std::to_string(i)}), problems);
    if (deck.history.probes[i].reaction && deck.history.probes[i].nodeSet.empty())
      problems.add(nodeAt(root, {"history", "probes", std::to_string(i), "reaction"}),
                   fmt::format("history.probes.{}.reaction belongs to node_set; name a node set "
                               "that conditions hold, or remove it.",
                               i));
  }
  checkListed("joints", deck.history.joints, "a card in joints, or \"*\"", joints, root, problems);
  Names rigid;
  for (const auto& block : deck.blocks)
    if (block.rigid)
      rigid.push_back(block.name);
  checkListed("rigid", deck.history.rigid, "a rigid block, or \"*\"", rigid, root, problems);
}

void checkStages(const Deck& deck, const DeckNode& root, Problems& problems)
{
  const auto& stages = deck.stages;
  const Names blocks = namesOf(deck.blocks);
  Names seen, absent = absentAtStart(deck);
  Real before = 0;
  if (!stages.empty() && deck.time.endAtRest)
    problems.add(nodeAt(root, {"time", "end_at_rest"}),
                 fmt::format("time.end_at_rest does not go with stages; give stages.{}.at_rest.",
                             stages.size() - 1));
  for (const InitialCard& initial : deck.initial)
    if (contains(absent, initial.block))
      problems.add(nodeAt(root, {"initial"}),
                   fmt::format("initial: block '{}' is not there at the start (stages add it), and "
                               "comes in at rest and free of stress; remove its card.",
                               initial.block));
  for (std::size_t i = 0; i < stages.size(); ++i)
  {
    const StageCard& stage = stages[i];
    const DeckNode& node = nodeAt(root, {"stages", std::to_string(i)});
    const std::string path = fmt::format("stages.{}", i);
    if (!stage.name.empty() && contains(seen, stage.name))
      problems.add(
          nodeAt(node, {"name"}),
          fmt::format("{}.name = '{}' is taken; accepted: each name once.", path, stage.name));
    seen.push_back(stage.name);
    const Real until = stage.until.value_or(deck.time.end);
    if (!stage.until && i + 1 < stages.size())
      problems.add(node,
                   fmt::format("{}.until is missing: only the last stage goes on to time.end; "
                               "accepted: a time.",
                               path));
    else if (until <= before || until > deck.time.end)
      problems.add(nodeAt(node, {"until"}),
                   fmt::format("{}.until = {} s; accepted: later than the end of the stage before, "
                               "{} s, and not later than time.end = {} s.",
                               path, until, before, deck.time.end));
    before = until;
    for (const char* key : {"remove", "add", "set", "zero_displacements"})
      if (const DeckNode* given = i == 0 ? node.find(key) : nullptr)
        problems.add(*given, fmt::format("{0}.{1}: the first stage is the deck as it stands, and "
                                         "begins with nothing; move {1} to a later stage.",
                                         path, key));
    const auto check = [&](const char* key, const Names& names, bool comes)
    {
      for (const std::string& name : names)
      {
        const DeckNode& at = nodeAt(node, {key});
        const auto card = std::find_if(deck.blocks.begin(), deck.blocks.end(),
                                       [&](const auto& b) { return b.name == name; });
        if (card == deck.blocks.end())
          problems.add(at, unknown(path + "." + key, name, "a card in blocks", blocks));
        else if (card->rigid)
          problems.add(at, fmt::format("{}.{}: block '{}' is rigid; accepted: blocks that deform. "
                                       "Use a stiff material.",
                                       path, key, name));
        else if (contains(absent, name) != comes)
          problems.add(at, fmt::format("{}.{}: block '{}' is {} there in this stage.", path, key,
                                       name, comes ? "already" : "not"));
        if (comes)
          absent.erase(std::remove(absent.begin(), absent.end(), name), absent.end());
        else
          absent.push_back(name);
      }
    };
    check("remove", stage.remove, false);
    check("add", stage.add, true);
  }
}

Real lengthOf(const LineCard& card)
{
  Real length = 0;
  for (std::size_t i = 1; i < card.points.size(); ++i)
  {
    Real squares = 0;
    for (std::size_t c = 0; c < std::min(card.points[i].size(), card.points[i - 1].size()); ++c)
      squares += std::pow(card.points[i][c] - card.points[i - 1][c], 2);
    if (!(squares > 0))
      return 0;
    length += std::sqrt(squares);
  }
  return length;
}

/// The earliest time at which a stage can begin [s]: one that may end at rest has no least length.
Real earliestBegin(const std::vector<StageCard>& stages, const std::string& name)
{
  Real begin = 0;
  for (std::size_t i = 0; i < stages.size() && stages[i].name != name; ++i)
    if (!stages[i].atRest)
      begin = stages[i].until.value_or(begin);
  return begin;
}

/// When a line is there.
void checkTimesOfLine(const Deck& deck, const LineCard& card, const DeckNode& node,
                      Problems& problems)
{
  const std::string path = "lines." + card.name;
  const Real begin =
      std::max(card.from, card.stage.empty() ? 0 : earliestBegin(deck.stages, card.stage));
  const Real end = std::min(card.until.value_or(infinity), deck.time.end);
  if (card.until && *card.until <= card.from)
    problems.add(nodeAt(node, {"until"}), fmt::format("{}.until = {} s; accepted: later than from, "
                                                      "{} s.",
                                                      path, *card.until, card.from));
  else if (card.until && *card.until <= begin)
    problems.add(nodeAt(node, {"until"}),
                 fmt::format("{}.until = {} s; accepted: later than the beginning of the stage "
                             "'{}', {} s.",
                             path, *card.until, card.stage, begin));
  else if (card.from >= deck.time.end)
    warnOfLateFrom(card.from, deck.time.end, node, path, problems);
  else if (card.pretension > 0 && begin + card.pretensionTime > (1 + 1e-9) * end)
    problems.warn(nodeAt(node, {"pretension_time"}),
                  fmt::format("{}.pretension_time = {:g} s: the line is there from {:g} to {:g} s, "
                              "so it is never pulled on in full.",
                              path, card.pretensionTime, begin, end));
}

void checkLines(const Deck& deck, const DeckNode& root, Problems& problems)
{
  if (!deck.lines.empty() && deck.geometry == "axisymmetric")
    problems.add(nodeAt(root, {"lines"}),
                 "lines do not go with geometry = 'axisymmetric': a line would be a cone all the "
                 "way round. Accepted: plane strain or three dimensions.");
  constexpr Real mostSegments = 1e6;
  const Names stages = namesOf(deck.stages), names = namesOf(deck.lines);
  for (const LineCard& card : deck.lines)
  {
    const std::string path = "lines." + card.name;
    const auto at = [&](const std::string& key) -> const DeckNode& {
      return nodeAt(root, {"lines", card.name, key});
    };
    const Real length = lengthOf(card);
    if (card.points.size() > 1 && length == 0)
      problems.add(at("points"), path + ".points: two points, one after the other, are the same; "
                                        "accepted: a path with a length.");
    if (card.attach == "ends" && card.points.size() > 2)
      problems.add(at("points"),
                   fmt::format("{}.points has {} points; accepted with attach = 'ends': two, as "
                               "the bar is straight between them.",
                               path, card.points.size()));
    if (length > 0 && card.freeLength > 0.999999 * length)
      problems.add(at("free_length"),
                   fmt::format("{}.free_length = {} m; accepted: less than the length of the line, "
                               "{:.6g} m. Without grout at all it is attach: ends.",
                               path, card.freeLength, length));
    if ((card.groutFriction > 0) != (card.groutPerimeter > 0))
      problems.add(at("grout"), path + ".grout: friction and perimeter go together; accepted: "
                                       "both, or none of them.");
    if (card.diameter && !card.compression)
      problems.add(at("diameter"), path + ".diameter: a line without compression is a cable, which "
                                          "does not bend; accepted: one of the two.");
    if (card.diameter && pi * *card.diameter * *card.diameter > 8 * 1.01 * card.area)
      problems.add(
          at("diameter"),
          fmt::format("{}.diameter = {:g} m: one bar of it has {:.4g} m^2, more than twice "
                      "area, {:g} m^2; accepted: that of one bar (or of half of one, in a plane "
                      "of symmetry), or of each of several that make up the area.",
                      path, *card.diameter, pi / 4 * *card.diameter * *card.diameter, card.area));
    if (card.mirrored != "none" && card.mirrored != "end" && card.freeLength > 0)
      problems.add(at("mirrored"),
                   fmt::format("{}.mirrored = '{}' with free_length: the line has no grout at its "
                               "start; accepted: one of the two.",
                               path, card.mirrored));
    if (card.yieldStress && card.pretension > *card.yieldStress * card.area)
      problems.add(at("pretension"),
                   fmt::format("{}.pretension = {} N; accepted: not more than yield_stress times "
                               "area, {:.6g} N.",
                               path, card.pretension, *card.yieldStress * card.area));
    if (card.segmentLength > 0 && length / card.segmentLength * card.copies > mostSegments)
      problems.add(
          at("segment_length"),
          fmt::format("{}.segment_length = {} m makes {:.3g} segments; accepted: {:.0e} at "
                      "most, with all copies. About the size of the elements is enough.",
                      path, card.segmentLength, length / card.segmentLength * card.copies,
                      mostSegments));
    if (card.copies > 1 && card.copyStep.x == 0 && card.copyStep.y == 0 && card.copyStep.z == 0)
      problems.add(at("copies"), path + ".copies: they would all be in one place; give copy_step.");
    for (int copy = 1; card.copies > 1 && copy <= std::min(card.copies, int(mostSegments)); ++copy)
      if (const std::string name = fmt::format("{}_{}", card.name, copy); contains(names, name))
        problems.add(at("copies"), fmt::format("{}.copies: copy {} would be called {}, as another "
                                               "line is; accepted: names of their own.",
                                               path, copy, name));
    checkTimesOfLine(deck, card, nodeAt(root, {"lines", card.name}), problems);
    if (!card.stage.empty() && !contains(stages, card.stage))
      problems.add(at("stage"), unknown(path + ".stage", card.stage, "a stage", stages));
  }
}

/// What results hold; lines and fragments go beside them.
void checkBesideResults(const Deck& deck, const DeckNode& root, Problems& problems)
{
  const DeckNode& output = nodeAt(root, {"output"});
  if (deck.output.lines && (deck.output.results.empty() || deck.lines.empty()))
    problems.add(
        nodeAt(output, {"lines"}),
        deck.lines.empty()
            ? "output.lines has no effect without the section lines; remove it or add that."
            : "output.lines has no effect without results, which output.results switches "
              "off; remove one of the two.");
  if (!deck.output.variables.empty() && deck.output.results.empty())
    problems.add(nodeAt(output, {"variables"}),
                 "output.variables has no effect without results, which output.results switches "
                 "off; remove one of the two.");
  if (deck.output.fragments && deck.output.results.empty())
    problems.add(nodeAt(output, {"fragments"}),
                 "output.fragments has no effect without results, which output.results switches "
                 "off; remove one of the two.");
  if (const DeckNode* given = deck.output.fragments ? nullptr : output.find("fragment_damage"))
    problems.add(*given, "output.fragment_damage has no effect without output.fragments: true; "
                         "remove it or add that.");
}

/// Outputs that a run never comes to.
void warnOfLateOutputs(const Deck& deck, const DeckNode& root, Problems& problems)
{
  const Real end = deck.time.end;
  const auto warn = [&](const std::string& group, Real every)
  {
    if (every > end)
      problems.warn(
          nodeAt(root, {group, "every"}),
          fmt::format("{}.every = {:g} s is longer than the run (time.end = {:g} s): only "
                      "its first and last state are written.",
                      group, every, end));
  };
  warn("output", deck.output.every);
  warn("history", deck.history.every);
  const auto& times = deck.output.times;
  if (const auto late = std::find_if(times.begin(), times.end(), [&](Real t) { return t > end; });
      late != times.end())
    problems.warn(
        nodeAt(root, {"output", "times"}),
        fmt::format("output.times has {:g} s, but the run ends at time.end = {:g} s.", *late, end));
}

/// A weight of the earth that lifts.
void warnOfGravityUpwards(const Deck& deck, const DeckNode& root, Problems& problems)
{
  for (int c = 1; c < 3; ++c)
    if (const Real g = deck.gravity[c].constant; g > 9.7 && g < 9.9)
      problems.warn(nodeAt(root, {"gravity", std::to_string(c)}),
                    fmt::format("gravity.{0} = {1:g} m/s^2 pulls along +{2}, upwards where {2} "
                                "points up; there it is -{1:g}.",
                                c, g, "xyz"[c]));
}

/// A joint law that acts nowhere, as one whose name is misspelt in --set does. Stages may come to
/// it later.
void warnOfJointsWithoutUse(const Deck& deck, const DeckNode& root, const Names& joints,
                            Problems& problems)
{
  const auto acts = [&](const std::string& joint)
  {
    const auto& pairs = deck.contact.pairs;
    return joint == deck.contact.defaultJoint ||
           std::any_of(pairs.begin(), pairs.end(),
                       [&](const ContactPairCard& pair) { return pair.joint == joint; });
  };
  for (const std::string& joint : joints)
    if (deck.stages.empty() && !acts(joint))
    {
      Names others = joints;
      others.erase(std::find(others.begin(), others.end(), joint));
      problems.warn(nodeAt(root, {"joints", joint}),
                    fmt::format("joints.{} acts nowhere: neither contact.default_joint nor an item "
                                "of contact.pairs names it.{}",
                                joint, didYouMean(joint, others)));
    }
}
} // namespace

void checkDeck(const Deck& deck, const DeckNode& root, Problems& problems)
{
  const Names materials = namesOf(deck.materials), joints = namesOf(deck.joints);
  for (const auto& block : deck.blocks)
    if (!block.material.empty() && !contains(materials, block.material))
      problems.add(nodeAt(root, {"blocks", block.name, "material"}),
                   unknown("blocks." + block.name + ".material", block.material,
                           "a card in materials", materials));
  checkMaterials(deck.materials, root, problems);
  checkJoints(deck.joints, root, problems);
  if (!deck.contact.defaultJoint.empty() && !contains(joints, deck.contact.defaultJoint))
    problems.add(
        nodeAt(root, {"contact", "default_joint"}),
        unknown("contact.default_joint", deck.contact.defaultJoint, "a card in joints", joints));
  checkPairs(deck, root, joints, problems);
  checkConditions(deck, root, problems);
  checkDamping(deck, root, problems);
  checkMassScaling(deck, root, problems);
  checkSubcycling(deck, root, problems);
  checkForces(deck, root, problems);
  checkDebris(deck, root, problems);
  checkErosion(deck, root, problems);
  checkBlockDamping(deck, root, problems);
  checkInitial(deck, root, problems);
  checkHistory(deck, root, joints, problems);
  checkStages(deck, root, problems);
  checkLines(deck, root, problems);
  checkBesideResults(deck, root, problems);
  warnOfLateOutputs(deck, root, problems);
  for (int c = 0; c < 3; ++c)
    warnOfIdleTable(deck.gravity[c], 0, deck.time.end, nodeAt(root, {"gravity", std::to_string(c)}),
                    fmt::format("gravity.{}", c), problems);
  warnOfGravityUpwards(deck, root, problems);
  warnOfJointsWithoutUse(deck, root, joints, problems);
}

std::vector<std::string> absentAtStart(const Deck& deck)
{
  Names seen, absent;
  for (const StageCard& stage : deck.stages)
  {
    for (const std::string& name : stage.add)
      if (!contains(seen, name))
        absent.push_back(name);
    for (const Names* names : {&stage.add, &stage.remove})
      seen.insert(seen.end(), names->begin(), names->end());
  }
  return absent;
}

std::string commonNormalBecauseOf(const Deck& deck)
{
  const ContactCard& card = deck.contact;
  const ContactCard usual;
  if (card.preset != usual.preset)
    return fmt::format("contact.preset = '{}'", card.preset);
  if (card.area != usual.area)
    return fmt::format("contact.area = '{}'", card.area);
  if (card.weights != usual.weights)
    return fmt::format("contact.weights = '{}'", card.weights);
  if (card.closure != usual.closure)
    return fmt::format("contact.closure = '{}'", card.closure);
  if (card.couple != usual.couple)
    return "contact.couple = false";
  if (card.areaRule != usual.areaRule)
    return "contact.area_rule = false";
  return {};
}
} // namespace coplane
