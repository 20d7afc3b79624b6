// The solver's part of a checkpoint, and those of what it is made of.
#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/ContactFaces.hpp>
#include <coplane_dynamics/Solver.hpp>

#include <algorithm>
#include <type_traits>

namespace coplane
{
namespace
{
struct NodeColumns
{
  std::vector<std::string> names;
  std::vector<NodeVectors> vectors;
  std::vector<Array<Real>> scalars;
};

/// What changes of the owned nodes. Masses and places at the start come from the mesh.
NodeColumns nodeColumns(const NodalState& state, const Array<Real>& contactStiffness)
{
  NodeColumns columns;
  const auto vector = [&](const char* name, const NodeVectors& values)
  {
    for (const char* axis : {"_x", "_y", "_z"})
      columns.names.push_back(std::string(name) + axis);
    columns.vectors.push_back(values);
  };
  vector("position", state.x);
  vector("velocity", state.v);
  vector("previous_velocity", state.vPrevious);
  vector("force", state.force);
  vector("contact_force", state.contactForce);
  vector("external", state.external);
  vector("damping", state.damping);
  vector("local_damping", state.localDamping);
  vector("impulse", state.impulse);
  vector("angular_impulse", state.angularImpulse);
  vector("at_search", state.atSearch);
  const auto scalar = [&](const char* name, const Array<Real>& values)
  {
    columns.names.push_back(name);
    columns.scalars.push_back(values);
  };
  scalar("external_work", state.externalWork);
  scalar("damping_work", state.dampingWork);
  scalar("local_damping_work", state.localDampingWork);
  scalar("total_work", state.totalWork);
  scalar("contact_stiffness", contactStiffness);
  return columns;
}

/// Structs of nothing but numbers, all of them, also those that are added later.
template <class Numbers>
std::vector<Real> numbersOf(const Numbers& from)
{
  static_assert(std::is_trivially_copyable_v<Numbers> && sizeof(Numbers) % sizeof(Real) == 0 &&
                alignof(Numbers) == alignof(Real));
  std::vector<Real> numbers(sizeof(Numbers) / sizeof(Real));
  __builtin_memcpy(numbers.data(), &from, sizeof(Numbers));
  return numbers;
}

template <class Numbers>
void setNumbers(Numbers& to, const StateSource& in, const std::string& name)
{
  const std::vector<Real> numbers = in.numbers(name);
  if (numbers.size() * sizeof(Real) != sizeof(Numbers))
    failOnAllRanks(
        ExitCode::Checkpoint,
        "{}: '{}' has {} numbers and should have {}. Restart with the program that wrote "
        "it ({}).",
        in.name(), name, numbers.size(), sizeof(Numbers) / sizeof(Real), in.program());
  __builtin_memcpy(static_cast<void*>(&to), numbers.data(), sizeof(Numbers));
}

std::string nameOfBlock(const RankMesh::Block& block)
{
  return fmt::format("elements/block_{}", block.id);
}
} // namespace

/// The numbers of the solver itself, for f(value).
template <class Self, class F>
void Solver::forEachNumber(Self& solver, F&& number)
{
  number(solver.clock_.cycle);
  number(solver.clock_.time);
  number(solver.clock_.step);
  number(solver.clock_.nextStep);
  number(solver.growth_.calm);
  number(solver.largestNextStep_);
  number(solver.relativeSpeed_);
  number(solver.searchSkin_);
  number(solver.searchIsDue_);
  number(solver.massDampingActs_);
  number(solver.localDampingActs_);
  number(solver.relaxation_.ended);
  number(solver.relaxation_.kineticBefore);
  number(solver.relaxation_.work);
  number(solver.relaxation_.stops);
  number(solver.relaxation_.below);
  number(solver.warned_.error);
  number(solver.warned_.remainder);
  number(solver.warned_.tooDeep);
  number(solver.warned_.capped);
}

void Solver::save(StateTables& out) const
{
  const NodeColumns columns = nodeColumns(state_, contactStiffness_);
  KeyedRows nodes;
  nodes.columns = columns.names;
  for (int n = 0; n < layout_.owned(); ++n)
  {
    Real* row = nodes.add({layout_.ids()[n]});
    for (const NodeVectors& vectors : columns.vectors)
      for (int c = 0; c < 3; ++c)
        *row++ = vectors(n, c);
    for (const Array<Real>& scalars : columns.scalars)
      *row++ = scalars(n);
  }
  out.rows("nodes", nodes);

  for (std::size_t b = 0; b < blocks_.size(); ++b)
  {
    const RankMesh::Block& part = model_.mesh.blocks[b];
    KeyedRows elements;
    elements.columns = blocks_[b].stateColumns();
    for (int e = 0; e < part.elements(); ++e)
      if (part.owned[e])
        blocks_[b].saveState(e, elements.add({part.elementIds[e]}));
    out.rows(nameOfBlock(part), elements);
  }
  if (contact_)
    contact_->save(out);
  rigid_->save(out);

  std::vector<ExactSum> sums = erodedEnergy_;
  sums.push_back(erodedMass_);
  std::vector<Real> eroded{Real(comm_->sum(erodedElements_))};
  for (const ExactSum& sum : ExactSum::totals(sums, *comm_))
    for (const Real digit : sum.digits())
      eroded.push_back(digit);
  out.numbers("solver/eroded", eroded);
  std::vector<Real> numbers;
  forEachNumber(*this, [&](const auto& value) { numbers.push_back(Real(value)); });
  out.numbers("solver/numbers", numbers);
  out.numbers("solver/initial_energy", numbersOf(initialEnergy_));
  out.numbers("solver/initial_momenta", numbersOf(initialMomenta_));
}

void Solver::restore(const StateSource& in)
{
  restoreElements(in);
  restoreNodes(in);
  restoreErosion(in);
  layout_.refresh(state_.x, state_.v);
  if (contact_)
  {
    if (layout_.setGhostNodes(contact_->restoreFaces(in, layout_.ids())))
    {
      state_.resize(layout_);
      layout_.refresh(state_.x, state_.v);
      layout_.refresh(state_.mass);
    }
    contact_->restorePlanes(in, layout_);
  }
  rigid_->restore(in);
  // What follows from positions and stresses: forces of the elements and their stable steps.
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (!isRigid(b))
      blocks_[b].update(state_.x, state_.v, 0);
  const std::vector<Real> numbers = in.numbers("solver/numbers");
  std::size_t at = 0;
  forEachNumber(*this,
                [&](auto& value)
                {
                  if (at < numbers.size())
                    value = static_cast<std::decay_t<decltype(value)>>(numbers[at]);
                  ++at;
                });
  if (at != numbers.size())
    failOnAllRanks(ExitCode::Checkpoint,
                   "{}: the clock has {} numbers and should have {}. Restart with the program that "
                   "wrote it ({}).",
                   in.name(), numbers.size(), at, in.program());
  if (contact_)
    contact_->setSkin(searchSkin_);
  setNumbers(initialEnergy_, in, "solver/initial_energy");
  setNumbers(initialMomenta_, in, "solver/initial_momenta");
}

void Solver::repartition(Model model)
{
  TimedRegion region("coplane::dynamics::repartition");
  StateTables state(*comm_);
  save(state);
  Repartitions repartitions = repartitions_;
  ++repartitions.count;
  // The largest parts of the old state go before the new one comes.
  contact_.reset();
  blocks_.clear();
  gathers_.clear();
  *this = Solver(std::move(model), *comm_);
  restore(state);
  repartitions_ = repartitions;
}

void Solver::restoreElements(const StateSource& in)
{
  for (std::size_t b = 0; b < blocks_.size(); ++b)
  {
    const RankMesh::Block& part = model_.mesh.blocks[b];
    const KeyedRows rows = in.rowsOf(nameOfBlock(part), blocks_[b].stateColumns(), part.elementIds);
    for (int e = 0; e < part.elements(); ++e)
      blocks_[b].restoreState(e, rows.row(std::size_t(e)));
  }
}

void Solver::restoreNodes(const StateSource& in)
{
  const NodeColumns columns = nodeColumns(state_, contactStiffness_);
  const KeyedRows rows = in.rowsOf(
      "nodes", columns.names,
      std::vector<GlobalId>(layout_.ids().begin(), layout_.ids().begin() + layout_.owned()));
  for (int n = 0; n < layout_.owned(); ++n)
  {
    const Real* row = rows.row(std::size_t(n));
    for (const NodeVectors& vectors : columns.vectors)
      for (int c = 0; c < 3; ++c)
        vectors(n, c) = *row++;
    for (const Array<Real>& scalars : columns.scalars)
      scalars(n) = *row++;
  }
}

/// What follows from the elements that have died, and the sums of what they took with them.
void Solver::restoreErosion(const StateSource& in)
{
  const std::vector<Real> eroded = in.numbers("solver/eroded");
  if (eroded.size() != 1 + (blocks_.size() + 1) * ExactSum::digitCount)
    failOnAllRanks(ExitCode::Checkpoint, "{}: the checkpoint has another number of blocks.",
                   in.name());
  if (comm_->isRoot()) // sums over ranks
  {
    erodedElements_ = std::int64_t(eroded[0]);
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      erodedEnergy_[b] = ExactSum::fromDigits(&eroded[1 + b * ExactSum::digitCount]);
    erodedMass_ = ExactSum::fromDigits(&eroded[1 + blocks_.size() * ExactSum::digitCount]);
  }
  if (!erodes_)
    return;
  std::vector<GlobalId> dead;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
  {
    const RankMesh::Block& part = model_.mesh.blocks[b];
    const int corners = topology(part.type).nodes;
    for (int e = 0; e < part.elements(); ++e)
    {
      if (blocks_[b].isAlive(e))
        continue;
      alive_[b][e] = 0;
      for (int k = 0; k < corners; ++k)
        if (const int node = part.connectivity[e * corners + k]; node < layout_.owned())
          --livingElements_[node];
      if (part.owned[e])
        dead.push_back(part.elementIds[e]);
    }
  }
  dead = comm_->allGather(dead);
  std::sort(dead.begin(), dead.end());
  endLoadsOn(dead);
  if (contact_)
    findContactFaces(nullptr);
}
} // namespace coplane
