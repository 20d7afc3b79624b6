#include "Rig.hpp"

#include <coplane_dynamics/detail/NearestOnFace.hpp>

#include <gtest/gtest.h>

#include <random>

namespace coplane
{
namespace
{
/// The second block dies at once: the ends of its element part by 1e-4 in the first steps.
/// @param middle height of its middle [m]
Model dying(const Mesh& mesh, const Comm& comm, const Vec3& velocity, Real middle)
{
  Model model = rockModel(mesh, comm);
  model.blocks[1].velocity = velocity;
  model.blocks[1].velocityField = [middle](const Vec3& x) { return Vec3{0, 0, x.z - middle}; };
  model.blocks[1].erosion.volumeRatio = {0.5, 1 + 1e-6};
  model.debris = true;
  return model;
}

/// A block of 2 x 2 x 2 m, and a cube of one element that dies at once: its corners go
/// on as eight points.
Model dyingCube(const Comm& comm, const Vec3& corner, Real edge, const Vec3& velocity)
{
  Mesh mesh;
  addBox(mesh, "block", {4, 4, 4}, {0, 0, 0}, {2, 2, 2});
  addBox(mesh, "cube", {1, 1, 1}, corner, {edge, edge, edge});
  return dying(mesh, comm, velocity, corner.z + 0.5 * edge);
}

/// It is as wide as 1 m, above the block, and falls on it.
Model fallingCorners(const Comm& comm, const Vec3& velocity = {0, 0, -20})
{
  return dyingCube(comm, {0.37, 0.41, 2.05}, 1, velocity);
}

/// Largest square of the distance that moving along an edge of the natural square can still gain.
Real gainAround(int corners, const Vec3* c, const Vec3& x, const NearestOnFace& nearest)
{
  Real best = dot(nearest.way, nearest.way);
  constexpr int samples = 60;
  for (int i = 0; i <= samples; ++i)
    for (int j = 0; j <= (corners == 2 ? 0 : samples); ++j)
    {
      const Real s = Real(i) / samples, t = Real(j) / samples;
      std::array<Real, 4> w{};
      if (corners == 2)
        w = {1 - s, s, 0, 0};
      else if (corners == 3)
        w = {1 - s, s * (1 - t), s * t, 0};
      else
        w = {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
      Vec3 way{};
      for (int k = 0; k < corners; ++k)
        way += w[std::size_t(k)] * (c[k] - x);
      best = std::min(best, dot(way, way));
    }
  return dot(nearest.way, nearest.way) - best;
}
} // namespace

TEST(NearestOnFace, isNoFartherThanAnyOtherPlace)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<Real> unit(-1, 1);
  for (int trial = 0; trial < 300; ++trial)
    for (const int corners : {2, 3, 4})
    {
      // Slightly twisted squares, far from the origin.
      const Vec3 far{100, -50, 20};
      Vec3 c[4] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
      for (Vec3& corner : c)
        corner += far + 0.15 * Vec3{unit(random), unit(random), unit(random)};
      const Vec3 x = far + Vec3{2 * unit(random), 2 * unit(random), 0.5 * unit(random)};
      const NearestOnFace nearest = nearestOnFace(corners, c, x);
      Real sum = 0;
      Vec3 place{};
      for (int k = 0; k < corners; ++k)
      {
        const Real weight = nearest.weights[std::size_t(k)];
        EXPECT_GE(weight, 0);
        sum += weight;
        place += weight * c[k];
      }
      EXPECT_NEAR(sum, 1, 1e-14);
      EXPECT_LT(norm(place - x - nearest.way), 1e-13);
      EXPECT_LT(gainAround(corners, c, x, nearest), 1e-12) << corners;
    }
}

TEST(NearestOnFace, isTheFootOfAPointAboveIt)
{
  const Vec3 c[4] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  const NearestOnFace nearest = nearestOnFace(4, c, {0.5, 1.5, -0.25});
  EXPECT_NEAR(nearest.way.z, 0.25, 1e-15);
  EXPECT_NEAR(nearest.weights[3], 0.75 * 0.75, 1e-14);
  const NearestOnFace edge = nearestOnFace(4, c, {2.5, 1, 0});
  EXPECT_NEAR(edge.way.x, -0.5, 1e-14);
}

TEST(Debris, bouncesWithItsMomentaAndItsEnergy)
{
  const Comm comm;
  Solver solver(fallingCorners(comm), comm);
  solver.prepare();
  std::int64_t mostTouching = 0;
  Real mostStored = 0;
  for (int n = 0; n < 400; ++n)
  {
    solver.advance();
    mostTouching = std::max(mostTouching, solver.debris()->touching());
    const EnergyBalance energy = solver.energy();
    mostStored = std::max(mostStored, energy.debris.stored);
    ASSERT_LT(std::abs(energy.error()), 2e-3 * energy.initial) << n;
    ASSERT_LT(norm(solver.momenta().linearError()), 1e-12 * solver.momenta().magnitude);
    ASSERT_LT(norm(solver.momenta().angularError()), 1e-12 * solver.momenta().magnitude);
  }
  ASSERT_EQ(solver.erosion().elements, 1);
  EXPECT_EQ(solver.debris()->count(), 8);
  EXPECT_GE(mostTouching, 4);
  const EnergyBalance energy = solver.energy();
  EXPECT_GT(mostStored, 0.1 * energy.initial);
  // A contact that begins or ends within a step: of second order in it, as below.
  EXPECT_LT(std::abs(energy.debris.remainder()), 1.5e-2 * energy.initial);
  // What hit the block flies up; a point of 125 kg on nodes of as much loses some of its speed.
  Real lowest = 0, highest = 0;
  for (int n = 0; n < solver.layout().owned(); ++n)
    if (solver.layout().ids()[std::size_t(n)] > 125)
    {
      lowest = std::min(lowest, solver.state().v(n, 2));
      highest = std::max(highest, solver.state().v(n, 2));
    }
  EXPECT_GT(comm.max(highest), 1);
}

TEST(Debris, pointsThatComeFromWithinABodyFlyOutOfIt)
{
  // In the middle of the block no element has an exterior face.
  const Comm comm;
  const Vec3 velocity{30, 20, 10};
  Solver solver(dyingCube(comm, {0.87, 0.91, 0.93}, 0.2, velocity), comm);
  solver.prepare();
  while (solver.clock().time < 0.06)
  {
    solver.advance();
    ASSERT_EQ(solver.debris()->touching(), 0) << solver.clock().cycle;
  }
  EXPECT_EQ(solver.debris()->count(), 8);
  EXPECT_LT(std::abs(solver.energy().debris.remainder()), 1e-12 * solver.energy().initial);
  Real slowest = infinity;
  for (int n = 0; n < solver.layout().owned(); ++n)
    if (solver.layout().ids()[std::size_t(n)] > 125)
    {
      EXPECT_NEAR(solver.state().v(n, 0), velocity.x, 1e-9);
      slowest = std::min(slowest, solver.state().x(n, 0));
    }
  EXPECT_GT(-comm.max(-slowest), 2); // all are out
}

namespace
{
/// A block in two halves with a gap between them at x = 1 m, and a small cube that dies above them.
Model aboveTwoHalves(const Comm& comm, Real gap, Real x, const Vec3& velocity)
{
  Mesh mesh;
  addBox(mesh, "left", {2, 4, 4}, {0, 0, 0}, {1, 2, 2});
  addBox(mesh, "right", {2, 4, 4}, {1 + gap, 0, 0}, {1, 2, 2});
  addBox(mesh, "cube", {1, 1, 1}, {x, 0.91, 2.05}, {0.1, 0.1, 0.1});
  Model model = rockModel(mesh, comm);
  model.blocks[2].velocity = velocity;
  model.blocks[2].velocityField = [](const Vec3& x) { return Vec3{0, 0, x.z - 2.1}; };
  model.blocks[2].erosion.volumeRatio = {0.5, 1 + 1e-6};
  model.debris = true;
  return model;
}
} // namespace

namespace
{
void runUntil(Solver& solver, Real time)
{
  solver.prepare();
  while (solver.clock().time < time)
    solver.advance();
}

/// The corners of the cube have come back from the block with their speed upwards, 10 m/s and what
/// parts them.
/// @param first their nodes come after this id
void expectThrownBack(const Solver& solver, GlobalId first, const Vec3& along)
{
  EXPECT_EQ(solver.debris()->count(), 8);
  EXPECT_EQ(solver.debris()->touching(), 0);
  for (int n = 0; n < solver.layout().owned(); ++n)
    if (solver.layout().ids()[std::size_t(n)] > first)
    {
      const Real before = 10 - (solver.state().reference(n, 2) - 2.1);
      EXPECT_NEAR(solver.state().v(n, 2), before, 0.03 * before);
      EXPECT_NEAR(solver.state().v(n, 0), along.x, 0.05);
      EXPECT_NEAR(solver.state().v(n, 1), along.y, 0.05);
    }
}
} // namespace

TEST(Debris, bouncesOffTwoHalvesAsOffTheWhole)
{
  // Half of the points come down 1 mm beside the seam, over which another half lies flush, or a
  // hair apart: that is no way out, however near it is. Or they cross it while they are deep.
  const Comm comm;
  for (const Real gap : {0.0, 1e-4, -1e-4})
    for (const auto& [x, along] : {std::pair(0.999, 0.0), std::pair(0.975, 5.0)})
    {
      SCOPED_TRACE(testing::Message() << "gap " << gap << ", x " << x);
      Solver solver(aboveTwoHalves(comm, gap, x, {along, 0, -10}), comm);
      runUntil(solver, 0.03);
      expectThrownBack(solver, 150, {along, 0, 0});
    }
}

TEST(Debris, keepsItsEnergyInAHairBetweenBodies)
{
  // Points cross a gap of 0.1 mm while they are deep, so slowly that they come to lie in it, in no
  // element.
  const Comm comm;
  Solver solver(aboveTwoHalves(comm, 1e-4, 0.9982, {0.3, 0, -10}), comm);
  runUntil(solver, 0.03);
  EXPECT_EQ(solver.debris()->count(), 8);
  EXPECT_EQ(solver.debris()->touching(), 0);
  for (int n = 0; n < solver.layout().owned(); ++n)
    if (solver.layout().ids()[std::size_t(n)] > 150)
    {
      EXPECT_NEAR(solver.state().v(n, 2), 10, 0.5);
    }
}

TEST(Debris, staysBetweenBodiesWhereItCameIn)
{
  // In a joint of 4 mm, which is narrow enough for the halves to lie on each other's faces, points
  // fly to and fro.
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "left", {2, 4, 4}, {0, 0, 0}, {1, 2, 2});
  addBox(mesh, "right", {2, 4, 4}, {1.004, 0, 0}, {1, 2, 2});
  addBox(mesh, "cube", {1, 1, 1}, {1.001, 0.91, 1.05}, {0.002, 0.002, 0.002});
  Model model = rockModel(mesh, comm);
  model.blocks[2].velocity = {2, 0, 0};
  model.blocks[2].velocityField = [](const Vec3& x) { return Vec3{0, 0, x.z - 1.051}; };
  model.blocks[2].erosion.volumeRatio = {0.5, 1 + 1e-6};
  model.debris = true;
  Solver solver(std::move(model), comm);
  solver.prepare();
  std::int64_t touched = 0;
  while (solver.clock().time < 0.02)
  {
    solver.advance();
    touched += solver.debris()->touching();
    for (int n = 0; n < solver.layout().owned(); ++n)
      if (solver.layout().ids()[std::size_t(n)] > 150)
      {
        ASSERT_GT(solver.state().x(n, 0), 0.998) << solver.clock().cycle;
        ASSERT_LT(solver.state().x(n, 0), 1.006) << solver.clock().cycle;
      }
  }
  EXPECT_EQ(solver.debris()->count(), 8);
  EXPECT_GT(touched, 0);
  EXPECT_LT(std::abs(solver.energy().debris.remainder()), 0.1 * solver.energy().initial);
}

