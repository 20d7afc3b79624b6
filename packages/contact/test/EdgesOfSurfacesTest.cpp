#include <coplane_contact/detail/EdgesOfSurfaces.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <gtest/gtest.h>

#include <cmath>

// What lies beyond the edges of faces. Bodies are single hexahedra.

namespace coplane
{
namespace
{
struct Body
{
  Vec3 low, size;
  /// Turned about the x axis, then about the z axis [degrees], around its middle.
  Real aboutX = 0, aboutZ = 0;
  /// By how much all that is farther along x is higher, before it is turned [-].
  Real lean = 0;
};

Vec3 turned(const Vec3& r, const Body& body)
{
  const Real x = body.aboutX * pi / 180, z = body.aboutZ * pi / 180;
  const Vec3 once{r.x, std::cos(x) * r.y - std::sin(x) * r.z,
                  std::sin(x) * r.y + std::cos(x) * r.z};
  return {std::cos(z) * once.x - std::sin(z) * once.y, std::sin(z) * once.x + std::cos(z) * once.y,
          once.z};
}

RankMesh meshOf(const std::vector<Body>& bodies)
{
  RankMesh mesh;
  mesh.blocks.resize(1);
  RankMesh::Block& block = mesh.blocks[0];
  block.type = ElementType::Hex8;
  for (int b = 0; b < int(bodies.size()); ++b)
  {
    const Body& body = bodies[b];
    const Vec3 middle = body.low + 0.5 * body.size;
    for (const Vec3& corner : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0},
                               Vec3{0, 0, 1}, Vec3{1, 0, 1}, Vec3{1, 1, 1}, Vec3{0, 1, 1}})
    {
      Vec3 r{(corner.x - 0.5) * body.size.x, (corner.y - 0.5) * body.size.y,
             (corner.z - 0.5) * body.size.z};
      r.y += body.lean * r.x;
      block.connectivity.push_back(mesh.nodes());
      mesh.coordinates.push_back(middle + turned(r, body));
      mesh.nodePositions.push_back(mesh.nodes());
      mesh.nodeIds.push_back(mesh.nodes() + 1);
    }
    block.elementIds.push_back(b + 1);
    block.positions.push_back(b);
    block.bodyIds.push_back(b);
    block.owned.push_back(1);
  }
  mesh.ownedNodes = mesh.nodes();
  return mesh;
}

/// Bodies and all pairs of their faces, as a search would have found them.
class Scene
{
public:
  /// @param numbers of the bodies; they are counted unless given
  explicit Scene(const std::vector<Body>& bodies, const std::vector<int>& numbers = {},
                 const std::vector<Mirror>& mirrors = {})
      : comm_(MPI_COMM_SELF), mesh_(meshOf(bodies)), layout_(comm_, mesh_), x_("x", mesh_.nodes())
  {
    for (int n = 0; n < mesh_.nodes(); ++n)
      set(x_, n, mesh_.coordinates[n]);
    for (const ExteriorFace& exterior : exteriorFaces(mesh_))
    {
      Face face;
      face.id = exterior.id;
      face.count = exterior.nodeCount;
      const int place = int(elementOfFace(face.id)) - 1;
      face.body = numbers.empty() ? place : numbers[place];
      places_.push_back(place);
      face.local = face.ownedHere = true;
      face.thickness = 1;
      for (int k = 0; k < face.count; ++k)
      {
        face.nodes[k] = exterior.nodes[k];
        for (std::size_t m = 0; m < mirrors.size(); ++m)
          if (dot(mirrors[m].normal, mesh_.coordinates[face.nodes[k]]) == mirrors[m].level)
            face.mirrors[k] |= std::uint8_t(1u << m);
      }
      faces_.push_back(face);
    }
    planes_ = Array<FacePlane>(
        Kokkos::ViewAllocateWithoutInitializing("coplane::contact::facePlanes"), faces_.size());
    for (std::size_t f = 0; f < faces_.size(); ++f)
      new (&planes_(f)) FacePlane(facePlane(faces_[f], x_, 3));
    for (int a = 0; a < int(faces_.size()); ++a)
      for (int b = a + 1; b < int(faces_.size()); ++b)
        if (places_[a] != places_[b])
          pairs_.push_back({a, b});
    const Array<Face> table(Kokkos::ViewAllocateWithoutInitializing("faces"), faces_.size());
    std::uninitialized_copy(faces_.begin(), faces_.end(), table.data());
    edges_.emplace(pairs_, table, faces_.size(), planes_, x_, 3, mirrors, layout_);
  }

