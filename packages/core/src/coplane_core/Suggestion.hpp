#pragma once

#include <string>
#include <vector>

namespace coplane
{
/// Least number of insertions, deletions, replacements and swaps of neighbours that make `b` of
/// `a`; upper and lower case are one.
int editDistance(const std::string& a, const std::string& b);

/// The candidate nearest to `word`, as a slip of the keyboard leaves it; or the only one of which
/// it is a part, as 'elastic' of 'linear_elastic'; or an empty string.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

/// " Did you mean 'x'?" with a space in front, or an empty string.
std::string didYouMean(const std::string& word, const std::vector<std::string>& candidates);

/// "a, b, c", and "... (37 more)" after `limit` names.
std::string listOf(const std::vector<std::string>& names, std::size_t limit = 20);

/// What is longer than 200 letters as its beginning and its length: "abc... (5000 letters)".
std::string shortened(const std::string& text);
} // namespace coplane
