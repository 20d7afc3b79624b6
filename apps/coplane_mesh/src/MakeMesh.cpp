#include "MakeMesh.hpp"

#include "Recipe.hpp"
#include "Selection.hpp"
#include "ShapeModel.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/Version.hpp>
#include <coplane_exodus/Provenance.hpp>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>

namespace coplane
{
namespace
{
/// One entry of `parts`: bodies in the part's own coordinates, and where they go.
struct Part
{
  std::string block;
  std::vector<Body> bodies;
  Mat3 rotation; ///< about `centre`
  Vec3 centre{}; ///< in own coordinates [m]
  Vec3 offset{}; ///< added last [m]

  Vec3 place(const Vec3& own) const { return rotation * (own - centre) + centre + offset; }
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

Mat3 rotationOf(const PartCard& card)
{
  if (card.dimension == 2)
    return rotationAbout(2, card.rotate.empty() ? 0.0 : card.rotate[0]);
  const std::vector<Real> degrees = card.rotate.empty() ? std::vector<Real>{0, 0, 0} : card.rotate;
  return rotationAbout(2, degrees[2]) *
         (rotationAbout(1, degrees[1]) * rotationAbout(0, degrees[0]));
}

Vec3 middleOf(const std::vector<Body>& bodies)
{
  Vec3 lowest{infinity, infinity, infinity}, highest = -lowest;
  for (const Body& body : bodies)
    for (const Vec3& p : body.points)
      for (int axis = 0; axis < 3; ++axis)
      {
        lowest[axis] = std::min(lowest[axis], p[axis]);
        highest[axis] = std::max(highest[axis], p[axis]);
      }
  return 0.5 * (lowest + highest);
}

Part makePart(const PartCard& card)
{
  Part part;
  part.block = card.block;
  part.bodies = findModel(shapeModels(), card.model)->law(card.parameters.get());
  if (card.split != "none")
    for (Body& body : part.bodies)
      body = inSimplices(body);
  part.rotation = rotationOf(card);
  // Without a rotation, rounding of (p - centre) + centre must not move touching bodies apart.
  if (!card.rotate.empty())
    part.centre = card.about.empty() ? middleOf(part.bodies) : toVec3(card.about);
  if (!card.offset.empty())
    part.offset = toVec3(card.offset);
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
} // namespace coplane
