#include <coplane_core/Error.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/Erosion.hpp>

#include <algorithm>

namespace coplane
{
Erosion::Erosion(const Model& model, const ElementForces& elements)
    : rules_(elements.blocks().size()), energies_(elements.blocks().size())
{
  for (std::size_t b = 0; b < rules_.size(); ++b)
    if (model.blocks[b].erosion.any())
    {
      rules_[b].emplace(model.blocks[b].erosion, elements.blocks()[b]);
      acts_ = true;
    }
  acts_ = acts_ || model.blocksComeOrGo;
  if (!acts_)
    return;
  sides_.emplace(model.mesh);
  recount(model.mesh, elements);
}

/// What is alive, and how many living elements there are around each owned node.
void Erosion::recount(const RankMesh& mesh, const ElementForces& elements)
{
  alive_.assign(mesh.blocks.size(), {});
  livingElements_.assign(std::size_t(mesh.ownedNodes), 0);
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    const RankMesh::Block& part = mesh.blocks[b];
    const std::size_t corners = std::size_t(topology(part.type).nodes);
    for (int e = 0; e < part.elements(); ++e)
    {
      const bool lives = elements.blocks()[b].isAlive(e);
      alive_[b].push_back(lives);
      for (std::size_t k = 0; k < corners && lives; ++k)
        if (const int node = part.connectivity[std::size_t(e) * corners + k];
            node < mesh.ownedNodes)
          ++livingElements_[std::size_t(node)];
    }
  }
}

void Erosion::beginWithout(const std::vector<int>& blocks, const RankMesh& mesh,
                           ElementForces& elements)
{
  for (const int b : blocks)
    for (int e = 0; e < mesh.blocks[std::size_t(b)].elements(); ++e)
      elements.block(std::size_t(b)).takeOut(e);
  recount(mesh, elements);
}

/// Block and element of those that meet their criterion. Ranks that hold the same element decide
/// alike, from the same bits.
std::vector<std::pair<int, int>> Erosion::dying(const ElementForces& elements,
                                                const std::vector<int>& leaving) const
{
  std::vector<std::pair<int, int>> found;
  for (std::size_t b = 0; b < rules_.size(); ++b)
  {
    const ElementBlock& block = elements.blocks()[b];
    if (std::find(leaving.begin(), leaving.end(), int(b)) != leaving.end())
    {
      for (int e = 0; e < block.count(); ++e)
        if (!block.isTakenOut(e)) // also those that have eroded: their mass is still there
          found.emplace_back(int(b), e);
      continue;
    }
    if (!rules_[b])
      continue;
    const ErosionRule& rule = *rules_[b];
    const Real first =
        parallelMin("coplane::dynamics::erode", block.count(),
                    [&](const int e) { return rule.kills(block, e) ? Real(e) : infinity; });
    for (int e = first < infinity ? int(first) : block.count(); e < block.count(); ++e)
      if (rule.kills(block, e))
        found.emplace_back(int(b), e);
  }
  return found;
}

std::vector<GlobalId> Erosion::erode(const RankMesh& mesh, ElementForces& elements,
                                     const Substep& cycle, const Array<Real>& substeps,
                                     const Substep& last, const std::vector<int>& leaving,
                                     const Comm& comm)
{
  if (!acts_)
    return {};
  TimedRegion region("coplane::dynamics::erode");
  const std::vector<std::pair<int, int>> mine = dying(elements, leaving);
  if (comm.max(std::int64_t(!mine.empty())) == 0)
    return {};
  std::vector<GlobalId> dead;
  for (const auto& [b, e] : mine)
    if (mesh.blocks[b].owned[e])
      dead.push_back(mesh.blocks[b].elementIds[e]);
  dead = comm.allGather(dead);
  std::sort(dead.begin(), dead.end());
  for (const auto& [b, e] : mine)
  {
    const RankMesh::Block& part = mesh.blocks[b];
    const bool lives = elements.blocks()[b].isAlive(e);
    const int corners = topology(part.type).nodes;
    const int* const nodes = part.connectivity.data() + std::size_t(e) * std::size_t(corners);
    const bool isSubstepped =
        std::any_of(nodes, nodes + corners, [&](int n) { return substeps(n) > 1; });
    if (part.owned[e] && lives)
      book(part, elements.blocks()[b], b, e, isSubstepped ? last : cycle);
    if (std::find(leaving.begin(), leaving.end(), b) != leaving.end())
      elements.block(b).takeOut(e);
    else
      elements.block(b).erode(e);
    if (lives)
      forget(part, b, e);
  }
  return dead;
}