TEST(Debris, getsNoEnergyFromAWayOutThatOpensAndCloses)
{
  // Bodies that are nearer to a face than 5 mm lie on it. The right half comes and goes over that
  // limit, four times while points are in the left one, and takes what they have stored.
  const Comm comm;
  Model model = aboveTwoHalves(comm, 0.005, 0.998, {0, 0, -100});
  model.blocks[1].rigid = true;
  model.rigidBodyOfNode = rigidBodiesOf(model.mesh, {0, 1, 0}, comm);
  const Real frequency = 2 * 3.14159265358979323846 / 5e-4;
  RigidMotion motion;
  motion.block = 1;
  motion.components = {true, true, true};
  motion.velocity = {[=](Real t) { return 5e-4 * frequency * std::cos(frequency * t); },
                     [](Real) { return 0.0; }, [](Real) { return 0.0; }};
  motion.spin = VectorOfTime(0, 0, 0);
  model.conditions.rigidMotions = {std::move(motion)};
  Solver solver(std::move(model), comm);
  runUntil(solver, 0.01);
  ASSERT_EQ(solver.debris()->count(), 8);
  EXPECT_GT(solver.energy().debris.remainder(), 0.01 * solver.energy().initial);
}

TEST(Debris, aLightPointIsThrownBackWithItsSpeed)
{
  // 0.125 kg on nodes of 30 to 125 kg, at a hundredth of the speed of waves, without friction.
  const Comm comm;
  Solver solver(dyingCube(comm, {0.87, 0.91, 2.05}, 0.1, {0.5, 0.25, -10}), comm);
  runUntil(solver, 0.03);
  expectThrownBack(solver, 125, {0.5, 0.25, 0});
}

