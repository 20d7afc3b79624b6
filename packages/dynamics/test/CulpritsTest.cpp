#include "Rig.hpp"

#include <coplane_mesh/FaceName.hpp>

#include <gtest/gtest.h>

namespace coplane
{
TEST(StepControl, namesAnElementAroundItsNode)
{
  const Comm comm;
  Solver solver(slidingCubes(comm), comm);
  solver.prepare();
  const StepControl control = solver.stepControl();
  EXPECT_FALSE(control.contact);
  EXPECT_EQ(control.text(), fmt::format("element {} at node {}", control.element, control.node));
  // The rank that holds the element finds the node among its corners.
  std::int64_t found = 0;
  for (const RankMesh::Block& block : solver.mesh().blocks)
    for (int e = 0; e < block.elements(); ++e)
      for (int k = 0; k < 8; ++k)
        if (block.elementIds[e] == control.element &&
            solver.mesh().nodeIds[block.connectivity[8 * e + k]] == control.node)
          found = 1;
  EXPECT_EQ(comm.max(found), 1);
}

TEST(StepControl, namesThePairThatLimitsTheStep)
{
  // A joint a hundred times as stiff as the elements behind it.
  const Comm comm;
  Model model = slidingCubes(comm);
  model.contactRules.joints[0].law.stiffnessFraction = 100;
  Solver solver(std::move(model), comm);
  solver.prepare();
  const StepControl control = solver.stepControl();
  EXPECT_TRUE(control.contact);
  EXPECT_EQ(control.text(), fmt::format("contact at node {}, most by {} against {}", control.node,
                                        faceName(control.faceId[0]), faceName(control.faceId[1])));
  // One of the two faces has the node: elements 1-8 lie below, 9-16 above.
  EXPECT_LE(elementOfFace(control.faceId[0]), 8);
  EXPECT_GE(elementOfFace(control.faceId[1]), 9);
  std::int64_t found = 0;
  for (const Face& face : solver.contact().faces())
    for (int k = 0; k < face.count; ++k)
      if ((face.id == control.faceId[0] || face.id == control.faceId[1]) &&
          solver.layout().ids()[face.nodes[k]] == control.node)
        found = 1;
  EXPECT_EQ(comm.max(found), 1);
  // The same on any number of ranks.
  const Comm self(MPI_COMM_SELF);
  Model again = slidingCubes(self);
  again.contactRules.joints[0].law.stiffnessFraction = 100;
  Solver one(std::move(again), self);
  one.prepare();
  EXPECT_EQ(one.stepControl().text(), control.text());
}

TEST(WorstEntities, nameTheDeepestPlanesTheSameOnAnyNumberOfRanks)
{
  const Comm comm, self(MPI_COMM_SELF);
  Solver many(slidingCubes(comm), comm), one(slidingCubes(self), self);
  for (Solver* solver : {&many, &one})
  {
    solver->prepare();
    cycles(*solver, 5);
  }
  // The deepest of all, counted by hand.
  Real deepest = 0;
  for (std::size_t p = 0; p < one.contact().planes().size(); ++p)
    if (const Plane& plane = one.contact().planes()[p]; plane.area > 0)
      deepest = std::max(deepest, plane.closure / plane.depthLimit);
  ASSERT_GT(deepest, 0);
  const std::string text = many.worstEntities();
  EXPECT_EQ(text, one.worstEntities());
  EXPECT_NE(text.find(fmt::format("m deep, {:.3g} of its limit", deepest)), std::string::npos)
      << text;
  EXPECT_NE(text.find("J unexplained"), std::string::npos) << text;
}

TEST(WorstEntities, nameThePlanesThatHavePassedTheStiffnessCap)
{
  // A hyperbola that ends at 0.5 mm and is as steep as its cap from half of that on, at 0.5 MPa:
  // 20 kPa do not close it so far, 1 MPa does.
  const Comm comm;
  for (const Real pressure : {2e4, 1e6})
  {
    Model model = slidingCubes(comm);
    model.blocks[1].velocity = {};
    JointLaw& law = model.contactRules.joints[0].law;
    law.penalty = false;
    law.initialStiffness = 1e9;
    law.curve.inverseMaximumClosure = 2e3;
    law.stiffnessCap = 4e9;
    model.conditions.pressures = {
        pressureWhere(model.mesh, pressure, [](const Vec3& x) { return x.z == 0 || x.z > 1.9; })};
    model.time.end = 3e-3;
    Solver solver(std::move(model), comm);
    solver.prepare();
    testing::internal::CaptureStderr();
    testing::internal::CaptureStdout();
    Recorder recorder;
    solver.run(recorder);
    std::string told = testing::internal::GetCapturedStderr();
    told += testing::internal::GetCapturedStdout();
    if (!comm.isRoot())
      continue;
    EXPECT_EQ(told.find("planes have reached joints.stiffness_cap") != std::string::npos,
              pressure > 1e5)
        << told;
    EXPECT_EQ(told.find("cap 4.000e+09 Pa/m") != std::string::npos, pressure > 1e5) << told;
    EXPECT_EQ(told.find("plane between side") != std::string::npos, pressure > 1e5) << told;
  }
}
} // namespace coplane
