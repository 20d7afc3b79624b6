#include <coplane_core/Error.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_mesh/FaceName.hpp>
#include <coplane_schema/TimeFunctionEvaluator.hpp>
#include <coplane_setup/ConditionsOfDeck.hpp>
#include <coplane_setup/Lookups.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

namespace coplane
{
namespace
{
bool isConstant(const TimeFunction& card)
{
  return card.expression.empty() && card.times.empty();
}

OfTime functionOf(const TimeFunction& card)
{
  if (isConstant(card))
    return [value = card.constant](Real) { return value; };
  const auto evaluator = std::make_shared<TimeFunctionEvaluator>(card);
  return [evaluator](Real t) { return (*evaluator)(t); };
}

/// Of a vector of any length.
Vec3 directionOf(const Vec3& v)
{
  const Real largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return normalised({v.x / largest, v.y / largest, v.z / largest});
}

bool isZero(const TimeFunction& function)
{
  return function.expression.empty() && function.constant == 0 &&
         std::all_of(function.values.begin(), function.values.end(),
                     [](Real value) { return value == 0; });
}

OfTimeAndPlace fieldOf(const TimeFunction& card)
{
  const auto evaluator = std::make_shared<TimeFunctionEvaluator>(card);
  return [evaluator](Real t, const Vec3& place) { return (*evaluator)(t, place); };
}

VectorOfTime vectorOf(const std::array<TimeFunction, 3>& card)
{
  Vec3 constant;
  std::array<OfTime, 3> functions;
  for (int c = 0; c < 3; ++c)
    if (const TimeFunction& component = card[std::size_t(c)]; isConstant(component))
      constant[c] = component.constant;
    else
      functions[std::size_t(c)] = functionOf(component);
  return {constant, functions};
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

Window windowOf(const ConditionCard& card)
{
  return {card.from, card.until.value_or(infinity)};
}

FreeFieldBoundary freeFieldOf(const ConditionCard& card, const RankMesh& part,
                              const std::vector<RankMesh::Side>& set,
                              const std::vector<BlockSetup>& blocks)
{
  FreeFieldBoundary boundary{card.set, card.where, {}, windowOf(card)};
  for (const RankMesh::Side& side : set)
  {
    const LinearElastic& elastic = elasticity(blocks[side.block].material);
    boundary.sides.push_back({loadedSide(part, side), side.block, side.element,
                              std::sqrt(elastic.density * pWaveModulus(elastic)),
                              std::sqrt(elastic.density * elastic.shearModulus)});
  }
  std::sort(boundary.sides.begin(), boundary.sides.end(),
            [](const auto& a, const auto& b) { return a.side.id < b.side.id; });
  return boundary;
}

std::function<Real(Real)> dampingOf(const TimeFunction& card)
{
  if (card.expression.empty() && card.constant == 0)
    return {};
  return [alpha = functionOf(card), card](Real t)
  {
    const Real value = alpha(t);
    if (value < 0)
      fail(ExitCode::Computation,
           "{}: damping.mass = '{}' is {} 1/s at t = {} s; accepted: not negative. Use max(0, "
           "...).",
           card.where, card.expression, value, t);
    return value;
  };
}

FacePressure pressureOf(const ConditionCard& card, const RankMesh& part,
                        const std::vector<RankMesh::Side>& set)
{
  FacePressure load{sidesOf(part, set), {}, {}, windowOf(card)};
  if (card.pressure.ofPlace)
    load.field = fieldOf(card.pressure);
  else
    load.pressure = functionOf(card.pressure);
  return load;
}

FaceTraction tractionOf(const ConditionCard& card, const RankMesh& part,
                        const std::vector<RankMesh::Side>& set)
{
  FaceTraction load{sidesOf(part, set), {}, {}, windowOf(card)};
  if (std::any_of(card.traction.begin(), card.traction.end(),
                  [](const TimeFunction& f) { return f.ofPlace; }))
    for (int c = 0; c < 3; ++c)
      load.field[c] = fieldOf(card.traction[c]);
  else
    load.traction = vectorOf(card.traction);
  return load;
}

BlastCharge chargeOf(const ConditionCard& card)
{
  return {card.burst == "air" ? Burst::Air : Burst::Surface, card.chargeMass, card.chargePlace,
          card.detonationTime};
}

AirBlast airBlastOf(const ConditionCard& card, const RankMesh& part,
                    const std::vector<RankMesh::Side>& set)
{
  const BlastCharge charge = chargeOf(card);
  AirBlast blast;
  blast.when = windowOf(card);
  for (const LoadedSide& side : sidesOf(part, set))
  {
    Vec3 corners[4];
    for (int k = 0; k < side.count; ++k)
      corners[k] = part.coordinates[side.nodes[k]];
    const std::array<Vec3, 4> areas = cornerAreas(part.dimension, corners, side.count);
    blast.sides.push_back({side, blastWaveOn(charge, side.place, normalOf(areas))});
  }
  return blast;
}

RigidMotion rigidMotionOf(const ConditionCard& card, const Mesh& mesh)
{
  RigidMotion motion;
  motion.where = card.where;
  motion.block = indexOf(mesh.blocks, card.set);
  for (int c = 0; c < 3 && card.translation; ++c)
    if (card.components[c])
    {
      motion.components[c] = true;
      if (!isZero((*card.translation)[c]))
        motion.velocity[c] = functionOf((*card.translation)[c]);
    }
  if (card.spin)
    motion.spin = vectorOf(*card.spin);
  return motion;
}

PrescribedVelocity prescribedOf(const ConditionCard& card, const RankMesh& part,
                                const std::vector<int>& nodes)
{
  PrescribedVelocity condition;
  condition.where = card.where;
  condition.when = windowOf(card);
  condition.nodes = nodes;
  condition.components = card.components;
  condition.of = card.type == "displacement"   ? PrescribedVelocity::Of::Displacement
                 : card.type == "acceleration" ? PrescribedVelocity::Of::Acceleration
                                               : PrescribedVelocity::Of::Velocity;
  const auto& motion = card.motion();
  for (int c = 0; c < 3 && card.type != "fixed"; ++c)
    if (motion[c].ofPlace && condition.components[c])
      condition.field[c] = fieldOf(motion[c]);
    else
      condition.velocity[c] = functionOf(motion[c]);
  if (condition.hasField())
    for (const int n : nodes)
      condition.places.push_back(part.coordinates[n]);
  return condition;
}
} // namespace

Conditions conditionsOf(const Deck& deck, const Mesh& mesh, const RankMesh& part,
                        const std::vector<BlockSetup>& blocks)
{
  Conditions conditions;
  conditions.gravity = vectorOf(deck.gravity);
  conditions.massDamping = dampingOf(deck.massDamping);
  conditions.localDamping = deck.localDamping;
  conditions.dampingFrom = deck.dampingFrom;
  conditions.dampingUntil = deck.dampingUntil.value_or(infinity);
  conditions.relaxation = {deck.kineticDamping, deck.dampingEnergyRatio.value_or(0),
                           deck.dampingForceRatio.value_or(0)};
  for (const ConditionCard& card : deck.conditions)
    if (card.onSides())
    {
      const auto& set = part.sideSets[indexOf(mesh.sideSets, card.set)];
      if (card.type == "pressure")
        conditions.pressures.push_back(pressureOf(card, part, set));
      else if (card.type == "traction")
        conditions.tractions.push_back(tractionOf(card, part, set));
      else if (card.type == "air_blast")
        conditions.airBlasts.push_back(airBlastOf(card, part, set));
      else if (card.type == "free_field")
        conditions.freeFields.push_back(freeFieldOf(card, part, set, blocks));
      else
        conditions.absorbing.push_back(
            {absorbingSidesOf(part, set, blocks), vectorOf(card.incident), windowOf(card)});
    }
    else if (card.type == "rigid_motion")
      conditions.rigidMotions.push_back(rigidMotionOf(card, mesh));
    else
    {
      const std::vector<int>& nodes = part.nodeSets[indexOf(mesh.nodeSets, card.set)];
      if (card.type == "symmetry")
        conditions.symmetries.push_back(
            {nodes, directionOf(card.normal), windowOf(card), card.where});
      else
        conditions.velocities.push_back(prescribedOf(card, part, nodes));
    }
  return conditions;
}

void bringToAxis(MeshSlice& mesh, const Comm& comm)
{
  Real farthest = 0;
  for (const Vec3& x : mesh.mine.coordinates)
    farthest = std::max(farthest, std::abs(x.x));
  farthest = comm.max(farthest);
  for (Vec3& x : mesh.mine.coordinates)
    if (std::abs(x.x) <= 1e-9 * farthest)
      x.x = 0;
}

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

namespace
{
bool prescribesMotion(const ConditionCard& card)
{
  return card.type == "fixed" || card.type == "velocity" || card.type == "displacement" ||
         card.type == "acceleration";
}

/// Whether a card of prescribed motion moves nodes along the normal of a symmetry.
bool movesAcross(const ConditionCard& card, const Vec3& normal)
{
  const Real along[] = {normal.x, normal.y, normal.z};
  const auto& motion = card.motion();
  for (int c = 0; c < 3 && card.type != "fixed"; ++c)
    if (card.components[c] && along[c] != 0 && !isZero(motion[c]))
      return true;
  return false;
}

/// Nodes on which two conditions contradict each other, for each pair of conditions.
class Contradictions
{
public:
  explicit Contradictions(const Deck& deck)
      : conditions_(deck.conditions), nodes_(count() * count(), 0),
        lowest_(count() * count(), INT64_MAX)
  {
  }
  void add(std::size_t first, std::size_t second, GlobalId node)
  {
    const std::size_t pair = first * count() + second;
    ++nodes_[pair];
    lowest_[pair] = std::min(lowest_[pair], std::int64_t(node));
  }
  /// Collective.
  void warn(const Comm& comm)
  {
    comm.sum(nodes_);
    for (std::size_t pair = 0; pair < nodes_.size(); ++pair)
      if (nodes_[pair] > 0)
      {
        const ConditionCard &first = conditions_[pair / count()],
                            &second = conditions_[pair % count()];
        logWarning("two conditions on one node",
                   fmt::format("{} ({} of '{}') and {} ({} of '{}') prescribe the same component "
                               "of {} nodes, the first of which is node {}: the second acts there. "
                               "Take these nodes out of one of the sets.",
                               first.where, first.type, first.set, second.where, second.type,
                               second.set, nodes_[pair], comm.min(lowest_[pair])));
      }
  }

private:
  std::size_t count() const { return conditions_.size(); }

