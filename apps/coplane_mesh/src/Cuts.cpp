#include "Cuts.hpp"

#include "RecipeMap.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_schema/Suggestion.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

namespace coplane
{
namespace
{
/// Part of a plane, by the centres of faces.
using Extent = std::function<bool(const Vec3&)>;

/// Parallel planes; one is a set without spacing.
struct PlaneSet
{
  Vec3 point{}, normal{};
  Real spacing = 0; ///< [m]
  int count = 0;    ///< 0: as many as meet the mesh, to both sides of the point
  Real tolerance = 0, leastCosine = 1;
  std::vector<Extent> extents; ///< all must hold

  /// The number of the plane on which a face with this centre and normal lies.
  bool holds(const Vec3& centre, const Vec3& faceNormal, int& number) const
  {
    if (std::abs(dot(faceNormal, normal)) < leastCosine)
      return false;
    const Real distance = dot(centre - point, normal);
    number = spacing > 0 ? int(std::lround(distance / spacing)) : 0;
    if (std::abs(distance - number * spacing) > tolerance)
      return false;
    if (spacing > 0 && count > 0 && (number < 0 || number >= count))
      return false;
    return std::all_of(extents.begin(), extents.end(),
                       [&](const Extent& extent) { return extent(centre); });
  }
};

class CutReader
{
public:
  CutReader(const Mesh& mesh, const std::vector<MeshFace>& faces)
      : mesh_(mesh), faces_(faces), places_(placesOfElements(mesh)), size_(sizeOf(mesh))
  {
  }

  CutSelection read(const RecipeMap& recipe)
  {
    CutSelection selection;
    std::vector<bool> taken(faces_.size(), false);
    for (const auto& [name, node] : recipe.entries("joints"))
    {
      const RecipeMap joint(node, recipe.file(), recipe.pathOf("joints") + "." + name,
                            {"planes", "blocks", "side_sets"});
      if (joint.has("planes") + joint.has("blocks") + joint.has("side_sets") != 1)
        joint.refuse("planes", "or blocks or side_sets: give exactly one of them.");
      for (const Mesh::SideSet& set : mesh_.sideSets)
        if (set.name == name)
          joint.refuse("",
                       fmt::format("'{}' is the name of a side set of the mesh already, and the "
                                   "joint writes one; name the joint otherwise.",
                                   name));
      std::string note;
      std::vector<bool> wanted(faces_.size(), false);
      if (joint.has("planes"))
        note = selectPlanes(joint, wanted);
      else if (joint.has("blocks"))
        selectBorders(joint, wanted);
      else
        note = selectSideSets(joint, wanted);
      Cut cut{name, {}};
      int others = 0;
      for (std::size_t f = 0; f < faces_.size(); ++f)
      {
        if (wanted[f] && taken[f])
          ++others;
        else if (wanted[f])
        {
          taken[f] = true;
          cut.faces.push_back(int(f));
        }
      }
      if (cut.faces.empty())
        joint.refuse("", fmt::format("finds no faces of its own: all {} belong to joints that come "
                                     "before it.",
                                     others));
      selection.notes.push_back(fmt::format(
          "joint '{}': {}{} faces{}", name, note, cut.faces.size(),
          others > 0 ? fmt::format("; {} more belong to joints before it", others) : ""));
      selection.cuts.push_back(std::move(cut));
    }
    if (selection.cuts.empty())
      recipe.refuse("joints", "names no joint.");
    return selection;
  }

private:
  Vec3 direction(const RecipeMap& map, const std::string& key) const
  {
    const Vec3 vector = map.point(key, mesh_.dimension);
    if (!(norm(vector) > 0))
      map.refuse(key, "must not be zero.");
    return normalised(vector);
  }

