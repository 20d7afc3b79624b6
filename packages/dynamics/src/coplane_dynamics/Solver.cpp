#include <coplane_core/Log.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_core/WorkWatch.hpp>
#include <coplane_dynamics/ContactFaces.hpp>
#include <coplane_dynamics/Rebalancer.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_mesh/Bodies.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
constexpr std::int64_t energyCheckEvery = 100; // cycles
/// Step by the motion of faces over that by elements when faces are about as fast as waves.
constexpr Real fasterThanWaves = 0.35;
constexpr Real mostCycles = 1e15; // some centuries
constexpr Real mostSkins = 1e8;   // of relative motion in one step
} // namespace

Solver::Solver(Model model, const Comm& comm)
    : model_(std::move(model)), comm_(&comm), layout_(comm, model_.mesh), state_(model_.mesh),
      dashpots_(model_.conditions, model_.mesh.ownedNodes)
{
  const RankMesh& mesh = model_.mesh;
  const int owned = mesh.ownedNodes;
  contactStiffness_ = Array<Real>("coplane::dynamics::contactStiffness", owned);

  for (int b = 0; b < int(mesh.blocks.size()); ++b)
  {
    const RankMesh::Block& part = mesh.blocks[b];
    const BlockSetup& setup = model_.blocks[b];
    blocks_.emplace_back(part.type, setup.material, setup.hourglass, model_.viscosity,
                         part.connectivity, setup.element);
    ElementBlock& block = blocks_.back();
    block.initialise(state_.x);
    if (!setup.rigid)
      attempt([&] { setInitialStress(b); });

    const int corners = topology(part.type).nodes;
    // Node to corners, in the order of element ids, so that sums have the same order on every rank.
    std::vector<int> order(part.elements());
    for (int e = 0; e < part.elements(); ++e)
      order[e] = e;
    std::sort(order.begin(), order.end(),
              [&](int p, int q) { return part.elementIds[p] < part.elementIds[q]; });
    Gather gather;
    gather.start = Array<int>("coplane::dynamics::gatherStart", owned + 1);
    for (const int node : part.connectivity)
      if (node < owned)
        ++gather.start(node + 1);
    for (int n = 0; n < owned; ++n)
      gather.start(n + 1) += gather.start(n);
    gather.entry = Array<int>("coplane::dynamics::gatherEntry", gather.start(owned));
    std::vector<int> next(gather.start.data(), gather.start.data() + owned);
    for (const int e : order)
      for (int k = 0; k < corners; ++k)
      {
        const int node = part.connectivity[e * corners + k];
        if (node < owned)
        {
          gather.entry(next[node]++) = e * corners + k;
          state_.mass(node) += block.cornerMass(e, k);
        }
        const Vec3 x = at(state_.x, node);
        attempt([&] { set(state_.v, node, setup.velocityAt(x)); });
      }
    gathers_.push_back(gather);
  }
  layout_.refresh(state_.mass);
  std::vector<char> rigidBlocks;
  for (const BlockSetup& setup : model_.blocks)
    rigidBlocks.push_back(setup.rigid);
  rigid_.emplace(mesh, model_.rigidBodyOfNode, rigidBlocks, blocks_, state_, comm);
  rigid_->takeConditions(model_.conditions);
  followsBody_ = Array<bool>("coplane::dynamics::followsBody", owned);
  for (int n = 0; n < owned; ++n)
    followsBody_(n) = rigid_->holds(n);
  constrained_ = model_.conditions.constrainedNodes();
  projections_ = model_.conditions.projections();
  beforeConstraint_ = NodeVectors("coplane::dynamics::beforeConstraint", constrained_.size());

  prepareErosion();
  takeWorkTimes();
  if (model_.contactEnabled)
  {
    const std::vector<ExteriorFace> exterior = exteriorFaces(mesh);
    bodyOfNode_ = bodyLabels(mesh, std::vector<char>(mesh.blocks.size(), 1), comm);
    std::vector<Face> faces =
        contactFaces(mesh, blocks_, model_.faceGroups, bodyOfNode_, exterior, state_.x);
    const Real smallest = Contact::smallestFaceSize(faces, state_.x, mesh.dimension, comm);
    const Real skin = model_.skin ? *model_.skin : (model_.searchEvery == 0 ? 0.5 : 0.1) * smallest;
    contact_ = std::make_unique<Contact>(comm, mesh.dimension, std::move(faces), model_.contact,
                                         model_.contactRules, skin, smallest);
  }
}

