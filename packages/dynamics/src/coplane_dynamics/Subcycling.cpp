#include <coplane_core/Timers.hpp>
#include <coplane_core/WorkWatch.hpp>
#include <coplane_dynamics/Subcycling.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
/// What is below this many steps of a cycle is substepped, so that it may be crushed further before
/// it limits the cycle, and stays so up to the other.
constexpr Real margin = 1.15, marginToStay = 1.3;
/// What a substep of a node costs over what a node costs in a cycle: those that are substepped are
/// in contact more often than others.
constexpr Real costOfSubstep = 1.5;
constexpr Real worthWhile = 0.9; ///< of the work without substeps: a plan has to do with less
constexpr int perLevel = 4; ///< lengths of a cycle that plan() chooses from, between powers of two
constexpr Real roundOff = 1e-12;

std::vector<int> sortedOnce(std::vector<int> numbers)
{
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

/// One step of a smoothing over some hundred cycles. Two in a row follow waves and resonances so
/// little that these gain some 1e-6 in a cycle where nothing damps them.
Vec3 smoothed(const Vec3& mean, const Vec3& value)
{
  constexpr Real follow = 1.0 / 300;
  return mean + follow * (value - mean);
}

void clear(const std::vector<int>& nodes, const NodeVectors& values)
{
  for (const int n : nodes)
    set(values, n, {});
}
} // namespace

std::int64_t Subcycling::elementsHere(const Parts& parts) const
{
  std::int64_t count = 0;
  for (const Group& group : groups_)
    for (const int e : group.elements)
      count += parts.mesh().blocks[group.block].owned[std::size_t(e)] != 0;
  return count;
}

void Subcycling::begin(const Cycle& cycle, const Loads& applyLoads, const Parts& parts,
                       NodalState& state, ElementForces& elements, Contact* contact,
                       WorkTimes& work)
{
  for (const int n : std::exchange(reacting_, {}))
    set(reactionImpulse_, n, {});
  if (count_ == 1)
    return;
  const Real dt = cycle.dt;
  TimedRegion region("coplane::dynamics::subcycling");
  const Real step = dt / count_;
  if (last_.extent(0) != state.v.extent(0))
    last_ = NodeVectors("coplane::dynamics::lastVelocity", state.v.extent(0));
  Kokkos::deep_copy(last_, state.v);
  reacting_ = moved_ = nodes_;
  std::vector<Vec3> start, way(nodes_.size());
  for (const int n : nodes_)
    start.push_back(at(state.x, n));
  for (Group& group : groups_)
    elements.block(group.block).give(group.elements, group.part);
  const auto drift = [&]
  {
    for (std::size_t i = 0; i < nodes_.size(); ++i)
    {
      const int n = nodes_[i];
      way[i] += step * at(last_, n);
      set(state.x, n, start[i] + (at(state.xRest, n) + way[i]));
    }
  };
  for (int substep = 1; substep < count_; ++substep)
  {
    drift();
    parts.layout.refresh(state.x, last_);
    updateGroups(state, step, work);
    if (contact)
    {
      const WorkWatch watch(work.planes);
      if (substep == 1)
        contact->beginSubsteps(state.x, {last_, step}, cycle.sinceSearch + step, cycle.lookAhead);
      contact->updateSubstepped(state.x, {last_, step});
    }
    const WorkWatch watch(work.nodes);
    applyLoads(parts.clock.time + substep * step, step);
    sumForces(contact, forces_);
    kick(step, parts.model.axisymmetric(), state);
  }
  drift();
  for (std::size_t i = 0; i < nodes_.size(); ++i)
  {
    const int n = nodes_[i];
    set(state.v, n, (1 / dt) * way[i]);
    set(state.x, n, start[i]);
  }
}

/// One that has turned inside out stays as it is: the end of the cycle tells of it.
void Subcycling::updateGroups(const NodalState& state, Real dt, WorkTimes& work)
{
  for (Group& group : groups_)
  {
    const WorkWatch watch(work.elements[group.block]);
    if (group.part.smallestStableStep() > 0)
      group.part.update(state.x, last_, dt);
  }
}

void Subcycling::sumForces(const Contact* contact, const NodeVectors& forces) const
{
  clear(nodes_, forces);
  for (const Group& group : groups_)
  {
    const Real* const cornerForce = group.part.cornerForce().data();
    for (std::size_t i = 0; i < nodes_.size(); ++i)
    {
      Vec3 sum = at(forces, nodes_[i]);
      for (const int entry : group.corners[i])
      {
        const Real* const f = cornerForce + 3 * std::size_t(entry);
        sum += {f[0], f[1], f[2]};
      }
      set(forces, nodes_[i], sum);
    }
  }
  if (contact)
    contact->addSubsteppedForces(forces);
}

