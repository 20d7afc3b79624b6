#include "DeckNode.hpp"

#include "detail/YamlFault.hpp"
#include "detail/YamlText.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/FileRoles.hpp>
#include <coplane_core/MissingFile.hpp>
#include <coplane_core/Suggestion.hpp>
#include <coplane_core/Text.hpp>

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <system_error>

namespace coplane
{
namespace
{
/// Where the nodes of one text stand: in the deck, or in the value of a --set.
struct Source
{
  std::string file;           // of the deck
  std::string set;            // the whole --set, or empty
  int number = 0;             // of the --set
  std::size_t most = 1000000; // values that may be copied: more are repetitions by aliases
  std::size_t nodes = 0;      // copied so far
  std::string where(const YAML::Mark& mark) const
  {
    return set.empty() ? fmt::format("{}:{}:{}", file, mark.line + 1, mark.column + 1) : set;
  }
  long order(const YAML::Mark& mark) const
  {
    constexpr long lineLength = 1000000;
    return set.empty() ? mark.line * lineLength + mark.column
                       : std::numeric_limits<long>::max() / 2 + number;
  }
};

DeckNode copyNode(const YAML::Node& node, Source& source, int depth)
{
  // An alias can contain itself, or double at each of many levels.
  if (depth > 50 || ++source.nodes > source.most)
    fail(ExitCode::Deck,
         "{}: this part of the file is nested too deeply or too large, as aliases (*name) that "
         "contain themselves make it; accepted: 50 levels and a million values more than are "
         "written. Write the values out.",
         source.where(node.Mark()));
  DeckNode copy;
  copy.where = source.where(node.Mark());
  copy.order = source.order(node.Mark());
  copy.flow = node.Style() == YAML::EmitterStyle::Flow;
  if (node.IsScalar())
  {
    copy.kind = DeckNode::Kind::Scalar;
    copy.text = node.Scalar();
    if (copy.text.find('\0') != std::string::npos)
      fail(ExitCode::Deck, "{}: a value with a zero byte (\\0); accepted: text without.",
           copy.where);
    copy.quoted = node.Tag() == "!"; // yaml-cpp's mark of every scalar that is not plain
  }
  else if (node.IsSequence())
  {
    copy.kind = DeckNode::Kind::List;
    for (const auto& item : node)
      copy.items.push_back(copyNode(item, source, depth + 1));
  }
  else if (node.IsMap())
  {
    copy.kind = DeckNode::Kind::Map;
    for (const auto& entry : node)
      copy.entries.emplace_back(copyNode(entry.first, source, depth + 1),
                                copyNode(entry.second, source, depth + 1));
  }
  return copy;
}

void emit(YAML::Emitter& out, const DeckNode& node)
{
  switch (node.kind)
  {
  case DeckNode::Kind::Nothing:
    out << YAML::Null;
    break;
  case DeckNode::Kind::Scalar:
    if (node.quoted)
      out << YAML::DoubleQuoted;
    out << node.text;
    break;
  case DeckNode::Kind::List:
    out << (node.flow ? YAML::Flow : YAML::Block) << YAML::BeginSeq;
    for (const auto& item : node.items)
      emit(out, item);
    out << YAML::EndSeq;
    break;
  case DeckNode::Kind::Map:
    out << (node.flow ? YAML::Flow : YAML::Block) << YAML::BeginMap;
    for (const auto& [key, value] : node.entries)
    {
      out << YAML::Key;
      emit(out, key);
      out << YAML::Value;
      emit(out, value);
    }
    out << YAML::EndMap;
    break;
  }
}

std::optional<std::size_t> listIndex(const std::string& word)
{
  if (word.empty() || word.size() > 9 || word.find_first_not_of("0123456789") != std::string::npos)
    return std::nullopt;
  return std::stoul(word);
}

DeckNode mapAt(const DeckNode& place)
{
  DeckNode map;
  map.kind = DeckNode::Kind::Map;
  map.where = place.where;
  map.order = place.order;
  return map;
}

/// One step of a path from a map, which may be made for it: the value of a key, new if it is not
/// there. `word` grows to a name with dots that fits further.
DeckNode* valueInMap(DeckNode& map, const std::string& rest, std::string& word,
                     const DeckNode& place)
{
  for (const auto& [key, ignored] : map.entries)
    if (key.text.size() > word.size() && rest.rfind(key.text, 0) == 0 &&
        (rest.size() == key.text.size() || rest[key.text.size()] == '.'))
      word = key.text;
  if (map.kind == DeckNode::Kind::Nothing)
    map = mapAt(place);
  if (!map.find(word))
  {
    DeckNode key;
    key.kind = DeckNode::Kind::Scalar;
    key.text = word;
    key.where = place.where;
    key.order = place.order;
    map.entries.emplace_back(key, DeckNode{});
  }
  return map.find(word);
}

/// The value at a path, the map or list that has it, and its name there.
struct Found
{
  DeckNode* node = nullptr; ///< nullptr and a problem: it cannot be
  DeckNode* parent = nullptr;
  std::string key;
};

/// The value at a path "a.b.0.c", new if it is not there.
/// @param listsGrow the item after the last one of a list is new, too, and a list by its first item
Found nodeOfPath(DeckNode& root, const std::string& path, const DeckNode& place, Problems& problems,
                 bool listsGrow = false)
{
  DeckNode *node = &root, *parent = nullptr;
  std::string done, word;
  for (std::string rest = path; !rest.empty();)
  {
    word = rest.substr(0, rest.find('.'));
    parent = node;
    if (listsGrow && node->kind == DeckNode::Kind::Nothing && word == "0")
    {
      node->kind = DeckNode::Kind::List;
      node->where = place.where;
      node->order = place.order;
    }
    if (node->kind == DeckNode::Kind::List)
    {
      const auto index = listIndex(word);
      if (listsGrow && index && *index == node->items.size())
        node->items.emplace_back();
      if (!index || *index >= node->items.size())
      {
        problems.add(place, fmt::format("'{}' is no item of {}, which has {}; accepted: a whole "
                                        "number, the first item is 0.",
                                        shortened(word), done, node->items.size()));
        return {};
      }
      node = &node->items[*index];
    }
    else if (node->kind == DeckNode::Kind::Scalar)
    {
      problems.add(place, fmt::format("{} is the value '{}' and has no key '{}'.", done,
                                      shortened(node->text), shortened(word)));
      return {};
    }
    else
      node = valueInMap(*node, rest, word, place);
    done += (done.empty() ? "" : ".") + word;
    rest = rest.size() > word.size() ? rest.substr(word.size() + 1) : "";
  }
  return {node, parent, word};
}
} // namespace

namespace
{
/// For trees that are const and for those that are not.
template <class Entries>
auto valueOf(Entries& entries, const std::string& key) -> decltype(&entries.front().second)
{
  for (auto& entry : entries)
    if (entry.first.text == key)
      return &entry.second;
  return nullptr;
}
} // namespace

const DeckNode* DeckNode::find(const std::string& key) const
{
  return valueOf(entries, key);
}

DeckNode* DeckNode::find(const std::string& key)
{
  return valueOf(entries, key);
}

const DeckNode& nodeAt(const DeckNode& root, const std::vector<std::string>& path)
{
  const DeckNode* node = &root;
  for (const auto& word : path)
  {
    const DeckNode* next = node->find(word);
    if (const auto index = listIndex(word);
        node->kind == DeckNode::Kind::List && index && *index < node->items.size())
      next = &node->items[*index];
    if (!next)
      break;
    node = next;
  }
  return *node;
}

namespace
{
/// A quoted word may hold line ends; a problem is one line.
std::pair<long, std::string> lineOf(const DeckNode& at, const std::string& text)
{
  std::string line = fmt::format("{}: {}", at.where, text);
  for (std::size_t end = 0; (end = line.find('\n', end)) != std::string::npos;)
    line.replace(end, 1, "\\n");
  return {at.order, line};
}

std::vector<std::string> inOrder(std::vector<std::pair<long, std::string>> lines)
{
  std::stable_sort(lines.begin(), lines.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> texts;
  for (const auto& line : lines)
    texts.push_back(line.second);
  return texts;
}
} // namespace

void Problems::add(const DeckNode& at, const std::string& text)
{
  problems_.push_back(lineOf(at, text));
}

void Problems::warn(const DeckNode& at, const std::string& text)
{
  warnings_.push_back(lineOf(at, text));
}

std::string Problems::text() const
{
  return fmt::format("{}", fmt::join(inOrder(problems_), "\n"));
}

std::vector<std::string> Problems::warnings() const
{
  return inOrder(warnings_);
}

void CardPlace::problem(const std::string& key, const std::string& text) const
{
  const DeckNode* const given = node.find(key);
  problems.add(given ? *given : node, path + "." + key + " " + text);
}

std::string readTextFile(const std::string& file, const FileKind& kind)
{
  if (const std::string special = kindOfSpecialFile(file); !special.empty())
    fail(ExitCode::Deck, "{}: this is {}; accepted for {}: a YAML file.", file, special, kind.name);
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!stream || !(text << stream.rdbuf() || stream.peek() == EOF))
    fail(ExitCode::Deck, "{}: {} cannot be read ({}). Check the path and its permissions.{}", file,
         kind.name, std::generic_category().message(errno),
         errno == ENOENT ? hintOfMissingFile(file) : "");
  return text.str();
}

DeckNode parseYaml(const std::string& text, const std::string& file, const FileKind& kind)
{
  if (const std::string foreign = foreignKindOf(text); !foreign.empty())
    fail(ExitCode::Deck,
         "{}: this is {}; accepted for {}: a YAML file, with keys such as '{}'. {} "
         "lists them.",
         file, foreign, kind.name, kind.example, kind.help);
  demandPlainText(text, file);
  Source source;
  source.file = file;
  source.most += text.size(); // every value that is written has a character
  const auto refuse = [&](const YamlFault& fault)
  { fail(ExitCode::Deck, "{}:{}:{}: {}", file, fault.line + 1, fault.column + 1, fault.text); };
  YamlText yaml;
  try
  {
    yaml = readYaml(text);
  }
  catch (const YAML::Exception& e)
  {
    refuse(faultOf(text, e));
  }
  if (const auto quote = openQuoteOf(text))
    refuse(*quote);
  if (yaml.rest)
    fail(ExitCode::Deck,
         "{}: here something begins that does not belong to what is above; a file is one document. "
         "Remove the line '---', or mend the indentation.",
         source.where(*yaml.rest));
  if (yaml.document.IsNull())
    fail(ExitCode::Deck, "{}: {} is empty; {} lists the keys that it needs.", file, kind.name,
         kind.help);
  DeckNode root = copyNode(yaml.document, source, 0);
  if (root.kind != DeckNode::Kind::Map)
    fail(ExitCode::Deck, "{}: {} is {}; accepted: keys with values, such as '{}'. See {}.",
         root.where, kind.name, root.kind == DeckNode::Kind::List ? "a list" : "a single value",
         kind.example, kind.help);
  return root;
}

void applyOverride(DeckNode& root, const std::string& assignment, int number, Problems& problems)
{
  Source source;
  source.set = "--set " + shortened(assignment);
  source.number = number;
  DeckNode place; // only where a message stands
  place.where = source.set;
  place.order = source.order(YAML::Mark());

  if (!isUtf8(assignment))
    return problems.add(place, "is not UTF-8, perhaps Latin-1; accepted: UTF-8.");
  const auto equals = assignment.find('=');
  const std::string path = assignment.substr(0, equals);
  if (equals == std::string::npos || path.empty() || path.front() == '.' || path.back() == '.' ||
      path.find("..") != std::string::npos)
    return problems.add(place, "is not an assignment; accepted: path=value, such as time.end=0.1 "
                               "or conditions.0.value=[1, 0, 0].");
  DeckNode value;
  try
  {
    const YamlText yaml = readYaml(assignment.substr(equals + 1));
    if (yaml.rest)
      return problems.add(place, "the value is followed by something that does not belong to it; "
                                 "accepted: one number, word, list or map.");
    value = copyNode(yaml.document, source, 0);
  }
  catch (const YAML::Exception& e)
  {
    return problems.add(place, fmt::format("the value is not YAML: {}.", e.msg));
  }
  if (DeckNode* const node = nodeOfPath(root, path, place, problems).node)
    *node = value;
}

void applyChange(DeckNode& root, const DeckNode& path, const DeckNode& value, Problems& problems)
{
  const Found found = nodeOfPath(root, path.text, path, problems, true);
  if (!found.node)
    return;
  *found.node = value;
  if (value.kind != DeckNode::Kind::Nothing || !found.parent)
    return;
  auto& entries = found.parent->entries;
  const std::string& key = found.key;
  entries.erase(std::remove_if(entries.begin(), entries.end(),
                               [&](const auto& entry) { return entry.first.text == key; }),
                entries.end());
}

std::string toYaml(const DeckNode& root)
{
  YAML::Emitter out;
  emit(out, root);
  return std::string(out.c_str()) + "\n";
}
} // namespace coplane