TEST(Debris, itsRemainderVanishesWithTheStep)
{
  const Comm comm;
  Model model = fallingCorners(comm);
  model.time.fixedStep = 4e-5; // about a sixth of the usual one
  Solver solver(std::move(model), comm);
  solver.prepare();
  std::int64_t touched = 0;
  for (int n = 0; n < 400; ++n)
  {
    solver.advance();
    touched += solver.debris()->touching();
  }
  EXPECT_GT(touched, 100);
  EXPECT_EQ(solver.debris()->touching(), 0);
  const EnergyBalance energy = solver.energy();
  EXPECT_LT(std::abs(energy.debris.remainder()), 1e-3 * energy.initial);
}

TEST(Debris, onARidgeIsPushedByBothSidesOfTheRoof)
{
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "block", {4, 4, 4}, {-1, -1, -1}, {2, 2, 2});
  for (Vec3& x : mesh.coordinates)
    x = {std::sqrt(0.5) * (x.x - x.z), x.y, std::sqrt(0.5) * (x.x + x.z)};
  const Real ridge = std::sqrt(2.0);
  addBox(mesh, "cube", {1, 1, 1}, {0, -0.6, ridge + 0.01}, {3, 1, 3}); // two edges over the ridge
  const int first = 125;
  Solver solver(dying(mesh, comm, {0, 0, -20}, ridge + 1.51), comm);
  solver.prepare();
  cycles(solver, 100);
  ASSERT_EQ(solver.debris()->count(), 8);
  int pushed = 0;
  for (int n = 0; n < solver.layout().owned(); ++n)
    if (solver.layout().ids()[std::size_t(n)] > first && solver.state().x(n, 0) < 1)
    {
      EXPECT_LT(std::abs(solver.state().v(n, 0)), 1e-9);
      pushed += solver.state().v(n, 2) > -15;
    }
  EXPECT_EQ(comm.sum(pushed), 2);
}

