#include "Rig.hpp"

#include <coplane_dynamics/FreeField.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace coplane
{
namespace
{
constexpr Real rockDensity = 1000, rockModulus = 1e9;

template <class Side>
void giveImpedances(Side& side)
{
  const Material rock = makeLinearElastic(rockModulus, 0.25, rockDensity);
  side.normalImpedance = std::sqrt(rockDensity * pWaveModulus(rock));
  side.shearImpedance = std::sqrt(rockDensity * elasticity(rock).shearModulus);
}

FreeFieldBoundary freeFieldWhere(const std::string& name, const RankMesh& mesh,
                                 const std::function<bool(const Vec3&)>& chosen)
{
  FreeFieldBoundary boundary{name, "deck:1", {}, {}};
  for (const ExteriorFace& face : exteriorFaces(mesh))
  {
    bool all = true;
    for (int k = 0; k < face.nodeCount; ++k)
      all = all && chosen(mesh.coordinates[std::size_t(face.nodes[std::size_t(k)])]);
    if (!all)
      continue;
    FreeFieldSide side{{face.id, face.nodeCount, face.nodes}, face.block, face.element};
    giveImpedances(side);
    boundary.sides.push_back(side);
  }
  return boundary;
}

AbsorbingBoundary baseWhere(const RankMesh& mesh, const std::function<bool(const Vec3&)>& chosen,
                            const VectorOfTime& incident)
{
  AbsorbingBoundary base;
  for (const LoadedSide& side : sidesWhere(mesh, chosen))
  {
    AbsorbingSide face{side};
    giveImpedances(face);
    base.sides.push_back(face);
  }
  base.incident = incident;
  return base;
}

/// Waves of all kinds, that come up.
VectorOfTime waves()
{
  const auto pulse = [](Real size, Real length) -> OfTime
  { return [=](Real t) { return t < length ? size * (1 - std::cos(2 * pi * t / length)) : 0; }; };
  return VectorOfTime({pulse(0.1, 4e-3), pulse(0.05, 5e-3), pulse(0.2, 3e-3)});
}

/// Ground of 2 x 3 x 4 m on a base into which waves come, with a free field on all sides.
Model ground(const Comm& comm, const std::string& method = "multijagged",
             const std::function<void(Mesh&)>& change = {})
{
  Mesh mesh = unitBox(2, 3, 4);
  if (change)
    change(mesh);
  Model model = rockModel(mesh, comm, 0, method);
  model.contactEnabled = false;
  Conditions& c = model.conditions;
  c.absorbing = {baseWhere(
      model.mesh, [](const Vec3& x) { return x.z == 0; }, waves())};
  const RankMesh& part = model.mesh;
  c.freeFields = {freeFieldWhere("left", part, [](const Vec3& x) { return x.x == 0; }),
                  freeFieldWhere("right", part, [](const Vec3& x) { return x.x == 2; }),
                  freeFieldWhere("front", part, [](const Vec3& x) { return x.y == 0; }),
                  freeFieldWhere("back", part, [](const Vec3& x) { return x.y == 3; })};
  return model;
}

/// Largest difference of the velocities of nodes that have stood at one height at the start.
Real unevenness(const Solver& solver)
{
  std::map<Real, std::array<Real, 6>> extremes;
  for (const Real z : {0.0, 1.0, 2.0, 3.0, 4.0})
    extremes[z] = {-infinity, -infinity, -infinity, -infinity, -infinity, -infinity};
  for (int n = 0; n < solver.layout().owned(); ++n)
    for (int c = 0; c < 3; ++c)
    {
      auto& most = extremes.at(solver.mesh().coordinates[std::size_t(n)].z);
      most[std::size_t(c)] = std::max(most[std::size_t(c)], solver.state().v(n, c));
      most[std::size_t(3 + c)] = std::max(most[std::size_t(3 + c)], -solver.state().v(n, c));
    }
  Real uneven = 0;
  for (const auto& [z, most] : extremes)
    for (std::size_t c = 0; c < 3; ++c)
      uneven = std::max(uneven, solver.comm().max(most[c]) + solver.comm().max(most[3 + c]));
  return uneven;
}

/// A state whose column "left" has another stress in its last layer.
class OtherStress : public StateTables
{
public:
  OtherStress(const Comm& comm, std::vector<std::string> columns)
      : StateTables(comm), columns_(std::move(columns))
  {
  }
  using StateTables::numbers;
  std::vector<Real> numbers(const std::string& name) const override
  {
    std::vector<Real> numbers = StateTables::numbers(name);
    const auto stress = std::find(columns_.begin(), columns_.end(), "stress.0");
    if (name == "free_field/left" && stress != columns_.end())
      *(numbers.end() - (columns_.end() - stress)) += 1;
    return numbers;
  }

private:
  std::vector<std::string> columns_;
};

/// The text by which a model is refused.
std::string refusal(const Comm& comm, const std::function<void(Model&)>& change,
                    const std::function<void(Mesh&)>& changeMesh = {})
{
  Model model = ground(comm, "multijagged", changeMesh);
  change(model);
  try
  {
    Solver solver(std::move(model), comm);
  }
  catch (const Error& error)
  {
    EXPECT_TRUE(error.onAllRanks());
    return error.what();
  }
  return "";
}
} // namespace

TEST(FreeField, groundUnderWavesFromBelowStaysLevel)
{
  const Comm comm;
  Solver solver(ground(comm), comm);
  solver.prepare();
  Real largestSpeed = 0;
  for (int i = 0; i < 60; ++i)
  {
    cycles(solver, 1);
    largestSpeed = std::max(largestSpeed, largest(solver.state().v, solver.layout().owned(), comm));
    EXPECT_LT(unevenness(solver), 1e-12);
  }
  EXPECT_GT(largestSpeed, 0.5); // twice the largest of 0.4 m/s comes up
  EXPECT_NEAR(solver.energy().error(), 0, 2e-2 * solver.energy().scale());
  EXPECT_LT(norm(solver.momenta().linearError()), 1e-12 * solver.momenta().magnitude);
  EXPECT_LT(norm(solver.momenta().angularError()), 1e-11 * solver.momenta().magnitude);
}

TEST(FreeField, whatLawsRememberIsTakenOver)
{
  // Plastic ground: flows already before the free field begins, and goes on level.
  const Comm comm;
  Model model = ground(comm);
  J2Parameters weak;
  weak.density = rockDensity;
  weak.youngsModulus = rockModulus;
  weak.poissonRatio = 0.25;
  weak.yieldStress = 2e4;
  weak.hardeningModulus = 1e8;
  model.blocks[0].material = makeLaw(weak);
  model.blocks[0].stress = {-1e6, -1e6, -1e6 - 1e4, 0, 0, 0};
  for (AbsorbingSide& side : model.conditions.absorbing[0].sides)
    side.stress = {model.blocks[0].stress, model.blocks[0].stress, model.blocks[0].stress,
                   model.blocks[0].stress};
  const SymTensor& stress = model.blocks[0].stress;
  model.conditions.pressures = {
      pressureWhere(model.mesh, -stress.zz, [](const Vec3& x) { return x.z == 4; })};
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 60);
  EXPECT_LT(unevenness(solver), 1e-11);
  EXPECT_GT(solver.energy().plastic, 1e-2 * solver.energy().kinetic);
}

