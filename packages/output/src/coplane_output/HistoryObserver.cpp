#include <coplane_contact/ContactTables.hpp>
#include <coplane_core/ExactSum.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_core/Text.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_output/HistoryObserver.hpp>
#include <coplane_output/detail/ProbedElements.hpp>
#include <coplane_output/detail/ProbedPlanes.hpp>

#include <algorithm>
#include <set>

namespace coplane
{
namespace
{
constexpr const char* axes = "xyz";
constexpr const char* firstColumns = "time[s],cycle,dt[s],kinetic[J],";
} // namespace

/// Names and values of one line, so that header and lines cannot differ.
class HistoryColumns
{
public:
  void add(const std::string& name, Real value) { put(name, fmt::format("{:.17g}", value)); }
  void add(const std::string& name, std::int64_t value) { put(name, fmt::format("{}", value)); }
  void add(const std::string& name, const std::string& text) { put(name, text); }
  void add(const std::string& name, const char* unit, const Vec3& value)
  {
    for (int c = 0; c < 3; ++c)
      add(fmt::format("{}_{}{}", name, axes[c], unit), value[c]);
  }

  void demandNamesOnce() const
  {
    std::set<std::string> seen;
    for (const std::string& name : each_)
      if (!seen.insert(name).second)
        fail(ExitCode::Deck,
             "history: two columns would be called '{}'. Give the probe, or the joint card of "
             "history.joints, another name, or leave one of them out.",
             name);
  }

  std::string names, values;

private:
  std::vector<std::string> each_;

