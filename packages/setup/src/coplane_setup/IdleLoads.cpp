#include <coplane_core/Log.hpp>
#include <coplane_material/Jwl.hpp>
#include <coplane_setup/IdleLoads.hpp>
#include <coplane_setup/Lookups.hpp>

#include <algorithm>
#include <set>

namespace coplane
{
namespace
{
constexpr const char* topic = "loads that never act";

void warnOfLateBlast(const ConditionCard& card, const AirBlast& blast, Real end, const Comm& comm)
{
  Real first = infinity, last = -infinity; // of the positive phase on any face
  for (const BlastSide& side : blast.sides)
  {
    first = std::min(first, side.wave.arrival);
    last = std::max(last, side.wave.arrival +
                              std::max(side.wave.incident.duration, side.wave.reflected.duration));
  }
  first = comm.min(first);
  last = comm.max(last);
  if (!(first <= last))
    return; // no faces
  if (first >= end)
    logWarning(topic, fmt::format("{}: the blast wave arrives at '{}' at {:.5g} s, after the end "
                                  "at {:.5g} s. Check detonation_time and charge_place, or raise "
                                  "time.end.",
                                  card.where, card.set, first, end));
  else if (first >= blast.when.until)
    logWarning(topic, fmt::format("{}: the blast wave arrives at '{}' at {:.5g} s, and the "
                                  "condition acts until {:.5g} s. Check `until`, detonation_time "
                                  "and charge_place.",
                                  card.where, card.set, first, blast.when.until));
  else if (last <= 0)
    logWarning(topic, fmt::format("{}: the blast wave has left '{}' at {:.5g} s, before the start "
                                  "at 0 s. Check detonation_time.",
                                  card.where, card.set, last));
  else if (last <= blast.when.from)
    logWarning(topic, fmt::format("{}: the blast wave has left '{}' at {:.5g} s, and the condition "
                                  "acts from {:.5g} s on. Check `from`.",
                                  card.where, card.set, last, blast.when.from));
}

struct Lit
{
  Real burns = infinity;      ///< when the first front reaches an element [s]
  std::vector<Real> distance; ///< of each lighting point from the nearest element [m]
  Real size = -infinity;      ///< longest side of the box of the block's elements [m]
};

/// Collective.
Lit litBlock(const Jwl& law, const Solver& solver, std::size_t b, const Comm& comm)
{
  const ElementBlock& block = solver.blocks()[b];
  const RankMesh::Block& part = solver.mesh().blocks[b];
  const int corners = topology(part.type).nodes;
  std::vector<Real> least(std::size_t(law.points) + 4, infinity); // box below; burns; distances
  std::vector<Real> most(3, -infinity);                           // box above
  for (int e = 0; e < block.count(); ++e)
  {
    if (block.isTakenOut(e))
      continue; // a stage adds it
    Vec3 centre;
    for (int k = 0; k < corners; ++k)
    {
      const Vec3 x = at(solver.state().x, part.connectivity[std::size_t(e * corners + k)]);
      centre += (1.0 / corners) * x;
      for (int c = 0; c < 3; ++c)
      {
        least[std::size_t(c)] = std::min(least[std::size_t(c)], x[c]);
        most[std::size_t(c)] = std::max(most[std::size_t(c)], x[c]);
      }
    }
    least[3] = std::min(least[3], block.history(Jwl::TimeToBurn, e));
    for (int i = 0; i < law.points; ++i)
      least[std::size_t(4 + i)] = std::min(least[std::size_t(4 + i)], norm(centre - law.point[i]));
  }
  comm.min(least);
  comm.max(most);
  Lit lit;
  lit.burns = least[3];
  for (int i = 0; i < law.points; ++i)
    lit.distance.push_back(least[std::size_t(4 + i)]);
  for (std::size_t c = 0; c < 3; ++c)
    lit.size = std::max(lit.size, most[c] - least[c]);
  return lit;
}

void warnOfUnlitBlock(const std::string& name, const Jwl& law, const Lit& lit, Real end)
{
  if (!(lit.size >= 0))
    return; // nothing of it is there
  for (int i = 0; i < law.points; ++i)
    if (const Real distance = lit.distance[std::size_t(i)]; distance > lit.size)
      logWarning(
          "lighting points",
          fmt::format("block '{}': lighting point {} at ({:g}, {:g}, {:g}) m is {:.4g} m "
                      "from the nearest middle of an element of the explosive, which is {:.4g} m "
                      "long. "
                      "Points are in m{}.",
                      name, i, law.point[i].x, law.point[i].y, law.point[i].z, distance, lit.size,
                      law.point[i].z != 0 ? ", z is 0 in two dimensions" : ""));
  if (lit.burns >= end)
    logWarning(topic, fmt::format("block '{}': the first front reaches the explosive at {:.5g} s, "
                                  "after the end at {:.5g} s, so none of it burns. Check "
                                  "lighting_points and lighting_times, or raise time.end.",
                                  name, lit.burns, end));
}

/// Collective.
void warnOfElementsThatDieAtOnce(const Solver& solver, std::size_t b, const Comm& comm)
{
  const ElementBlock& block = solver.blocks()[b];
  const ErosionRule rule(solver.model().blocks[b].erosion, block);
  std::vector<std::int64_t> counts(2, 0); // those that die, all
  for (int e = 0; e < block.count(); ++e)
    if (solver.mesh().blocks[b].owned[std::size_t(e)] && !block.isTakenOut(e))
    {
      counts[0] += rule.kills(block, e);
      ++counts[1];
    }
  comm.sum(counts);
  if (counts[0] > 0)
    logWarning("elements that die at once",
               fmt::format("block '{}': {} of {} elements are beyond a limit of erosion at the "
                           "start, and die in the first cycle. Check blocks.{}.erosion.",
                           solver.model().blocks[b].name, counts[0], counts[1],
                           solver.model().blocks[b].name));
}
} // namespace

void warnOfIdleLoads(const std::vector<Deck>& decks, const MeshSlice& mesh, const Solver& solver,
                     const Comm& comm)
{
  const Deck& first = decks.front();
  const Real end = decks.back().time.end;
  // A condition stands in the decks of all its stages, which may change when it acts.
  std::set<std::string> doneWith;
  for (const Deck& deck : decks)
    for (const ConditionCard& card : deck.conditions)
      if (card.from < end)
        doneWith.insert(card.where);
  for (const Deck& deck : decks)
    for (const ConditionCard& card : deck.conditions)
      if (card.from >= end && doneWith.insert(card.where).second)
        logWarning(topic, fmt::format("{}: {} acts from {:.5g} s on, and the run ends at {:.5g} s. "
                                      "Check `from`, or raise time.end.",
                                      card.where, card.type, card.from, end));
  const auto& blasts = solver.model().conditions.airBlasts;
  std::size_t blast = 0;
  for (const ConditionCard& card : first.conditions)
    if (card.type == "air_blast")
      warnOfLateBlast(card, blasts.at(blast++), end, comm);
  for (std::size_t b = 0; b < mesh.mine.blocks.size(); ++b)
  {
    const BlockSetup& setup = solver.model().blocks[b];
    if (setup.erosion.any())
      warnOfElementsThatDieAtOnce(solver, b, comm);
    if (std::holds_alternative<Jwl>(setup.material) && setup.rigid)
      logWarning(topic, fmt::format("block '{}' is rigid: nothing is computed in its elements, so "
                                    "the explosive does not burn. Leave out blocks.{}.rigid.",
                                    setup.name, setup.name));
    else if (const auto* law = std::get_if<Jwl>(&setup.material); law && law->points > 0)
      warnOfUnlitBlock(setup.name, *law, litBlock(*law, solver, b, comm), end);
  }
}
} // namespace coplane
