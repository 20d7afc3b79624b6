#include "FractureFile.hpp"

#include "PlanePolygon.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_schema/DeckNode.hpp>

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace coplane
{
namespace
{
std::vector<std::string> fieldsOf(const std::string& line)
{
  std::vector<std::string> fields;
  std::stringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');)
  {
    const auto first = field.find_first_not_of(" \t\r"), last = field.find_last_not_of(" \t\r");
    field = first == std::string::npos ? "" : field.substr(first, last - first + 1);
    if (field.size() > 1 && field.front() == '"' && field.back() == '"')
      field = field.substr(1, field.size() - 2);
    fields.push_back(field);
  }
  return fields;
}

/// What is wrong with the columns; empty: nothing.
std::string problemOfColumns(const std::vector<std::string>& columns, int dimension)
{
  const auto has = [&](std::initializer_list<const char*> names)
  {
    return std::all_of(names.begin(), names.end(),
                       [&](const char* name)
                       { return std::count(columns.begin(), columns.end(), name) == 1; });
  };
  if (dimension == 2)
    return has({"x1", "y1", "x2", "y2"}) ? "" : "x1, y1, x2, y2";
  const bool oriented = has({"dip", "dip_direction"}) || has({"nx", "ny", "nz"});
  return has({"x", "y", "z", "radius"}) && oriented
             ? ""
             : "x, y, z, radius and dip, dip_direction or nx, ny, nz";
}

/// The rows of a table of numbers.
std::vector<Fracture> readTable(std::istream& text, const std::string& file, int dimension)
{
  std::vector<std::string> columns;
  std::vector<Fracture> rows;
  int number = 0;
  for (std::string line; std::getline(text, line);)
  {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#')
      continue;
    const std::vector<std::string> fields = fieldsOf(line);
    if (columns.empty())
    {
      columns = fields;
      if (const std::string wanted = problemOfColumns(columns, dimension); !wanted.empty())
        fail(ExitCode::Deck,
             "{}:{}: the columns are '{}'; a table of fractures in {} dimensions "
             "has {}.",
             file, number, fmt::join(columns, ", "), dimension == 2 ? "two" : "three", wanted);
      continue;
    }
    if (fields.size() != columns.size())
      fail(ExitCode::Deck, "{}:{}: {} values for {} columns.", file, number, fields.size(),
           columns.size());
    rows.push_back({number, {}, {}});
    auto& row = rows.back().values;
    for (std::size_t k = 0; k < fields.size(); ++k)
    {
      char* end = nullptr;
      row[columns[k]] = std::strtod(fields[k].c_str(), &end);
      if (end == fields[k].c_str() || *end != '\0' || !std::isfinite(row[columns[k]]))
        fail(ExitCode::Deck, "{}:{}: '{}' in column {} is no number.", file, number, fields[k],
             columns[k]);
    }
    if (dimension == 2 && row.at("x1") == row.at("x2") && row.at("y1") == row.at("y2"))
      fail(ExitCode::Deck, "{}:{}: the trace has no length.", file, number);
    if (dimension == 3 && row.count("radius") && !(row.at("radius") > 0))
      fail(ExitCode::Deck, "{}:{}: the radius {} is not positive.", file, number, row.at("radius"));
    const auto demandDegrees = [&](const char* column, Real least, Real most)
    {
      if (row.count(column) && !(row.at(column) >= least && row.at(column) <= most))
        fail(ExitCode::Deck, "{}:{}: {} = {} is not between {} and {} degrees: {}.", file, number,
             column, row.at(column), least, most,
             most > 90 ? "the azimuth of the descent, clockwise from north"
                       : "the steepest descent below the horizontal; a plane that descends beyond "
                         "the vertical has 180 less that, and the opposite dip_direction");
    };
    if (dimension == 3 && !row.count("nx"))
    {
      demandDegrees("dip", 0, 90);
      demandDegrees("dip_direction", -360, 360);
    }
    if (row.count("nx") && !(std::hypot(row.at("nx"), row.at("ny"), row.at("nz")) > 0))
      fail(ExitCode::Deck, "{}:{}: the normal is zero.", file, number);
  }
  if (rows.empty())
    fail(ExitCode::Deck, "{}: no fracture in the table.", file);
  return rows;
}

const std::string polygonsBegin = "nPolygons:";

/// The corners on their common plane; dfnWorks writes twelve digits.
std::vector<Vec3> onPlane(const std::vector<Vec3>& corners, const std::string& place)
{
  const std::size_t count = corners.size();
  Vec3 middle{}, twiceArea{};
  Real reach = 0;
  for (std::size_t k = 0; k < count; ++k)
  {
    middle += (1 / Real(count)) * corners[k];
    twiceArea += cross(corners[k] - corners[0], corners[(k + 1) % count] - corners[0]);
    reach = std::max(reach, norm(corners[k] - corners[0]));
  }
  if (const std::string problem = problemOfPolygon(corners); !problem.empty())
    fail(ExitCode::Deck, "{}: the polygon {}", place, problem);
  const Vec3 normal = normalised(twiceArea);
  std::vector<Vec3> plane;
  for (const Vec3& corner : corners)
  {
    const Real off = dot(corner - middle, normal);
    if (!(std::abs(off) <= 1e-5 * reach))
      fail(ExitCode::Deck,
           "{}: the polygon is not plane: the corner {} is {:.3g} m off the plane of the others.",
           place, 1 + (&corner - corners.data()), std::abs(off));
    plane.push_back(corner - off * normal);
  }
  return plane;
}

/// polygons.dat of dfnWorks: the number of polygons, then a line each: the number of its corners
/// and each of them as {x, y, z}.
std::vector<Fracture> readPolygons(std::istream& text, const std::string& file, int dimension)
{
  if (dimension != 3)
    fail(ExitCode::Deck,
         "{}: polygons of dfnWorks need dimension: 3; in two dimensions a table has traces: x1, "
         "y1, x2, y2.",
         file);
  std::vector<Fracture> polygons;
  long announced = -1;
  int number = 0;
  for (std::string line; std::getline(text, line);)
  {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string::npos)
      continue;
    const std::string place = fmt::format("{}:{}", file, number);
    const auto numbersOf = [&](const std::string& part)
    {
      std::vector<Real> numbers;
      std::istringstream words(part);
      for (std::string word; words >> word;)
      {
        char* end = nullptr;
        numbers.push_back(std::strtod(word.c_str(), &end));
        if (*end != '\0' || !std::isfinite(numbers.back()))
          fail(ExitCode::Deck,
               "{}: '{}' is no number; a line has the number of corners and each of them as {{x, "
               "y, z}}.",
               place, word);
      }
      return numbers;
    };
    if (announced < 0)
    {
      const std::vector<Real> count = numbersOf(line.substr(line.find(':') + 1));
      if (count.size() != 1 || !(count[0] >= 1) || count[0] != std::floor(count[0]) ||
          count[0] > 1e9)
        fail(ExitCode::Deck, "{}: '{}' has to name the number of polygons.", place, line);
      announced = long(count[0]);
      continue;
    }
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == '{' || c == '}' || c == ','; }, ' ');
    const std::vector<Real> numbers = numbersOf(line);
    const std::size_t corners = numbers.size() / 3;
    if (numbers.empty() || numbers[0] != Real(corners) || numbers.size() != 1 + 3 * corners ||
        corners < 3)
      fail(ExitCode::Deck,
           "{}: {} numbers follow for {} corners; accepted: three for each, and three corners or "
           "more.",
           place, numbers.empty() ? 0 : numbers.size() - 1, numbers.empty() ? 0 : numbers[0]);
    Fracture& polygon = polygons.emplace_back();
    polygon.line = number;
    for (std::size_t k = 0; k < corners; ++k)
      polygon.corners.push_back({numbers[1 + 3 * k], numbers[2 + 3 * k], numbers[3 + 3 * k]});
    polygon.corners = onPlane(polygon.corners, place);
  }
  if (long(polygons.size()) != announced)
    fail(ExitCode::Deck, "{}: {} polygons, and {} {}: the file is not whole.", file,
         polygons.size(), polygonsBegin, announced);
  return polygons;
}
} // namespace

std::vector<Fracture> readFractures(const std::string& file, int dimension)
{
  std::string content = readTextFile(file, {"the table of fractures", "", "", infinity});
  if (content.rfind("\xEF\xBB\xBF", 0) == 0) // a byte order mark
    content.erase(0, 3);
  std::istringstream text(content);
  const std::size_t begin = content.find_first_not_of(" \t\r\n");
  return begin != std::string::npos &&
                 content.compare(begin, polygonsBegin.size(), polygonsBegin) == 0
             ? readPolygons(text, file, dimension)
             : readTable(text, file, dimension);
}
} // namespace coplane
