#include "detail/YamlFault.hpp"

#include <fmt/format.h>
#include <yaml-cpp/exceptions.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <vector>

namespace coplane
{
namespace
{
/// A bracket or quote and where it stands.
struct Mark
{
  char sign;
  int line, column;
};

/// Follows brackets and quotes through a text of YAML.
class OpenMarks
{
public:
  explicit OpenMarks(const std::string& text) : text_(text)
  {
    while (at_ < text_.size() && !fault_)
      step();
    if (!fault_ && !open_.empty())
      fault_ = faultOf(open_.back(), "");
  }

  const std::optional<YamlFault>& fault() const { return fault_; }
  bool isOfQuote() const { return ofQuote_; }
  /// The first quote that goes on beyond its line.
  const std::optional<Mark>& longQuote() const { return longQuote_; }

private:
  char sign() const { return at_ < text_.size() ? text_[at_] : '\n'; }
  bool blankFollows() const
  {
    return at_ + 1 >= text_.size() || std::isspace(static_cast<unsigned char>(text_[at_ + 1]));
  }
  Mark here() const { return {sign(), line_, int(at_ - lineBegin_)}; }

  void advance()
  {
    if (text_[at_++] != '\n')
      return;
    ++line_;
    lineBegin_ = at_;
  }
  void skipLine()
  {
    while (at_ < text_.size() && sign() != '\n')
      ++at_;
  }

  void step()
  {
    const char c = sign();
    const bool afterBlank = at_ == lineBegin_ || text_[at_ - 1] == ' ' || text_[at_ - 1] == '\t';
    if (c == '\n')
    {
      begins_ = true;
      advance();
    }
    else if (c == ' ' || c == '\t' || c == '\r')
      advance();
    else if (c == '#' && afterBlank)
      skipLine();
    else if (!open_.empty() && (c == ']' || c == '}'))
      close();
    else if (begins_ && (c == '"' || c == '\''))
      passQuote();
    else if (begins_ && open_.empty() && (c == '|' || c == '>'))
      passBlock();
    else if ((begins_ || !open_.empty()) && (c == '[' || c == '{'))
    {
      open_.push_back(here());
      begins_ = true;
      advance();
    }
    else
    {
      const bool newItem = begins_ && c == '-' && blankFollows() && open_.empty();
      begins_ = newItem || (c == ':' && (blankFollows() || !open_.empty())) ||
                (c == ',' && !open_.empty());
      advance();
    }
  }

  void close()
  {
    const Mark mark = open_.back();
    if ((mark.sign == '[') != (sign() == ']'))
      fault_ = faultOf(mark, fmt::format(", and '{}' comes in line {}", sign(), line_ + 1));
    open_.pop_back();
    begins_ = false;
    advance();
  }

  void passQuote()
  {
    const Mark mark = here();
    advance();
    for (bool ended = false; !ended; advance())
    {
      if (at_ >= text_.size())
      {
        fault_ = faultOf(mark, "");
        ofQuote_ = true;
        return;
      }
      if (mark.sign == '"' && sign() == '\\' && at_ + 1 < text_.size())
        ++at_;
      else if (sign() == mark.sign)
      {
        const bool twice =
            mark.sign == '\'' && at_ + 1 < text_.size() && text_[at_ + 1] == mark.sign;
        ended = !twice;
        at_ += twice ? 1 : 0;
      }
    }
    if (line_ > mark.line && !longQuote_)
      longQuote_ = mark;
    begins_ = false;
  }

  /// Text of lines, which ends with its indentation.
  void passBlock()
  {
    const auto indentation = [&](std::size_t begin)
    { return std::min(text_.find_first_not_of(' ', begin), text_.size()) - begin; };
    const std::size_t around = indentation(lineBegin_);
    do
    {
      skipLine();
      if (at_ < text_.size())
        advance();
    } while (at_ < text_.size() &&
             (indentation(at_) > around || text_[at_ + indentation(at_)] == '\n'));
    begins_ = true;
  }

  static YamlFault faultOf(const Mark& mark, const std::string& instead)
  {
    const char* const closing = mark.sign == '[' ? "]" : mark.sign == '{' ? "}" : nullptr;
    return {mark.line, mark.column,
            closing ? fmt::format("'{}' is not closed{}; put the missing '{}'.", mark.sign, instead,
                                  closing)
                    : fmt::format("the quote {} is not closed; put the missing one at the end of "
                                  "the text.",
                                  mark.sign)};
  }

