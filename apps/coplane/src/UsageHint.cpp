#include "UsageHint.hpp"

#include <coplane_core/Suggestion.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace coplane
{
namespace
{
bool isOneOf(const std::string& word, const std::vector<std::string>& words)
{
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool isDeck(const std::string& word)
{
  const std::size_t dot = word.rfind('.');
  return dot != std::string::npos && isOneOf(word.substr(dot), {".yaml", ".yml"});
}

std::vector<std::string> optionsOf(const CLI::App& app)
{
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames())
      names.push_back("--" + name);
  return names;
}
} // namespace

std::string usageHint(const std::vector<std::string>& arguments, const CLI::App& app)
{
  const std::vector<std::string> options = optionsOf(app);
  for (std::size_t i = 0; i < arguments.size(); ++i)
  {
    const std::string& word = arguments[i];
    const std::string next = i + 1 < arguments.size() ? arguments[i + 1] : "";
    if (isOneOf(word, {"-n", "-np", "--np", "--ranks"}))
      return "The number of ranks belongs to mpirun: mpirun -np 2 coplane run.yaml\n";
    if (isOneOf(word, {"-i", "-input", "--input", "-f", "--file", "-j", "-job", "--deck"}))
      return "The deck stands without an option: coplane run.yaml\n";
    if (word == "--set" && next.find('=') == std::string::npos)
      return fmt::format("--set takes one word, path=value: --set {}=...\n", next);
    if (word == "--restart" && isDeck(next))
      return fmt::format("--restart has taken '{0}' for a checkpoint: coplane {0} --restart\n",
                         next);
    const std::string name = word.substr(0, word.find('='));
    if (word.rfind("--", 0) == 0 && !isOneOf(name, options))
      if (const std::string similar = nearest(name, options); !similar.empty())
        return fmt::format("Did you mean {}?\n", similar);
  }
  return "";
}
} // namespace coplane
