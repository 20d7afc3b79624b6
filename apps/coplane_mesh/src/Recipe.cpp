#include "Recipe.hpp"

#include "ShapeModel.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_schema/SchemaReader.hpp>

namespace coplane
{
using namespace schema;

namespace
{
const char* word(int dimension)
{
  return dimension == 2 ? "two" : "three";
}

/// Why a shape has no place in a recipe; empty: it has.
std::string problemOfShape(const std::string& name, int dimension)
{
  const ShapeModel& shape = *findModel(shapeModels(), name);
  return !shape.onlyDimension || shape.onlyDimension == dimension
             ? ""
             : fmt::format("= '{}' needs {} dimensions; use {}.", name, word(shape.onlyDimension),
                           shape.otherwise);
}

void checkRotation(const PlacementCard& card, const CardPlace& place)
{
  const std::size_t angles = card.dimension == 2 ? 1 : 3;
  if (!card.rotate.empty() && card.rotate.size() != angles)
    place.problem("rotate", card.dimension == 2
                                ? "must be one number in two dimensions: the angle about z."
                                : "must be a list of 3 numbers in three dimensions: the angles "
                                  "about x, y and z.");
}

void checkPart(PartCard& part, const CardPlace& place)
{
  if (part.dimension == 0)
    return; // reported at `dimension`
  const ShapeModel& shape = *findModel(shapeModels(), part.model);
  if (part.split != "none" && (part.split == "triangles") != (part.dimension == 2))
    place.problem("split", fmt::format("= '{}' needs {} dimensions; use {}.", part.split,
                                       word(part.dimension == 2 ? 3 : 2),
                                       part.dimension == 2 ? "triangles" : "tetrahedra"));
  checkRotation(part, place);
  shape.setDimension(part.parameters.get(), part.dimension);
  if (shape.check)
    shape.check(part.parameters.get(), place);
}

void checkMesh(MeshCard& mesh, const CardPlace& place)
{
  if (mesh.dimension > 0)
    checkRotation(mesh, place);
}

/// Keys of a PlacementCard. @param what is placed, with its article
template <class Card>
std::vector<Key> placementKeys(const std::string& what)
{
  using Numbers = std::vector<Real>;
  return {
      numbers<Card, Numbers>("rotate", &Card::rotate, 3)
          .orOneAlone()
          .in("degrees")
          .defaultIs("0")
          .like("[0, 30, 0]")
          .means("2D: one number, about z; 3D: about x, then y, then z"),
      numbers<Card, Numbers>("about", &Card::about)
          .byDimension()
          .in("m")
          .defaultIs("the middle of " + what + "'s bounding box")
          .like("[0.3, 0]")
          .means("point that stays in place"),
      numbers<Card, Numbers>("offset", &Card::offset)
          .byDimension()
          .in("m")
          .defaultIs("none")
          .like("[0, 0.05]")
          .means("added last"),
  };
}

/// A list of placed cards, which know the dimension of the recipe.
template <class Card>
KeyBuilder placed(const std::string& name, std::vector<Card> Recipe::*member,
                  const std::vector<Key>& keys)
{
  Key key = list(name, member, keys);
  key.enter = [enter = key.enter](void* recipe, const std::string& own, const std::string& where)
  {
    void* const card = enter(recipe, own, where);
    static_cast<Card*>(card)->dimension = static_cast<Recipe*>(recipe)->dimension;
    return card;
  };
  return KeyBuilder(key);
}

Key parts()
{
  std::vector<Key> keys = keysOfModels<PartCard>(shapeModels(), "what the part is", "box", "shape");
  std::string meaning = "what the part is.";
  for (const ShapeModel& shape : shapeModels())
    meaning += fmt::format(" {}: {}.", shape.name, shape.meaning);
  keys[0] = KeyBuilder(keys[0]).needed().means(meaning.substr(0, meaning.size() - 1));
  std::vector<Key> common = placementKeys<PartCard>("the part");
  common.insert(
      common.begin(),
      {text("block", &PartCard::block)
           .needed()
           .like("wall")
           .means("element block of the mesh; parts that name the same one share it"),
       text("split", &PartCard::split)
           .oneOf({"none", "triangles", "tetrahedra"})
           .like("triangles")
           .means("every quadrilateral into 2 triangles, every hexahedron into 5 tetrahedra")});
  keys.insert(keys.begin() + 1, common.begin(), common.end());
  return placed("parts", &Recipe::parts, keys)
      .decidedBy("shape")
      .checkedBy(checkPart)
      .means("bodies, each with nodes of its own");
}

Key meshes()
{
  std::vector<Key> keys = placementKeys<MeshCard>("the mesh");
  keys.insert(keys.begin(),
              {text("file", &MeshCard::file)
                   .needed()
                   .like("projectile.e")
                   .means("Exodus II file, beside the recipe"),
               text("prefix", &MeshCard::prefix)
                   .defaultIs("none")
                   .like("bar_")
                   .means("put before the names of its blocks and sets"),
               flag("join", &MeshCard::join)
                   .like("true")
                   .means("its blocks and sets go into those before them that have their names; "
                          "otherwise such names are refused"),
               number("scale", &MeshCard::scale)
                   .in("-")
                   .above(0)
                   .like("0.001")
                   .means("its lengths are times this, before all else: 0.001 where they are in "
                          "millimetres")});
  return placed("meshes", &Recipe::meshes, keys)
      .orOneAlone()
      .checkedBy(checkMesh)
      .means("meshes of files, put beside the parts with their blocks, node sets and side sets; "
             "they share no nodes");
}

void checkPlaces(PlacesCard& places, const CardPlace& place)
{
  const std::pair<const char*, const std::vector<Real>&> all[]{{"x", places.x},
                                                               {"y", places.y},
                                                               {"z", places.z},
                                                               {"radius", places.radius},
                                                               {"angle", places.angle}};
  for (const auto& [key, ends] : all)
    if (ends.size() == 2 && ends[0] > ends[1])
      place.problem(key, fmt::format("= [{}, {}]: the lower end comes first.", ends[0], ends[1]));
}

KeyBuilder places(const std::string& name, PlacesCard SetCard::*member)
{
  const auto range =
      [](const std::string& axis, std::vector<Real> PlacesCard::*field, const std::string& meaning)
  {
    return numbers(axis, field, 2)
        .orOneAlone()
        .in("m")
        .defaultIs("any")
        .like("[0, 1]")
        .means(meaning);
  };
  return group(name, member,
               {
                   range("x", &PlacesCard::x, "a plane, or from and to"),
                   range("y", &PlacesCard::y, "a plane, or from and to"),
                   range("z", &PlacesCard::z, "a plane, or from and to").onlyInDimension(3),
                   range("radius", &PlacesCard::radius,
                         "distance from the z axis (2D: from the origin)"),
                   range("angle", &PlacesCard::angle, "from x towards y about the z axis")
                       .in("degrees")
                       .like("[0, 90]"),
               })
      .checkedBy(checkPlaces);
}

std::vector<Key> setKeys()
{
  return {
      texts("block", &SetCard::blocks)
          .orOneAlone()
          .atLeastItems(1)
          .defaultIs("all blocks")
          .like("[wall, slab]")
          .means("blocks of the parts"),
      places("where", &SetCard::places)
          .means("where in the mesh; nodes must meet all keys, within 1e-6 of the mesh size"),
      places("where_own", &SetCard::ownPlaces)
          .means("the same in the part's coordinates before rotate and offset"),
  };
}

/// Where the dimension is not known: keys of one of them may be missing.
void demandNothingOfDimensions(Key& key)
{
  key.required = key.required && key.dimension == 0;
  for (Key& one : key.keys)
    demandNothingOfDimensions(one);
}

Key makeSchema()
{
  return section(
      "", {
              definitions(),
              text("title", &Recipe::title)
                  .defaultIs("the name of the file")
                  .like("a wall and a bar")
                  .means("title of the mesh"),
              choice("dimension", &Recipe::dimension, {{"2", 2}, {"3", 3}})
                  .needed()
                  .like("2")
                  .means("of space; lists by dimension have as many numbers"),
              parts(),
              meshes(),
              named("node_sets", &Recipe::nodeSets, nodeSetKeys())
                  .means("node sets of the mesh, by a name of your choice"),
              named("side_sets", &Recipe::sideSets, sideSetKeys())
                  .means("side sets of the mesh, by a name of your choice: exterior faces whose "
                         "nodes all meet the selection"),
          });
}
} // namespace

std::vector<Key> nodeSetKeys()
{
  return setKeys();
}

std::vector<Key> sideSetKeys()
{
  std::vector<Key> keys = setKeys();
  keys.push_back(numbers("normal", &SetCard::normal)
                     .byDimension()
                     .notAllZero()
                     .in("-")
                     .defaultIs("any")
                     .like("[0, 1]")
                     .means("outward normal, within 26 degrees"));
  return keys;
}

int fitToDimensionOf(const DeckNode& root, Key& schema)
{
  const DeckNode* const dimension = root.find("dimension");
  if (!dimension || (dimension->text != "2" && dimension->text != "3"))
  {
    demandNothingOfDimensions(schema);
    return 0;
  }
  const int axes = dimension->text == "2" ? 2 : 3;
  fitToDimension(schema, axes);
  return axes;
}

const Key& recipeSchema()
{
  static const Key schema = makeSchema();
  return schema;
}

const FileKind& recipeFile()
{
  static const FileKind kind{"the recipe", "coplane_mesh --help-recipe", "dimension: 2", 1e12};
  return kind;
}

Recipe parseRecipe(const std::string& text, const std::string& file,
                   const std::vector<std::string>& overrides)
{
  Problems problems;
  Recipe recipe;
  Key schema = recipeSchema();
  const auto fit = [&schema](const DeckNode& root)
  {
    const int axes = fitToDimensionOf(root, schema);
    for (Key& key : schema.keys)
      if (axes > 0 && key.name == "parts")
        key.problemOfModel = [axes](const std::string& shape)
        { return problemOfShape(shape, axes); };
  };
  recipe.root = readBySchema(schema, text, file, overrides, &recipe, problems, fit, recipeFile());
  if (problems.empty() && recipe.parts.empty() && recipe.meshes.empty())
    problems.add(recipe.root, "the recipe has no parts and no meshes. Accepted: parts: [{shape: "
                              "box, ...}], meshes: [{file: wall.e}] or both; coplane_mesh "
                              "--help-recipe parts lists the keys.");
  if (!problems.empty())
    throw Error(ExitCode::Deck, problems.text());
  return recipe;
}
} // namespace coplane