  /// The pair of the faces of body a and of body b > a whose normals are next to these.
  Plane pair(int a, const Vec3& normalA, int b, const Vec3& normalB)
  {
    const int lower = face(a, normalA), higher = face(b, normalB);
    for (std::size_t p = 0; p < pairs_.size(); ++p)
      if (pairs_[p].lower == lower && pairs_[p].higher == higher)
      {
        Plane plane;
        edges_->look(p, plane);
        pair_ = pairs_[p];
        return plane;
      }
    ADD_FAILURE() << "no such pair";
    return {};
  }

  /// Outward directions of the edges of face 0 or 1 of the pair looked at last, whose bits are set;
  /// as words, sorted: "+x -z".
  std::string edgesIn(std::uint8_t bits, int side) const
  {
    const Face& of = faces_[side == 0 ? pair_.lower : pair_.higher];
    const Vec3 normal = planes_(side == 0 ? pair_.lower : pair_.higher).normal;
    std::vector<std::string> words;
    for (int e = 0; e < of.count; ++e)
    {
      if ((bits >> (4 * side + e) & 1) == 0)
        continue;
      // The outline of the higher face runs the other way.
      const int i = side == 0 ? e : e == of.count - 1 ? e : of.count - 2 - e;
      const Vec3 along = at(x_, of.nodes[(i + 1) % of.count]) - at(x_, of.nodes[i]);
      const Vec3 out = normalised(cross(along, normal));
      for (int c = 0; c < 3; ++c)
        if (std::abs(out[c]) > 0.9)
          words.push_back(std::string(out[c] > 0 ? "+" : "-") + "xyz"[c]);
    }
    std::sort(words.begin(), words.end());
    std::string text;
    for (const std::string& word : words)
      text += (text.empty() ? "" : " ") + word;
    return text;
  }

private:
  int face(int body, const Vec3& normal) const
  {
    int best = -1;
    for (int f = 0; f < int(faces_.size()); ++f)
      if (places_[f] == body &&
          (best < 0 || dot(planes_(f).normal, normal) > dot(planes_(best).normal, normal)))
        best = f;
    return best;
  }

  Comm comm_;
  RankMesh mesh_;
  NodeLayout layout_;
  NodeVectors x_;
  std::vector<Face> faces_;
  std::vector<int> places_; ///< by face: its body in the list
  Array<FacePlane> planes_;
  std::vector<CandidatePair> pairs_;
  std::optional<EdgesOfSurfaces> edges_;
  CandidatePair pair_;
};

constexpr Vec3 right{1, 0, 0}, left{-1, 0, 0}, up{0, 1, 0}, down{0, -1, 0}, front{0, 0, 1};
constexpr Vec3 unitCube{1, 1, 1};
constexpr Real closed = 1e-5; ///< closure of joints [m]
} // namespace

TEST(NormalsOfNodes, aNodeHasAllItsNormalsInAnyOrder)
{
  // Within 20 degrees of each other, and more than three: a node that keeps some of them only has
  // others when faces come in another order, and a body then differs from its mirror image.
  std::vector<Vec3> all;
  for (int i = 0; i < 7; ++i)
    all.push_back(normalised({std::cos(0.1 * i), std::sin(0.1 * i), 1}));
  NormalsOfNodes forth(2), back(2);
  for (int i = 0; i < 7; ++i)
  {
    forth.add(1, all[i]);
    back.add(1, all[6 - i]);
    forth.add(1, all[0]);
  }
  EXPECT_EQ(forth.most(), 7);
  for (const Vec3& normal : all)
  {
    EXPECT_TRUE(forth.has(1, normal));
    EXPECT_TRUE(back.has(1, normal));
    EXPECT_FALSE(forth.has(0, normal));
  }
}