/// Along which directions conditions hold substepped nodes within the next cycle, to the velocities
/// that it begins with; those that win are the last.
void Subcycling::findHolds(const Parts& parts)
{
  const Real middle = parts.clock.time + 0.5 * parts.clock.nextStep;
  holds_ = {nodes_.size(), [&](const auto& visit)
            {
              const auto visitNode = [&](int node, const Vec3& direction)
              {
                if (const int place = placeOf_[std::size_t(node)]; place >= 0)
                  visit(std::size_t(place), direction);
              };
              for (const Conditions::Projection& projection : parts.motion.projections())
                visitNode(projection.node, projection.normal);
              for (const PrescribedVelocity& given : parts.model.conditions.velocities)
                for (int c = 0; c < 3 && given.when.holds(middle); ++c)
                  for (const int node : given.nodes)
                    if (given.components[std::size_t(c)])
                      visitNode(node, {Real(c == 0), Real(c == 1), Real(c == 2)});
            }};
}

Vec3 Subcycling::withoutHeld(std::size_t place, Vec3 force) const
{
  for (const Vec3& direction : holds_[place])
    force -= dot(direction, force) * direction;
  return force;
}

/// In the middle of a cycle.
void Subcycling::kick(Real dt, bool axisymmetric, NodalState& state)
{
  for (std::size_t i = 0; i < nodes_.size(); ++i)
  {
    const int n = nodes_[i];
    if (!(state.mass(n) > 0))
      continue;
    const Vec3 load = at(state.external, n), before = at(last_, n);
    const Vec3 force = at(forces_, n) + at(state.steadyForce, n) + load;
    Vec3 free = withoutHeld(i, force);
    Vec3 after = before + (dt / state.mass(n)) * free;
    if (axisymmetric && after.x < -state.x(n, 0) / dt) // comes to the axis and no further
    {
      free.x += state.mass(n) / dt * (-state.x(n, 0) / dt - after.x);
      after.x = -state.x(n, 0) / dt;
    }
    const Vec3 held = free - force;
    const Vec3 path = (0.5 * dt) * (before + after);
    set(last_, n, after);
    set(reactionImpulse_, n, at(reactionImpulse_, n) + dt * held);
    const Vec3 outer = load + held;
    set(state.impulse, n, at(state.impulse, n) + dt * outer);
    set(state.angularImpulse, n, at(state.angularImpulse, n) + dt * cross(at(state.x, n), outer));
    state.externalWork(n) += dot(outer, path);
    state.totalWork(n) += dot(free, path);
  }
}

void Subcycling::endElements(Real dt, const NodeLayout& layout, const NodalState& state,
                             ElementForces& elements, WorkTimes& work)
{
  if (count_ == 1)
    return;
  TimedRegion region("coplane::dynamics::subcycling");
  layout.refresh(state.x, last_);
  updateGroups(state, dt / count_, work);
  for (const Group& group : groups_)
    elements.block(group.block).take(group.elements, group.part);
}

void Subcycling::relist(const Parts& parts, Contact* contact)
{
  if (!acts())
    return;
  // Ghost nodes may be others, and know neither their steps nor their last velocities.
  parts.layout.refresh(parts.state.substeps);
  if (count_ == 1)
    return;
  const NodeVectors last("coplane::dynamics::lastVelocity", std::size_t(parts.layout.size()));
  Kokkos::deep_copy(last, parts.state.v);
  for (const int n : moved_)
    set(last, n, at(last_, n));
  parts.layout.refresh(parts.state.x, last);
  last_ = last;
  list(parts, contact);
}

void Subcycling::endMotion(NodalState& state)
{
  for (const int n : moved_)
    set(state.v, n, at(last_, n));
}

Array<Real> Subcycling::leastAround(const Parts& parts, const Array<Real>& ofNodes)
{
  std::vector<Array<Real>> ofElements;
  for (std::size_t b = 0; b < parts.blocks().size(); ++b)
  {
    const auto connectivity = parts.blocks()[b].connectivity();
    const Array<Real> least("coplane::dynamics::leastOfElements",
                            std::size_t(parts.blocks()[b].count()));
    parallelFor(
        "coplane::dynamics::leastOfElements", int(least.extent(0)), KOKKOS_LAMBDA(const int e) {
          Real lowest = infinity;
          for (int c = 0; c < int(connectivity.extent(1)); ++c)
            lowest = std::min(lowest, ofNodes(connectivity(e, c)));
          least(e) = lowest;
        });
    ofElements.push_back(least);
  }
  const Array<Real> around("coplane::dynamics::leastAround", std::size_t(parts.layout.owned()));
  parallelFor("coplane::dynamics::leastAround", parts.layout.owned(),
              [&](const int n)
              {
                around(n) = ofNodes(n);
                parts.elements.forEachAround(n,
                                             [&](std::size_t b, int e) {
                                               around(n) = std::min(around(n), ofElements[b](e));
                                             });
              });
  return around;
}

