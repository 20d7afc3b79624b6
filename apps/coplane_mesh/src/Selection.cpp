#include "Selection.hpp"

#include "MeshFaces.hpp"

#include <coplane_input/Suggestion.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace coplane
{
namespace
{
/// Ranges along the axes; a plane is a range of zero length. Both ends are widened by the
/// tolerance.
struct Ranges
{
  std::array<Real, 3> low{-infinity, -infinity, -infinity}, high{infinity, infinity, infinity};
  bool hold(const Vec3& x) const
  {
    for (int axis = 0; axis < 3; ++axis)
      if (x[axis] < low[axis] || x[axis] > high[axis])
        return false;
    return true;
  }
};

Ranges readRanges(const RecipeMap& selection, const std::string& key, int dimension, Real tolerance)
{
  Ranges ranges;
  if (!selection.has(key))
    return ranges;
  const RecipeMap map =
      selection.map(key, dimension == 2 ? std::vector<std::string>{"x", "y"}
                                        : std::vector<std::string>{"x", "y", "z"});
  const std::array<std::string, 3> axes{"x", "y", "z"};
  for (int axis = 0; axis < dimension; ++axis)
  {
    if (!map.has(axes[axis]))
      continue;
    Real low, high;
    if (map.node(axes[axis]).IsSequence())
    {
      const std::vector<Real> ends = map.numbers(axes[axis], 2);
      low = ends[0];
      high = ends[1];
      if (low > high)
        map.refuse(axes[axis], fmt::format("= [{}, {}]: the lower end comes first.", low, high));
    }
    else
      low = high = map.number(axes[axis]);
    ranges.low[axis] = low - tolerance;
    ranges.high[axis] = high + tolerance;
  }
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

void addSets(Mesh& mesh, const std::vector<Vec3>& ownCoordinates, const RecipeMap& recipe)
{
  const Real tolerance = 1e-6 * sizeOf(mesh);
  for (const auto& [name, node] : recipe.entries("node_sets"))
    addNodeSet(mesh, ownCoordinates,
               RecipeMap(node, recipe.file(), "node_sets." + name, {"block", "where", "where_own"}),
               name, tolerance);
  const auto sideSets = recipe.entries("side_sets");
  if (sideSets.empty())
    return;
  const std::vector<MeshFace> faces = facesOf(mesh);
  const std::vector<ElementPlace> places = placesOfElements(mesh);
  for (const auto& [name, node] : sideSets)
    addSideSet(mesh, ownCoordinates,
               RecipeMap(node, recipe.file(), "side_sets." + name,
                         {"block", "where", "where_own", "normal"}),
               name, tolerance, faces, places);
}
} // namespace coplane
