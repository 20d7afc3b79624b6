#include "CutBlocks.hpp"

#include "CutEstimate.hpp"
#include "ElementSizes.hpp"
#include "GmshModel.hpp"
#include "JointSurfaces.hpp"
#include "MeshDomain.hpp"
#include "OpeningSection.hpp"
#include "ShapeModel.hpp"
#include "SolidFile.hpp"
#include "VoronoiCells.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/PlaceText.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gmsh.h>
#include <map>
#include <numeric>
#include <set>

namespace coplane
{
namespace
{
namespace occ = gmsh::model::occ;

/// Gmsh as long as one mesh is made: silent, and with the same result every time.
class Session
{
public:
  Session()
  {
    gmsh::initialize();
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("General.NumThreads", 1);
    gmsh::option::setNumber("Geometry.OCCParallel", 0);
    gmsh::option::setNumber("Mesh.Smoothing", 0); // it has moved nodes across joints that end
    gmsh::model::add("blocks");
  }
  ~Session() { gmsh::finalize(); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
};

int addPolygon(const std::vector<Vec3>& corners)
{
  std::vector<int> points, lines;
  for (const Vec3& corner : corners)
    points.push_back(occ::addPoint(corner.x, corner.y, corner.z));
  for (std::size_t k = 0; k < points.size(); ++k)
    lines.push_back(occ::addLine(points[k], points[(k + 1) % points.size()]));
  return occ::addPlaneSurface({occ::addCurveLoop(lines)});
}

int addShell(const Polyhedron& solid)
{
  std::vector<int> points, faces;
  for (const Vec3& x : solid.points)
    points.push_back(occ::addPoint(x.x, x.y, x.z));
  std::map<std::pair<int, int>, int> lines; // both ways round
  for (const std::vector<int>& face : solid.faces)
  {
    std::vector<int> loop;
    for (std::size_t k = 0; k < face.size(); ++k)
    {
      const int a = points[std::size_t(face[k])],
                b = points[std::size_t(face[(k + 1) % face.size()])];
      if (!lines.count({a, b}))
      {
        lines[{a, b}] = occ::addLine(a, b);
        lines[{b, a}] = -lines[{a, b}];
      }
      loop.push_back(lines[{a, b}]);
    }
    faces.push_back(occ::addPlaneSurface({occ::addCurveLoop(loop)}));
  }
  return occ::addVolume({occ::addSurfaceLoop(faces)});
}

int addSolid(const Polyhedron& solid)
{
  const int outside = addShell(solid);
  if (solid.cavities.empty())
    return outside;
  Entities cavities, rest;
  for (const Polyhedron& cavity : solid.cavities)
    cavities.push_back({3, addShell(cavity)});
  std::vector<Entities> parts;
  occ::cut({{3, outside}}, cavities, rest, parts);
  return rest.at(0).second;
}

/// Cuts one domain.
class Cutter
{
public:
  Cutter(const BlocksRecipe& recipe, const std::string& recipeFile, const MeshingWay& way,
         Stages& stages)
      : recipe_(recipe), recipeFile_(recipeFile), way_(way), stages_(stages),
        dimension_(recipe.dimension), limits_(limitsOf(recipe))
  {
    size_ = recipe.elements.size;
  }

  CutDomain cut()
  {
    begin("the domain was read");
    addDomain();
    demandFewSides(recipe_, recipeFile_, low_, high_);
    demandFewElements();
    begin("Gmsh cut the domain");
    for (const OpeningCard& opening : recipe_.openings)
      addOpening(opening);
    addJoints();
    fragment();
    checkOpenings();
    measureJoints();
    for (int round = 0; round < 20 && joinSlivers(); ++round)
      fragment();
    removeOpenings();
    nameEntities();
    meshDomain(recipe_, recipeFile_, way_, stages_,
               {low_, high_, pieces_, walls_, sized_, groupOfJoint_}, result_);
    return std::move(result_);
  }

private:
  /// An opening or the domain, as bodies of the geometry.
  struct Body
  {
    int opening = -1; ///< position in the recipe; -1: the domain
    bool support = false;
    std::string name; ///< of a solid of a file
    Entity entity;
  };

