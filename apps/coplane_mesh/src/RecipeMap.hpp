#pragma once

#include <coplane_core/Error.hpp>
#include <coplane_core/Vec3.hpp>

#include <yaml-cpp/yaml.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace coplane
{
/// One map of a recipe, read strictly: keys outside the accepted ones, keys given twice and values
/// of the wrong kind are errors with file, line and column (Error of ExitCode::Deck).
class RecipeMap
{
public:
  /// `path` is the way to this map for messages: "parts[1]". Refuses keys that are not in
  /// `accepted`.
  RecipeMap(YAML::Node node, std::string file, std::string path, std::vector<std::string> accepted);

  bool has(const std::string& key) const { return bool(node_[key]); }
  std::string text(const std::string& key) const;
  /// One of the given words; the first when the key is not there.
  std::string choice(const std::string& key, const std::vector<std::string>& words) const;
  Real number(const std::string& key) const;
  Real positive(const std::string& key) const; ///< a length [m]
  int count(const std::string& key, int least = 1) const;
  std::vector<Real> numbers(const std::string& key, int size) const;
  std::vector<Real> numbers(const std::string& key) const;          ///< any number of them
  std::vector<Real> ratios(const std::string& key, int size) const; ///< greater than 0 [-]
  std::vector<Real> positives(const std::string& key, int size) const;
  std::vector<int> counts(const std::string& key, int size, int least = 1) const;
  /// A point of `dimension` coordinates; z = 0 in two.
  Vec3 point(const std::string& key, int dimension) const;
  /// A list of `size` such points, or of three and more.
  std::vector<Vec3> points(const std::string& key, int size, int dimension) const;
  std::vector<Vec3> points(const std::string& key, int dimension) const;
  /// A word, or a list of words.
  std::vector<std::string> texts(const std::string& key) const;

  RecipeMap map(const std::string& key, const std::vector<std::string>& accepted) const;
  /// The maps of a list.
  std::vector<YAML::Node> list(const std::string& key) const;
  /// Keys of a map with free keys, in the order of the file.
  std::vector<std::pair<std::string, YAML::Node>> entries(const std::string& key) const;
  YAML::Node node(const std::string& key) const { return node_[key]; }
  const std::string& file() const { return file_; }
  std::string pathOf(const std::string& key) const;

  /// Error at a key (or at the map, when it is absent or empty): "file:line:column: path.key
  /// <text>".
  [[noreturn]] void refuse(const std::string& key, const std::string& text) const;

private:
  YAML::Node required(const std::string& key) const;
  template <class T>
  std::vector<T> sequence(const std::string& key, int size, const char* what) const;

  YAML::Node node_;
  std::string file_, path_;
};

/// Errors of several parts and sets of one recipe, to be told together.
class RecipeProblems
{
public:
  /// Does something; an Error of ExitCode::Deck is kept for later.
  template <class F>
  void collect(const F& action)
  {
    try
    {
      action();
    }
    catch (const Error& error)
    {
      if (error.code() != ExitCode::Deck)
        throw;
      text_ += (text_.empty() ? "" : "\n") + std::string(error.what());
    }
  }
  /// Throws what was kept.
  void tell() const
  {
    if (!text_.empty())
      throw Error(ExitCode::Deck, text_);
  }

private:
  std::string text_;
};

/// The text of a file, or an Error(ExitCode::Deck) that says where its keys are explained.
std::string textOfRecipe(const std::string& file, const std::string& help);
/// The root of a YAML text; `name` stands for the file in messages.
YAML::Node parseRecipe(const std::string& text, const std::string& name);

/// "file:line:column", counted from 1.
std::string placeOf(const std::string& file, const YAML::Node& node);
} // namespace coplane
