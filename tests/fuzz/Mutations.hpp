#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace coplane
{
/// Makes spoilt files out of good ones: a few random changes each, of the kinds that disks, editors
/// and other programs make. The same seed gives the same files. First come the good ones
/// themselves.
class Mutations
{
public:
  Mutations(std::vector<std::string> good, std::uint64_t seed)
      : good_(std::move(good)), random_(seed)
  {
  }

  std::string next()
  {
    if (unchanged_ < good_.size())
      return good_[unchanged_++];
    std::string file = good_[below(good_.size())];
    for (std::size_t changes = 1 + below(4); changes > 0; --changes)
      change(file);
    return file;
  }

private:
  std::size_t below(std::size_t n) { return std::size_t(random_() % n); }
  std::size_t place(const std::string& file) { return below(file.size() + 1); }

  void change(std::string& file)
  {
    if (file.empty())
    {
      file = "\n";
      return;
    }
    const std::size_t at = below(file.size()), rest = file.size() - at;
    switch (below(12))
    {
    case 0: // one bit
      file[at] = char(file[at] ^ (1 << below(8)));
      break;
    case 1: // one byte
      file[at] = char(below(256));
      break;
    case 2: // cut off
      file.resize(at);
      break;
    case 3: // a piece is lost
      file.erase(at, 1 + below(std::min<std::size_t>(rest, 64)));
      break;
    case 4: // a piece is zero
      std::memset(&file[at], 0, 1 + below(std::min<std::size_t>(rest, 64)));
      break;
    case 5: // a piece comes twice
      file.insert(place(file), file.substr(at, 1 + below(200)));
      break;
    case 6: // a piece of another file
    {
      const std::string& other = good_[below(good_.size())];
      if (!other.empty())
        file.insert(at, other.substr(below(other.size()), 1 + below(200)));
      break;
    }
    case 7: // a binary number that is out of the ordinary
      overwriteNumber(file, at, rest);
      break;
    case 8:
      replaceNumber(file, at);
      break;
    case 9: // a word of text that is out of the ordinary
    {
      static const std::array<const char*, 20> words{
          "nan",      ".inf",  "-1",   "[]", "{}", "~",  "*a", "&a ", "!!binary ", "\t",
          "\xff\xfe", "\xc3(", "\r\n", "- ", "? ", ": ", "\"", "|\n", "1e999",     "# "};
      file.insert(at, words[below(words.size())]);
      break;
    }
    case 10: // nested without end
      file.insert(at, std::string(1 + below(3000), "[{-("[below(4)]));
      break;
    default:
      swapLines(file);
    }
  }

  void overwriteNumber(std::string& file, std::size_t at, std::size_t rest)
  {
    static const std::array<std::uint64_t, 10> numbers{0,
                                                       1,
                                                       0x7f,
                                                       0xffffffff,
                                                       0x7fffffff,
                                                       0x80000000,
                                                       0x10000000,
                                                       0xffffffffffffffff,
                                                       0x7fffffffffffffff,
                                                       0x7ff8000000000000};
    const std::uint64_t number = numbers[below(numbers.size())];
    const bool swapped = below(2) != 0;
    const std::size_t bytes = std::min<std::size_t>(rest, std::size_t(1) << below(4));
    for (std::size_t i = 0; i < bytes; ++i)
      file[at + i] = char(number >> (8 * (swapped ? bytes - 1 - i : i)));
  }

  /// The next number in a text becomes another one.
  void replaceNumber(std::string& file, std::size_t at)
  {
    const std::size_t begin = file.find_first_of("0123456789", at);
    if (begin == std::string::npos)
      return;
    const std::size_t end = file.find_first_not_of("0123456789.eE+-", begin);
    static const std::array<const char*, 14> numbers{
        "0",          "-1",         "1e308", "-1e308", "1e-320",     "nan",  "99999999999999999999",
        "2147483648", "4294967295", "1e9",   "3.5",    "1000000000", "-0.0", "9223372036854775807"};
    file.replace(begin, (end == std::string::npos ? file.size() : end) - begin,
                 numbers[below(numbers.size())]);
  }

  void swapLines(std::string& file)
  {
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < file.size();)
    {
      const std::size_t end = std::min(file.find('\n', begin), file.size() - 1) + 1;
      lines.push_back(file.substr(begin, end - begin));
      begin = end;
    }
    std::swap(lines[below(lines.size())], lines[below(lines.size())]);
    file.clear();
    for (const std::string& line : lines)
      file += line;
  }

  std::vector<std::string> good_;
  std::size_t unchanged_ = 0; ///< so many of them have been given
  std::mt19937_64 random_;
};
} // namespace coplane
