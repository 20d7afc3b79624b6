#include <coplane_contact/Census.hpp>
#include <coplane_contact/ContactTables.hpp>
#include <coplane_contact/FaceContact.hpp>

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
/// Two blocks on a third, each rank by itself; joint "soft" under the left one, "hard" under the
/// right one, which stands 0.1 mm higher in the mesh.
///
///      +--+    +-----+  2
///      |1 |    |  2  |
///      +--+----+-----+  1
///      |      0      |
///      +-------------+
///      0  1    2     4
constexpr Real leftArea = 1, rightArea = 2; // areas of the joints [m^2]
constexpr Real soft = 1e9, hard = 2e9;      // stiffness [Pa/m]
const GlobalId lonely = faceId(2, 3);       // the left side of block 1
constexpr Real pressure = 1e6, lift = 1e-4;
const std::vector<Vec3> corners{{0, 0, 0},        {4, 0, 0},        {4, 1, 0}, {0, 1, 0},
                                {0, 1, 0},        {1, 1, 0},        {1, 2, 0}, {0, 2, 0},
                                {2, 1 + lift, 0}, {4, 1 + lift, 0}, {4, 2, 0}, {2, 2, 0}};

RankMesh threeBlocks()
{
  RankMesh mesh;
  mesh.dimension = 2;
  mesh.ownedNodes = 12;
  mesh.coordinates = corners;
  for (int n = 0; n < 12; ++n)
  {
    mesh.nodeIds.push_back(n + 1);
    mesh.nodePositions.push_back(n);
  }
  for (int b = 0; b < 3; ++b)
  {
    RankMesh::Block block;
    block.meshBlock = b;
    block.type = ElementType::Quad4;
    block.elementIds = {b + 1};
    block.positions = {0};
    block.connectivity = {4 * b, 4 * b + 1, 4 * b + 2, 4 * b + 3};
    block.bodyIds = {0};
    block.owned = {1};
    mesh.blocks.push_back(block);
  }
  return mesh;
}

ContactRules rules()
{
  ContactRules rules;
  for (const auto& [name, stiffness] : {std::make_pair("soft", soft), std::make_pair("hard", hard)})
  {
    JointRecipe joint;
    joint.name = name;
    joint.law.penalty = false;
    joint.law.initialStiffness = stiffness;
    joint.law.friction = 0.5;
    rules.joints.push_back(joint);
  }
  // Group 3 is the left side of block 1: a joint with nothing on its other side.
  rules.tellApart(4);
  rules.table[15].declared = true;
  rules.table[15].item = 0;
  rules.declaredItems = {{0, "nowhere"}, {1, "first"}, {2, "second"}};
  for (const int other : {1, 2})
    for (const int i : {other, 4 * other})
    {
      rules.table[i].joint = other - 1;
      rules.table[i].declared = true;
      rules.table[i].item = other;
    }
  return rules;
}

/// The three blocks with joints closed under the pressure.
class Tables : public ::testing::Test
{
protected:
  Tables()
      : comm_(MPI_COMM_SELF), mesh_(threeBlocks()), layout_(comm_, mesh_), x_("x", 12), v_("v", 12)
  {
    std::vector<Face> faces;
    for (const ExteriorFace& exterior : exteriorFaces(mesh_))
    {
      Face face;
      face.id = exterior.id;
      face.count = exterior.nodeCount;
      face.block = face.group = exterior.block;
      if (face.id == lonely)
        face.group = 3;
      face.local = face.ownedHere = true;
      face.thickness = 1;
      face.modulus = 1e10;
      for (int k = 0; k < face.count; ++k)
        face.nodes[k] = exterior.nodes[k];
      faces.push_back(face);
    }
    for (int n = 0; n < 12; ++n)
      set(x_, n, corners[n]);
    contact_.emplace(comm_, 2, faces, ContactOptions{}, rules(), 0.1, 1.0);
    contact_->findGhosts(x_, layout_.ids());
    contact_->pairUp(x_, layout_);
    SymTensor stress{};
    stress.yy = -pressure;
    contact_->closeDeclaredJoints(x_, [&](int, const Vec3&) { return stress; });
    contact_->step6_updateCommonPlanes(x_, v_, 0, 0, 0);
  }

  /// Moves the blocks on top by u in one step.
  void move(const Vec3& u)
  {
    constexpr Real dt = 1e-3;
    for (int n = 4; n < 12; ++n)
    {
      set(x_, n, at(x_, n) + u);
      set(v_, n, (1 / dt) * u);
    }
    contact_->step6_updateCommonPlanes(x_, v_, dt, 2 * dt, dt);
  }

  Comm comm_;
  RankMesh mesh_;
  NodeLayout layout_;
  NodeVectors x_, v_;
  std::optional<Contact> contact_;
};
} // namespace

