#include "JointSurfaces.hpp"

#include "ShapeModel.hpp"

#include <coplane_core/Error.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

namespace coplane
{
Draws::Draws(int seed, int stream)
{
  std::seed_seq sequence{seed, stream};
  engine_.seed(sequence);
}

Real Draws::uniform()
{
  return Real(engine_() >> 11) * 0x1p-53;
}

Real Draws::normal()
{
  // Box and Muller 1958.
  const Real radius = std::sqrt(-2 * std::log(1 - uniform()));
  return radius * std::cos(2 * pi * uniform());
}

Vec3 normalOfDip(Real dip, Real dipDirection, const Vec3& up, const Vec3& north)
{
  const Vec3 above = normalised(up), ahead = normalised(north - dot(north, above) * above);
  const Vec3 right = cross(ahead, above);
  const Real azimuth = dipDirection * pi / 180, descent = dip * pi / 180;
  const Vec3 down = std::cos(azimuth) * ahead + std::sin(azimuth) * right;
  return std::sin(descent) * down + std::cos(descent) * above;
}

namespace
{
/// Two unit vectors that make a right-handed frame with `normal`.
std::pair<Vec3, Vec3> axesOf(const Vec3& normal)
{
  Vec3 axis{};
  axis[std::abs(normal.x) < 0.6 ? 0 : 1] = 1;
  const Vec3 u = normalised(axis - dot(axis, normal) * normal);
  return {u, cross(normal, u)};
}

/// A normal drawn round `mean` by Fisher's distribution: cos(angle) has a density proportional to
/// exp(K cos(angle)).
Vec3 fisherNormal(const Vec3& mean, Real concentration, Draws& draws)
{
  const Real cosine =
      1 + std::log(1 - draws.uniform() * (1 - std::exp(-2 * concentration))) / concentration;
  const Real sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)), turn = 2 * pi * draws.uniform();
  const auto [u, v] = axesOf(mean);
  return cosine * mean + sine * (std::cos(turn) * u + std::sin(turn) * v);
}

/// A polygon of 24 corners with the area of the circle.
std::vector<Vec3> discOf(const Vec3& centre, const Vec3& normal, Real radius)
{
  constexpr int count = 24;
  const auto [u, v] = axesOf(normal);
  const Real reach = radius * std::sqrt(2 * pi / (count * std::sin(2 * pi / count)));
  std::vector<Vec3> corners;
  for (int k = 0; k < count; ++k)
    corners.push_back(
        centre + reach * (std::cos(2 * pi * k / count) * u + std::sin(2 * pi * k / count) * v));
  return corners;
}

/// One row of a table.
struct Fracture
{
  int line = 0;                       ///< of the file, from 1
  std::map<std::string, Real> values; ///< by the names of the columns
};

/// The surfaces of one joint.
class JointMaker
{
public:
  JointMaker(const BlocksRecipe& recipe, int joint, const Vec3& low, const Vec3& high,
             std::vector<JointSurface>& surfaces)
      : recipe_(recipe), joint_(joint), middle_(0.5 * (low + high)), reach_(norm(high - low)),
        surfaces_(surfaces), draws_(recipe.seed, joint)
  {
  }

  void makeSet(const JointSetCard& set)
  {
    const bool flat = recipe_.dimension == 2;
    const Real angle = set.angle * pi / 180;
    const Vec3 mean = flat ? Vec3{-std::sin(angle), std::cos(angle), 0}
                           : normalOfDip(set.dip, set.dipDirection, recipe_.up, recipe_.north);
    const Vec3 through = set.through.empty() ? middle_ : toVec3(set.through);
    for (const Real offset : offsets(set, dot(middle_ - through, mean)))
    {
      Vec3 normal = mean;
      if (flat && set.angleScatter > 0)
      {
        const Real turned = angle + set.angleScatter * pi / 180 * draws_.normal();
        normal = {-std::sin(turned), std::cos(turned), 0};
      }
      else if (!flat && set.fisher > 0)
        normal = fisherNormal(mean, set.fisher, draws_);
      // Below or above the middle of the domain, so that scatter turns a joint about its middle.
      const Vec3 foot = middle_ + (dot(through - middle_, mean) + offset) * mean;
      if (set.persistence < 1)
        addParts(foot, normal, set);
      else
        addPlane(foot, normal);
    }
  }

