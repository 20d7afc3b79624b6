#include "ElementSizes.hpp"

#include "GmshModel.hpp"
#include "ShapeModel.hpp"

#include <coplane_core/Error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

namespace coplane
{
namespace
{
/// A field of Gmsh: a size at faces, growing with the distance from them.
double sizeFrom(const std::vector<int>& faces, int dimension, Real size, Real growth)
{
  const int distance = gmsh::model::mesh::field::add("Distance");
  std::vector<double> tags(faces.begin(), faces.end());
  gmsh::model::mesh::field::setNumbers(distance, dimension == 2 ? "CurvesList" : "SurfacesList",
                                       tags);
  gmsh::model::mesh::field::setNumber(distance, "NumPointsPerCurve", 40);
  const int field = gmsh::model::mesh::field::add("MathEval");
  gmsh::model::mesh::field::setString(
      field, "F", fmt::format("{:.17g} + {:.17g} * F{}", size, growth, distance));
  return field;
}

/// What regions ask for, where Gmsh asks.
struct RegionSizes
{
  struct Box
  {
    Vec3 low, high;
    Real size;
  };
  Real growth;
  std::vector<Box> boxes;
  std::map<Entity, Real> inside; ///< sizes of entities of blocks, with those at their borders

  double operator()(int dimension, int tag, const Vec3& x) const
  {
    Real size = infinity;
    if (const auto place = inside.find({dimension, tag}); place != inside.end())
      size = place->second;
    for (const Box& box : boxes)
    {
      Vec3 away{};
      for (int axis = 0; axis < 3; ++axis)
        away[axis] = std::max({box.low[axis] - x[axis], x[axis] - box.high[axis], 0.0});
      size = std::min(size, box.size + growth * norm(away));
    }
    return size < infinity ? size : 1e22; // what Gmsh takes for no limit
  }
};
} // namespace

void setElementSizes(const BlocksRecipe& recipe, const std::string& recipeFile,
                     const SizedParts& parts, Real factor)
{
  gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
  gmsh::option::setNumber("Mesh.MeshSizeFromPoints", 0);
  gmsh::option::setNumber("Mesh.MeshSizeMax", recipe.elements.size * factor);
  std::vector<double> fields;
  for (const auto& [opening, faces] : parts.walls)
    fields.push_back(sizeFrom(faces, recipe.dimension,
                              factor * recipe.openings[std::size_t(opening)].elementSize,
                              recipe.elements.growth));
  RegionSizes sizes{recipe.elements.growth, {}, {}};
  for (const ElementSizeCard& region : recipe.elements.regions)
  {
    const Real size = factor * region.size;
    if (region.block.empty())
    {
      sizes.boxes.push_back({toVec3(region.box.min), toVec3(region.box.max), size});
      continue;
    }
    const auto block = parts.blocks.find(region.block);
    if (block == parts.blocks.end())
    {
      std::vector<std::string> names;
      for (const auto& [name, tags] : parts.blocks)
        names.push_back(name);
      fail(ExitCode::Deck, "{}: elements.regions has no block '{}'; accepted: {}.", recipeFile,
           region.block, fmt::join(names, ", "));
    }
    std::vector<Entity> there;
    for (const int tag : block->second)
      there.push_back({recipe.dimension, tag});
    std::set<int> faces;
    std::set<Entity> seen(there.begin(), there.end());
    for (std::size_t k = 0; k < there.size(); ++k) // grows
    {
      const Entity entity = there[k];
      const auto place = sizes.inside.insert({entity, size}).first;
      place->second = std::min(place->second, size);
      if (entity.first == recipe.dimension - 1)
        faces.insert(entity.second);
      if (entity.first > 0)
        for (const int border : bordersOf(entity))
          if (const Entity lower{entity.first - 1, border}; seen.insert(lower).second)
            there.push_back(lower);
    }
    fields.push_back(
        sizeFrom({faces.begin(), faces.end()}, recipe.dimension, size, recipe.elements.growth));
  }
  if (!recipe.elements.regions.empty())
    gmsh::model::mesh::setSizeCallback(
        // Gmsh 4.9 and later tell the size without this, and take what this returns in its place.
        [sizes](int dimension, int tag, double x, double y, double z, auto... without) {
          return std::min({sizes(dimension, tag, {x, y, z}), without...});
        });
  if (fields.empty())
    return;
  const int least = gmsh::model::mesh::field::add("Min");
  gmsh::model::mesh::field::setNumbers(least, "FieldsList", fields);
  gmsh::model::mesh::field::setAsBackgroundMesh(least);
}
} // namespace coplane
