#include "SchemaReader.hpp"

#include "detail/ValueReader.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/Suggestion.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

namespace coplane
{
namespace
{
using Kind = DeckNode::Kind;

/// All places of the schema with a key of this name.
void collectPlaces(const Key& group, const std::string& path, const std::string& name,
                   std::vector<std::string>& places)
{
  for (const auto& key : group.keys)
  {
    const std::string here = path + (path.empty() ? "" : ".") + key.name;
    if (key.name == name && (places.empty() || places.back() != here))
      places.push_back(here);
    collectPlaces(key, key.kind == KeyKind::NamedGroups ? here + ".<name>" : here, name, places);
  }
}

class SchemaReader
{
public:
  SchemaReader(const Key& schema, const FileKind& file, Problems& problems)
      : schema_(schema), problems_(problems), reading_{file, problems, {}}
  {
  }

  /// The whole tree. Expressions of names in `define` have their values in it afterwards, and
  /// `define` is gone.
  void read(DeckNode& root, void* target)
  {
    const std::size_t before = problems_.size();
    const auto isDefine = [](const auto& entry) { return entry.first.text == "define"; };
    const bool mayDefine =
        std::any_of(schema_.keys.begin(), schema_.keys.end(),
                    [](const Key& key) { return key.kind == KeyKind::Definitions; });
    if (const DeckNode* define = root.find("define"); define && mayDefine)
    {
      reading_.checkNames(*define, "define");
      reading_.definitions.read(*define, problems_);
    }
    readGroup(schema_, root, "", target);
    if (!mayDefine)
      return;
    if (problems_.size() == before && !reading_.file.idleNames)
      reading_.definitions.demandUse(problems_);
    auto& entries = root.entries;
    entries.erase(std::remove_if(entries.begin(), entries.end(), isDefine), entries.end());
  }

private:
  void readGroup(const Key& group, DeckNode& node, const std::string& path, void* target)
  {
    if (!group.shortFor.empty() && node.kind != Kind::Map)
      return readShort(group, node, path, target);
    if (node.kind != Kind::Map)
      return reading_.wrong(node, path, "", acceptedText(group));
    const std::size_t before = problems_.size();
    const std::optional<std::string> model = modelOf(group, node);
    if (const DeckNode* place = model ? node.find(group.discriminator) : nullptr;
        place && group.problemOfModel)
      if (const std::string problem = group.problemOfModel(*model); !problem.empty())
        return problems_.add(*place,
                             fmt::format("{} {}", join(path, group.discriminator), problem));
    reading_.checkNames(node, path);
    for (const auto& [name, value] : node.entries)
      checkKnown(group, model, name, path);
    for (const auto& key : group.keys)
    {
      if (!key.models.empty() && !(model && key.appliesTo(*model)))
        continue;
      DeckNode* value = node.find(key.name);
      if (value && !key.noPlace.empty())
        problems_.add(*value, fmt::format("{} {}; remove it.", join(path, key.name), key.noPlace));
      else if (value)
        readKey(key, *value, join(path, key.name), target);
      else if (key.required && key.noPlace.empty())
        problems_.add(
            node, fmt::format("{} is missing{}; accepted: {}: {}.", join(path, key.name),
                              key.models.empty()
                                  ? ""
                                  : fmt::format(" ({}: {} needs it)", group.discriminator, *model),
                              acceptedText(key), key.meaning));
    }
    checkAlternatives(group, node, path);
    if (group.check && problems_.size() == before)
      group.check(target, {node, path, problems_});
  }

  /// A value in place of a group: that of one of its keys.
  void readShort(const Key& group, DeckNode& node, const std::string& path, void* target)
  {
    const std::size_t before = problems_.size();
    for (const auto& key : group.keys)
      if (key.name == group.shortFor)
        readKey(key, node, path, target);
    DeckNode map = node; // where a check finds it
    map.kind = Kind::Map;
    map.entries = {{node, node}};
    map.entries[0].first.text = group.shortFor;
    if (group.check && problems_.size() == before)
      group.check(target, {map, path, problems_});
  }

  /// The value that decides which keys there are; nothing when it is missing or wrong, which is
  /// reported where it is read.
  std::optional<std::string> modelOf(const Key& group, const DeckNode& node) const
  {
    if (group.discriminator.empty())
      return "";
    for (const auto& key : group.keys)
      if (key.name == group.discriminator)
      {
        const DeckNode* value = node.find(key.name);
        if (!value)
          return key.required ? std::nullopt : std::optional(key.defaultText);
        const auto& words = key.choices;
        if (std::find(words.begin(), words.end(), value->text) != words.end())
          return value->text;
      }
    return std::nullopt;
  }