TEST(EdgesOfSurfaces, aBlockThatHangsOverAnEndMayLeaveOverIt)
{
  Scene scene({{{0, 0, 0}, unitCube}, {{0.9, 1, 0}, unitCube}});
  const Plane plane = scene.pair(0, up, 1, down);
  EXPECT_EQ(scene.edgesIn(plane.turns, 0), "+x +z -x -z");
  EXPECT_EQ(scene.edgesIn(plane.turns, 1), "+x +z -x -z");
  EXPECT_EQ(scene.edgesIn(plane.exits, 0),
            "+x +z -x -z"); // the sides face away from each other, too
  EXPECT_EQ(scene.edgesIn(plane.covered, 0), "");
}

TEST(EdgesOfSurfaces, aSurfaceGoesOnOverAFlushSeam)
{
  // 0 and 1 are flush, and 2 lies across the seam.
  Scene scene({{{-1, 0, 0}, unitCube}, {{0, 0, 0}, unitCube}, {{-0.5, 1, 0}, unitCube}});
  const Plane plane = scene.pair(0, up, 2, down);
  EXPECT_EQ(scene.edgesIn(plane.turns, 0), "+z -x -z");
  EXPECT_EQ(scene.edgesIn(plane.seams, 0), "+x");
  EXPECT_EQ(scene.edgesIn(plane.seams, 1), "");
  // So it does where the seam is a hair open.
  Scene open({{{-1, 0, 0}, unitCube}, {{0.004, 0, 0}, unitCube}, {{-0.5, 1, 0}, unitCube}});
  EXPECT_EQ(open.edgesIn(open.pair(0, up, 2, down).seams, 0), "+x");
  // A step of more than 0.005 of a face is an edge again.
  Scene stepped({{{-1, 0, 0}, unitCube}, {{0, -0.01, 0}, unitCube}, {{-0.5, 1, 0}, unitCube}});
  const Plane above = stepped.pair(0, up, 2, down);
  EXPECT_EQ(stepped.edgesIn(above.turns, 0), "+x +z -x -z");
  EXPECT_EQ(stepped.edgesIn(above.seams, 0), "");
}

TEST(EdgesOfSurfaces, aThirdBodyDoesNotComeToASideThatIsHidden)
{
  Scene scene({{{-1, 0, 0}, unitCube}, {{0, 0, 0}, unitCube}, {{-0.1, 0.9, 0}, unitCube}});
  const Plane plane = scene.pair(0, right, 2, left);
  EXPECT_EQ(scene.edgesIn(plane.covered, 0), "+y +z -y -z");
  EXPECT_EQ(scene.edgesIn(plane.covered, 1), "");
  // The one that lies on it is not hidden from it.
  EXPECT_EQ(scene.pair(0, right, 1, left).covered, 0);
}

TEST(EdgesOfSurfaces, bricksBesideEachOtherPartOverTheEdgesThatCrossAtTheirJoint)
{
  // The top of one and the front of the other see each other through the corner: a sliver as wide
  // as the joint is closed, and as deep as the bricks.
  Scene scene({{{-1, 0, 0}, unitCube}, {{-closed, 0, 0}, unitCube}});
  const Plane plane = scene.pair(0, up, 1, front);
  EXPECT_NE(scene.edgesIn(plane.exits, 0).find("+x"), std::string::npos);
  EXPECT_NE(scene.edgesIn(plane.exits, 1).find("-x"), std::string::npos);
  EXPECT_EQ(scene.edgesIn(plane.turns, 0), "+x +z -x -z"); // the other one's top is not its own
  const Plane other = scene.pair(0, front, 1, down);
  EXPECT_NE(scene.edgesIn(other.exits, 0).find("+x"), std::string::npos);
  EXPECT_NE(scene.edgesIn(other.exits, 1).find("-x"), std::string::npos);
}

