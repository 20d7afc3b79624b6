#include <coplane_core/CompensatedSum.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/NodalMotion.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace coplane
{
namespace
{
std::vector<char> rigidBlocksOf(const Model& model)
{
  std::vector<char> rigid;
  for (const BlockSetup& setup : model.blocks)
    rigid.push_back(setup.rigid);
  return rigid;
}

KickTimes kickTimesOf(const NodalMotion::Times& times)
{
  return {times.t, NodalMotion::kickOf(times), times.after};
}
} // namespace

NodalMotion::NodalMotion(Model& model, const ElementForces& elements, const NodalState& state,
                         const Comm& comm)
    : dimension_(model.mesh.dimension),
      bodies_(model.mesh, model.rigidBodyOfNode, rigidBlocksOf(model), elements.blocks(), state,
              comm),
      followsBody_("coplane::dynamics::followsBody", model.mesh.ownedNodes),
      passesTheAxis_("coplane::dynamics::passesTheAxis", model.mesh.ownedNodes),
      freeFields_(model, comm), dashpots_(model.conditions, model.mesh.ownedNodes)
{
  bodies_.takeConditions(model.conditions);
  for (int n = 0; n < model.mesh.ownedNodes; ++n)
    followsBody_(n) = bodies_.holds(n);
  const std::vector<int> held = model.conditions.constrainedNodes();
  std::set_union(held.begin(), held.end(), dashpots_.nodes().begin(), dashpots_.nodes().end(),
                 std::back_inserter(constrained_));
  beforeConstraint_ = NodeVectors("coplane::dynamics::beforeConstraint", constrained_.size());
  reactions_ = NodeVectors("coplane::dynamics::reactions", constrained_.size());
}

Vec3 NodalMotion::reaction(int node) const
{
  const auto found = std::lower_bound(constrained_.begin(), constrained_.end(), node);
  if (found == constrained_.end() || *found != node)
    return {};
  return at(reactions_, int(found - constrained_.begin()));
}

void NodalMotion::drift(Real dt, const NodalState& state)
{
  const auto x = state.x, rest = state.xRest;
  const ConstNodeVectors v = state.v;
  if (state.keepsRests)
    parallelFor(
        "coplane::dynamics::drift", state.owned(), KOKKOS_LAMBDA(const int n) {
          for (int c = 0; c < 3; ++c)
            addCompensated(x(n, c), rest(n, c), dt * v(n, c));
        });
  else
    parallelFor(
        "coplane::dynamics::drift", state.owned(),
        KOKKOS_LAMBDA(const int n) { set(x, n, at(x, n) + dt * at(v, n)); });
  bodies_.drift(dt);
  freeFields_.advance(dt);
}

void NodalMotion::applyLoads(const Conditions& conditions, Real t, Real dt, NodalState& state) const
{
  conditions.applyLoads(dimension_, state.owned(), t, dt, state);
}

void NodalMotion::sumForcesOnBodies(const NodalState& state, const ElementForces& elements)
{
  bodies_.sumForces(state, state.contactStiffness,
                    [&](int n) { return elements.leastStepAround(n); });
}

/// Of the middle of a step: found anew when symmetry planes come or go.
void NodalMotion::findProjections(const Conditions& conditions, Real middle)
{
  std::vector<char> active = conditions.activeSymmetries(middle);
  if (active == activeSymmetries_)
    return;
  activeSymmetries_ = std::move(active);
  projections_ = conditions.projections(middle);
}

void NodalMotion::applyLocalDamping(Real fraction, const Conditions& conditions, Real middle,
                                    const NodalState& state)
{
  const NodeVectors damping = state.localDamping;
  if (fraction == 0)
  {
    if (localDampingActs_)
      Kokkos::deep_copy(damping, 0.0);
    localDampingActs_ = false;
    return;
  }
  localDampingActs_ = true;
  const ConstNodeVectors force = state.force, external = state.external, v = state.v;
  parallelFor(
      "coplane::dynamics::unbalancedForces", state.owned(),
      KOKKOS_LAMBDA(const int n) { set(damping, n, at(force, n) + at(external, n)); });
  conditions.clearConstrained(middle, projections_, damping);
  const auto followsBody = followsBody_;
  parallelFor(
      "coplane::dynamics::localDamping", state.owned(), KOKKOS_LAMBDA(const int n) {
        for (int c = 0; c < 3; ++c)
        {
          const Real size = followsBody(n) ? 0 : fraction * std::abs(damping(n, c));
          damping(n, c) = v(n, c) > 0 ? -size : v(n, c) < 0 ? size : 0;
        }
      });
}

void NodalMotion::startFreeFields(const Times& times, const Conditions& conditions,
                                  const RankMesh& mesh, const NodalState& state,
                                  const ElementForces& elements, const Comm& comm)
{
  freeFields_.start(kickTimesOf(times), conditions, mesh, state, elements, comm);
}

void NodalMotion::kick(const Times& times, const Conditions& conditions, NodalState& state)
{
  TimedRegion region("coplane::dynamics::kick");
  const Real massDamping = conditions.massDampingAt(times.damping);
  const Real localDamping = conditions.localDampingAt(times.damping);
  const Real middle = times.t + 0.5 * times.after;
  findProjections(conditions, middle);
  freeFields_.kick(kickTimesOf(times), conditions, massDamping, localDamping);
  if (!dashpots_.empty())
    dashpots_.act(dimension_, conditions, freeFields_, times.t, middle,
                  releasedReactions(conditions, middle, state), state.x, state.external);
  applyLocalDamping(localDamping, conditions, middle, state);
  dashpots_.drive(state.external);
  kickNodes(times, conditions, state);
  prescribe(times, conditions, state);
  if (conditions.axisymmetric)
    stopAtAxis(times, conditions, state);
  dashpots_.book(state.vPrevious, state.v, state.external);
  bodies_.kick(kickTimesOf(times), massDamping, localDamping, state);
  bookForces(times, massDamping, state);
  bodies_.bookSecondHalf(times.before);
}

/// What conditions that do not act any more gave to the nodes of dashpots in the last cycle [N].
std::vector<Vec3> NodalMotion::releasedReactions(const Conditions& conditions, Real middle,
                                                 const NodalState& state)
{
  constexpr Real roundOff = 1e-12; // of projections on normals
  const auto holds = [](const Vec3& f) { return f.x != 0 || f.y != 0 || f.z != 0; };
  const std::vector<int>& nodes = dashpots_.nodes();
  std::vector<Vec3> released(nodes.size());
  bool some = false;
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    released[i] = reaction(nodes[i]);
    some |= holds(released[i]);
  }
  if (!some)
    return released;
  const NodeVectors left("coplane::dynamics::releasedReactions", std::size_t(state.owned()));
  for (std::size_t i = 0; i < nodes.size(); ++i)
    set(left, nodes[i], released[i]);
  conditions.clearConstrained(middle, projections_, left);
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const Vec3 rest = at(left, nodes[i]);
    released[i] = norm(rest) > roundOff * norm(released[i]) ? rest : Vec3{};
  }
  return released;
}

