#include "detail/YamlText.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/Text.hpp>

#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <sstream>

namespace coplane
{
namespace
{
/// Sees a document pass by and keeps the place of the first thing in it.
struct Passing : YAML::EventHandler
{
  std::optional<YAML::Mark> first;
  void see(const YAML::Mark& mark)
  {
    if (!first)
      first = mark;
  }
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { see(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { see(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string&) override
  {
    see(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override
  {
    see(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override
  {
    see(mark);
  }
  void OnMapEnd() override {}
};
} // namespace

void demandPlainText(const std::string& text, const std::string& file)
{
  const auto isControl = [](unsigned char c)
  { return (c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7f; };
  if (text.rfind("\xff\xfe", 0) == 0 || text.rfind("\xfe\xff", 0) == 0)
    fail(ExitCode::Deck, "{}:1: the text is UTF-16; accepted: UTF-8. Save it as UTF-8.", file);
  const auto found = std::find_if(text.begin(), text.end(), isControl);
  if (found != text.end())
    fail(ExitCode::Deck,
         "{}:{}: the text has a control character (byte {:#04x}) here: the file is damaged, or is "
         "no text. Write the line again.",
         file, 1 + std::count(text.begin(), found, '\n'), static_cast<unsigned char>(*found));
  if (isUtf8(text))
    return;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);)
    if (++number; !isUtf8(line))
      fail(ExitCode::Deck,
           "{}:{}: the text is not UTF-8 here, perhaps Latin-1; accepted: UTF-8. Save it as UTF-8, "
           "or: iconv -f latin1 -t utf-8.",
           file, number);
}

YamlText readYaml(const std::string& text)
{
  YamlText read;
  read.document = YAML::Load(text);
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Passing first, second;
  if (parser.HandleNextDocument(first) && parser.HandleNextDocument(second))
    read.rest = second.first.value_or(YAML::Mark());
  return read;
}
} // namespace coplane
