#pragma once

#include <coplane_contact/Contact.hpp>
#include <coplane_core/Comm.hpp>
#include <coplane_core/Error.hpp>
#include <coplane_dynamics/BalanceWatch.hpp>
#include <coplane_dynamics/Debris.hpp>
#include <coplane_dynamics/ElementForces.hpp>
#include <coplane_dynamics/Erosion.hpp>
#include <coplane_dynamics/Ledger.hpp>
#include <coplane_dynamics/Lines.hpp>
#include <coplane_dynamics/MassScaling.hpp>
#include <coplane_dynamics/Model.hpp>
#include <coplane_dynamics/NodalMotion.hpp>
#include <coplane_dynamics/NodalState.hpp>
#include <coplane_dynamics/Observer.hpp>
#include <coplane_dynamics/Parts.hpp>
#include <coplane_dynamics/Relaxation.hpp>
#include <coplane_dynamics/SearchPlan.hpp>
#include <coplane_dynamics/Signals.hpp>
#include <coplane_dynamics/Stage.hpp>
#include <coplane_dynamics/Subcycling.hpp>
#include <coplane_dynamics/TimeStep.hpp>
#include <coplane_dynamics/WorkTimes.hpp>
#include <coplane_dynamics/WorstEntities.hpp>
#include <coplane_mesh/NodeLayout.hpp>

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace coplane
{
/// Where a run is in its stages.
struct StageState
{
  int index = 0;  ///< the first is 0
  Real begin = 0; ///< of the present one [s]
};

/// How often and how a run has taken another partition.
struct Repartitions
{
  std::int64_t count = 0;
  std::int64_t nodesMoved = 0; ///< that changed their rank, each time counted
  double seconds = 0;          ///< that all this took
};

class Rebalancer;

/// The equations of motion in time: central differences (kick and drift) with lumped mass.
///
/// A cycle takes positions from n to n + 1 with the velocities at n + 1/2, finds the forces there,
/// and ends with the kick to n + 3/2. So at its end the state holds x(n), v(n-1/2) and v(n+1/2),
/// from which energies and momenta at n follow exactly.
class Solver
{
public:
  Solver(Model model, const Comm& comm);

  /// First search, census, joints closed, forces at t = 0, first kick. Collective.
  void prepare();
  /// Everything that the rest of the run depends on. Call between cycles. Collective.
  void save(StateTables& out) const;
  /// Instead of prepare(): goes on from there, with the same bits, on any ranks. Collective.
  void restore(const StateSource& in);
  /// Goes on with another part of the mesh on this rank, with the same bits: `model` is that of the
  /// same run. Call between cycles. What is known of the parts of ranks (local numbers) is void
  /// afterwards. For a moment the state is there twice. Collective.
  void repartition(Model model);
  /// Goes on with another stage; call between cycles. Blocks come and leave in the next cycle:
  /// those that come are free of stress at its end, with their nodes where these are then; those
  /// that leave do so as elements that erode, but with their mass. Collective.
  void beginStage(Stage stage);
  /// What of a stage the mesh and the laws show to be impossible, now or before; throws on all
  /// ranks. Collective.
  void demandPossible(const Stage& stage) const;
  /// Cycles until the end time, a stop request or a failure. Returns how it ended; throws
  /// Error(ExitCode::Computation) on failure after the observers have finished. A rebalancer may
  /// change the partition at the end of cycles. Collective.
  ExitCode run(Observer& observer, Rebalancer* rebalancer = nullptr,
               const NextStage& nextStage = {});
  /// One cycle. Public for tests and benchmarks. Collective.
  void advance();

  const Comm& comm() const { return *comm_; }
  const Model& model() const { return model_; }
  const RankMesh& mesh() const { return model_.mesh; }
  const NodeLayout& layout() const { return layout_; }
  const NodalState& state() const { return state_; }
  /// Place from which the strain of an element block of the mesh counts at a node of it: that from
  /// which displacements do, or where the block came in if that was later [m].
  Vec3 strainReference(int block, int node) const;
  /// In the order of the mesh file.
  const std::vector<ElementBlock>& blocks() const { return elements_.blocks(); }
  bool hasContact() const { return contact_ != nullptr; }
  const Contact& contact() const { return *contact_; }
  /// In which bodies are cut; none without contact.
  const Mirrors& mirrors() const { return mirrors_; }
  const Clock& clock() const { return clock_; }
  const RigidBodies& rigidBodies() const { return motion_->bodies(); }
  const Lines& lines() const { return *lines_; }
  /// Mass points that erosion has left, where faces stop them; nullptr: they do not.
  const Debris* debris() const { return debris_ ? &*debris_ : nullptr; }
  /// Of conditions on the motion of an owned node, at the end of the cycle [N].
  Vec3 reaction(int node) const { return motion_->reaction(node) + subcycling_.reaction(node); }
  /// Several steps in a cycle where only small ones are stable.
  const Subcycling& subcycling() const { return subcycling_; }
  /// Over all ranks. Collective.
  std::int64_t substeppedElements() const { return comm_->sum(subcycling_.elementsHere(parts())); }
  const RelaxationState& relaxation() const { return relaxation_.state(); }
  RestRatios restRatios() const { return coplane::restRatios(parts()); } ///< Collective.
  const StageState& stage() const { return stage_; }
  /// The same of a state that was saved; the first stage where it is older than stages. Collective.
  static StageState stageIn(const StateSource& in);
  std::int64_t searches() const { return contact_ ? contact_->searches() : 0; }
  // By signals or by an observer (Signals.hpp), decided together for the cycle that has ended.
  bool resultsRequested() const { return requests_.results; }
  bool checkpointRequested() const { return requests_.checkpoint; }
  bool stopRequested() const { return requests_.stop; }
  bool isOver() const; ///< the end time is reached

  // Over all ranks, the same bits on all. Collective.
  EnergyBalance energy() const { return ledger_.energy(parts(), relaxation_.state()); }
  /// Before the first cycle.
  const EnergyBalance& initialEnergy() const { return ledger_.initialEnergy(); }
  ErosionTotals erosion() const { return erosion_->totals(*comm_); }
  Momenta momenta() const { return ledger_.momenta(parts()); }
  bool scalesMass() const { return step_.scaling().acts(); }
  std::vector<AddedMass> addedMasses() const { return MassScaling::byBlock(parts()); } ///< by block
  StepControl stepControl() const
  {
    return step_.control(parts(), motionLimits(), searches_.relativeSpeed());
  }
  /// Positions, velocities, element and plane state, clock; independent of ranks, threads and back
  /// end.
  std::uint64_t stateHash() const;
  /// Text that names the planes with the largest unexplained work, the deepest planes, and the
  /// elements whose volume has changed most.
  std::string worstEntities() const { return coplane::worstEntities(parts()); }

  const Repartitions& repartitions() const { return repartitions_; }
  /// What the last change of the partition took [s], and how many nodes went to another rank.
  void bookRepartition(double seconds, std::int64_t nodesMoved)
  {
    repartitions_.seconds += seconds;
    repartitions_.nodesMoved += nodesMoved;
  }
  /// What this rank has worked since the last call, or since the last change of the partition.
  WorkTimes takeWorkTimes();

  /// Energy of a block's elements on this rank that have died [J].
  const ExactSum& erodedEnergy(int block) const { return erosion_->energies()[block]; }

private:
  Parts parts() const
  {
    return {*comm_,    model_,   layout_,        state_,  elements_,
            *erosion_, *motion_, contact_.get(), *lines_, debris_ ? &*debris_ : nullptr,
            clock_};
  }
  void startVelocities();
  void makeContact();
  std::vector<Face> facesAtStart(const std::vector<ExteriorFace>& exterior);
  std::vector<Face> facesOf(const std::vector<ExteriorFace>& exterior,
                            const std::vector<Face>* known = nullptr) const;
  // Of a cycle, in this order; all but the first are collective.
  void drift(Real dt);
  void refresh();
  void findForces(Real dt);
  void sumLoads();
  /// For the forces that there are now; agreeOnNextStep() tells other ranks.
  void raiseMasses(bool atStart);
  /// The step of the next cycle, the same on all ranks, and their requests; nothing when an element
  /// or a force has failed, or the step is far too small. Collective.
  std::optional<Real> agreeOnNextStep(const Requests& mine);
  void agreeOnMasses();                                     ///< collective
  Real chooseStep(Real stable, const MotionLimits& limits); ///< collective
  void kick(Real step);
  void relax(Real step);
  void planSearch(bool again = false); ///< for the same cycle
  // Of findForces. Collective.
  bool erode(Real dt); ///< whether elements have died on some rank, or faces are others
  void search(Real time, bool again = false);
  void passOn(); ///< between searches
  /// Of the faces of this rank, which they are found from when they are asked for first.
  const MotionLimits& motionLimits() const;
  void replaceFaces(std::vector<Face> faces); ///< of this rank, for contact
  /// The rows of owned nodes.
  NodeVectors ownedOf(const NodeVectors& all) const;
  void updatePlanes(Real dt);
  /// Of contact: the speed of approach may grow by the kick that lies between, so twice the step.
  Real lookAhead() const { return 2 * step_.largestNext(); }
  void addContactForces();

  // Collective.
  void leaveWithoutElements(const std::vector<GlobalId>& dead, const std::vector<Face>* known);
  void renewDebris();
  void bookFromOutside(Real dt);
  void takeGhostNodes(const std::vector<GlobalId>& ghostNodes);
  void openContact();
  bool declaresJoints() const;
  void joinAdded(const std::vector<int>& blocks, Real time);

  void findElementForces();
  /// Blocks, and conditions that still have the loads on their faces.
  struct ComingBlocks
  {
    std::vector<int> blocks;
    Conditions conditions;
  };
  // Of stages. Collective.
  void rebuild(Model model);
  bool goOn(Observer& observer, const NextStage& nextStage);
  void demandNoRigidNodes(const std::vector<int>& blocks) const;
  void demandThere(const std::vector<int>& blocks, bool there, int stage) const;
  bool comeIn(const ComingBlocks& coming, Real time);
  void leaveAbsentBlocks();
  void takeMassAlong(const std::vector<int>& blocks);
  std::vector<GlobalId> facesThatGo() const;
  void saveStage(StateTables& out) const;
  void restoreStage(const StateSource& in);
  NodalMotion::Times kickTimes(Real step) const
  {
    return {clock_.time, clock_.step, step, relaxation_.dampingTime(clock_)};
  }
  /// Of the smallest elements, whatever the cycle [s].
  Real stableStepOfWaves() const
  {
    return subcycling_.acts() ? subcycling_.leastStep() : step_.chosenFrom();
  }
  /// Whether bodies are fast beside the waves in them and contact has lost hold. Collective.
  bool contactCannotStop() const;
  /// Fails, after the observers have finished, when the run cannot go on. Collective.
  void judge(Observer& observer);
  /// @param why an error of all ranks
  [[noreturn]] void failAfter(Observer& observer, const Error& why);
  [[noreturn]] void failTogether(const std::string& what); ///< collective
  void saveNodes(StateTables& out) const;
  void restoreNodes(const StateSource& in);
  void restoreNumbers(const StateSource& in);
  template <class Self, class F>
  static void forEachNumber(Self& self, F&& number);
  /// What only some ranks may find to be wrong with the deck, such as a function without a value
  /// at one of their nodes: all hear of it in planSearch(), and the run ends with one message.
  template <class F>
  void attempt(const F& action)
  {
    try
    {
      action();
    }
    catch (const Error& error)
    {
      if (!trouble_)
        trouble_ = error;
    }
  }

  Model model_;
  const Comm* comm_;
  NodeLayout layout_;
  NodalState state_;
  ElementForces elements_;
  std::optional<Erosion> erosion_; // there from the constructor on, as is
  std::optional<NodalMotion> motion_;
  std::optional<Lines> lines_;
  std::unique_ptr<Contact> contact_;
  mutable std::optional<MotionLimits> motionLimits_; ///< of its faces; empty: not asked for yet
  Mirrors mirrors_;                                  ///< with contact only
  std::optional<Debris> debris_;                     ///< with contact only
  std::vector<int> bodyOfNode_; ///< number of the body, the same on all ranks; contact only
  Clock clock_;
  TimeStep step_;
  Subcycling subcycling_;
  SearchPlan searches_;
  Relaxation relaxation_;
  Ledger ledger_;
  BalanceWatch watch_;
  bool massesRaised_ = false;         ///< on this rank, since ranks agreed on a step
  bool contactMayHaveGained_ = false; ///< in this cycle, on some rank: the same on all
  bool failed_ = false;               ///< the same on all ranks
  std::optional<Error> trouble_;      ///< of this rank
  Requests requests_;
  Repartitions repartitions_;
  WorkTimes work_;
  StageState stage_;
  bool displacementsZeroed_ = false;      ///< state_.reference is not the mesh
  std::map<int, std::vector<Vec3>> came_; ///< by block that has come in: places of the nodes then
  std::set<int> cameBeforeZero_; ///< of these blocks, before displacements were zeroed last
  // Done in the next cycle.
  std::vector<int> leaving_;
  ComingBlocks coming_;
};
} // namespace coplane