  PlaneSet readPlanes(const RecipeMap& map) const
  {
    PlaneSet planes;
    planes.point = map.point("point", mesh_.dimension);
    planes.normal = direction(map, "normal");
    if (map.has("spacing"))
      planes.spacing = map.positive("spacing");
    if (map.has("count"))
    {
      if (!map.has("spacing"))
        map.refuse("count", "needs spacing.");
      planes.count = map.count("count");
    }
    planes.tolerance = map.has("tolerance") ? map.positive("tolerance") : 1e-6 * size_;
    if (planes.spacing > 0 && !(planes.tolerance < planes.spacing / 2))
      map.refuse("tolerance", fmt::format("= {} m must be less than half the spacing = {} m.",
                                          planes.tolerance, planes.spacing / 2));
    const Real degrees = map.has("angle") ? map.number("angle") : 1.0;
    if (!(degrees > 0 && degrees < 90))
      map.refuse("angle", fmt::format("= {} degrees must be between 0 and 90.", degrees));
    planes.leastCosine = std::cos(degrees * pi / 180);
    for (const char* key : {"box", "disc", "segment", "polygon"})
      if (map.has(key))
        planes.extents.push_back(readExtent(map, key, planes.normal));
    return planes;
  }

  Extent readExtent(const RecipeMap& map, const std::string& key, const Vec3& normal) const
  {
    const Real reach = 1e-6 * size_;
    if (key == "box")
    {
      const RecipeMap box = map.map(key, {"min", "max"});
      const Vec3 low = box.point("min", mesh_.dimension), high = box.point("max", mesh_.dimension);
      for (int axis = 0; axis < mesh_.dimension; ++axis)
        if (!(high[axis] >= low[axis]))
          box.refuse("max", fmt::format("= {} m along {} is less than min = {} m.", high[axis],
                                        "xyz"[axis], low[axis]));
      return [=](const Vec3& x)
      {
        for (int axis = 0; axis < 3; ++axis)
          if (x[axis] < low[axis] - reach || x[axis] > high[axis] + reach)
            return false;
        return true;
      };
    }
    if (key == "disc")
    {
      const RecipeMap disc = map.map(key, {"centre", "radius"});
      const Vec3 centre = disc.point("centre", mesh_.dimension);
      const Real radius = disc.positive("radius");
      return [=](const Vec3& x)
      {
        const Vec3 r = x - centre;
        return norm(r - dot(r, normal) * normal) <= radius + reach;
      };
    }
    if (key == "segment")
    {
      if (mesh_.dimension != 2)
        map.refuse(key, "is for two dimensions; use polygon, disc or box.");
      const std::vector<Vec3> ends = map.points(key, 2, 2);
      const Vec3 along{-normal.y, normal.x, 0};
      const Real a = dot(ends[0], along), b = dot(ends[1], along);
      return [=](const Vec3& x)
      {
        const Real s = dot(x, along);
        return s >= std::min(a, b) - reach && s <= std::max(a, b) + reach;
      };
    }
    if (mesh_.dimension != 3)
      map.refuse(key, "is for three dimensions; use segment, disc or box.");
    return polygonExtent(map.points(key, 3), normal);
  }

  /// Inside the shadow of a polygon along the normal: an odd number of its edges lies to one side.
  static Extent polygonExtent(const std::vector<Vec3>& corners, const Vec3& normal)
  {
    const int k = std::abs(normal.x) < 0.6 ? 0 : 1;
    Vec3 axis{};
    axis[k] = 1;
    const Vec3 u = normalised(axis - dot(axis, normal) * normal), v = cross(normal, u);
    std::vector<std::pair<Real, Real>> shadow;
    for (const Vec3& corner : corners)
      shadow.emplace_back(dot(corner, u), dot(corner, v));
    return [=](const Vec3& x)
    {
      const Real s = dot(x, u), t = dot(x, v);
      bool inside = false;
      for (std::size_t i = 0; i < shadow.size(); ++i)
      {
        const auto& a = shadow[i];
        const auto& b = shadow[(i + 1) % shadow.size()];
        if ((a.second > t) != (b.second > t) &&
            s < a.first + (t - a.second) / (b.second - a.second) * (b.first - a.first))
          inside = !inside;
      }
      return inside;
    };
  }