namespace
{
/// A plate, or a quarter of it, and dust above each quarter that flies over the middle and falls.
struct Dusty
{
  Mesh mesh;
  Model model;
  Dusty(
      bool whole, const Comm& comm, Real side = 1,
      const std::function<Vec3(const Vec3&)>& turned = [](const Vec3& v) { return v; },
      const Vec3& shift = {}, bool inPlane = false)
  {
    addBox(mesh, "block", {whole ? 4 : 2, whole ? 4 : 2, 2},
           {whole ? -1.0 : 0, whole ? -1.0 : 0, -1}, {whole ? 2.0 : 1, whole ? 2.0 : 1, 1});
    const std::vector<Real> halves = whole ? std::vector<Real>{0.3, -0.5} : std::vector<Real>{0.3};
    for (const Real x : halves)
      for (const Real y : inPlane ? std::vector<Real>{0} : halves)
        addBox(mesh, "dust", {1, 1, 1}, {x, y, 0.02}, {0.2, 0.2, 0.2});
    const Mesh straight = mesh;
    for (Vec3& x : mesh.coordinates)
      x = turned(x) + shift;
    model = rockModel(mesh, comm);
    for (std::size_t b = 1; b < model.blocks.size(); ++b)
    {
      const Real x = straight.coordinates[std::size_t(straight.blocks[b].connectivity[0])].x,
                 y = straight.coordinates[std::size_t(straight.blocks[b].connectivity[0])].y;
      model.blocks[b].velocity = turned({x > 0 ? -700.0 : 700,
                                         inPlane ? 0
                                         : y > 0 ? -500.0
                                                 : 500,
                                         -20});
      model.blocks[b].velocityField = [=](const Vec3& at) {
        return 1.0 * dot(turned({0, 0, 1}), at - shift) * turned({0, 0, 1});
      };
      model.blocks[b].erosion.volumeRatio = {0.5, 1 + 1e-6};
    }
    for (const Vec3& normal : {Vec3{1, 0, 0}, Vec3{0, 1, 0}})
      if (!whole)
      {
        std::vector<int> nodes;
        for (int n = 0; n < model.mesh.ownedNodes; ++n)
          if (std::abs(dot(turned(normal), model.mesh.coordinates[std::size_t(n)] - shift)) < 1e-9)
            nodes.push_back(n);
        model.conditions.symmetries.push_back({nodes, side * turned(normal)});
      }
    model.debris = true;
    model.time.stepFactor = 0.1;
  }
};
} // namespace