void Solver::setInitialStress(int b)
{
  const RankMesh::Block& part = model_.mesh.blocks[b];
  for (int e = 0; e < part.elements(); ++e)
    blocks_[b].setInitialStress(e, model_.blocks[b].stressOfElement(model_.mesh, b, e));
}

void Solver::search(bool again)
{
  TimedRegion region("coplane::dynamics::search");
  contact_->coverMotion(relativeSpeed_ * largestNextStep_);
  searchSkin_ = contact_->skin();
  const std::vector<GlobalId> ghostNodes =
      contact_->findGhosts(state_.x, layout_.ids(), state_.v, largestNextStep_);
  if (layout_.setGhostNodes(ghostNodes))
  {
    state_.resize(layout_);
    layout_.refresh(state_.x, state_.v);
    layout_.refresh(state_.mass);
  }
  contact_->pairUp(state_.x, layout_, again, state_.v);
  const auto x = state_.x;
  const auto atSearch = state_.atSearch;
  parallelFor(
      "coplane::dynamics::rememberPositions", layout_.owned(),
      KOKKOS_LAMBDA(const int n) { set(atSearch, n, at(x, n)); });
}

namespace
{
/// Adds the forces of the elements of a block to owned nodes.
void gatherBlock(int owned, const Array<int>& start, const Array<int>& entry,
                 const ElementBlock& block, bool first, const NodeVectors& force)
{
  // Corners of all elements one after another, as the entries count them.
  const Real* const cornerForce = block.cornerForce().data();
  parallelFor(
      "coplane::dynamics::gatherForces", owned, KOKKOS_LAMBDA(const int n) {
        Vec3 sum = first ? Vec3{} : at(force, n);
        for (int i = start(n); i < start(n + 1); ++i)
        {
          const Real* const f = cornerForce + 3 * std::size_t(entry(i));
          sum += {f[0], f[1], f[2]};
        }
        set(force, n, sum);
      });
}
} // namespace

void Solver::gatherElementForces()
{
  TimedRegion region("coplane::dynamics::gatherForces");
  const WorkWatch watch(work_.nodes);
  bool first = true;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
  {
    if (isRigid(b))
      continue;
    gatherBlock(layout_.owned(), gathers_[b].start, gathers_[b].entry, blocks_[b], first,
                state_.force);
    first = false;
  }
  if (first)
    Kokkos::deep_copy(state_.force, 0.0);
}

/// Dilatation of the step at every node from the elements of one block around it; empty where the
/// block does not ask for it. Collective when it does.
ConstArray<Real> Solver::nodalDilatation(std::size_t b, Real dt)
{
  ElementBlock& block = blocks_[b];
  if (block.options().form != ElementForm::NodalPressure || dt == 0)
    return {};
  {
    const WorkWatch watch(work_.elements[b]);
    block.findVolumeChanges(state_.x, state_.v, dt);
  }
  if (int(dilatation_.extent(0)) != layout_.size())
    dilatation_ = Array<Real>("coplane::dynamics::nodalDilatation", layout_.size());
  const auto start = gathers_[b].start;
  const auto entry = gathers_[b].entry;
  const auto changes = block.volumeChanges();
  const auto dilatation = dilatation_;
  const ElementBlock* const elements = &block;
  const int corners = topology(block.type()).nodes;
  parallelFor(
      "coplane::dynamics::nodalDilatation", layout_.owned(), KOKKOS_LAMBDA(const int n) {
        Real change = 0, volume = 0;
        for (int i = start(n); i < start(n + 1); ++i)
          if (elements->isAlive(entry(i) / corners))
          {
            change += changes(0, entry(i) / corners);
            volume += changes(1, entry(i) / corners);
          }
        dilatation(n) = volume > 0 ? change / volume : 0;
      });
  layout_.refresh(dilatation_);
  return dilatation_;
}

