#pragma once

#include <yaml-cpp/yaml.h>

#include <optional>
#include <string>

namespace coplane
{
/// Refuses text with control characters other than tabs and ends of lines: no editor writes them,
/// and the YAML library (0.7) never comes back from some. Exit code Deck.
void demandPlainText(const std::string& text, const std::string& file);

/// What a text of YAML holds.
struct YamlText
{
  YAML::Node document;            ///< the first one, null if there is none
  std::optional<YAML::Mark> rest; ///< where something follows that does not belong to it
};

/// Reads the first document. What follows may be a second one after '---', or a piece that a wrong
/// indentation has cut off; YAML::Load would pass over it in silence, and YAML::LoadAll of 0.7
/// makes documents of some such pieces until the memory is full.
/// @throws YAML::Exception
YamlText readYaml(const std::string& text);
} // namespace coplane
