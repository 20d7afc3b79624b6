#include "Rig.hpp"

#include <coplane_checkpoint/CheckpointReader.hpp>
#include <coplane_checkpoint/CheckpointWriter.hpp>
#include <coplane_core/ExactSum.hpp>

#include <gtest/gtest.h>

#include <TestFolder.hpp>
#include <algorithm>
#include <cstring>

namespace coplane
{
namespace
{
void save(const Solver& solver, const std::string& file, const Comm& comm)
{
  CheckpointWriter out(comm);
  solver.save(out);
  out.write(file, solver.clock().cycle, solver.clock().time);
}

using Maker = std::function<Model(const Comm&, const std::string&)>;

void expectSameBits(const Maker& make, int total, const std::vector<int>& stops)
{
  const Comm comm;
  const TestFolder folder(comm);
  Solver straight(make(comm, "multijagged"), comm);
  straight.prepare();
  std::int64_t planes = 0;
  for (int cycle = 1; cycle <= total; ++cycle)
  {
    straight.advance();
    planes = std::max(planes, std::int64_t(straight.contact().counts().planes));
    for (const int stop : stops)
      if (cycle == stop)
        save(straight, folder / std::to_string(stop), comm);
  }
  EXPECT_GT(planes, 0);
  const EnergyBalance expected = straight.energy();
  for (const int stop : stops)
  {
    const std::string file = folder / std::to_string(stop);
    const CheckpointReader in(file, comm);
    Solver again(make(comm, "rcb"), comm);
    again.restore(in);
    // What is saved is restored.
    save(again, file + ".again", comm);
    EXPECT_TRUE(contentOf(file) == contentOf(file + ".again")) << "cycle " << stop;
    cycles(again, total - stop);
    EXPECT_EQ(again.stateHash(), straight.stateHash()) << "from cycle " << stop;
    EXPECT_EQ(again.searches(), straight.searches());
    const EnergyBalance energy = again.energy();
    EXPECT_EQ(std::memcmp(&energy, &expected, sizeof energy), 0) << "from cycle " << stop;
    const Momenta a = again.momenta(), b = straight.momenta();
    EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0) << "from cycle " << stop;
    EXPECT_EQ(again.erosion().elements, straight.erosion().elements);
    EXPECT_EQ(again.erosion().mass, straight.erosion().mass);
  }
}
} // namespace

TEST(Restart, ofSlidingCubesHasTheBitsOfTheStraightRun)
{
  expectSameBits([](const Comm& comm, const std::string& method)
                 { return slidingCubes(comm, method); },
                 40, {1, 5, 18, 39});
}

TEST(Restart, withScaledMassesHasTheBitsOfTheStraightRun)
{
  expectSameBits(
      [](const Comm& comm, const std::string& method)
      {
        Model model = slidingCubes(comm, method);
        model.time.massScaling = MassScalingOptions{6e-4, 100};
        return model;
      },
      40, {1, 5, 18, 39});
}

TEST(Restart, withSubstepsHasTheBitsOfTheStraightRun)
{
  expectSameBits(
      [](const Comm& comm, const std::string& method)
      {
        Mesh mesh;
        addBox(mesh, "lower", {8, 8, 8}, {0, 0, 0}, {1, 1, 1});
        for (Vec3& x : mesh.coordinates)
          if (x.z == 0.875 && x.x < 0.3 && x.y < 0.3)
            x.z = 0.97; // thin elements in contact
        addBox(mesh, "upper", {2, 2, 3}, {0.05, 0.0625, 1}, {0.4, 0.4, 0.5});
        Model model = rockModel(mesh, comm, 0.25, method);
        model.blocks[1].velocity = {0.5, 0.25, -1};
        model.conditions.symmetries = {
            {ownedNodesWhere(model.mesh, [](const Vec3& x) { return x.x == 0; }), {1, 0, 0}}};
        model.time.subcyclingLevels = 4;
        return model;
      },
      50, {1, 5, 18, 19, 20, 21, 49});
}