/// Nodes that may be substepped: rigid bodies, lines and dashpots act once in a cycle, and nodal
/// pressures belong to all elements around.
void Subcycling::findEligible(const Parts& parts)
{
  const int owned = parts.layout.owned();
  eligible_.assign(std::size_t(owned), 1);
  const bool nodalPressure = std::any_of(
      parts.blocks().begin(), parts.blocks().end(),
      [](const ElementBlock& block) { return block.options().form == ElementForm::NodalPressure; });
  const Conditions& conditions = parts.model.conditions;
  if (!nodalPressure && parts.bodies().count() == 0 && parts.lines.empty() &&
      conditions.absorbing.empty() && conditions.freeFields.empty())
    return;
  const Array<Real> free("coplane::dynamics::free", std::size_t(parts.layout.size()));
  for (int n = 0; n < owned; ++n)
    free(n) = !parts.motion.followsBody(n) && !(parts.lines.stiffnessAt(n) > 0);
  for (const int n : parts.motion.nodesOfDashpots())
    free(n) = 0;
  for (std::size_t b = 0; b < parts.blocks().size(); ++b)
    if (parts.blocks()[b].options().form == ElementForm::NodalPressure)
      for (const int n : parts.mesh().blocks[b].connectivity)
        free(n) = 0;
  parts.layout.refresh(free);
  const Array<Real> allAround = leastAround(parts, free);
  for (int n = 0; n < owned; ++n)
    eligible_[std::size_t(n)] = allAround(n) > 0;
  if (parts.contact)
    parts.contact->forEachPair(
        [&](const Face& a, const Face& b)
        {
          const auto isFree = [&](const Face& face)
          {
            return !face.rigid && std::all_of(face.nodes, face.nodes + face.count,
                                              [&](int n) { return free(n) > 0; });
          };
          if (isFree(a) && isFree(b))
            return;
          for (const Face* face : {&a, &b})
            for (int k = 0; k < face->count; ++k)
              if (face->nodes[k] < owned)
                eligible_[std::size_t(face->nodes[k])] = 0;
        });
}

Real Subcycling::plan(const Parts& parts, const TimeStep& step)
{
  TimedRegion region("coplane::dynamics::subcycling");
  const int owned = parts.layout.owned();
  findEligible(parts);
  const Array<Real> steps("coplane::dynamics::stepsOfNodes", std::size_t(parts.layout.size()));
  parallelFor("coplane::dynamics::stepsOfNodes", owned,
              [&](const int n)
              {
                steps(n) = parts.state.mass(n) > 0 && !parts.motion.followsBody(n)
                               ? step.nodeStep(parts, n)
                               : infinity;
              });
  steps_ = steps;
  std::vector<Real> bounds{infinity, step.stableOfBodies(parts)};
  for (int n = 0; n < owned; ++n)
  {
    Real& bound = bounds[eligible_[std::size_t(n)] ? 0 : 1];
    bound = std::min(bound, steps(n));
  }
  parts.comm.min(bounds);
  leastEligible_ = bounds[0];
  least_ = std::min(bounds[0], bounds[1]);
  // Lengths of a cycle to choose from.
  const int choices = perLevel * (options_.subcyclingLevels - 1) + 1;
  const auto length = [&](int choice)
  { return std::min(bounds[0] * std::exp2(Real(choice) / perLevel), bounds[1]); };
  planned_ = length(0);
  if (!(planned_ > 0) || !(planned_ < infinity))
    return planned_;
  parts.layout.refresh(steps);
  const Array<Real> around = leastAround(parts, steps);
  std::vector<std::int64_t> substepped(std::size_t(choices) + 1, 0); // the last one: all nodes
  for (int n = 0; n < owned; ++n)
  {
    ++substepped.back();
    if (eligible_[std::size_t(n)])
      for (int choice = choices - 1; choice > 0 && around(n) < margin * length(choice); --choice)
        ++substepped[std::size_t(choice)];
  }
  parts.comm.sum(substepped);
  Real leastWork = worthWhile * Real(substepped.back()) / length(0); // per time
  for (int choice = 1; choice < choices; ++choice)
  {
    const int substeps = 1 << ((choice + perLevel - 1) / perLevel);
    const Real work = (Real(substepped.back()) +
                       costOfSubstep * substeps * Real(substepped[std::size_t(choice)])) /
                      length(choice);
    if (work < leastWork)
    {
      leastWork = work;
      planned_ = length(choice);
    }
  }
  return planned_;
}

