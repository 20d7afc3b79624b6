#include "MakeMesh.hpp"

#include "PartReader.hpp"
#include "Selection.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/Version.hpp>
#include <coplane_exodus/Provenance.hpp>

#include <ctime>
#include <filesystem>

namespace coplane
{
namespace
{
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
    const ElementType type = part.bodies.front().type;
    if (block && block->type != type)
      fail(ExitCode::Deck,
           "{} = '{}' has {} elements in other parts and {} in this one; a block has elements of "
           "one "
           "type. Give this part a block of its own, or split all parts of the block.",
           part.keyPlace, part.block, topology(block->type).exodusName, topology(type).exodusName);
    if (!block)
      block = &mesh.blocks.emplace_back(
          Mesh::Block{GlobalId(mesh.blocks.size()) + 1, part.block, type, {}, {}, {}});
    for (const Body& body : part.bodies)
    {
      ++bodies;
      demandCountable(Real(mesh.coordinates.size()) + Real(body.points.size()));
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
Mesh makeMeshFromText(const std::string& text, const std::string& name)
{
  const RecipeMap recipe(parseRecipe(text, name), name, "",
                         {"title", "dimension", "parts", "node_sets", "side_sets"});
  const int dimension = recipe.count("dimension", 2);
  if (dimension > 3)
    recipe.refuse("dimension", fmt::format("= {} must be 2 or 3.", dimension));
  std::vector<Part> parts;
  RecipeProblems problems;
  int number = 0;
  for (const YAML::Node& node : recipe.list("parts"))
    problems.collect(
        [&]
        { parts.push_back(readPart(node, name, fmt::format("parts[{}]", number++), dimension)); });
  problems.tell(); // sets are made of all parts
  std::vector<Vec3> ownCoordinates;
  Mesh mesh = assemble(parts, dimension, ownCoordinates);
  mesh.title =
      recipe.has("title") ? recipe.text("title") : std::filesystem::path(name).filename().string();
  mesh.qaRecords.push_back(qaRecord());
  addSets(mesh, ownCoordinates, recipe, problems);
  problems.tell();
  return mesh;
}

Mesh makeMesh(const std::string& recipeFile)
{
  return makeMeshFromText(textOfRecipe(recipeFile, "coplane_mesh --help-recipe"), recipeFile);
}

const char* recipeHelp()
{
  return R"(A recipe is a YAML file. Lengths are in metres, angles in degrees. [..] are lists of 2 or 3 numbers, by dimension.

title: text                      optional
dimension: 2 | 3
parts:                           a list; parts of the same block name make one element block, every body has nodes of its own
  - shape: box                   one body
    block: name                  of the element block
    min: [..]                    lowest corner, default the origin
    size: [..]  or  max: [..]    lengths, or highest corner
    divisions: [..]              elements along x, y, z
    bias: [..]                   optional: last element over first element along x, y, z, the others in geometric progression
    lines: {x: .., y: ..}        instead of all these: the grid lines, each a list of coordinates, or a map
                                 {ends: [x0, x1, ..], divisions: [n01, ..], bias: [b01, ..]} of the segments between the ends
  - shape: quadrilateral         2D: one body between four corners
  - shape: hexahedron            3D: between eight; a wedge is one with close corners
    corners: [[x, y], ..]        counter-clockwise; 3D: four seen from above, then the four above them
    divisions: [..]              along corners 1-2, 1-4, and 1-5 in 3D
  - shape: wall                  running bond: bricks along x, courses upward in y, thickness in z
    brick: [..]                  size of a whole brick
    courses: n
    length_in_bricks: n          odd courses (the second, fourth, ...) are shifted by half a brick, with half bricks at their ends
    divisions: [..]              of a whole brick; even along x
  - shape: imbricate             2D wall in layers through its thickness (x), bricks along y, centred on y = 0
    brick: [thickness, length]
    layers: n                    layers 1, 3, ... have half bricks at their ends, layers 2, 4, ... whole ones only
    length_in_bricks: n
    divisions: [x, y]            of a whole brick; even along y
  - shape: projectile            axis x, tip of the nose at the origin, body towards -x
    width: w                     nose of radius w/2
    length: l                    with the nose
    across: n                    elements on the width; even, at least 4
    along: n                     elements on the straight part; default: about as long as wide
    section: round | square      3D: round with half a ball (default), or square with half a cylinder across z as nose
  - shape: ogive                 axis y, tip at the origin, body towards +y; 2D: half section x >= 0 of a body of revolution; 3D: quarter x >= 0, z >= 0
    width: w, length: l          diameter; length with the nose
    caliber: c                   radius of the nose's outline over the width (CRH); at least 0.5, half a ball
    across: n                    elements on the whole width; even, at least 4
    nose: n, along: n            elements on the axis of the nose (more than across / 4) and on the shank; default: about twice as long as wide
  - shape: rock                  joint sets at right angles: equal blocks from the origin
    blocks: [..]                 numbers of blocks
    size: [..]                   of one block
    divisions: [..]              of one block
  - shape: cylinder              2D disk, 3D cylinder along z from z = 0; centred on the origin
    radius: r
    across: n                    elements on the diameter; even, at least 4
    length: l, along: n          3D
  - shape: sector                ring sectors about the origin (arch stones); 3D: swept from z = 0
    inner_radius: r, outer_radius: r
    from: degrees, to: degrees   from x towards y
    count: n                     bodies of equal angle, default 1; they touch and do not share nodes
    divisions: [radial, around, along z]  of one body
    bias: b                      optional: outermost over innermost radial length, those between in geometric progression
    length: l                    3D
  - shape: half_disc             lower half of a disc of centre (0, radius): lowest point at the origin, fine there; 3D: swept from z = 0
    radius: r
    fine: l                      length of elements at the lowest point
    fine_radius: r               so far reach such elements (at most radius / 4); beyond, they grow with the distance
    length: l, along: n          3D
  every part:
    split: none | triangles | tetrahedra  optional; every quadrilateral into 2 triangles, every hexahedron into 5 tetrahedra
    rotate: degrees | [x, y, z]  optional; 2D: about z; 3D: about x, then y, then z
    about: [..]                  point that stays in place; default: the middle of the part's bounding box
    offset: [..]                 added last
node_sets:                       optional
  name:
    block: name or list          default: all blocks
    where: {y: 0, x: [0, 1]}     planes and ranges in the mesh; nodes must meet all of them, within 1e-6 of the mesh size
           {radius: r, angle: [0, 90]}  distance from the z axis (2D: the origin), degrees from x towards y about it; also ranges or single values
    where_own: {x: 0}            the same in the part's coordinates before rotate and offset
side_sets:                       optional; exterior faces whose nodes all meet the selection
  name:
    block, where, where_own      as above
    normal: [..]                 optional; outward normal, within 26 degrees
)";
}
} // namespace coplane
