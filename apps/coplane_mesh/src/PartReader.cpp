#include "PartReader.hpp"

#include "Ogive.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_schema/Suggestion.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace coplane
{
namespace
{
const std::vector<std::string> shapes{"box",       "quadrilateral", "hexahedron", "wall",
                                      "imbricate", "rock",          "cylinder",   "projectile",
                                      "ogive",     "sector",        "half_disc"};

/// "box, wall or rock".
std::string shapeWords()
{
  std::string words;
  for (std::size_t i = 0; i < shapes.size(); ++i)
    words += (i == 0 ? "" : i + 1 < shapes.size() ? ", " : " or ") + shapes[i];
  return words;
}

/// Keys of each shape beside those of every part.
std::vector<std::string> keysOf(const std::string& shape)
{
  static const std::map<std::string, std::vector<std::string>> own{
      {"box", {"min", "max", "size", "divisions", "bias", "lines"}},
      {"quadrilateral", {"corners", "divisions"}},
      {"hexahedron", {"corners", "divisions"}},
      {"wall", {"brick", "courses", "length_in_bricks", "divisions"}},
      {"imbricate", {"brick", "layers", "length_in_bricks", "divisions"}},
      {"projectile", {"width", "length", "across", "along", "section"}},
      {"ogive", {"width", "length", "caliber", "across", "nose", "along"}},
      {"rock", {"blocks", "size", "divisions"}},
      {"cylinder", {"radius", "across", "length", "along"}},
      {"sector",
       {"inner_radius", "outer_radius", "from", "to", "count", "divisions", "length", "bias"}},
      {"half_disc", {"radius", "fine", "fine_radius", "length", "along"}}};
  std::vector<std::string> keys{"shape", "block", "split", "rotate", "about", "offset"};
  keys.insert(keys.end(), own.at(shape).begin(), own.at(shape).end());
  return keys;
}

Vec3 toVec3(const std::vector<Real>& x)
{
  return {x[0], x[1], x.size() > 2 ? x[2] : 0.0};
}
std::array<int, 3> toCounts(const std::vector<int>& n)
{
  return {n[0], n[1], n.size() > 2 ? n[2] : 1};
}

void requireEven(const RecipeMap& map, const std::string& key, int value, const char* why)
{
  if (value % 2 != 0)
    map.refuse(key, fmt::format("has {} {}; it must be even.", value, why));
}

/// Coordinates of the grid lines along one axis: a list of them, or a map of `ends`, `divisions`
/// and `bias` of the segments between the ends.
std::vector<Real> readLine(const RecipeMap& lines, const std::string& axis)
{
  std::vector<Real> line;
  if (lines.node(axis).IsMap())
  {
    const RecipeMap segments = lines.map(axis, {"ends", "divisions", "bias"});
    const std::vector<Real> ends = segments.numbers("ends");
    const int count = int(ends.size()) - 1;
    const std::vector<int> n = segments.counts("divisions", std::max(count, 0));
    const std::vector<Real> bias =
        segments.has("bias") ? segments.ratios("bias", count) : std::vector<Real>(n.size(), 1.0);
    for (int s = 0; s < count; ++s)
    {
      const std::vector<Real> part = gradedLine(ends[s], ends[s + 1], n[s], bias[s]);
      line.insert(line.end(), part.begin() + (s == 0 ? 0 : 1), part.end());
    }
  }
  else
    line = lines.numbers(axis);
  if (line.size() < 2)
    lines.refuse(axis, "needs at least two coordinates.");
  for (std::size_t i = 1; i < line.size(); ++i)
    if (!(line[i] > line[i - 1]))
      lines.refuse(axis, fmt::format("has {} m after {} m; coordinates must be ascending.", line[i],
                                     line[i - 1]));
  return line;
}

std::vector<Body> readBoxOfLines(const RecipeMap& map, int dimension)
{
  for (const char* key : {"min", "max", "size", "divisions", "bias"})
    if (map.has(key))
      map.refuse(key, "has no place beside lines; leave one of them out.");
  const std::vector<std::string> axes{"x", "y", "z"};
  const RecipeMap lines = map.map("lines", {axes.begin(), axes.begin() + dimension});
  std::array<std::vector<Real>, 3> coordinates;
  for (int axis = 0; axis < dimension; ++axis)
    coordinates[axis] = readLine(lines, axes[axis]);
  return {boxOfLines(dimension, coordinates)};
}

std::vector<Body> readBox(const RecipeMap& map, int dimension)
{
  if (map.has("lines"))
    return readBoxOfLines(map, dimension);
  Vec3 lowest{}, highest{};
  if (map.has("size") == map.has("max"))
    map.refuse("size", "or max: give exactly one of them (with min, or without for the origin).");
  if (map.has("min"))
    lowest = map.point("min", dimension);
  if (map.has("size"))
    highest = lowest + toVec3(map.positives("size", dimension));
  else
    highest = map.point("max", dimension);
  for (int axis = 0; axis < dimension; ++axis)
    if (!(highest[axis] > lowest[axis]))
      map.refuse("max", fmt::format("= {} m along {} must be greater than min = {} m.",
                                    highest[axis], "xyz"[axis], lowest[axis]));
  const auto n = toCounts(map.counts("divisions", dimension));
  if (!map.has("bias"))
    return {box(dimension, lowest, highest, n)};
  const std::vector<Real> bias = map.ratios("bias", dimension);
  std::array<std::vector<Real>, 3> lines;
  for (int axis = 0; axis < dimension; ++axis)
    lines[axis] = gradedLine(lowest[axis], highest[axis], n[axis], bias[axis]);
  return {boxOfLines(dimension, lines)};
}

/// `quadrilateral` and `hexahedron`: the corners are those of one large element.
std::vector<Body> readCornered(const RecipeMap& map, int dimension, int shapeDimension)
{
  if (dimension != shapeDimension)
    map.refuse("shape", dimension == 2 ? "hexahedron needs three dimensions; use quadrilateral."
                                       : "quadrilateral needs two dimensions; use hexahedron.");
  const std::vector<Vec3> corners = map.points("corners", dimension == 2 ? 4 : 8, dimension);
  // The map keeps its sense everywhere when it does so with a large element's edges at each corner
  // (two dimensions: exactly; three: unless strongly warped, which the check of the mesh finds).
  static const int next[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                                 {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};
  for (std::size_t c = 0; c < corners.size(); ++c)
  {
    const Vec3 a = corners[next[c][0]] - corners[c], b = corners[next[c][1]] - corners[c];
    const Vec3 up = dimension == 2 ? Vec3{0, 0, 1} : corners[next[c][2]] - corners[c];
    if (!(dot(cross(a, b), up) > 0))
      map.refuse("corners",
                 fmt::format("turn inside out at corner {}. {}", c + 1,
                             dimension == 2
                                 ? "Give them counter-clockwise; every angle is below 180 degrees."
                                 : "Give the four of the bottom counter-clockwise seen from above, "
                                   "then those above them in the same order."));
  }
  return {cornered(dimension, corners, toCounts(map.counts("divisions", dimension)))};
}

std::vector<Body> readWall(const RecipeMap& map, int dimension)
{
  const auto n = toCounts(map.counts("divisions", dimension));
  requireEven(map, "divisions", n[0],
              "elements along a brick, and a half brick takes half of them");
  return runningBond(dimension, toVec3(map.positives("brick", dimension)), map.count("courses"),
                     map.count("length_in_bricks"), n);
}

std::vector<Body> readImbricate(const RecipeMap& map, int dimension)
{
  if (dimension != 2)
    map.refuse("shape", "imbricate exists in two dimensions only; use wall.");
  const auto n = toCounts(map.counts("divisions", 2));
  requireEven(map, "divisions", n[1],
              "elements along a brick, and a half brick takes half of them");
  const std::vector<Real> brick = map.positives("brick", 2);
  return imbricate(brick[0], brick[1], map.count("layers"), map.count("length_in_bricks"), n);
}

std::vector<Body> readProjectile(const RecipeMap& map, int dimension)
{
  const Real width = map.positive("width"), length = map.positive("length");
  if (!(length > width / 2))
    map.refuse("length",
               fmt::format("= {} m must be greater than the nose, which is half the width = {} m.",
                           length, width / 2));
  const int across = map.count("across", 4);
  requireEven(map, "across", across, "elements");
  // Without `along`, elements of the straight part are about as long as wide.
  const int along = map.has("along")
                        ? map.count("along")
                        : std::max(1, int(std::lround((length - width / 2) / (width / across))));
  if (dimension == 2)
  {
    if (map.has("section"))
      map.refuse("section", "is for three dimensions only.");
    return {roundNosed(width, length, across, along)};
  }
  if (map.choice("section", {"round", "square"}) == "round")
    return {roundBar(width, length, across, along)};
  std::vector<Real> depth;
  for (int k = 0; k <= across; ++k)
    depth.push_back(width * (2 * k - across) / (2 * across));
  return {extruded(roundNosed(width, length, across, along), depth)};
}

std::vector<Body> readOgive(const RecipeMap& map, int dimension)
{
  const Real width = map.positive("width"), length = map.positive("length");
  const Real caliber = map.positive("caliber");
  if (!(caliber >= 0.5))
    map.refuse("caliber", fmt::format("= {} must be at least 0.5, half a ball.", caliber));
  const Real nose = ogiveLength(width, caliber);
  if (!(length > nose))
    map.refuse("length", fmt::format("= {} m must be greater than the nose, which is {} m long.",
                                     length, nose));
  const int across = map.count("across", 4);
  requireEven(map, "across", across, "elements");
  const int least = across / 4 + 1;
  // Without these keys, elements are about twice as long as wide.
  const auto divisions = [&](const char* key, Real part, int lowest)
  {
    return map.has(key) ? map.count(key, lowest)
                        : std::max(lowest, int(std::lround(part / (2 * width / across))));
  };
  return {ogiveNosed(dimension, width, caliber, length, across, divisions("nose", nose, least),
                     divisions("along", length - nose, 1))};
}

std::vector<Body> readRock(const RecipeMap& map, int dimension)
{
  return jointedRock(dimension, toCounts(map.counts("blocks", dimension)),
                     toVec3(map.positives("size", dimension)),
                     toCounts(map.counts("divisions", dimension)));
}

std::vector<Body> readSector(const RecipeMap& map, int dimension)
{
  const Real inner = map.positive("inner_radius"), outer = map.positive("outer_radius");
  if (!(outer > inner))
    map.refuse("outer_radius",
               fmt::format("= {} m must be greater than inner_radius = {} m.", outer, inner));
  const Real from = map.number("from"), to = map.number("to");
  if (!(to > from) || to - from > 360)
    map.refuse("to", fmt::format("= {} degrees must be greater than from = {} degrees, by 360 at "
                                 "most.",
                                 to, from));
  const int count = map.has("count") ? map.count("count") : 1;
  const auto n = toCounts(map.counts("divisions", dimension));
  if (!((to - from) / (count * n[1]) <= 90))
    map.refuse("divisions", fmt::format("make elements of {} degrees; 90 is the most. Take more "
                                        "around.",
                                        (to - from) / (count * n[1])));
  if (dimension == 2 && map.has("length"))
    map.refuse("length", "is for three dimensions only.");
  return sectors(dimension, inner, outer, from, to, count,
                 dimension == 3 ? map.positive("length") : 0.0, n,
                 map.has("bias") ? map.positive("bias") : 1.0);
}

/// A plane body as it is in two dimensions, swept from z = 0 by `length` and `along` in three.
std::vector<Body> planeOrSwept(const Body& section, const RecipeMap& map, int dimension)
{
  if (dimension == 2)
  {
    for (const char* key : {"length", "along"})
      if (map.has(key))
        map.refuse(key, "is for three dimensions only.");
    return {section};
  }
  const Real length = map.positive("length");
  const int along = map.count("along");
  std::vector<Real> heights;
  for (int k = 0; k <= along; ++k)
    heights.push_back(length * k / along);
  return {extruded(section, heights)};
}

std::vector<Body> readHalfDisc(const RecipeMap& map, int dimension)
{
  const Real radius = map.positive("radius"), fine = map.positive("fine");
  const Real fineRadius = map.positive("fine_radius");
  if (!(fineRadius <= radius / 4))
    map.refuse("fine_radius", fmt::format("= {} m must not exceed a quarter of the radius = {} m.",
                                          fineRadius, radius / 4));
  if (!(fine <= fineRadius))
    map.refuse("fine", fmt::format("= {} m must not exceed fine_radius = {} m.", fine, fineRadius));
  return planeOrSwept(halfDisc(radius, fine, fineRadius), map, dimension);
}

std::vector<Body> readCylinder(const RecipeMap& map, int dimension)
{
  const Real radius = map.positive("radius");
  const int across = map.count("across", 4);
  requireEven(map, "across", across, "elements");
  return planeOrSwept(disk(radius, across), map, dimension);
}

std::vector<Body> readBodies(const std::string& shape, const RecipeMap& map, int dimension)
{
  if (shape == "box")
    return readBox(map, dimension);
  if (shape == "quadrilateral")
    return readCornered(map, dimension, 2);
  if (shape == "hexahedron")
    return readCornered(map, dimension, 3);
  if (shape == "sector")
    return readSector(map, dimension);
  if (shape == "half_disc")
    return readHalfDisc(map, dimension);
  if (shape == "wall")
    return readWall(map, dimension);
  if (shape == "imbricate")
    return readImbricate(map, dimension);
  if (shape == "projectile")
    return readProjectile(map, dimension);
  if (shape == "ogive")
    return readOgive(map, dimension);
  if (shape == "rock")
    return readRock(map, dimension);
  return readCylinder(map, dimension);
}

/// The bodies as they are, or split into triangles or tetrahedra.
std::vector<Body> splitAsAsked(std::vector<Body> bodies, const RecipeMap& map, int dimension)
{
  const std::string split = map.choice("split", {"none", "triangles", "tetrahedra"});
  if (split == "none")
    return bodies;
  if ((split == "triangles") != (dimension == 2))
    map.refuse("split", dimension == 2 ? "= 'tetrahedra' needs three dimensions; use triangles."
                                       : "= 'triangles' needs two dimensions; use tetrahedra.");
  for (Body& body : bodies)
    body = inSimplices(body);
  return bodies;
}

/// Right-handed rotation about one axis, angle in degrees. Quarter turns are exact.
Mat3 rotationAbout(int axis, Real degrees)
{
  const Real quarter = degrees / 90;
  Real c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
  if (quarter == std::floor(quarter))
  {
    c = std::round(c);
    s = std::round(s);
  }
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  Mat3 r;
  r(axis, axis) = 1;
  r(a, a) = r(b, b) = c;
  r(a, b) = -s;
  r(b, a) = s;
  return r;
}

Mat3 readRotation(const RecipeMap& map, int dimension)
{
  if (dimension == 2)
    return rotationAbout(2, map.has("rotate") ? map.number("rotate") : 0.0);
  const std::vector<Real> degrees =
      map.has("rotate") ? map.numbers("rotate", 3) : std::vector<Real>{0, 0, 0};
  return rotationAbout(2, degrees[2]) *
         (rotationAbout(1, degrees[1]) * rotationAbout(0, degrees[0]));
}

Vec3 middleOf(const std::vector<Body>& bodies)
{
  Vec3 lowest{infinity, infinity, infinity}, highest = -lowest;
  for (const Body& body : bodies)
    for (const Vec3& p : body.points)
      for (int axis = 0; axis < 3; ++axis)
      {
        lowest[axis] = std::min(lowest[axis], p[axis]);
        highest[axis] = std::max(highest[axis], p[axis]);
      }
  return 0.5 * (lowest + highest);
}
} // namespace

Part readPart(const YAML::Node& node, const std::string& file, const std::string& path,
              int dimension)
{
  if (!node.IsMap() || !node["shape"])
    fail(ExitCode::Deck, "{}: {} must be a map with a key shape: {}.", placeOf(file, node), path,
         shapeWords());
  const std::string shape = node["shape"].IsScalar() ? node["shape"].Scalar() : "";
  if (std::find(shapes.begin(), shapes.end(), shape) == shapes.end())
  {
    fail(ExitCode::Deck, "{}: {}.shape = '{}' is not known; use {}.{}",
         placeOf(file, node["shape"]), path, shape, shapeWords(), didYouMean(shape, shapes));
  }
  const RecipeMap map(node, file, path, keysOf(shape));
  Part part;
  part.block = map.text("block");
  part.bodies = splitAsAsked(readBodies(shape, map, dimension), map, dimension);
  part.keyPlace = fmt::format("{}: {}", placeOf(file, map.node("block")), map.pathOf("block"));
  part.rotation = readRotation(map, dimension);
  part.centre = map.has("about") ? map.point("about", dimension) : middleOf(part.bodies);
  if (map.has("offset"))
    part.offset = map.point("offset", dimension);
  // Without a rotation, rounding of (p - centre) + centre must not move touching bodies apart.
  if (!map.has("rotate"))
    part.centre = {};
  return part;
}
} // namespace coplane
