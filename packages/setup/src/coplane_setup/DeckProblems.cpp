#include <coplane_core/Log.hpp>
#include <coplane_input/MaterialCards.hpp>
#include <coplane_schema/UsualRanges.hpp>
#include <coplane_setup/DeckProblems.hpp>
#include <coplane_setup/Lookups.hpp>
#include <coplane_setup/detail/BlocksOfDeck.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
std::vector<std::string> problemsOfLaws(const Deck& deck, int dimension)
{
  std::vector<std::string> problems;
  for (const BlockCard& card : deck.blocks)
  {
    const MaterialCard& material = materialCardOf(deck, card);
    if (const std::string problem =
            dimension == 2 ? problemInTheFlat(material, deck.geometry == "axisymmetric") : "";
        !problem.empty())
      problems.push_back(fmt::format("{}: blocks.{}: material '{}': {}.", card.where, card.name,
                                     material.name, problem));
    const std::vector<std::string> names = historyNames(materialOf(material));
    for (const std::string& wanted : erosionOf(card.erosion).variableNames())
      if (std::find(names.begin(), names.end(), wanted) == names.end())
        problems.push_back(fmt::format(
            "{}: blocks.{}.erosion asks for '{}', but material '{}' ({}) {}.", card.where,
            card.name, wanted, material.name, material.model,
            names.empty() ? std::string("has no variables; use volume_ratio or stable_step")
                          : fmt::format("has only {}", fmt::join(names, ", "))));
  }
  return problems;
}

namespace
{
std::vector<char> rigidBlocksOf(const Deck& deck, const Mesh& mesh)
{
  std::vector<char> rigid;
  for (const Mesh::Block& block : mesh.blocks)
  {
    const int card = indexOf(deck.blocks, block.name);
    rigid.push_back(card >= 0 && deck.blocks[card].rigid);
  }
  return rigid;
}

/// The lowest rigid block that has a side in a set, over all ranks; -1: none. Collective.
int rigidBlockBehind(const Mesh::SideSet& set, const std::vector<char>& rigid,
                     const MeshSlice& slice, const Comm& comm)
{
  std::int64_t block = std::int64_t(rigid.size());
  for (const int element : set.elements)
    if (const int other = slice.placeOf(element).first; rigid[other])
      block = std::min(block, std::int64_t(other));
  block = comm.min(block);
  return block < std::int64_t(rigid.size()) ? int(block) : -1;
}
} // namespace

std::vector<std::string> problemsOfRigidBlocks(const Deck& deck, const MeshSlice& slice,
                                               const Comm& comm)
{
  std::vector<std::string> problems;
  const Mesh& mesh = slice.mine;
  const std::vector<char> rigid = rigidBlocksOf(deck, mesh);
  for (const ConditionCard& card : deck.conditions)
    for (int c = 0; c < 2 && card.spin && mesh.dimension == 2; ++c)
      if (const TimeFunction& spin = (*card.spin)[c];
          spin.constant != 0 || !spin.expression.empty() || !spin.times.empty())
        problems.push_back(fmt::format(
            "{}: angular_velocity about {} of the rigid block '{}', but the mesh has two "
            "dimensions; accepted: 0 there, a spin about z.",
            card.where, "xy"[c], card.set));
  for (const ConditionCard& card : deck.conditions)
    if (const int set = card.type == "absorbing" || card.type == "free_field"
                            ? indexOf(mesh.sideSets, card.set)
                            : -1;
        set >= 0)
      if (const int block = rigidBlockBehind(mesh.sideSets[set], rigid, slice, comm); block >= 0)
        problems.push_back(
            fmt::format("{}: {} side set '{}' has a side of the rigid block '{}', through which no "
                        "waves run; take it out of the set, or remove rigid.",
                        card.where, card.type, card.set, mesh.blocks[block].name));
  return problems;
}

