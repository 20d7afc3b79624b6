#include "MeshDomain.hpp"

#include "CubesOfTetrahedra.hpp"
#include "GmshModel.hpp"
#include "MeasureOfElements.hpp"
#include "MendSimplices.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/PlaceText.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace coplane
{
namespace
{
/// Meshes one domain.
class Mesher
{
public:
  Mesher(const BlocksRecipe& recipe, const std::string& recipeFile, const MeshingWay& way,
         Stages& stages, const CutGeometry& geometry, CutDomain& domain)
      : recipe_(recipe), recipeFile_(recipeFile), way_(way), stages_(stages), geometry_(geometry),
        result_(domain), dimension_(recipe.dimension), limits_(limitsOf(recipe))
  {
  }

  void mesh()
  {
    const bool cubes = recipe_.elements.shape == BlockElements::Cubes;
    stages_.begin("sizes of elements were set", recipe_.elements.timeLimit);
    setElementSizes(recipe_, recipeFile_,
                    geometry_.sized, // each cube is cut in half along its edges
                    way_.sizeFactor * (cubes ? 2 : 1));
    gmsh::option::setNumber("Mesh.Algorithm", way_.faceAlgorithm);
    gmsh::option::setNumber("Mesh.RandomSeed", way_.seed);
    stages_.begin(meshingStage, recipe_.elements.timeLimit);
    gmsh::model::mesh::generate(dimension_);
    readNodes();
    GlobalId next = 0;
    for (int d = dimension_; d >= dimension_ - 1; --d)
      for (const auto& [entity, groups] : result_.mesh.physicalsOfEntity)
        if (entity.first == d)
          readElements(entity, next);
    demandFilled();
    stages_.begin("flat elements were mended", recipe_.elements.timeLimit);
    const Real size = (cubes ? 2 : 1) * leastSizeOf(recipe_);
    result_.worstBefore = findWorst(size);
    if (dimension_ == 2)
      mendElements<TrianglesWithSurfaces>(size);
    else
      mendElements<TetrahedraWithSurfaces>(size);
    demandWorth();
    if (!cubes)
      return;
    cutIntoCubes(result_.mesh);
    findWorst(leastSizeOf(recipe_));
    demandWorth();
  }

  /// Gmsh has left gaps, and put elements on each other, without a word.
  void demandFilled() const
  {
    const Real filled = measureOfElements(result_.mesh, dimension_);
    const Real volume =
        std::accumulate(result_.blockVolumes.begin(), result_.blockVolumes.end(), 0.0);
    if (!(std::abs(filled - volume) <= 1e-6 * volume))
      throw Error(ExitCode::Computation,
                  fmt::format("its elements fill {:.9g} of {:.9g} {}", filled, volume,
                              dimension_ == 2 ? "m^2" : "m^3"));
  }

  /// The least worth of an element, and its place.
  Real findWorst(Real size)
  {
    Real least = infinity;
    for (const GmshFile::Element& element : result_.mesh.elements)
    {
      if (element.entity.first != dimension_)
        continue;
      std::array<Vec3, 8> x{};
      const std::size_t count = std::size_t(nodesOfGmshType(element.type));
      for (std::size_t k = 0; k < count; ++k)
        x[k] = result_.mesh.coordinates[std::size_t(element.nodes[k])];
      Real worth = infinity;
      if (count == 8)
        worth = worthOf(x, size);
      else if (dimension_ == 3)
        worth = worthOf(std::array<Vec3, 4>{x[0], x[1], x[2], x[3]}, size);
      else
        for (std::size_t k = 0; k < count; ++k) // the corners of a quadrilateral
          worth = std::min(worth, worthOf(std::array<Vec3, 3>{x[(k + count - 1) % count], x[k],
                                                              x[(k + 1) % count]},
                                          size));
      if (worth < least)
      {
        least = worth;
        result_.worstPlace = (1 / Real(count)) * std::accumulate(x.begin(), x.end(), Vec3{});
      }
    }
    result_.worst = least;
    return least;
  }

  /// What is flat makes a step that nobody can pay.
  void demandWorth() const
  {
    if (result_.worst >= recipe_.slivers.shape)
      return;
    fail(ExitCode::Mesh,
         "{}: the element at {} m is worth {:.2g} (1: regular and of the "
         "size asked for, 0: flat), which would make the time step about {} times shorter; "
         "accepted: slivers.shape = {:.6g} or more. Joints or borders nearly meet there. Larger "
         "slivers.thickness (here {:.3g} m) or slivers.stub (here {:.3g} m), another seed, or "
         "joints somewhat elsewhere help; slivers.shape: 0 writes the mesh as it is.",
         recipeFile_, placeText(result_.worstPlace, leastSizeOf(recipe_) / 10), result_.worst,
         result_.worst > 1e-6 ? fmt::format("{:.0f}", 1 / result_.worst) : "infinitely many",
         recipe_.slivers.shape, limits_.thickness, limits_.stub);
  }

  /// Mends elements that are nearly flat, if there are any.
  template <class Simplices>
  void mendElements(Real size)
  {
    MendLimits limits;
    limits.size = size;
    limits.worth = 0.1;
    limits.tolerance = limits_.thickness;
    limits.reach = limits_.stub;
    Simplices mesh = simplices<Simplices>();
    const std::vector<Real> before = areasOfSurfaces(mesh);
    result_.changes = mend(mesh, limits);
    if (result_.changes == 0)
      return;
    const std::vector<Real> after = areasOfSurfaces(mesh);
    for (std::size_t s = 0; s < before.size(); ++s)
      if (const auto& surface = mesh.surfaces[s]; surface.joint >= 0)
        result_.measures[std::size_t(surface.joint)].leaveOut(before[s] - after[s], surface.point);
    takeOver(mesh);
    findWorst(size);
  }

  template <class Simplices>
  static std::vector<Real> areasOfSurfaces(const Simplices& mesh)
  {
    std::vector<Real> areas(mesh.surfaces.size(), 0);
    for (const auto& [face, surface] : mesh.surfaceOf)
    {
      const auto x = [&, &corners = face](std::size_t i)
      { return mesh.points[std::size_t(corners[i])]; };
      if constexpr (Simplices::dimension == 2)
        areas[std::size_t(surface)] += norm(x(1) - x(0));
      else
        areas[std::size_t(surface)] += norm(cross(x(1) - x(0), x(2) - x(0))) / 2;
    }
    return areas;
  }

  /// The elements, with the surfaces of joints and borders.
  template <class Simplices>
  Simplices simplices() const
  {
    Simplices mesh;
    mesh.points = result_.mesh.coordinates;
    const auto groupOf = [&](int tag) {
      return result_.mesh.physicalsOfEntity.at({dimension_, tag}).front();
    };
    for (const GmshFile::Element& element : result_.mesh.elements)
      if (element.entity.first == dimension_)
      {
        typename Simplices::Simplex simplex{{}, groupOf(element.entity.second)};
        std::array<Vec3, Simplices::corners> x;
        for (std::size_t k = 0; k < Simplices::corners; ++k)
        {
          simplex.nodes[k] = element.nodes[k];
          x[k] = mesh.points[std::size_t(element.nodes[k])];
        }
        if (volumeOf(x) < 0) // plane surfaces may face either way
          std::swap(simplex.nodes[0], simplex.nodes[1]);
        mesh.simplices.push_back(simplex);
      }
    Entities faces;
    gmsh::model::getEntities(faces, dimension_ - 1);
    for (const Entity& face : faces)
    {
      typename Simplices::Surface surface;
      const std::vector<int> sides = blocksAt(face);
      if (const auto piece = geometry_.pieces.find(face); piece != geometry_.pieces.end())
        surface.joint = piece->second;
      if (sides.size() == 1 || (sides.size() == 2 && groupOf(sides[0]) != groupOf(sides[1])))
        surface.border = borderAt(face);
      if (surface.border != Border::None || surface.joint >= 0)
        addSurface(mesh, face, surface);
    }
    return mesh;
  }

  /// Sides of a solid of a file that lie on the sides of its box stay, as those of a box do: sets
  /// of nodes lie there.
  Border borderAt(const Entity& face) const
  {
    if (geometry_.walls.count(face))
      return Border::Wall;
    if (recipe_.domain.file.empty())
      return Border::Fixed;
    Vec3 low, high;
    gmsh::model::getBoundingBox(face.first, face.second, low.x, low.y, low.z, high.x, high.y,
                                high.z);
    constexpr Real widened = 1e-6; // Gmsh widens boxes by 1e-7 on each side
    const Real slack = std::max(widened, 1e-5 * norm(geometry_.high - geometry_.low));
    for (int axis = 0; axis < 3; ++axis)
      for (const Real side : {geometry_.low[axis], geometry_.high[axis]})
        if (std::abs(low[axis] - side) < slack && std::abs(high[axis] - side) < slack)
          return Border::Fixed;
    return Border::Drawn;
  }

  /// Adds the plane, or line, of a face of the geometry, and the faces of elements on it.
  template <class Simplices>
  void addSurface(Simplices& mesh, const Entity& face, typename Simplices::Surface surface) const
  {
    constexpr std::size_t count = Simplices::dimension;
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, face.first, face.second);
    Real area = 0;
    std::vector<typename Simplices::Face> onSurface;
    for (const std::vector<std::size_t>& all : nodes)
      for (std::size_t k = 0; k + count <= all.size(); k += count)
      {
        typename Simplices::Face corners;
        Vec3 sum{};
        for (std::size_t i = 0; i < count; ++i)
        {
          corners[i] = nodeOfTag_.at(all[k + i]);
          sum += mesh.points[std::size_t(corners[i])];
        }
        const auto x = [&](std::size_t i) { return mesh.points[std::size_t(corners[i])]; };
        const Vec3 along = x(1) - x(0);
        Vec3 normal{-along.y, along.x, 0};
        if constexpr (count == 3)
          normal = cross(along, x(2) - x(0));
        surface.normal += normal;
        surface.point += norm(normal) * ((1.0 / count) * sum);
        area += norm(normal);
        std::sort(corners.begin(), corners.end());
        onSurface.push_back(corners);
      }
    if (!(area > 0))
      return;
    for (const typename Simplices::Face& corners : onSurface)
      mesh.surfaceOf[corners] = int(mesh.surfaces.size());
    surface.point = (1 / area) * surface.point;
    surface.normal = normalised(surface.normal);
    mesh.surfaces.push_back(surface);
  }

  /// The mesh that was mended, in place of that of Gmsh.
  template <class Simplices>
  void takeOver(const Simplices& mesh)
  {
    GmshFile& result = result_.mesh;
    std::map<std::pair<int, int>, Entity> entityOf; // one of each group, by dimension and number
    for (const auto& [entity, groups] : result.physicalsOfEntity)
      entityOf.insert({{entity.first, groups.front()}, entity});
    result.coordinates = mesh.points;
    while (result.nodeIds.size() < mesh.points.size())
      result.nodeIds.push_back(GlobalId(result.nodeIds.size()) + 1);
    result.elements.clear();
    const auto add = [&](const Entity& entity, int type, const auto& nodes)
    {
      GmshFile::Element element{entity, type, GlobalId(result.elements.size()) + 1, {}};
      std::copy(nodes.begin(), nodes.end(), element.nodes.begin());
      result.elements.push_back(element);
    };
    constexpr int types[] = {15, 1, 2, 4}; // of Gmsh, by dimension
    std::map<typename Simplices::Face, int> sides;
    for (const auto& [nodes, group] : mesh.simplices)
    {
      add(entityOf.at({dimension_, group}), types[dimension_], nodes);
      for (std::size_t left = 0; left < nodes.size(); ++left)
      {
        typename Simplices::Face face;
        for (std::size_t k = 0; k < face.size(); ++k)
          face[k] = nodes[(left + 1 + k) % nodes.size()];
        std::sort(face.begin(), face.end());
        ++sides[face];
      }
    }
    for (const auto& [face, surface] : mesh.surfaceOf)
      if (const int joint = mesh.surfaces[std::size_t(surface)].joint;
          joint >= 0 && sides[face] == 2)
        add(entityOf.at({dimension_ - 1, geometry_.groupOfJoint.at(std::size_t(joint))}),
            types[dimension_ - 1], face);
  }

  void readNodes()
  {
    std::vector<std::size_t> tags;
    std::vector<double> places, parameters;
    gmsh::model::mesh::getNodes(tags, places, parameters);
    std::map<std::size_t, Vec3> sorted;
    for (std::size_t n = 0; n < tags.size(); ++n)
      sorted[tags[n]] = {places[3 * n], places[3 * n + 1], places[3 * n + 2]};
    for (const auto& [tag, place] : sorted)
    {
      for (int axis = 0; axis < dimension_; ++axis)
        if (const Real x = place[axis], slack = 1e-3 * recipe_.elements.size;
            !(x >= geometry_.low[axis] - slack && x <= geometry_.high[axis] + slack))
          throw Error(ExitCode::Computation, "it has made nodes outside of the domain");
      nodeOfTag_[tag] = int(result_.mesh.nodeIds.size());
      result_.mesh.nodeIds.push_back(GlobalId(result_.mesh.nodeIds.size()) + 1);
      result_.mesh.coordinates.push_back(place);
    }
  }

  void readElements(const Entity& entity, GlobalId& next)
  {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, entity.first, entity.second);
    for (std::size_t k = 0; k < types.size(); ++k)
    {
      const std::size_t perElement = nodesOfGmshType(types[k]);
      if (perElement == 0)
        fail(ExitCode::Mesh, "Gmsh has made elements of its type {}, which cannot be used.",
             types[k]);
      for (std::size_t e = 0; e < tags[k].size(); ++e)
      {
        GmshFile::Element element;
        element.entity = entity;
        element.type = types[k];
        element.id = ++next;
        for (std::size_t n = 0; n < perElement; ++n)
          element.nodes[n] = nodeOfTag_.at(nodes[k][e * perElement + n]);
        result_.mesh.elements.push_back(element);
      }
    }
  }

  const BlocksRecipe& recipe_;
  const std::string& recipeFile_;
  const MeshingWay& way_;
  Stages& stages_;
  const CutGeometry& geometry_;
  CutDomain& result_;
  int dimension_;
  SliverLimits limits_;
  std::map<std::size_t, int> nodeOfTag_;
};
} // namespace

void meshDomain(const BlocksRecipe& recipe, const std::string& recipeFile, const MeshingWay& way,
                Stages& stages, const CutGeometry& geometry, CutDomain& domain)
{
  Mesher(recipe, recipeFile, way, stages, geometry, domain).mesh();
}
} // namespace coplane
