// Stages of a run: blocks that leave or come in, and another model for what stays.
#include <coplane_core/Log.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/Solver.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
const std::vector<std::string> placeColumns{"x", "y", "z"};

std::string nameOfPlaces(const RankMesh::Block& block)
{
  return fmt::format("nodes/came_with_block_{}", block.id);
}

/// Calls f(element, corner, node) for the corners of a block at owned nodes.
template <class F>
void forEachOwnedCorner(const RankMesh& mesh, int b, F&& f)
{
  const RankMesh::Block& part = mesh.blocks[std::size_t(b)];
  const int corners = topology(part.type).nodes;
  for (int i = 0; i < int(part.connectivity.size()); ++i)
    if (const int node = part.connectivity[std::size_t(i)]; node < mesh.ownedNodes)
      f(i / corners, i % corners, node);
}

std::vector<int> nodesOfBlock(const RankMesh::Block& part)
{
  std::vector<int> nodes(part.connectivity.begin(), part.connectivity.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}
} // namespace

void Solver::rebuild(Model model)
{
  StateTables state(*comm_);
  save(state);
  const Repartitions repartitions = repartitions_;
  // The largest parts of the old state go before the new one comes.
  contact_.reset();
  elements_ = {};
  *this = Solver(std::move(model), *comm_);
  restore(state);
  repartitions_ = repartitions;
}

void Solver::beginStage(Stage stage)
{
  TimedRegion region("coplane::dynamics::beginStage");
  // All that may be refused: what is left of the run has to be told of by a solver that is whole.
  demandPossible(stage);
  demandThere(stage.remove, true, stage.index);
  demandThere(stage.add, false, stage.index);
  // Restoring ends the loads on what is not there.
  const Conditions conditions = stage.add.empty() ? Conditions() : stage.model.conditions;
  rebuild(std::move(stage.model));
  stage_ = {stage.index, clock_.time};
  relaxation_.beginAnew();
  if (stage.zeroDisplacements)
  {
    displacementsZeroed_ = true;
    for (int n = 0; n < mesh().nodes(); ++n)
      set(state_.reference, n, at(state_.x, n));
    for (const auto& [b, places] : came_)
      cameBeforeZero_.insert(b);
    motion_->zeroDisplacements();
  }
  coming_ = {std::move(stage.add), conditions};
  leaving_ = std::move(stage.remove);
}

void Solver::demandPossible(const Stage& stage) const
{
  demandNoRigidNodes(stage.add);
  demandNoRigidNodes(stage.remove);
  motion_->demandPossible(stage.model.conditions);
  static_cast<void>(
      FreeFields(stage.model, *comm_)); // refuses sides that are no end of level ground
  for (std::size_t b = 0; b < blocks().size(); ++b)
    if (historyNames(stage.model.blocks[b].material) != blocks()[b].historyVariables())
      failOnAllRanks(ExitCode::Deck,
                     "block '{}' would have a law with other variables; accepted: other numbers "
                     "of the keys that its material has from the start on.",
                     model_.blocks[b].name);
}

/// Masses of rigid bodies are those of the start.
void Solver::demandNoRigidNodes(const std::vector<int>& blocks) const
{
  for (const int b : blocks)
  {
    std::int64_t rigid = 0;
    forEachOwnedCorner(mesh(), b, [&](int, int, int node) { rigid += motion_->followsBody(node); });
    if (comm_->max(rigid) > 0)
      failOnAllRanks(ExitCode::Deck,
                     "stages: block '{}' shares nodes with a rigid body; accepted for blocks that "
                     "are removed or added: nodes of their own, or shared with blocks that deform.",
                     model_.blocks[std::size_t(b)].name);
  }
}

/// The deck knows, but a restart may have changed it.
void Solver::demandThere(const std::vector<int>& blocks, bool there, int stage) const
{
  for (const int b : blocks)
  {
    const ElementBlock& block = this->blocks()[std::size_t(b)];
    std::int64_t present = 0;
    for (int e = 0; e < block.count(); ++e)
      present |= std::int64_t(!block.isTakenOut(e));
    if ((comm_->max(present) > 0) != there)
      failOnAllRanks(ExitCode::Deck,
                     "stages.{}: block '{}' is {} there, so it cannot be {}. Blocks that a stage "
                     "adds are absent from the start of the run on: a restart cannot change which.",
                     stage, model_.blocks[std::size_t(b)].name, there ? "not" : "already",
                     there ? "removed" : "added");
  }
}