  void begin(const std::string& stage) { stages_.begin(stage, recipe_.elements.timeLimit); }

  void addDomain()
  {
    const DomainCard& card = recipe_.domain;
    if (!card.box.min.empty())
    {
      low_ = toVec3(card.box.min);
      high_ = toVec3(card.box.max);
      const Vec3 d = high_ - low_;
      addBody(-1, dimension_ == 2 ? occ::addRectangle(low_.x, low_.y, 0, d.x, d.y)
                                  : occ::addBox(low_.x, low_.y, low_.z, d.x, d.y, d.z));
      return;
    }
    low_ = {infinity, infinity, infinity};
    high_ = -low_;
    const auto widen = [&](const std::vector<Vec3>& points)
    {
      for (const Vec3& x : points)
        for (int axis = 0; axis < 3; ++axis)
        {
          low_[axis] = std::min(low_[axis], x[axis]);
          high_[axis] = std::max(high_[axis], x[axis]);
        }
    };
    if (!card.polygon.empty())
    {
      widen(toPoints(card.polygon));
      return addBody(-1, addPolygon(toPoints(card.polygon)));
    }
    const auto file = std::filesystem::path(recipeFile_).parent_path() / card.file;
    for (const Polyhedron& solid : readSolids(file.string()))
    {
      widen(solid.points);
      addBody(-1, addSolid(solid), solid.support, solid.name);
    }
  }

  void addBody(int opening, int tag, bool support = false, const std::string& name = "")
  {
    bodies_.push_back({opening, support, name, {dimension_, tag}});
  }

  /// Before anything is cut: how many elements the sizes ask for, about; joints make it more.
  void demandFewElements() const
  {
    const bool flat = dimension_ == 2, cubes = recipe_.elements.shape == BlockElements::Cubes;
    const Real perVolume = flat ? (cubes ? 1 : 2.3) : (cubes ? 3 : 6);
    const auto count = [&](Real volume, Real size)
    { return perVolume * volume / std::pow(size, dimension_); };
    Real domain = 0, supports = 0;
    for (const Body& body : bodies_)
      (body.support ? supports : domain) += measureOf(body.entity);
    std::map<std::string, Real> volumes{{recipe_.domain.block, domain}};
    volumes[recipe_.domain.supports] += supports;
    Real elements = count(domain + supports, size_);
    for (const OpeningCard& opening : recipe_.openings)
    {
      const auto [perimeter, area] = measuresOf(opening);
      const Real length = flat ? 1 : norm(toVec3(opening.path[1]) - toVec3(opening.path[0]));
      volumes[opening.name] = length * area;
      if (const Real size = opening.elementSize; size > 0) // growing to both sides of its wall
        elements += 2 * count(length * perimeter, size) * size /
                    (recipe_.elements.growth * (dimension_ - 1));
    }
    for (const ElementSizeCard& region : recipe_.elements.regions)
    {
      Real volume = 1;
      if (!region.block.empty())
        volume = volumes.count(region.block) ? volumes.at(region.block) : 0;
      else
        for (int axis = 0; axis < dimension_; ++axis)
          volume *= std::max(0.0, std::min(region.box.max[std::size_t(axis)], high_[axis]) -
                                      std::max(region.box.min[std::size_t(axis)], low_[axis]));
      elements += count(volume, region.size);
    }
    if (elements > recipe_.elements.most)
      fail(ExitCode::Deck,
           "{}: the sizes of elements ask for about {:.2g} elements (elements.size = {:.6g} m, the "
           "least size anywhere {:.6g} m, the domain has {:.4g} {}), and up to elements.most = "
           "{:.6g} are meshed. All lengths are in metres. Make elements larger, or raise "
           "elements.most.",
           recipeFile_, elements, size_, leastSizeOf(recipe_), domain + supports,
           flat ? "m^2" : "m^3", recipe_.elements.most);
  }

