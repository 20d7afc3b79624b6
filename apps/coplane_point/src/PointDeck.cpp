#include "PointDeck.hpp"

#include "PathFile.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/Suggestion.hpp>
#include <coplane_input/ContactSchema.hpp>
#include <coplane_input/DeckReader.hpp>
#include <coplane_input/JointCards.hpp>
#include <coplane_input/MaterialCards.hpp>
#include <coplane_schema/SchemaBuilder.hpp>
#include <coplane_schema/SchemaReader.hpp>

#include <algorithm>
#include <filesystem>

namespace coplane
{
using namespace schema;

namespace
{
Key jointPaths()
{
  const auto takeSteps = [](int& field, int value) { field = value; };
  return named(
             "joint_paths", &PointDeck::jointPaths,
             {
                 text("type", &JointPathCard::type)
                     .needed()
                     .oneOf({"closing", "shear", "circle", "points"})
                     .like("shear")
                     .means(
                         "closing: closures in turn; shear: slips in turn, under normal "
                         "traction; circle: slip around a circle, under normal traction; points: "
                         "gaps and slips from lists or a file"),
                 text("joint", &JointPathCard::joint)
                     .needed()
                     .like("dry")
                     .means("name of a card in joints"),
                 flag("declared", &JointPathCard::declared)
                     .like("false")
                     .means(
                         "a joint of the model, bonded at the start if its law has a bond; false: "
                         "a contact that was made later"),
                 bound<int>("steps", KeyKind::Integer, &JointPathCard::steps, takeSteps)
                     .atLeast(1)
                     .in("steps")
                     .like("1000")
                     .defaultIs(fmt::format("{}", JointPathCard{}.steps))
                     .means("from one point of the path to the next; of a circle: for each turn"),
                 number("speed", &JointPathCard::speed)
                     .onlyFor({"closing", "shear", "circle"})
                     .in("m/s")
                     .above(0)
                     .like("0.5")
                     .means("with which the path is followed, for friction that depends on speed"),
                 text("output", &JointPathCard::output)
                     .like("dry.csv")
                     .defaultIs("<name of the deck>_<name of the path>.csv")
                     .means("CSV file, relative to the working folder"),
                 numbers("closures", &JointPathCard::closures)
                     .onlyFor({"closing"})
                     .needed()
                     .in("m")
                     .like("[1e-4, 5e-5, 1.6e-4, 0]")
                     .means("visited in turn from 0; negative: the joint opens"),
                 numbers("slips", &JointPathCard::slips)
                     .onlyFor({"shear"})
                     .needed()
                     .in("m")
                     .like("[1e-3, -1e-3]")
                     .means("visited in turn from 0, along x"),
                 number("normal_traction", &JointPathCard::normalTraction)
                     .onlyFor({"shear", "circle"})
                     .in("Pa")
                     .atLeast(0)
                     .like("2e6")
                     .means("compression before the shear starts"),
                 number("surrounding_stiffness", &JointPathCard::surroundingStiffness)
                     .onlyFor({"shear", "circle"})
                     .in("Pa/m")
                     .atLeast(0)
                     .like("5e9")
                     .means("by which the compression rises when the joint dilates; 0: it stays"),
                 number("radius", &JointPathCard::radius)
                     .onlyFor({"circle"})
                     .needed()
                     .in("m")
                     .above(0)
                     .like("1e-3")
                     .means("of the circle, which starts at 0 along y"),
                 number("turns", &JointPathCard::turns)
                     .onlyFor({"circle"})
                     .in("-")
                     .above(0)
                     .like("2")
                     .means("how often the circle is followed"),
                 text("file", &JointPathCard::file)
                     .onlyFor({"points"})
                     .like("path.csv")
                     .means(
                         "CSV file, relative to the folder of the deck: a line of headings, then "
                         "time [s], gap [m], slip in x [m], slip in y [m]"),
                 numbers("times", &JointPathCard::times)
                     .onlyFor({"points"})
                     .in("s")
                     .above(0)
                     .like("[0.5, 1]")
                     .means("rising; the path starts at 0 with gap and slips 0"),
                 numbers("gaps", &JointPathCard::gaps)
                     .onlyFor({"points"})
                     .in("m")
                     .like("[-2e-5, -2e-5]")
                     .defaultIs("all 0")
                     .means("normal opening at `times`; negative: the joint closes"),
                 numbers("slips_x", &JointPathCard::slipsX)
                     .onlyFor({"points"})
                     .in("m")
                     .like("[0, 1e-4]")
                     .defaultIs("all 0")
                     .means("slip along x at `times`"),
                 numbers("slips_y", &JointPathCard::slipsY)
                     .onlyFor({"points"})
                     .in("m")
                     .like("[0, 5e-5]")
                     .defaultIs("all 0")
                     .means("slip along y at `times`"),
             })
      .decidedBy("type")
      .means("paths on which joints are led, by a name of your choice; each gives one CSV file");
}

/// What one key of a path demands of another.
class PathCheck
{
public:
  PathCheck(PointDeck& deck, JointPathCard& card, const DeckNode& root, Problems& problems)
      : deck_(deck), card_(card), root_(root), problems_(problems)
  {
  }

