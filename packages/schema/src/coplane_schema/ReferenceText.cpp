#include "detail/ReferenceText.hpp"

#include <fmt/format.h>

namespace coplane
{
std::string pathOf(const std::string& path, const Key& key)
{
  std::string here = path + (path.empty() ? "" : ".") + key.name;
  if (key.kind == KeyKind::NamedGroups)
    here += ".<name>";
  if (key.kind == KeyKind::GroupList)
    here += ".<index>";
  return here;
}

std::string conditionText(const Key& group, const Key& key)
{
  std::string text = key.models.empty()
                         ? ""
                         : fmt::format("{}: {}", group.discriminator, fmt::join(key.models, ", "));
  if (key.dimension)
    text += fmt::format("{}{}D", text.empty() ? "" : "; ", key.dimension);
  return text;
}

std::string alternativesText(const Key& group)
{
  std::string text;
  for (const auto& one : group.alternatives)
    text += fmt::format("{} one of {}.", one.oneNeeded ? "Exactly" : "At most",
                        fmt::join(one.names, ", "));
  if (!group.shortFor.empty())
    text += fmt::format("{}A value without keys is that of {}.", text.empty() ? "" : " ",
                        group.shortFor);
  if (group.aloneToo)
    text += fmt::format("{}One item may stand without the list.", text.empty() ? "" : " ");
  return text;
}

std::string necessity(const Key& key)
{
  if (key.required)
    return "required";
  return key.defaultText.empty() ? "optional" : "default: " + key.defaultText;
}

void writeText(const Key& group, const Key& key, const std::string& path, std::string& out)
{
  const std::string here = pathOf(path, key);
  const std::string condition = conditionText(group, key);
  out += fmt::format("{}{}\n", here, condition.empty() ? "" : "   (" + condition + ")");
  if (!key.isGroup())
  {
    out += fmt::format("    {}; {}\n    {}. Example: {}\n\n", acceptedText(key), necessity(key),
                       key.meaning, key.example);
    return;
  }
  const std::string rules = alternativesText(key);
  out += fmt::format("    {}{}{}\n\n", key.meaning, key.required ? "; required" : "",
                     rules.empty() ? "" : ". " + rules);
  for (const Key& inner : key.keys)
    writeText(key, inner, here, out);
}
} // namespace coplane
