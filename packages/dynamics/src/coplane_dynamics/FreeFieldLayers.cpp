#include <coplane_dynamics/FreeFieldLayers.hpp>
#include <coplane_mesh/ElementTopology.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace coplane
{
namespace
{
constexpr Real sameHeight = 1e-6; // of the height of the side, as are
constexpr Real samePlane = 1e-6;
constexpr Real sameDirection = 1e-6; // sine
constexpr Real sameWidth = 1e-4;     // of the width

/// The axis that is nearest to where gravity comes from; without gravity y, and z in three
/// dimensions.
Vec3 upOf(const Conditions& conditions, Real from, Real end, int dimension)
{
  Vec3 gravity = conditions.gravity(from);
  if (!(norm(gravity) > 0))
    gravity = conditions.gravity(end);
  int axis = dimension - 1;
  for (int c = 0; c < dimension; ++c)
    if (std::abs(gravity[c]) > std::abs(gravity[axis]))
      axis = c;
  Vec3 up{};
  up[axis] = gravity[axis] > 0 ? -1 : 1;
  return up;
}

/// Of the faces of this rank, so that each is there once.
std::vector<FreeFieldFaceRecord> recordsOf(const FreeFieldBoundary& boundary, const Model& model)
{
  std::vector<FreeFieldFaceRecord> records;
  const RankMesh& mesh = model.mesh;
  for (const FreeFieldSide& face : boundary.sides)
  {
    const RankMesh::Block& block = mesh.blocks[std::size_t(face.block)];
    if (!isOfThisRank(face.side, mesh))
      continue;
    FreeFieldFaceRecord record;
    record.id = face.side.id;
    record.block = face.block;
    record.count = face.side.count;
    record.normalImpedance = face.normalImpedance;
    record.shearImpedance = face.shearImpedance;
    for (int k = 0; k < face.side.count; ++k)
    {
      record.nodes[k] = mesh.nodeIds[std::size_t(face.side.nodes[k])];
      record.corners[k] = mesh.coordinates[std::size_t(face.side.nodes[k])];
    }
    // Sum of the cones from the middle of the face to the other sides.
    const ElementTopology& shape = topology(block.type);
    for (int s = 0; s < shape.sides; ++s)
    {
      Vec3 corners[4];
      for (int k = 0; k < shape.nodesPerSide; ++k)
        corners[k] = mesh.coordinates[std::size_t(
            block.connectivity[std::size_t(face.element * shape.nodes + shape.sideNodes[s][k])])];
      const auto areas = cornerAreas(mesh.dimension, corners, shape.nodesPerSide);
      Vec3 area{}, middle{};
      for (int k = 0; k < shape.nodesPerSide; ++k)
      {
        area += areas[std::size_t(k)];
        middle += (1.0 / shape.nodesPerSide) * corners[k];
      }
      record.volume += dot(middle - record.corners[0], area) / mesh.dimension;
    }
    records.push_back(record);
  }
  return records;
}

Real areaOf(const FreeFieldFaceRecord& face, int dimension, Vec3* direction = nullptr)
{
  const auto areas = cornerAreas(dimension, face.corners, face.count);
  const Vec3 sum = areas[0] + areas[1] + areas[2] + areas[3];
  if (direction)
    *direction = normalised(sum);
  return norm(sum);
}

/// What a free-field side has to be, for messages.
constexpr const char* accepted =
    "accepted: a vertical plane, with a column of ground behind it in level layers";

template <class... Args>
[[noreturn]] void refuse(const FreeFieldBoundary& boundary, fmt::format_string<Args...> what,
                         Args&&... args)
{
  failOnAllRanks(ExitCode::Deck, "{}: free-field side set '{}': {}", boundary.where, boundary.name,
                 fmt::format(what, std::forward<Args>(args)...));
}
} // namespace

int FreeFieldLayers::levelAt(Real height) const
{
  const auto above = std::lower_bound(heights.begin(), heights.end(), height);
  if (above == heights.begin())
    return 0;
  const int i = int(above - heights.begin());
  return above == heights.end() || height - heights[std::size_t(i - 1)] < *above - height ? i - 1
                                                                                          : i;
}

bool isOfThisRank(const LoadedSide& side, const RankMesh& mesh)
{
  int lowest = side.nodes[0];
  for (int k = 1; k < side.count; ++k)
    if (mesh.nodeIds[std::size_t(side.nodes[std::size_t(k)])] < mesh.nodeIds[std::size_t(lowest)])
      lowest = side.nodes[std::size_t(k)];
  return lowest < mesh.ownedNodes;
}

FreeFieldLayers freeFieldLayers(const FreeFieldBoundary& boundary, const Model& model,
                                const Comm& comm)
{
  const int dimension = model.mesh.dimension;
  if (model.axisymmetric())
    refuse(boundary, "the model is a body of revolution; accepted: plane strain and three "
                     "dimensions. Use absorbing.");
  std::vector<FreeFieldFaceRecord> faces = comm.allGather(recordsOf(boundary, model));
  if (faces.empty())
    refuse(boundary, "it has no sides; {}.", accepted);
  std::sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.id < b.id; });

  FreeFieldLayers layers;
  layers.up = upOf(model.conditions, boundary.when.from, model.time.end, dimension);
  areaOf(faces[0], dimension, &layers.normal);
  if (const Real slope = dot(layers.normal, layers.up); std::abs(slope) > sameDirection)
    refuse(boundary,
           "side {} of element {} leans by {:.4g} degrees, with up along [{}, {}, {}]; {}. Up is "
           "the axis that gravity comes from (without gravity y, in three dimensions z).",
           sideOfFace(faces[0].id) + 1, elementOfFace(faces[0].id),
           std::abs(std::asin(slope)) * 180 / pi, layers.up.x, layers.up.y, layers.up.z, accepted);
  layers.normal = normalised(layers.normal - dot(layers.normal, layers.up) * layers.up);
  layers.along = cross(layers.up, layers.normal);
  layers.offset = dot(layers.normal, faces[0].corners[0]);

  // Levels.
  std::map<GlobalId, Vec3> nodes;
  for (const FreeFieldFaceRecord& face : faces)
    for (int k = 0; k < face.count; ++k)
      nodes[face.nodes[k]] = face.corners[k];
  std::vector<std::pair<Real, GlobalId>> byHeight;
  for (const auto& [id, x] : nodes)
    byHeight.push_back({dot(x, layers.up), id});
  std::sort(byHeight.begin(), byHeight.end());
  const Real size = byHeight.back().first - byHeight.front().first;
  for (const auto& [height, id] : byHeight)
  {
    if (layers.heights.empty() || height - layers.heights.back() > sameHeight * size)
    {
      layers.heights.push_back(height);
      layers.nodeOfLevel.push_back(id);
      layers.nodesOfLevel.push_back(0);
    }
    layers.nodeOfLevel.back() = std::min(layers.nodeOfLevel.back(), id);
    ++layers.nodesOfLevel.back();
  }
  for (const GlobalId id : layers.nodeOfLevel)
    layers.placeOfLevel.push_back(nodes[id]);
  for (const auto& [id, x] : nodes)
    if (const Real away = dot(layers.normal, x) - layers.offset; std::abs(away) > samePlane * size)
      refuse(boundary, "node {} lies {:.4g} m away from the plane of side {} of element {}; {}.",
             id, std::abs(away), sideOfFace(faces[0].id) + 1, elementOfFace(faces[0].id), accepted);
  std::vector<std::tuple<int, Real, GlobalId>> places;
  for (const auto& [id, x] : nodes)
    places.push_back({layers.levelAt(dot(x, layers.up)), dot(x, layers.along), id});
  std::sort(places.begin(), places.end());
  for (std::size_t i = 1; i < places.size(); ++i)
  {
    const auto& [level, along, id] = places[i];
    const auto& [levelBefore, alongBefore, idBefore] = places[i - 1];
    if (level == levelBefore && along - alongBefore <= samePlane * size)
      refuse(boundary,
             "nodes {} and {} stand at one place: a joint ends there, and columns have none; {}. "
             "End joints before the side, or use absorbing.",
             std::min(id, idBefore), std::max(id, idBefore), accepted);
  }

  // Layers.
  std::vector<Real> areas(layers.heights.size() - 1, 0);
  layers.layers.resize(areas.size());
  for (const FreeFieldFaceRecord& face : faces)
  {
    Vec3 direction;
    const Real area = areaOf(face, dimension, &direction);
    if (norm(direction - layers.normal) > samePlane)
      refuse(boundary,
             "side {} of element {} has another direction than side {} of element {}; {}.",
             sideOfFace(face.id) + 1, elementOfFace(face.id), sideOfFace(faces[0].id) + 1,
             elementOfFace(faces[0].id), accepted);
    int low = int(layers.heights.size()), high = 0;
    for (int k = 0; k < face.count; ++k)
    {
      const int level = layers.levelAt(dot(face.corners[k], layers.up));
      low = std::min(low, level);
      high = std::max(high, level);
    }
    if (high != low + 1)
      refuse(boundary,
             "side {} of element {} reaches from {:.6g} to {:.6g} m, and other nodes of the side "
             "stand between these heights; accepted: nodes in rows of one height. Mesh the side in "
             "rows, or use absorbing.",
             sideOfFace(face.id) + 1, elementOfFace(face.id), layers.heights[std::size_t(low)],
             layers.heights[std::size_t(high)]);
    FreeFieldLayer& layer = layers.layers[std::size_t(low)];
    int feet = 0;
    for (int k = 0; k < face.count; ++k)
      feet += layers.levelAt(dot(face.corners[k], layers.up)) == low;
    if (face.count == 4 && feet != 2)
      refuse(boundary, "side {} of element {} stands on a corner; {}.", sideOfFace(face.id) + 1,
             elementOfFace(face.id), accepted);
    const bool first = areas[std::size_t(low)] == 0;
    areas[std::size_t(low)] += area;
    if (!first && layer.face.block != face.block)
      refuse(
          boundary,
          "between {:.6g} and {:.6g} m there are block '{}' (element {}) and block '{}' (element "
          "{}); {}.",
          layers.heights[std::size_t(low)], layers.heights[std::size_t(high)],
          model.blocks[std::size_t(layer.face.block)].name, elementOfFace(layer.face.id),
          model.blocks[std::size_t(face.block)].name, elementOfFace(face.id), accepted);
    if (!first)
      continue;
    if (model.blocks[std::size_t(face.block)].rigid)
      refuse(boundary, "block '{}' is rigid; {}.", model.blocks[std::size_t(face.block)].name,
             accepted);
    if (std::count(model.absentBlocks.begin(), model.absentBlocks.end(), face.block) > 0)
      refuse(boundary,
             "block '{}' is not there at the start; accepted: blocks that are there from "
             "the start on.",
             model.blocks[std::size_t(face.block)].name);
    layer.face = face;
    const Real thickness = layers.heights[std::size_t(high)] - layers.heights[std::size_t(low)];
    const bool simplex = model.mesh.blocks[std::size_t(face.block)].type == ElementType::Tri3 ||
                         model.mesh.blocks[std::size_t(face.block)].type == ElementType::Tet4;
    layer.depth = (simplex ? dimension : 1) * face.volume / area;
    layer.breadth = dimension == 2 ? 1 : simplex ? thickness : area / thickness;
  }
  for (std::size_t l = 0; l < areas.size(); ++l)
  {
    const Real width = areas[l] / (layers.heights[l + 1] - layers.heights[l]);
    const Real foot = areas[0] / (layers.heights[1] - layers.heights[0]);
    if (std::abs(width - foot) > sameWidth * foot)
      refuse(
          boundary,
          "it is {:.6g} m wide at its foot and {:.6g} m between {:.6g} and {:.6g} m; accepted: a "
          "rectangle without holes, up to a level top.",
          foot, width, layers.heights[l], layers.heights[l + 1]);
  }

  for (const FreeFieldSide& face : boundary.sides)
  {
    std::array<int, 4>& levels = layers.levels[face.side.id];
    levels = {-1, -1, -1, -1};
    for (int k = 0; k < face.side.count; ++k)
      levels[std::size_t(k)] =
          layers.levelAt(dot(model.mesh.coordinates[std::size_t(face.side.nodes[k])], layers.up));
  }
  return layers;
}
} // namespace coplane
