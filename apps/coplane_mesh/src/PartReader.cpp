#include "PartReader.hpp"

#include <coplane_core/Error.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace coplane
{
namespace
{
const std::vector<std::string> shapes{"box", "wall", "imbricate", "projectile", "rock", "cylinder"};

/// Keys of each shape beside those of every part.
std::vector<std::string> keysOf(const std::string& shape)
{
  static const std::map<std::string, std::vector<std::string>> own{
      {"box", {"min", "max", "size", "divisions"}},
      {"wall", {"brick", "courses", "length_in_bricks", "divisions"}},
      {"imbricate", {"brick", "layers", "length_in_bricks", "divisions"}},
      {"projectile", {"width", "length", "across", "along", "section"}},
      {"rock", {"blocks", "size", "divisions"}},
      {"cylinder", {"radius", "across", "length", "along"}}};
  std::vector<std::string> keys{"shape", "block", "rotate", "about", "offset"};
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

std::vector<Body> readBox(const RecipeMap& map, int dimension)
{
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
  return {box(dimension, lowest, highest, toCounts(map.counts("divisions", dimension)))};
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

std::vector<Body> readRock(const RecipeMap& map, int dimension)
{
  return jointedRock(dimension, toCounts(map.counts("blocks", dimension)),
                     toVec3(map.positives("size", dimension)),
                     toCounts(map.counts("divisions", dimension)));
}

std::vector<Body> readCylinder(const RecipeMap& map, int dimension)
{
  const Real radius = map.positive("radius");
  const int across = map.count("across", 4);
  requireEven(map, "across", across, "elements");
  const Body section = disk(radius, across);
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

std::vector<Body> readBodies(const std::string& shape, const RecipeMap& map, int dimension)
{
  if (shape == "box")
    return readBox(map, dimension);
  if (shape == "wall")
    return readWall(map, dimension);
  if (shape == "imbricate")
    return readImbricate(map, dimension);
  if (shape == "projectile")
    return readProjectile(map, dimension);
  if (shape == "rock")
    return readRock(map, dimension);
  return readCylinder(map, dimension);
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
  std::vector<std::string> anyKeys;
  for (const std::string& shape : shapes)
    for (const std::string& key : keysOf(shape))
      anyKeys.push_back(key);
  if (!node.IsMap() || !node["shape"])
    fail(ExitCode::Deck,
         "{}: {} must be a map with a key shape: box, wall, imbricate, projectile, rock or "
         "cylinder.",
         placeOf(file, node), path);
  const std::string shape = node["shape"].IsScalar() ? node["shape"].Scalar() : "";
  if (std::find(shapes.begin(), shapes.end(), shape) == shapes.end())
  {
    const auto near = nearestWord(shape, shapes);
    fail(ExitCode::Deck,
         "{}: {}.shape = '{}' is not known; use box, wall, imbricate, projectile, rock or "
         "cylinder.{}",
         placeOf(file, node["shape"]), path, shape,
         near ? fmt::format(" Did you mean '{}'?", *near) : "");
  }
  const RecipeMap map(node, file, path, keysOf(shape));
  Part part;
  part.block = map.text("block");
  part.bodies = readBodies(shape, map, dimension);
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
