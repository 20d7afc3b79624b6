#include "Rig.hpp"

#include <gtest/gtest.h>

// What searches have to find, and what they should leave alone.

namespace coplane
{
namespace
{
struct SearchAhead : WithForces
{
};
INSTANTIATE_TEST_SUITE_P(, SearchAhead, WithForces::both(), WithForces::name);
} // namespace

TEST_P(SearchAhead, bodiesThatPassTheSkinInOneStepMeetAtTheirSurfaces)
{
  // Waves run at 1095 m/s through elements of 0.5 m: by motion a step is 0.125 ms, in which 800 m/s
  // are 0.1 m, twice the skin of slow bodies. From gaps of all parts of a step, as the first step
  // closes them too.
  const Comm comm;
  for (const int dimension : {2, 3})
    for (const Real gap : {0.06, 0.15, 0.26, 0.3, 0.34, 0.38})
      for (const Real common : {0.0, 2000.0})
      {
        SCOPED_TRACE(testing::Message() << dimension << "D, " << gap << " m, " << common << " m/s");
        Mesh mesh;
        const Vec3 up = dimension == 3 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
        if (dimension == 3)
        {
          addBox(mesh, "lower", {2, 2, 2}, {0, 0, 0}, {1, 1, 1});
          addBox(mesh, "upper", {2, 2, 2}, {0.125, 0.0625, 1 + gap}, {1, 1, 1});
        }
        else
        {
          addRectangle(mesh, "lower", {2, 2}, {0, 0, 0}, {1, 1, 0});
          addRectangle(mesh, "upper", {2, 2}, {0.125, 1 + gap, 0}, {1, 1, 0});
        }
        Model model = rockModel(mesh, comm);
        for (BlockSetup& block : model.blocks)
          block.velocity = {common, 0, 0};
        model.blocks[1].velocity -= 800.0 * up;
        Solver solver(std::move(model), comm);
        solver.prepare();
        EXPECT_GT(solver.contact().skin(), 800 * solver.clock().nextStep);
        std::vector<std::int64_t> met(3, 0); // planes, those without traction, those found late
        while (met[0] == 0 && solver.clock().cycle < 5)
        {
          solver.advance();
          met.assign(3, 0);
          for (std::size_t p = 0; p < solver.contact().planes().size(); ++p)
          {
            const Plane& plane = solver.contact().planes()[p];
            if (!plane.countedHere || !(plane.isBorn() || plane.refusal == Refusal::Deep ||
                                        plane.sighting == Sighting::FoundLate))
              continue;
            ++met[0];
            met[1] += !(plane.normalTraction > 0);
            met[2] += plane.sighting == Sighting::FoundLate;
          }
          comm.sum(met);
        }
        EXPECT_EQ(met[0], dimension == 3 ? 9 : 3);
        EXPECT_EQ(met[1], 0);
        EXPECT_EQ(met[2], 0);
        EXPECT_EQ(solver.contact().counts().missed, 0);
      }
}

TEST_P(SearchAhead, aBondThatIsWideOpenDoesNotWidenTheSearchOfOthers)
{
  const Comm comm;
  const auto slotsAfter = [&](bool bonded)
  {
    Mesh mesh;
    addBox(mesh, "floor", {8, 8, 1}, {0, 0, 0}, {1, 1, 0.1});
    addBox(mesh, "plate", {9, 9, 1}, {0, 0, 0.1}, {1, 1, 0.1});
    addBox(mesh, "lower", {1, 1, 1}, {5, 5, 0}, {0.5, 0.5, 0.5});
    addBox(mesh, "upper", {1, 1, 1}, {5, 5, 0.5}, {0.5, 0.5, 0.5});
    Model model = rockModel(mesh, comm);
    ContactRules& rules = model.contactRules;
    JointRecipe bond;
    bond.law.bond = Bond::softening(Bond::Kind::Exponential, 1e3, 1e3, 200, 200);
    rules.joints.push_back(bond);
    for (const int i : {2 * 4 + 3, 3 * 4 + 2})
    {
      rules.table[i].declared = bonded;
      rules.table[i].joint = 1;
    }
    model.blocks[3].velocity = {0, 0, 30};
    model.skin = 0.01;
    Solver solver(std::move(model), comm);
    solver.prepare();
    while (solver.clock().time < 0.01)
      solver.advance();
    const ContactCounts counts = solver.contact().counts();
    EXPECT_EQ(counts.stick, bonded ? 1 : 0); // 0.3 m open
    return counts.slots;
  };
  EXPECT_EQ(slotsAfter(true), slotsAfter(false) + 1);
}
} // namespace coplane
