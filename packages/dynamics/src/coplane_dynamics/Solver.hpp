#pragma once

#include <coplane_contact/Contact.hpp>
#include <coplane_core/Comm.hpp>
#include <coplane_core/Error.hpp>
#include <coplane_dynamics/Dashpots.hpp>
#include <coplane_dynamics/Erosion.hpp>
#include <coplane_dynamics/Ledger.hpp>
#include <coplane_dynamics/Model.hpp>
#include <coplane_dynamics/NodalState.hpp>
#include <coplane_dynamics/Observer.hpp>
#include <coplane_dynamics/RigidBodies.hpp>
#include <coplane_dynamics/Signals.hpp>
#include <coplane_dynamics/StepGrowth.hpp>
#include <coplane_dynamics/WorkTimes.hpp>
#include <coplane_element/ElementBlock.hpp>
#include <coplane_mesh/NodeLayout.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace coplane
{
struct Clock
{
  std::int64_t cycle = 0;
  Real time = 0;     ///< t(n) [s]
  Real step = 0;     ///< dt(n-1/2), of the cycle that ended; 0 at the start [s]
  Real nextStep = 0; ///< dt(n+1/2) [s]
};

/// What limits the time step.
struct StepControl
{
  Real stableStep = infinity;           ///< without the safety factor [s]
  GlobalId node = 0;                    ///< the node with it (the lowest id when several have)
  bool motion = false;                  ///< the motion of faces limits it, see Solver::motionStep
  Real relativeSpeed = 0, thinnest = 0; ///< with motion [m/s], [m]
  bool rigid = false;                   ///< a rigid body, which has the node, is what limits it
  bool contact = false;        ///< whether contact adds more than elements to its frequency
  GlobalId element = 0;        ///< of those around the node the one with the smallest step
  GlobalId faceId[2] = {0, 0}; ///< the plane that adds most to the node's contact stiffness, if any
  /// "element 12 at node 7", or "contact at node 7, most by side 1 of element 3 against side ..."
  std::string text() const;
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
  /// Cycles until the end time, a stop request or a failure. Returns how it ended; throws
  /// Error(ExitCode::Computation) on failure after the observers have finished. A rebalancer may
  /// change the partition at the end of cycles. Collective.
  ExitCode run(Observer& observer, Rebalancer* rebalancer = nullptr);
  /// One cycle. Public for tests and benchmarks.
  void advance();

  const Comm& comm() const { return *comm_; }
  const Model& model() const { return model_; }
  const RankMesh& mesh() const { return model_.mesh; }
  const NodeLayout& layout() const { return layout_; }
  const NodalState& state() const { return state_; }
  const std::vector<ElementBlock>& blocks() const
  {
    return blocks_;
  } ///< in the order of the mesh file
  bool hasContact() const { return contact_ != nullptr; }
  const Contact& contact() const { return *contact_; }
  const Clock& clock() const { return clock_; }
  const RigidBodies& rigidBodies() const { return *rigid_; }
  const RelaxationState& relaxation() const { return relaxation_; }
  std::int64_t searches() const { return contact_ ? contact_->searches() : 0; }
  // By signals or by an observer (Signals.hpp), decided together for the cycle that has ended.
  bool resultsRequested() const { return requests_.results; }
  bool checkpointRequested() const { return requests_.checkpoint; }
  bool stopRequested() const { return requests_.stop; }

  // Over all ranks, the same bits on all. Collective.
  EnergyBalance energy() const;
  const EnergyBalance& initialEnergy() const { return initialEnergy_; } ///< before the first cycle
  ErosionTotals erosion() const;
  Momenta momenta() const;
  StepControl stepControl() const;
  bool isOver() const;
  /// Positions, velocities, element and plane state, clock; independent of ranks, threads and back
  /// end.
  std::uint64_t stateHash() const;
  /// Text that names the planes with the largest unexplained work, the deepest planes, and the
  /// elements whose volume has changed most.
  std::string worstEntities() const;

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
  const ExactSum& erodedEnergy(int block) const { return erodedEnergy_[block]; }

private:
  struct Gather
  {
    Array<int> start,
        entry; ///< entries of node n: element * corners + corner, in the order of element ids
  };

  void search(bool again = false);
  void findForces(Real dt);
  ConstArray<Real> nodalDilatation(std::size_t block, Real dt);
  void gatherElementForces();
  void prepareErosion();
  /// Takes out the elements that meet their criterion, and finds the exterior faces anew. Returns
  /// whether there were any on some rank. Collective.
  bool erode(Real dt);
  void kill(int block, int element, Real dt);
  void endLoadsOn(const std::vector<GlobalId>& deadElements); ///< sorted
  void findContactFaces(const std::vector<Face>* known);
  void restoreElements(const StateSource& in);
  void restoreNodes(const StateSource& in);
  void restoreErosion(const StateSource& in);
  template <class Self, class F>
  static void forEachNumber(Self& solver, F&& number);
  /// Whether all elements of an owned node have died.
  bool isFree(int node) const { return erodes_ && livingElements_[node] == 0; }
  /// Of all elements, contacts and rigid bodies of this rank [s]; 0 when an element has turned
  /// inside out, or a force or stiffness is no number.
  Real stableStep() const;
  Real stepOfFreeBodies() const;
  /// In which faces move by a fraction of the thinnest element behind one, relative to each other:
  /// no face may jump over an element, nor deep into it, between two looks at their closure.
  /// `thinnest`: over all ranks [m]
  Real motionStep(Real thinnest) const
  {
    return relativeSpeed_ > 0 ? motionPerStep * thinnest / relativeSpeed_ : infinity;
  }
  /// Bound on the speed of any two nodes relative to each other [m/s]. Collective.
  Real relativeSpeed() const;
  Real boundOfFirstStep();
  Real leastElementStep(int node) const; ///< of the elements around an owned node [s]
  Real nodeStep(int node) const;         ///< of elements and contacts there [s]
  Real rigidStep() const;                ///< of rigid bodies [s]
  /// Bound on the rate by which contact damping acts, from a bound on the frequency of contact. A
  /// plane's dashpot is 2 zeta K / omega with its own frequency omega; that of the planes of a node
  /// together is up to twice as high where faces match [1/s].
  Real contactDamping(Real frequency) const;
  void setInitialStress(int block);
  void applyLocalDamping();
  /// For the dampings: a time at which none acts when relaxation has ended them.
  Real dampingTime() const { return relaxation_.ended ? infinity : clock_.time; }
  // Dynamic relaxation (Relaxation.cpp). Collective.
  void relax(Real step);
  void takeBackWorkAhead(Real step);
  void stopMotion(Real step);
  bool isAtRest() const;
  Real kineticAtHalfStep() const; ///< sum m v(n+1/2)^2 / 2 [J]
  Real kineticAtFullStep() const; ///< sum m v(n-1/2).v(n+1/2) / 2 [J]
  void mirrorVelocities();        ///< v(n-1/2) of a start: mirrors v(n+1/2) about v(n)
  void kick(Real step);
  void drift(Real dt);
  /// Forces of conditions at the end of the cycle, and those on rigid bodies.
  void sumLoads();
  /// The step of the next cycle, the same on all ranks, and their requests; nothing when an element
  /// or a force has failed. Collective.
  std::optional<Real> agreeOnNextStep(const Requests& mine);
  /// @param stable of all ranks, without its safety factor [s]; thinnest element behind a face [m]
  Real nextStep(Real stable, Real thinnest);
  /// Whether contact needs a search before the forces of the next cycle, and how fast nodes move
  /// relative to each other; tells all ranks of trouble. Collective.
  void planSearch();
  bool isRigid(std::size_t block) const { return model_.blocks[block].rigid; }
  void nameWhatLimits(int node, StepControl& control) const;
  std::string worstByRemainder() const;
  std::string deepestPlanes() const;
  void warnOfCaps(const std::string& now);
  std::string brokenBalance(const EnergyBalance& balance) const;
  void warnOfTrouble(const EnergyBalance& balance);
  /// @param why what has been caught already; empty: the caller fails next, and says why
  void finishBeforeFailing(Observer& observer, const std::string& why = "") const;
  [[noreturn]] void failTogether(const std::string& what);
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
  Dashpots dashpots_;
  std::vector<ElementBlock> blocks_;
  std::vector<Gather> gathers_;
  std::unique_ptr<Contact> contact_;
  std::vector<int> bodyOfNode_;  ///< number of the body, the same on all ranks; contact only
  Array<Real> contactStiffness_; ///< per owned node [N/m]
  Array<Real> dilatation_;       ///< of the step, per node of the layout
  std::vector<int> constrained_;
  std::vector<Conditions::Projection> projections_;
  NodeVectors beforeConstraint_;
  std::optional<RigidBodies> rigid_;
  Array<bool> followsBody_;                              ///< owned nodes of rigid bodies
  bool erodes_ = false;                                  ///< some block has a criterion
  std::vector<std::optional<ErosionRule>> erosionRules_; ///< by block
  std::optional<ElementSides> sides_;
  std::vector<std::vector<char>> alive_; ///< [block][element]
  std::vector<int> livingElements_;      ///< around each owned node
  std::vector<ExactSum> erodedEnergy_;   ///< by block
  ExactSum erodedMass_;
  std::int64_t erodedElements_ = 0;
  Clock clock_;
  StepGrowth growth_;
  static constexpr Real motionPerStep = 0.2; ///< of the thickness of an element
  Real largestNextStep_ = 0;                 ///< bound for the step after the one in progress [s]
  Real relativeSpeed_ = 0;                   ///< at the last half step [m/s]
  Real searchSkin_ = 0;                      ///< of the last search [m]
  RelaxationState relaxation_;
  EnergyBalance initialEnergy_;
  Momenta initialMomenta_;
  // When warnOfTrouble() speaks: at this fraction of the error at which the run stops; at these
  // fractions of the energy in play that contact has lost or gained by the remainder.
  static constexpr Real errorToWarn = 0.2, lossToWarn = 0.1, gainToWarn = 0.02;
  /// What was warned of last.
  struct Warned
  {
    Real error = 0, remainder = 0, tooDeep = 0, capped = 0;
  };
  Warned warned_;
  bool massDampingActs_ = false, localDampingActs_ = false; ///< their forces are not all zero
  bool searchIsDue_ = false;
  bool failed_ = false;
  std::optional<Error> trouble_; ///< of this rank
  Requests requests_;
  Repartitions repartitions_;
  WorkTimes work_;
};
} // namespace coplane
