#include <coplane_core/Suggestion.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace coplane
{
// Optimal string alignment distance: Levenshtein's table with one more case for swapped neighbours.
int editDistance(const std::string& a, const std::string& b)
{
  const auto same = [](char x, char y)
  {
    return std::tolower(static_cast<unsigned char>(x)) ==
           std::tolower(static_cast<unsigned char>(y));
  };
  const std::size_t n = a.size(), m = b.size();
  std::vector<std::vector<int>> d(n + 1, std::vector<int>(m + 1));
  for (std::size_t i = 0; i <= n; ++i)
    d[i][0] = static_cast<int>(i);
  for (std::size_t j = 0; j <= m; ++j)
    d[0][j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= n; ++i)
    for (std::size_t j = 1; j <= m; ++j)
    {
      const int replace = d[i - 1][j - 1] + (same(a[i - 1], b[j - 1]) ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replace});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[n][m];
}

namespace
{
std::string lowerCase(std::string text)
{
  for (char& c : text)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Whether one of the names ("linear_elastic") has the other in it, from the beginning of a word
/// on.
bool isPartOf(const std::string& part, const std::string& name)
{
  constexpr std::size_t least = 3;
  const std::size_t at = part.size() < least ? std::string::npos : name.find(part);
  return at != std::string::npos && (at == 0 || name[at - 1] == '_');
}

/// The only candidate that has the word as a part, or is a part of it; or an empty string.
std::string ofWhichItIsPart(const std::string& word, const std::vector<std::string>& candidates)
{
  std::string found;
  for (const auto& candidate : candidates)
  {
    const std::string a = lowerCase(word), b = lowerCase(candidate);
    if (!isPartOf(a, b) && !isPartOf(b, a))
      continue;
    if (!found.empty())
      return "";
    found = candidate;
  }
  return found;
}
} // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& candidates)
{
  // A third of the letters may be wrong: 'densty' finds 'density', 'mesh' does not find 'time'.
  int best = std::max(1, static_cast<int>(word.size()) / 3) + 1;
  std::string found;
  for (const auto& candidate : candidates)
  {
    const int distance = editDistance(word, candidate);
    if (distance < best && distance < static_cast<int>(candidate.size()))
    {
      best = distance;
      found = candidate;
    }
  }
  return found.empty() ? ofWhichItIsPart(word, candidates) : found;
}

std::string didYouMean(const std::string& word, const std::vector<std::string>& candidates)
{
  const std::string found = nearest(word, candidates);
  return found.empty() ? "" : fmt::format(" Did you mean '{}'?", found);
}

std::string listOf(const std::vector<std::string>& names, std::size_t limit)
{
  std::string text;
  for (std::size_t i = 0; i < std::min(limit, names.size()); ++i)
    text += (i ? ", " : "") + names[i];
  if (names.size() > limit)
    text += fmt::format(", ... ({} more)", names.size() - limit);
  return text;
}

std::string shortened(const std::string& text)
{
  constexpr std::size_t most = 200;
  const auto begins = [](char c)
  { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }; // UTF-8
  const auto letters = std::size_t(std::count_if(text.begin(), text.end(), begins));
  if (letters <= most)
    return text;
  std::size_t end = 0;
  for (std::size_t letter = 0; letter < most || !begins(text[end]); ++end)
    letter += begins(text[end]);
  return fmt::format("{}... ({} letters)", text.substr(0, end), letters);
}
} // namespace coplane