  void put(const std::string& name, const std::string& text)
  {
    each_.push_back(name);
    const char* comma = names.empty() ? "" : ",";
    names += comma + csvField(name);
    values += comma + csvField(text);
  }
};

namespace
{
void addEnergies(HistoryColumns& line, const EnergyBalance& energy, Real initialKinetic,
                 bool withLines, const Debris* debris)
{
  line.add("kinetic[J]", energy.kinetic);
  line.add("internal[J]", energy.internal);
  line.add("plastic[J]", energy.plastic);
  line.add("plastic_bending[J]", energy.bending);
  line.add("hourglass[J]", energy.hourglass);
  line.add("viscous[J]", energy.viscous);
  line.add("eroded[J]", energy.eroded);
  line.add("contact_stored[J]", energy.contact.stored);
  line.add("contact_friction[J]", energy.contact.friction);
  line.add("contact_hysteresis[J]", energy.contact.hysteresis);
  line.add("contact_fracture[J]", energy.contact.fracture);
  line.add("contact_damping[J]", energy.contact.damping);
  line.add("contact_eroded[J]", energy.contact.eroded);
  line.add("contact_remainder[J]", energy.contact.remainder());
  if (withLines)
  {
    line.add("line_stored[J]", energy.lines.stored);
    line.add("line_plastic[J]", energy.lines.plastic);
    line.add("line_bond[J]", energy.lines.bond);
    line.add("line_dowel[J]", energy.lines.dowel);
    line.add("line_rupture[J]", energy.lines.rupture);
    line.add("line_remainder[J]", energy.lines.remainder());
    line.add("line_pretension[J]", energy.lines.pretension);
  }
  if (debris)
  {
    line.add("debris_points", debris->count());
    line.add("debris_touching", debris->touching());
    line.add("debris_stored[J]", energy.debris.stored);
    line.add("debris_remainder[J]", energy.debris.remainder());
  }
  line.add("mass_damping[J]", energy.massDamping);
  line.add("local_damping[J]", energy.localDamping);
  line.add("kinetic_damping[J]", energy.kineticDamping);
  line.add("external_work[J]", energy.externalWork);
  line.add("chemical[J]", energy.chemical);
  line.add("initial[J]", energy.initial);
  line.add("error[J]", energy.error());
  line.add("nodal_work[J]", energy.nodalWork);
  line.add("nodal_error[J]", energy.kinetic - initialKinetic - energy.nodalWork);
}

void addMomenta(HistoryColumns& line, const Momenta& momenta)
{
  line.add("momentum", "[N*s]", momenta.linear);
  line.add("impulse", "[N*s]", momenta.impulse);
  line.add("momentum_error", "[N*s]", momenta.linearError());
  line.add("angular_momentum", "[N*m*s]", momenta.angular);
  line.add("angular_impulse", "[N*m*s]", momenta.angularImpulse);
  line.add("angular_momentum_error", "[N*m*s]", momenta.angularError());
}

void addAddedMasses(HistoryColumns& line, const Solver& solver)
{
  const std::vector<AddedMass> blocks = solver.addedMasses();
  for (std::size_t b = 0; b < blocks.size(); ++b)
  {
    if (solver.model().blocks[b].rigid)
      continue;
    const std::string& name = solver.model().blocks[b].name;
    line.add(name + "_added_mass[kg]", blocks[b].added);
    line.add(name + "_added_momentum", "[N*s]", blocks[b].momentum);
    line.add(name + "_added_kinetic[J]", blocks[b].kinetic);
  }
}

void addBody(HistoryColumns& line, const std::string& name, const RigidBodies::BodyMotion& motion)
{
  line.add(name + "_displacement", "[m]", motion.displacement);
  line.add(name + "_velocity", "[m/s]", motion.velocity);
  line.add(name + "_spin", "[rad/s]", motion.spin);
  line.add(name + "_reaction", "[N]", motion.force);
  line.add(name + "_reaction_moment", "[N*m]", motion.moment);
}

void addCounts(HistoryColumns& line, const ContactCounts& counts, std::int64_t searches)
{
  line.add("pairs", counts.slots);
  line.add("looked_at", counts.lookedAt);
  line.add("carrying", counts.carrying);
  line.add("planes", counts.planes);
  line.add("open", counts.open);
  line.add("stick", counts.stick);
  line.add("slip", counts.slip);
  line.add("too_deep", counts.tooDeep);
  line.add("released", counts.released);
  line.add("missed", counts.missed);
  line.add("searches", searches);
}

void addJoint(HistoryColumns& line, const std::string& name, const JointSummary& joint)
{
  line.add(name + "_open_area[m^2]", joint.openArea);
  line.add(name + "_stick_area[m^2]", joint.stickArea);
  line.add(name + "_slip_area[m^2]", joint.slipArea);
  line.add(name + "_mean_closure[m]", joint.meanClosure);
  line.add(name + "_largest_slip[m]", joint.largestSlip);
  line.add(name + "_normal_force[N]", joint.normalForce);
  line.add(name + "_stored[J]", joint.energy.stored);
  line.add(name + "_friction[J]", joint.energy.friction);
  line.add(name + "_hysteresis[J]", joint.energy.hysteresis);
  line.add(name + "_fracture[J]", joint.energy.fracture);
}
} // namespace

HistoryObserver::HistoryObserver(const Comm& comm, HistoryOptions options)
    : options_(std::move(options)), schedule_(OutputTimes{options_.every, {}})
{
  for (Probe& probe : options_.probes)
    probe.variables = byComponent(probe.variables);
  comm.together(
      [&]
      {
        std::optional<TextPosition> position;
        if (!options_.position.empty())
          position = TextPosition::from(options_.position);
        lastCycle_ = position ? position->cycle : -1;
        if (comm.isRoot() && !options_.file.empty())
          hasHeader_ = table_.open(options_.file, firstColumns, position);
      });
}

void HistoryObserver::demandPossible(const Solver& solver, HistoryOptions options)
{
  options.file.clear();
  HistoryObserver trial(solver.comm(), std::move(options));
  trial.findShares(solver);
  trial.warnOfLeaving(solver);
  const HistoryColumns line = trial.columnsOf(solver);
  solver.comm().together([&] { line.demandNamesOnce(); });
}

void HistoryObserver::start(const Solver& solver)
{
  initialKinetic_ = solver.initialEnergy().kinetic;
  findShares(solver);
  warnOfLeaving(solver);
  schedule_.startAt(solver.clock().time);
  if (options_.position.empty())
    write(solver);
}

void HistoryObserver::endOfCycle(const Solver& solver)
{
  if (options_.every <= 0 || schedule_.isDue(solver.clock().time))
    write(solver);
}

void HistoryObserver::repartitioned(const Solver& solver)
{
  findShares(solver);
}

void HistoryObserver::savePosition(std::map<std::string, std::string>& positions) const
{
  if (table_.isOpen()) // on rank 0, which speaks
    positions["history"] = table_.position(lastCycle_).text();
}

void HistoryObserver::endOfStage(const Solver& solver)
{
  if (solver.clock().cycle != lastCycle_)
    write(solver);
}

void HistoryObserver::finish(const Solver& solver, const Ending&)
{
  if (solver.clock().cycle != lastCycle_)
    write(solver);
}

void HistoryObserver::findShares(const Solver& solver)
{
  const RankMesh& mesh = solver.mesh();
  std::vector<ExactSum> sums(4 * options_.probes.size()); // of weights, and of weighted places
  shares_.clear();
  for (const Probe& probe : options_.probes)
  {
    std::vector<Share> shares;
    if (probe.point)
    {
      if (const int node = nearestNode(solver, *probe.point); node >= 0)
        shares.push_back({node, 1});
    }
    else if (probe.nodeSet >= 0)
      for (const int node : mesh.nodeSets[probe.nodeSet])
        shares.push_back({node, 1});
    else
    {
      // Mass that the block's own elements bring to a node. Elements stand in the order of the file
      // on every rank, so the sums have the same bits.
      const RankMesh::Block& block = mesh.blocks[probe.block];
      const int corners = topology(block.type).nodes;
      std::vector<Real> mass(mesh.ownedNodes, 0);
      for (int i = 0; i < int(block.connectivity.size()); ++i)
        if (block.connectivity[i] < mesh.ownedNodes)
          mass[block.connectivity[i]] +=
              solver.blocks()[probe.block].cornerMass(i / corners, i % corners);
      for (int n = 0; n < mesh.ownedNodes; ++n)
        if (mass[n] > 0)
          shares.push_back({n, mass[n]});
    }
    for (const Share& share : shares)
    {
      ExactSum* mine = &sums[4 * shares_.size()];
      mine[0].add(share.weight);
      for (int c = 0; c < 3; ++c)
        mine[1 + c].add(share.weight * mesh.coordinates[share.node][c]);
    }
    shares_.push_back(std::move(shares));
  }
  totalWeight_.clear();
  places_.clear();
  if (!sums.empty())
  {
    const std::vector<Real> total = ExactSum::overRanks(sums, solver.comm());
    for (std::size_t p = 0; p < shares_.size(); ++p)
    {
      const Real* mine = &total[4 * p];
      totalWeight_.push_back(mine[0]);
      places_.push_back((1 / mine[0]) * Vec3{mine[1], mine[2], mine[3]});
    }
  }
  demandDistances(solver.comm());
  findElements(solver);
}

void HistoryObserver::demandDistances(const Comm& comm) const
{
  constexpr Real roundOff = 1e-9; // of the places
  for (std::size_t p = 0; p < options_.probes.size(); ++p)
    if (const int other = options_.probes[p].relativeTo; other >= 0)
      comm.together(
          [&]
          {
            const Vec3 &here = places_[p], &there = places_[std::size_t(other)];
            if (!(norm(here - there) > roundOff * (norm(here) + norm(there))))
              fail(ExitCode::Deck,
                   "history.probes: '{}' and '{}', to which it is relative, are in one place at "
                   "t = 0, so there is no drift between them. Accepted: two places.",
                   options_.probes[p].name, options_.probes[std::size_t(other)].name);
          });
}

/// A point at the wall of an opening is as near to what will be dug as to what stays.
void HistoryObserver::warnOfLeaving(const Solver& solver) const
{
  const std::vector<std::string>& leaving = options_.leaving;
  for (std::size_t p = 0; p < options_.probes.size() && !leaving.empty(); ++p)
  {
    const auto block = solver.comm().max(std::int64_t(nearest_[p].first));
    if (block < 0)
      continue;
    const std::string& name = solver.model().blocks[std::size_t(block)].name;
    if (std::find(leaving.begin(), leaving.end(), name) != leaving.end())
      logWarning("probes in what leaves",
                 fmt::format("history.probes: '{}' takes its variables from an element of '{}', "
                             "which a stage removes; they are 0 from then on. Give a point inside "
                             "of what stays.",
                             options_.probes[p].name, name));
  }
}

/// Elements at points; and whether the laws have the variables.
void HistoryObserver::findElements(const Solver& solver)
{
  nearest_.clear();
  for (const Probe& probe : options_.probes)
  {
    ProbedElement at;
    if (probe.point && !probe.variables.empty())
      at = nearestElement(solver, *probe.point);
    nearest_.emplace_back(at.block, at.element);
    const int block = probe.point ? at.block : probe.block;
    if (probe.nodeSet >= 0)
      continue; // names of nodes are those of every mesh
    for (const std::string& name : probe.variables)
      solver.comm().together(
          [&]
          {
            if (block >= 0 && solver.blocks()[std::size_t(block)].count() > 0 &&
                !elementVariable(solver, block, 0, name))
              fail(ExitCode::Deck,
                   "history.probes: '{}' asks for '{}', but block '{}' has: stress_xx, ... "
                   "stress_zx, strain_xx, ... strain_zx, von_mises, pressure, density{}{}.",
                   probe.name, name, solver.model().blocks[std::size_t(block)].name,
                   solver.blocks()[std::size_t(block)].historyVariables().empty() ? "" : ", ",
                   fmt::join(solver.blocks()[std::size_t(block)].historyVariables(), ", "));
          });
  }
}

auto HistoryObserver::variablesOf(const Solver& solver, std::size_t p) const -> NamedValues
{
  const Probe& probe = options_.probes[p];
  NamedValues columns;
  if (probe.variables.empty())
    return columns;
  const auto column = [&](const std::string& name, const std::string& rest)
  { return probe.name + "_" + name + rest; };
  if (!probe.point)
  {
    const bool ofNodes = probe.nodeSet >= 0;
    const std::vector<Extreme> extremes =
        ofNodes ? nodalExtremesOf(solver, probe.nodeSet, probe.variables)
                : extremesOf(solver, probe.block, probe.variables);
    const std::string_view item = ofNodes ? "node" : "element";
    for (std::size_t i = 0; i < extremes.size(); ++i)
    {
      const std::string& name = probe.variables[i / 2];
      const std::string which = i % 2 == 0 ? "_least" : "_largest";
      const Extreme& extreme = extremes[i];
      columns.emplace_back(column(name, which + unitOfVariable(name)), extreme.value);
      columns.emplace_back(column(name, fmt::format("{}_{}", which, item)), Real(extreme.id));
      for (int c = 0; c < 3; ++c)
        columns.emplace_back(column(name, fmt::format("{}_place_{}[m]", which, axes[c])),
                             extreme.place[c]);
    }
    return columns;
  }
  std::vector<ExactSum> sums(probe.variables.size());
  const auto [block, element] = nearest_[p];
  for (std::size_t i = 0; i < sums.size() && block >= 0; ++i)
    sums[i].add(elementVariable(solver, block, element, probe.variables[i]).value());
  const std::vector<Real> values = ExactSum::overRanks(sums, solver.comm());
  for (std::size_t i = 0; i < values.size(); ++i)
    columns.emplace_back(column(probe.variables[i], unitOfVariable(probe.variables[i])), values[i]);
  return columns;
}

std::vector<Real> HistoryObserver::probeValues(const Solver& solver) const
{
  if (shares_.empty())
    return {};
  const NodalState& state = solver.state();
  std::vector<ExactSum> sums(6 * shares_.size());
  for (std::size_t p = 0; p < shares_.size(); ++p)
    for (const Share& share : shares_[p])
      for (int c = 0; c < 3; ++c)
      {
        const int n = share.node;
        sums[6 * p + c].add(share.weight * (state.x(n, c) - state.reference(n, c)));
        sums[6 * p + 3 + c].add(share.weight * (0.5 * (state.vPrevious(n, c) + state.v(n, c))));
      }
  std::vector<Real> values = ExactSum::overRanks(sums, solver.comm());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] /= totalWeight_[i / 6];
  return values;
}

