#include <coplane_core/Log.hpp>
#include <coplane_dynamics/Rebalancer.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_mesh/Distribute.hpp>
#include <coplane_partition/Partition.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace coplane
{
namespace
{
/// Deals an amount of work to the owned ones of some nodes.
void deal(double amount, const int* nodes, int count, std::vector<Real>& costs)
{
  const int owned = int(costs.size());
  int mine = 0;
  for (int k = 0; k < count; ++k)
    mine += nodes[k] < owned;
  for (int k = 0; k < count; ++k)
    if (nodes[k] < owned)
      costs[nodes[k]] += amount / mine;
}

void dealElements(const RankMesh::Block& part, const ElementBlock& block, double work,
                  std::vector<Real>& costs)
{
  const int corners = topology(part.type).nodes;
  int living = 0;
  for (int e = 0; e < part.elements(); ++e)
    living += block.isAlive(e);
  for (int e = 0; e < part.elements(); ++e)
    if (block.isAlive(e))
      deal(work / living, &part.connectivity[e * corners], corners, costs);
}

void dealPlanes(const Contact& contact, double work, std::vector<Real>& costs)
{
  const auto weight = [](const Plane& plane) {
    return plane.face[0] < 0 ? 0 : plane.overlap > 0 ? costOfOverlap : 1;
  };
  Real all = 0;
  for (std::size_t slot = 0; slot < contact.slots(); ++slot)
    all += weight(contact.planeOf(slot));
  for (std::size_t slot = 0; slot < contact.slots(); ++slot)
  {
    const Plane plane = contact.planeOf(slot);
    if (plane.face[0] < 0)
      continue;
    int nodes[8], count = 0;
    for (const int side : plane.face)
    {
      const Face& face = contact.faces()[side];
      for (int k = 0; k < face.count; ++k)
        nodes[count++] = face.nodes[k];
    }
    deal(work * weight(plane) / all, nodes, count, costs);
  }
}

/// What a node costs at least, over the mean [-].
constexpr Real leastOfMean = 0.01;

/// A node on its way to its home.
struct PlacedNode
{
  int position; ///< in the file
  int owner;
  Vec3 x;
  Real cost;
};
} // namespace

std::vector<Real> costsOfOwnedNodes(const Solver& solver, const WorkTimes& work)
{
  const int owned = solver.layout().owned();
  std::vector<Real> costs(owned, owned > 0 ? work.nodes / owned : 0);
  for (std::size_t b = 0; b < work.elements.size(); ++b)
    dealElements(solver.mesh().blocks[b], solver.blocks()[b], work.elements[b], costs);
  if (solver.hasContact())
  {
    const Contact& contact = solver.contact();
    const std::vector<Face>& faces = contact.localFaces();
    for (const Face& face : faces)
      deal(work.search / double(faces.size()), face.nodes, face.count, costs);
    dealPlanes(contact, work.planes, costs);
  }
  return costs;
}

RebalancePlan planRebalance(const Solver& solver, const MeshSlice& mesh, const std::string& method,
                            const WorkTimes& work)
{
  const Comm& comm = solver.comm();
  const RankMesh& part = solver.mesh();
  const std::vector<Real> mine = costsOfOwnedNodes(solver, work);
  std::vector<std::vector<PlacedNode>> toHomes(comm.size());
  for (int n = 0; n < part.ownedNodes; ++n)
    toHomes[mesh.homeOfNode(part.nodePositions[n])].push_back(
        {part.nodePositions[n], comm.rank(), at(solver.state().x, n), mine[n]});
  const int first = mesh.nodeRange().first;
  std::vector<Vec3> places(mesh.nodeRange().count);
  std::vector<Real> costs(places.size());
  std::vector<int> owners(places.size());
  for (const PlacedNode& node : comm.exchange(toHomes))
  {
    places[node.position - first] = node.x;
    costs[node.position - first] = node.cost;
    owners[node.position - first] = node.owner;
  }
  // A node whose work was too short to be seen still is something to be looked after.
  const Real total =
      comm.size() *
      largestAndMean(std::accumulate(costs.begin(), costs.end(), Real(0)), comm).second;
  for (Real& cost : costs)
    cost = std::max(cost, total > 0 ? leastOfMean * total / mesh.nodes : 1);

  RebalancePlan plan;
  plan.owners = nodeOwners(partAtHome(mesh, comm), comm, method, costs, &places);
  std::vector<std::vector<double>> sums(comm.size());
  std::int64_t moved = 0;
  for (std::size_t n = 0; n < costs.size(); ++n)
  {
    std::vector<double>& sum = sums[plan.owners[n]];
    sum.resize(1, 0);
    sum[0] += costs[n];
    moved += plan.owners[n] != owners[n];
  }
  const std::vector<double> shares = comm.exchange(sums);
  const auto [busiest, mean] =
      largestAndMean(std::accumulate(shares.begin(), shares.end(), 0.0), comm);
  plan.busiest = busiest;
  plan.imbalance = busiest / mean;
  plan.moved = comm.sum(moved);
  return plan;
}

bool RebalanceLedger::pays(double saved, double rest)
{
  lost_ = std::max(0.0, lost_ + saved);
  return lost_ > cost_ && rest > cost_;
}

void RebalanceLedger::done(double cost)
{
  cost_ = cost;
  lost_ = 0;
}

Rebalancer::Rebalancer(const Comm& comm, const MeshSlice& mesh, RebalanceOptions options,
                       std::function<Model(RankMesh)> modelOf)
    : mesh_(&mesh), options_(std::move(options)), modelOf_(std::move(modelOf)),
      ledger_(comm.max(options_.firstCost))
{
}

bool Rebalancer::isTime(std::int64_t cycle)
{
  if (nextLook_ < 0)
    nextLook_ = ((cycle - 1) / options_.every + 1) * options_.every;
  if (cycle < nextLook_)
    return false;
  nextLook_ += options_.every;
  return true;
}

bool Rebalancer::look(Solver& solver)
{
  const Comm& comm = solver.comm();
  const Clock& clock = solver.clock();
  if (options_.when == RebalanceOptions::When::Never || comm.size() == 1 || !isTime(clock.cycle))
    return false;

  // From here on every rank has the same numbers, hence decides alike.
  const WorkTimes work = solver.takeWorkTimes();
  const auto [busiest, mean] = largestAndMean(work.total(), comm);
  const double imbalance = mean > 0 ? busiest / mean : 1;
  const bool always = options_.when == RebalanceOptions::When::Always;
  if (!always && imbalance < options_.above)
    return false;
  const RebalancePlan plan = planRebalance(solver, *mesh_, options_.method, work);
  const double saved = busiest - plan.busiest;
  const double perCycle = saved / double(work.cycles);
  const double cyclesLeft = std::ceil((solver.model().time.end - clock.time) / clock.nextStep);
  if (!always && !(ledger_.pays(saved, perCycle * cyclesLeft) && plan.moved > 0))
    return false;
  rebalance(solver, plan);
  logInfo("rebalanced at cycle {}: in {} cycles the busiest rank had {:.3f} times the mean work; "
          "{:.3f} predicted now; {} of {} nodes changed their rank, which took {:.3g} s; saves "
          "{:.3g} s in 1000 cycles",
          clock.cycle, work.cycles, imbalance, plan.imbalance, plan.moved, mesh_->nodes,
          ledger_.cost(), 1000 * perCycle);
  return true;
}

void Rebalancer::rebalance(Solver& solver, const RebalancePlan& plan)
{
  const Comm& comm = solver.comm();
  const auto begin = std::chrono::steady_clock::now();
  solver.repartition(modelOf_(distribute(*mesh_, plan.owners, comm)));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  ledger_.done(comm.max(took.count()));
  solver.bookRepartition(ledger_.cost(), plan.moved);
}
} // namespace coplane
