#include <coplane_input/DeckFingerprint.hpp>
#include <coplane_input/MaterialCards.hpp>
#include <coplane_schema/DeckNode.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <sstream>

namespace coplane
{
namespace
{
const std::vector<std::string> mayChange{"title",
                                         "mesh",
                                         "time.end",
                                         "time.end_at_rest",
                                         "time.energy_tolerance",
                                         "time.contact_gain_tolerance",
                                         "contact.lost_contact",
                                         "output",
                                         "history.every",
                                         "history.file",
                                         "history.tables",
                                         "checkpoint",
                                         "partition"};

bool isFree(const std::string& path)
{
  return std::any_of(mayChange.begin(), mayChange.end(),
                     [&](const std::string& name)
                     { return path == name || path.rfind(name + ".", 0) == 0; });
}

std::string valueOf(const DeckNode& node)
{
  if (node.kind == DeckNode::Kind::Nothing)
    return "nothing";
  if (!node.quoted && !node.text.empty())
  {
    char* end = nullptr;
    const double number = std::strtod(node.text.c_str(), &end);
    if (*end == '\0')
      return fmt::format("{}", number);
  }
  // One line each, whatever the text.
  std::string line = node.text;
  std::replace(line.begin(), line.end(), '\n', ' ');
  return line;
}

/// In the paths of fingerprints for a dot that belongs to a name.
constexpr char dotOfName = '\x1f';

std::string wordOfKey(std::string key)
{
  std::replace(key.begin(), key.end(), '.', dotOfName);
  return key;
}

/// A path as decks and --set have it.
std::string shown(std::string path)
{
  std::replace(path.begin(), path.end(), dotOfName, '.');
  return path;
}

void collect(const DeckNode& node, const std::string& path, std::vector<std::string>& lines)
{
  if (isFree(path))
    return;
  const std::string prefix = path.empty() ? "" : path + ".";
  switch (node.kind)
  {
  case DeckNode::Kind::Map:
    for (const auto& [key, value] : node.entries)
      collect(value, prefix + wordOfKey(key.text), lines);
    break;
  case DeckNode::Kind::List:
    for (std::size_t i = 0; i < node.items.size(); ++i)
      collect(node.items[i], prefix + std::to_string(i), lines);
    break;
  default:
    lines.push_back(fmt::format("{} = {}", path, valueOf(node)));
  }
}

std::map<std::string, std::string> valuesIn(const std::string& fingerprint)
{
  std::map<std::string, std::string> values;
  std::istringstream lines(fingerprint);
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t equals = line.find(" = "); equals != std::string::npos)
      values[line.substr(0, equals)] = line.substr(equals + 3);
  return values;
}
} // namespace