  void all()
  {
    std::vector<std::string> names;
    for (const auto& joint : deck_.joints)
      names.push_back(joint.name);
    const auto found = std::find(names.begin(), names.end(), card_.joint);
    if (!card_.joint.empty() && found == names.end())
      problem("joint", fmt::format(" = '{}' is not a card in joints.{} There {}.", card_.joint,
                                   didYouMean(card_.joint, names),
                                   names.empty() ? "are none" : "is: " + listOf(names)));
    else if (found != names.end() && deck_.elements.isRigid() &&
             needsElements(deck_.joints[std::size_t(found - names.begin())]))
      problem("joint", fmt::format(" = '{}' has a stiffness that comes from the elements; give "
                                   "elements.thickness [m] and elements.modulus [Pa].",
                                   card_.joint));
    if (card_.type == "closing" && given("closures") && card_.closures.empty())
      problem("closures", " is empty; accepted: at least one number.");
    if (card_.type == "shear" && given("slips") && card_.slips.empty())
      problem("slips", " is empty; accepted: at least one number.");
    if (card_.type == "points")
      points();
  }

private:
  bool given(const char* key) const
  {
    const DeckNode* paths = root_.find("joint_paths");
    const DeckNode* path = paths ? paths->find(card_.name) : nullptr;
    return path && path->find(key);
  }

  void problem(const std::string& key, const std::string& text)
  {
    problems_.add(nodeAt(root_, {"joint_paths", card_.name, key}),
                  fmt::format("joint_paths.{}.{}{}", card_.name, key, text));
  }

  void points()
  {
    if (!card_.file.empty())
    {
      bool alone = true;
      for (const char* key : {"times", "gaps", "slips_x", "slips_y"})
        if (given(key))
        {
          problem(key, " and file exclude each other; keep one of them.");
          alone = false;
        }
      const auto folder = std::filesystem::path(deck_.file).parent_path();
      card_.file = (folder / card_.file).lexically_normal().string();
      if (alone)
        readPathFile(card_.file, card_, nodeAt(root_, {"joint_paths", card_.name, "file"}),
                     problems_);
      return;
    }
    if (!given("times"))
      return problem("times", " is missing; accepted: a list of numbers [s], or a file.");
    if (card_.times.empty())
      return problem("times", " is empty; accepted: at least one number.");
    for (std::size_t i = 1; i < card_.times.size(); ++i)
      if (!(card_.times[i] > card_.times[i - 1]))
        return problem("times", fmt::format(" does not rise at item {}: {} s after {} s.", i,
                                            card_.times[i], card_.times[i - 1]));
    list("gaps", card_.gaps);
    list("slips_x", card_.slipsX);
    list("slips_y", card_.slipsY);
  }

  void list(const char* key, std::vector<Real>& values)
  {
    if (!given(key))
      values.assign(card_.times.size(), 0);
    else if (values.size() != card_.times.size())
      problem(key, fmt::format(" has {} numbers, but times has {}; accepted: as many.",
                               values.size(), card_.times.size()));
  }

