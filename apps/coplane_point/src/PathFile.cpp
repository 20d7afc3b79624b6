#include "PathFile.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/FileRoles.hpp>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>

namespace coplane
{
namespace
{
constexpr const char* accepted =
    "accepted: a line of headings, then lines of four numbers with commas between them: time [s], "
    "gap [m], slip in x [m], slip in y [m]";

std::array<Real, 4> numbersOf(const std::string& line, const std::string& where)
{
  std::array<Real, 4> values{};
  const char* at = line.c_str();
  for (int i = 0; i < 4; ++i)
  {
    char* end = nullptr;
    values[i] = std::strtod(at, &end);
    while (end && (*end == ' ' || *end == '\t' || *end == '\r'))
      ++end;
    if (end == at || !std::isfinite(values[i]) || *end != (i < 3 ? ',' : '\0'))
      fail(ExitCode::Deck, "{}: '{}' is no point of a path; {}.", where, line, accepted);
    at = end + 1;
  }
  return values;
}
} // namespace

void readPathFile(const std::string& file, JointPathCard& card)
{
  if (const std::string kind = kindOfSpecialFile(file); !kind.empty())
    fail(ExitCode::Deck, "{}: this is {}; accepted: a plain file of CSV.", file, kind);
  std::ifstream stream(file);
  std::string line;
  if (!stream || !std::getline(stream, line))
    fail(ExitCode::Deck, "{}: the file of joint_paths.{} cannot be read or is empty; {}.", file,
         card.name, accepted);
  int number = 1;
  while (std::getline(stream, line))
  {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos)
      continue;
    const std::string where = fmt::format("{}:{}", file, number);
    const auto [time, gap, x, y] = numbersOf(line, where);
    const Real before = card.times.empty() ? 0 : card.times.back();
    if (!(time > before) && !(card.times.empty() && time == 0 && gap == 0 && x == 0 && y == 0))
      fail(ExitCode::Deck, "{}: the time {} s comes after {} s; accepted: times that rise, from 0.",
           where, time, before);
    if (time == 0)
      continue;
    card.times.push_back(time);
    card.gaps.push_back(gap);
    card.slipsX.push_back(x);
    card.slipsY.push_back(y);
  }
  if (card.times.empty())
    fail(ExitCode::Deck, "{}: the file has no row of values after time 0; {}.", file, accepted);
}
} // namespace coplane