/// Mass damping takes v at n as the mean of both half steps, like dashpots do: second order, and
/// the stable step stays that of the undamped body.
void NodalMotion::kickNodes(const Times& times, const Conditions& conditions, NodalState& state)
{
  const Real dt = kickOf(times), alpha = conditions.massDampingAt(times.damping);
  const Real half = 0.5 * dt * alpha;
  const NodeVectors v = state.v, vPrevious = state.vPrevious;
  const ConstNodeVectors force = state.force, external = state.external,
                         localDamping = state.localDamping;
  const ConstArray<Real> mass = state.mass;
  const bool locally = localDampingActs_;
  const auto given = [=](int n) // all forces at n that do not depend on v(n+1/2)
  {
    const Vec3 sum = at(force, n) + at(external, n);
    return locally ? sum + at(localDamping, n) : sum;
  };
  parallelFor(
      "coplane::dynamics::kickVelocities", state.owned(), KOKKOS_LAMBDA(const int n) {
        const Vec3 total = given(n);
        const Vec3 old = at(v, n);
        set(vPrevious, n, old);
        if (mass(n) > 0)
          set(v, n, (1 / (1 + half)) * ((1 - half) * old + (dt / mass(n)) * total));
      });
  if (dashpots_.empty())
    return;
  dashpots_.kick(dt, alpha, mass, given, vPrevious, v);
}

/// Velocities that conditions give; the force that this takes, and what the dampings no longer
/// give, is external.
void NodalMotion::prescribe(const Times& times, const Conditions& conditions, NodalState& state)
{
  const Real dt = kickOf(times), half = 0.5 * dt * conditions.massDampingAt(times.damping);
  const NodeVectors v = state.v, external = state.external;
  for (std::size_t i = 0; i < constrained_.size(); ++i)
    set(beforeConstraint_, int(i), at(v, constrained_[i]));
  conditions.prescribeVelocities(kickTimesOf(times), state.vPrevious, v, projections_);
  for (std::size_t i = 0; i < constrained_.size(); ++i)
  {
    const int n = constrained_[i];
    const Vec3 change = at(v, n) - at(beforeConstraint_, int(i));
    const Vec3 reaction =
        (state.mass(n) / dt * (1 + half)) * change + 0.5 * dashpots_.drag(n, change);
    set(reactions_, int(i), reaction);
    set(external, n, at(external, n) + reaction);
  }
}