TEST(Debris, beyondPlanesOfSymmetryMeetsWhatItsImageMeets)
{
  const Comm comm = Comm::alone();
  const auto turned = [](const Vec3& v)
  {
    return Vec3{0.6 * v.x - 0.8 * v.y, 0.8 * (0.8 * v.x + 0.6 * v.y) - 0.6 * v.z,
                0.6 * (0.8 * v.x + 0.6 * v.y) + 0.8 * v.z};
  };
  const auto same = [](const Vec3& v) { return v; };
  struct Case
  {
    Real side;
    std::function<Vec3(const Vec3&)> turned;
    Vec3 shift;
  };
  Dusty all(true, comm);
  const Mesh mesh = all.mesh;
  Solver whole(std::move(all.model), comm);
  whole.prepare();
  while (whole.clock().time < 1.8e-3)
    whole.advance();
  ASSERT_EQ(whole.debris()->count(), 32);
  for (const Case& one : {Case{1, same, {}}, Case{-1, same, {}}, Case{1, turned, {3, -2, 5}}})
  {
    Dusty part(false, comm, one.side, one.turned, one.shift);
    const Mesh partMesh = part.mesh;
    Solver quarter(std::move(part.model), comm);
    quarter.prepare();
    while (quarter.clock().time < 1.8e-3)
      quarter.advance();
    ASSERT_EQ(quarter.debris()->count(), 8);
    int pushed = 0;
    for (int k = 0; k < 8; ++k)
    {
      const int mine = partMesh.blocks[1].connectivity[std::size_t(k)],
                its = mesh.blocks[1].connectivity[std::size_t(k)];
      const Vec3 v = at(quarter.state().v, mine), wanted = one.turned(at(whole.state().v, its));
      EXPECT_LT(norm(v - wanted), 1e-9 * norm(wanted)) << k;
      pushed += at(whole.state().v, its).z > -15 && at(whole.state().x, its).x < -0.1 &&
                at(whole.state().x, its).y < -0.1;
    }
    EXPECT_EQ(pushed, 4); // the lower ones, beyond both planes
    const Momenta momenta = quarter.momenta();
    EXPECT_LT(norm(momenta.linearError()), 1e-12 * momenta.magnitude);
    EXPECT_LT(norm(momenta.angularError()), 1e-11 * momenta.magnitude);
  }
}

