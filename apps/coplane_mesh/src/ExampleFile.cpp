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

struct ExampleCard : ChangeCard
{
  std::string size;
  std::string pictures = "pictures.py", check = "check.py", summary = "summary.py";
  std::vector<ChangeCard> sizes, variants;
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
      text("pictures", &Card::pictures)
          .like("../perforation/pictures.py")
          .means("draws the pictures"),
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
