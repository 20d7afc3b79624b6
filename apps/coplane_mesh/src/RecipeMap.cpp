#include "RecipeMap.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/FileRoles.hpp>
#include <coplane_schema/Suggestion.hpp>
#include <coplane_schema/YamlText.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

namespace coplane
{
namespace
{
std::string joined(const std::vector<std::string>& words)
{
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// A key of the map at `path`.
std::string wordOf(const YAML::Node& key, const std::string& file, const std::string& path)
{
  if (!key.IsScalar())
    fail(ExitCode::Deck, "{}: a key in {} is no word; accepted: a word, such as 'parts:'.",
         placeOf(file, key), path.empty() ? "the recipe" : path);
  return key.Scalar();
}
} // namespace

std::string textOfRecipe(const std::string& recipeFile, const std::string& help)
{
  if (const std::string kind = kindOfSpecialFile(recipeFile); !kind.empty())
    fail(ExitCode::Deck, "{}: this is {}; accepted: a recipe, which is a YAML file.", recipeFile,
         kind);
  std::ifstream file(recipeFile);
  std::stringstream text;
  const bool isOpen = file.is_open();
  if (isOpen && file.peek() != std::ifstream::traits_type::eof())
    text << file.rdbuf();
  if (!isOpen || file.bad() || !text)
    fail(ExitCode::Deck, "{}: the recipe cannot be read. Check its name; {} shows what it holds.",
         recipeFile, help);
  return text.str();
}

YAML::Node parseRecipe(const std::string& text, const std::string& name)
{
  demandPlainText(text, name);
  try
  {
    const YamlText yaml = readYaml(text);
    if (yaml.rest)
      fail(ExitCode::Deck,
           "{}:{}:{}: here something begins that does not belong to what is above; a recipe is one "
           "document. Remove the line '---', or mend the indentation.",
           name, yaml.rest->line + 1, yaml.rest->column + 1);
    return yaml.document;
  }
  catch (const YAML::ParserException& error)
  {
    fail(ExitCode::Deck, "{}:{}:{}: the recipe is not valid YAML: {}.", name, error.mark.line + 1,
         error.mark.column + 1, error.msg);
  }
}

std::string placeOf(const std::string& file, const YAML::Node& node)
{
  const YAML::Mark mark = node.Mark();
  return mark.is_null() ? file : fmt::format("{}:{}:{}", file, mark.line + 1, mark.column + 1);
}

RecipeMap::RecipeMap(YAML::Node node, std::string file, std::string path,
                     std::vector<std::string> accepted)
    : node_(std::move(node)), file_(std::move(file)), path_(std::move(path))
{
  const std::string name = path_.empty() ? "the recipe" : path_;
  if (!node_.IsMap())
    fail(ExitCode::Deck, "{}: {} must be a map with the keys {}.", placeOf(file_, node_), name,
         joined(accepted));
  std::set<std::string> seen;
  for (const auto& entry : node_)
  {
    const std::string key = wordOf(entry.first, file_, path_);
    if (std::find(accepted.begin(), accepted.end(), key) == accepted.end())
      fail(ExitCode::Deck, "{}: {} is not known; {} accepts {}.{}", placeOf(file_, entry.first),
           pathOf(key), name, joined(accepted), didYouMean(key, accepted));
    if (!seen.insert(key).second)
      fail(ExitCode::Deck, "{}: {} is given twice; keep one.", placeOf(file_, entry.first),
           pathOf(key));
  }
}

std::string RecipeMap::pathOf(const std::string& key) const
{
  return path_.empty() ? key : key.empty() ? path_ : path_ + "." + key;
}

void RecipeMap::refuse(const std::string& key, const std::string& text) const
{
  fail(ExitCode::Deck, "{}: {} {}", placeOf(file_, node_[key] ? node_[key] : node_), pathOf(key),
       text);
}

YAML::Node RecipeMap::required(const std::string& key) const
{
  if (!node_[key])
    refuse(key, "is missing.");
  return node_[key];
}

std::string RecipeMap::text(const std::string& key) const
{
  const YAML::Node value = required(key);
  if (!value.IsScalar() || value.Scalar().empty() || value.Scalar().find('\0') != std::string::npos)
    refuse(key, "must be a word.");
  return value.Scalar();
}

std::string RecipeMap::choice(const std::string& key, const std::vector<std::string>& words) const
{
  if (!has(key))
    return words.front();
  const std::string word = text(key);
  if (std::find(words.begin(), words.end(), word) == words.end())
    refuse(key, fmt::format("= '{}' is not known; use {}.{}", word, joined(words),
                            didYouMean(word, words)));
  return word;
}

template <class T>
std::vector<T> RecipeMap::sequence(const std::string& key, int size, const char* what) const
{
  const YAML::Node value = required(key);
  if (!value.IsSequence() || int(value.size()) != size)
    refuse(key, fmt::format("must be a list of {} {}.", size, what));
  std::vector<T> list;
  for (const YAML::Node& item : value)
  {
    T number{};
    if (!item.IsScalar() || !YAML::convert<T>::decode(item, number) || !std::isfinite(Real(number)))
      refuse(key, fmt::format("has the entry '{}'; it must be a list of {} {}.",
                              item.IsScalar() ? item.Scalar() : "...", size, what));
    list.push_back(number);
  }
  return list;
}

Real RecipeMap::number(const std::string& key) const
{
  const YAML::Node value = required(key);
  Real number = 0;
  if (!value.IsScalar() || !YAML::convert<Real>::decode(value, number) || !std::isfinite(number))
    refuse(key, fmt::format("= '{}' is not a number.", value.IsScalar() ? value.Scalar() : "..."));
  return number;
}

Real RecipeMap::positive(const std::string& key) const
{
  const Real value = number(key);
  if (!(value > 0))
    refuse(key, fmt::format("= {} m must be greater than 0.", value));
  return value;
}

int RecipeMap::count(const std::string& key, int least) const
{
  const YAML::Node value = required(key);
  int number = 0;
  if (!value.IsScalar() || !YAML::convert<int>::decode(value, number))
    refuse(key,
           fmt::format("= '{}' is not a whole number up to {}.",
                       value.IsScalar() ? value.Scalar() : "...", std::numeric_limits<int>::max()));
  if (number < least)
    refuse(key, fmt::format("= {} must be at least {}.", number, least));
  return number;
}

std::vector<Real> RecipeMap::numbers(const std::string& key, int size) const
{
  return sequence<Real>(key, size, "numbers");
}

std::vector<Real> RecipeMap::positives(const std::string& key, int size) const
{
  std::vector<Real> list = sequence<Real>(key, size, "lengths [m]");
  for (const Real value : list)
    if (!(value > 0))
      refuse(key, fmt::format("has the entry {} m; every length must be greater than 0.", value));
  return list;
}

std::vector<Real> RecipeMap::numbers(const std::string& key) const
{
  const YAML::Node value = required(key);
  if (!value.IsSequence())
    refuse(key, "must be a list of numbers.");
  return numbers(key, int(value.size()));
}

std::vector<Real> RecipeMap::ratios(const std::string& key, int size) const
{
  std::vector<Real> list = numbers(key, size);
  for (const Real value : list)
    if (!(value > 0))
      refuse(key, fmt::format("has the entry {}; every ratio must be greater than 0.", value));
  return list;
}

std::vector<int> RecipeMap::counts(const std::string& key, int size, int least) const
{
  std::vector<int> list = sequence<int>(key, size, "whole numbers");
  for (const int value : list)
    if (value < least)
      refuse(key, fmt::format("has the entry {}; every entry must be at least {}.", value, least));
  return list;
}

Vec3 RecipeMap::point(const std::string& key, int dimension) const
{
  const std::vector<Real> x = numbers(key, dimension);
  return {x[0], x[1], dimension == 3 ? x[2] : 0.0};
}

std::vector<Vec3> RecipeMap::points(const std::string& key, int size, int dimension) const
{
  const YAML::Node value = required(key);
  if (!value.IsSequence() || int(value.size()) != size)
    refuse(key, fmt::format("must be a list of {} points.", size));
  std::vector<Vec3> list;
  for (const YAML::Node& item : value)
  {
    Vec3 x{};
    bool good = item.IsSequence() && int(item.size()) == dimension;
    for (int axis = 0; good && axis < dimension; ++axis)
      good = item[axis].IsScalar() && YAML::convert<Real>::decode(item[axis], x[axis]) &&
             std::isfinite(x[axis]);
    if (!good)
      refuse(key, fmt::format("has as entry {} no point; a point is a list of {} numbers.",
                              list.size() + 1, dimension));
    list.push_back(x);
  }
  return list;
}

std::vector<Vec3> RecipeMap::points(const std::string& key, int dimension) const
{
  const YAML::Node value = required(key);
  if (!value.IsSequence() || value.size() < 3)
    refuse(key, "must be a list of three points or more.");
  return points(key, int(value.size()), dimension);
}

std::vector<std::string> RecipeMap::texts(const std::string& key) const
{
  const YAML::Node value = required(key);
  std::vector<std::string> words;
  if (value.IsScalar())
    words.push_back(value.Scalar());
  else if (value.IsSequence())
    for (const YAML::Node& item : value)
      if (item.IsScalar())
        words.push_back(item.Scalar());
  if (words.empty() || (value.IsSequence() && words.size() != value.size()))
    refuse(key, "must be a word or a list of words.");
  return words;
}

RecipeMap RecipeMap::map(const std::string& key, const std::vector<std::string>& accepted) const
{
  return RecipeMap(required(key), file_, pathOf(key), accepted);
}

std::vector<YAML::Node> RecipeMap::list(const std::string& key) const
{
  const YAML::Node value = required(key);
  if (!value.IsSequence() || value.size() == 0)
    refuse(key, "must be a list with at least one entry.");
  return {value.begin(), value.end()};
}

std::vector<std::pair<std::string, YAML::Node>> RecipeMap::entries(const std::string& key) const
{
  std::vector<std::pair<std::string, YAML::Node>> all;
  if (!has(key))
    return all;
  if (!node_[key].IsMap())
    refuse(key, "must be a map from names to selections.");
  std::set<std::string> seen;
  for (const auto& entry : node_[key])
  {
    const std::string name = wordOf(entry.first, file_, pathOf(key));
    if (!seen.insert(name).second)
      fail(ExitCode::Deck, "{}: {}.{} is given twice; keep one.", placeOf(file_, entry.first),
           pathOf(key), name);
    all.emplace_back(name, entry.second);
  }
  return all;
}
} // namespace coplane
