#include <coplane_core/Log.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_core/WorkWatch.hpp>
#include <coplane_dynamics/ModelExtent.hpp>
#include <coplane_dynamics/Rebalancer.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_dynamics/detail/ContactFaces.hpp>
#include <coplane_mesh/Bodies.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
constexpr std::int64_t energyCheckEvery = 100; // cycles; what contact gains in every one
constexpr std::int64_t regroupEvery = 20;      ///< cycles; what is substepped
/// Step by the motion of faces over that by elements when faces are about as fast as waves.
constexpr Real fastBesideWaves = 0.35;
constexpr Real mostCycles = 1e15; // some centuries
/// Default skin over the smallest face [-]; the larger one where searches come by motion only.
constexpr Real skinOfFace = 0.1, skinOfFaceWithOneSearch = 0.5;
/// Faces that need more steps than this for a skin are not fast: a search covers the motion of
/// eight of them (SearchReach.hpp).
constexpr Real stepsThroughSkin = 10;

/// What conditions push faces with at t = 0.
/// @param faces sorted by id
void setPressures(const Conditions& conditions, std::vector<Face>& faces)
{
  for (const FacePressure& load : conditions.pressures)
    for (const LoadedSide& side : load.when.holds(0) ? load.sides : std::vector<LoadedSide>())
    {
      const auto face = std::lower_bound(faces.begin(), faces.end(), side.id,
                                         [](const Face& f, GlobalId id) { return f.id < id; });
      if (face != faces.end() && face->id == side.id)
        face->pressure += load.at(0, side.place);
    }
}

/// Of all ranks, which found it together.
Error computationFailed(const std::string& why)
{
  return {ExitCode::Computation, why, true};
}
} // namespace

Solver::Solver(Model model, const Comm& comm)
    : model_(std::move(model)), comm_(&comm), layout_(comm, model_.mesh), state_(model_.mesh),
      elements_(model_.mesh, model_.blocks, model_.viscosity, state_),
      step_(model_.time, std::max(model_.contact.dampNormal, model_.contact.dampShear)),
      subcycling_(model_.time), searches_(model_.searchEvery),
      relaxation_(model_.conditions.relaxation)
{
  state_.keepsRests = extentOf(mesh(), comm).isFarFromOrigin();
  attempt([&] { elements_.setInitialStress(model_); });
  attempt([&] { startVelocities(); });
  erosion_.emplace(model_, elements_);
  motion_.emplace(model_, elements_, state_, comm);
  lines_.emplace(model_.lines, mesh(), comm);
  takeWorkTimes();
  if (model_.contactEnabled)
    makeContact();
  if (!contact_ || !model_.debris)
    return;
  debris_.emplace(comm, model_.axisymmetric());
  for (const Mirrors::Lack& lack : mirrors_.lacks)
    if (erosion_->acts())
      logWarning(
          "debris beyond a symmetry",
          fmt::format("{}: points of debris that cross this plane of symmetry fly on where "
                      "nothing is, as it {}. In a whole model they would meet its other half.",
                      lack.where, lack.why));
}

/// Where blocks share nodes, the last one's velocity counts.
void Solver::startVelocities()
{
  const auto& absent = model_.absentBlocks;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b)
    for (const int node : std::count(absent.begin(), absent.end(), int(b)) > 0
                              ? std::vector<int>()
                              : mesh().blocks[b].connectivity)
      set(state_.v, node, model_.blocks[b].velocityAt(at(state_.x, node)));
}

void Solver::makeContact()
{
  bodyOfNode_ = bodyLabels(mesh(), std::vector<char>(mesh().blocks.size(), 1), *comm_);
  mirrors_ = mirrorsOf(model_.conditions, motion_->bodies(), mesh(), layout_);
  model_.contactRules.mirrors = mirrors_.all;
  std::vector<Face> faces = facesAtStart(exteriorFaces(mesh()));
  const Real smallest = Contact::smallestFaceSize(faces, state_.x, mesh().dimension, *comm_);
  const Real skin = model_.skin.value_or(
      (model_.searchEvery == 0 ? skinOfFaceWithOneSearch : skinOfFace) * smallest);
  contact_ = std::make_unique<Contact>(*comm_, mesh().dimension, std::move(faces), model_.contact,
                                       model_.contactRules, skin, smallest);
}