/// At the start: blocks of later stages.
void Solver::leaveAbsentBlocks()
{
  if (model_.absentBlocks.empty())
    return;
  demandNoRigidNodes(model_.absentBlocks);
  erosion_->beginWithout(model_.absentBlocks, mesh(), elements_);
  elements_.sumMasses(state_);
  std::vector<GlobalId> absent;
  for (const int b : model_.absentBlocks)
  {
    const RankMesh::Block& part = mesh().blocks[std::size_t(b)];
    for (int e = 0; e < part.elements(); ++e)
      if (part.owned[std::size_t(e)])
        absent.push_back(part.elementIds[std::size_t(e)]);
  }
  absent = comm_->allGather(absent);
  std::sort(absent.begin(), absent.end());
  model_.conditions.endLoadsOn(absent);
  if (contact_)
    replaceFaces(facesAtStart(erosion_->exterior()));
  for (int n = 0; n < layout_.owned(); ++n)
    if (!(state_.mass(n) > 0))
    {
      set(state_.v, n, {});
      set(state_.vPrevious, n, {});
    }
  layout_.refresh(state_.x, state_.v);
}

/// Blocks as new where their nodes are now, at n + 1, free of stress: the step that follows is the
/// first with forces of theirs, and they have their say in its length. The mass that they bring to
/// nodes that move has momentum and kinetic energy, which are booked as coming in with it at
/// n + 1/2. Whether any did.
bool Solver::comeIn(const ComingBlocks& coming, Real time)
{
  const std::vector<int>& blocks = coming.blocks;
  if (blocks.empty())
    return false;
  for (const int b : blocks)
  {
    std::vector<Vec3>& places = came_[b];
    cameBeforeZero_.erase(b);
    places.assign(std::size_t(mesh().nodes()), {});
    for (const int node : nodesOfBlock(mesh().blocks[std::size_t(b)]))
      places[std::size_t(node)] = at(state_.x, node);
    elements_.initialise(std::size_t(b), state_.x, time);
    forEachOwnedCorner(mesh(), b,
                       [&](int element, int corner, int node)
                       {
                         const ElementBlock& block = this->blocks()[std::size_t(b)];
                         const Vec3 v = at(state_.v, node);
                         erosion_->bookEnergy(b,
                                              -0.5 * block.cornerMass(element, corner) * dot(v, v));
                       });
  }
  const std::vector<Real> before(state_.mass.data(), state_.mass.data() + layout_.owned());
  elements_.sumMasses(state_);
  for (int n = 0; n < layout_.owned(); ++n)
  {
    const Vec3 momentum = (state_.mass(n) - before[std::size_t(n)]) * at(state_.v, n);
    state_.totalWork(n) += 0.5 * dot(momentum, at(state_.v, n));
    set(state_.impulse, n, at(state_.impulse, n) + momentum);
    set(state_.angularImpulse, n, at(state_.angularImpulse, n) + cross(at(state_.x, n), momentum));
  }
  erosion_->recount(mesh(), elements_);
  model_.conditions.takeFaceLoads(coming.conditions);
  model_.conditions.endLoadsOn(erosion_->dead(mesh(), elements_, *comm_));
  return true;
}

/// Elements of these blocks have just gone; what their mass has of momentum and kinetic energy at
/// n + 1/2 goes with them. Nodes that are left without mass stay where they are.
void Solver::takeMassAlong(const std::vector<int>& blocks)
{
  if (blocks.empty())
    return;
  for (const int b : blocks)
    forEachOwnedCorner(mesh(), b,
                       [&](int element, int corner, int node)
                       {
                         const ElementBlock& block = this->blocks()[std::size_t(b)];
                         const Vec3 v = at(state_.v, node);
                         if (block.isTakenOut(element))
                           erosion_->bookEnergy(b, 0.5 * block.cornerMass(element, corner) *
                                                       dot(v, v));
                       });
  const std::vector<Real> before(state_.mass.data(), state_.mass.data() + layout_.owned());
  elements_.sumMasses(state_);
  for (int n = 0; n < layout_.owned(); ++n)
  {
    const Vec3 momentum = (before[std::size_t(n)] - state_.mass(n)) * at(state_.v, n);
    state_.totalWork(n) -= 0.5 * dot(momentum, at(state_.v, n));
    set(state_.impulse, n, at(state_.impulse, n) - momentum);
    set(state_.angularImpulse, n, at(state_.angularImpulse, n) - cross(at(state_.x, n), momentum));
    if (!(state_.mass(n) > 0) && before[std::size_t(n)] > 0)
    {
      set(state_.v, n, {});
      set(state_.vPrevious, n, {});
    }
  }
}