void Subcycling::regroup(Real step, const Parts& parts, NodalState& state, Contact* contact)
{
  TimedRegion region("coplane::dynamics::subcycling");
  countBefore_ = count_;
  const Real factor = options_.stepFactor;
  count_ = 1;
  while (count_ < 1 << (options_.subcyclingLevels - 1) &&
         count_ * factor * leastEligible_ < (1 - roundOff) * step)
    count_ *= 2;
  std::int64_t isOther = count_ != countBefore_;
  for (int n = 0; n < state.owned(); ++n)
  {
    const bool was = state.substeps(n) > 1;
    const bool is = count_ > 1 && eligible_[std::size_t(n)] != 0 &&
                    factor * steps_(n) < (was ? marginToStay : margin) * step;
    isOther |= std::int64_t(is != was);
    state.substeps(n) = is ? count_ : 1;
  }
  isRegrouped_ = parts.comm.max(isOther) > 0;
  if (!isRegrouped_)
    return;
  nodesBefore_ = nodes_;
  if (countBefore_ > 1)
    sumForces(contact, forcesBefore_);
  parts.layout.refresh(state.substeps);
  list(parts, contact);
}

void Subcycling::restore(const Parts& parts, NodalState& state, Contact* contact)
{
  if (!acts())
    return;
  Real most = 1;
  for (int n = 0; n < state.owned(); ++n)
    most = std::max(most, state.substeps(n));
  count_ = int(parts.comm.max(most));
  parts.layout.refresh(state.substeps);
  list(parts, contact);
  findHolds(parts);
  weighed_ = nodes_;
}

/// What is substepped, from the steps of nodes.
void Subcycling::list(const Parts& parts, Contact* contact)
{
  const int owned = parts.layout.owned();
  if (contact)
    contact->substepPairsAt(parts.state.substeps, owned);
  if (int(forces_.extent(0)) != owned)
    for (NodeVectors* values : {&forces_, &forcesBefore_, &reactionImpulse_})
      *values = NodeVectors("coplane::dynamics::substeps", std::size_t(owned));
  groups_.clear();
  nodes_.clear();
  listGroups(parts);
  for (const Group& group : groups_)
  {
    const auto connectivity = group.part.connectivity();
    for (int e = 0; e < group.part.count(); ++e)
      for (std::size_t c = 0; c < connectivity.extent(1); ++c)
        if (connectivity(e, c) < owned)
          nodes_.push_back(connectivity(e, c));
  }
  if (contact)
    nodes_.insert(nodes_.end(), contact->substepped().nodes().begin(),
                  contact->substepped().nodes().end());
  nodes_ = sortedOnce(std::move(nodes_));
  placeOf_.assign(std::size_t(owned), -1);
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    placeOf_[std::size_t(nodes_[i])] = int(i);
  for (Group& group : groups_)
  {
    const auto connectivity = group.part.connectivity();
    const int corners = int(connectivity.extent(1));
    group.corners = {nodes_.size(), [&](const auto& visit)
                     {
                       for (int e = 0; e < group.part.count(); ++e)
                         for (int c = 0; c < corners; ++c)
                           if (connectivity(e, c) < owned)
                             visit(std::size_t(placeOf_[std::size_t(connectivity(e, c))]),
                                   e * corners + c);
                     }};
  }
}

void Subcycling::listGroups(const Parts& parts)
{
  if (count_ == 1)
    return;
  const Array<Real> steps = parts.state.substeps;
  for (std::size_t b = 0; b < parts.blocks().size(); ++b)
  {
    const ElementBlock& block = parts.blocks()[b];
    const RankMesh::Block& part = parts.mesh().blocks[b];
    if (parts.elements.isRigid(b) || block.options().form == ElementForm::NodalPressure)
      continue;
    const int corners = topology(block.type()).nodes;
    std::vector<int> elements;
    for (int e = 0; e < block.count(); ++e)
    {
      const int* const nodes = part.connectivity.data() + std::size_t(e) * corners;
      if (block.isAlive(e) &&
          std::any_of(nodes, nodes + corners, [&](int n) { return steps(n) > 1; }))
        elements.push_back(e);
    }
    if (elements.empty())
      continue;
    std::sort(elements.begin(), elements.end(),
              [&](int p, int q) { return part.elementIds[p] < part.elementIds[q]; });
    ElementBlock some = block.part(elements);
    groups_.push_back({b, std::move(elements), std::move(some), {}});
  }
}