void Solver::replaceFaces(std::vector<Face> faces)
{
  contact_->replaceLocalFaces(std::move(faces));
  motionLimits_.reset();
}

const MotionLimits& Solver::motionLimits() const
{
  if (motionLimits_)
    return *motionLimits_;
  MotionLimits& limits = motionLimits_.emplace();
  if (!contact_)
    return limits;
  const RigidBodies& bodies = motion_->bodies();
  for (const Face& face : contact_->localFaces())
  {
    limits.thinnest = std::min(limits.thinnest, face.thickness);
    const int* const end = face.nodes + face.count;
    const int* const owned =
        std::find_if(face.nodes, end, [&](int node) { return node < layout_.owned(); });
    if (!face.rigid || owned == end)
      continue;
    const int body = bodies.bodyOf(*owned);
    const Real length = mesh().dimension == 2 ? 1 : 2 * bodies.reach(body);
    limits.massOverStiffness =
        std::min(limits.massOverStiffness,
                 bodies.massThatYields(body) / (contact_->stiffestOn(face) * length));
  }
  return limits;
}

std::vector<Face> Solver::facesAtStart(const std::vector<ExteriorFace>& exterior)
{
  std::vector<Face> faces = facesOf(exterior);
  attempt([&] { setPressures(model_.conditions, faces); });
  return faces;
}

std::vector<Face> Solver::facesOf(const std::vector<ExteriorFace>& exterior,
                                  const std::vector<Face>* known) const
{
  std::vector<Face> faces =
      contactFaces(mesh(), blocks(), model_.faceGroups, bodyOfNode_, exterior, state_.x, known);
  for (Face& face : faces)
  {
    face.rigid = model_.blocks[std::size_t(face.block)].rigid;
    for (int k = 0; k < face.count; ++k)
      face.mirrors[k] = std::uint8_t(mirrors_.ofNode[std::size_t(face.nodes[k])]);
  }
  markThinFaces(faces, layout_);
  return faces;
}

void Solver::prepare()
{
  attempt([&] { model_.conditions.prescribeVelocities(0, state_.v); });
  motion_->start(state_);
  refresh();
  leaveAbsentBlocks();
  if (step_.scaling().acts())
  {
    findElementForces();
    raiseMasses(true);
  }
  if (contact_)
    openContact();
  findForces(0);
  sumLoads();
  raiseMasses(true);
  if (const auto step = agreeOnNextStep({})) // requests are for the first cycle
  {
    kick(*step);
    motion_->mirrorVelocities(state_); // energies at t = 0 are those of the given velocities
    planSearch();
  }
  if (failed_)
    failTogether("before the first cycle");
  ledger_.open(parts(), relaxation_.state());
  watch_.open(ledger_.initialEnergy(), parts());
}

void Solver::advance()
{
  const Real dt = clock_.nextStep;
  const auto applyLoads = [this](Real time, Real over)
  { attempt([&] { motion_->applyLoads(model_.conditions, time, over, state_); }); };
  subcycling_.begin({dt, searches_.timeSince(clock_.time), lookAhead()}, applyLoads, parts(),
                    state_, elements_, contact_.get(), work_);
  if (subcycling_.substeps() > 1)
    planSearch(true); // only now it is known where substepped nodes will be
  drift(dt);
  refresh();
  findForces(dt);
  ++clock_.cycle;
  clock_.time += dt;
  clock_.step = dt;
  ++work_.cycles;
  sumLoads();
  raiseMasses(false);
  if (const auto step = agreeOnNextStep(takeRequests()))
  {
    kick(*step);
    relax(*step);
    planSearch();
  }
}

void Solver::drift(Real dt)
{
  const WorkWatch watch(work_.nodes);
  motion_->drift(dt, state_);
}

void Solver::refresh()
{
  TimedRegion region("coplane::mesh::refreshCopies");
  layout_.refresh(state_.x, state_.v);
}