void NodalMotion::letThroughAxis(const std::vector<int>& nodes)
{
  Kokkos::deep_copy(passesTheAxis_, false);
  for (const int n : nodes)
    passesTheAxis_(n) = true;
}

/// Rings that close meet themselves on the axis of a body of revolution: a node comes to it and no
/// further. What stops it is external, and takes the energy of its radial motion.
void NodalMotion::stopAtAxis(const Times& times, const Conditions& conditions,
                             NodalState& state) const
{
  const Real after = times.after, dt = kickOf(times);
  const Real share = (1 + 0.5 * dt * conditions.massDampingAt(times.damping)) / dt;
  if (!(after > 0))
    return;
  const NodeVectors v = state.v, external = state.external;
  const ConstNodeVectors x = state.x;
  const ConstArray<Real> mass = state.mass;
  for (const int n : dashpots_.nodes())
    if (const Real change = -x(n, 0) / after - v(n, 0); change > 0 && !passesTheAxis_(n))
      set(external, n, at(external, n) + 0.5 * dashpots_.drag(n, {change, 0, 0}));
  const auto passes = passesTheAxis_;
  parallelFor(
      "coplane::dynamics::stopAtAxis", state.owned(), KOKKOS_LAMBDA(const int n) {
        const Real inward = -x(n, 0) / after; // brings it to the axis in this step
        if (v(n, 0) >= inward || passes(n))
          return;
        external(n, 0) += share * mass(n) * (inward - v(n, 0));
        v(n, 0) = inward;
      });
}

void NodalMotion::bookForces(const Times& times, Real alpha, const NodalState& state)
{
  const Real dt = kickOf(times), before = 0.5 * times.before, after = 0.5 * times.after;
  const NodeVectors damping = state.damping, impulse = state.impulse,
                    angularImpulse = state.angularImpulse;
  const ConstNodeVectors x = state.x, v = state.v, vPrevious = state.vPrevious, force = state.force,
                         external = state.external, localDamping = state.localDamping;
  const ConstArray<Real> mass = state.mass;
  const auto externalWork = state.externalWork, dampingWork = state.dampingWork,
             localDampingWork = state.localDampingWork, totalWork = state.totalWork;
  const auto followsBody = followsBody_;
  if (alpha == 0 && massDampingActs_)
    Kokkos::deep_copy(damping, 0.0);
  massDampingActs_ = alpha > 0;
  const bool massive = massDampingActs_, locally = localDampingActs_;
  const auto acts = [](const Vec3& f) { return f.x != 0 || f.y != 0 || f.z != 0; };
  // This pass is bound by memory: it leaves alone what does not change.
  parallelFor(
      "coplane::dynamics::bookForces", state.owned(), KOKKOS_LAMBDA(const int n) {
        const Vec3 path = before * at(vPrevious, n) + after * at(v, n);
        Vec3 outer = at(external, n);
        if (acts(outer))
          externalWork(n) += dot(outer, path);
        if (massive)
        {
          const Real drag = followsBody(n) ? 0 : -0.5 * alpha * mass(n);
          const Vec3 dragged = drag * (at(vPrevious, n) + at(v, n));
          set(damping, n, dragged);
          dampingWork(n) -= dot(dragged, path);
          outer += dragged;
        }
        if (locally)
        {
          localDampingWork(n) -= dot(at(localDamping, n), path);
          outer += at(localDamping, n);
        }
        if (acts(outer))
        {
          set(impulse, n, at(impulse, n) + dt * outer);
          set(angularImpulse, n, at(angularImpulse, n) + dt * cross(at(x, n), outer));
        }
        totalWork(n) += dot(at(force, n) + outer, path);
      });
}

/// Works are booked to n + 1/2 in the kick; this motion ends at n.
void NodalMotion::takeBackWorkAhead(Real step, const NodalState& state) const
{
  const Real half = 0.5 * step;
  parallelFor(
      "coplane::dynamics::takeBackWorkAhead", state.owned(), KOKKOS_LAMBDA(const int n) {
        const Vec3 path = half * at(state.v, n);
        const Vec3 external = at(state.external, n), damping = at(state.damping, n),
                   localDamping = at(state.localDamping, n);
        state.externalWork(n) -= dot(external, path);
        state.dampingWork(n) += dot(damping, path);
        state.localDampingWork(n) += dot(localDamping, path);
        state.totalWork(n) -= dot(at(state.force, n) + external + damping + localDamping, path);
      });
}

