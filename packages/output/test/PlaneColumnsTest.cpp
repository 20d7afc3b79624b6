#include <coplane_contact/PlaneState.hpp>

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>

namespace coplane
{
namespace
{
std::vector<std::string> parts(const std::string& text, const std::string& between)
{
  const std::regex separator(between);
  return {std::sregex_token_iterator(text.begin(), text.end(), separator, -1), {}};
}

/// Units of the variables in the table of the section on planes.
std::map<std::string, std::string> unitsInTheManual()
{
  std::ifstream page(COPLANE_PAGE_OF_OUTPUTS);
  std::map<std::string, std::string> units;
  bool here = false;
  for (std::string line; std::getline(page, line);)
  {
    if (line.rfind("## ", 0) == 0)
      here = line.rfind("## Planes", 0) == 0;
    const std::vector<std::string> cells = parts(line, R"(\s*\|\s*)");
    if (!here || cells.size() < 4 || cells[1].front() != '`')
      continue;
    const std::vector<std::string> names = parts(cells[1], ", "), of = parts(cells[2], ", ");
    for (std::size_t i = 0; i < names.size(); ++i)
      units[names[i].substr(1, names[i].size() - 2)] = of[of.size() == 1 ? 0 : i];
  }
  return units;
}
} // namespace

TEST(PlaneColumns, areThoseOfTheManualWithTheirUnits)
{
  std::map<std::string, std::string> manual = unitsInTheManual();
  forEachMember(
      [&](const auto& member)
      {
        if (member.column)
        {
          EXPECT_EQ(manual[member.column], std::string(member.unit) == "-" ? "–" : member.unit)
              << member.column;
        }
      });
}
} // namespace coplane