void Solver::findForces(Real dt)
{
  {
    TimedRegion region("coplane::element::update");
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      if (!isRigid(b))
      {
        const ConstArray<Real> dilatation = nodalDilatation(b, dt);
        const WorkWatch watch(work_.elements[b]);
        blocks_[b].update(state_.x, state_.v, dt, dilatation);
      }
  }
  const bool someDied = dt > 0 && erode(dt);
  if (contact_ && (searchIsDue_ || someDied))
    search();
  if (contact_)
  {
    const WorkWatch watch(work_.planes);
    // The speed of approach may grow by the kick that lies between: twice the step.
    contact_->step6_updateCommonPlanes(state_.x, state_.v, state_.mass, dt, 2 * largestNextStep_);
  }
  gatherElementForces();
  if (contact_)
  {
    TimedRegion region("coplane::contact::addForces");
    const WorkWatch watch(work_.planes);
    Kokkos::deep_copy(state_.contactForce, 0.0);
    contact_->addForces(state_.contactForce, contactStiffness_);
    const auto force = state_.force;
    const auto contactForce = state_.contactForce;
    parallelFor(
        "coplane::dynamics::addContactForces", layout_.owned(),
        KOKKOS_LAMBDA(const int n) { set(force, n, at(force, n) + at(contactForce, n)); });
  }
}

void Solver::drift(Real dt)
{
  const WorkWatch watch(work_.nodes);
  const auto x = state_.x;
  const ConstNodeVectors v = state_.v;
  parallelFor(
      "coplane::dynamics::drift", layout_.owned(),
      KOKKOS_LAMBDA(const int n) { set(x, n, at(x, n) + dt * at(v, n)); });
  rigid_->drift(dt);
}

void Solver::applyLocalDamping()
{
  const Real fraction = model_.conditions.localDampingAt(dampingTime());
  const NodeVectors damping = state_.localDamping;
  if (fraction == 0)
  {
    if (localDampingActs_)
      Kokkos::deep_copy(damping, 0.0);
    localDampingActs_ = false;
    return;
  }
  localDampingActs_ = true;
  const ConstNodeVectors force = state_.force, external = state_.external, v = state_.v;
  parallelFor(
      "coplane::dynamics::unbalancedForces", layout_.owned(),
      KOKKOS_LAMBDA(const int n) { set(damping, n, at(force, n) + at(external, n)); });
  model_.conditions.clearConstrained(projections_, damping);
  const auto followsBody = followsBody_;
  parallelFor(
      "coplane::dynamics::localDamping", layout_.owned(), KOKKOS_LAMBDA(const int n) {
        for (int c = 0; c < 3; ++c)
        {
          const Real size = followsBody(n) ? 0 : fraction * std::abs(damping(n, c));
          damping(n, c) = v(n, c) > 0 ? -size : v(n, c) < 0 ? size : 0;
        }
      });
}

