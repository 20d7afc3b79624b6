// Elements that die: they leave the mesh at the end of the cycle in which they meet their
// criterion, and the faces behind them take part in contact from the same cycle on.
#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/ContactFaces.hpp>
#include <coplane_dynamics/Erosion.hpp>
#include <coplane_dynamics/Solver.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
std::vector<std::string> ErosionCriteria::variableNames() const
{
  std::vector<std::string> names;
  if (damage)
    names.push_back("damage");
  for (const Limit& limit : variables)
    names.push_back(limit.variable);
  return names;
}

ErosionRule::ErosionRule(const ErosionCriteria& criteria, const ElementBlock& block)
    : criteria_(criteria)
{
  const auto rowOf = [&](const std::string& variable)
  {
    const int row = block.historyRow(variable);
    if (row < 0)
      fail(ExitCode::Internal, "erosion: the law has no variable '{}'", variable);
    return row;
  };
  if (criteria.damage)
    damageRow_ = rowOf("damage");
  for (const ErosionCriteria::Limit& limit : criteria.variables)
    rows_.push_back(rowOf(limit.variable));
}

bool ErosionRule::exceedsLimit(const ElementBlock& block, int e) const
{
  for (std::size_t i = 0; i < rows_.size(); ++i)
  {
    const Real value = block.history()(rows_[i], e);
    if (!(value <= criteria_.variables[i].above && value >= criteria_.variables[i].below))
      return true;
  }
  if (criteria_.volumeRatio)
  {
    const Real ratio = block.volume()(e) / block.referenceVolume()(e);
    if (!(ratio >= (*criteria_.volumeRatio)[0] && ratio <= (*criteria_.volumeRatio)[1]))
      return true;
  }
  return criteria_.stableStep && !(block.stableStep()(e) >= *criteria_.stableStep);
}

bool ErosionRule::kills(const ElementBlock& block, int e) const
{
  if (!block.isAlive(e) ||
      (damageRow_ >= 0 && !(block.history()(damageRow_, e) > *criteria_.damage)))
    return false;
  return !criteria_.hasLimits() || exceedsLimit(block, e);
}

void Solver::prepareErosion()
{
  const RankMesh& mesh = model_.mesh;
  erosionRules_.resize(blocks_.size());
  erodedEnergy_.resize(blocks_.size());
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (model_.blocks[b].erosion.any())
    {
      erosionRules_[b].emplace(model_.blocks[b].erosion, blocks_[b]);
      erodes_ = true;
    }
  if (!erodes_)
    return;
  sides_.emplace(mesh);
  livingElements_.assign(mesh.ownedNodes, 0);
  for (const RankMesh::Block& part : mesh.blocks)
  {
    alive_.emplace_back(part.elements(), char(1));
    for (const int node : part.connectivity)
      if (node < mesh.ownedNodes)
        ++livingElements_[node];
  }
}

bool Solver::erode(Real dt)
{
  if (!erodes_)
    return false;
  TimedRegion region("coplane::dynamics::erode");
  std::vector<std::pair<int, int>> dying; // block, element
  for (int b = 0; b < int(blocks_.size()); ++b)
  {
    if (!erosionRules_[b])
      continue;
    const ElementBlock& block = blocks_[b];
    const ErosionRule& rule = *erosionRules_[b];
    const Real first =
        parallelMin("coplane::dynamics::erode", block.count(),
                    [&](const int e) { return rule.kills(block, e) ? Real(e) : infinity; });
    for (int e = first < infinity ? int(first) : block.count(); e < block.count(); ++e)
      if (rule.kills(block, e))
        dying.emplace_back(b, e);
  }
  // Ranks that hold the same element have decided alike, from the same bits.
  if (comm_->max(std::int64_t(!dying.empty())) == 0)
    return false;

  std::vector<GlobalId> dead;
  for (const auto& [b, e] : dying)
    if (model_.mesh.blocks[b].owned[e])
      dead.push_back(model_.mesh.blocks[b].elementIds[e]);
  dead = comm_->allGather(dead);
  std::sort(dead.begin(), dead.end());
  for (const auto& [b, e] : dying)
    kill(b, e, dt);

  endLoadsOn(dead);
  if (contact_)
  {
    contact_->endPlanesOf(dead, state_.x, state_.v, dt);
    findContactFaces(&contact_->localFaces());
  }
  return true;
}

void Solver::findContactFaces(const std::vector<Face>* known)
{
  const std::vector<ExteriorFace> exterior = sides_->exterior(alive_);
  contact_->replaceLocalFaces(contactFaces(model_.mesh, blocks_, model_.faceGroups, bodyOfNode_,
                                           exterior, state_.x, known));
}

/// Loads end with the element that carried them.
void Solver::endLoadsOn(const std::vector<GlobalId>& dead)
{
  const auto isDead = [&](const LoadedSide& side)
  { return std::binary_search(dead.begin(), dead.end(), elementOfFace(side.id)); };
  const auto forget = [](auto& sides, const auto& gone)
  { sides.erase(std::remove_if(sides.begin(), sides.end(), gone), sides.end()); };
  for (FacePressure& load : model_.conditions.pressures)
    forget(load.sides, isDead);
  for (FaceTraction& load : model_.conditions.tractions)
    forget(load.sides, isDead);
  for (AbsorbingBoundary& boundary : model_.conditions.absorbing)
    forget(boundary.sides, [&](const AbsorbingSide& face) { return isDead(face.side); });
}

void Solver::kill(int b, int e, Real dt)
{
  const RankMesh::Block& part = model_.mesh.blocks[b];
  ElementBlock& block = blocks_[b];
  const int corners = topology(part.type).nodes;
  if (part.owned[e])
  {
    // The element gives no force at the end of this step: what its energy got from that force over
    // the second half of the step has not been taken from the nodes.
    Real power = 0;
    for (int k = 0; k < corners; ++k)
    {
      const auto force = block.cornerForce();
      power += dot(Vec3{force(e, k, 0), force(e, k, 1), force(e, k, 2)},
                   at(state_.v, part.connectivity[e * corners + k]));
    }
    ExactSum& sum = erodedEnergy_[b];
    sum.add(0.5 * dt * power);
    for (const ElementEnergy kind :
         {ElementEnergy::Internal, ElementEnergy::Hourglass, ElementEnergy::Viscous})
      sum.add(block.energy(e, kind));
    erodedMass_.add(block.mass(e));
    ++erodedElements_;
  }
  block.erode(e);
  alive_[b][e] = 0;
  for (int k = 0; k < corners; ++k)
    if (const int node = part.connectivity[e * corners + k]; node < layout_.owned())
      --livingElements_[node];
}

ErosionTotals Solver::erosion() const
{
  std::vector<ExactSum> mass{erodedMass_};
  return {comm_->sum(erodedElements_), ExactSum::overRanks(mass, *comm_)[0]};
}
} // namespace coplane