  std::string selectPlanes(const RecipeMap& joint, std::vector<bool>& wanted) const
  {
    std::vector<YAML::Node> nodes{joint.node("planes")};
    if (nodes[0].IsSequence())
      nodes = joint.list("planes");
    int total = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      const RecipeMap map(nodes[i], joint.file(),
                          joint.node("planes").IsSequence()
                              ? fmt::format("{}[{}]", joint.pathOf("planes"), i)
                              : joint.pathOf("planes"),
                          {"point", "normal", "spacing", "count", "tolerance", "angle", "box",
                           "disc", "segment", "polygon"});
      const PlaneSet planes = readPlanes(map);
      std::map<int, int> facesOfPlane;
      int exterior = 0, number = 0;
      for (std::size_t f = 0; f < faces_.size(); ++f)
        if (planes.holds(centreOf(mesh_, faces_[f]), normalOf(mesh_, faces_[f]), number))
        {
          if (faces_[f].count == 1)
          {
            ++exterior;
            continue;
          }
          wanted[f] = true;
          ++facesOfPlane[number];
        }
      if (facesOfPlane.empty())
        map.refuse(
            "point",
            fmt::format("and normal find no interior face of an element within tolerance = "
                        "{:.3g} m and angle. {}The cut follows element faces: mesh with faces "
                        "on the plane, or allow more distance and angle.",
                        planes.tolerance,
                        exterior > 0 ? fmt::format("{} exterior faces lie there, which are "
                                                   "apart already. ",
                                                   exterior)
                                     : ""));
      for (int k = 0; k < planes.count; ++k)
        if (!facesOfPlane.count(k))
          map.refuse("count", fmt::format("= {}, but plane {} of them, at distance {} m, finds no "
                                          "interior face. Leave count away for all planes that do.",
                                          planes.count, k + 1, k * planes.spacing));
      total += int(facesOfPlane.size());
    }
    return fmt::format("{} plane{}, ", total, total == 1 ? "" : "s");
  }

  int blockOfName(const RecipeMap& joint, const std::string& name) const
  {
    std::vector<std::string> names;
    for (std::size_t b = 0; b < mesh_.blocks.size(); ++b)
    {
      if (mesh_.blocks[b].name == name)
        return int(b);
      names.push_back(mesh_.blocks[b].name);
    }
    joint.refuse("blocks", fmt::format("names '{}', which is no block of the mesh.{}", name,
                                       didYouMean(name, names)));
  }

  void selectBorders(const RecipeMap& joint, std::vector<bool>& wanted) const
  {
    const YAML::Node value = joint.node("blocks");
    const bool all = value.IsScalar() && value.Scalar() == "all";
    std::set<std::pair<int, int>> pairs;
    if (!all)
    {
      const char* accepted =
          "must be the word all, or a list of pairs of block names: [[rock, liner]].";
      if (!value.IsSequence() || value.size() == 0)
        joint.refuse("blocks", accepted);
      for (const YAML::Node& pair : value)
      {
        if (!pair.IsSequence() || pair.size() != 2 || !pair[0].IsScalar() || !pair[1].IsScalar())
          joint.refuse("blocks", accepted);
        const int a = blockOfName(joint, pair[0].Scalar()),
                  b = blockOfName(joint, pair[1].Scalar());
        if (a == b)
          joint.refuse("blocks",
                       fmt::format("names '{}' twice in a pair; a border lies between two "
                                   "blocks.",
                                   pair[0].Scalar()));
        pairs.insert(std::minmax(a, b));
      }
    }
    std::set<std::pair<int, int>> found;
    for (std::size_t f = 0; f < faces_.size(); ++f)
    {
      if (faces_[f].count < 2)
        continue;
      const std::pair<int, int> blocks =
          std::minmax(places_[faces_[f].elements[0]].block, places_[faces_[f].elements[1]].block);
      if (blocks.first != blocks.second && (all || pairs.count(blocks)))
      {
        wanted[f] = true;
        found.insert(blocks);
      }
    }
    for (const auto& [a, b] : pairs)
      if (!found.count({a, b}))
        joint.refuse("blocks", fmt::format("'{}' and '{}' have no face in common.",
                                           mesh_.blocks[a].name, mesh_.blocks[b].name));
    if (found.empty())
      joint.refuse("blocks", "= all, but no two blocks of the mesh have a face in common.");
  }

