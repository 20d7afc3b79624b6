#include "PathFile.hpp"

#include <coplane_core/FileRoles.hpp>
#include <coplane_core/MissingFile.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <optional>

namespace coplane
{
namespace
{
constexpr const char* accepted =
    "time [s], gap [m], slip in x [m], slip in y [m], with commas between them";
constexpr const char* names[4] = {"time", "gap", "slip in x", "slip in y"};
constexpr const char* units[4] = {"s", "m", "m", "m"};
constexpr int mostProblems = 20; // a file of another kind has as many as rows

/// A value of a row, without the blanks around it.
struct Cell
{
  std::string text;
  std::size_t column = 1;
};

std::vector<Cell> cellsOf(const std::string& row)
{
  std::vector<Cell> cells;
  for (std::size_t begin = 0; begin <= row.size();)
  {
    const std::size_t end = std::min(row.find(',', begin), row.size());
    const std::size_t first = std::min(row.find_first_not_of(" \t\r", begin), end);
    const std::size_t last = row.find_last_not_of(" \t\r", end - 1);
    cells.push_back({first < end ? row.substr(first, last + 1 - first) : "", first + 1});
    begin = end + 1;
  }
  return cells;
}

std::optional<Real> numberOf(const std::string& text)
{
  char* end = nullptr;
  const Real value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value))
    return std::nullopt;
  return value;
}

/// Adds the rows of a file to a path.
class PathReader
{
public:
  PathReader(const std::string& file, JointPathCard& card, Problems& problems)
      : file_(file), card_(card), problems_(problems)
  {
  }

  void read(int line, const std::string& row)
  {
    const std::vector<Cell> cells = cellsOf(row);
    if (cells.size() != 4)
      return problem(line, 1,
                     fmt::format("a row of {} values; accepted: {}.", cells.size(), accepted));
    std::array<Real, 4> values{};
    for (std::size_t i = 0; i < 4; ++i)
    {
      const std::optional<Real> value = numberOf(cells[i].text);
      if (!value)
        return problem(line, cells[i].column,
                       fmt::format("{} = '{}' is not a finite number [{}]; accepted: {}.", names[i],
                                   cells[i].text, units[i], accepted));
      values[i] = *value;
    }
    add(line, values);
  }

  void end()
  {
    if (count_ > mostProblems)
      problems_.add(placeOf(file_),
                    fmt::format("{} more rows have problems.", count_ - mostProblems));
    else if (count_ == 0 && card_.times.empty())
      problems_.add(placeOf(file_),
                    fmt::format("the file has no row of values after time 0; accepted: a line of "
                                "headings, then rows of {}.",
                                accepted));
  }

private:
  void add(int line, const std::array<Real, 4>& values)
  {
    const auto [time, gap, x, y] = values;
    const Real before = card_.times.empty() ? 0 : card_.times.back();
    const bool start = card_.times.empty() && time == 0 && gap == 0 && x == 0 && y == 0;
    if (!(time > before) && !start)
      return problem(line, 1,
                     fmt::format("the time {} s comes after {} s; accepted: times that rise, from "
                                 "0, where gap and slips are 0.",
                                 time, before));
    if (start)
      return;
    card_.times.push_back(time);
    card_.gaps.push_back(gap);
    card_.slipsX.push_back(x);
    card_.slipsY.push_back(y);
  }

  void problem(int line, std::size_t column, const std::string& text)
  {
    if (++count_ <= mostProblems)
      problems_.add(placeOf(fmt::format("{}:{}:{}", file_, line, column)), text);
  }

  /// Behind all places of the deck.
  static DeckNode placeOf(const std::string& where)
  {
    DeckNode place;
    place.where = where;
    place.order = std::numeric_limits<long>::max();
    return place;
  }

  const std::string& file_;
  JointPathCard& card_;
  Problems& problems_;
  int count_ = 0;
};
} // namespace

void readPathFile(const std::string& file, JointPathCard& card, const DeckNode& key,
                  Problems& problems)
{
  const auto unreadable = [&](const std::string& why)
  { problems.add(key, fmt::format("joint_paths.{}.file = '{}' {}", card.name, file, why)); };
  if (const std::string kind = kindOfSpecialFile(file); !kind.empty())
    return unreadable(fmt::format("is {}; accepted: a plain file of CSV.", kind));
  std::ifstream stream(file);
  std::string row;
  if (!stream || !std::getline(stream, row))
    return unreadable("cannot be read or is empty." + hintOfMissingFile(file));
  PathReader reader(file, card, problems);
  for (int line = 2; std::getline(stream, row); ++line)
    if (row.find_first_not_of(" \t\r") != std::string::npos)
      reader.read(line, row);
  reader.end();
}
} // namespace coplane
