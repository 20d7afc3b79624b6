#include "JointRecipe.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_schema/SchemaBuilder.hpp>
#include <coplane_schema/SchemaReader.hpp>

namespace coplane
{
using namespace schema;

namespace
{
void checkPlanes(PlanesCard&, const CardPlace& place)
{
  if (place.gives("count") && !place.gives("spacing"))
    place.problem("count", "needs spacing.");
}

void checkBox(PlanesCard::Box& box, const CardPlace& place)
{
  for (std::size_t axis = 0; axis < box.min.size(); ++axis)
    if (!(box.max[axis] >= box.min[axis]))
      place.problem("max", fmt::format("= {} m along {} is less than min = {} m.", box.max[axis],
                                       "xyz"[axis], box.min[axis]));
}

template <class Card>
Key corner(const std::string& name, std::vector<Real> Card::*member, const std::string& meaning)
{
  return numbers(name, member).needed().byDimension().in("m").like("[0, 0]").means(meaning);
}

/// Which part of the planes is cut.
std::vector<Key> extentKeys()
{
  const auto radius = number("radius", &PlanesCard::Disc::radius)
                          .needed()
                          .in("m")
                          .above(0)
                          .like("2")
                          .means("of the circle");
  return {
      points("segment", &PlanesCard::segment, 2)
          .onlyInDimension(2)
          .in("m")
          .defaultIs("no limit")
          .like("[[3, 1], [3, 4]]")
          .means("only between the shadows of two points on the plane"),
      group("disc", &PlanesCard::disc,
            {corner("centre", &PlanesCard::Disc::centre, "of the circle"), radius})
          .means("only within a circle"),
      group("box", &PlanesCard::box,
            {corner("min", &PlanesCard::Box::min, "lowest corner"),
             corner("max", &PlanesCard::Box::max, "highest corner")})
          .checkedBy(checkBox)
          .means("only within a box"),
      points("polygon", &PlanesCard::polygon)
          .atLeastItems(3)
          .onlyInDimension(3)
          .in("m")
          .defaultIs("no limit")
          .like("[[0, 0, 1], [4, 0, 1], [4, 4, 1]]")
          .means("only within the shadow of a polygon on the plane"),
  };
}

Key planesKey()
{
  std::vector<Key> keys{
      corner("point", &PlanesCard::point, "of the plane"),
      numbers("normal", &PlanesCard::normal)
          .needed()
          .byDimension()
          .notAllZero()
          .in("-")
          .like("[0, 1]")
          .means("of the plane, of any length"),
      number("spacing", &PlanesCard::spacing)
          .in("m")
          .above(0)
          .defaultIs("one plane")
          .like("1")
          .means("parallel planes at this distance, one through the point, as many as meet the "
                 "mesh"),
      integer("count", &PlanesCard::count)
          .in("planes")
          .atLeast(1)
          .defaultIs("all that meet the mesh")
          .like("3")
          .means("with spacing: so many, from the point along the normal"),
      number("tolerance", &PlanesCard::tolerance)
          .in("m")
          .above(0)
          .defaultIs("1e-6 of the mesh size")
          .like("0.03")
          .means("distance of face centres from the plane"),
      number("angle", &PlanesCard::angle)
          .in("degrees")
          .above(0)
          .below(90)
          .like("20")
          .means("between the normals of face and plane"),
  };
  const std::vector<Key> extent = extentKeys();
  keys.insert(keys.end(), extent.begin(), extent.end());
  Key key = list("planes", &JointCutCard::planes, keys)
                .orOneAlone()
                .checkedBy(checkPlanes)
                .means("faces on planes");
  return key;
}

Key blockPairs()
{
  Key key = bound<std::vector<std::vector<std::string>>>("blocks", KeyKind::TextLists,
                                                         &JointCutCard::blocks, copyTo)
                .oneOf({"all"})
                .atLeastItems(1)
                .like("[[rock, liner]]")
                .means("faces on the borders of all blocks, or of pairs of blocks");
  key.itemLength = 2;
  return key;
}
} // namespace

const Key& jointRecipeSchema()
{
  static const Key schema =
      section("", {
                      definitions(),
                      Key(named("joints", &JointRecipe::joints,
                                {
                                    planesKey(),
                                    blockPairs(),
                                    texts("side_sets", &JointCutCard::sideSets)
                                        .orOneAlone()
                                        .atLeastItems(1)
                                        .like("crack")
                                        .means("faces of side sets inside the mesh"),
                                    texts("every_face", &JointCutCard::everyFace)
                                        .orOneAlone()
                                        .atLeastItems(1)
                                        .like("rock")
                                        .means("all faces between the elements of these blocks, of "
                                               "one block or of two of them; all: of the mesh"),
                                })
                              .needed()
                              .exactlyOneOf({"planes", "blocks", "side_sets", "every_face"})
                              .means("joints by the names of the side sets that hold both faces of "
                                     "every cut face; cut in the order of the file: a face that "
                                     "several find belongs to the first")),
                  });
  return schema;
}

const FileKind& jointRecipeFile()
{
  static const FileKind kind{"the recipe of joints", "coplane_mesh --help-split",
                             "joints: {all: {blocks: all}}", 1e12};
  return kind;
}

JointRecipe parseJointRecipe(const std::string& text, const std::string& file, int dimension,
                             const std::vector<std::string>& overrides)
{
  Problems problems;
  JointRecipe recipe;
  Key schema = jointRecipeSchema();
  fitToDimension(schema, dimension);
  recipe.root =
      readBySchema(schema, text, file, overrides, &recipe, problems, {}, jointRecipeFile());
  if (!problems.empty())
    throw Error(ExitCode::Deck, problems.text());
  return recipe;
}
} // namespace coplane