  std::string selectSideSets(const RecipeMap& joint, std::vector<bool>& wanted) const
  {
    std::map<std::pair<int, int>, int> faceOfSide;
    for (std::size_t f = 0; f < faces_.size(); ++f)
      for (int k = 0; k < faces_[f].count; ++k)
        faceOfSide[{faces_[f].elements[k], faces_[f].sides[k]}] = int(f);
    int exterior = 0;
    for (const std::string& name : joint.texts("side_sets"))
    {
      std::vector<std::string> names;
      const Mesh::SideSet* set = nullptr;
      for (const Mesh::SideSet& other : mesh_.sideSets)
      {
        names.push_back(other.name);
        if (other.name == name)
          set = &other;
      }
      if (!set)
      {
        joint.refuse("side_sets", fmt::format("names '{}', which is no side set of the mesh.{}",
                                              name, didYouMean(name, names)));
      }
      int interior = 0;
      for (std::size_t i = 0; i < set->elements.size(); ++i)
      {
        const int face = faceOfSide.at({set->elements[i], set->sides[i]});
        if (faces_[face].count == 2)
        {
          wanted[face] = true;
          ++interior;
        }
        else
          ++exterior;
      }
      if (interior == 0)
        joint.refuse("side_sets",
                     fmt::format("'{}' has no interior face: all {} are on the surface, "
                                 "which is apart already.",
                                 name, set->elements.size()));
    }
    return exterior > 0 ? fmt::format("{} exterior faces of side sets left out, ", exterior) : "";
  }

  const Mesh& mesh_;
  const std::vector<MeshFace>& faces_;
  std::vector<ElementPlace> places_;
  Real size_; ///< of the mesh [m]
};
} // namespace

CutSelection selectCuts(const std::string& text, const std::string& name, const Mesh& mesh,
                        const std::vector<MeshFace>& faces)
{
  return CutReader(mesh, faces).read(RecipeMap(parseRecipe(text, name), name, "", {"joints"}));
}

const char* cutsHelp()
{
  return R"(A recipe of joints is a YAML file. Lengths are in metres, angles in degrees. [..] are lists of 2 or 3 numbers, by dimension.

joints:                          cut in the order of the file; a face that several find belongs to the first
  name:                          also the name of the side set that holds both faces of every cut face
    planes:                      a map like this one, or a list of them
      point: [..]                of the plane
      normal: [..]
      spacing: l                 optional: parallel planes at this distance, through the point, as many as meet the mesh
      count: n                   optional, with spacing: so many, from the point along the normal
      segment: [[..], [..]]      optional, 2D: only between the shadows of two points on the plane
      disc: {centre: [..], radius: r}  optional: only within a circle
      box: {min: [..], max: [..]}  optional: only within a box
      polygon: [[..], [..], ..]  optional, 3D: only within the shadow of a polygon on the plane
      tolerance: l               optional: distance of face centres from the plane; default 1e-6 of the mesh size
      angle: degrees             optional: between the normals of face and plane; default 1
  name:
    blocks: all | [[a, b], ..]   borders of all blocks, or of pairs
  name:
    side_sets: name or list      faces of side sets inside the mesh
)";
}
} // namespace coplane