/// Faces of contact that blocks have covered; sorted, on all ranks.
std::vector<GlobalId> Solver::facesThatGo() const
{
  std::vector<GlobalId> stay, gone;
  for (const ExteriorFace& face : erosion_->exterior())
    stay.push_back(face.id);
  for (const Face& face : contact_->localFaces())
    if (face.ownedHere && !std::binary_search(stay.begin(), stay.end(), face.id))
      gone.push_back(face.id);
  gone = comm_->allGather(gone);
  std::sort(gone.begin(), gone.end());
  return gone;
}

namespace
{
constexpr const char* stageNumbers = "solver/stage";
constexpr const char* zeroPlaces = "nodes/zero_displacement";
constexpr const char* beforeZero = "solver/came_before_zero_displacement";
} // namespace

Vec3 Solver::strainReference(int block, int node) const
{
  const auto came = came_.find(block);
  return came == came_.end() || cameBeforeZero_.count(block) > 0 ? at(state_.reference, node)
                                                                 : came->second[std::size_t(node)];
}

StageState Solver::stageIn(const StateSource& in)
{
  if (!in.has(stageNumbers))
    return {};
  const std::vector<Real> numbers = in.numbers(stageNumbers);
  return {int(numbers.at(0)), numbers.at(1)};
}

void Solver::saveStage(StateTables& out) const
{
  if (!model_.inStages)
    return;
  std::vector<Real> numbers{Real(stage_.index), stage_.begin, Real(displacementsZeroed_)};
  for (const auto& [b, places] : came_)
  {
    numbers.push_back(b);
    KeyedRows rows;
    rows.columns = placeColumns;
    std::vector<char> done(std::size_t(mesh().ownedNodes), 0);
    forEachOwnedCorner(mesh(), b,
                       [&, &places = places](int, int, int node)
                       {
                         if (std::exchange(done[std::size_t(node)], 1))
                           return;
                         Real* row = rows.add({layout_.ids()[std::size_t(node)]});
                         for (int c = 0; c < 3; ++c)
                           row[c] = places[std::size_t(node)][c];
                       });
    out.rows(nameOfPlaces(mesh().blocks[std::size_t(b)]), rows);
  }
  out.numbers(stageNumbers, numbers);
  if (!displacementsZeroed_)
    return;
  KeyedRows rows;
  rows.columns = placeColumns;
  for (int n = 0; n < layout_.owned(); ++n)
  {
    Real* row = rows.add({layout_.ids()[std::size_t(n)]});
    for (int c = 0; c < 3; ++c)
      row[c] = state_.reference(n, c);
  }
  out.rows(zeroPlaces, rows);
  out.numbers(beforeZero, std::vector<Real>(cameBeforeZero_.begin(), cameBeforeZero_.end()));
  motion_->saveZero(out);
}

void Solver::restoreStage(const StateSource& in)
{
  if (!in.has(stageNumbers))
    return;
  const std::vector<Real> numbers = in.numbers(stageNumbers);
  stage_ = stageIn(in);
  displacementsZeroed_ = numbers.at(2) != 0;
  came_.clear();
  cameBeforeZero_.clear();
  for (std::size_t i = 3; i < numbers.size(); ++i)
  {
    const int b = int(numbers[i]);
    const RankMesh::Block& part = mesh().blocks.at(std::size_t(b));
    const std::vector<int> nodes = nodesOfBlock(part);
    std::vector<GlobalId> ids;
    for (const int node : nodes)
      ids.push_back(layout_.ids()[std::size_t(node)]);
    const KeyedRows rows = in.rowsOf(nameOfPlaces(part), placeColumns, ids);
    std::vector<Vec3>& places = came_[b];
    places.assign(std::size_t(mesh().nodes()), {});
    const NodeVectors x("coplane::dynamics::placesOfBlock", std::size_t(mesh().nodes()));
    for (std::size_t k = 0; k < nodes.size(); ++k)
    {
      const Real* row = rows.row(k);
      places[std::size_t(nodes[k])] = {row[0], row[1], row[2]};
      set(x, nodes[k], {row[0], row[1], row[2]});
    }
    elements_.initialise(std::size_t(b), x, 0); // the history is restored with its element
  }
  if (!displacementsZeroed_)
    return;
  if (in.has(beforeZero))
    for (const Real b : in.numbers(beforeZero))
      cameBeforeZero_.insert(int(b));
  const KeyedRows rows = in.rowsOf(
      zeroPlaces, placeColumns,
      std::vector<GlobalId>(layout_.ids().begin(), layout_.ids().begin() + mesh().nodes()));
  for (int n = 0; n < mesh().nodes(); ++n)
    for (int c = 0; c < 3; ++c)
      state_.reference(n, c) = rows.row(std::size_t(n))[c];
  motion_->restoreZero(in);
}
} // namespace coplane
