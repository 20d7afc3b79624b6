#include "Cuts.hpp"

#include "JointRecipe.hpp"
#include "ShapeModel.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/Suggestion.hpp>

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

class CutSelector
{
public:
  CutSelector(const Mesh& mesh, const std::vector<MeshFace>& faces, const JointRecipe& recipe,
              Problems& problems)
      : mesh_(mesh), faces_(faces), places_(placesOfElements(mesh)), size_(sizeOf(mesh)),
        recipe_(recipe), problems_(problems), taken_(faces.size(), false)
  {
  }

  /// Faces of one joint that no joint before it has.
  void select(const JointCutCard& card, CutSelection& selection)
  {
    const CardPlace place{nodeAt(recipe_.root, {"joints", card.name}), "joints." + card.name,
                          problems_};
    const std::size_t before = problems_.size();
    for (const Mesh::SideSet& set : mesh_.sideSets)
      if (set.name == card.name)
        refuse(place, "is the name of a side set of the mesh already, and the joint "
                      "writes one; name the joint otherwise.");
    std::string note;
    std::vector<bool> wanted(faces_.size(), false);
    if (!card.planes.empty())
      note = selectPlanes(card, place, wanted);
    else if (!card.blocks.empty())
      selectBorders(card, place, wanted);
    else if (!card.everyFace.empty())
      selectEveryFace(card, place, wanted);
    else
      note = selectSideSets(card, place, wanted);
    Cut cut{card.name, {}};
    int others = 0;
    for (std::size_t f = 0; f < faces_.size(); ++f)
    {
      if (wanted[f] && taken_[f])
        ++others;
      else if (wanted[f])
      {
        taken_[f] = true;
        cut.faces.push_back(int(f));
      }
    }
    if (cut.faces.empty() && problems_.size() == before)
      refuse(place, fmt::format("finds no faces of its own: all {} belong to joints that come "
                                "before it.",
                                others));
    selection.notes.push_back(
        fmt::format("joint '{}': {}{} faces{}", card.name, note, cut.faces.size(),
                    others > 0 ? fmt::format("; {} more belong to joints before it", others) : ""));
    selection.cuts.push_back(std::move(cut));
  }

private:
  /// A problem of the joint as a whole.
  void refuse(const CardPlace& joint, const std::string& text)
  {
    problems_.add(joint.node, joint.path + " " + text);
  }

  PlaneSet planeSet(const PlanesCard& card) const
  {
    PlaneSet planes;
    planes.point = toVec3(card.point);
    planes.normal = normalised(toVec3(card.normal));
    planes.spacing = card.spacing;
    planes.count = card.count;
    planes.tolerance = card.tolerance > 0 ? card.tolerance : 1e-6 * size_;
    planes.leastCosine = std::cos(card.angle * pi / 180);
    const Real reach = 1e-6 * size_;
    if (!card.box.min.empty())
      planes.extents.push_back(boxExtent(toVec3(card.box.min), toVec3(card.box.max), reach));
    if (card.disc.radius > 0)
      planes.extents.push_back(
          discExtent(toVec3(card.disc.centre), card.disc.radius, planes.normal, reach));
    if (!card.segment.empty())
      planes.extents.push_back(segmentExtent(toPoints(card.segment), planes.normal, reach));
    if (!card.polygon.empty())
      planes.extents.push_back(polygonExtent(toPoints(card.polygon), planes.normal));
    return planes;
  }

  static Extent boxExtent(const Vec3& low, const Vec3& high, Real reach)
  {
    return [=](const Vec3& x)
    {
      for (int axis = 0; axis < 3; ++axis)
        if (x[axis] < low[axis] - reach || x[axis] > high[axis] + reach)
          return false;
      return true;
    };
  }

  static Extent discExtent(const Vec3& centre, Real radius, const Vec3& normal, Real reach)
  {
    return [=](const Vec3& x)
    {
      const Vec3 r = x - centre;
      return norm(r - dot(r, normal) * normal) <= radius + reach;
    };
  }