TEST(Restart, givesPlanesToThosePairsThatHadOne)
{
  const Comm comm;
  const TestFolder folder(comm);
  const std::string file = folder / "some.chk";
  Solver straight(slidingCubes(comm), comm);
  straight.prepare();
  cycles(straight, 10);
  save(straight, file, comm);
  const auto planes = [&](const Solver& solver)
  {
    const PlaneList& all = solver.contact().planes();
    std::int64_t count = 0;
    for (std::size_t p = 0; p < all.size(); ++p)
      count += all[p].countedHere;
    return comm.sum(count);
  };
  const CheckpointReader in(file, comm);
  const std::int64_t written = in.rowCount("contact/planes"), bare = in.rowCount("contact/pairs");
  EXPECT_EQ(written + bare, straight.contact().counts().slots);
  EXPECT_GE(written, planes(straight)); // and pairs that would take something over
  EXPECT_GT(planes(straight), 0);
  EXPECT_GT(bare, 0);
  Solver again(slidingCubes(comm), comm);
  again.restore(in);
  EXPECT_EQ(planes(again), written);
  EXPECT_EQ(again.contact().counts().slots, straight.contact().counts().slots);
}

TEST(Restart, keepsReactions)
{
  const Comm comm;
  const TestFolder folder(comm);
  const auto make = [&](const char* method)
  {
    Model model = slidingCubes(comm, method);
    PrescribedVelocity foot;
    foot.nodes = ownedNodesWhere(model.mesh, [](const Vec3& x) { return x.z == 0; });
    model.conditions.velocities = {foot};
    return model;
  };
  const auto total = [&](const Solver& solver)
  {
    std::vector<ExactSum> sums(1);
    for (int n = 0; n < solver.layout().owned(); ++n)
      sums[0].add(solver.reaction(n).z);
    return ExactSum::overRanks(sums, comm)[0];
  };
  Solver straight(make("multijagged"), comm);
  straight.prepare();
  cycles(straight, 20);
  save(straight, folder / "held", comm);
  Solver again(make("rcb"), comm);
  again.restore(CheckpointReader(folder / "held", comm));
  EXPECT_GT(std::abs(total(straight)), 1e4);
  EXPECT_EQ(total(again), total(straight));
}

TEST(Restart, withErosionRigidBodiesLoadsAndDampingHasTheBitsOfTheStraightRun)
{
  const Comm comm;
  Solver solver(everything(comm), comm);
  solver.prepare();
  cycles(solver, 60);
  EXPECT_GT(solver.erosion().elements, 0); // else the claim would be an empty one
  EXPECT_EQ(solver.rigidBodies().count(), 1);
  expectSameBits(everything, 60, {2, 23, 45, 58});
}

TEST(Restart, readsACheckpointOfManyRanksOnOne)
{
  const Comm comm, alone(MPI_COMM_SELF);
  const TestFolder folder(comm);
  const std::string file = folder / "one.chk";
  Solver straight(slidingCubes(comm), comm);
  straight.prepare();
  cycles(straight, 10);
  save(straight, file, comm);
  cycles(straight, 20);
  const std::uint64_t expected = straight.stateHash();
  if (!comm.isRoot())
    return;
  const CheckpointReader in(file, alone);
  Solver again(slidingCubes(alone), alone);
  again.restore(in);
  cycles(again, 20);
  EXPECT_EQ(again.stateHash(), expected);
}

TEST(Restart, refusesACheckpointOfAnotherMesh)
{
  const Comm comm;
  const TestFolder folder(comm);
  const std::string file = folder / "other.chk";
  Solver small(rockModel(unitBox(1, 1, 1), comm), comm);
  small.prepare();
  save(small, file, comm);
  const CheckpointReader in(file, comm);
  Solver other(slidingCubes(comm), comm);
  try
  {
    other.restore(in);
    ADD_FAILURE() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Checkpoint);
    EXPECT_TRUE(error.onAllRanks());
  }
}
} // namespace coplane