  void addOpening(const OpeningCard& card)
  {
    const int number = int(&card - recipe_.openings.data());
    Vec3 origin, right{1, 0, 0}, upward{0, 1, 0}, along{};
    if (dimension_ == 2)
      origin = toVec3(card.at);
    else
    {
      origin = toVec3(card.path[0]);
      along = toVec3(card.path[1]) - origin;
      if (!(norm(along) > 0))
        fail(ExitCode::Deck, "{}: openings.{}.path has no length.", recipeFile_, card.name);
      right = cross(along, recipe_.up);
      if (!(norm(right) > 1e-6 * norm(along) * norm(recipe_.up))) // a shaft
        right = cross(along, recipe_.north);
      right = normalised(right);
      upward = normalised(cross(right, along));
    }
    std::vector<Vec3> corners;
    for (const auto& [s, t] : sectionOf(card, card.elementSize > 0 ? card.elementSize : size_))
      corners.push_back(origin + s * right + t * upward);
    int tag = addPolygon(corners);
    if (dimension_ == 3)
    {
      Entities swept;
      occ::extrude({{2, tag}}, along.x, along.y, along.z, swept);
      for (const Entity& entity : swept)
        if (entity.first == 3)
          tag = entity.second;
      // Lower ends of an extrusion are the section itself, which stays part of the volume.
    }
    addBody(number, tag);
  }

  void addJoints()
  {
    Problems problems;
    std::vector<JointSurface> surfaces = jointSurfaces(recipe_, recipeFile_, low_, high_, problems);
    if (!problems.empty())
      throw Error(ExitCode::Deck, problems.text());
    demandFewParts(recipe_, recipeFile_, surfaces, low_, high_, limits_.thickness);
    for (std::size_t j = 0; j < recipe_.joints.size(); ++j)
    {
      result_.joints.push_back(recipe_.joints[j].name);
      if (const VoronoiCard& card = recipe_.joints[j].voronoi; card.cells > 0)
        for (const JointSurface& surface :
             voronoiSurfaces(card, int(j), recipe_.seed, dimension_, low_, high_))
          surfaces.push_back(surface);
    }
    if (!recipe_.domain.joint.empty())
      result_.joints.push_back(recipe_.domain.joint);
    std::stable_sort(surfaces.begin(), surfaces.end(),
                     [](const auto& a, const auto& b) { return a.joint < b.joint; });
    result_.notes = notesOfSizes(recipe_, low_, high_);
    Entities tools;
    std::vector<int> joints;
    for (const JointSurface& surface : surfaces)
    {
      if (dimension_ == 3)
        tools.push_back({2, addPolygon(surface.corners)});
      else
        tools.push_back(
            {1, occ::addLine(addPoint(surface.corners[0]), addPoint(surface.corners[1]))});
      joints.push_back(surface.joint);
    }
    if (tools.empty())
      return;
    // Only what lies inside, so that nothing hangs about outside.
    Entities domain, inside;
    for (const Body& body : bodies_)
      if (body.opening < 0)
        domain.push_back(body.entity);
    std::vector<Entities> pieces;
    occ::intersect(tools, domain, inside, pieces, -1, true, false);
    std::set<Entity> taken;
    std::set<int> covered; // joints with pieces where one before them has the place
    std::vector<bool> outside(tools.size(), true);
    for (std::size_t t = 0; t < tools.size(); ++t)
      for (const Entity& piece : pieces[t])
        if (piece.first == dimension_ - 1)
        {
          outside[t] = false;
          if (taken.insert(piece).second)
            pieces_[piece] = joints[t];
          else
            covered.insert(joints[t]);
        }
    for (std::size_t j = 0; j < recipe_.joints.size(); ++j)
      if (std::none_of(pieces_.begin(), pieces_.end(),
                       [&](const auto& piece) { return piece.second == int(j); }))
      {
        if (covered.count(int(j)))
          fail(ExitCode::Deck,
               "{}: joints.{} lies wholly on joints that stand before it, which have the place.",
               recipeFile_, recipe_.joints[j].name);
        refuseJoint(j);
      }
    for (const std::string& note : notesOfOutside(recipe_, surfaces, outside))
      result_.notes.push_back(note);
  }