  /// How many surfaces or steps makeSet would need.
  Real workOfSet(const JointSetCard& set) const
  {
    const Vec3 through = set.through.empty() ? middle_ : toVec3(set.through);
    const Real parts = set.persistence < 1 ? std::ceil(2 * reach_ / set.length) : 1;
    return (reach_ + norm(through - middle_)) / set.spacing *
           std::pow(parts, recipe_.dimension - 1);
  }

  void makePlanes(const JointPlaneCard& card)
  {
    const Vec3 normal = normalised(toVec3(card.normal));
    const auto number = &card - recipe_.joints[std::size_t(joint_)].planes.data() + 1;
    for (int k = 0; k < card.count; ++k)
    {
      source_ = fmt::format("plane {}", number);
      if (card.count > 1)
        source_ += fmt::format(" ({} of {})", k + 1, card.count);
      const Vec3 shift = k * card.spacing * normal, point = toVec3(card.point) + shift;
      const auto onPlane = [&](const Vec3& x) { return x - dot(x - point, normal) * normal; };
      if (card.disc.radius > 0)
        add(discOf(onPlane(toVec3(card.disc.centre)), normal, card.disc.radius));
      else if (!card.segment.empty())
        add({onPlane(toVec3(card.segment[0])), onPlane(toVec3(card.segment[1]))});
      else if (!card.polygon.empty())
      {
        std::vector<Vec3> corners;
        for (const Vec3& corner : toPoints(card.polygon))
          corners.push_back(onPlane(corner));
        add(corners);
      }
      else
        addPlane(onPlane(middle_), normal);
    }
  }

  void makeFracture(const Fracture& fracture)
  {
    const auto& values = fracture.values;
    const auto at = [&](const char* name) { return values.at(name); };
    source_ = fmt::format("line {}", fracture.line);
    if (recipe_.dimension == 2)
      return add({{at("x1"), at("y1"), 0}, {at("x2"), at("y2"), 0}});
    const Vec3 normal =
        values.count("nx") ? normalised(Vec3{at("nx"), at("ny"), at("nz")})
                           : normalOfDip(at("dip"), at("dip_direction"), recipe_.up, recipe_.north);
    add(discOf({at("x"), at("y"), at("z")}, normal, at("radius")));
  }

private:
  /// Distances along the normal from the point that the set goes through; all planes that can meet
  /// the domain. @param middle the same of the middle of the domain
  std::vector<Real> offsets(const JointSetCard& set, Real middle)
  {
    std::vector<Real> all;
    const auto gap = [&]
    { return set.spacing * (1 + set.spacingScatter * (2 * draws_.uniform() - 1)); };
    for (Real offset = 0; offset < middle + reach_ / 2; offset += gap())
      if (offset > middle - reach_ / 2)
        all.push_back(offset);
    for (Real offset = -gap(); offset > middle - reach_ / 2; offset -= gap())
      if (offset < middle + reach_ / 2)
        all.push_back(offset);
    std::sort(all.begin(), all.end());
    return all;
  }

  void add(const std::vector<Vec3>& corners) { surfaces_.push_back({joint_, corners, source_}); }

  /// Beyond the domain to all sides.
  void addPlane(const Vec3& point, const Vec3& normal)
  {
    if (recipe_.dimension == 2)
    {
      const Vec3 along{normal.y, -normal.x, 0};
      return add({point - reach_ * along, point + reach_ * along});
    }
    const auto [u, v] = axesOf(normal);
    add({point - reach_ * u - reach_ * v, point + reach_ * u - reach_ * v,
         point + reach_ * u + reach_ * v, point - reach_ * u + reach_ * v});
  }