auto HistoryObserver::planeValues(const Solver& solver, const std::vector<Real>& motions) const
    -> std::vector<NamedValues>
{
  std::vector<WantedPlane> wanted;
  for (std::size_t p = 0; p < options_.probes.size(); ++p)
    if (const Probe& probe = options_.probes[p]; probe.plane)
    {
      const Real* moved = &motions[6 * p];
      wanted.push_back({*probe.point + Vec3{moved[0], moved[1], moved[2]}, probe.joint});
    }
  return wanted.empty() ? std::vector<NamedValues>{} : nearestPlanes(solver, wanted);
}

std::vector<Vec3> HistoryObserver::reactions(const Solver& solver) const
{
  std::vector<Vec3> result(options_.probes.size());
  if (std::none_of(options_.probes.begin(), options_.probes.end(),
                   [](const Probe& probe) { return probe.reaction; }))
    return result;
  std::vector<ExactSum> sums(3 * result.size());
  for (std::size_t p = 0; p < result.size(); ++p)
    if (options_.probes[p].reaction)
      for (const Share& share : shares_[p])
      {
        const Vec3 reaction = solver.reaction(share.node);
        for (int c = 0; c < 3; ++c)
          sums[3 * p + c].add(reaction[c]);
      }
  const std::vector<Real> values = ExactSum::overRanks(sums, solver.comm());
  for (std::size_t p = 0; p < result.size(); ++p)
    result[p] = {values[3 * p], values[3 * p + 1], values[3 * p + 2]};
  return result;
}