void Solver::findForces(Real dt)
{
  elements_.update(state_, layout_, dt, work_);
  subcycling_.endElements(dt, layout_, state_, elements_, work_);
  const std::vector<int> coming = coming_.blocks;
  const bool someDied = dt > 0 && erode(dt);
  elements_.addNodalTensions(state_, layout_, work_);
  if (contact_ && !coming.empty() && declaresJoints())
    joinAdded(coming, clock_.time + dt);
  else if (contact_ && (searches_.isDue() || someDied))
    search(clock_.time + dt);
  else if (contact_ && model_.contact.inherit && searches_.isPassingDue())
    passOn();
  if (someDied && !contact_)
    subcycling_.relist(parts(), nullptr);
  if (contact_)
    updatePlanes(dt);
  {
    const WorkWatch watch(work_.nodes);
    elements_.gather(state_.force);
  }
  if (contact_)
    addContactForces();
  lines_->addForces(elements_, state_, clock_.time + dt, dt, stage_.index, !contact_);
  if (debris_)
    debris_->addForces(mesh(), elements_, state_, dt);
}

/// Forces and stable steps that belong to the present stress. That is no work of a cycle.
void Solver::findElementForces()
{
  WorkTimes notBooked;
  notBooked.elements.assign(blocks().size(), 0);
  elements_.update(state_, layout_, 0, notBooked);
  elements_.addNodalTensions(state_, layout_, notBooked);
}

bool Solver::erode(Real dt)
{
  const std::vector<int> leaving = std::exchange(leaving_, {});
  const ComingBlocks coming = std::exchange(coming_, {});
  const bool facesChange = comeIn(coming, clock_.time + dt);
  const std::vector<GlobalId> dead =
      erosion_->erode(mesh(), elements_, {state_.v, dt}, state_.substeps, subcycling_.lastStep(dt),
                      leaving, *comm_);
  if (dead.empty() && !facesChange)
    return false;
  if (contact_)
    contact_->endPlanesOf(dead, facesChange ? facesThatGo() : std::vector<GlobalId>(), state_.x,
                          state_.v, dt, subcycling_.lastStep(dt));
  leaveWithoutElements(dead, contact_ ? &contact_->localFaces() : nullptr);
  takeMassAlong(leaving); // planes have ended with the velocities that there were
  if (facesChange)
    watch_.acceptOverlapsOf(coming.blocks);
  renewDebris();
  return true;
}

/// Which nodes have mass and no element, and which faces may stop them.
void Solver::renewDebris()
{
  if (!debris_ || !erosion_->acts())
    return;
  std::vector<Debris::FreeNode> points;
  std::vector<int> nodes;
  for (int n = 0; n < layout_.owned(); ++n)
    if (erosion_->isFree(n) && state_.mass(n) > 0 && !motion_->followsBody(n))
    {
      points.push_back(
          {layout_.ids()[std::size_t(n)], state_.mass(n), shareOf(mirrors_.holding(n))});
      nodes.push_back(n);
    }
  motion_->letThroughAxis(nodes);
  debris_->renew(points, erosion_->exterior(), mirrors_, bodyOfNode_, mesh(), elements_, layout_);
}

/// Ends the loads on elements that have died, and lays bare the faces behind them.
void Solver::leaveWithoutElements(const std::vector<GlobalId>& dead, const std::vector<Face>* known)
{
  model_.conditions.endLoadsOn(dead);
  if (contact_)
    replaceFaces(facesOf(erosion_->exterior(), known));
}

void Solver::takeGhostNodes(const std::vector<GlobalId>& ghostNodes)
{
  if (!layout_.setGhostNodes(ghostNodes))
    return;
  state_.resize(layout_);
  layout_.refresh(state_.x, state_.v);
}

NodeVectors Solver::ownedOf(const NodeVectors& all) const
{
  return Kokkos::subview(all, std::make_pair(0, layout_.owned()), Kokkos::ALL());
}

void Solver::search(Real time, bool again)
{
  TimedRegion region("coplane::dynamics::search");
  const Real step = step_.largestNext();
  const Real ahead = contact_->coverMotion(searches_.relativeSpeed() * step, step);
  searches_.booked(contact_->skin(), time, ahead, contact_->foresees());
  takeGhostNodes(contact_->findGhosts(state_.x, layout_.ids(), state_.v, ahead));
  contact_->pairUp(state_.x, layout_, again, state_.v);
  Kokkos::deep_copy(state_.atSearch, ownedOf(state_.x));
  Kokkos::deep_copy(state_.velocityAtSearch, ownedOf(state_.v));
  Kokkos::deep_copy(state_.atPassing, state_.atSearch);
  subcycling_.relist(parts(), contact_.get());
}