  PointDeck& deck_;
  JointPathCard& card_;
  const DeckNode& root_;
  Problems& problems_;
};

/// What the paths of materials demand beyond the schema.
void checkMaterialPaths(PointDeck& deck, const DeckNode& root, Problems& problems)
{
  std::vector<std::string> names;
  for (const auto& material : deck.materials)
    names.push_back(material.name);
  for (MaterialPathCard& card : deck.materialPaths)
  {
    const DeckNode& node = nodeAt(root, {"material_paths", card.name});
    const std::string path = "material_paths." + card.name;
    const auto at = [&](const char* key) -> const DeckNode& {
      return nodeAt(root, {"material_paths", card.name, key});
    };
    if (!card.material.empty() &&
        std::find(names.begin(), names.end(), card.material) == names.end())
      problems.add(at("material"),
                   fmt::format("{}.material = '{}' is neither a card in materials nor a set of the "
                               "library.{} There {}.",
                               path, card.material, didYouMean(card.material, names),
                               names.empty() ? "are none" : "is: " + listOf(names)));
    if (node.find("strains") && card.strains.empty())
      problems.add(at("strains"),
                   fmt::format("{}.strains is empty; accepted: at least one number.", path));
    for (std::size_t i = 1; i < card.times.size(); ++i)
      if (!(card.times[i] > card.times[i - 1]))
        problems.add(at("times"), fmt::format("{}.times does not rise at item {}: {} s after {} s.",
                                              path, i, card.times[i], card.times[i - 1]));
    constexpr const char* components[6] = {"xx", "yy", "zz", "xy", "yz", "zx"};
    for (int k = 0; k < 6; ++k)
      if (!card.values[k].empty() && card.values[k].size() != card.times.size())
        problems.add(at(components[k]),
                     fmt::format("{}.{} has {} numbers, but times has {}; accepted: as many.", path,
                                 components[k], card.values[k].size(), card.times.size()));
    if (card.output.empty())
      card.output =
          fmt::format("{}_{}.csv", std::filesystem::path(deck.file).stem().string(), card.name);
  }
}
} // namespace

const Key& pointSchema()
{
  static const Key schema = section(
      "", {
              definitions(),
              text("title", &PointDeck::title).means("for the records").like("Direct shear"),
              Key(named("joints", &PointDeck::joints, jointCardKeys())
                      .decidedBy("model")
                      .atMostOneOf({"shear_stiffness", "shear_ratio"})
                      .means("laws of contact planes, as in decks of coplane")),
              Key(group("elements", &PointDeck::elements,
                        {
                            number("thickness", &ElementCard::thickness)
                                .in("m")
                                .above(0)
                                .like("0.1")
                                .defaultIs("none, rigid")
                                .means("of the elements behind both faces"),
                            number("modulus", &ElementCard::modulus)
                                .in("Pa")
                                .above(0)
                                .like("40e9")
                                .defaultIs("none, rigid")
                                .means("P-wave modulus K + 4G/3 of the elements behind both faces"),
                        })
                      .means("what a joint takes from the elements behind its faces: the stiffness "
                             "of penalty joints, the default of stiffness_cap")),
              jointPaths(),
              Key(named("materials", &PointDeck::materials, materialCardKeys())
                      .decidedBy("model")
                      .completedBy("set")
                      .means("laws of the continuum, as in decks of coplane")),
              Key(named("material_paths", &PointDeck::materialPaths, materialPathKeys())
                      .decidedBy("type")
                      .means("paths on which materials are led, by a name of your choice; each "
                             "gives one CSV file")),
          });
  return schema;
}

PointDeck parsePointDeck(const std::string& text, const std::string& file,
                         const std::vector<std::string>& overrides)
{
  Problems problems;
  PointDeck deck;
  deck.file = file;
  const DeckNode root =
      readBySchema(pointSchema(), text, file, overrides, &deck, problems, insertMaterialSets);
  checkJoints(deck.joints, root, problems);
  for (JointPathCard& card : deck.jointPaths)
  {
    PathCheck(deck, card, root, problems).all();
    if (card.output.empty())
      card.output =
          fmt::format("{}_{}.csv", std::filesystem::path(file).stem().string(), card.name);
  }
  checkMaterials(deck.materials, root, problems);
  checkMaterialPaths(deck, root, problems);
  if (problems.empty() && deck.jointPaths.empty() && deck.materialPaths.empty())
    problems.add(root, "joint_paths and material_paths are missing; accepted: at least one path in "
                       "one of them.");
  if (!problems.empty())
    throw Error(ExitCode::Deck, problems.text());
  deck.warnings = problems.warnings();
  return deck;
}

PointDeck readPointDeck(const std::string& file, const std::vector<std::string>& overrides)
{
  return parsePointDeck(readDeckFile(file), file, overrides);
}
} // namespace coplane