TEST(FreeField, restAtTheStartIsRest)
{
  // Under gravity with a stress in balance with it: nothing moves before a wave comes.
  const Comm comm;
  Model model = ground(comm);
  model.conditions.gravity = {0, 0, -10};
  model.blocks[0].stressGradient = {{0.4e4, 0.4e4, 1e4, 0, 0, 0}, {0, 0, 4}, {0, 0, 1}};
  for (AbsorbingSide& side : model.conditions.absorbing[0].sides)
    side.stress = {model.blocks[0].stressAt({}), model.blocks[0].stressAt({}),
                   model.blocks[0].stressAt({}), model.blocks[0].stressAt({})};
  model.conditions.absorbing[0].incident = {};
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 100);
  EXPECT_LT(largest(solver.state().v, solver.layout().owned(), comm), 1e-12);
}

TEST(FreeField, takesOverTheReactionOfWhatHeldTheSide)
{
  // The same without stress in the sides: held until 0.01 s, base and sides at once. The column
  // takes the stress that the elements have.
  const Comm comm;
  Model model = ground(comm);
  model.conditions.gravity = {0, 0, -10};
  model.blocks[0].stressGradient = {{0.4e4, 0.4e4, 1e4, 0, 0, 0}, {0, 0, 4}, {0, 0, 1}};
  model.conditions.absorbing[0].incident = {};
  model.conditions.absorbing[0].when.from = 0.01;
  for (FreeFieldBoundary& boundary : model.conditions.freeFields)
    boundary.when.from = 0.01;
  PrescribedVelocity fixed;
  fixed.nodes =
      ownedNodesWhere(model.mesh, [](const Vec3& x)
                      { return x.z == 0 || x.x == 0 || x.x == 2 || x.y == 0 || x.y == 3; });
  fixed.when.until = 0.01;
  model.conditions.velocities = {fixed};
  Solver solver(std::move(model), comm);
  solver.prepare();
  while (solver.clock().time < 0.05)
    solver.advance();
  EXPECT_LT(largest(solver.state().v, solver.layout().owned(), comm), 1e-12);
}