void Solver::passOn()
{
  TimedRegion region("coplane::dynamics::search");
  contact_->passOnAnew(state_.x, layout_);
  searches_.passedOn();
  Kokkos::deep_copy(state_.atPassing, ownedOf(state_.x));
}

bool Solver::declaresJoints() const
{
  const auto& rules = model_.contactRules.table;
  return std::any_of(rules.begin(), rules.end(),
                     [](const ContactRule& rule) { return rule.declared; });
}

/// A search after which the declared joints of blocks that have come in are closed.
void Solver::joinAdded(const std::vector<int>& blocks, Real time)
{
  contact_->seekDeclaredJoints(true);
  search(time);
  contact_->seekDeclaredJoints(false);
  contact_->closeJointsOfAdded(state_.x, blocks);
  search(time, true);
}

/// First search, and declared joints closed.
void Solver::openContact()
{
  searches_.start(parts());
  findElementForces();
  const MotionLimits& limits = motionLimits();
  step_.boundFirst(comm_->min(elements_.smallestStep()),
                   {comm_->min(limits.thinnest), comm_->min(limits.massOverStiffness)},
                   searches_.relativeSpeed());
  const bool declares = declaresJoints();
  contact_->seekDeclaredJoints(declares);
  search(0);
  contact_->seekDeclaredJoints(false);
  const Contact::Overpressed pressed = contact_->closeDeclaredJoints(
      state_.x, [this](int block, const Vec3& x) { return model_.blocks[block].stressAt(x); });
  if (pressed.planes > 0)
  {
    const JointRecipe& joint = model_.contactRules.joints[std::size_t(pressed.joint)];
    const Vec3& place = pressed.pointOfContact;
    logWarning(
        "joints crushed by the initial stress",
        fmt::format("{} planes of declared joints are under more initial compression than "
                    "their joint bears: most at ({:.6g}, {:.6g}, {:.6g}) m, {:.4g} Pa where "
                    "joints.{} has compressive_strength = {:.4g} Pa. They begin at their "
                    "strength, crushed to the peak and out of equilibrium. Lower the initial "
                    "stress, raise compressive_strength, or load the model in time.",
                    pressed.planes, place.x, place.y, place.z, pressed.compression, joint.name,
                    joint.law.curve.crushing.strength));
  }
  // Once more, so that their neighbours know the offsets of joints that are closed now.
  if (declares)
    search(0, true);
}

void Solver::updatePlanes(Real dt)
{
  const WorkWatch watch(work_.planes);
  contact_->step6_updateCommonPlanes(state_.x, state_.v, dt, lookAhead(),
                                     searches_.timeSince(clock_.time + dt),
                                     subcycling_.lastStep(dt));
}

void Solver::addContactForces()
{
  TimedRegion region("coplane::contact::addForces");
  const WorkWatch watch(work_.planes);
  Kokkos::deep_copy(state_.contactForce, 0.0);
  contact_->addForces(state_.contactForce, state_.contactStiffness);
  const auto force = state_.force;
  const auto contactForce = state_.contactForce;
  parallelFor(
      "coplane::dynamics::addContactForces", layout_.owned(),
      KOKKOS_LAMBDA(const int n) { set(force, n, at(force, n) + at(contactForce, n)); });
}

void Solver::sumLoads()
{
  attempt([&] { motion_->applyLoads(model_.conditions, clock_.time, clock_.nextStep, state_); });
  motion_->sumForcesOnBodies(state_, elements_);
}

void Solver::raiseMasses(bool atStart)
{
  if (step_.scaling().acts() && step_.scaling().raise(parts(), state_, atStart))
    massesRaised_ = true;
}

/// Some rank has raised masses: whether they are too large now.
void Solver::agreeOnMasses()
{
  massesRaised_ = false;
  const std::string beyond = step_.scaling().beyondLimit(parts());
  if (beyond.empty())
    return;
  failed_ = true;
  trouble_ = Error(ExitCode::Computation, beyond);
}