namespace
{
struct NearestNode
{
  Real distance = 0; ///< [m]
  GlobalId id = 0;
  Vec3 place{};
  Real size = 0; ///< the longest way between two nodes of an element there [m]
};

/// Collective.
NearestNode nearestNodeTo(const Vec3& point, const RankMesh& part, const Comm& comm)
{
  NearestNode nearest;
  nearest.distance = infinity;
  for (const Vec3& x : part.coordinates)
    nearest.distance = std::min(nearest.distance, norm(x - point));
  nearest.distance = comm.min(nearest.distance);
  std::int64_t id = INT64_MAX;
  for (std::size_t n = 0; n < part.coordinates.size(); ++n)
    if (norm(part.coordinates[n] - point) == nearest.distance)
      id = std::min(id, std::int64_t(part.nodeIds[n]));
  nearest.id = GlobalId(comm.min(id));
  std::vector<Real> most(4, -infinity); // place, size
  for (std::size_t n = 0; n < part.coordinates.size(); ++n)
    for (int c = 0; c < 3 && part.nodeIds[n] == nearest.id; ++c)
      most[std::size_t(c)] = part.coordinates[n][c];
  for (const RankMesh::Block& block : part.blocks)
  {
    const std::size_t corners = std::size_t(topology(block.type).nodes);
    for (auto first = block.connectivity.begin(); first < block.connectivity.end();
         first += long(corners))
    {
      const auto last = first + long(corners);
      if (std::none_of(first, last, [&](int n) { return part.nodeIds[n] == nearest.id; }))
        continue;
      for (auto a = first; a < last; ++a)
        for (auto b = first; b < a; ++b)
          most[3] = std::max(most[3], norm(part.coordinates[*a] - part.coordinates[*b]));
    }
  }
  comm.max(most);
  nearest.place = {most[0], most[1], most[2]};
  nearest.size = most[3];
  return nearest;
}
} // namespace

std::vector<std::string> problemsOfProbes(const Deck& deck, const RankMesh& part, const Comm& comm)
{
  std::vector<std::string> problems;
  const auto farText = [&](const ProbeCard& probe, std::size_t p, const char* key,
                           const Vec3& point) -> std::string
  {
    const NearestNode nearest = nearestNodeTo(point, part, comm);
    if (nearest.distance <= nearest.size)
      return "";
    return fmt::format("{}: history.probes.{}.{}: ({:g}, {:g}, {:g}) m is beside all bodies, "
                       "{:.4g} m from the nearest node, {} at ({:g}, {:g}, {:g}) m, where elements "
                       "are {:.3g} m long. Accepted: points in or at a body, in m.",
                       probe.where, p, key, point.x, point.y, point.z, nearest.distance, nearest.id,
                       nearest.place.x, nearest.place.y, nearest.place.z, nearest.size);
  };
  for (std::size_t p = 0; p < deck.history.probes.size(); ++p)
  {
    const ProbeCard& probe = deck.history.probes[p];
    for (const auto& [key, point] :
         {std::pair("point", probe.point), std::pair("plane", probe.plane)})
      if (const std::string text = point ? farText(probe, p, key, *point) : ""; !text.empty())
        problems.push_back(text);
    if (probe.between.size() != 2)
      continue;
    const auto end = [&](std::size_t i)
    {
      const std::vector<Real>& x = probe.between[i];
      return Vec3{x[0], x[1], x.size() > 2 ? x[2] : 0};
    };
    for (int k = 0; k < probe.count; ++k)
    {
      const Vec3 point = end(0) + (Real(k) / (probe.count - 1)) * (end(1) - end(0));
      if (const std::string text = farText(probe, p, "between", point); !text.empty())
      {
        logWarning("probes beside all bodies", text);
        break; // one of a line is enough
      }
    }
  }
  return problems;
}

void warnOfInitialStress(const Deck& deck, const Mesh& mesh, const RankMesh& part, const Comm& comm)
{
  constexpr Real share = 0.1;                     // of the modulus
  std::vector<Real> most(deck.initial.size(), 0); // by card [Pa]
  for (std::size_t i = 0; i < most.size(); ++i)
  {
    const InitialCard& card = deck.initial[i];
    const Vec3 axis = normalised(card.stressAxis);
    for (const RankMesh::Block& block : part.blocks)
      if (block.meshBlock == indexOf(mesh.blocks, card.block))
        for (const int node : block.connectivity)
        {
          const Real along = dot(axis, part.coordinates[std::size_t(node)] - card.stressPoint);
          for (std::size_t c = 0; c < 6; ++c)
            most[i] = std::max(most[i], std::abs(card.stress[c] + along * card.stressGradient[c]));
        }
  }
  comm.max(most);
  for (std::size_t i = 0; i < most.size(); ++i)
  {
    const InitialCard& card = deck.initial[i];
    const int block = indexOf(deck.blocks, card.block);
    if (block < 0 || most[i] == 0)
      continue;
    const BlockCard& of = deck.blocks[std::size_t(block)];
    const Material material = materialOf(materialCardOf(deck, of));
    // The initial stress of a fluid is its state.
    if (const Real modulus = pWaveModulus(material);
        elasticity(material).shearModulus > 0 && most[i] > share * modulus)
      logWarning("initial stress",
                 fmt::format("{}: initial stress of up to {:.4g} Pa in block '{}' is {:.3g} % of "
                             "the P-wave modulus of material '{}', {:.4g} Pa. Usual: up to {:g} %. "
                             "{}",
                             card.where, most[i], card.block, 100 * most[i] / modulus, of.material,
                             modulus, 100 * share, usual::ofPressure));
  }
}
} // namespace coplane