  const std::vector<ConditionCard>& conditions_;
  std::vector<std::int64_t> nodes_, lowest_;
};
} // namespace

void warnOfDoubleConditions(const Deck& deck, const Mesh& mesh, const RankMesh& part,
                            const Comm& comm)
{
  Contradictions found(deck);
  const auto& cards = deck.conditions;
  const auto nodesOf = [&](const ConditionCard& card) -> const std::vector<int>&
  { return part.nodeSets[std::size_t(indexOf(mesh.nodeSets, card.set))]; };
  const auto share = [&](const ConditionCard& a, const ConditionCard& b)
  {
    bool component = false;
    for (std::size_t c = 0; c < std::size_t(part.dimension); ++c)
      component |= a.components[c] && b.components[c];
    return component && !(a.type == "fixed" && b.type == "fixed") &&
           windowOf(a).overlaps(windowOf(b));
  };
  for (std::size_t i = 0; i < cards.size(); ++i)
  {
    if (!prescribesMotion(cards[i]))
      continue;
    std::vector<char> held(std::size_t(part.nodes()), 0);
    for (const int node : nodesOf(cards[i]))
      held[std::size_t(node)] = 1;
    for (std::size_t k = i + 1; k < cards.size(); ++k)
      for (const int node : prescribesMotion(cards[k]) && share(cards[i], cards[k])
                                ? nodesOf(cards[k])
                                : std::vector<int>())
        if (held[std::size_t(node)] && node < part.ownedNodes)
          found.add(i, k, part.nodeIds[node]);
  }
  for (std::size_t i = 0; i < cards.size(); ++i)
  {
    if (cards[i].type != "symmetry")
      continue;
    std::vector<char> held(std::size_t(part.nodes()), 0);
    for (const int node : nodesOf(cards[i]))
      held[std::size_t(node)] = 1;
    for (std::size_t k = 0; k < cards.size(); ++k)
      for (const int node : prescribesMotion(cards[k]) &&
                                    windowOf(cards[k]).overlaps(windowOf(cards[i])) &&
                                    movesAcross(cards[k], cards[i].normal)
                                ? nodesOf(cards[k])
                                : std::vector<int>())
        if (held[std::size_t(node)] && node < part.ownedNodes)
          found.add(i, k, part.nodeIds[node]);
  }
  found.warn(comm);
}

namespace
{
/// Least and largest distance of the charge from a face, over all ranks [m]. Collective.
std::pair<Real, Real> distancesFrom(const Vec3& charge, const RankMesh& part,
                                    const std::vector<RankMesh::Side>& set, const Comm& comm)
{
  Real least = infinity, largest = 0;
  for (const LoadedSide& side : sidesOf(part, set))
  {
    const Real distance = norm(side.place - charge);
    least = std::min(least, distance);
    largest = std::max(largest, distance);
  }
  return {comm.min(least), comm.max(largest)};
}
} // namespace

std::vector<std::string> problemsOfAirBlasts(const Deck& deck, const Mesh& mesh,
                                             const RankMesh& part, const Comm& comm)
{
  std::vector<std::string> problems;
  for (const ConditionCard& card : deck.conditions)
  {
    const int set = card.type == "air_blast" ? indexOf(mesh.sideSets, card.set) : -1;
    if (set < 0)
      continue;
    const Vec3& place = card.chargePlace;
    if (deck.geometry == "axisymmetric" && (place.x != 0 || place.z != 0))
      problems.push_back(fmt::format("{}: charge_place is [{}, {}, {}], off the axis; accepted in "
                                     "a body of revolution: [0, y, 0].",
                                     card.where, place.x, place.y, place.z));
    const auto [least, largest] = distancesFrom(place, part, part.sideSets[set], comm);
    const ScaledDistances range = blastRange(chargeOf(card).burst);
    const Real size = std::cbrt(card.chargeMass);
    if (least < range.least * size || largest > range.largest * size)
      problems.push_back(fmt::format(
          "{}: air blast on '{}': its faces are {:.6g} to {:.6g} m from the charge, scaled {:.4g} "
          "to {:.4g} m/kg^(1/3); accepted for burst: {}: {} to {} m/kg^(1/3), here {:.6g} to "
          "{:.6g} m, beyond which there are no measurements. Take other faces out of the set; "
          "near a charge, mesh it (model: jwl) or give a pressure.",
          card.where, card.set, least, largest, least / size, largest / size, card.burst,
          range.least, range.largest, range.least * size, range.largest * size));
  }
  return problems;
}

namespace
{
bool hasDashpots(const ConditionCard& card)
{
  return card.type == "absorbing" || card.type == "free_field";
}

/// The faces of a set of this rank's own elements, sorted by id.
std::vector<GlobalId> ownFacesOf(const RankMesh& part, const std::vector<RankMesh::Side>& set)
{
  std::vector<GlobalId> faces;
  for (const RankMesh::Side& side : set)
    if (part.blocks[std::size_t(side.block)].owned[std::size_t(side.element)])
      faces.push_back(loadedSide(part, side).id);
  std::sort(faces.begin(), faces.end());
  return faces;
}
} // namespace

std::vector<std::string> problemsOfDashpots(const Deck& deck, const Mesh& mesh,
                                            const RankMesh& part, const Comm& comm)
{
  std::vector<std::string> problems;
  const auto& cards = deck.conditions;
  const auto setOf = [&](const ConditionCard& card)
  { return hasDashpots(card) ? indexOf(mesh.sideSets, card.set) : -1; };
  for (std::size_t i = 0; i < cards.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
    {
      const int mine = setOf(cards[i]), other = setOf(cards[k]);
      if (mine < 0 || other < 0 || !windowOf(cards[i]).overlaps(windowOf(cards[k])))
        continue;
      const std::vector<GlobalId> a = ownFacesOf(part, part.sideSets[std::size_t(mine)]),
                                  b = ownFacesOf(part, part.sideSets[std::size_t(other)]);
      std::vector<GlobalId> both;
      std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
      const std::int64_t count = comm.sum(std::int64_t(both.size()));
      const GlobalId first = comm.min(both.empty() ? INT64_MAX : both.front());
      if (count > 0)
        problems.push_back(fmt::format(
            "{}: {} side set '{}' has {} faces that the {} side set '{}' of {} has, too, {} the "
            "first: dashpots of both would act there at once. Accepted: one of the two on a face "
            "at a time; take one out, or give them other times.",
            cards[i].where, cards[i].type, cards[i].set, count, cards[k].type, cards[k].set,
            cards[k].where, faceName(first)));
    }
  return problems;
}

namespace
{
/// Nodes of rigid blocks of the deck.
std::vector<char> rigidNodes(const Deck& deck, const Mesh& mesh, const RankMesh& part)
{
  std::vector<char> rigid(std::size_t(part.nodes()), 0);
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    if (const int card = indexOf(deck.blocks, mesh.blocks[b].name);
        card >= 0 && deck.blocks[std::size_t(card)].rigid)
      for (const int node : part.blocks[b].connectivity)
        rigid[std::size_t(node)] = 1;
  return rigid;
}

/// Nodes whose motion conditions of the deck, or the axis of a body of revolution, hold.
std::vector<char> heldNodes(const Deck& deck, const Mesh& mesh, const RankMesh& part)
{
  std::vector<char> held(std::size_t(part.nodes()), 0);
  for (const ConditionCard& card : deck.conditions)
    if (const int set = prescribesMotion(card) || card.type == "symmetry"
                            ? indexOf(mesh.nodeSets, card.set)
                            : -1;
        set >= 0)
      for (const int node : part.nodeSets[std::size_t(set)])
        held[std::size_t(node)] = 1;
  for (int n = 0; n < part.nodes() && deck.geometry == "axisymmetric"; ++n)
    if (part.coordinates[std::size_t(n)].x == 0)
      held[std::size_t(n)] = 1;
  return held;
}
} // namespace

std::vector<std::string> problemsOfReactions(const Deck& deck, const Mesh& mesh,
                                             const RankMesh& part, const Comm& comm)
{
  std::vector<std::string> problems;
  const std::vector<char> rigid = rigidNodes(deck, mesh, part), held = heldNodes(deck, mesh, part);
  for (std::size_t p = 0; p < deck.history.probes.size(); ++p)
  {
    const ProbeCard& probe = deck.history.probes[p];
    const int set = probe.reaction ? indexOf(mesh.nodeSets, probe.nodeSet) : -1;
    if (set < 0)
      continue;
    std::vector<std::int64_t> count{0, 0}; // rigid, held
    for (const int node : part.nodeSets[std::size_t(set)])
    {
      count[0] += rigid[std::size_t(node)];
      count[1] += held[std::size_t(node)];
    }
    comm.sum(count);
    if (count[0] > 0)
      problems.push_back(fmt::format(
          "{}: history.probes.{}.reaction: node set '{}' has nodes of rigid blocks, which are held "
          "as a whole; take them out of the set. history.rigid writes the reactions of bodies.",
          probe.where, p, probe.nodeSet));
    else if (count[1] == 0)
      problems.push_back(fmt::format(
          "{}: history.probes.{}.reaction: no condition holds a node of '{}'; accepted: a node set "
          "of which fixed, velocity, displacement, acceleration or symmetry holds nodes. Remove "
          "reaction, or "
          "name such a set.",
          probe.where, p, probe.nodeSet));
  }
  return problems;
}
} // namespace coplane
