#include "MakeMesh.hpp"

#include "MergeMeshes.hpp"
#include "Recipe.hpp"
#include "Selection.hpp"
#include "ShapeModel.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/Version.hpp>
#include <coplane_exodus/Provenance.hpp>
#include <coplane_exodus/ReadMesh.hpp>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>

namespace coplane
{
namespace
{
/// Where what has own coordinates goes.
struct Placement
{
  Mat3 rotation; ///< about `centre`
  Vec3 centre{}; ///< in own coordinates [m]
  Vec3 offset{}; ///< added last [m]

  Vec3 place(const Vec3& own) const { return rotation * (own - centre) + centre + offset; }
};

/// One entry of `parts`: bodies in the part's own coordinates, and where they go.
struct Part : Placement
{
  std::string block;
  std::vector<Body> bodies;
};

/// Right-handed rotation about one axis, angle in degrees. Quarter turns are exact.
Mat3 rotationAbout(int axis, Real degrees)
{
  const Real quarter = degrees / 90;
  Real c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
  if (quarter == std::floor(quarter))
  {
    c = std::round(c);
    s = std::round(s);
  }
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  Mat3 r;
  r(axis, axis) = 1;
  r(a, a) = r(b, b) = c;
  r(a, b) = -s;
  r(b, a) = s;
  return r;
}

Mat3 rotationOf(const PlacementCard& card)
{
  if (card.dimension == 2)
    return rotationAbout(2, card.rotate.empty() ? 0.0 : card.rotate[0]);
  const std::vector<Real> degrees = card.rotate.empty() ? std::vector<Real>{0, 0, 0} : card.rotate;
  return rotationAbout(2, degrees[2]) *
         (rotationAbout(1, degrees[1]) * rotationAbout(0, degrees[0]));
}

/// The middle of the bounding box. @param points lists of them
Vec3 middleOf(const std::vector<const std::vector<Vec3>*>& points)
{
  Vec3 lowest{infinity, infinity, infinity}, highest = -lowest;
  for (const std::vector<Vec3>* list : points)
    for (const Vec3& p : *list)
      for (int axis = 0; axis < 3; ++axis)
      {
        lowest[axis] = std::min(lowest[axis], p[axis]);
        highest[axis] = std::max(highest[axis], p[axis]);
      }
  return 0.5 * (lowest + highest);
}

/// @param points in own coordinates, lists of them
Placement placementOf(const PlacementCard& card,
                      const std::vector<const std::vector<Vec3>*>& points)
{
  Placement placement;
  placement.rotation = rotationOf(card);
  // Without a rotation, rounding of (p - centre) + centre must not move touching bodies apart.
  if (!card.rotate.empty())
    placement.centre = card.about.empty() ? middleOf(points) : toVec3(card.about);
  if (!card.offset.empty())
    placement.offset = toVec3(card.offset);
  return placement;
}

Part makePart(const PartCard& card)
{
  Part part;
  part.block = card.block;
  part.bodies = findModel(shapeModels(), card.model)->law(card.parameters.get());
  if (card.split != "none")
    for (Body& body : part.bodies)
      body = inSimplices(body);
  std::vector<const std::vector<Vec3>*> points;
  for (const Body& body : part.bodies)
    points.push_back(&body.points);
  static_cast<Placement&>(part) = placementOf(card, points);
  return part;
}

/// All parts; a part that asks for more nodes than a mesh can have, with those before it, is a
/// problem.
std::vector<Part> makeParts(const Recipe& recipe, Problems& problems)
{
  std::vector<Part> parts;
  Real nodes = 0;
  for (std::size_t p = 0; p < recipe.parts.size(); ++p)
    try
    {
      parts.push_back(makePart(recipe.parts[p]));
      for (const Body& body : parts.back().bodies)
        nodes += Real(body.points.size());
      demandCountable(nodes);
    }
    catch (const Error& error)
    {
      problems.add(nodeAt(recipe.root, {"parts", std::to_string(p)}),
                   fmt::format("parts.{} {}", p, error.what()));
    }
  return parts;
}

/// Refuses a block with elements of two types.
void demandOneType(const std::vector<Part>& parts, const DeckNode& root, Problems& problems)
{
  for (std::size_t p = 0; p < parts.size(); ++p)
  {
    const auto first =
        std::find_if(parts.begin(), parts.end(),
                     [&](const Part& other) { return other.block == parts[p].block; });
    const ElementType type = parts[p].bodies.front().type, before = first->bodies.front().type;
    if (type != before)
      CardPlace{nodeAt(root, {"parts", std::to_string(p)}), fmt::format("parts.{}", p), problems}
          .problem("block",
                   fmt::format("= '{}' has {} elements in other parts and {} in this one; a block "
                               "has elements of one type. Give this part a block of its own, or "
                               "split all parts of the block.",
                               parts[p].block, topology(before).exodusName,
                               topology(type).exodusName));
  }
}

/// Nodes part by part and body by body; elements block by block. Ids count from 1 in that order.
Mesh assemble(const std::vector<Part>& parts, int dimension, std::vector<Vec3>& ownCoordinates)
{
  Mesh mesh;
  mesh.dimension = dimension;
  int bodies = 0;
  for (const Part& part : parts)
  {
    Mesh::Block* block = nullptr;
    for (Mesh::Block& other : mesh.blocks)
      if (other.name == part.block)
        block = &other;
    if (!block)
      block = &mesh.blocks.emplace_back(Mesh::Block{
          GlobalId(mesh.blocks.size()) + 1, part.block, part.bodies.front().type, {}, {}, {}});
    for (const Body& body : part.bodies)
    {
      ++bodies;
      const int firstNode = int(mesh.coordinates.size());
      for (const Vec3& own : body.points)
      {
        mesh.coordinates.push_back(part.place(own));
        ownCoordinates.push_back(own);
      }
      for (const int node : body.connectivity)
        block->connectivity.push_back(firstNode + node);
      block->bodyIds.insert(block->bodyIds.end(), body.elements(), bodies);
    }
  }
  for (std::size_t node = 0; node < mesh.coordinates.size(); ++node)
    mesh.nodeIds.push_back(GlobalId(node) + 1);
  GlobalId element = 0;
  for (Mesh::Block& block : mesh.blocks)
    for (std::size_t e = 0; e < block.bodyIds.size(); ++e)
      block.elementIds.push_back(++element);
  return mesh;
}

std::string fileOf(const MeshCard& card, const std::string& recipeFile)
{
  return std::filesystem::path(recipeFile).parent_path() / card.file;
}

/// Puts the meshes of files beside that of the parts. @param own the coordinates that nodes had
/// before they were placed; grows @param recipeFile files stand beside it
Mesh withMeshes(const Recipe& recipe, const std::string& recipeFile, const Mesh& parts,
                std::vector<Vec3>& own)
{
  std::vector<MeshToMerge> all;
  if (parts.nodes() > 0)
    all.push_back({parts, recipeFile, {}, false});
  for (const MeshCard& card : recipe.meshes)
  {
    const std::string file = fileOf(card, recipeFile);
    Mesh mesh = readMesh(file);
    if (mesh.dimension != recipe.dimension)
      fail(ExitCode::Mesh, "{}: the mesh {} has {} dimensions and the recipe {}.", card.where, file,
           mesh.dimension, recipe.dimension);
    for (Vec3& x : mesh.coordinates)
      x = card.scale * x;
    own.insert(own.end(), mesh.coordinates.begin(), mesh.coordinates.end());
    const Placement placement = placementOf(card, {&mesh.coordinates});
    for (Vec3& x : mesh.coordinates)
      x = placement.place(x);
    all.push_back({std::move(mesh), file, card.prefix, card.join});
  }
  return mergeMeshes(all).mesh;
}
} // namespace

std::array<std::string, 4> qaRecord()
{
  const std::time_t now = std::time(nullptr);
  char date[32], hour[32];
  std::strftime(date, sizeof date, "%Y/%m/%d", std::localtime(&now));
  std::strftime(hour, sizeof hour, "%H:%M:%S", std::localtime(&now));
  return {programOfMeshes, version().number, date, hour};
}

Mesh makeMeshFromText(const std::string& text, const std::string& name,
                      const std::vector<std::string>& overrides)
{
  const Recipe recipe = parseRecipe(text, name, overrides);
  Problems problems;
  const std::vector<Part> parts = makeParts(recipe, problems);
  if (!problems.empty())
    throw Error(ExitCode::Deck, problems.text());
  demandOneType(parts, recipe.root, problems);
  if (!problems.empty())
    throw Error(ExitCode::Deck, problems.text()); // sets are made of all parts
  std::vector<Vec3> ownCoordinates;
  Mesh mesh = assemble(parts, recipe.dimension, ownCoordinates);
  if (!recipe.meshes.empty())
    mesh = withMeshes(recipe, name, mesh, ownCoordinates);
  mesh.title =
      recipe.title.empty() ? std::filesystem::path(name).filename().string() : recipe.title;
  mesh.qaRecords.push_back(qaRecord());
  addSets(mesh, ownCoordinates, recipe, problems);
  if (!problems.empty())
    throw Error(ExitCode::Deck, problems.text());
  return mesh;
}

Mesh makeMesh(const std::string& recipeFile, const std::vector<std::string>& overrides)
{
  return makeMeshFromText(readTextFile(recipeFile, coplane::recipeFile()), recipeFile, overrides);
}

std::vector<std::string> meshFilesOf(const std::string& recipeFile,
                                     const std::vector<std::string>& overrides)
{
  std::vector<std::string> files;
  const std::string text = readTextFile(recipeFile, coplane::recipeFile());
  for (const MeshCard& card : parseRecipe(text, recipeFile, overrides).meshes)
    files.push_back(fileOf(card, recipeFile));
  return files;
}
} // namespace coplane
