#include "Rig.hpp"

#include <coplane_dynamics/Rebalancer.hpp>

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

namespace coplane
{
namespace
{
using Maker = std::function<Model(const Comm&, const std::string&)>;

/// Runs with a change of the partition after every few cycles against the straight run.
void expectSameBits(const Maker& make, int total, int every)
{
  const Comm comm;
  Solver straight(make(comm, "multijagged"), comm), moved(make(comm, "multijagged"), comm);
  straight.prepare();
  moved.prepare();
  const std::string methods[] = {"scattered", "rcb", "last", "hsfc"};
  for (int cycle = 1; cycle <= total; ++cycle)
  {
    straight.advance();
    moved.advance();
    if (cycle % every == 0)
      moved.repartition(make(comm, methods[cycle / every % 4]));
    ASSERT_EQ(moved.stateHash(), straight.stateHash()) << "cycle " << cycle;
  }
  EXPECT_EQ(moved.repartitions().count, total / every);
  EXPECT_GT(straight.contact().counts().planes, 0);
  EXPECT_EQ(moved.searches(), straight.searches());
  const EnergyBalance energy = moved.energy(), expected = straight.energy();
  EXPECT_EQ(std::memcmp(&energy, &expected, sizeof energy), 0);
  const Momenta a = moved.momenta(), b = straight.momenta();
  EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
  EXPECT_EQ(moved.erosion().elements, straight.erosion().elements);
  EXPECT_EQ(moved.erosion().mass, straight.erosion().mass);
  EXPECT_EQ(moved.stepControl().text(), straight.stepControl().text());
  ContactCounts m = moved.contact().counts(), s = straight.contact().counts();
  m.lookedAt = s.lookedAt = 0; // known from the next cycle on: velocities have changed
  EXPECT_EQ(std::memcmp(&m, &s, sizeof m), 0);
}

/// A plate on a plate in the left half, one thick block in the right half: contact is on the left.
///
///    +------+------+
///    |======|      |
///    +------+------+
Mesh contactOnTheLeft()
{
  Mesh mesh;
  addBox(mesh, "lower", {8, 4, 1}, {0, 0, 0}, {2, 1, 0.25});
  addBox(mesh, "upper", {8, 4, 1}, {0.03, 0.03, 0.25}, {2, 1, 0.25});
  addBox(mesh, "thick", {8, 4, 3}, {3, 0, 0}, {2, 1, 0.5});
  return mesh;
}

Model contactOnTheLeftModel(const Comm& comm)
{
  Model model = rockModel(contactOnTheLeft(), comm, 0, "multijagged");
  model.blocks[1].velocity = {0, 0, -1};
  model.blocks[2].velocity = {0, 0, 1};
  return model;
}

/// What a cycle takes when an element takes 1 and a pair that lies over each other 1.
WorkTimes countedWork(const Solver& solver)
{
  WorkTimes work;
  for (const ElementBlock& block : solver.blocks())
    work.elements.push_back(block.count());
  const Contact& contact = solver.contact();
  for (std::size_t slot = 0; slot < contact.slots(); ++slot)
    if (const Plane plane = contact.planeOf(slot); plane.face[0] >= 0)
      work.planes += plane.overlap > 0 ? 1 : 1 / costOfOverlap;
  work.cycles = 1;
  return work;
}

/// Largest over mean.
Real imbalanceOf(Real mine, const Comm& comm)
{
  const std::vector<Real> all = comm.allGather(std::vector<Real>{mine});
  return *std::max_element(all.begin(), all.end()) * comm.size() /
         std::accumulate(all.begin(), all.end(), Real(0));
}
} // namespace

TEST(Repartition, ofSlidingCubesHasTheBitsOfTheStraightRun)
{
  expectSameBits([](const Comm& comm, const std::string& method)
                 { return slidingCubes(comm, method); },
                 40, 3);
}

TEST(Repartition, withErosionRigidBodiesLoadsAndDampingHasTheBitsOfTheStraightRun)
{
  expectSameBits(everything, 60, 1);
}

TEST(CostsOfOwnedNodes, addUpToTheWorkOfTheRank)
{
  const Comm comm;
  Solver solver(contactOnTheLeftModel(comm), comm);
  solver.prepare();
  cycles(solver, 10);
  WorkTimes work = countedWork(solver);
  work.search = 3;
  work.nodes = 5;
  const std::vector<Real> costs = costsOfOwnedNodes(solver, work);
  const Real sum = std::accumulate(costs.begin(), costs.end(), Real(0));
  // Work of a kind of which this rank has nothing is dealt to nobody.
  const Real expected = work.total() - (solver.contact().localFaces().empty() ? work.search : 0) -
                        (solver.layout().owned() == 0 ? work.nodes : 0);
  EXPECT_NEAR(sum, expected, 1e-12 * work.total()); // rounding of a few thousand additions
}

TEST(CostsOfOwnedNodes, areHigherWhereFacesMeet)
{
  const Comm alone(MPI_COMM_SELF);
  Solver solver(contactOnTheLeftModel(alone), alone);
  solver.prepare();
  cycles(solver, 10);
  WorkTimes work;
  work.elements.assign(3, 0);
  work.planes = 1;
  const std::vector<Real> costs = costsOfOwnedNodes(solver, work);
  for (int n = 0; n < solver.layout().owned(); ++n)
  {
    const bool meets = solver.mesh().coordinates[std::size_t(n)].x < 2.5;
    EXPECT_TRUE(meets || costs[std::size_t(n)] == 0) << "node " << n;
  }
  EXPECT_NEAR(std::accumulate(costs.begin(), costs.end(), Real(0)), 1, 1e-12);
}

TEST(PlanRebalance, sharesOutContactThatIsInOneHalf)
{
  const Comm comm;
  const MeshSlice mesh = sliceOf(contactOnTheLeft(), comm);
  const Maker make = [&](const Comm&, const std::string&) { return contactOnTheLeftModel(comm); };
  Solver solver(make(comm, ""), comm);
  solver.prepare();
  cycles(solver, 10);
  const WorkTimes work = countedWork(solver);
  const Real before = imbalanceOf(work.total(), comm);
  const RebalancePlan plan = planRebalance(solver, mesh, "multijagged", work);
  if (comm.size() == 1)
  {
    EXPECT_EQ(before, 1);
    EXPECT_EQ(plan.imbalance, 1);
    EXPECT_EQ(plan.moved, 0);
    return;
  }
  EXPECT_GT(before, 1.2);
  EXPECT_LT(plan.imbalance, 1.1); // Zoltan2 is asked for 1.05, and a layer of nodes is a step
  EXPECT_GT(plan.moved, 0);

  Model model = contactOnTheLeftModel(comm);
  model.mesh = distribute(mesh, plan.owners, comm);
  solver.repartition(std::move(model));
  const Real after = imbalanceOf(countedWork(solver).total(), comm);
  // Elements and pairs between two ranks are counted on both now.
  EXPECT_LT(after, 1 + 0.6 * (before - 1)) << "before: " << before;
}

TEST(RebalanceLedger, actsWhenWhatIsLostExceedsTheCost)
{
  RebalanceLedger ledger(1.0);
  EXPECT_FALSE(ledger.pays(0.4, 100));
  EXPECT_FALSE(ledger.pays(0.4, 100));
  EXPECT_TRUE(ledger.pays(0.4, 100));
  ledger.done(0.5);
  EXPECT_FALSE(ledger.pays(0.4, 100));
  EXPECT_TRUE(ledger.pays(0.4, 100));
}

TEST(RebalanceLedger, waitsWhereTheRestOfTheRunDoesNotPayForIt)
{
  RebalanceLedger ledger(1.0);
  EXPECT_FALSE(ledger.pays(5, 0.9));
  EXPECT_FALSE(ledger.pays(-10, 0.5)); // and forgets what a better partition would have saved
  EXPECT_FALSE(ledger.pays(0.9, 100));
  EXPECT_TRUE(ledger.pays(0.9, 100));
}

TEST(Rebalancer, looksEverySoManyCyclesAndTellsTheObserver)
{
  struct Counter : Recorder
  {
    int repartitions = 0;
    void repartitioned(const Solver&) override { ++repartitions; }
  };
  const Comm comm;
  const MeshSlice mesh = sliceOf(contactOnTheLeft(), comm);
  std::uint64_t hashes[3];
  for (const auto when : {RebalanceOptions::When::Never, RebalanceOptions::When::Auto,
                          RebalanceOptions::When::Always})
  {
    RebalanceOptions options;
    options.when = when;
    options.every = 5;
    options.above = 1;
    // Never pays; ranks that measure different costs still decide alike.
    options.firstCost = comm.isRoot() && comm.size() > 1 ? 0 : 1e9;
    Model model = contactOnTheLeftModel(comm);
    model.time.fixedStep = 1e-5;
    model.time.end = 21.5e-5; // 22 cycles
    Rebalancer rebalancer(comm, mesh, options,
                          [&](RankMesh part)
                          {
                            Model again = contactOnTheLeftModel(comm);
                            again.time.end = 21.5e-5;
                            again.time.fixedStep = 1e-5;
                            again.mesh = std::move(part);
                            return again;
                          });
    Solver solver(std::move(model), comm);
    solver.prepare();
    Counter counter;
    solver.run(counter, &rebalancer);
    EXPECT_EQ(solver.clock().cycle, 22);
    const int expected = when == RebalanceOptions::When::Always && comm.size() > 1 ? 4 : 0;
    EXPECT_EQ(counter.repartitions, expected);
    EXPECT_EQ(solver.repartitions().count, expected);
    hashes[int(when)] = solver.stateHash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}
} // namespace coplane
