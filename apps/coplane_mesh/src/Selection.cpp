#include "Selection.hpp"

#include "MeshFaces.hpp"

#include <coplane_schema/Suggestion.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace coplane
{
namespace
{
/// From and to, both ends widened by the tolerance; a plane is a range of zero length.
struct Range
{
  Real low = -infinity, high = infinity;
  bool holds(Real x) const { return low <= x && x <= high; }
};

/// Ranges along the axes, of the distance from the z axis (2D: from the origin), and of the angle
/// about it.
struct Ranges
{
  std::array<Range, 3> axes;
  Range radius, angle; ///< [m, degrees from x towards y]
  Real tolerance;

  bool hold(const Vec3& x) const
  {
    for (int axis = 0; axis < 3; ++axis)
      if (!axes[axis].holds(x[axis]))
        return false;
    const Real r = std::hypot(x[0], x[1]);
    if (!radius.holds(r))
      return false;
    if (angle.low == -infinity || r <= tolerance)
      return true; // the axis has any angle
    const Real slack = degrees(tolerance / r), from = angle.low - slack;
    const Real turned =
        std::fmod(std::fmod(degrees(std::atan2(x[1], x[0])) - from, 360) + 360, 360);
    return turned <= angle.high - angle.low + 2 * slack;
  }

private:
  static Real degrees(Real radians) { return radians * 180 / pi; }
};

/// A number, or two with the lower one first.
Range readRange(const RecipeMap& map, const std::string& key, Real tolerance)
{
  if (!map.has(key))
    return {};
  if (!map.node(key).IsSequence())
  {
    const Real at = map.number(key);
    return {at - tolerance, at + tolerance};
  }
  const std::vector<Real> ends = map.numbers(key, 2);
  if (ends[0] > ends[1])
    map.refuse(key, fmt::format("= [{}, {}]: the lower end comes first.", ends[0], ends[1]));
  return {ends[0] - tolerance, ends[1] + tolerance};
}

Ranges readRanges(const RecipeMap& selection, const std::string& key, int dimension, Real tolerance)
{
  Ranges ranges;
  ranges.tolerance = tolerance;
  if (!selection.has(key))
    return ranges;
  std::vector<std::string> accepted{"x", "y", "z", "radius", "angle"};
  if (dimension == 2)
    accepted.erase(accepted.begin() + 2);
  const RecipeMap map = selection.map(key, accepted);
  const std::array<std::string, 3> axes{"x", "y", "z"};
  for (int axis = 0; axis < dimension; ++axis)
    ranges.axes[axis] = readRange(map, axes[axis], tolerance);
  ranges.radius = readRange(map, "radius", tolerance);
  ranges.angle = readRange(map, "angle", 0);
  return ranges;
}

/// What node sets and side sets have in common: blocks, `where` and `where_own`.
struct Filter
{
  std::vector<bool> blocks;
  Ranges where, whereOwn;
  bool holds(const Vec3& x, const Vec3& own) const { return where.hold(x) && whereOwn.hold(own); }
};

Filter readFilter(const Mesh& mesh, const RecipeMap& map, Real tolerance)
{
  Filter filter;
  filter.blocks.assign(mesh.blocks.size(), !map.has("block"));
  if (map.has("block"))
    for (const std::string& name : map.texts("block"))
    {
      std::vector<std::string> names;
      bool found = false;
      for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
      {
        names.push_back(mesh.blocks[b].name);
        if (names.back() == name)
          found = filter.blocks[b] = true;
      }
      if (!found)
      {
        map.refuse("block", fmt::format("= '{}' is no block of the parts.{}", name,
                                        didYouMean(name, names)));
      }
    }
  filter.where = readRanges(map, "where", mesh.dimension, tolerance);
  filter.whereOwn = readRanges(map, "where_own", mesh.dimension, tolerance);
  return filter;
}

void addNodeSet(Mesh& mesh, const std::vector<Vec3>& own, const RecipeMap& map,
                const std::string& name, Real tolerance)
{
  const Filter filter = readFilter(mesh, map, tolerance);
  std::set<int> nodes;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    if (filter.blocks[b])
      for (const int node : mesh.blocks[b].connectivity)
        if (filter.holds(mesh.coordinates[node], own[node]))
          nodes.insert(node);
  if (nodes.empty())
    map.refuse("where",
               "selects no node. Compare it with the bounding box that coplane_mesh check prints.");
  mesh.nodeSets.push_back({GlobalId(mesh.nodeSets.size()) + 1, name, {nodes.begin(), nodes.end()}});
}

void addSideSet(Mesh& mesh, const std::vector<Vec3>& own, const RecipeMap& map,
                const std::string& name, Real tolerance, const std::vector<MeshFace>& faces,
                const std::vector<ElementPlace>& places)
{
  const Filter filter = readFilter(mesh, map, tolerance);
  Vec3 normal{};
  if (map.has("normal"))
  {
    normal = map.point("normal", mesh.dimension);
    if (!(norm(normal) > 0))
      map.refuse("normal", "must not be zero.");
    normal = normalised(normal);
  }
  // Faces within 26 degrees of the wanted normal: tells the sides of a block apart, also on a round
  // nose.
  constexpr Real leastCosine = 0.9;
  Mesh::SideSet set{GlobalId(mesh.sideSets.size()) + 1, name, {}, {}};
  for (const MeshFace& face : faces)
  {
    bool inside = face.count == 1 && filter.blocks[places[face.elements[0]].block];
    for (const int node : face.nodes)
      inside = inside && (node < 0 || filter.holds(mesh.coordinates[node], own[node]));
    if (!inside || (map.has("normal") && dot(normalOf(mesh, face), normal) < leastCosine))
      continue;
    set.elements.push_back(face.elements[0]);
    set.sides.push_back(face.sides[0]);
  }
  if (set.elements.empty())
    map.refuse("where", "selects no exterior face. All nodes of a face must lie there, and its "
                        "normal within 26 degrees of `normal`.");
  mesh.sideSets.push_back(std::move(set));
}
} // namespace

void addSets(Mesh& mesh, const std::vector<Vec3>& ownCoordinates, const RecipeMap& recipe,
             RecipeProblems& problems)
{
  const Real tolerance = 1e-6 * sizeOf(mesh);
  for (const auto& entry : recipe.entries("node_sets"))
    problems.collect(
        [&, &name = entry.first]
        {
          addNodeSet(mesh, ownCoordinates,
                     RecipeMap(entry.second, recipe.file(), "node_sets." + name,
                               {"block", "where", "where_own"}),
                     name, tolerance);
        });
  const auto sideSets = recipe.entries("side_sets");
  if (sideSets.empty())
    return;
  const std::vector<MeshFace> faces = facesOf(mesh);
  const std::vector<ElementPlace> places = placesOfElements(mesh);
  for (const auto& entry : sideSets)
    problems.collect(
        [&, &name = entry.first]
        {
          addSideSet(mesh, ownCoordinates,
                     RecipeMap(entry.second, recipe.file(), "side_sets." + name,
                               {"block", "where", "where_own", "normal"}),
                     name, tolerance, faces, places);
        });
}
} // namespace coplane
