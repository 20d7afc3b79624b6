#pragma once

#include <optional>
#include <string>

namespace YAML
{
class Exception;
}

namespace coplane
{
/// What is wrong with a text, where it has to be mended.
struct YamlFault
{
  int line = 0, column = 0; ///< from 0
  std::string text;         ///< whole sentences
};

/// Of a text that could not be read: what most likely led to the library's error, which often comes
/// lines later: a tab, a bracket or quote that is not closed, a comment of another language.
YamlFault faultOf(const std::string& text, const YAML::Exception& error);

/// A quote that is never closed, which the library takes to end with the text.
std::optional<YamlFault> openQuoteOf(const std::string& text);

/// What a file is when it is no YAML at all: "a mesh or results (Exodus)", "an input file of
/// LS-DYNA or Abaqus"; empty: nothing that is known.
std::string foreignKindOf(const std::string& text);
} // namespace coplane
