#include "BlocksRecipe.hpp"

#include "PlanePolygon.hpp"
#include "ShapeModel.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_schema/SchemaBuilder.hpp>
#include <coplane_schema/SchemaReader.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
using namespace schema;

namespace
{
template <class Card>
KeyBuilder corner(const std::string& name, std::vector<Real> Card::*member,
                  const std::string& meaning)
{
  return numbers(name, member).byDimension().in("m").like("[0, 0]").means(meaning);
}

void checkBox(DomainCard::Box& box, const CardPlace& place)
{
  for (std::size_t axis = 0; axis < box.min.size() && axis < box.max.size(); ++axis)
    if (!(box.max[axis] > box.min[axis]))
      place.problem("max", fmt::format("= {} m along {} must be more than min = {} m.",
                                       box.max[axis], "xyz"[axis], box.min[axis]));
}

void checkPolygon(const std::vector<std::vector<Real>>& polygon, const CardPlace& place)
{
  if (const std::string problem = problemOfPolygon(toPoints(polygon)); !problem.empty())
    place.problem("polygon", problem);
}

void checkDomain(DomainCard& domain, const CardPlace& place)
{
  if (!domain.polygon.empty())
    checkPolygon(domain.polygon, place);
  if (!domain.joint.empty() && domain.file.empty())
    place.problem("joint", "names the joint between the solids of a file, and there is no file.");
}

Key domainKey()
{
  return group(
             "domain", &BlocksRecipe::domain,
             {
                 text("block", &DomainCard::block)
                     .like("granite")
                     .means("element block of the mesh"),
                 group("box", &DomainCard::box,
                       {corner("min", &DomainCard::Box::min, "lowest corner").needed(),
                        corner("max", &DomainCard::Box::max, "highest corner").needed()})
                     .checkedBy(checkBox)
                     .means("between two corners"),
                 points("polygon", &DomainCard::polygon)
                     .atLeastItems(3)
                     .onlyInDimension(2)
                     .in("m")
                     .like("[[0, 0], [40, 0], [40, 10], [20, 10], [0, 30]]")
                     .means("corners along the border, either way round"),
                 text("file", &DomainCard::file)
                     .onlyInDimension(3)
                     .like("mountain.stl")
                     .means("closed surfaces of solids, in metres: STL, OBJ, PLY, with a group or "
                            "object a solid; JSON: an assembly of COMPAS (compas_assembly, "
                            "compas_dem); beside the recipe"),
                 text("joint", &DomainCard::joint)
                     .onlyInDimension(3)
                     .defaultIs("solids that touch hang together")
                     .like("mortar")
                     .means("name of the joint where solids of the file touch"),
                 text("supports", &DomainCard::supports)
                     .onlyInDimension(3)
                     .like("piers")
                     .means(
                         "element block of the blocks that an assembly of COMPAS calls supports"),
             })
      .needed()
      .exactlyOneOf({"box", "polygon", "file"})
      .checkedBy(checkDomain)
      .means("what is cut");
}

void checkOpening(OpeningCard& opening, const CardPlace& place)
{
  if (!opening.polygon.empty())
    checkPolygon(opening.polygon, place);
  if (!opening.horseshoe.empty() && !(opening.horseshoe[1] > opening.horseshoe[0] / 2))
    place.problem("horseshoe", fmt::format("= [{}, {}]: the height must be more than half the "
                                           "width, which is the radius of the roof.",
                                           opening.horseshoe[0], opening.horseshoe[1]));
}

Key openingsKey()
{
  Key section = points("polygon", &OpeningCard::polygon)
                    .atLeastItems(3)
                    .in("m")
                    .like("[[-2, 0], [2, 0], [2, 3], [-2, 3]]")
                    .means("corners of the section: to the right and upward from the point, seen "
                           "along the path");
  section.byDimension = false;
  section.itemLength = 2;
  return named(
             "openings", &BlocksRecipe::openings,
             {
                 number("circle", &OpeningCard::circle)
                     .in("m")
                     .above(0)
                     .defaultIs("none")
                     .like("2.5")
                     .means(
                         "radius of a circle round the point; a regular polygon of the same area "
                         "with sides of about the size of elements, at least 6"),
                 numbers("horseshoe", &OpeningCard::horseshoe, 2)
                     .in("m")
                     .above(0)
                     .defaultIs("none")
                     .like("[5, 6]")
                     .means("width and height of a section with a flat floor, upright walls and "
                            "half a circle as roof, of at least 18 sides; the point is the middle "
                            "of the floor"),
                 section,
                 numbers("at", &OpeningCard::at, 2)
                     .needed()
                     .onlyInDimension(2)
                     .in("m")
                     .like("[20, 12]")
                     .means("the point of the section"),
                 points("path", &OpeningCard::path, 2)
                     .needed()
                     .onlyInDimension(3)
                     .in("m")
                     .like("[[0, 5, 0], [20, 5, 0]]")
                     .means("the two ends of the straight line along which the section goes"),
                 number("size", &OpeningCard::elementSize)
                     .in("m")
                     .above(0)
                     .defaultIs("that of elements")
                     .like("0.25")
                     .means("of elements at its wall; it grows with the distance"),
                 flag("keep", &OpeningCard::keep)
                     .like("true")
                     .means("stays, as an element block of the opening's name, to be dug out "
                            "later; its border holds"),
             })
      .exactlyOneOf({"circle", "horseshoe", "polygon"})
      .checkedBy(checkOpening)
      .means("openings, by names of your choice; the first that has a place takes it");
}

void checkSet(JointSetCard& set, const CardPlace& place)
{
  if (set.persistence < 1 && set.length == 0)
    place.problem("persistence", fmt::format("= {} needs length: that of the joints between "
                                             "bridges of rock.",
                                             set.persistence));
  if (set.length > 0 && set.persistence == 1)
    place.problem("length", "needs a persistence below 1; joints without bridges have no ends.");
}

Key setKey()
{
  return group(
             "set", &JointsCard::set,
             {
                 number("angle", &JointSetCard::angle)
                     .needed()
                     .onlyInDimension(2)
                     .in("degrees")
                     .atLeast(-180)
                     .atMost(180)
                     .like("30")
                     .means("of the traces, from x towards y"),
                 number("dip", &JointSetCard::dip)
                     .needed()
                     .onlyInDimension(3)
                     .in("degrees")
                     .atLeast(0)
                     .atMost(90)
                     .like("60")
                     .means("steepest descent below the horizontal"),
                 number("dip_direction", &JointSetCard::dipDirection)
                     .needed()
                     .onlyInDimension(3)
                     .in("degrees")
                     .atLeast(-360)
                     .atMost(360)
                     .like("135")
                     .means("azimuth of the descent, clockwise from north seen from above"),
                 number("spacing", &JointSetCard::spacing)
                     .needed()
                     .in("m")
                     .above(0)
                     .like("2")
                     .means("mean distance of neighbours along the normal"),
                 number("spacing_scatter", &JointSetCard::spacingScatter)
                     .in("-")
                     .atLeast(0)
                     .below(1)
                     .like("0.3")
                     .means("each distance is spacing times a number between 1 - scatter and 1 + "
                            "scatter, all equally likely"),
                 number("angle_scatter", &JointSetCard::angleScatter)
                     .onlyInDimension(2)
                     .in("degrees")
                     .atLeast(0)
                     .atMost(30)
                     .like("4")
                     .means("standard deviation of the angle of each joint"),
                 number("fisher", &JointSetCard::fisher)
                     .onlyInDimension(3)
                     .in("-")
                     .atLeast(5)
                     .defaultIs("no scatter")
                     .like("100")
                     .means("concentration K of Fisher's distribution of the normals: 100 is about "
                            "8 degrees"),
                 number("persistence", &JointSetCard::persistence)
                     .in("-")
                     .above(0)
                     .atMost(1)
                     .like("0.7")
                     .means("share of each trace (2D) or plane (3D) that is open; the rest is "
                            "bridges of rock"),
                 number("length", &JointSetCard::length)
                     .in("m")
                     .above(0)
                     .defaultIs("no ends")
                     .like("4")
                     .means("with persistence: of each open part; in 3D these are squares"),
                 corner("through", &JointSetCard::through, "a point on one of them")
                     .defaultIs("the middle of the domain"),
             })
      .checkedBy(checkSet)
      .means("parallel joints through the whole domain, with scatter");
}

void checkPlane(JointPlaneCard& plane, const CardPlace& place)
{
  if (place.gives("count") && !place.gives("spacing"))
    place.problem("count", "needs spacing.");
  if (!plane.segment.empty())
  {
    const Vec3 along = toVec3(plane.segment[1]) - toVec3(plane.segment[0]);
    const Vec3 normal = normalised(toVec3(plane.normal));
    if (!(norm(along - dot(along, normal) * normal) > 1e-9 * norm(along)))
      place.problem("segment", "has no length on the plane.");
  }
  if (!plane.polygon.empty())
    checkPolygon(plane.polygon, place);
  for (const std::vector<Real>& point : plane.polygon)
    if (std::abs(dot(toVec3(point) - toVec3(plane.point), normalised(toVec3(plane.normal)))) >
        1e-6 * (1 + norm(toVec3(point) - toVec3(plane.point))))
    {
      place.problem("polygon", "has a corner that is not on the plane of point and normal.");
      break;
    }
}

Key planesKey()
{
  return list("planes", &JointsCard::planes,
              {
                  corner("point", &JointPlaneCard::point, "of the plane").needed(),
                  numbers("normal", &JointPlaneCard::normal)
                      .needed()
                      .byDimension()
                      .notAllZero()
                      .in("-")
                      .like("[0, 1]")
                      .means("of the plane, of any length"),
                  number("spacing", &JointPlaneCard::spacing)
                      .in("m")
                      .above(0)
                      .defaultIs("one plane")
                      .like("1")
                      .means("of parallel planes, from the point along the normal"),
                  integer("count", &JointPlaneCard::count)
                      .in("planes")
                      .atLeast(1)
                      .like("3")
                      .means("with spacing: so many"),
                  group("disc", &JointPlaneCard::disc,
                        {corner("centre", &JointPlaneCard::Disc::centre,
                                "of the circle; its shadow on the plane counts")
                             .needed(),
                         number("radius", &JointPlaneCard::Disc::radius)
                             .needed()
                             .in("m")
                             .above(0)
                             .like("2")
                             .means("of the circle")})
                      .onlyInDimension(3)
                      .means("only within a circle, which becomes 24 straight sides of the same "
                             "area"),
                  points("segment", &JointPlaneCard::segment, 2)
                      .onlyInDimension(2)
                      .in("m")
                      .defaultIs("no limit")
                      .like("[[3, 1], [3, 4]]")
                      .means("only between the shadows of two points on the plane"),
                  points("polygon", &JointPlaneCard::polygon)
                      .atLeastItems(3)
                      .onlyInDimension(3)
                      .in("m")
                      .defaultIs("no limit")
                      .like("[[0, 0, 1], [4, 0, 1], [4, 4, 1]]")
                      .means("only within a polygon on the plane"),
              })
      .orOneAlone()
      .atMostOneOf({"disc", "segment", "polygon"})
      .checkedBy(checkPlane)
      .means("planes that are given one by one");
}

Key jointsKey()
{
  return named("joints", &BlocksRecipe::joints,
               {
                   setKey(),
                   planesKey(),
                   text("file", &JointsCard::file)
                       .like("fractures.csv")
                       .means("table of fractures, beside the recipe; columns by their names: x1, "
                              "y1, x2, y2 (2D); x, y, z, radius and dip, dip_direction or nx, ny, "
                              "nz (3D), discs; or polygons.dat of dfnWorks (3D)"),
                   group("voronoi", &JointsCard::voronoi,
                         {integer("cells", &VoronoiCard::cells)
                              .needed()
                              .in("cells")
                              .atLeast(2)
                              .atMost(100000)
                              .like("200")
                              .means("so many points, anywhere in the box around the domain"),
                          integer("relaxations", &VoronoiCard::relaxations)
                              .in("times")
                              .atLeast(0)
                              .atMost(100)
                              .like("5")
                              .means("so often each point moves to the middle of its cell: cells "
                                     "become more alike")})
                       .means("borders of Voronoi cells"),
               })
      .exactlyOneOf({"set", "planes", "file", "voronoi"})
      .means("joints by the names of the side sets that hold both faces of each; where several lie "
             "on each other, the first in the file has the place. Without any, the domain is "
             "meshed in one piece");
}

void checkElements(BlockElementsCard& elements, const CardPlace& place)
{
  for (const ElementSizeCard& region : elements.regions)
    if (!(region.size < elements.size))
      place.problem("regions", fmt::format("have the size {} m, which must be less than that of "
                                           "elements = {} m: it is the largest.",
                                           region.size, elements.size));
}

Key elementsKey()
{
  return group(
             "elements", &BlocksRecipe::elements,
             {
                 number("size", &BlockElementsCard::size)
                     .needed()
                     .in("m")
                     .above(0)
                     .like("0.5")
                     .means("length of their edges"),
                 choice("shape", &BlockElementsCard::shape,
                        {{"simplices", BlockElements::Simplices}, {"cubes", BlockElements::Cubes}})
                     .like("cubes")
                     .means("simplices: triangles, tetrahedra. cubes: quadrilaterals, hexahedra; "
                            "each is cut from a larger element, so some are oblique"),
                 number("growth", &BlockElementsCard::growth)
                     .in("-")
                     .above(0)
                     .atMost(2)
                     .like("0.5")
                     .means("by how much the size grows per distance from openings and regions"),
                 number("most", &BlockElementsCard::most)
                     .in("elements")
                     .above(0)
                     .like("2e7")
                     .means("a recipe whose sizes ask for more is refused before anything is cut; "
                            "the number is estimated from volumes and sizes"),
                 number("most_parts", &BlockElementsCard::mostParts)
                     .in("parts")
                     .above(0)
                     .like("2e4")
                     .means("a recipe whose joints cut the domain into more, or whose openings "
                            "have more sides, is refused before anything is cut; the number is "
                            "estimated from the areas of joints"),
                 number("time_limit", &BlockElementsCard::timeLimit)
                     .in("s")
                     .above(0)
                     .like("1e4")
                     .means(
                         "of each step that Gmsh takes (reading, cutting, meshing, mending); one "
                         "that takes longer is ended: Gmsh hangs with some geometries"),
                 list("regions", &BlockElementsCard::regions,
                      {
                          group("box", &ElementSizeCard::box,
                                {corner("min", &DomainCard::Box::min, "lowest corner").needed(),
                                 corner("max", &DomainCard::Box::max, "highest corner").needed()})
                              .checkedBy(checkBox)
                              .means("between two corners"),
                          text("block", &ElementSizeCard::block)
                              .like("granite")
                              .means("element block: the domain's, an opening that is kept, or the "
                                     "supports"),
                          number("size", &ElementSizeCard::size)
                              .needed()
                              .in("m")
                              .above(0)
                              .like("0.1")
                              .means("of elements there; less than that of elements"),
                      })
                     .exactlyOneOf({"box", "block"})
                     .orOneAlone()
                     .means("parts of the domain with smaller elements; their size grows with the "
                            "distance from them"),
             })
      .checkedBy(checkElements)
      .needed()
      .means("of the mesh");
}

Key sliversKey()
{
  return group(
             "slivers", &BlocksRecipe::slivers,
             {
                 number("volume", &SliverCard::volume)
                     .in("m^3, 2D: m^2")
                     .atLeast(0)
                     .defaultIs("a cube or square of half the element size")
                     .like("0.01")
                     .means("smaller blocks are joined to a neighbour, that with the largest face "
                            "in common: the joint between them is left out there"),
                 number("thickness", &SliverCard::thickness)
                     .in("m")
                     .atLeast(0)
                     .defaultIs("a tenth of the element size")
                     .like("0.05")
                     .means("the same of blocks whose volume over their largest face is less; "
                            "joints, and surfaces of a file, leave their lines or planes by up to "
                            "this much where elements would be flat otherwise"),
                 number("stub", &SliverCard::stub)
                     .in("m")
                     .atLeast(0)
                     .defaultIs("half the element size")
                     .like("0.2")
                     .means("the end of a joint inside a block is left out where it reaches less "
                            "than this beyond another joint"),
                 number("shape", &SliverCard::shape)
                     .in("-")
                     .atLeast(0)
                     .atMost(0.1)
                     .like("0")
                     .means("a mesh with a flatter element is refused: least height over that of a "
                            "regular element of the size asked for, or the shape that check "
                            "prints, if that is less; 0 takes all"),
             })
      .means("blocks that are too small to stay");
}

Key makeSchema()
{
  std::string Recipe::*const title = &Recipe::title;
  return section(
      "",
      {
          definitions(),
          text<BlocksRecipe>("title", title)
              .defaultIs("the name of the file")
              .like("a slope")
              .means("title of the mesh"),
          choice<BlocksRecipe, int>("dimension", &Recipe::dimension, {{"2", 2}, {"3", 3}})
              .needed()
              .like("2")
              .means("of space; lists by dimension have as many numbers"),
          integer("seed", &BlocksRecipe::seed)
              .atLeast(0)
              .like("7")
              .means("of everything random; the same seed gives the same blocks"),
          vector("up", &BlocksRecipe::up)
              .onlyInDimension(3)
              .notAllZero()
              .in("-")
              .like("[0, 1, 0]")
              .means("for dips and sections"),
          vector("north", &BlocksRecipe::north)
              .onlyInDimension(3)
              .notAllZero()
              .in("-")
              .like("[1, 0, 0]")
              .means("for dip directions; what it has of up does not count"),
          domainKey(),
          openingsKey(),
          jointsKey(),
          elementsKey(),
          sliversKey(),
          named<BlocksRecipe, SetCard>("node_sets", &Recipe::nodeSets, nodeSetKeys())
              .means("node sets of the mesh, by a name of your choice"),
          named<BlocksRecipe, SetCard>("side_sets", &Recipe::sideSets, sideSetKeys())
              .means("side sets of the mesh, by a name of your choice: exterior faces whose nodes "
                     "all meet the selection"),
      });
}
} // namespace