  /// Each opening has a part of the domain of its own; notes which take most of it.
  void checkOpenings()
  {
    std::set<int> there;
    for (const auto& [block, opening] : blocks_)
      there.insert(opening);
    for (std::size_t o = 0; o < recipe_.openings.size(); ++o)
      if (!there.count(int(o)))
        fail(ExitCode::Deck,
             "{}: openings.{} has no part of the domain, or only such that openings before it "
             "have.",
             recipeFile_, recipe_.openings[o].name);
    std::vector<Real> shares(recipe_.openings.size(), 0);
    Real all = 0;
    for (const auto& [block, opening] : blocks_)
    {
      all += measureOf(block);
      if (opening >= 0)
        shares[std::size_t(opening)] += measureOf(block);
    }
    for (Real& share : shares)
      share /= all;
    for (const std::string& note : notesOfLargeOpenings(recipe_, shares))
      result_.notes.push_back(note);
  }

  static Vec3 middleOf(const Entity& entity)
  {
    Vec3 x;
    occ::getCenterOfMass(entity.first, entity.second, x.x, x.y, x.z);
    return x;
  }

  /// How much of each joint is inside of what stays, before anything is left out.
  void measureJoints()
  {
    const std::set<int> loose = loosePieces(false);
    result_.measures.assign(result_.joints.size(), {});
    for (const auto& [piece, joint] : pieces_)
    {
      const std::vector<int> sides = blocksAt(piece); // those of bodies_, too, on the border
      const auto stay = std::count_if(
          sides.begin(), sides.end(),
          [&](int side) {
            return blocks_.count({dimension_, side}) > 0 && !isRemoved({dimension_, side});
          });
      if (loose.count(piece.second) || stay == 2)
        result_.measures[std::size_t(joint)].asked += measureOf(piece);
    }
  }

  /// A part of a joint that will not be cut. @param sum of its kind, in the measures of joints
  void leaveOut(const Entity& piece, Real JointMeasure::*sum)
  {
    JointMeasure& measure = result_.measures[std::size_t(pieces_.at(piece))];
    measure.*sum += measureOf(piece);
    measure.leaveOut(measureOf(piece), middleOf(piece));
  }

  static int addPoint(const Vec3& x) { return occ::addPoint(x.x, x.y, x.z); }

  /// Makes bodies and joints conform; `bodies_` stay as they are, for another time.
  void fragment()
  {
    Entities objects, tools, all;
    for (const Body& body : bodies_)
    {
      Entities copy;
      occ::copy({body.entity}, copy);
      objects.push_back(copy.at(0));
    }
    for (const auto& [piece, joint] : pieces_)
      tools.push_back(piece);
    if (tools.empty()) // Gmsh wants some
    {
      tools.assign(objects.begin() + 1, objects.end());
      objects.resize(1);
    }
    std::vector<Entities> parts{objects};
    if (!tools.empty())
      occ::fragment(objects, tools, all, parts);
    demandApart(parts);
    blocks_.clear();
    isSupport_.clear();
    // A part of the domain that is also one of an opening belongs to the first opening; what an
    // opening has outside of the domain is no part of the model.
    std::map<Entity, int> openingOf;
    std::set<Entity> inDomain;
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      for (const Entity& part : parts[b])
        if (bodies_[b].opening < 0)
        {
          inDomain.insert(part);
          isSupport_[part] = bodies_[b].support;
        }
        else
          openingOf.insert({part, bodies_[b].opening});
    Entities outside;
    for (const auto& [part, opening] : openingOf)
      if (!inDomain.count(part))
        outside.push_back(part);
    for (const Entity& part : inDomain)
    {
      const auto opening = openingOf.find(part);
      blocks_[part] = opening == openingOf.end() ? -1 : opening->second;
    }
    std::map<Entity, int> pieces;
    std::size_t t = bodies_.size();
    for (const auto& [piece, joint] : pieces_)
      for (const Entity& part : parts[t++])
      {
        const auto [place, isNew] = pieces.insert({part, joint});
        if (!isNew)
          place->second = std::min(place->second, joint);
      }
    pieces_ = std::move(pieces);
    occ::remove(outside, true);
    occ::synchronize();
    if (!recipe_.domain.joint.empty())
      addBordersOfSolids(parts);
  }

