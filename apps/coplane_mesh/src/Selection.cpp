#include "Selection.hpp"

#include "MeshFaces.hpp"
#include "ShapeModel.hpp"

#include <coplane_core/Suggestion.hpp>

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

Range rangeOf(const std::vector<Real>& ends, Real tolerance)
{
  return ends.empty() ? Range{} : Range{ends.front() - tolerance, ends.back() + tolerance};
}

Ranges rangesOf(const PlacesCard& places, Real tolerance)
{
  return {
      {rangeOf(places.x, tolerance), rangeOf(places.y, tolerance), rangeOf(places.z, tolerance)},
      rangeOf(places.radius, tolerance),
      rangeOf(places.angle, 0),
      tolerance};
}

/// What node sets and side sets have in common: blocks, `where` and `where_own`.
struct Filter
{
  std::vector<bool> blocks;
  Ranges where, whereOwn;
  bool holds(const Vec3& x, const Vec3& own) const { return where.hold(x) && whereOwn.hold(own); }
};

Filter filterOf(const Mesh& mesh, const SetCard& card, Real tolerance, const CardPlace& place)
{
  std::vector<std::string> names;
  for (const Mesh::Block& block : mesh.blocks)
    names.push_back(block.name);
  Filter filter;
  filter.blocks.assign(names.size(), card.blocks.empty());
  for (const std::string& name : card.blocks)
  {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      place.problem("block", fmt::format("= '{}' is no block of the parts.{}", name,
                                         didYouMean(name, names)));
    else
      filter.blocks[std::size_t(found - names.begin())] = true;
  }
  filter.where = rangesOf(card.places, tolerance);
  filter.whereOwn = rangesOf(card.ownPlaces, tolerance);
  return filter;
}

/// Sets of the meshes of files have names already.
template <class Set>
bool isTaken(const std::vector<Set>& sets, const SetCard& card, const CardPlace& place)
{
  if (std::none_of(sets.begin(), sets.end(), [&](const Set& set) { return set.name == card.name; }))
    return false;
  place.problems.add(place.node, fmt::format("{} has the name of a set of a mesh; name it "
                                             "otherwise, or give the mesh a prefix.",
                                             place.path));
  return true;
}

void addNodeSet(Mesh& mesh, const std::vector<Vec3>& own, const SetCard& card, Real tolerance,
                const CardPlace& place)
{
  if (isTaken(mesh.nodeSets, card, place))
    return;
  const std::size_t before = place.problems.size();
  const Filter filter = filterOf(mesh, card, tolerance, place);
  std::set<int> nodes;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    if (filter.blocks[b])
      for (const int node : mesh.blocks[b].connectivity)
        if (filter.holds(mesh.coordinates[node], own[node]))
          nodes.insert(node);
  if (nodes.empty() && place.problems.size() == before)
    place.problem(
        "where",
        "selects no node. Compare it with the bounding box that coplane_mesh check prints.");
  mesh.nodeSets.push_back(
      {GlobalId(mesh.nodeSets.size()) + 1, card.name, {nodes.begin(), nodes.end()}});
}

void addSideSet(Mesh& mesh, const std::vector<Vec3>& own, const SetCard& card, Real tolerance,
                const std::vector<MeshFace>& faces, const std::vector<ElementPlace>& places,
                const CardPlace& place)
{
  if (isTaken(mesh.sideSets, card, place))
    return;
  const std::size_t before = place.problems.size();
  const Filter filter = filterOf(mesh, card, tolerance, place);
  const bool anyNormal = card.normal.empty();
  const Vec3 normal = anyNormal ? Vec3{} : normalised(toVec3(card.normal));
  // Faces within 26 degrees of the wanted normal: tells the sides of a block apart, also on a round
  // nose.
  constexpr Real leastCosine = 0.9;
  Mesh::SideSet set{GlobalId(mesh.sideSets.size()) + 1, card.name, {}, {}};
  for (const MeshFace& face : faces)
  {
    bool inside = face.count == 1 && filter.blocks[places[face.elements[0]].block];
    for (const int node : face.nodes)
      inside = inside && (node < 0 || filter.holds(mesh.coordinates[node], own[node]));
    if (!inside || (!anyNormal && dot(normalOf(mesh, face), normal) < leastCosine))
      continue;
    set.elements.push_back(face.elements[0]);
    set.sides.push_back(face.sides[0]);
  }
  if (set.elements.empty() && place.problems.size() == before)
    place.problem("where", "selects no exterior face. All nodes of a face must lie there, and its "
                           "normal within 26 degrees of `normal`.");
  mesh.sideSets.push_back(std::move(set));
}
} // namespace

void addSets(Mesh& mesh, const std::vector<Vec3>& ownCoordinates, const Recipe& recipe,
             Problems& problems)
{
  const Real tolerance = 1e-6 * sizeOf(mesh);
  const auto placeOf = [&](const char* group, const std::string& name)
  {
    return CardPlace{nodeAt(recipe.root, {group, name}), fmt::format("{}.{}", group, name),
                     problems};
  };
  for (const SetCard& card : recipe.nodeSets)
    addNodeSet(mesh, ownCoordinates, card, tolerance, placeOf("node_sets", card.name));
  if (recipe.sideSets.empty())
    return;
  const std::vector<MeshFace> faces = facesOf(mesh);
  const std::vector<ElementPlace> places = placesOfElements(mesh);
  for (const SetCard& card : recipe.sideSets)
    addSideSet(mesh, ownCoordinates, card, tolerance, faces, places,
               placeOf("side_sets", card.name));
}
} // namespace coplane
