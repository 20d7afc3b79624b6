#pragma once

#include <coplane_core/Error.hpp>

#include <algorithm>
#include <string>

namespace coplane
{
/// Refuses text with control characters other than tabs and ends of lines: no editor writes them,
/// and the YAML library (0.7) never comes back from some.
inline void demandPlainText(const std::string& text, const std::string& file)
{
  const auto isControl = [](unsigned char c)
  { return (c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7f; };
  const auto found = std::find_if(text.begin(), text.end(), isControl);
  if (found != text.end())
    fail(ExitCode::Deck,
         "{}:{}: the text has a control character (byte {:#04x}) here: the file is damaged, or is "
         "no text. Write the line again.",
         file, 1 + std::count(text.begin(), found, '\n'), static_cast<unsigned char>(*found));
}
} // namespace coplane