  void checkKnown(const Key& group, const std::optional<std::string>& model, const DeckNode& name,
                  const std::string& path)
  {
    if (name.kind != Kind::Scalar || name.text == "<<")
      return;
    std::vector<std::string> names, owners;
    bool known = false, fits = false;
    for (const auto& key : group.keys)
    {
      const bool here = key.models.empty() || !model || key.appliesTo(*model);
      if (here && std::find(names.begin(), names.end(), key.name) == names.end())
        names.push_back(key.name);
      if (key.name != name.text)
        continue;
      known = true;
      fits = fits || here;
      owners.insert(owners.end(), key.models.begin(), key.models.end());
    }
    if (fits)
      return;
    if (known)
      return problems_.add(name,
                           fmt::format("{} belongs to {}: {}, but {} is {} here; remove it or "
                                       "change {}.{}",
                                       join(path, name.text), group.discriminator, listOf(owners),
                                       group.discriminator, *model, group.discriminator,
                                       adviceOnAbsent(group, name.text)));
    for (const RemovedKey& gone : group.removed)
      if (gone.name == name.text)
        return problems_.add(
            name, fmt::format("{} is no longer a key. {}", join(path, name.text), gone.instead));
    std::string hint = adviceOnAbsent(group, name.text);
    if (hint.empty())
      hint = hintOfName(group, name.text, names);
    if (hint.empty())
    {
      std::vector<std::string> places;
      collectPlaces(schema_, "", name.text, places);
      if (!places.empty())
        hint = fmt::format(" Its place is {}.", listOf(places));
    }
    problems_.add(name, fmt::format("{} is not known.{} Accepted here: {}.", join(path, name.text),
                                    hint, listOf(names)));
  }

  static std::string adviceOnAbsent(const Key& group, const std::string& name)
  {
    for (const AbsentKey& absent : group.absent)
      if (absent.name == name)
        return " " + absent.advice;
    return "";
  }

  /// The key that is meant: by its name in other programs, or by its letters.
  static std::string hintOfName(const Key& group, const std::string& name,
                                const std::vector<std::string>& names)
  {
    for (const Key& key : group.keys)
      for (const std::string& theirs : key.habits)
        if (editDistance(name, theirs) == 0 &&
            std::find(names.begin(), names.end(), key.name) != names.end())
          return fmt::format(" It is called '{}' here.", key.name);
    if (name.find_first_not_of("0123456789") == std::string::npos)
      return " If it stands after a decimal comma: numbers have a point, as 0.25.";
    return didYouMean(name, names);
  }

  void checkAlternatives(const Key& group, const DeckNode& node, const std::string& path)
  {
    for (const auto& alternatives : group.alternatives)
    {
      std::vector<std::string> given;
      for (const auto& name : alternatives.names)
        if (node.find(name))
          given.push_back(name);
      if (given.size() > 1)
        problems_.add(*node.find(given[1]),
                      fmt::format("{} and {} exclude each other; keep one of them.",
                                  join(path, given[0]), join(path, given[1])));
      if (given.empty() && alternatives.oneNeeded)
        problems_.add(
            node, fmt::format("{} needs one of the keys {}.", path, listOf(alternatives.names)));
    }
  }

  void readKey(const Key& key, DeckNode& node, const std::string& path, void* target)
  {
    switch (key.kind)
    {
    case KeyKind::Group:
      return readGroup(key, node, path, key.enter(target, "", node.where));
    case KeyKind::NamedGroups:
      return readNamedGroups(key, node, path, target);
    case KeyKind::GroupList:
      return readGroupList(key, node, path, target);
    case KeyKind::Definitions:
      return; // read before all others
    case KeyKind::Changes:
      if (node.kind != Kind::Map)
        return reading_.wrong(node, path, "", acceptedText(key));
      checkAllNames(node, path);
      return insertDefinitions(node);
    default:
      if (const auto value = readValue(reading_, key, node, path))
      {
        key.store(target, *value);
        const Key& own = key.ofModel ? key.ofModel(target) : key;
        if (const std::string odd = oddityOf(own, *value); !odd.empty())
          problems_.warn(node, fmt::format("{} = {}", path, odd));
      }
    }
  }