Real NodalMotion::stop(const Times& times, const Conditions& conditions, NodalState& state,
                       const Comm& comm)
{
  const Real kinetic = kineticAtFullStep(state, comm);
  takeBackWorkAhead(times.after, state);
  const NodeVectors v = state.v, vPrevious = state.vPrevious;
  const NodeVectors impulse = state.impulse, angularImpulse = state.angularImpulse;
  const ConstNodeVectors x = state.x;
  const ConstArray<Real> mass = state.mass;
  const auto followsBody = followsBody_;
  const auto copy = vPrevious; // what the velocities are before the stop
  parallelFor(
      "coplane::dynamics::stopMotion", state.owned(), KOKKOS_LAMBDA(const int n) {
        set(copy, n, at(v, n));
        set(v, n, {});
      });
  conditions.keepPrescribed(kickTimesOf(times), copy, v);
  parallelFor(
      "coplane::dynamics::bookStop", state.owned(), KOKKOS_LAMBDA(const int n) {
        if (followsBody(n))
          return;
        const Vec3 lost = mass(n) * (at(v, n) - at(copy, n));
        set(impulse, n, at(impulse, n) + lost);
        set(angularImpulse, n, at(angularImpulse, n) + cross(at(x, n), lost));
      });
  bodies_.stop(kickTimesOf(times), state);
  freeFields_.stop(kickTimesOf(times), conditions);
  applyLoads(conditions, times.t, 0, state);
  kick({times.t, 0, times.after, times.damping}, conditions, state); // a start
  mirrorVelocities(state);
  return kinetic - kineticAtFullStep(state, comm);
}

void NodalMotion::mirrorVelocities(NodalState& state)
{
  const auto v = state.v;
  const auto vPrevious = state.vPrevious;
  parallelFor(
      "coplane::dynamics::mirrorVelocities", state.owned(),
      KOKKOS_LAMBDA(const int n) { set(vPrevious, n, 2.0 * at(vPrevious, n) - at(v, n)); });
  bodies_.mirrorVelocities();
}

namespace
{
constexpr const char* reactionsTable = "nodes/reactions";
const std::vector<std::string> reactionsColumns{"reaction_x", "reaction_y", "reaction_z"};
} // namespace

void NodalMotion::save(const std::vector<GlobalId>& ids, StateTables& out) const
{
  KeyedRows rows;
  rows.columns = reactionsColumns;
  for (std::size_t i = 0; i < constrained_.size(); ++i)
  {
    Real* row = rows.add({ids[constrained_[i]]});
    for (int c = 0; c < 3; ++c)
      row[c] = reactions_(i, c);
  }
  out.rows(reactionsTable, rows);
  dashpots_.save(ids, out);
  freeFields_.save(out);
  bodies_.save(out);
}

void NodalMotion::restore(const std::vector<GlobalId>& ids, const StateSource& in)
{
  std::vector<GlobalId> mine;
  for (const int node : constrained_)
    mine.push_back(ids[node]);
  // Nodes that a stage holds for the first time had no reaction before.
  const KeyedRows rows =
      in.rowsOf(reactionsTable, reactionsColumns, mine, StateSource::Missing::Zero);
  for (std::size_t i = 0; i < constrained_.size(); ++i)
    for (int c = 0; c < 3; ++c)
      reactions_(i, c) = rows.row(i)[c];
  dashpots_.restore(ids, in);
  freeFields_.restore(in);
  bodies_.restore(in);
}

Real NodalMotion::kineticAtHalfStep(const NodalState& state, const Comm& comm) const
{
  std::vector<ExactSum> sums(1);
  for (int n = 0; n < state.owned(); ++n)
    if (!followsBody(n))
      sums[0].add(0.5 * state.mass(n) * dot(at(state.v, n), at(state.v, n)));
  if (comm.isRoot()) // every rank has all bodies
    sums[0].add(bodies_.kineticAtHalfStep());
  return ExactSum::overRanks(sums, comm)[0];
}

Real NodalMotion::kineticAtFullStep(const NodalState& state, const Comm& comm) const
{
  std::vector<ExactSum> sums(1);
  for (int n = 0; n < state.owned(); ++n)
    if (!followsBody(n))
      sums[0].add(0.5 * state.mass(n) * dot(at(state.vPrevious, n), at(state.v, n)));
  if (comm.isRoot())
    sums[0].add(bodies_.kinetic());
  return ExactSum::overRanks(sums, comm)[0];
}
} // namespace coplane