void Solver::kick(Real step)
{
  TimedRegion region("coplane::dynamics::kick");
  const WorkWatch watch(work_.nodes);
  const int owned = layout_.owned();
  const Real dtKick = 0.5 * (clock_.step + step);
  const Conditions& conditions = model_.conditions;
  applyLocalDamping();

  // Mass damping takes v at n as the mean of both half steps, like dashpots do: second order, and
  // the stable step stays that of the undamped body.
  const Real alpha = conditions.massDampingAt(dampingTime());
  const Real half = 0.5 * dtKick * alpha;
  const NodeVectors v = state_.v, vPrevious = state_.vPrevious, external = state_.external,
                    damping = state_.damping;
  const ConstNodeVectors force = state_.force, localDamping = state_.localDamping, x = state_.x;
  const ConstArray<Real> mass = state_.mass;
  const bool locally = localDampingActs_;
  const auto given = [=](int n) // all forces at n that do not depend on v(n+1/2)
  {
    const Vec3 sum = at(force, n) + at(external, n);
    return locally ? sum + at(localDamping, n) : sum;
  };
  parallelFor(
      "coplane::dynamics::kickVelocities", owned, KOKKOS_LAMBDA(const int n) {
        const Vec3 total = given(n);
        const Vec3 old = at(v, n);
        set(vPrevious, n, old);
        if (mass(n) > 0)
          set(v, n, (1 / (1 + half)) * ((1 - half) * old + (dtKick / mass(n)) * total));
      });
  if (!dashpots_.empty())
  {
    dashpots_.find(model_.mesh.dimension, conditions, x);
    dashpots_.kick(dtKick, alpha, mass, given, vPrevious, v);
  }
  for (std::size_t i = 0; i < constrained_.size(); ++i)
    set(beforeConstraint_, int(i), at(v, constrained_[i]));
  conditions.prescribeVelocities(clock_.time + 0.5 * step, step, v, projections_);
  for (std::size_t i = 0; i < constrained_.size(); ++i)
  {
    // The force that this took, and what the dampings no longer give.
    const int n = constrained_[i];
    const Vec3 change = at(v, n) - at(beforeConstraint_, int(i));
    set(external, n,
        at(external, n) + (mass(n) / dtKick * (1 + half)) * change +
            0.5 * dashpots_.drag(n, change));
  }
  dashpots_.book(vPrevious, v, external);
  rigid_->kick(dtKick, step, clock_.time, alpha, conditions.localDampingAt(dampingTime()), state_);

  const auto impulse = state_.impulse, angularImpulse = state_.angularImpulse;
  const auto followsBody = followsBody_;
  const auto externalWork = state_.externalWork, dampingWork = state_.dampingWork,
             localDampingWork = state_.localDampingWork, totalWork = state_.totalWork;
  const Real before = 0.5 * clock_.step, after = 0.5 * step;
  if (alpha == 0 && massDampingActs_)
    Kokkos::deep_copy(damping, 0.0);
  massDampingActs_ = alpha > 0;
  const bool massive = massDampingActs_;
  const auto acts = [](const Vec3& f) { return f.x != 0 || f.y != 0 || f.z != 0; };
  // This pass is bound by memory: it leaves alone what does not change.
  parallelFor(
      "coplane::dynamics::bookForces", owned, KOKKOS_LAMBDA(const int n) {
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
          set(impulse, n, at(impulse, n) + dtKick * outer);
          set(angularImpulse, n, at(angularImpulse, n) + dtKick * cross(at(x, n), outer));
        }
        totalWork(n) += dot(at(force, n) + outer, path);
      });
  rigid_->bookSecondHalf(clock_.step);
}

namespace
{
/// Largest speed of two nodes relative to each other, from the extremes of velocity: three largest
/// and three negated least ones [m/s].
Real speedOf(const Real* extremes)
{
  const Vec3 range{extremes[0] + extremes[3], extremes[1] + extremes[4], extremes[2] + extremes[5]};
  return std::isfinite(dot(range, range)) ? norm(range) : 0;
}
} // namespace

void Solver::sumLoads()
{
  attempt(
      [&] {
        model_.conditions.applyLoads(model_.mesh.dimension, layout_.owned(), clock_.time, state_);
      });
  rigid_->sumForces(state_, contactStiffness_, [this](int n) { return leastElementStep(n); });
}