std::optional<Real> Solver::agreeOnNextStep(const Requests& mine)
{
  // One reduction decides everything that must not differ between ranks.
  const MotionLimits& limits = motionLimits();
  std::vector<Real> extremes{-step_.stable(parts()), Real(mine.results),
                             Real(mine.checkpoint),  Real(mine.stop),
                             -limits.thinnest,       -limits.massOverStiffness,
                             Real(massesRaised_),    Real(watch_.mayHaveGained(parts()))};
  comm_->max(extremes);
  failed_ = !(extremes[0] < 0);
  requests_ = {extremes[1] > 0, extremes[2] > 0, extremes[3] > 0};
  contactMayHaveGained_ = extremes[7] > 0;
  if (extremes[6] > 0 && !failed_)
    agreeOnMasses();
  if (failed_)
    return std::nullopt;
  const Real step = chooseStep(-extremes[0], {-extremes[4], -extremes[5]});
  if (step * mostCycles < model_.time.end)
  {
    failed_ = true;
    trouble_ = Error(
        ExitCode::Computation,
        fmt::format("cycle {}, t = {:.6e} s: the time step is {:.3e} s, which would take more than "
                    "{:.0e} cycles to time.end = {:.6g} s. Look at time.fixed_step, "
                    "time.maximum_step, elements that are far too small or stiff, and velocities "
                    "that are far too large.",
                    clock_.cycle, clock_.time, step, mostCycles, model_.time.end));
    return std::nullopt;
  }
  return step;
}

/// @param stable with what is substepped now, limits: of all ranks
Real Solver::chooseStep(Real stable, const MotionLimits& limits)
{
  if (!subcycling_.acts())
    return step_.choose(stable, limits, searches_.relativeSpeed(), parts());
  const Real factor = model_.time.stepFactor;
  bool regroup = clock_.cycle % regroupEvery == 0 || factor * stable < clock_.nextStep;
  const Real safe =
      regroup ? subcycling_.plan(parts(), step_) : std::max(stable, subcycling_.planned());
  Real step = step_.choose(safe, limits, searches_.relativeSpeed(), parts());
  if (!regroup && step > factor * stable)
  {
    step = std::min(step, factor * subcycling_.plan(parts(), step_));
    regroup = true;
  }
  if (regroup)
    subcycling_.regroup(step, parts(), state_, contact_.get());
  return step;
}

void Solver::kick(Real step)
{
  const WorkWatch watch(work_.nodes);
  subcycling_.endMotion(state_);
  if (subcycling_.acts())
    subcycling_.weigh(clock_.step, step, state_, contact_.get());
  attempt(
      [&]
      {
        motion_->startFreeFields(kickTimes(step), model_.conditions, mesh(), state_, elements_,
                                 *comm_); // throws on all ranks or on none
        motion_->kick(kickTimes(step), model_.conditions, state_);
      });
  bookFromOutside(NodalMotion::kickOf(kickTimes(step)));
  clock_.nextStep = step;
  if (subcycling_.acts())
    subcycling_.endKick(parts(), state_);
}

/// What bodies get from their images beyond planes of symmetry during a kick [s].
void Solver::bookFromOutside(Real dt)
{
  lines_->bookOuterMoments(state_, dt);
  if (debris_)
    debris_->bookImages(state_, dt);
}

void Solver::relax(Real step)
{
  const Relaxation::Verdict verdict = relaxation_.look(parts(), stage_.index);
  if (verdict.stop)
  {
    const Real lost = motion_->stop(kickTimes(step), model_.conditions, state_, *comm_);
    bookFromOutside(0.5 * step); // of the start that follows
    relaxation_.bookStop(lost, motion_->kineticAtHalfStep(state_, *comm_));
  }
  if (verdict.rest)
    relaxation_.end(parts());
}

void Solver::planSearch(bool again)
{
  failed_ = searches_.look(parts(), trouble_.has_value(), again);
}

WorkTimes Solver::takeWorkTimes()
{
  WorkTimes work;
  work.elements.assign(blocks().size(), 0);
  std::swap(work, work_);
  if (contact_)
    work.search = contact_->takeSearchSeconds();
  return work;
}

/// The end counts as reached when only the rounding of many summed steps is missing, as for
/// outputs.
bool Solver::isOver() const
{
  if (model_.time.endAtRest && relaxation_.state().ended)
    return true;
  return clock_.time + 1e-10 * std::abs(clock_.time) >= model_.time.end;
}

/// Whether there is another stage, which has begun then.
bool Solver::goOn(Observer& observer, const NextStage& nextStage)
{
  if (!nextStage)
    return false;
  try
  {
    std::optional<Stage> next = nextStage(*this);
    if (!next)
      return false;
    observer.endOfStage(*this);
    beginStage(std::move(*next));
    return true;
  }
  catch (const Error& error)
  {
    if (error.onAllRanks())
      failAfter(observer, error);
    throw;
  }
}