  /// Solids of a file may touch, and no more; what both have would be given to one of them.
  void demandApart(const std::vector<Entities>& parts) const
  {
    constexpr Real rounding = 1e-6; // coordinates of files have single precision
    std::map<Entity, std::vector<std::size_t>> solidsOf;
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      if (bodies_[b].opening < 0)
        for (const Entity& part : parts[b])
          solidsOf[part].push_back(b);
    std::map<std::pair<std::size_t, std::size_t>, Real> shared;
    for (const auto& [part, solids] : solidsOf)
      for (std::size_t i = 0; i < solids.size(); ++i)
        for (std::size_t k = i + 1; k < solids.size(); ++k)
          shared[{solids[i], solids[k]}] += measureOf(part);
    std::vector<std::string> pairs;
    for (const auto& [pair, volume] : shared)
    {
      const Body &a = bodies_[pair.first], &b = bodies_[pair.second];
      if (volume > rounding * std::min(measureOf(a.entity), measureOf(b.entity)))
        pairs.push_back(fmt::format("'{}' and '{}' by {:.4g} m^3", a.name, b.name, volume));
    }
    if (pairs.empty())
      return;
    const std::size_t told = std::min<std::size_t>(pairs.size(), 10);
    fail(ExitCode::Mesh,
         "{}: solids of domain.file = {} overlap: {}{}. Accepted: solids that are apart or touch; "
         "move them, or cut one out of the other where they were drawn.",
         recipeFile_, recipe_.domain.file, fmt::join(pairs.begin(), pairs.begin() + told, ", "),
         pairs.size() > told ? fmt::format(", and {} more pairs", pairs.size() - told) : "");
  }

  /// Where solids of a file touch is a joint as well, unless one of the recipe has the place.
  void addBordersOfSolids(const std::vector<Entities>& parts)
  {
    std::map<int, std::size_t> solidOf;
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      if (bodies_[b].opening < 0)
        for (const Entity& part : parts[b])
          solidOf.insert({part.second, b});
    for (const auto& [block, opening] : blocks_)
      for (const int face : bordersOf(block))
      {
        const std::vector<int> sides = blocksAt({dimension_ - 1, face});
        if (sides.size() == 2 && solidOf[sides[0]] != solidOf[sides[1]])
          pieces_.insert({{dimension_ - 1, face}, int(recipe_.joints.size())});
      }
  }

  bool isRemoved(const Entity& block) const
  {
    const int opening = blocks_.at(block);
    return opening >= 0 && !recipe_.openings[std::size_t(opening)].keep;
  }

  bool isSliver(const Entity& block) const
  {
    const Real volume = measureOf(block);
    Real largest = 0;
    for (const int face : bordersOf(block))
      largest = std::max(largest, measureOf({dimension_ - 1, face}));
    return volume < limits_.volume || volume < limits_.thickness * largest;
  }

  /// Faces of joints that end inside of blocks. @param removed those in openings that are cut out,
  /// too
  std::set<int> loosePieces(bool removed = true) const
  {
    std::set<int> loose;
    for (const auto& [block, opening] : blocks_)
    {
      if (!removed && isRemoved(block))
        continue;
      Entities embedded;
      gmsh::model::mesh::getEmbedded(block.first, block.second, embedded);
      for (const Entity& entity : embedded)
        if (entity.first == dimension_ - 1)
          loose.insert(entity.second);
    }
    return loose;
  }

