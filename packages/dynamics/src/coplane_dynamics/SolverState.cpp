// The solver's part of a checkpoint, and those of what it is made of; the hash of the state.
#include <coplane_contact/PlaneState.hpp>
#include <coplane_core/StateHash.hpp>
#include <coplane_core/Timers.hpp>
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

/// What changes of the owned nodes. Places at the start come from the mesh.
NodeColumns nodeColumns(const NodalState& state, bool subcycles)
{
  NodeColumns columns;
  const auto vector = [&](const char* name, const NodeVectors& values)
  {
    for (const char* axis : {"_x", "_y", "_z"})
      columns.names.push_back(std::string(name) + axis);
    columns.vectors.push_back(values);
  };
  vector("position", state.x);
  vector("position_rest", state.xRest);
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
  vector("velocity_at_search", state.velocityAtSearch);
  vector("at_passing", state.atPassing);
  if (subcycles)
  {
    vector("steady_mean", state.steadyMean);
    vector("steady_force", state.steadyForce);
    vector("under_way", state.underWay);
  }
  const auto scalar = [&](const char* name, const Array<Real>& values)
  {
    columns.names.push_back(name);
    columns.scalars.push_back(values);
  };
  scalar("external_work", state.externalWork);
  scalar("damping_work", state.dampingWork);
  scalar("local_damping_work", state.localDampingWork);
  scalar("total_work", state.totalWork);
  scalar("contact_stiffness", state.contactStiffness);
  // Mass scaling adds to masses bit by bit: what they are does not follow from both parts.
  scalar("mass", state.mass);
  scalar("added_mass", state.addedMass);
  if (subcycles)
  {
    scalar("substeps", state.substeps);
    scalar("swing", state.swing);
  }
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
} // namespace

/// The numbers of the solver and of those that it is made of, for f(value).
template <class Self, class F>
void Solver::forEachNumber(Self& self, F&& number)
{
  Clock::forEachNumber(self.clock_, number);
  TimeStep::forEachNumber(self.step_, number);
  Subcycling::forEachNumber(self.subcycling_, number);
  SearchPlan::forEachNumber(self.searches_, number);
  NodalMotion::forEachNumber(*self.motion_, number);
  Relaxation::forEachNumber(self.relaxation_, number);
  BalanceWatch::forEachNumber(self.watch_, number);
}

void Solver::save(StateTables& out) const
{
  saveStage(out);
  saveNodes(out);
  elements_.save(mesh(), out);
  if (contact_)
    contact_->save(out);
  motion_->save(layout_.ids(), out);
  lines_->save(out);
  if (debris_)
    debris_->save(out);
  erosion_->save(out, *comm_);
  watch_.saveBodies(out);
  std::vector<Real> numbers;
  forEachNumber(*this, [&](const auto& value) { numbers.push_back(Real(value)); });
  out.numbers("solver/numbers", numbers);
  Ledger::forEachStruct(ledger_, [&](const char* name, const auto& values)
                        { out.numbers(name, numbersOf(values)); });
}

void Solver::restore(const StateSource& in)
{
  restoreStage(in);
  elements_.restore(mesh(), in);
  restoreNodes(in);
  const std::vector<GlobalId> dead = erosion_->restore(mesh(), elements_, in, *comm_);
  if (erosion_->acts())
    leaveWithoutElements(dead, nullptr);
  layout_.refresh(state_.x, state_.v);
  if (model_.blocksComeOrGo)
    elements_.sumMasses(state_);
  if (contact_)
  {
    takeGhostNodes(contact_->restoreFaces(in, layout_.ids()));
    motionLimits_.reset();
    contact_->restorePlanes(in, layout_);
  }
  motion_->restore(layout_.ids(), in);
  lines_->restore(in);
  if (debris_)
  {
    renewDebris();
    debris_->restore(in, mesh(), elements_, state_);
  }
  findElementForces();
  restoreNumbers(in);
  watch_.restoreBodies(in);
  watch_.forgetPlanes();
  if (contact_)
  {
    contact_->setSkin(searches_.skin());
    NodeVectors atSearch("atSearch", layout_.size()), velocity("velocity", layout_.size());
    Kokkos::deep_copy(ownedOf(atSearch), state_.atSearch);
    Kokkos::deep_copy(ownedOf(velocity), state_.velocityAtSearch);
    layout_.refresh(atSearch, velocity);
    contact_->restoreDistances(atSearch, velocity, searches_.ahead());
    contact_->followFaces(state_.x, state_.v, searches_.timeSince(clock_.time), lookAhead());
    contact_->findFaces(state_.x, state_.v);
  }
  motion_->findProjections(model_.conditions, clock_.time + 0.5 * clock_.nextStep);
  subcycling_.restore(parts(), state_, contact_.get());
  Ledger::forEachStruct(ledger_,
                        [&](const char* name, auto& values) { setNumbers(values, in, name); });
}

void Solver::restoreNumbers(const StateSource& in)
{
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
}

void Solver::repartition(Model model)
{
  TimedRegion region("coplane::dynamics::repartition");
  rebuild(std::move(model));
  ++repartitions_.count;
}

void Solver::saveNodes(StateTables& out) const
{
  const NodeColumns columns = nodeColumns(state_, subcycling_.acts());
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
}

void Solver::restoreNodes(const StateSource& in)
{
  const NodeColumns columns = nodeColumns(state_, subcycling_.acts());
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

std::uint64_t Solver::stateHash() const
{
  StateHash hash;
  enum Field : std::uint64_t
  {
    Position = 1,
    Velocity,
    Element = 100,
    PlaneField = 200,
    Time = 300,
    LineField = 400,
    FreeFieldNumber = 500,
    DebrisField = 600
  };
  for (int n = 0; n < layout_.owned(); ++n)
    for (int c = 0; c < 3; ++c)
    {
      hash.add(Position, layout_.ids()[n], c, state_.x(n, c));
      hash.add(Velocity, layout_.ids()[n], c, state_.v(n, c));
    }
  for (std::size_t b = 0; b < blocks().size(); ++b)
  {
    const RankMesh::Block& part = mesh().blocks[b];
    std::uint64_t field = Element;
    blocks()[b].forEachState(
        [&](const char*, int components, const auto& values)
        {
          for (int e = 0; e < part.elements(); ++e)
            if (part.owned[e])
              for (int c = 0; c < components; ++c)
                hash.add(field, part.elementIds[e], c, values(c, e));
          ++field;
        });
  }
  for (std::size_t p = 0; contact_ && p < contact_->planes().size(); ++p)
  {
    const Plane& plane = contact_->planes()[p];
    if (plane.countedHere && plane.isBorn())
      addTo(hash, PlaneField, contact_->prepared(contact_->planes().slotOf(p)));
  }
  if (comm_->isRoot())
  {
    hash.add(Time, clock_.cycle, 0, clock_.time);
    hash.add(Time, clock_.cycle, 1, clock_.nextStep);
    // Every rank has all of these.
    lines_->addTo(hash, LineField);
    motion_->freeFields().addTo(hash, FreeFieldNumber);
    if (debris_)
      debris_->addTo(hash, DebrisField);
  }
  std::vector<std::uint64_t> total{hash.part()};
  comm_->sum(total);
  return total[0];
}
} // namespace coplane