ExitCode Solver::run(Observer& observer, Rebalancer* rebalancer, const NextStage& nextStage)
{
  observer.start(*this);
  Ending ending;
  while (true)
  {
    const bool begins = isOver();
    if (begins && !goOn(observer, nextStage))
      break;
    advance();
    judge(observer);
    try
    {
      if (begins)
        observer.repartitioned(*this); // the masses and places of blocks that came in are known now
      observer.endOfCycle(*this);
    }
    catch (const Error& error)
    {
      if (error.onAllRanks())
        failAfter(observer, error);
      throw;
    }
    if (requests_.stop)
    {
      ending = requests_.checkpoint ? Ending{"interrupted after a checkpoint", ExitCode::Resumable}
                                    : Ending{"interrupted", ExitCode::Interrupted};
      break;
    }
    if (rebalancer && !isOver() && rebalancer->look(*this))
      observer.repartitioned(*this);
  }
  observer.finish(*this, ending);
  return ending.code;
}

void Solver::judge(Observer& observer)
{
  if (failed_)
    try
    {
      failTogether("element");
    }
    catch (const Error& error)
    {
      if (error.onAllRanks())
        failAfter(observer, error);
      throw;
    }
  if (contactCannotStop())
    failAfter(
        observer,
        computationFailed(fmt::format(
            "cycle {}, t = {:.6e} s: nodes move at up to {:.4g} m/s relative to each other, "
            "by {:.2g} of the thinnest element behind a face in a stable step, and faces lie "
            "deeper in bodies than contact.depth_max, or in each other before they were "
            "found: they are too fast for the waves that had to stop them, and contact "
            "cannot. Raise joints.<name>.stiffness_fraction, lower time.step_factor, or use a "
            "material that stiffens under pressure. {}",
            clock_.cycle, clock_.time, searches_.relativeSpeed(),
            step_.motionInStableStep(searches_.relativeSpeed(), stableStepOfWaves()),
            worstEntities())));
  const bool due = clock_.cycle % energyCheckEvery == 0 || isOver();
  if (!due && !contactMayHaveGained_)
    return;
  if (contact_ && due)
    if (const std::string through = watch_.goesThrough(parts(), stableStepOfWaves());
        !through.empty())
      failAfter(observer, computationFailed(through));
  const EnergyBalance balance = energy();
  const bool gained = contact_ && watch_.hasGained(balance, parts());
  if (!due && !gained)
    return;
  const std::string broken = watch_.broken(balance, parts());
  if (!broken.empty())
    failAfter(observer, computationFailed(broken));
  watch_.warn(balance, parts());
}

/// Bodies that come at a good part of the wave speed may meet with more pressure than contact can
/// give, and pass through each other. The skin tells at no cost whether anything is fast at all.
bool Solver::contactCannotStop() const
{
  if (!contact_ ||
      stepsThroughSkin * searches_.relativeSpeed() * clock_.nextStep < contact_->skin())
    return false;
  if (!step_.motionIsFasterThan(fastBesideWaves, searches_.relativeSpeed(), stableStepOfWaves()))
    return false;
  const ContactCounts counts = contact_->counts();
  return counts.tooDeep > 0 || counts.missed > 0;
}

void Solver::failAfter(Observer& observer, const Error& why)
{
  // Outputs that fail, too, are told of and do not hide why the run ends.
  try
  {
    observer.finish(*this, {"failed", why.code(), why.what()});
  }
  catch (const Error& error)
  {
    if (!error.onAllRanks())
    {
      logError(why.what());
      throw;
    }
    if (error.what() != std::string(why.what()))
      logError(error.what());
  }
  throw why;
}

void Solver::failTogether(const std::string& what)
{
  // Every rank names its first broken element; together() lets the lowest rank with one speak.
  comm_->together(
      [&]
      {
        if (trouble_)
          throw Error(*trouble_);
        elements_.throwIfInverted(model_, clock_);
      });
  failOnAllRanks(ExitCode::Computation,
                 "cycle {}, t = {:.6e} s: the stable step is not a number ({}). {}", clock_.cycle,
                 clock_.time, what, worstEntities());
}
} // namespace coplane