void Subcycling::weigh(Real before, Real after, NodalState& state, const Contact* contact)
{
  const bool isRegrouped = std::exchange(isRegrouped_, false);
  const std::vector<int> moved = std::exchange(moved_, {});
  for (const int n : std::exchange(weighed_, {}))
  {
    set(state.takenOff, n, {});
    state.swing(n) = 0;
  }
  kick_ = 0.5 * (before + after);
  isStart_ = before == 0;
  if (!isRegrouped)
  {
    countBefore_ = count_;
    nodesBefore_ = nodes_;
  }
  if (count_ == 1 && countBefore_ == 1)
    return;
  sumForces(contact, forces_);
  const NodeVectors forcesBefore = isRegrouped ? forcesBefore_ : forces_;
  // Impulses of half a cycle that come in other substeps than the first or last.
  const Real lateBefore = 0.5 * before * (1 - 1.0 / countBefore_),
             lateAfter = 0.5 * after * (1 - 1.0 / count_);
  std::vector<Vec3> slow;
  for (const int n : nodes_)
    slow.push_back(at(state.force, n) - at(forces_, n));
  const auto takeOff = [&](const NodeVectors& from, int n, Real impulse, const Vec3& force)
  {
    const Vec3 off = (impulse / kick_) * force;
    set(from, n, at(from, n) - off);
    set(state.takenOff, n, at(state.takenOff, n) + off);
  };
  std::vector<Vec3> loads;
  for (const int n : nodes_)
    loads.push_back(at(state.external, n));
  weighed_ = nodes_;
  weighed_.insert(weighed_.end(), nodesBefore_.begin(), nodesBefore_.end());
  weighed_.insert(weighed_.end(), moved.begin(), moved.end());
  substepOfKick_ = (before / countBefore_ + after / count_) / (before + after);
  if (countBefore_ > 1)
    for (const int n : nodesBefore_)
      takeOff(state.force, n, lateBefore, at(forcesBefore, n));
  std::vector<char> isMoved(std::size_t(state.owned()), 0);
  for (const int n : moved)
  {
    isMoved[std::size_t(n)] = 1;
    takeOff(state.force, n, lateBefore, at(state.steadyForce, n));
    takeOff(state.external, n, lateBefore, at(state.external, n));
    set(state.underWay, n, {});
    if (placeOf_[std::size_t(n)] < 0)
      for (const NodeVectors& steady : {state.steadyMean, state.steadyForce})
        set(steady, n, {});
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i)
  {
    const int n = nodes_[i];
    const bool goesOn = isMoved[std::size_t(n)] != 0;
    const Vec3 mean = goesOn ? smoothed(at(state.steadyMean, n), slow[i]) : slow[i],
               steady = goesOn ? smoothed(at(state.steadyForce, n), mean) : slow[i];
    set(state.steadyMean, n, mean);
    set(state.steadyForce, n, steady);
    set(state.underWay, n, lateAfter * steady);
    takeOff(state.force, n, lateAfter, at(forces_, n) + steady);
    takeOff(state.external, n, lateAfter, loads[i]);
  }
}

void Subcycling::endKick(const Parts& parts, NodalState& state)
{
  if (nodes_.empty())
    return;
  findHolds(parts);
  if (isStart_)
    reacting_ = nodes_;
  for (std::size_t i = 0; i < nodes_.size(); ++i)
  {
    const int n = nodes_[i];
    if (!(state.mass(n) > 0))
      continue;
    // Velocities change by the kick, in which forces that are in balance may not be, and would by
    // all forces at n in a substep.
    const Vec3 change = at(state.v, n) - at(state.vPrevious, n),
               inSubstep = substepOfKick_ * (change + (kick_ / state.mass(n)) *
                                                          withoutHeld(i, at(state.takenOff, n)));
    if (isStart_) // what holds it comes in substeps, of which there have been none
    {
      const Vec3 off = at(state.takenOff, n);
      set(reactionImpulse_, n, kick_ * (withoutHeld(i, off) - off));
    }
    state.swing(n) = 0.125 * state.mass(n) * (dot(change, change) - dot(inSubstep, inSubstep));
  }
}

Vec3 Subcycling::reaction(int node) const
{
  return reactionImpulse_.extent(0) > 0 && kick_ > 0 ? (1 / kick_) * at(reactionImpulse_, node)
                                                     : Vec3{};
}
} // namespace coplane