std::optional<Real> Solver::agreeOnNextStep(const Requests& mine)
{
  // One reduction decides everything that must not differ between ranks.
  std::vector<Real> extremes{-stableStep(), Real(mine.results), Real(mine.checkpoint),
                             Real(mine.stop), contact_ ? -contact_->thinnestElement() : -infinity};
  comm_->max(extremes);
  failed_ = !(extremes[0] < 0);
  requests_ = {extremes[1] > 0, extremes[2] > 0, extremes[3] > 0};
  if (failed_)
    return std::nullopt;
  const Real step = nextStep(-extremes[0], -extremes[4]);
  largestNextStep_ = model_.time.fixedStep ? step : StepGrowth::perCycle * step;
  if (step * mostCycles < model_.time.end)
    failOnAllRanks(
        ExitCode::Computation,
        "cycle {}, t = {:.6e} s: the time step is {:.3e} s, which would take more than "
        "{:.0e} cycles to time.end = {:.6g} s. Look at time.fixed_step, "
        "time.maximum_step, elements that are far too small or stiff, and velocities that "
        "are far too large.",
        clock_.cycle, clock_.time, step, mostCycles, model_.time.end);
  return step;
}

Real Solver::nextStep(Real stable, Real thinnest)
{
  Real step = std::min(model_.time.stepFactor * stable, motionStep(thinnest));
  if (model_.time.maximumStep)
    step = std::min(step, *model_.time.maximumStep);
  if (model_.time.fixedStep)
  {
    if (*model_.time.fixedStep > step)
      logWarning("fixed step above the stable step",
                 fmt::format("cycle {}: time.fixed_step = {:.4e} s is above the stable step with "
                             "its safety factor, {:.4e} s",
                             clock_.cycle, *model_.time.fixedStep, step));
    step = *model_.time.fixedStep;
  }
  if (!(step < infinity))
    step = stepOfFreeBodies();
  return model_.time.fixedStep ? step : growth_.next(step, clock_.nextStep);
}

void Solver::planSearch()
{
  // The next positions are known now: a search falls due when one may be needed by then, from an
  // exact bound on the relative displacement of any two nodes since the last search.
  const Real step = clock_.nextStep;
  std::vector<Real> range(13, -infinity); // max, -min per axis of way and velocity; trouble
  range[12] = trouble_ ? 1 : 0;
  for (int n = 0; n < layout_.owned() && contact_; ++n)
    for (int c = 0; c < 3 && !isFree(n); ++c)
    {
      const Real moved = state_.x(n, c) + step * state_.v(n, c) - state_.atSearch(n, c);
      range[c] = std::max(range[c], moved);
      range[3 + c] = std::max(range[3 + c], -moved);
      range[6 + c] = std::max(range[6 + c], state_.v(n, c));
      range[9 + c] = std::max(range[9 + c], -state_.v(n, c));
    }
  comm_->max(range);
  failed_ = range[12] > 0;
  if (failed_ || !contact_)
    return;
  relativeSpeed_ = speedOf(&range[6]);
  for (int axis = 0; axis < 3; ++axis)
    if (const Real moved = range[axis] + range[3 + axis];
        moved > -infinity && !(moved < mostSkins * contact_->skin()))
      failOnAllRanks(ExitCode::Computation,
                     "cycle {}, t = {:.6e} s: nodes move {:.3e} m against each other along {} in "
                     "one step of {:.3e} s; the skin of contact is {:.3e} m. Look for a velocity, "
                     "a load or a gravity that is far too large.",
                     clock_.cycle, clock_.time, moved, "xyz"[axis], step, contact_ -> skin());
  const bool forced = range[0] + range[3] > 0.5 * contact_->skin() ||
                      range[1] + range[4] > 0.5 * contact_->skin() ||
                      range[2] + range[5] > 0.5 * contact_->skin();
  const bool regular = model_.searchEvery > 0 && (clock_.cycle + 1) % model_.searchEvery == 0;
  searchIsDue_ = forced || regular;
}

Real Solver::relativeSpeed() const
{
  std::vector<Real> range(6, -infinity);
  for (int n = 0; n < layout_.owned(); ++n)
    for (int c = 0; c < 3 && !isFree(n); ++c)
    {
      range[c] = std::max(range[c], state_.v(n, c));
      range[3 + c] = std::max(range[3 + c], -state_.v(n, c));
    }
  comm_->max(range);
  return speedOf(range.data());
}