TEST(Debris, inAPlaneOfSymmetryCrossesAnotherAndIsStopped)
{
  const Comm comm = Comm::alone();
  const Real angle = 0.3;
  const auto turned = [=](const Vec3& v)
  {
    return Vec3{std::cos(angle) * v.x - std::sin(angle) * v.y,
                std::sin(angle) * v.x + std::cos(angle) * v.y, v.z};
  };
  const auto same = [](const Vec3& v) { return v; };
  std::vector<Vec3> straight;
  for (const bool isTurned : {false, true})
  {
    Dusty part(false, comm, 1, isTurned ? std::function<Vec3(const Vec3&)>(turned) : same, {},
               true);
    const Mesh mesh = part.mesh;
    Solver quarter(std::move(part.model), comm);
    quarter.prepare();
    while (quarter.clock().time < 1.8e-3)
      quarter.advance();
    int pushed = 0;
    for (int k = 0; k < 8; ++k)
    {
      const Vec3 v = at(quarter.state().v, mesh.blocks[1].connectivity[std::size_t(k)]);
      pushed += v.z > -15;
      if (isTurned)
        EXPECT_LT(norm(v - turned(straight[std::size_t(k)])), 1e-9 * norm(v)) << k;
      else
        straight.push_back(v);
    }
    EXPECT_EQ(pushed, 4);
  }
}

TEST(Debris, inAPlaneOfSymmetryHasItsPartOfTheStiffness)
{
  // Points heavier than the elements, whose mass does not count any more. The whole has both halves
  // of a point in one.
  const Comm comm = Comm::alone();
  std::vector<Real> falls;
  for (const bool whole : {true, false})
  {
    Mesh mesh;
    addBox(mesh, "block", {4, whole ? 4 : 2, 2}, {-1, whole ? -1.0 : 0, -1},
           {2, whole ? 2.0 : 1, 1});
    addBox(mesh, "dust", {1, whole ? 2 : 1, 1}, {0.3, whole ? -0.2 : 0, 0.02},
           {0.2, whole ? 0.4 : 0.2, 0.2});
    Model model = dying(mesh, comm, {0, 0, -20}, 0.12);
    model.blocks[1].material = makeLinearElastic(1e9, 0.25, 5e5);
    model.time.stepFactor = 0.1;
    std::vector<int> nodes;
    for (int n = 0; n < model.mesh.ownedNodes; ++n)
      if (model.mesh.coordinates[std::size_t(n)].y == 0)
        nodes.push_back(n);
    if (!whole)
      model.conditions.symmetries = {{nodes, {0, 1, 0}}};
    Solver solver(std::move(model), comm);
    solver.prepare();
    while (solver.clock().time < 2e-3)
      solver.advance();
    Real sum = 0;
    for (const int n : nodes)
      if (solver.layout().ids()[std::size_t(n)] > (whole ? 75 : 45))
        sum += solver.state().v(n, 2);
    falls.push_back(sum);
  }
  EXPECT_GT(falls[0], 4 * -20 + 1); // four points of dust lie in the plane, two meet the block
  EXPECT_NEAR(falls[1], falls[0], 1e-9);
}

TEST(Debris, hasNoImageBeyondRollersThatGravityPressesOn)
{
  const Comm comm = Comm::alone();
  for (const bool pressed : {false, true})
  {
    Dusty part(false, comm);
    part.model.conditions.gravity = {pressed ? -9.81 : 0, 0, -9.81};
    Solver quarter(std::move(part.model), comm);
    quarter.prepare();
    std::int64_t most = 0;
    while (quarter.clock().time < 1.8e-3)
    {
      quarter.advance();
      most = std::max(most, quarter.debris()->touching());
    }
    EXPECT_EQ(most > 0, !pressed);
  }
}

TEST(Debris, fliesThroughWithoutTheOption)
{
  const Comm comm;
  Model model = fallingCorners(comm);
  model.debris = false;
  Solver solver(std::move(model), comm);
  solver.prepare();
  cycles(solver, 400);
  EXPECT_EQ(solver.debris(), nullptr);
  Real fastest = -infinity;
  for (int n = 0; n < solver.layout().owned(); ++n)
    if (solver.layout().ids()[std::size_t(n)] > 125)
      fastest = std::max(fastest, solver.state().v(n, 2));
  EXPECT_LT(comm.max(fastest), -15);
}

