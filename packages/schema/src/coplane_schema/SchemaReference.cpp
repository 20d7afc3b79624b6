#include "SchemaReference.hpp"

#include "detail/ReferenceText.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>

namespace coplane
{
namespace
{
using Json = nlohmann::ordered_json;

std::string cell(std::string text)
{
  for (std::size_t at = 0; (at = text.find_first_of("|<>*", at)) != std::string::npos; at += 2)
    text.insert(at, "\\");
  return text;
}

void writeMarkdown(const Key& group, const std::string& path, std::string& out)
{
  std::string rows;
  for (const auto& key : group.keys)
  {
    const std::string condition = conditionText(group, key);
    const std::string limit = condition.empty() ? "" : " (" + condition + ")";
    if (!key.isGroup())
      rows += fmt::format(
          "| `{}`{} | {} | {} | {} | `{}` |\n", key.name, limit, cell(acceptedText(key)),
          key.required ? "required" : cell(key.defaultText), cell(key.meaning), key.example);
  }
  if (!rows.empty())
    out +=
        "| Key | Accepted | Default | Meaning | Example |\n|---|---|---|---|---|\n" + rows + "\n";
  for (const auto& key : group.keys)
    if (key.isGroup())
    {
      const std::string here = pathOf(path, key);
      std::string meaning = key.meaning;
      meaning[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(meaning[0])));
      const std::string rules = alternativesText(key);
      out += fmt::format("## `{}`\n\n{}{}.{}\n\n", here, cell(meaning),
                         key.required ? " (required)" : "", rules.empty() ? "" : " " + rules);
      writeMarkdown(key, here, out);
    }
}

/// A number, or an expression of names in `define`, which has a letter.
Json numberSchema(const Key& key, const char* type)
{
  Json schema{{"type", {type, "string"}}, {"pattern", "[A-Za-z_]"}};
  if (key.lower)
    schema[key.lowerOpen ? "exclusiveMinimum" : "minimum"] = *key.lower;
  if (key.upper)
    schema[key.upperOpen ? "exclusiveMaximum" : "maximum"] = *key.upper;
  return schema;
}

Json listSchema(const Key& key, const Json& item)
{
  Json schema{{"type", "array"}, {"items", item}};
  if (key.leastLength)
    schema["minItems"] = key.leastLength;
  if (key.length || (key.byDimension && key.kind != KeyKind::Points))
  {
    schema["minItems"] = key.length ? key.length : 2;
    schema["maxItems"] = key.length ? key.length : 3;
  }
  if (!key.choices.empty())
  {
    schema["minItems"] = 1;
    schema["uniqueItems"] = true;
  }
  return key.aloneToo ? Json{{"anyOf", {item, schema}}} : schema;
}

/// A list of lists.
Json listsSchema(const Key& key, KeyKind kind, const Json& word)
{
  Key item = key;
  item.kind = kind;
  item.length = key.itemLength;
  item.leastLength = 0;
  item.choices.clear();
  Key list = item;
  list.kind = key.kind;
  list.length = key.length;
  list.leastLength = key.leastLength;
  const Json lists = listSchema(list, listSchema(item, word));
  return key.choices.empty() ? lists : Json{{"anyOf", {{{"enum", key.choices}}, lists}}};
}

/// The words of a choice; YAML reads some as numbers.
Json wordsSchema(const std::vector<std::string>& choices)
{
  Json words = choices;
  for (const std::string& word : choices)
    if (const Json number = Json::parse(word, nullptr, false); number.is_number())
      words.push_back(number);
  return Json{{"enum", words}};
}

Json groupSchema(const Key& group);
Json valueSchema(const Key& key);

/// A group, or the value of the key that it is short for.
Json shortSchema(const Key& group)
{
  Json accepted = Json::array({groupSchema(group)});
  for (const Key& key : group.keys)
    if (key.name == group.shortFor)
      accepted.push_back(valueSchema(key));
  return Json{{"anyOf", accepted}};
}

/// A number or an expression, or a table.
Json timeFunctionSchema()
{
  const Json numbers{{"type", "array"}, {"items", numberSchema(Key(), "number")}, {"minItems", 2}};
  return Json{
      {"anyOf",
       {{{"type", {"number", "string"}}},
        {{"type", "object"},
         {"properties",
          {{"times", numbers}, {"values", numbers}, {"scale", numberSchema(Key(), "number")}}},
         {"required", {"times", "values"}},
         {"additionalProperties", false}}}}};
}

/// A key with groups of keys.
Json groupsSchema(const Key& key)
{
  if (key.kind == KeyKind::Group)
    return key.shortFor.empty() ? groupSchema(key) : shortSchema(key);
  const Json item = groupSchema(key);
  if (key.kind == KeyKind::NamedGroups)
  {
    Json schema{{"type", "object"}, {"additionalProperties", item}};
    if (key.required)
      schema["minProperties"] = 1;
    return schema;
  }
  Json items{{"type", "array"}, {"items", item}};
  if (key.required)
    items["minItems"] = 1;
  return key.aloneToo ? Json{{"anyOf", {item, items}}} : items;
}

Json valueSchema(const Key& key)
{
  const Json word =
      key.choices.empty() ? Json{{"type", "string"}, {"minLength", 1}} : wordsSchema(key.choices);
  switch (key.kind)
  {
  case KeyKind::Text:
    // YAML reads a title such as 2024 as a number; the program takes it as text.
    return key.choices.empty() ? Json{{"type", {"string", "number", "boolean"}}} : word;
  case KeyKind::Number:
    return numberSchema(key, "number");
  case KeyKind::Integer:
    return key.choices.empty() ? numberSchema(key, "integer")
                               : Json{{"anyOf", {numberSchema(key, "integer"), word}}};
  case KeyKind::Flag:
    return Json{{"type", "boolean"}};
  case KeyKind::Numbers:
    return listSchema(key, numberSchema(key, "number"));
  case KeyKind::Integers:
    return listSchema(key, numberSchema(key, "integer"));
  case KeyKind::Points:
    return listsSchema(key, KeyKind::Numbers, numberSchema(key, "number"));
  case KeyKind::Texts:
    return listSchema(key, word);
  case KeyKind::TextLists:
    return listsSchema(key, KeyKind::Texts, Json{{"type", "string"}, {"minLength", 1}});
  case KeyKind::TimeFunction:
    return timeFunctionSchema();
  case KeyKind::TimeFunctions:
    return listSchema(key, timeFunctionSchema());
  case KeyKind::PlaceFunctions:
    return listSchema(key, Json{{"type", {"number", "string"}}});
  case KeyKind::Definitions:
    return Json{{"type", "object"},
                {"propertyNames", {{"pattern", "^[A-Za-z_][A-Za-z0-9_]*$"}}},
                {"additionalProperties", {{"type", {"number", "string"}}}}};
  case KeyKind::Changes:
    return Json{{"type", "object"}};
  default:
    return groupsSchema(key);
  }
}

Json described(const Key& key)
{
  Json schema = valueSchema(key);
  schema["description"] =
      key.isGroup() ? key.meaning
                    : fmt::format("{}: {}; {}", key.meaning, acceptedText(key), necessity(key));
  return schema;
}

/// Demands keys; where another key completes the group, only without that one.
Json demanding(const Key& group, const Json& required)
{
  const Json demand{{"required", required}};
  if (group.completedBy.empty())
    return demand;
  return Json{{"anyOf", {demand, {{"required", Json::array({group.completedBy})}}}}};
}

/// What holds for one value of the discriminator: the keys of that model, and none of the others.
Json modelSchema(const Key& group, const Key& discriminator, const std::string& model)
{
  Json properties = Json::object(), required = Json::array();
  for (const auto& key : group.keys)
  {
    if (key.models.empty())
      continue;
    if (key.appliesTo(model))
    {
      properties[key.name] = described(key);
      if (key.required && !key.dimension)
        required.push_back(key.name);
    }
    else if (!properties.contains(key.name))
      properties[key.name] = false;
  }
  Json condition{{"properties", {{discriminator.name, {{"const", model}}}}}};
  if (discriminator.defaultText != model) // without the key, the default's keys hold
    condition["required"] = Json::array({discriminator.name});
  Json then{{"properties", properties}};
  then.update(demanding(group, required));
  return Json{{"if", condition}, {"then", then}};
}

Json groupSchema(const Key& group)
{
  Json schema{{"type", "object"}, {"additionalProperties", false}};
  Json properties = Json::object(), required = Json::array(), rules = Json::array();
  for (const auto& key : group.keys)
  {
    properties[key.name] = key.models.empty() ? described(key) : Json::object();
    if (key.required && key.models.empty() && !key.dimension)
      required.push_back(key.name);
    if (key.name == group.discriminator)
      for (const auto& model : key.choices)
        rules.push_back(modelSchema(group, key, model));
  }
  for (const auto& alternatives : group.alternatives)
  {
    rules.push_back({{"not", {{"required", alternatives.names}}}});
    Json one = Json::array();
    for (const auto& name : alternatives.names)
      one.push_back({{"required", Json::array({name})}});
    if (alternatives.oneNeeded)
      rules.push_back({{"anyOf", one}});
  }
  schema["properties"] = properties;
  schema.update(demanding(group, required));
  if (!rules.empty())
    schema["allOf"] = rules;
  return schema;
}
} // namespace

std::string referenceText(const Key& schema)
{
  std::string out;
  for (const Key& key : schema.keys)
    writeText(schema, key, "", out);
  return out;
}

std::string referenceMarkdown(const Key& schema)
{
  std::string out;
  writeMarkdown(schema, "", out);
  out.pop_back(); // one newline at the end
  return out;
}

std::string jsonSchema(const Key& schema, const std::string& title)
{
  Json json{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}};
  json.update(groupSchema(schema));
  return json.dump(2) + "\n";
}
} // namespace coplane