std::string deckFingerprint(const std::string& deckText, const std::string& file)
{
  // With what comes from the library: a deck that --set has changed is written with it.
  DeckNode root = parseYaml(deckText, file);
  insertMaterialSets(root);
  std::vector<std::string> lines;
  collect(root, "", lines);
  std::sort(lines.begin(), lines.end());
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

namespace
{
struct DeckChange
{
  std::string path, text; ///< a sentence
};

std::vector<DeckChange> changesBetween(const std::map<std::string, std::string>& old,
                                       const std::map<std::string, std::string>& present)
{
  std::vector<DeckChange> changes;
  for (const auto& [path, value] : old)
  {
    const auto found = present.find(path);
    if (found == present.end())
      changes.push_back({path, fmt::format("{} was {} and is not there now", shown(path), value)});
    else if (found->second != value)
      changes.push_back(
          {path, fmt::format("{} was {} and is {} now", shown(path), value, found->second)});
  }
  for (const auto& [path, value] : present)
    if (old.find(path) == old.end())
      changes.push_back({path, fmt::format("{} is {} now and was not there", shown(path), value)});
  return changes;
}

using Words = std::vector<std::string>;

Words wordsOf(const std::string& path)
{
  Words words;
  std::istringstream stream(path);
  for (std::string word; std::getline(stream, word, '.');)
    words.push_back(word);
  return words;
}

bool has(const Words& words, const std::string& word)
{
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Sections that may change as a whole: nothing of them is in the state.
const Words freeInStages{"conditions", "gravity", "damping"};
const Words timesFreeInStages{"step_factor", "maximum_step", "fixed_step"};
/// Of joints: strengths. A stiffness would change the energy that is stored in what is closed.
const Words jointKeysFreeInStages{"friction",         "dynamic_friction", "slip_speed",
                                  "dilation",         "dilation_slip",    "cohesion",
                                  "residual_friction"};
/// Laws in rate form, whose stress stays what it is when their parameters change.
const Words lawsFreeInStages{"linear_elastic", "j2",         "drucker_prager",
                             "mohr_coulomb",   "hoek_brown", "ubiquitous_joints"};
const Words lawKeysFixedInStages{"model",      "set",         "density",     "joint_normal",
                                 "eos",        "sound_speed", "shock_slope", "grueneisen",
                                 "distension", "crush_start", "crush_end"};

bool mayChangeInStages(const std::string& path, const std::map<std::string, std::string>& before,
                       int stage)
{
  const Words words = wordsOf(path);
  const auto valueOf = [&](const std::string& of)
  {
    const auto found = before.find(of);
    return found == before.end() ? std::string() : found->second;
  };
  const std::string& section = words[0];
  if (has(freeInStages, section))
    return true;
  // A card that was not there would make others out of those behind it.
  if (has({"joints", "materials", "blocks"}, section) && words.size() > 1)
  {
    const std::string card = section + "." + words[1] + ".";
    const auto first = before.lower_bound(card);
    if (first == before.end() || first->first.rfind(card, 0) != 0)
      return false;
  }
  if (section == "time" && words.size() > 1)
    return has(timesFreeInStages, words[1]);
  if (section == "contact" && words.size() > 1)
    return words[1] == "damping";
  if (section == "joints" && words.size() > 2)
  {
    const std::string model = valueOf("joints." + words[1] + ".model");
    const bool bonded = model == "mortar" || model == "bilinear"; // their cohesion has softened
    return has(jointKeysFreeInStages, words[2]) && !(bonded && words[2] == "cohesion");
  }
  if (section == "materials" && words.size() > 2)
    return has(lawsFreeInStages, valueOf("materials." + words[1] + ".model")) &&
           !has(lawKeysFixedInStages, words[2]);
  if (section == "blocks" && words.size() > 2)
    return words[2] == "erosion";
  if (section == "stages" && words.size() > 2)
  {
    const int of = std::atoi(words[1].c_str());
    return of > stage || (of == stage && (words[2] == "until" || words[2] == "at_rest"));
  }
  return false;
}
} // namespace

bool isOfStages(const std::string& path)
{
  const Words words = wordsOf(path);
  if (words.size() < 2)
    return !words.empty() && has(freeInStages, words[0]);
  return has(freeInStages, words[0]) || words[0] == "joints" || words[0] == "materials" ||
         words[0] == "blocks" || (words[0] == "contact" && words[1] == "damping") ||
         (words[0] == "time" && has(timesFreeInStages, words[1]));
}

DeckChanges deckChanges(const std::string& before, const std::string& now, int stage)
{
  const auto old = valuesIn(before);
  DeckChanges changes;
  for (const DeckChange& change : changesBetween(old, valuesIn(now)))
    (mayChangeInStages(change.path, old, stage) ? changes.allowed : changes.refused)
        .push_back(change.text);
  return changes;
}

std::string whatStagesMayChange()
{
  return fmt::format(
      "Accepted: {}; time.{}; contact.damping; blocks.<name>.erosion; of joints {} (cohesion not "
      "of "
      "mortar and bilinear); of materials {} all numbers but density, normals and equations of "
      "state.",
      fmt::join(freeInStages, ", "), fmt::join(timesFreeInStages, ", time."),
      fmt::join(jointKeysFreeInStages, ", "), fmt::join(lawsFreeInStages, ", "));
}
} // namespace coplane