  /// Whether a piece reaches less than the least length into its block: a short end beyond another
  /// joint.
  bool isStub(int face) const
  {
    const Real measure = measureOf({dimension_ - 1, face});
    if (dimension_ == 2)
      return measure < limits_.stub;
    Real longest = 0;
    for (const int curve : bordersOf({2, face}))
      longest = std::max(longest, measureOf({1, curve}));
    return measure < limits_.stub * longest;
  }

  /// Takes the joints away between slivers and their neighbours, and all bodies, which are then
  /// made anew. Returns whether there was something to do.
  bool joinSlivers()
  {
    std::vector<std::pair<Real, Entity>> slivers;
    for (const auto& [block, opening] : blocks_)
      if (!isRemoved(block) && isSliver(block))
        slivers.push_back({measureOf(block), block});
    std::sort(slivers.begin(), slivers.end());
    std::set<int> touched;
    std::set<Entity> dropped;
    const std::set<int> told = loosePieces(false);
    for (const int face : loosePieces())
      if (isStub(face))
      {
        const Entity piece{dimension_ - 1, face};
        dropped.insert(piece);
        if (told.count(face) && pieces_.count(piece))
          leaveOut(piece, &JointMeasure::stubs);
      }
    result_.stubs += int(dropped.size());
    result_.slivers = 0;
    for (const auto& [volume, block] : slivers)
    {
      std::map<int, Real> borderOf; // by the neighbour
      std::map<int, std::vector<Entity>> facesTo;
      for (const int face : bordersOf(block))
        for (const int other : blocksAt({dimension_ - 1, face}))
          if (other != block.second && pieces_.count({dimension_ - 1, face}) &&
              blocks_.at({dimension_, other}) == blocks_.at(block))
          {
            borderOf[other] += measureOf({dimension_ - 1, face});
            facesTo[other].push_back({dimension_ - 1, face});
          }
      const auto largest =
          std::max_element(borderOf.begin(), borderOf.end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
      if (largest == borderOf.end())
      {
        ++result_.slivers;
        continue;
      }
      if (touched.count(block.second) || touched.count(largest->first))
        continue; // next round
      touched.insert({block.second, largest->first});
      ++result_.joined;
      for (const Entity& piece : facesTo[largest->first])
        if (dropped.insert(piece).second)
          leaveOut(piece, &JointMeasure::slivers);
    }
    if (dropped.empty())
      return false;
    for (const Entity& piece : dropped)
      pieces_.erase(piece);
    Entities blocks, faces;
    for (const auto& [block, opening] : blocks_)
    {
      blocks.push_back(block);
      for (const int face : bordersOf(block))
        if (!pieces_.count({dimension_ - 1, face}))
          faces.push_back({dimension_ - 1, face});
    }
    occ::remove(blocks, false);
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    occ::remove(faces, true);
    return true;
  }

  void removeOpenings()
  {
    Entities removed;
    for (const auto& [block, opening] : blocks_)
    {
      if (opening >= 0)
        for (const int face : bordersOf(block))
        {
          const std::vector<int> sides = blocksAt({dimension_ - 1, face});
          if (sides.size() != 2 ||
              blocks_.at({dimension_, sides[0]}) == blocks_.at({dimension_, sides[1]}))
            continue;
          walls_.insert({dimension_ - 1, face});
          if (recipe_.openings[std::size_t(opening)].elementSize > 0)
            sized_.walls[opening].push_back(face);
        }
      if (isRemoved(block))
        removed.push_back(block);
    }
    for (const Body& body : bodies_)
      removed.push_back(body.entity);
    for (const Entity& block : removed)
      blocks_.erase(block);
    occ::remove(removed, true);
    occ::synchronize();
    if (blocks_.empty())
      fail(ExitCode::Deck, "{}: the openings leave nothing of the domain.", recipeFile_);
    forgetPiecesInOpenings();
  }

  /// Parts of joints that are in what was removed, which took most of them along.
  void forgetPiecesInOpenings()
  {
    Entities left, loose;
    gmsh::model::getEntities(left, dimension_ - 1);
    const std::set<Entity> there(left.begin(), left.end());
    const std::set<int> inside = loosePieces();
    for (auto piece = pieces_.begin(); piece != pieces_.end();)
    {
      const bool exists = there.count(piece->first) > 0;
      if (exists && (inside.count(piece->first.second) || !blocksAt(piece->first).empty()))
      {
        ++piece;
        continue;
      }
      if (exists)
        loose.push_back(piece->first);
      piece = pieces_.erase(piece);
    }
    occ::remove(loose, true);
    occ::synchronize();
  }

  void nameEntities()
  {
    std::map<std::string, std::vector<int>>& blocks = sized_.blocks;
    const std::set<int> inside = loosePieces();
    for (const auto& [block, opening] : blocks_)
    {
      blocks[opening >= 0           ? recipe_.openings[std::size_t(opening)].name
             : isSupport_.at(block) ? recipe_.domain.supports
                                    : recipe_.domain.block]
          .push_back(block.second);
      result_.blockVolumes.push_back(measureOf(block));
    }
    for (const auto& [name, tags] : blocks)
      addGroup(dimension_, tags, name);
    std::vector<std::vector<int>> faces(result_.joints.size());
    for (const auto& [piece, joint] : pieces_)
      if (inside.count(piece.second) || blocksAt(piece).size() == 2)
        faces[std::size_t(joint)].push_back(piece.second);
    for (std::size_t j = 0; j < faces.size(); ++j)
    {
      if (faces[j].empty())
        refuseJoint(j);
      groupOfJoint_.push_back(addGroup(dimension_ - 1, faces[j], result_.joints[j]));
    }
  }

  [[noreturn]] void refuseJoint(std::size_t joint) const
  {
    fail(ExitCode::Deck,
         "{}: joints.{} has no face inside of the domain, which reaches from {} to {} m{}.",
         recipeFile_, result_.joints[joint], placeText(low_, size_ / 10),
         placeText(high_, size_ / 10),
         result_.joined + result_.stubs > 0 ? ", or all that it had were left out as slivers" : "");
  }

  int addGroup(int dimension, const std::vector<int>& tags, const std::string& name)
  {
    const int number = gmsh::model::addPhysicalGroup(dimension, tags);
    gmsh::model::setPhysicalName(dimension, number, name);
    result_.mesh.physicalNames[{dimension, number}] = name;
    for (const int tag : tags)
      result_.mesh.physicalsOfEntity[{dimension, tag}] = {number};
    return number;
  }

  const BlocksRecipe& recipe_;
  const std::string& recipeFile_;
  const MeshingWay& way_;
  Stages& stages_;
  int dimension_;
  Real size_;
  SliverLimits limits_;
  Vec3 low_{}, high_{};
  std::vector<Body> bodies_;
  std::map<Entity, int> pieces_;     ///< parts of joints, and whose
  std::map<Entity, int> blocks_;     ///< and the opening they are in; -1: none
  std::map<Entity, bool> isSupport_; ///< blocks of the domain
  std::set<Entity> walls_;           ///< faces of openings
  SizedParts sized_;
  std::vector<int> groupOfJoint_; ///< numbers of Gmsh
  CutDomain result_;
};
} // namespace

CutDomain cutDomain(const BlocksRecipe& recipe, const std::string& recipeFile,
                    const MeshingWay& way, Stages& stages)
{
  const Session session;
  try
  {
    return Cutter(recipe, recipeFile, way, stages).cut();
  }
  catch (const Error&)
  {
    throw;
  }
  catch (const std::bad_alloc&)
  {
    throw;
  }
  catch (...) // Gmsh throws whatever it likes; its words are in its log
  {
    std::string last;
    gmsh::logger::getLastError(last);
    throw Error(ExitCode::Computation, last.empty() ? "it gives no reason" : last);
  }
}
} // namespace coplane