TEST(EdgesOfSurfaces, goOnWhereBodiesAreCutByAPlaneOfSymmetry)
{
  // One cube on another: halves of blocks, or quarters.
  const Mirror atLeft{{1, 0, 0}, 0, 1}, atBack{{0, 0, 1}, 0, 1}, above{{0, 1, 0}, 2, -1};
  const std::vector<Body> stack{{{0, 0, 0}, unitCube}, {{0, 1, 0}, unitCube}};
  for (const auto& [mirrors, turns] :
       {std::pair<std::vector<Mirror>, std::string>{{}, "+x +z -x -z"},
        {{atLeft}, "+x +z -z"},
        {{atLeft, atBack}, "+x +z"},
        {{above}, "+x +z -x -z"}})
  {
    Scene scene(stack, {}, mirrors);
    const Plane plane = scene.pair(0, up, 1, down);
    EXPECT_EQ(scene.edgesIn(plane.turns, 0), turns);
    EXPECT_EQ(scene.edgesIn(plane.turns, 1), turns);
  }
  // The roof of a block that falls away from the plane has a ridge there, with that of its image;
  // one that rises has a valley.
  for (const auto& [lean, turns] :
       {std::pair<Real, std::string>{-0.3, "+x +z -x -z"}, {-0.01, "+x +z -z"}, {0.3, "+x +z -z"}})
  {
    Body leaning{{0, 0, 0}, unitCube}, other{{0, 1, 0}, unitCube};
    leaning.lean = other.lean = lean;
    Scene scene({leaning, other}, {}, {atLeft});
    const Plane plane = scene.pair(0, up, 1, down);
    EXPECT_EQ(scene.edgesIn(plane.turns, 0), turns) << lean;
    // What hangs down from the other one does the opposite.
    EXPECT_EQ(scene.edgesIn(plane.turns, 1), lean == 0.3 ? "+x +z -x -z" : "+x +z -z") << lean;
  }
}

TEST(EdgesOfSurfaces, roofsThatCrossKeepEachOtherUp)
{
  // Ridges along x below and along z above, flanks at 45 degrees.
  Scene scene({{{0, 0, 0}, unitCube, 45, 0}, {{0, 1.4, 0}, unitCube, 0, 45}});
  const Vec3 flank = normalised(up + front), above = normalised(left + down);
  EXPECT_EQ(scene.pair(0, flank, 1, above).exits, 0);
  EXPECT_EQ(scene.pair(0, normalised(up - front), 1, normalised(right + down)).exits, 0);
}

TEST(EdgesOfSurfaces, bothFlanksOfAKeelAreAlike)
{
  // A cube that stands on an edge, its end 0.05 over the end of a table.
  for (const Real angle : {44.0, 45.0, 46.0})
  {
    Scene scene({{{0, 0, 0}, unitCube}, {{0.95, 1.2, 0}, unitCube, angle, 0}});
    const Plane one = scene.pair(0, up, 1, normalised(down + front));
    const std::string exits = scene.edgesIn(one.exits, 0);
    EXPECT_EQ(exits.find("x"), std::string::npos) << angle;
    const Plane other = scene.pair(0, up, 1, normalised(down - front));
    EXPECT_EQ(scene.edgesIn(other.exits, 0), exits) << angle;
  }
}

TEST(EdgesOfSurfaces, aBodyOnItsOwnSeamSlidesOn)
{
  // 1 is flush with 0, and a fragment of it, which has its number, lies across the seam.
  Scene scene({{{-1, 0, 0}, unitCube}, {{0, 0, 0}, unitCube}, {{-0.5, 1, 0}, unitCube}}, {0, 1, 1});
  const Plane plane = scene.pair(0, up, 2, down);
  EXPECT_EQ(scene.edgesIn(plane.turns, 0), "+z -x -z");
}

TEST(EdgesOfSurfaces, theTopOfABodyEndsBeforeTheBottomOfTheOneBeside)
{
  // Where a top bulges into the body beside it, it faces that body's bottom: no surface goes on.
  Scene scene({{{-1, 0, 0}, unitCube}, {{0, 0, 0}, unitCube}, {{-0.5, 1, 0}, unitCube}}, {0, 1, 2});
  EXPECT_EQ(scene.edgesIn(scene.pair(0, up, 1, down).turns, 0), "+x +z -x -z");
  EXPECT_EQ(scene.edgesIn(scene.pair(0, up, 2, down).turns, 0), "+z -x -z");
}
} // namespace coplane
