#include "ExampleFile.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/Suggestion.hpp>
#include <coplane_schema/Definitions.hpp>
#include <coplane_schema/SchemaBuilder.hpp>
#include <coplane_schema/SchemaReader.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
using namespace schema;

namespace
{
using Json = nlohmann::ordered_json;

/// What an example, one of its sizes or one of its variants may say.
struct ChangeCard
{
  std::string name, where;
  std::string title;
  std::string recipe = "mesh.yaml", joints, deck = "deck.yaml";
  int ranks = 2;
};

/// What one call of `coplane pictures` draws; keys are its options.
struct PictureCard
{
  std::string name, where;
  std::vector<Real> times, shares, range, window, direction, size{1200, 800};
  std::string color = "block", title, palette = "green_blue", camera, up, planes = "dots",
              lines = "force";
  std::vector<std::string> blocks, plain;
  int steps = 2, dotSize = 4, columns = 0;
  Real opacity = 1;
  bool mirror = false, noEdges = false, undeformed = false;
};

struct ExampleCard : ChangeCard
{
  std::string size;
  std::string check = "check.py", summary = "summary.py";
  std::vector<ChangeCard> sizes, variants;
  std::vector<PictureCard> pictures;
};

template <class Card>
std::vector<Key> commonKeys()
{
  return {
      text<Card>("recipe", &Card::recipe).like("mesh_3d.yaml").means("recipe of the mesh"),
      text<Card>("joints", &Card::joints)
          .defaultIs("none")
          .like("joints.yaml")
          .means("recipe of joints that are opened in the mesh"),
      text<Card>("deck", &Card::deck).like("deck_3d.yaml").means("the deck"),
      integer<Card>("ranks", &Card::ranks).in("ranks").atLeast(1).like("1").means("MPI ranks"),
  };
}

std::vector<Key> changeKeys()
{
  std::vector<Key> keys = commonKeys<ChangeCard>();
  keys.insert(keys.begin(), text("title", &ChangeCard::title)
                                .defaultIs("that of the example")
                                .like("a wider wall")
                                .means("of the run"));
  keys.push_back(changes("mesh")
                     .like("{parts.0.divisions: [8, 4]}")
                     .means("of the recipe, by paths of its keys"));
  keys.push_back(changes("set")
                     .like("{time.end: 0.5}")
                     .means("of the deck, by paths of its keys; null takes a key out"));
  return keys;
}

std::vector<Key> pictureKeys()
{
  using Card = PictureCard;
  return {
      numbers("times", &Card::times)
          .in("s")
          .atLeast(0)
          .defaultIs("the first and the last")
          .like("[0, 0.25]")
          .means("the states nearest to these times"),
      numbers("shares", &Card::shares)
          .in("-")
          .atLeast(0)
          .atMost(1)
          .defaultIs("none")
          .like("[0, 0.6, 1]")
          .means("the states nearest to these shares of the last time"),
      integer("steps", &Card::steps)
          .in("states")
          .atLeast(1)
          .like("6")
          .means("so many states from the first to the last"),
      text("color", &Card::color)
          .like("4*(1-damage)")
          .means("block, a variable of the results, or an expression of variables"),
      text("title", &Card::title)
          .defaultIs("the variable and its unit")
          .like("tensile strength [MPa]")
          .means("of the colours"),
      numbers("range", &Card::range, 2)
          .in("-")
          .defaultIs("of all that is drawn")
          .like("[0, 1]")
          .means("of the colours, in the unit of the variable"),
      text("palette", &Card::palette)
          .oneOf({"green_blue", "cool_warm", "white_to_blue", "dark"})
          .like("cool_warm")
          .means("the colours"),
      texts("blocks", &Card::blocks).defaultIs("all").like("[slab]").means("only these blocks"),
      texts("plain", &Card::plain)
          .defaultIs("none")
          .like("[projectile]")
          .means("blocks in a colour of their own, where others have that of a variable"),
      text("camera", &Card::camera)
          .oneOf({"front", "back", "left", "right", "top", "bottom", "iso"})
          .defaultIs("front; in space iso")
          .like("left")
          .means("where it stands"),
      numbers("direction", &Card::direction, 3)
          .in("-")
          .notAllZero()
          .defaultIs("that of camera")
          .like("[1, -4, 2]")
          .means("from the bodies to the camera"),
      text("up", &Card::up)
          .oneOf({"y", "z"})
          .defaultIs("the axis against gravity, else z in space")
          .like("y")
          .means("the axis that points up"),
      numbers("window", &Card::window)
          .in("m")
          .atLeastItems(4)
          .defaultIs("all bodies")
          .like("[-12, 12, -2, 11.5]")
          .means("what is seen: x0, x1, y0, y1, in space also with z0, z1"),
      text("planes", &Card::planes)
          .like("slip")
          .means("dots, all, arrows, none, or a variable of the planes: dots in its colours"),
      text("lines", &Card::lines)
          .oneOf({"force", "stress", "strain", "plastic_strain", "broken", "slip", "bond", "none"})
          .like("slip")
          .means("segments of lines in the colours of this, where the run has output.lines"),
      integer("dot_size", &Card::dotSize)
          .in("points of the screen")
          .atLeast(1)
          .like("6")
          .means("of the planes"),
      number("opacity", &Card::opacity)
          .in("-")
          .above(0)
          .atMost(1)
          .like("0.3")
          .means("of the bodies"),
      flag("mirror", &Card::mirror).like("true").means("also the mirror image at x = 0"),
      flag("no_edges", &Card::noEdges).like("true").means("without the edges of elements"),
      flag("undeformed", &Card::undeformed).like("true").means("at the coordinates of the start"),
      numbers("size", &Card::size, 2)
          .in("points of the screen")
          .atLeast(1)
          .like("[460, 300]")
          .means("width and height"),
      integer("strip", &Card::columns)
          .in("columns")
          .atLeast(1)
          .defaultIs("a picture for each state")
          .like("4")
          .means("one picture of all states, so many in a row"),
  };
}

void checkExample(ExampleCard& example, const CardPlace& place)
{
  std::vector<std::string> names;
  for (const ChangeCard& size : example.sizes)
    names.push_back(size.name);
  if (place.gives("default") && std::find(names.begin(), names.end(), example.size) == names.end())
    place.problems.add(*place.node.find("default"),
                       fmt::format("default = '{}' is none of the sizes.{} There are: {}.",
                                   example.size, didYouMean(example.size, names), listOf(names)));
}

Key makeSchema()
{
  using Card = ExampleCard;
  std::vector<Key> keys = commonKeys<Card>();
  keys.insert(keys.begin(), text<Card>("title", &Card::title)
                                .needed()
                                .like("a ball against a wall")
                                .means("what the example is"));
  const std::vector<Key> own{
      text("default", &Card::size)
          .defaultIs("the first")
          .like("S")
          .means("the size that is run when none is named"),
      named("sizes", &Card::sizes, changeKeys())
          .needed()
          .means("sizes of the problem, by names of your choice: what they change"),
      named("variants", &Card::variants, changeKeys())
          .means("variants of the problem, by names of your choice: what they change"),
      named("pictures", &Card::pictures, pictureKeys())
          .means("what coplane pictures draws of a run, by names of your choice, with which the "
                 "names of files begin: its options"),
      text("check", &Card::check)
          .like("../perforation/check.py")
          .means("looks at the results of a run"),
      text("summary", &Card::summary)
          .like("../perforation/summary.py")
          .means("looks at the results of all runs"),
  };
  keys.insert(keys.end(), own.begin(), own.end());
  return section("", keys).checkedBy(checkExample);
}

Json jsonOfScalar(const DeckNode& node)
{
  const auto number = node.quoted ? std::nullopt : numberIn(node.text);
  if (number && std::isfinite(*number)) // others stay as they are written
  {
    const bool isWhole = node.text.find_first_not_of("+-0123456789") == std::string::npos;
    return isWhole && std::abs(*number) < 1e15 ? Json(std::int64_t(*number)) : Json(*number);
  }
  const bool isBoolean = !node.quoted && (node.text == "true" || node.text == "false");
  return isBoolean ? Json(node.text == "true") : Json(node.text);
}

/// @param asText what example files say themselves is text, whatever it looks like; changes are
///        what they look like
Json jsonOf(const DeckNode& node, bool asText = true)
{
  Json json;
  switch (node.kind)
  {
  case DeckNode::Kind::Nothing:
    return json;
  case DeckNode::Kind::Scalar:
    return asText ? Json(node.text) : jsonOfScalar(node);
  case DeckNode::Kind::List:
    json = Json::array();
    for (const DeckNode& item : node.items)
      json.push_back(jsonOf(item, asText));
    return json;
  case DeckNode::Kind::Map:
    json = Json::object();
    for (const auto& [key, value] : node.entries)
      json[key.text] =
          jsonOf(value, asText && key.text != "mesh" && key.text != "set" && key.text != "ranks");
    return json;
  }
  return json;
}
} // namespace

const Key& exampleSchema()
{
  static const Key schema = makeSchema();
  return schema;
}

const FileKind& exampleFile()
{
  static const FileKind kind{"the example", "coplane_mesh --help-example", "title: two bars"};
  return kind;
}

std::string exampleAsJson(const std::string& text, const std::string& file)
{
  Problems problems;
  ExampleCard example;
  const DeckNode root =
      readBySchema(exampleSchema(), text, file, {}, &example, problems, {}, exampleFile());
  if (!problems.empty())
    throw Error(ExitCode::Deck, problems.text());
  return jsonOf(root).dump(1) + "\n";
}
} // namespace coplane