  static Extent segmentExtent(const std::vector<Vec3>& ends, const Vec3& normal, Real reach)
  {
    const Vec3 along{-normal.y, normal.x, 0};
    const Real a = dot(ends[0], along), b = dot(ends[1], along);
    return [=](const Vec3& x)
    {
      const Real s = dot(x, along);
      return s >= std::min(a, b) - reach && s <= std::max(a, b) + reach;
    };
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

  std::string selectPlanes(const JointCutCard& card, const CardPlace& joint,
                           std::vector<bool>& wanted)
  {
    const DeckNode& node = nodeAt(recipe_.root, {"joints", card.name, "planes"});
    const bool isList = node.kind == DeckNode::Kind::List;
    int total = 0;
    for (std::size_t i = 0; i < card.planes.size(); ++i)
    {
      const std::string path = joint.path + ".planes";
      total += selectPlaneSet(
          card.planes[i],
          {isList ? node.items[i] : node, isList ? fmt::format("{}.{}", path, i) : path, problems_},
          wanted);
    }
    return fmt::format("{} plane{}, ", total, total == 1 ? "" : "s");
  }

  /// Returns the number of planes that have faces.
  int selectPlaneSet(const PlanesCard& card, const CardPlace& place, std::vector<bool>& wanted)
  {
    const PlaneSet planes = planeSet(card);
    if (planes.spacing > 0 && !(planes.tolerance < planes.spacing / 2))
    {
      place.problem("tolerance", fmt::format("= {:.3g} m must be less than half the spacing = "
                                             "{:.3g} m{}.",
                                             planes.tolerance, planes.spacing / 2,
                                             card.tolerance > 0 ? ""
                                                                : " (by default it is 1e-6 of "
                                                                  "the mesh size)"));
      return 0;
    }
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
      place.problem("point",
                    fmt::format("and normal find no interior face of an element within tolerance = "
                                "{:.3g} m and angle. {}The cut follows element faces: mesh with "
                                "faces on the plane, or allow more distance and angle.",
                                planes.tolerance,
                                exterior > 0 ? fmt::format("{} exterior faces lie there, which "
                                                           "are apart already. ",
                                                           exterior)
                                             : ""));
    else
      for (int k = 0; k < planes.count; ++k)
        if (!facesOfPlane.count(k))
        {
          place.problem("count",
                        fmt::format("= {}, but plane {} of them, at distance {} m, finds no "
                                    "interior face. Leave count away for all planes that do.",
                                    planes.count, k + 1, k * planes.spacing));
          break;
        }
    return int(facesOfPlane.size());
  }

  /// The block's position, or -1 with a problem.
  int blockOfName(const CardPlace& joint, const std::string& name, const char* key = "blocks") const
  {
    std::vector<std::string> names;
    for (std::size_t b = 0; b < mesh_.blocks.size(); ++b)
    {
      if (mesh_.blocks[b].name == name)
        return int(b);
      names.push_back(mesh_.blocks[b].name);
    }
    joint.problem(key, fmt::format("names '{}', which is no block of the mesh.{}", name,
                                   didYouMean(name, names)));
    return -1;
  }

  void selectEveryFace(const JointCutCard& card, const CardPlace& joint,
                       std::vector<bool>& wanted) const
  {
    const bool all = card.everyFace.size() == 1 && card.everyFace[0] == "all";
    std::vector<bool> chosen(mesh_.blocks.size(), all);
    for (const std::string& name : card.everyFace)
      if (const int block = all ? -1 : blockOfName(joint, name, "every_face"); block >= 0)
        chosen[block] = true;
    bool found = false;
    for (std::size_t f = 0; f < faces_.size(); ++f)
      if (faces_[f].count == 2 && chosen[places_[faces_[f].elements[0]].block] &&
          chosen[places_[faces_[f].elements[1]].block])
        found = wanted[f] = true;
    if (!found && std::count(chosen.begin(), chosen.end(), true) > 0)
      joint.problem("every_face", "finds no face between two elements.");
  }

  std::set<std::pair<int, int>> pairsOf(const JointCutCard& card, const CardPlace& joint) const
  {
    std::set<std::pair<int, int>> pairs;
    for (const auto& names : card.blocks)
    {
      const int a = blockOfName(joint, names[0]), b = blockOfName(joint, names[1]);
      if (a == b && a >= 0)
        joint.problem("blocks", fmt::format("names '{}' twice in a pair; a border lies between two "
                                            "blocks.",
                                            names[0]));
      else if (a >= 0 && b >= 0)
        pairs.insert(std::minmax(a, b));
    }
    return pairs;
  }

  void selectBorders(const JointCutCard& card, const CardPlace& joint, std::vector<bool>& wanted)
  {
    const bool all = card.blocks[0].size() == 1;
    const auto pairs = all ? std::set<std::pair<int, int>>() : pairsOf(card, joint);
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
        joint.problem("blocks", fmt::format("'{}' and '{}' have no face in common.",
                                            mesh_.blocks[a].name, mesh_.blocks[b].name));
    if (all && found.empty())
      joint.problem("blocks", "= all, but no two blocks of the mesh have a face in common.");
  }

  /// The side set of that name, or nullptr with a problem.
  const Mesh::SideSet* sideSetOf(const CardPlace& joint, const std::string& name) const
  {
    std::vector<std::string> names;
    for (const Mesh::SideSet& set : mesh_.sideSets)
    {
      if (set.name == name)
        return &set;
      names.push_back(set.name);
    }
    joint.problem("side_sets", fmt::format("names '{}', which is no side set of the mesh.{}", name,
                                           didYouMean(name, names)));
    return nullptr;
  }

  std::string selectSideSets(const JointCutCard& card, const CardPlace& joint,
                             std::vector<bool>& wanted) const
  {
    std::map<std::pair<int, int>, int> faceOfSide;
    for (std::size_t f = 0; f < faces_.size(); ++f)
      for (int k = 0; k < faces_[f].count; ++k)
        faceOfSide[{faces_[f].elements[k], faces_[f].sides[k]}] = int(f);
    int exterior = 0;
    for (const std::string& name : card.sideSets)
    {
      const Mesh::SideSet* const set = sideSetOf(joint, name);
      if (!set)
        continue;
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
        joint.problem("side_sets",
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
  const JointRecipe& recipe_;
  Problems& problems_;
  std::vector<bool> taken_; ///< faces that joints before have
};
} // namespace

CutSelection selectCuts(const std::string& text, const std::string& name, const Mesh& mesh,
                        const std::vector<MeshFace>& faces,
                        const std::vector<std::string>& overrides)
{
  const JointRecipe recipe = parseJointRecipe(text, name, mesh.dimension, overrides);
  Problems problems;
  CutSelector selector(mesh, faces, recipe, problems);
  CutSelection selection;
  for (const JointCutCard& card : recipe.joints)
    selector.select(card, selection);
  if (!problems.empty())
    throw Error(ExitCode::Deck, problems.text());
  return selection;
}
} // namespace coplane