/// A bound of the first step, for what looks ahead before it is known [s]. Collective.
Real Solver::boundOfFirstStep()
{
  Real least = infinity;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (!isRigid(b))
    {
      blocks_[b].update(state_.x, state_.v, 0);
      least = std::min(least, blocks_[b].smallestStableStep());
    }
  const TimeOptions& time = model_.time;
  least = std::min(time.stepFactor * comm_->min(least),
                   motionStep(comm_->min(contact_->thinnestElement())));
  least = std::min(least, time.maximumStep.value_or(infinity));
  least = time.fixedStep.value_or(least);
  return least < infinity ? least : 0; // else nothing moves relative to anything
}

void Solver::prepare()
{
  attempt([&] { model_.conditions.prescribeVelocities(0, state_.v); });
  rigid_->start(state_);
  layout_.refresh(state_.x, state_.v);
  if (contact_)
  {
    relativeSpeed_ = relativeSpeed();
    largestNextStep_ = boundOfFirstStep();
    search();
    contact_->closeDeclaredJoints(state_.x, [this](int block, const Vec3& x)
                                  { return model_.blocks[block].stressAt(x); });
    // Once more, so that their neighbours know the offsets of joints that are closed now.
    if (std::any_of(model_.contactRules.table.begin(), model_.contactRules.table.end(),
                    [](const ContactRule& rule) { return rule.declared; }))
      search(true);
  }
  findForces(0);
  sumLoads();
  if (const auto step = agreeOnNextStep({})) // requests are for the first cycle
  {
    attempt([&] { kick(*step); });
    clock_.nextStep = *step;
    mirrorVelocities(); // energies at t = 0 are those of the given velocities
    planSearch();
  }
  if (failed_)
    failTogether("before the first cycle");
  initialEnergy_ = {};
  initialEnergy_ = energy();
  initialMomenta_ = momenta();
  // Momenta before any impulse: the first half kick has happened already.
  initialMomenta_.linear -= initialMomenta_.impulse;
  initialMomenta_.angular -= initialMomenta_.angularImpulse;
}

void Solver::advance()
{
  const Real dt = clock_.nextStep;
  drift(dt);
  {
    TimedRegion region("coplane::mesh::refreshCopies");
    layout_.refresh(state_.x, state_.v);
  }
  findForces(dt);
  ++clock_.cycle;
  clock_.time += dt;
  clock_.step = dt;
  ++work_.cycles;
  sumLoads();
  if (const auto step = agreeOnNextStep(takeRequests()))
  {
    attempt([&] { kick(*step); });
    clock_.nextStep = *step;
    relax(*step);
    planSearch();
  }
}

WorkTimes Solver::takeWorkTimes()
{
  WorkTimes work;
  work.elements.assign(blocks_.size(), 0);
  std::swap(work, work_);
  if (contact_)
    work.search = contact_->takeSearchSeconds();
  return work;
}

/// The end counts as reached when only the rounding of many summed steps is missing, as for
/// outputs.
bool Solver::isOver() const
{
  return clock_.time + 1e-10 * std::abs(clock_.time) >= model_.time.end;
}

/// When neither elements nor contact limit the step (rigid bodies in free flight): a thousandth of
/// the run, and no node may leave the skin of contact in one step. Collective.
Real Solver::stepOfFreeBodies() const
{
  constexpr Real ofTheRun = 1e-3;
  Real step = ofTheRun * model_.time.end;
  if (!contact_)
    return step;
  std::vector<Real> fastest{0, 0};
  for (int n = 0; n < layout_.owned(); ++n)
  {
    fastest[0] = std::max(fastest[0], norm(at(state_.v, n)));
    if (state_.mass(n) > 0)
      fastest[1] =
          std::max(fastest[1], norm(at(state_.force, n) + at(state_.external, n)) / state_.mass(n));
  }
  comm_->max(fastest);
  // v dt + a dt^2 is at most a quarter of the skin for each of two bodies.
  const Real room = 0.25 * contact_->skin();
  const Real root = std::sqrt(fastest[0] * fastest[0] + 4 * fastest[1] * room);
  return fastest[0] + root > 0 ? std::min(step, 2 * room / (fastest[0] + root)) : step;
}