  /// Numbers in place of defined names, in every value of a tree.
  void insertDefinitions(DeckNode& node)
  {
    for (auto& [name, value] : node.entries)
      insertDefinitions(value);
    for (DeckNode& item : node.items)
      insertDefinitions(item);
    if (node.kind != Kind::Scalar || !reading_.definitions.appearIn(node.text))
      return;
    std::string problem;
    if (const auto value = reading_.definitions.value(node.text, problem))
    {
      node.text = fmt::format("{}", *value);
      node.quoted = false;
    }
    else
      node.text = reading_.definitions.insertedInto(node.text);
  }

  /// Of a map and of all maps in it.
  void checkAllNames(const DeckNode& node, const std::string& path)
  {
    if (node.kind == Kind::Map)
      reading_.checkNames(node, path);
    for (const auto& [name, value] : node.entries)
      checkAllNames(value, join(path, name.text));
    for (std::size_t i = 0; i < node.items.size(); ++i)
      checkAllNames(node.items[i], fmt::format("{}.{}", path, i));
  }

  void readNamedGroups(const Key& key, DeckNode& node, const std::string& path, void* target)
  {
    if (node.kind != Kind::Map || (key.required && node.entries.empty()))
      return reading_.wrong(node, path,
                            node.kind == Kind::List ? ": names are wanted, not items with '-'" : "",
                            acceptedText(key));
    reading_.checkNames(node, path);
    const bool mayBeEmpty = std::none_of(key.keys.begin(), key.keys.end(),
                                         [](const Key& inner) { return inner.required; });
    std::set<std::string> seen;
    for (auto& [name, value] : node.entries)
    {
      if (mayBeEmpty && value.kind == Kind::Nothing)
        value.kind = Kind::Map; // a name alone
      if (name.kind == Kind::Scalar && name.text != "<<" && seen.insert(name.text).second)
        readGroup(key, value, join(path, name.text), key.enter(target, name.text, name.where));
    }
  }

  void readGroupList(const Key& key, DeckNode& node, const std::string& path, void* target)
  {
    if (key.aloneToo && node.kind == Kind::Map)
      return readGroup(key, node, path, key.enter(target, "", node.where));
    if (node.kind != Kind::List || ((key.required || key.aloneToo) && node.items.empty()))
      return reading_.wrong(
          node, path, node.kind == Kind::Map ? ": items are wanted, each with '-' before it" : "",
          acceptedText(key));
    for (std::size_t i = 0; i < node.items.size(); ++i)
      readGroup(key, node.items[i], fmt::format("{}.{}", path, i),
                key.enter(target, "", node.items[i].where));
  }

  const Key& schema_;
  Problems& problems_;
  Reading reading_;
};

/// Refuses a file of another kind as a whole, by a key that only that kind has.
void demandKind(const Key& schema, const DeckNode& root, const std::string& file,
                const FileKind& kind)
{
  const auto has = [&](const std::string& name)
  {
    return std::any_of(schema.keys.begin(), schema.keys.end(),
                       [&](const Key& key) { return key.name == name; });
  };
  for (const Key& key : schema.keys)
    if (key.required && root.find(key.name))
      return;
  for (const auto& [name, what] : {std::pair("parts", "a recipe of a mesh, for coplane_mesh make"),
                                   std::pair("joint_paths", "a deck of coplane_point"),
                                   std::pair("material_paths", "a deck of coplane_point"),
                                   std::pair("time", "a deck of coplane")})
    if (root.find(name) && !has(name))
      fail(ExitCode::Deck,
           "{}: this is {}, with the key '{}'; accepted for {}: keys that {} lists.", file, what,
           name, kind.name, kind.help);
}
} // namespace

DeckNode readBySchema(const Key& schema, const std::string& text, const std::string& file,
                      const std::vector<std::string>& overrides, void* target, Problems& problems,
                      const std::function<void(DeckNode&)>& prepare, const FileKind& kind)
{
  DeckNode root = parseYaml(text, file, kind);
  demandKind(schema, root, file, kind);
  for (std::size_t i = 0; i < overrides.size(); ++i)
    applyOverride(root, overrides[i], static_cast<int>(i), problems);
  if (prepare)
    prepare(root);
  SchemaReader(schema, kind, problems).read(root, target);
  return root;
}
} // namespace coplane