HistoryColumns HistoryObserver::columnsOf(const Solver& solver) const
{
  HistoryColumns line;
  line.add("time[s]", solver.clock().time);
  line.add("cycle", solver.clock().cycle);
  line.add("dt[s]", solver.clock().step);
  addEnergies(line, solver.energy(), initialKinetic_, !solver.lines().empty(), solver.debris());
  addMomenta(line, solver.momenta());
  addCounts(line, solver.hasContact() ? solver.contact().counts() : ContactCounts{},
            solver.searches());
  const ErosionTotals erosion = solver.erosion();
  line.add("eroded_elements", erosion.elements);
  line.add("eroded_mass[kg]", erosion.mass);
  if (solver.scalesMass())
    addAddedMasses(line, solver);
  if (solver.subcycling().acts())
  {
    line.add("substeps", std::int64_t(solver.subcycling().substeps()));
    line.add("substepped_elements", solver.substeppedElements());
  }
  const std::vector<Real> probes = probeValues(solver);
  const std::vector<Vec3> reactionsOf = reactions(solver);
  const std::vector<NamedValues> planes = planeValues(solver, probes);
  std::size_t plane = 0;
  for (std::size_t p = 0; p < options_.probes.size(); ++p)
  {
    const Real* value = &probes[6 * p];
    const std::string& name = options_.probes[p].name;
    if (options_.probes[p].plane)
    {
      for (const auto& [column, ofPlane] : planes[plane++])
        line.add(name + "_" + column, ofPlane);
      continue;
    }
    const int other = options_.probes[p].relativeTo;
    Vec3 displacement{value[0], value[1], value[2]}, velocity{value[3], value[4], value[5]};
    if (other >= 0)
    {
      const Real* from = &probes[std::size_t(6 * other)];
      displacement -= Vec3{from[0], from[1], from[2]};
      velocity -= Vec3{from[3], from[4], from[5]};
    }
    line.add(name + "_displacement", "[m]", displacement);
    line.add(name + "_velocity", "[m/s]", velocity);
    if (other >= 0)
      line.add(name + "_drift", "",
               (1 / norm(places_[p] - places_[std::size_t(other)])) * displacement);
    if (options_.probes[p].reaction)
      line.add(name + "_reaction", "[N]", reactionsOf[p]);
    for (const auto& [column, value] : variablesOf(solver, p))
      line.add(column, value);
  }
  if (!options_.joints.empty() && solver.hasContact())
  {
    const std::vector<JointSummary> joints = jointSummaries(solver.contact(), solver.state().x);
    for (const std::string& name : options_.joints)
      for (std::size_t j = 0; j < joints.size(); ++j)
        if (solver.contact().rules().joints[j].name == name)
          addJoint(line, name, joints[j]);
  }
  for (const int block : options_.rigidBlocks)
  {
    std::vector<int> bodies;
    for (int b = 0; b < solver.rigidBodies().count(); ++b)
      if (solver.rigidBodies().hasBlock(b, block))
        bodies.push_back(b);
    const std::string& name = solver.model().blocks[std::size_t(block)].name;
    for (std::size_t i = 0; i < bodies.size(); ++i)
      addBody(line, bodies.size() == 1 ? name : fmt::format("{}_{}", name, i + 1),
              solver.rigidBodies().motion(bodies[i]));
  }
  if (options_.stateHash)
    line.add("state_hash", fmt::format("{:016x}", solver.stateHash()));
  return line;
}

void HistoryObserver::write(const Solver& solver)
{
  TimedRegion region("coplane::output::history");
  const HistoryColumns line = columnsOf(solver);
  solver.comm().together(
      [&]
      {
        if (!solver.comm().isRoot())
          return;
        if (!hasHeader_)
          line.demandNamesOnce();
        table_.add((hasHeader_ ? "" : line.names + "\n") + line.values + "\n");
        hasHeader_ = true;
      });
  lastCycle_ = solver.clock().cycle;
}
} // namespace coplane