TEST_F(Tables, jointsAreSummedUpByCard)
{
  const std::vector<JointSummary> joints = jointSummaries(*contact_, x_);
  ASSERT_EQ(joints.size(), 2u);
  // Closure is pressure over stiffness; stored is 1/2 pressure closure area.
  const Real areas[] = {leftArea, rightArea}, stiffness[] = {soft, hard};
  for (int j = 0; j < 2; ++j)
  {
    const Real closure = pressure / stiffness[j];
    EXPECT_NEAR(joints[j].stickArea, areas[j], 1e-12);
    EXPECT_NEAR(joints[j].openArea, 0, 1e-12);
    EXPECT_EQ(joints[j].slipArea, 0);
    EXPECT_NEAR(joints[j].meanClosure, closure, 1e-12 * closure + 4 * epsilon);
    EXPECT_NEAR(joints[j].normalForce, pressure * areas[j], 1e-9 * pressure);
    EXPECT_NEAR(joints[j].energy.stored, 0.5 * pressure * closure * areas[j], 1e-6);
    EXPECT_EQ(joints[j].largestSlip, 0);
    EXPECT_EQ(joints[j].energy.friction, 0);
  }
}

TEST_F(Tables, whatOpensIsOpenArea)
{
  move({0, 2e-3, 0}); // twice the closure of the soft joint
  const std::vector<JointSummary> joints = jointSummaries(*contact_, x_);
  EXPECT_NEAR(joints[0].openArea, leftArea, 1e-12);
  EXPECT_NEAR(joints[1].openArea, rightArea, 1e-12);
  EXPECT_EQ(joints[0].stickArea + joints[0].slipArea + joints[1].stickArea, 0);
  EXPECT_EQ(joints[0].normalForce, 0);
  EXPECT_EQ(joints[0].meanClosure, 0);
}

TEST_F(Tables, areasAndTractionsAreThoseOfTheFacesNow)
{
  // All faces become 1.3 times as long, and as close as before: the joints keep their force.
  constexpr Real grown = 1.3;
  for (int n = 0; n < 12; ++n)
    set(x_, n, {grown * corners[n].x, corners[n].y, 0});
  contact_->step6_updateCommonPlanes(x_, v_, 0, 0, 0);
  const std::vector<JointSummary> joints = jointSummaries(*contact_, x_);
  const Real areas[] = {leftArea, rightArea};
  for (int j = 0; j < 2; ++j)
  {
    EXPECT_NEAR(joints[j].stickArea, grown * areas[j], 1e-12);
    EXPECT_NEAR(joints[j].openArea, 0, 1e-12);
    EXPECT_NEAR(joints[j].normalForce, pressure * areas[j], 1e-9 * pressure);
  }
  const std::vector<FaceContact> faces = faceContact(*contact_, x_);
  int pressed = 0;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (contact_->faces()[f].block > 0 && faces[f].areaFraction > 0)
    {
      ++pressed;
      EXPECT_NEAR(faces[f].areaFraction, 1, 1e-12);
      EXPECT_NEAR(faces[f].normalTraction, pressure / grown, 1e-9 * pressure);
    }
  EXPECT_EQ(pressed, 2);
  for (const ContactTableRow& row : contactTable(*contact_, x_))
    EXPECT_NEAR(row.area, grown * areas[row.kind.joint], 1e-12);
}

TEST_F(Tables, slipBooksFriction)
{
  // Shear stiffness is half of the normal one: the soft joint slips beyond mu p / (k / 2) = 1 mm of
  // 10 mm, the hard one beyond half a millimetre.
  move({-0.01, 0, 0});
  const std::vector<JointSummary> joints = jointSummaries(*contact_, x_);
  EXPECT_GT(joints[0].slipArea, 0.98);
  EXPECT_EQ(joints[0].stickArea, 0);
  EXPECT_NEAR(joints[0].largestSlip, 0.009, 1e-9);
  EXPECT_NEAR(joints[1].largestSlip, 0.0095, 1e-9);
  EXPECT_GT(joints[0].energy.friction, 0);
}

TEST_F(Tables, sliversAndFacesThatOverlapNoMoreAreNoJoint)
{
  // Under slip, until 0.05 % of the left block lies on the other one; then none of it.
  move({-0.01, 0, 0});
  EXPECT_GT(jointSummaries(*contact_, x_)[0].largestSlip, 0);
  move({-0.9895, 0, 0});
  const Real frictionAtTheEnd = jointSummaries(*contact_, x_)[0].energy.friction;
  EXPECT_GT(frictionAtTheEnd, 0);
  for (const Real way : {0.0, -0.1})
  {
    move({way, 0, 0});
    const JointSummary left = jointSummaries(*contact_, x_)[0];
    EXPECT_EQ(left.openArea + left.stickArea + left.slipArea, 0);
    EXPECT_EQ(left.largestSlip, 0);
    EXPECT_NEAR(left.energy.friction, frictionAtTheEnd, 1e-3 * frictionAtTheEnd);
  }
  EXPECT_GT(jointSummaries(*contact_, x_)[1].largestSlip, 0);
}

