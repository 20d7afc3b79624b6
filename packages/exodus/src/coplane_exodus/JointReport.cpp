#include <coplane_exodus/MeshReport.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace coplane
{
namespace
{
struct Face
{
  int element = 0, side = 0;
  Vec3 centre{}, normal{};
  std::vector<Vec3> corners;
};

/// Faces by the cells of a grid that hold their centres.
class FaceGrid
{
public:
  explicit FaceGrid(Real tolerance) : tolerance_(tolerance), cell_(4 * tolerance) {}

  void add(const Face& face, int position)
  {
    faces_[key(face.centre, {0, 0, 0})].push_back(position);
  }

  /// Calls with every face whose centre may lie within the tolerance.
  template <class Action>
  void forEachNear(const Vec3& centre, const Action& action) const
  {
    std::vector<Key> seen;
    for (int corner = 0; corner < 8; ++corner)
    {
      const Key near =
          key(centre, {corner & 1 ? tolerance_ : -tolerance_, corner & 2 ? tolerance_ : -tolerance_,
                       corner & 4 ? tolerance_ : -tolerance_});
      if (std::find(seen.begin(), seen.end(), near) != seen.end())
        continue;
      seen.push_back(near);
      const auto found = faces_.find(near);
      if (found != faces_.end())
        for (const int position : found->second)
          action(position);
    }
  }

private:
  using Key = std::array<std::int64_t, 3>;
  Key key(const Vec3& centre, const Vec3& shift) const
  {
    Key cells;
    for (int axis = 0; axis < 3; ++axis)
      cells[axis] = std::int64_t(std::floor((centre[axis] + shift[axis]) / cell_));
    return cells;
  }

  Real tolerance_, cell_;
  std::map<Key, std::vector<int>> faces_;
};

bool sameCorners(const Face& a, const Face& b, Real tolerance)
{
  return a.corners.size() == b.corners.size() &&
         std::all_of(a.corners.begin(), a.corners.end(),
                     [&](const Vec3& x)
                     {
                       return std::any_of(b.corners.begin(), b.corners.end(),
                                          [&](const Vec3& y) { return norm(x - y) <= tolerance; });
                     });
}
} // namespace

std::vector<MeshReport::Joint> findJoints(const Mesh& mesh, Real tolerance)
{
  std::vector<MeshReport::Joint> joints;
  if (!(tolerance > 0) || mesh.sideSets.empty())
    return joints;
  std::vector<std::pair<int, int>> places; // block and index of each element
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    for (int e = 0; e < mesh.blocks[b].elements(); ++e)
      places.emplace_back(int(b), e);
  for (const Mesh::SideSet& set : mesh.sideSets)
  {
    std::vector<Face> faces;
    FaceGrid grid(tolerance);
    for (std::size_t i = 0; i < set.elements.size(); ++i)
    {
      const auto [b, e] = places[set.elements[i]];
      const Mesh::Block& block = mesh.blocks[b];
      const ElementTopology& shape = topology(block.type);
      Face face{set.elements[i], set.sides[i], {}, {}, {}};
      for (int k = 0; k < shape.nodesPerSide; ++k)
      {
        face.corners.push_back(
            mesh.coordinates[block.connectivity[e * shape.nodes +
                                                shape.sideNodes[set.sides[i]][k]]]);
        face.centre += (1.0 / shape.nodesPerSide) * face.corners.back();
      }
      const std::vector<Vec3>& x = face.corners;
      face.normal = x.size() == 2 ? Vec3{x[1].y - x[0].y, x[0].x - x[1].x, 0}
                                  : cross(x[2] - x[0], (x.size() == 3 ? x[0] : x[3]) - x[1]);
      grid.add(face, int(faces.size()));
      faces.push_back(std::move(face));
    }
    MeshReport::Joint joint{set.id, set.name, 0, {}};
    int withPartner = 0;
    for (const Face& face : faces)
    {
      bool found = false;
      grid.forEachNear(face.centre,
                       [&](int position)
                       {
                         const Face& other = faces[position];
                         found = found || (other.element != face.element &&
                                           dot(other.normal, face.normal) < 0 &&
                                           sameCorners(face, other, tolerance));
                       });
      if (found)
        ++withPartner;
      else
      {
        const auto [b, e] = places[face.element];
        joint.alone.emplace_back(mesh.blocks[b].elementIds[e], face.side + 1);
      }
    }
    joint.pairs = withPartner / 2;
    if (joint.pairs > 0)
      joints.push_back(std::move(joint));
  }
  return joints;
}
} // namespace coplane