  /// Parts of the length of the set between bridges, on a grid that starts anywhere; in three
  /// dimensions squares, two of their sides along the strike.
  void addParts(const Vec3& point, const Vec3& normal, const JointSetCard& set)
  {
    const Real half = set.length / 2;
    const auto starts = [&](Real period)
    {
      std::vector<Real> middles;
      for (Real s = -reach_ + period * draws_.uniform(); s < reach_; s += period)
        middles.push_back(s);
      return middles;
    };
    if (recipe_.dimension == 2)
    {
      const Vec3 along{normal.y, -normal.x, 0};
      for (const Real s : starts(set.length / set.persistence))
        add({point + (s - half) * along, point + (s + half) * along});
      return;
    }
    const Vec3 strike = cross(recipe_.up, normal);
    const Vec3 u =
        norm(strike) > 1e-9 * norm(recipe_.up) ? normalised(strike) : axesOf(normal).first;
    const Vec3 v = cross(normal, u);
    const Real period = set.length / std::sqrt(set.persistence);
    const std::vector<Real> columns = starts(period), rows = starts(period);
    for (const Real s : columns)
      for (const Real t : rows)
        if (s * s + t * t < std::pow(reach_ / 2 + set.length, 2))
          add({point + (s - half) * u + (t - half) * v, point + (s + half) * u + (t - half) * v,
               point + (s + half) * u + (t + half) * v, point + (s - half) * u + (t + half) * v});
  }

  const BlocksRecipe& recipe_;
  int joint_;
  Vec3 middle_;
  Real reach_; ///< the diagonal of the domain's box [m]
  std::vector<JointSurface>& surfaces_;
  std::string source_;
  Draws draws_;
};

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

/// The rows of a table of numbers. Throws Error(Deck) with the line.
std::vector<Fracture> readFractures(const std::string& file, int dimension)
{
  std::stringstream text(readTextFile(file, {"the table of fractures", "", "", infinity}));
  std::vector<std::string> columns;
  std::vector<Fracture> rows;
  int number = 0;
  for (std::string line; std::getline(text, line);)
  {
    if (++number == 1 && line.rfind("\xEF\xBB\xBF", 0) == 0) // a byte order mark
      line.erase(0, 3);
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
    rows.push_back({number, {}});
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
    if (row.count("radius") && !(row.at("radius") > 0))
      fail(ExitCode::Deck, "{}:{}: the radius {} is not positive.", file, number, row.at("radius"));
    if (row.count("nx") && !(std::hypot(row.at("nx"), row.at("ny"), row.at("nz")) > 0))
      fail(ExitCode::Deck, "{}:{}: the normal is zero.", file, number);
  }
  if (rows.empty())
    fail(ExitCode::Deck, "{}: no fracture in the table.", file);
  return rows;
}
} // namespace

std::vector<JointSurface> jointSurfaces(const BlocksRecipe& recipe, const std::string& recipeFile,
                                        const Vec3& low, const Vec3& high, Problems& problems)
{
  std::vector<JointSurface> surfaces;
  for (std::size_t j = 0; j < recipe.joints.size(); ++j)
  {
    const JointsCard& card = recipe.joints[j];
    JointMaker maker(recipe, int(j), low, high, surfaces);
    if (card.set.spacing > 0)
    {
      constexpr Real most = 1e6;
      if (const Real work = maker.workOfSet(card.set); work > most)
        problems.add(nodeAt(recipe.root, {"joints", card.name, "set"}),
                     fmt::format("joints.{}.set makes about {:.2g} joints, and up to {:.2g} are "
                                 "made: spacing or length is too small for the domain, or "
                                 "through too far away.",
                                 card.name, work, most));
      else
        maker.makeSet(card.set);
    }
    for (const JointPlaneCard& plane : card.planes)
      maker.makePlanes(plane);
    if (card.file.empty())
      continue;
    try
    {
      const auto file = std::filesystem::path(recipeFile).parent_path() / card.file;
      for (const auto& row : readFractures(file.string(), recipe.dimension))
        maker.makeFracture(row);
    }
    catch (const Error& error)
    {
      problems.add(nodeAt(recipe.root, {"joints", card.name, "file"}), error.what());
    }
  }
  return surfaces;
}
} // namespace coplane
