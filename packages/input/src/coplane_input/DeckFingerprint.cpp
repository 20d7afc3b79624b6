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

void collect(const DeckNode& node, const std::string& path, std::vector<std::string>& lines)
{
  if (isFree(path))
    return;
  const std::string prefix = path.empty() ? "" : path + ".";
  switch (node.kind)
  {
  case DeckNode::Kind::Map:
    for (const auto& [key, value] : node.entries)
      collect(value, prefix + key.text, lines);
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

std::vector<std::string> deckDifferences(const std::string& before, const std::string& now,
                                         std::size_t most)
{
  const auto old = valuesIn(before), present = valuesIn(now);
  std::vector<std::string> texts;
  for (const auto& [path, value] : old)
  {
    const auto found = present.find(path);
    if (found == present.end())
      texts.push_back(fmt::format("{} was {} and is not there now", path, value));
    else if (found->second != value)
      texts.push_back(fmt::format("{} was {} and is {} now", path, value, found->second));
  }
  for (const auto& [path, value] : present)
    if (old.find(path) == old.end())
      texts.push_back(fmt::format("{} is {} now and was not there", path, value));
  if (texts.size() > most)
  {
    const std::size_t rest = texts.size() - most;
    texts.resize(most);
    texts.push_back(fmt::format("{} more", rest));
  }
  return texts;
}
} // namespace coplane