  const std::string& text_;
  std::size_t at_ = 0, lineBegin_ = 0;
  int line_ = 0;
  bool begins_ = true; ///< whether a value or a key may begin here
  std::vector<Mark> open_;
  std::optional<YamlFault> fault_;
  bool ofQuote_ = false;
  std::optional<Mark> longQuote_;
};

std::vector<std::string> linesOf(const std::string& text)
{
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  return lines;
}

std::size_t indentationOf(const std::string& line)
{
  return std::min(line.find_first_not_of(" \t\r"), line.size());
}

/// The first line up to `last` that is indented with a tab.
std::optional<YamlFault> tabIn(const std::vector<std::string>& lines, int last)
{
  for (int i = 0; i <= last && i < int(lines.size()); ++i)
    if (const std::size_t tab = lines[i].substr(0, indentationOf(lines[i])).find('\t');
        tab != std::string::npos)
      return YamlFault{i, int(tab),
                       "this line is indented with a tab, which YAML does not have; accepted: "
                       "blanks. Put blanks in place of all tabs."};
  return std::nullopt;
}

/// A line at the error or just before it that begins as comments do elsewhere.
std::optional<YamlFault> commentIn(const std::vector<std::string>& lines, int at)
{
  int before = at - 1;
  while (before >= 0 && before < int(lines.size()) &&
         indentationOf(lines[before]) == lines[before].size())
    --before;
  for (const int i : {before, at})
  {
    if (i < 0 || i >= int(lines.size()))
      continue;
    const std::size_t begin = indentationOf(lines[i]);
    for (const char* sign : {"//", "/*", "$", "!", "*", "%", ";"})
      if (lines[i].compare(begin, std::string(sign).size(), sign) == 0)
        return YamlFault{
            i, int(begin),
            fmt::format("a line that begins with '{}'; comments begin with '#'.", sign)};
  }
  return std::nullopt;
}

/// What messages of the library mean.
std::string meaningOf(const YAML::Exception& error, const std::vector<std::string>& lines)
{
  const std::string& said = error.msg;
  const int line = error.mark.line;
  const std::string found = line >= 0 && line < int(lines.size()) ? lines[line] : "";
  if (said == "end of map not found" || said == "end of sequence not found")
    return fmt::format("this line is indented by {} blanks, as nothing above that it could belong "
                       "to; lines of one "
                       "group begin in one column.",
                       indentationOf(found));
  if (said == "illegal map value")
    return "a second ': ' within one value. Text that holds ': ' wants quotes; each key stands in "
           "a line of its own, or in { } with commas between; and lines of one group begin in one "
           "column.";
  return fmt::format("this is not YAML: {}. Look at this line and the one before for a missing "
                     "colon, bracket or quote, or a wrong indentation.",
                     said == "bad file" ? "it is nested too deeply" : said);
}
} // namespace

YamlFault faultOf(const std::string& text, const YAML::Exception& error)
{
  const std::vector<std::string> lines = linesOf(text);
  if (const auto tab = tabIn(lines, error.mark.line))
    return *tab;
  const OpenMarks marks(text);
  if (marks.fault())
    return *marks.fault();
  if (const auto& quote = marks.longQuote(); quote && quote->line < error.mark.line)
    return {
        quote->line, quote->column,
        fmt::format("the quote {} is not closed in its line, and the next one, in a later line, "
                    "ends it; put the missing one.",
                    quote->sign)};
  if (const auto comment = commentIn(lines, error.mark.line))
    return *comment;
  return {error.mark.line, error.mark.column, meaningOf(error, lines)};
}

std::optional<YamlFault> openQuoteOf(const std::string& text)
{
  const OpenMarks marks(text);
  return marks.isOfQuote() ? marks.fault() : std::nullopt;
}

std::string foreignKindOf(const std::string& text)
{
  if (text.rfind("CDF", 0) == 0 || text.rfind("\x89HDF", 0) == 0)
    return "a mesh or results (Exodus)";
  if (text.rfind("$MeshFormat", 0) == 0)
    return "a mesh of Gmsh";
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.size() > 1 && line[0] == '*' && std::isalpha(static_cast<unsigned char>(line[1])))
      return "an input file of LS-DYNA or Abaqus";
    else if (line.rfind("$", 0) != 0 && line.rfind("**", 0) != 0)
      return "";
  return "";
}
} // namespace coplane