namespace
{
/// Names that two things would share in the mesh.
void checkNames(const BlocksRecipe& recipe, Problems& problems)
{
  std::vector<std::string> joints;
  for (const JointsCard& joint : recipe.joints)
    joints.push_back(joint.name);
  const auto isJoint = [&](const std::string& name)
  { return std::find(joints.begin(), joints.end(), name) != joints.end(); };
  if (isJoint(recipe.domain.joint))
    problems.add(nodeAt(recipe.root, {"domain", "joint"}),
                 fmt::format("domain.joint = '{}' is also one of joints; name it otherwise.",
                             recipe.domain.joint));
  for (const OpeningCard& opening : recipe.openings)
    if (opening.keep && opening.name == recipe.domain.block)
      problems.add(nodeAt(recipe.root, {"openings", opening.name}),
                   fmt::format("openings.{} has the name of the domain's block, so that it could "
                               "not be dug out; name it otherwise.",
                               opening.name));
  for (const OpeningCard& opening : recipe.openings)
    if (opening.keep && !recipe.domain.file.empty() && opening.name == recipe.domain.supports)
      problems.add(nodeAt(recipe.root, {"openings", opening.name}),
                   fmt::format("openings.{} has the name of the block of supports, so that it "
                               "could not be dug out; name it, or domain.supports, otherwise.",
                               opening.name));
  if (!recipe.domain.joint.empty())
    joints.push_back(recipe.domain.joint);
  for (const SetCard& set : recipe.sideSets)
    if (isJoint(set.name))
      problems.add(nodeAt(recipe.root, {"side_sets", set.name}),
                   fmt::format("side_sets.{0} has the name of a joint, which becomes the side set "
                               "'{0}'; name it otherwise.",
                               set.name));
}
} // namespace