TEST(Debris, carriesNothingWhereItIsFreedInside)
{
  // The lower corners lie in the block when the cube dies: no energy comes of that, and their
  // contact begins where they go deeper.
  const Comm comm;
  Model model = fallingCorners(comm, {0, 0, 0});
  for (Vec3& x : model.mesh.coordinates)
    if (x.z > 2.01)
      x.z -= 0.07;
  model.contact.lookAhead = 0;
  Solver solver(std::move(model), comm);
  solver.prepare();
  Real most = 0;
  for (int n = 0; n < 50; ++n)
  {
    solver.advance();
    const EnergyBalance energy = solver.energy();
    most = std::max(most, energy.debris.stored);
    EXPECT_LT(energy.error(), 1e-2 * std::max(energy.scale(), 1.0));
  }
  EXPECT_EQ(solver.debris()->count(), 8);
  // The corners have no more than what they move with; the overlap would hold 200 kJ.
  EXPECT_LT(most, solver.energy().initial);
}

TEST(Debris, staysInTheMiddleBetweenFaces)
{
  // Corners fall on the edge of a wall and go on in its middle plane, as far from one side as from
  // the other.
  const Comm comm;
  Mesh mesh;
  addBox(mesh, "wall", {2, 4, 4}, {0.875, 0, 0}, {0.25, 2, 2});
  addBox(mesh, "cube", {1, 1, 1}, {1, 0.5, 2.0625}, {1, 1, 1});
  Model model = rockModel(mesh, comm);
  model.blocks[1].velocity = {0, 0, -150};
  model.blocks[1].velocityField = [](const Vec3& x) { return Vec3{0, 0, x.z - 2.5625}; };
  model.blocks[1].erosion.volumeRatio = {0.5, 1 + 1e-6};
  model.debris = true;
  Solver solver(std::move(model), comm);
  solver.prepare();
  Real deepest = infinity, sideways = 0, most = 0;
  while (solver.clock().time < 3e-3)
  {
    solver.advance();
    most = std::max(most, solver.energy().debris.stored);
    for (int n = 0; n < solver.layout().owned(); ++n)
      if (solver.layout().ids()[std::size_t(n)] > 75 && std::abs(solver.state().x(n, 0) - 1) < 0.1)
      {
        sideways = std::max(sideways, std::abs(solver.state().v(n, 0)));
        deepest = std::min(deepest, solver.state().x(n, 2));
      }
  }
  EXPECT_LT(-comm.max(-deepest), 2 - 0.15); // beyond where the sides are as near as the edge
  EXPECT_GT(most, 0);
  EXPECT_LT(comm.max(sideways), 1e-6);
}

TEST(Debris, hasTheSameBitsOnAnyRanks)
{
  const Comm world, alone(MPI_COMM_SELF);
  Solver one(fallingCorners(alone, {3, -2, -20}), alone),
      many(fallingCorners(world, {3, -2, -20}), world);
  one.prepare();
  many.prepare();
  std::int64_t touched = 0;
  for (int n = 0; n < 150; ++n)
  {
    one.advance();
    many.advance();
    touched += one.debris()->touching();
    ASSERT_EQ(many.stateHash(), one.stateHash()) << n;
    ASSERT_EQ(many.energy().debris.work, one.energy().debris.work) << n;
    ASSERT_EQ(many.energy().debris.stored, one.energy().debris.stored) << n;
  }
  EXPECT_GT(touched, 20);
}

TEST(Debris, goesOnAfterARestartWithTheSameBits)
{
  const Comm comm;
  Solver whole(fallingCorners(comm, {3, -2, -20}), comm);
  whole.prepare();
  int n = 0;
  while (whole.debris()->touching() == 0 && n++ < 200)
    whole.advance();
  ASSERT_GT(whole.debris()->touching(), 0);
  whole.advance();
  StateTables state(comm);
  whole.save(state);
  Solver second(fallingCorners(comm, {3, -2, -20}), comm);
  second.restore(state);
  EXPECT_EQ(second.stateHash(), whole.stateHash());
  StateTables again(comm);
  second.save(again);
  EXPECT_EQ(again.numbers("debris/state"), state.numbers("debris/state"));
  EXPECT_EQ(second.energy().debris.work, whole.energy().debris.work);
  EXPECT_EQ(second.energy().debris.stored, whole.energy().debris.stored);
  cycles(whole, 60);
  cycles(second, 60);
  EXPECT_EQ(second.stateHash(), whole.stateHash());
  EXPECT_EQ(second.energy().debris.work, whole.energy().debris.work);
  EXPECT_EQ(second.energy().error(), whole.energy().error());
}
} // namespace coplane