TEST(FreeField, theHashKnowsTheElementsOfColumns)
{
  const Comm comm;
  Solver solver(ground(comm), comm);
  solver.prepare();
  cycles(solver, 20);
  StateTables same(comm);
  OtherStress other(comm, solver.blocks()[0].stateColumns());
  for (StateTables* state : {&same, static_cast<StateTables*>(&other)})
  {
    solver.save(*state);
    Solver restored(ground(comm), comm);
    restored.restore(*state);
    EXPECT_EQ(restored.stateHash() == solver.stateHash(), state == &same);
  }
}

TEST(FreeField, aColumnThatLimitsTheStepIsNamed)
{
  // Masses of the model are raised for a step that its columns do not allow.
  const Comm comm;
  Model model = ground(comm);
  {
    Model plain = ground(comm);
    Solver solver(std::move(plain), comm);
    solver.prepare();
    EXPECT_EQ(solver.stepControl().freeField, "");
    model.time.massScaling = MassScalingOptions{3 * solver.clock().nextStep, 99};
  }
  Solver solver(std::move(model), comm);
  solver.prepare();
  solver.advance(); // columns begin with the first step
  const StepControl control = solver.stepControl();
  EXPECT_EQ(control.text(), "the free-field column beside side set 'left'");
  EXPECT_NEAR(solver.clock().nextStep, solver.model().time.stepFactor * control.stableStep,
              1e-12 * control.stableStep);
}

TEST(FreeField, anotherPartitionHasTheSameBits)
{
  const Comm comm;
  Solver one(ground(comm), comm), other(ground(comm, "scattered"), comm);
  for (Solver* solver : {&one, &other})
  {
    solver->prepare();
    cycles(*solver, 20);
  }
  EXPECT_EQ(one.stateHash(), other.stateHash());
  one.repartition(ground(comm, "last"));
  for (Solver* solver : {&one, &other})
    cycles(*solver, 20);
  EXPECT_EQ(one.stateHash(), other.stateHash());
}

TEST(FreeField, sidesThatAreNoEndOfLevelGroundAreRefused)
{
  const Comm comm;
  const auto nothing = [](Model&) {};
  const auto in = [](const std::string& text, const char* part)
  { return text.find(part) != std::string::npos; };
  EXPECT_EQ(refusal(comm, nothing), "");
  // A side that leans: gravity comes from x.
  EXPECT_PRED2(in,
               refusal(comm,
                       [](Model& m) {
                         m.conditions.gravity = {-10, 0, 0};
                       }),
               "deck:1: free-field side set 'left'");
  EXPECT_PRED2(in,
               refusal(comm,
                       [](Model& m) {
                         m.conditions.gravity = {-10, 0, 0};
                       }),
               "leans by 90 degrees");
  EXPECT_PRED2(in,
               refusal(comm,
                       [](Model& m)
                       {
                         m.conditions.freeFields[0] = freeFieldWhere(
                             "left", m.mesh, [](const Vec3& x) { return x.x == 0 || x.y == 0; });
                       }),
               "away from the plane");
  EXPECT_PRED2(in,
               refusal(comm,
                       [](Model& m)
                       {
                         m.conditions.freeFields[0] = freeFieldWhere(
                             "left", m.mesh,
                             [](const Vec3& x) { return x.x == 0 && (x.z <= 2 || x.y <= 1); });
                       }),
               "m wide at its foot");
  EXPECT_PRED2(in, refusal(comm, [](Model& m) { m.blocks[0].rigid = true; }), "is rigid");
  EXPECT_PRED2(in, refusal(comm, [](Model& m) { m.absentBlocks = {0}; }),
               "is not there at the start");
  EXPECT_PRED2(in, refusal(comm, [](Model& m) { m.conditions.freeFields[0].sides.clear(); }),
               "has no sides");
  EXPECT_PRED2(in, refusal(comm, [](Model& m) { m.conditions.freeFields[1].name = "left"; }),
               "has a free field already");
  // Rows of nodes that are not level.
  EXPECT_PRED2(in,
               refusal(comm, nothing,
                       [](Mesh& mesh)
                       {
                         for (Vec3& x : mesh.coordinates)
                           if (x.z > 0 && x.z < 4 && x.y == 1)
                             x.z += 0.1;
                       }),
               "accepted: nodes in rows of one height");
}

TEST(FreeField, jointsThatEndInTheSideAreRefused)
{
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "lower", {2, 2, 2}, {0, 0, 0}, {1, 1, 1});
  addBox(mesh, "upper", {2, 2, 2}, {0, 0, 1}, {1, 1, 1});
  Model model = rockModel(mesh, comm);
  model.conditions.freeFields = {
      freeFieldWhere("left", model.mesh, [](const Vec3& x) { return x.x == 0; })};
  try
  {
    Solver solver(std::move(model), comm);
    FAIL() << "not refused";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("a joint ends there"), std::string::npos)
        << error.what();
  }
}
} // namespace coplane