ExitCode Solver::run(Observer& observer, Rebalancer* rebalancer)
{
  // Faster than waves, bodies may meet with more pressure than contact can give, and pass through
  // each other. The skin tells at no cost whether anything is fast at all.
  const auto cannotStop = [this]
  {
    if (!contact_ || 10 * relativeSpeed_ * clock_.nextStep < contact_->skin())
      return false;
    const StepControl control = stepControl();
    if (!(motionStep(control.thinnest) <
          fasterThanWaves * model_.time.stepFactor * control.stableStep))
      return false;
    const ContactCounts counts = contact_->counts();
    return counts.tooDeep > 0 || counts.missed > 0;
  };
  observer.start(*this);
  std::string ending = "completed";
  ExitCode code = ExitCode::Success;
  while (!isOver())
  {
    advance();
    if (failed_)
    {
      finishBeforeFailing(observer);
      failTogether("element");
    }
    if (cannotStop())
    {
      finishBeforeFailing(observer);
      failOnAllRanks(
          ExitCode::Computation,
          "cycle {}, t = {:.6e} s: bodies move at {:.4g} m/s relative to each other, faster than "
          "waves run in them, and faces lie deeper in them than contact.depth_max, or in each "
          "other before they were found: contact cannot stop them. Raise "
          "joints.<name>.stiffness_fraction, or use a material that stiffens under pressure. {}",
          clock_.cycle, clock_.time, relativeSpeed_, worstEntities());
    }
    if (clock_.cycle % energyCheckEvery == 0 || isOver())
    {
      const EnergyBalance balance = energy();
      const std::string broken = brokenBalance(balance);
      if (!broken.empty())
      {
        finishBeforeFailing(observer);
        failOnAllRanks(ExitCode::Computation, "{}", broken);
      }
      warnOfTrouble(balance);
    }
    try
    {
      observer.endOfCycle(*this);
    }
    catch (const Error& error)
    {
      if (error.onAllRanks())
        finishBeforeFailing(observer, error.what());
      throw;
    }
    if (requests_.stop)
    {
      ending = requests_.checkpoint ? "interrupted after a checkpoint" : "interrupted";
      code = requests_.checkpoint ? ExitCode::Resumable : ExitCode::Interrupted;
      break;
    }
    if (rebalancer && !isOver() && rebalancer->look(*this))
      observer.repartitioned(*this);
  }
  observer.finish(*this, ending);
  return code;
}

void Solver::finishBeforeFailing(Observer& observer, const std::string& why) const
{
  // Outputs that fail, too, are told of and do not hide why the run ends.
  try
  {
    observer.finish(*this, "failed");
  }
  catch (const Error& error)
  {
    if (!error.onAllRanks())
    {
      if (!why.empty())
        logError(why);
      throw;
    }
    if (error.what() != why)
      logError(error.what());
  }
}

void Solver::failTogether(const std::string& what)
{
  // Every rank names its first broken element; together() lets the lowest rank with one speak.
  comm_->together(
      [&]
      {
        if (trouble_)
          throw Error(*trouble_);
        for (std::size_t b = 0; b < blocks_.size(); ++b)
        {
          const int e = isRigid(b) ? -1 : blocks_[b].invertedElement();
          if (e >= 0)
            fail(ExitCode::Computation,
                 "cycle {}, t = {:.6e} s: element {} (block '{}') has turned inside out or has a "
                 "force that is not finite; its "
                 "volume is {:.3e} m^3. Refine the mesh there, lower time.step_factor, or raise "
                 "blocks.<name>.hourglass.stiffness.",
                 clock_.cycle, clock_.time, model_.mesh.blocks[b].elementIds[e],
                 model_.blocks[b].name, blocks_[b].volume()(e));
        }
      });
  failOnAllRanks(ExitCode::Computation,
                 "cycle {}, t = {:.6e} s: the stable step is not a number ({}). {}", clock_.cycle,
                 clock_.time, what, worstEntities());
}
} // namespace coplane