SliverLimits limitsOf(const BlocksRecipe& recipe)
{
  const Real size = recipe.elements.size;
  const SliverCard& card = recipe.slivers;
  return {card.volume >= 0 ? card.volume : std::pow(size / 2, recipe.dimension),
          card.thickness >= 0 ? card.thickness : size / 10, card.stub >= 0 ? card.stub : size / 2};
}

Real leastSizeOf(const BlocksRecipe& recipe)
{
  Real least = recipe.elements.size;
  for (const ElementSizeCard& region : recipe.elements.regions)
    least = std::min(least, region.size);
  for (const OpeningCard& opening : recipe.openings)
    if (opening.elementSize > 0)
      least = std::min(least, opening.elementSize);
  return least;
}

const Key& blocksRecipeSchema()
{
  static const Key schema = makeSchema();
  return schema;
}

const FileKind& blocksRecipeFile()
{
  static const FileKind kind{"the recipe of blocks", "coplane_mesh --help-blocks", "dimension: 2",
                             1e12};
  return kind;
}

BlocksRecipe parseBlocksRecipe(const std::string& text, const std::string& file,
                               const std::vector<std::string>& overrides)
{
  Problems problems;
  BlocksRecipe recipe;
  Key schema = blocksRecipeSchema();
  const auto fit = [&schema](const DeckNode& root) { fitToDimensionOf(root, schema); };
  recipe.root =
      readBySchema(schema, text, file, overrides, &recipe, problems, fit, blocksRecipeFile());
  const CardPlace whole{recipe.root, "", problems};
  if (problems.empty() && recipe.dimension == 3 &&
      norm(cross(recipe.up, recipe.north)) < 1e-6 * norm(recipe.up) * norm(recipe.north))
    problems.add(nodeAt(recipe.root, {"north"}), "north is parallel to up, so no azimuth is told.");
  if (problems.empty())
    checkNames(recipe, problems);
  if (!problems.empty())
    throw Error(ExitCode::Deck, problems.text());
  return recipe;
}
} // namespace coplane