TEST_F(Tables, rowsOfPairsAddUpToTheEnergyOfContact)
{
  move({-0.01, 0, 0});
  const std::vector<ContactTableRow> rows = contactTable(*contact_, x_);
  ASSERT_EQ(rows.size(), 2u);
  ContactEnergy sum;
  for (int i = 0; i < 2; ++i)
  {
    EXPECT_EQ(rows[i].kind.blocks[0], 0);
    EXPECT_EQ(rows[i].kind.blocks[1], i + 1);
    EXPECT_EQ(rows[i].kind.joint, i);
    EXPECT_EQ(rows[i].planes, 1);
    sum.work += rows[i].energy.work;
    sum.stored += rows[i].energy.stored;
    sum.friction += rows[i].energy.friction;
  }
  const ContactEnergy energy = contact_->energy();
  EXPECT_DOUBLE_EQ(sum.work, energy.work);
  EXPECT_DOUBLE_EQ(sum.stored, energy.stored);
  EXPECT_DOUBLE_EQ(sum.friction, energy.friction);
}

TEST_F(Tables, aFaceSeesTheMeansOfItsPlanes)
{
  const std::vector<FaceContact> seen = faceContact(*contact_, x_);
  for (std::size_t f = 0; f < seen.size(); ++f)
  {
    const GlobalId id = contact_->faces()[f].id;
    if (id == faceId(1, 2)) // the top of block 0: 3 of 4 m in contact
    {
      EXPECT_EQ(seen[f].state, PlaneState::Stick);
      EXPECT_NEAR(seen[f].areaFraction, (leftArea + rightArea) / 4, 1e-12);
      EXPECT_NEAR(seen[f].normalTraction, pressure, 1e-9 * pressure);
      const Real closure =
          (leftArea * pressure / soft + rightArea * pressure / hard) / (leftArea + rightArea);
      EXPECT_NEAR(seen[f].closure, closure, 1e-12 * closure + 4 * epsilon);
      EXPECT_NEAR(seen[f].gap, -pressure / soft, 4 * epsilon);
    }
    else if (id == faceId(2, 0) || id == faceId(3, 0)) // feet of the blocks on top
    {
      EXPECT_NEAR(seen[f].areaFraction, 1, 1e-12);
    }
    else
    {
      EXPECT_EQ(seen[f].state, PlaneState::Slot);
      EXPECT_EQ(seen[f].areaFraction, 0);
    }
  }
}

TEST_F(Tables, shearOfTheTwoFacesOfAPlaneIsOpposite)
{
  move({-0.01, 0, 0});
  const std::vector<FaceContact> seen = faceContact(*contact_, x_);
  for (std::size_t f = 0; f < seen.size(); ++f)
    if (contact_->faces()[f].id == faceId(2, 0))
    {
      // Friction holds back what slides to -x.
      EXPECT_NEAR(seen[f].shearTraction.x, 0.5 * seen[f].normalTraction, 1e-6 * pressure);
      EXPECT_EQ(seen[f].state, PlaneState::Slip);
    }
    else if (contact_->faces()[f].id == faceId(1, 2))
    {
      EXPECT_NEAR(seen[f].shearTraction.x, -0.5 * seen[f].normalTraction, 1e-6 * pressure);
    }
}

TEST_F(Tables, censusKnowsTheGapsThatJointsAbsorb)
{
  const ContactCensus found = census(*contact_);
  EXPECT_EQ(found.declaredClosed, 2);
  EXPECT_EQ(found.bonded, 0);
  EXPECT_EQ(found.stick, 2);
  EXPECT_EQ(found.overlapping, 0);
  EXPECT_EQ(found.lonelyFaces, 1);
  EXPECT_EQ(found.firstLonelyFaces, std::vector<GlobalId>{lonely});
  EXPECT_EQ(found.itemsWithoutPartner, std::vector<std::string>{"nowhere"});
  ASSERT_EQ(found.joints.count, 2);
  EXPECT_NEAR(found.joints.quantiles[0], 0, 4 * epsilon);
  EXPECT_NEAR(found.joints.quantiles[6], lift, 4 * epsilon);
  ASSERT_EQ(found.joints.extreme.size(), 2u);
  EXPECT_EQ(found.joints.extreme[0].faceId[0], faceId(1, 2));
  EXPECT_EQ(found.joints.extreme[0].faceId[1], faceId(3, 0));
  EXPECT_EQ(found.leastStiffness, soft);
  EXPECT_EQ(found.largestStiffness, hard);
}

TEST(Contact, refusesMoreBlocksOrJointsThanPlanesCanName)
{
  const Comm comm(MPI_COMM_SELF);
  const auto messageWith = [&](int blocks, int joints) -> std::string
  {
    Face face;
    face.block = blocks - 1;
    ContactRules rules;
    rules.joints.resize(std::size_t(joints));
    try
    {
      Contact(comm, 2, {face}, {}, rules, 1, 1);
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(messageWith(65535, 65535), "");
  EXPECT_NE(messageWith(65536, 1).find("65536 element blocks"), std::string::npos);
  EXPECT_NE(messageWith(1, 70000).find("70000 joint laws"), std::string::npos);
}
} // namespace coplane
