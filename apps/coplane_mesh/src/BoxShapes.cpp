#include "ShapeModel.hpp"

namespace coplane
{
using namespace schema;

namespace
{
/// Grid lines along one axis: the ends of segments, and elements in each.
struct GridLines
{
  std::vector<Real> ends; ///< [m]
  std::vector<int> divisions;
  std::vector<Real> bias;
};

struct BoxLines
{
  std::array<GridLines, 3> axes;
};

struct BoxParameters
{
  int dimension = 0;
  std::vector<Real> min, max, size; ///< [m]
  std::vector<int> divisions;
  std::vector<Real> bias;
  BoxLines lines;
};

struct CorneredParameters
{
  int dimension = 0;
  std::vector<std::vector<Real>> corners; ///< [m]
  std::vector<int> divisions;
};

std::vector<Real> lineOf(const GridLines& grid)
{
  if (grid.divisions.empty() && grid.bias.empty())
    return grid.ends;
  std::vector<Real> line;
  for (std::size_t s = 0; s + 1 < grid.ends.size(); ++s)
  {
    const std::vector<Real> part =
        gradedLine(grid.ends[s], grid.ends[s + 1], grid.divisions.empty() ? 1 : grid.divisions[s],
                   grid.bias.empty() ? 1.0 : grid.bias[s]);
    line.insert(line.end(), part.begin() + (s == 0 ? 0 : 1), part.end());
  }
  return line;
}

void checkGridLines(GridLines& grid, const CardPlace& place)
{
  const std::size_t segments = grid.ends.size() - 1;
  for (std::size_t i = 1; i <= segments; ++i)
    if (!(grid.ends[i] > grid.ends[i - 1]))
      place.problem("ends", fmt::format("has {} m after {} m; coordinates must be ascending.",
                                        grid.ends[i], grid.ends[i - 1]));
  for (const char* key : {"divisions", "bias"})
  {
    const std::size_t given = key[0] == 'd' ? grid.divisions.size() : grid.bias.size();
    if (place.gives(key) && given != segments)
      place.problem(key, fmt::format("has {} numbers, but ends has {}; accepted: one less than "
                                     "ends.",
                                     given, grid.ends.size()));
  }
}

Key gridLines(int axis)
{
  Key key = section(std::string(1, "xyz"[axis]),
                    {
                        numbers("ends", &GridLines::ends)
                            .needed()
                            .in("m")
                            .atLeastItems(2)
                            .like("[0, 0.1, 0.4]")
                            .means("coordinates of the ends of segments, ascending"),
                        integers("divisions", &GridLines::divisions)
                            .in("elements")
                            .atLeast(1)
                            .defaultIs("1 in each segment")
                            .like("[8, 15]")
                            .means("in each segment"),
                        numbers("bias", &GridLines::bias)
                            .in("-")
                            .above(0)
                            .defaultIs("1 in each segment")
                            .like("[1, 3]")
                            .means("last element over first element of each segment, the others in "
                                   "geometric progression"),
                    })
                .shortFor("ends")
                .checkedBy(checkGridLines)
                .means(fmt::format("grid lines along {}", "xyz"[axis]));
  key.enter = [axis](void* lines, const std::string&, const std::string&) -> void*
  { return &static_cast<BoxLines*>(lines)->axes[axis]; };
  key.required = true;
  key.dimension = axis == 2 ? 3 : 0;
  return key;
}

void checkBox(const BoxParameters& box, const CardPlace& place)
{
  if (place.gives("lines"))
  {
    for (const char* key : {"min", "max", "size", "divisions", "bias"})
      if (place.gives(key))
        place.problem(key, "has no place beside lines; leave one of them out.");
    return;
  }
  if (!place.gives("divisions"))
    place.problem("divisions", "is missing; accepted: a list of whole numbers >= 1 [elements], or "
                               "lines in its place.");
  if (place.gives("size") == place.gives("max"))
    place.problem("size",
                  "or max: give exactly one of them (with min, or without for the origin).");
  else if (place.gives("max"))
    for (int axis = 0; axis < box.dimension; ++axis)
      if (const Real low = box.min.empty() ? 0 : box.min[axis]; !(box.max[axis] > low))
        place.problem("max", fmt::format("= {} m along {} must be greater than min = {} m.",
                                         box.max[axis], "xyz"[axis], low));
  for (std::size_t axis = 0; axis < box.size.size(); ++axis)
    if (const Real low = box.min.empty() ? 0 : box.min[axis]; !(low + box.size[axis] > low))
      place.problem("size", fmt::format("= {} m along {} is lost in rounding beside min = {} m.",
                                        box.size[axis], "xyz"[axis], low));
}

std::vector<Body> makeLaw(const BoxParameters& p)
{
  std::array<std::vector<Real>, 3> lines;
  if (!p.lines.axes[0].ends.empty())
  {
    for (int axis = 0; axis < p.dimension; ++axis)
      lines[axis] = lineOf(p.lines.axes[axis]);
    return {boxOfLines(p.dimension, lines)};
  }
  const Vec3 lowest = p.min.empty() ? Vec3{} : toVec3(p.min);
  const Vec3 highest = p.size.empty() ? toVec3(p.max) : lowest + toVec3(p.size);
  const auto n = toCounts(p.divisions);
  if (p.bias.empty())
    return {box(p.dimension, lowest, highest, n)};
  for (int axis = 0; axis < p.dimension; ++axis)
    lines[axis] = gradedLine(lowest[axis], highest[axis], n[axis], p.bias[axis]);
  return {boxOfLines(p.dimension, lines)};
}

/// The corners are those of one large element.
void checkCorners(const CorneredParameters& p, const CardPlace& place)
{
  // The map keeps its sense everywhere when it does so with a large element's edges at each corner
  // (two dimensions: exactly; three: unless strongly warped, which the check of the mesh finds).
  static const int next[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                                 {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};
  const std::vector<Vec3> corners = toPoints(p.corners);
  for (std::size_t c = 0; c < corners.size(); ++c)
  {
    const Vec3 a = corners[next[c][0]] - corners[c], b = corners[next[c][1]] - corners[c];
    const Vec3 up = p.dimension == 2 ? Vec3{0, 0, 1} : corners[next[c][2]] - corners[c];
    if (!(dot(cross(a, b), up) > 0))
      return place.problem(
          "corners",
          fmt::format("turn inside out at corner {}. {}", c + 1,
                      p.dimension == 2 ? "Give them counter-clockwise; every angle is below 180 "
                                         "degrees."
                                       : "Give the four of the bottom counter-clockwise seen from "
                                         "above, then those above them in the same order."));
  }
}

std::vector<Body> makeLaw(const CorneredParameters& p)
{
  return {cornered(p.dimension, toPoints(p.corners), toCounts(p.divisions))};
}
} // namespace

ShapeModel boxModel()
{
  using P = BoxParameters;
  return ShapeModelOf<P>("box", "one body between two corners")
      .has({
          numbers("min", &P::min)
              .byDimension()
              .in("m")
              .defaultIs("the origin")
              .like("[0, -0.05]")
              .means("lowest corner"),
          numbers("max", &P::max)
              .byDimension()
              .in("m")
              .defaultIs("as size says")
              .like("[1.2, 0]")
              .means("highest corner"),
          numbers("size", &P::size)
              .byDimension()
              .in("m")
              .above(0)
              .defaultIs("as max says")
              .like("[0.2, 0.1]")
              .means("lengths of the edges"),
          integers("divisions", &P::divisions)
              .byDimension()
              .in("elements")
              .atLeast(1)
              .defaultIs("as lines say")
              .like("[23, 1]")
              .means("along x, y, z"),
          numbers("bias", &P::bias)
              .byDimension()
              .in("-")
              .above(0)
              .defaultIs("all 1")
              .like("[1, 3]")
              .means("last element over first element along x, y, z, the others in geometric "
                     "progression"),
          group("lines", &P::lines, {gridLines(0), gridLines(1), gridLines(2)})
              .means("instead of all these: grid lines along each axis"),
      })
      .demands(checkBox);
}

ShapeModel quadrilateralModel()
{
  using P = CorneredParameters;
  return ShapeModelOf<P>("quadrilateral", "one body between four corners (2D)")
      .existsIn(2, "hexahedron")
      .has({
          points("corners", &P::corners, 4)
              .needed()
              .in("m")
              .like("[[0, 0], [2, 0], [2, 1], [0, 2]]")
              .means("counter-clockwise"),
          divisions<P>("along corners 1-2 and 1-4"),
      })
      .demands(checkCorners);
}

ShapeModel hexahedronModel()
{
  using P = CorneredParameters;
  return ShapeModelOf<P>("hexahedron", "one body between eight corners (3D)")
      .existsIn(3, "quadrilateral")
      .has({
          points("corners", &P::corners, 8)
              .needed()
              .in("m")
              .like("[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 2], "
                    "[0, 1, 2]]")
              .means("four counter-clockwise as seen from above, then the four above them; a wedge "
                     "is one with close corners"),
          divisions<P>("along corners 1-2, 1-4 and 1-5"),
      })
      .demands(checkCorners);
}
} // namespace coplane
