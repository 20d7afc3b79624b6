#include "Rig.hpp"

#include <coplane_core/Error.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace coplane
{
namespace
{
/// Runs to the end, which must be an error of the computation on every rank; returns its text.
std::string failureOf(Solver& solver, Recorder& observer)
{
  try
  {
    solver.run(observer);
    ADD_FAILURE() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Computation);
    EXPECT_TRUE(error.onAllRanks());
    EXPECT_EQ(observer.ending.how,
              "failed"); // observers close their files before the error is thrown
    return error.what();
  }
  return "";
}

void expectContains(const std::string& text, const std::string& part)
{
  EXPECT_NE(text.find(part), std::string::npos) << "no '" << part << "' in: " << text;
}
} // namespace

TEST(InvertedElement, isNamedByItsIdOnAllRanks)
{
  // Two bodies of one element each; the top of the second is driven through its foot: 1 m of
  // height at 1000 m/s in steps of 0.1 ms has gone after 10 cycles.
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "quiet", {1, 1, 1}, {0, 0, 0}, {1, 1, 1});
  addBox(mesh, "crushed", {1, 1, 1}, {5, 0, 0}, {1, 1, 1});
  mesh.blocks[1].elementIds = {4711};
  Model model = rockModel(mesh, comm);
  PrescribedVelocity foot, top;
  foot.nodes = ownedNodesWhere(model.mesh, [](const Vec3& x) { return x.x >= 5 && x.z == 0; });
  top.nodes = ownedNodesWhere(model.mesh, [](const Vec3& x) { return x.x >= 5 && x.z == 1; });
  top.velocity[2] = [](Real) { return -1000.0; };
  model.conditions.velocities = {foot, top};
  model.time.fixedStep = 1e-4;
  model.time.end = 1;
  model.time.energyTolerance = infinity;
  Solver solver(std::move(model), comm);
  solver.prepare();
  Recorder observer;
  const std::string text = failureOf(solver, observer);
  expectContains(text, "element 4711 (block 'crushed') has turned inside out");
  expectContains(text, "its volume is -");
  expectContains(text, "cycle 1");
  EXPECT_GE(solver.clock().cycle, 10);
  EXPECT_LE(solver.clock().cycle, 12);
}

TEST(InvertedElement, ofTheMeshIsReportedBeforeTheFirstCycle)
{
  const Comm comm;
  Mesh mesh = unitBox(2, 1, 1);
  for (Vec3& x : mesh.coordinates) // folds the right element over the left one
    x.x = x.x == 2 ? 0.5 : x.x;
  try
  {
    Model model = rockModel(mesh, comm);
    model.contactEnabled = false;
    Solver solver(std::move(model), comm);
    solver.prepare();
    ADD_FAILURE() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Computation);
    expectContains(error.what(), "element 2 (block 'box')");
  }
}

TEST(EnergyTolerance, contactThatMakesEnergyEndsTheRun)
{
  // A cube slides on and off another under load: areas change, and with them the energy that the
  // planes hold. To one side or the other contact gains a little.
  const Comm comm;
  int ended = 0;
  for (const Real direction : {1., -1.})
  {
    Model model = slidingCubes(comm);
    model.blocks[1].velocity.x *= direction;
    model.time.end = 1;
    model.time.contactGainTolerance = 1e-12;
    Solver solver(std::move(model), comm);
    solver.prepare();
    Recorder observer;
    const std::string text = failureOf(solver, observer);
    if (text.find("contact has made") == std::string::npos)
      continue;
    ++ended;
    expectContains(text, "time.contact_gain_tolerance");
    expectContains(text, "plane between side 6 of element ");
  }
  EXPECT_GT(ended, 0);
}

namespace
{
/// What contact has gained by each cycle, over the energy in play by which the watch judges it.
struct Gains : Recorder
{
  std::vector<Real> byCycle{0};
  Real inPlay = 0;
  void start(const Solver& solver) override { inPlay = solver.energy().scale(); }
  void endOfCycle(const Solver& solver) override
  {
    const EnergyBalance balance = solver.energy();
    if (solver.clock().cycle % 100 == 0)
      inPlay = balance.scale();
    byCycle.push_back(-balance.contact.remainder() / std::max(inPlay, balance.scale()));
  }
};
} // namespace

TEST(EnergyTolerance, aGainBetweenTwoLooksEndsTheRunInItsCycle)
{
  // Cubes that meet at the start of a step gain in their collision, of some 15 cycles.
  const Comm comm;
  const auto collision = [&]
  {
    Model model = slidingCubes(comm);
    model.time.end = 0.02;
    return model;
  };
  Gains gains;
  Solver whole(collision(), comm);
  whole.prepare();
  whole.run(gains);
  Model model = collision();
  model.time.contactGainTolerance =
      0.5 * *std::max_element(gains.byCycle.begin(), gains.byCycle.end());
  ASSERT_GT(model.time.contactGainTolerance, 0);
  const auto first =
      std::find_if(gains.byCycle.begin(), gains.byCycle.end(),
                   [&](Real gain) { return gain > model.time.contactGainTolerance; });
  Solver solver(std::move(model), comm);
  solver.prepare();
  Recorder observer;
  expectContains(failureOf(solver, observer), "contact has made");
  EXPECT_EQ(solver.clock().cycle, first - gains.byCycle.begin());
  EXPECT_LT(solver.clock().cycle, 100);
}

TEST(EnergyTolerance, gainsOfTheSizeOfRoundOffEndNoRun)
{
  // The same collision at a nanometre per second, at which a step moves nodes by some thousand
  // units in the last place: it gains the same part of what is in play.
  const Comm comm;
  const auto collision = [&](Real tolerance)
  {
    Model model = slidingCubes(comm);
    for (auto& block : model.blocks)
      block.velocity = 1e-9 * block.velocity;
    model.time.end = 0.02;
    model.time.contactGainTolerance = tolerance;
    return model;
  };
  Gains gains;
  Solver measured(collision(0.9), comm);
  measured.prepare();
  measured.run(gains);
  const Real most = *std::max_element(gains.byCycle.begin(), gains.byCycle.end());
  ASSERT_GT(most, 1e-6);
  Solver solver(collision(0.5 * most), comm);
  solver.prepare();
  Recorder observer;
  EXPECT_NO_THROW(solver.run(observer));
}

TEST(EnergyTolerance, errorNamesTheWorstPlanesAndElements)
{
  // No balance closes to 1e-15: the check after 100 cycles must fail.
  const Comm comm;
  Model model = slidingCubes(comm);
  model.time.end = 1;
  model.time.energyTolerance = 1e-15;
  Solver solver(std::move(model), comm);
  solver.prepare();
  Recorder observer;
  const std::string text = failureOf(solver, observer);
  EXPECT_EQ(solver.clock().cycle, 100);
  expectContains(text, "cycle 100");
  expectContains(text, "the energy balance is off by");
  expectContains(text, "time.energy_tolerance");
  expectContains(text, "plane between side 6 of element "); // the top of the lower cube
  expectContains(text, "and side 5 of element ");           // the foot of the upper one
  expectContains(text, "element ");
  expectContains(text, "times its initial one");
}

TEST(EnergyTolerance, isNotReachedByAnHonestRun)
{
  const Comm comm;
  Model model = slidingCubes(comm);
  model.time.fixedStep = 1e-4;
  model.time.end = 0.02; // 200 cycles
  Solver solver(std::move(model), comm);
  solver.prepare();
  Recorder observer;
  EXPECT_EQ(solver.run(observer), ExitCode::Success);
}
} // namespace coplane
