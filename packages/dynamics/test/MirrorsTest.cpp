#include "Rig.hpp"

#include <coplane_dynamics/Mirrors.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace coplane
{
namespace
{
/// Faces that are cut, and edges that lie in a mirror of faces that are not, of all ranks.
struct Counted
{
  std::int64_t cut = 0, edges = 0;

  bool operator==(const Counted& o) const { return cut == o.cut && edges == o.edges; }
  friend std::ostream& operator<<(std::ostream& out, const Counted& c)
  {
    return out << c.cut << " cut, " << c.edges << " edges";
  }
};

Counted countOf(Model model, const Comm& comm)
{
  const Solver solver(std::move(model), comm);
  Counted counted;
  for (const Face& face : solver.contact().localFaces())
  {
    if (!face.ownedHere)
      continue;
    counted.cut += face.isCut();
    for (int k = 0; k < face.count && !face.isCut(); ++k)
      counted.edges += (face.mirrors[k] & face.mirrors[(k + 1) % face.count]) != 0;
  }
  return {comm.sum(counted.cut), comm.sum(counted.edges)};
}

/// Half of a block, 4 x 4 x 4 elements, on one of 2 x 2 x 2 that is cut as well.
Mesh halves()
{
  Mesh mesh;
  addBox(mesh, "block", {4, 4, 4}, {0, 0, 0}, {2, 2, 2});
  addBox(mesh, "other", {2, 2, 2}, {0, 0, 3}, {2, 2, 2});
  return mesh;
}

bool inPlane(const Vec3& x)
{
  return x.x == 0;
}

Model cutWhere(const Mesh& mesh, const Comm& comm,
               const std::function<bool(const Vec3&)>& chosen = inPlane,
               const Vec3& normal = {1, 0, 0})
{
  Model model = rockModel(mesh, comm);
  model.conditions.symmetries = {{ownedNodesWhere(model.mesh, chosen), normal}};
  return model;
}

void makeRigid(Model& model, const Comm& comm)
{
  model.blocks[1].rigid = true;
  model.rigidBodyOfNode = rigidBodiesOf(model.mesh, {0, 1}, comm);
}

// Faces in the plane, and edges of those beside it.
constexpr Counted both{16 + 4, 16 + 8}, block{16, 16}, other{4, 8}, none{};
} // namespace

TEST(Mirrors, holdTheFacesAndEdgesInThem)
{
  const Comm comm;
  EXPECT_EQ(countOf(cutWhere(halves(), comm), comm), both);
  // Of one block, and of a half of that.
  EXPECT_EQ(
      countOf(cutWhere(halves(), comm, [](const Vec3& x) { return x.x == 0 && x.z < 2.5; }), comm),
      block);
  EXPECT_EQ(
      countOf(cutWhere(halves(), comm, [](const Vec3& x) { return x.x == 0 && x.z > 2.5; }), comm),
      other);
  EXPECT_EQ(
      countOf(cutWhere(halves(), comm, [](const Vec3& x) { return x.x == 0 && x.z < 1.1; }), comm)
          .cut,
      8);
  // Two conditions for one plane, with normals to either side.
  Model two = cutWhere(halves(), comm, [](const Vec3& x) { return x.x == 0 && x.z < 2.5; });
  two.conditions.symmetries.push_back(
      {ownedNodesWhere(two.mesh, [](const Vec3& x) { return x.x == 0 && x.z > 2.5; }), {-1, 0, 0}});
  EXPECT_EQ(countOf(std::move(two), comm), both);
  // Two planes.
  Model quarter = cutWhere(halves(), comm);
  quarter.conditions.symmetries.push_back(
      {ownedNodesWhere(quarter.mesh, [](const Vec3& x) { return x.y == 0; }), {0, 1, 0}});
  EXPECT_EQ(countOf(std::move(quarter), comm).cut, 2 * both.cut);
}

TEST(Mirrors, areOneWhereConditionsHoldPartsOfAPlaneInAnyOrder)
{
  const Comm comm;
  const auto upper = [](const Vec3& x) { return x.x == 0 && x.z > 2.5; };
  const auto lower = [](const Vec3& x) { return x.x == 0 && x.z < 2.5; };
  const auto line = [](const Vec3& x) { return x.x == 0 && x.z < 2.5 && x.y == 0; };
  const std::vector<std::pair<std::function<bool(const Vec3&)>, Vec3>> parts{
      {line, {1, 0, 0}}, {lower, {-1, 0, 0}}, {upper, {1, 4e-7, 0}}};
  for (std::array<int, 3> order : {std::array<int, 3>{0, 1, 2}, {2, 1, 0}, {1, 0, 2}})
  {
    Model model = rockModel(halves(), comm);
    for (const int i : order)
      model.conditions.symmetries.push_back(
          {ownedNodesWhere(model.mesh, parts[std::size_t(i)].first),
           normalised(parts[std::size_t(i)].second)});
    const Solver solver(model, comm);
    EXPECT_EQ(solver.mirrors().all.size(), 1u);
    EXPECT_EQ(solver.mirrors().lacks.size(), 0u);
    EXPECT_EQ(countOf(std::move(model), comm), both);
  }
}

TEST(Mirrors, countWhatHasNoImagesApart)
{
  // Floors under gravity at nine heights, before the plane of symmetry.
  const Comm comm;
  Mesh mesh;
  for (int i = 0; i < 9; ++i)
    addBox(mesh, "step" + std::to_string(i), {1, 1, 1}, {0, 2.0 * i, 0.25 * i}, {1, 1, 1});
  Model model = rockModel(mesh, comm);
  model.conditions.gravity = {0, 0, -9.81};
  for (int i = 0; i < 9; ++i)
    model.conditions.symmetries.push_back(
        {ownedNodesWhere(model.mesh, [&](const Vec3& x)
                         { return x.z == 0.25 * i && x.y >= 2 * i && x.y <= 2 * i + 1; }),
         {0, 0, 1}});
  model.conditions.symmetries.push_back({ownedNodesWhere(model.mesh, inPlane), {1, 0, 0}});
  const Solver solver(model, comm);
  EXPECT_EQ(solver.mirrors().all.size(), 1u);
  EXPECT_EQ(solver.mirrors().lacks.size(), 9u);
  EXPECT_EQ(countOf(std::move(model), comm).cut, 9);
}

TEST(Mirrors, areFoundFarFromTheOriginAndAtOddAngles)
{
  const Comm comm;
  const Real c = std::cos(0.3), s = std::sin(0.3);
  for (const Real far : {0.0, 1e4})
  {
    Mesh mesh = halves();
    for (Vec3& x : mesh.coordinates)
      x = {far + c * x.x - s * x.y, 2 * far + s * x.x + c * x.y, x.z - far};
    const Real level = dot(Vec3{c, s, 0}, mesh.coordinates[0]);
    EXPECT_EQ(countOf(cutWhere(mesh, comm,
                               [&](const Vec3& x) {
                                 return std::abs(dot(Vec3{c, s, 0}, x) - level) < 1e-6;
                               },
                               {c, s, 0}),
                      comm),
              both)
        << far;
  }
}

TEST(Mirrors, areFoundWithTheDigitsOfDecksAndMeshes)
{
  const Comm comm;
  Mesh mesh = halves();
  for (Vec3& x : mesh.coordinates)
    x = {Real(float(std::sqrt(0.75) * x.x - 0.5 * x.y)),
         Real(float(0.5 * x.x + std::sqrt(0.75) * x.y)), x.z};
  const Vec3 normal = normalised(Vec3{0.866025, 0.5, 0});
  const auto chosen = [&](const Vec3& x) { return std::abs(dot(normal, x)) < 1e-5; };
  Model model = cutWhere(mesh, comm, chosen, normal);
  model.conditions.gravity = {-4.905, 8.49571, 0}; // along the plane
  EXPECT_EQ(countOf(std::move(model), comm), both);
  // A millimetre is no round-off.
  mesh.coordinates[0].x += 1e-3;
  EXPECT_EQ(countOf(cutWhere(
                        mesh, comm, [&](const Vec3& x) { return std::abs(dot(normal, x)) < 2e-3; },
                        normal),
                    comm),
            none);
}

TEST(Mirrors, areNoneWhereNothingCanBeSymmetric)
{
  const Comm comm;
  Model pulled = cutWhere(halves(), comm);
  pulled.conditions.gravity = {-9.81, 0, 0};
  EXPECT_EQ(countOf(std::move(pulled), comm), none);
  Model along = cutWhere(halves(), comm);
  along.conditions.gravity = {0, 0, -9.81};
  EXPECT_EQ(countOf(std::move(along), comm), both);
  Model ends = cutWhere(halves(), comm);
  ends.conditions.symmetries[0].when.until = 1;
  EXPECT_EQ(countOf(std::move(ends), comm), none);
  Mesh beyond = halves();
  addBox(beyond, "beyond", {1, 1, 1}, {-1, 0, 5.5}, {0.5, 1, 1});
  EXPECT_EQ(countOf(cutWhere(beyond, comm), comm), none);
}

TEST(Mirrors, holdRigidBodiesThatStayInThem)
{
  const Comm comm;
  struct Case
  {
    std::array<bool, 3> components;
    std::array<OfTime, 3> velocity;
    std::optional<VectorOfTime> spin;
    bool stays;
  };
  const OfTime moves = [](Real) { return 1.0; };
  const VectorOfTime still, about(1, 0, 0), out(0, 1, 0);
  for (const Case& one : {Case{{true, true, true}, {}, still, true},
                          {{true, false, true}, {{{}, {}, moves}}, still, true},
                          {{true, false, false}, {}, about, true},
                          {{true, false, false}, {}, out, false},
                          {{true, false, false}, {}, std::nullopt, false},
                          {{true, true, true}, {{moves, {}, {}}}, still, false},
                          {{false, true, true}, {}, still, false}})
  {
    Model model = cutWhere(halves(), comm, [](const Vec3& x) { return x.x == 0 && x.z < 2.5; });
    makeRigid(model, comm);
    RigidMotion motion;
    motion.block = 1;
    motion.components = one.components;
    motion.velocity = one.velocity;
    motion.spin = one.spin;
    model.conditions.rigidMotions = {std::move(motion)};
    EXPECT_EQ(countOf(std::move(model), comm), one.stays ? both : block);
  }
  // By all of its components, in an oblique plane.
  Mesh mesh = halves();
  const Real c = 0.866025, s = 0.5;
  for (Vec3& x : mesh.coordinates)
    x = {c * x.x - s * x.y, s * x.x + c * x.y, x.z};
  Model oblique = cutWhere(
      mesh, comm, [&](const Vec3& x) { return std::abs(c * x.x + s * x.y) < 1e-4 && x.z < 2.5; },
      normalised(Vec3{c, s, 0}));
  makeRigid(oblique, comm);
  RigidMotion still3;
  still3.block = 1;
  still3.components = {true, true, true};
  still3.spin = VectorOfTime(0, 0, 0);
  oblique.conditions.rigidMotions = {still3};
  EXPECT_EQ(countOf(std::move(oblique), comm), both);
  // Held as a whole by the symmetry: so it turns about its normal only.
  Model held = cutWhere(halves(), comm, [](const Vec3& x) { return x.x == 0 || x.z > 2.5; });
  makeRigid(held, comm);
  EXPECT_EQ(countOf(std::move(held), comm), both);
  Model free = cutWhere(halves(), comm, [](const Vec3& x) { return x.x == 0 && x.z < 2.5; });
  makeRigid(free, comm);
  EXPECT_EQ(countOf(std::move(free), comm), block);
}

TEST(Mirrors, areOnTheAxisOfABodyOfRevolution)
{
  const Comm comm;
  Mesh mesh;
  addRectangle(mesh, "core", {2, 3}, {0, 0, 0}, {1, 1, 0});
  addRectangle(mesh, "ring", {2, 2}, {0.5, 2, 0}, {1, 1, 0});
  Model model = rockModel(mesh, comm);
  model.conditions.axisymmetric = true;
  EXPECT_EQ(countOf(std::move(model), comm).cut, 3);
}

TEST(Mirrors, leaveAPartOfWhatTheyHold)
{
  const auto at = [](Real degrees) {
    return Mirror{{std::sin(degrees * pi / 180), -std::cos(degrees * pi / 180), 0}, 0, 1, false};
  };
  const Mirror floor{{0, 0, 1}, 2, 1, false}, axis{{1, 0, 0}, 0, 1, true};
  EXPECT_EQ(shareOf({}), 1);
  EXPECT_EQ(shareOf({axis}), 1);
  EXPECT_EQ(shareOf({at(0)}), 0.5);
  EXPECT_EQ(shareOf({at(0), at(90)}), 0.25);
  EXPECT_EQ(shareOf({at(0), at(60)}), 1.0 / 6);
  EXPECT_EQ(shareOf({at(0), at(30), floor}), 1.0 / 24);
  EXPECT_EQ(shareOf({at(0), at(90), floor}), 0.125);
  EXPECT_EQ(shareOf({floor, floor}), 0.5);
}
} // namespace coplane