void Erosion::book(const RankMesh::Block& part, const ElementBlock& block, int b, int e,
                   const Substep& step)
{
  // The element gives no force at the end of this step: what its energy got from that force over
  // the second half of the step has not been taken from the nodes.
  const int corners = topology(part.type).nodes;
  const auto force = block.cornerForce();
  Real power = 0;
  for (int k = 0; k < corners; ++k)
    power += dot(Vec3{force(e, k, 0), force(e, k, 1), force(e, k, 2)},
                 at(step.v, part.connectivity[e * corners + k]));
  ExactSum& sum = energies_[b];
  sum.add(0.5 * step.dt * power);
  sum.add(-block.workLeftToNodes(e));
  for (const ElementEnergy kind :
       {ElementEnergy::Internal, ElementEnergy::Hourglass, ElementEnergy::Viscous})
    sum.add(block.energy(e, kind));
  mass_.add(block.mass(e));
  ++count_;
}

void Erosion::forget(const RankMesh::Block& part, int b, int e)
{
  alive_[b][e] = 0;
  const int corners = topology(part.type).nodes;
  for (int k = 0; k < corners; ++k)
    if (const std::size_t node = part.connectivity[e * corners + k]; node < livingElements_.size())
      --livingElements_[node];
}

ErosionTotals Erosion::totals(const Comm& comm) const
{
  std::vector<ExactSum> mass{mass_};
  return {comm.sum(count_), ExactSum::overRanks(mass, comm)[0]};
}

void Erosion::save(StateTables& out, const Comm& comm) const
{
  std::vector<ExactSum> sums = energies_;
  sums.push_back(mass_);
  std::vector<Real> eroded{Real(comm.sum(count_))};
  for (const ExactSum& sum : ExactSum::totals(sums, comm))
    for (const Real digit : sum.digits())
      eroded.push_back(digit);
  out.numbers("solver/eroded", eroded);
}

std::vector<GlobalId> Erosion::restore(const RankMesh& mesh, const ElementForces& elements,
                                       const StateSource& in, const Comm& comm)
{
  const std::vector<Real> eroded = in.numbers("solver/eroded");
  if (eroded.size() != 1 + (energies_.size() + 1) * ExactSum::digitCount)
    failOnAllRanks(ExitCode::Checkpoint, "{}: the checkpoint has another number of blocks.",
                   in.name());
  if (comm.isRoot()) // sums over ranks
  {
    const auto sumAt = [&](std::size_t i)
    { return ExactSum::fromDigits(&eroded[1 + i * ExactSum::digitCount]); };
    count_ = std::int64_t(eroded[0]);
    for (std::size_t b = 0; b < energies_.size(); ++b)
      energies_[b] = sumAt(b);
    mass_ = sumAt(energies_.size());
  }
  if (!acts_)
    return {};
  recount(mesh, elements);
  return dead(mesh, elements, comm);
}

std::vector<GlobalId> Erosion::dead(const RankMesh& mesh, const ElementForces& elements,
                                    const Comm& comm) const
{
  std::vector<GlobalId> dead;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    const RankMesh::Block& part = mesh.blocks[b];
    for (int e = 0; e < part.elements(); ++e)
      if (!elements.blocks()[b].isAlive(e) && part.owned[e])
        dead.push_back(part.elementIds[e]);
  }
  dead = comm.allGather(dead);
  std::sort(dead.begin(), dead.end());
  return dead;
}
} // namespace coplane
