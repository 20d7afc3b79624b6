#include "Shapes.hpp"

#include <coplane_core/Error.hpp>

#include <cmath>
#include <limits>
#include <map>

namespace coplane
{
namespace
{
/// How far the corners of the middle square of a disk are drawn in, as a fraction d. Three elements
/// meet at such a corner; the square's own angle there is 90 degrees + 2 atan(2 d / (1 - d)), which
/// is 120 degrees, an equal share, for d = 0.118.
constexpr Real cornerDrawnIn = 0.118;

/// Elements on a side of the middle square for `across` on the diameter: two thirds, and even.
int coreDivisions(int across)
{
  return 2 * int(std::lround(across / 3.0));
}

/// Middle and rings of a disk, or of its upper half. Node numbers follow from the position in the
/// core or on a ring.
class RoundGrid
{
public:
  RoundGrid(Real radius, int across, bool half)
      : radius_(radius), across_(across), core_(coreDivisions(across)),
        rings_((across - core_) / 2), half_(half)
  {
    demandCountable((Real(core_) + 1) * (Real(core_) + 4 * Real(rings_) + 1) / (half_ ? 2 : 1));
    body_.type = ElementType::Quad4;
    const int rows = half_ ? core_ / 2 : core_;
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= core_; ++i)
        body_.points.push_back(corePoint(i, half_ ? j + core_ / 2 : j));
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < core_; ++i)
        addQuad(coreNode(i, j), coreNode(i + 1, j), coreNode(i + 1, j + 1), coreNode(i, j + 1));
    addBorder(rows);
    addRings();
  }

  Body body() const { return body_; }

  /// Half disk: the nodes of its straight edge from (-radius, 0) to (radius, 0).
  std::vector<int> straightEdge() const
  {
    std::vector<int> edge;
    for (int ring = rings_; ring > 0; --ring)
      edge.push_back(ringNode(ring, int(border_.size()) - 1));
    for (int i = 0; i <= core_; ++i)
      edge.push_back(coreNode(i, 0));
    for (int ring = 1; ring <= rings_; ++ring)
      edge.push_back(ringNode(ring, 0));
    return edge;
  }

  /// Half disk: the nodes of its arc from (radius, 0) to (-radius, 0).
  std::vector<int> outerArc() const
  {
    std::vector<int> arc;
    for (int b = 0; b < int(border_.size()); ++b)
      arc.push_back(ringNode(rings_, b));
    return arc;
  }

private:
  int coreNode(int i, int j) const { return j * (core_ + 1) + i; }
  int ringNode(int ring, int b) const
  {
    return ring == 0 ? border_[b] : firstOfRings_ + (ring - 1) * int(border_.size()) + b;
  }
  void addQuad(int a, int b, int c, int d)
  {
    body_.connectivity.insert(body_.connectivity.end(), {a, b, c, d});
  }

  Vec3 corePoint(int i, int j) const
  {
    const Real u = Real(2 * i - core_) / core_, v = Real(2 * j - core_) / core_;
    const Real halfWidth = radius_ * core_ / across_;
    return {halfWidth * u * (1 - cornerDrawnIn * v * v),
            halfWidth * v * (1 - cornerDrawnIn * u * u), 0};
  }

  /// Nodes around the core, counter-clockwise, from the lowest of its right side: a loop, or the
  /// path over the upper half.
  void addBorder(int rows)
  {
    for (int j = 0; j < rows; ++j)
      border_.push_back(coreNode(core_, j));
    for (int i = core_; i > 0; --i)
      border_.push_back(coreNode(i, rows));
    for (int j = rows; j > 0; --j)
      border_.push_back(coreNode(0, j));
    if (half_)
      border_.push_back(coreNode(0, 0));
    else
      for (int i = 0; i < core_; ++i)
        border_.push_back(coreNode(i, 0));
  }

  void addRings()
  {
    firstOfRings_ = int(body_.points.size());
    const int n = int(border_.size());
    for (int ring = 1; ring <= rings_; ++ring)
      for (int b = 0; b < n; ++b)
      {
        // A quarter circle carries as many elements as a side of the core; a loop begins at the
        // corner at -45 degrees.
        const Real angle = (half_ ? 0.0 : -pi / 4) + 0.5 * pi * b / core_;
        const Vec3 outer{radius_ * std::cos(angle),
                         half_ && b == n - 1 ? 0.0 : radius_ * std::sin(angle), 0};
        const Vec3 inner = body_.points[border_[b]];
        body_.points.push_back(inner + (Real(ring) / rings_) * (outer - inner));
      }
    for (int ring = 0; ring < rings_; ++ring)
      for (int b = 0; b < (half_ ? n - 1 : n); ++b)
      {
        const int next = (b + 1) % n;
        addQuad(ringNode(ring, b), ringNode(ring + 1, b), ringNode(ring + 1, next),
                ringNode(ring, next));
      }
  }

  Real radius_;
  int across_, core_, rings_;
  bool half_;
  int firstOfRings_ = 0;
  std::vector<int> border_;
  Body body_;
};
} // namespace

void demandCountable(Real nodes)
{
  if (nodes > Real(std::numeric_limits<int>::max()))
    fail(ExitCode::Deck,
         "asks for {:.3g} nodes; accepted: at most {} in a mesh. Look at divisions, blocks, counts "
         "and sizes of elements.",
         nodes, std::numeric_limits<int>::max());
}

int countable(Real count)
{
  demandCountable(count);
  return int(count);
}

Real nodesOfGrid(int dimension, const std::array<int, 3>& n)
{
  Real nodes = 1;
  for (int axis = 0; axis < dimension; ++axis)
    nodes *= Real(n[axis]) + 1;
  return nodes;
}

Body mappedGrid(int dimension, const std::array<int, 3>& n,
                const std::function<Vec3(int, int, int)>& position)
{
  demandCountable(nodesOfGrid(dimension, n));
  Body body;
  body.type = dimension == 2 ? ElementType::Quad4 : ElementType::Hex8;
  const int layers = dimension == 3 ? n[2] : 0;
  for (int k = 0; k <= layers; ++k)
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i <= n[0]; ++i)
        body.points.push_back(position(i, j, k));
  const auto node = [&](int i, int j, int k) { return (k * (n[1] + 1) + j) * (n[0] + 1) + i; };
  for (int k = 0; k < (dimension == 3 ? n[2] : 1); ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i)
        for (int top = 0; top < (dimension == 3 ? 2 : 1); ++top)
          for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
            body.connectivity.push_back(node(i + di, j + dj, k + top));
  return body;
}

Body extruded(const Body& plane, const std::vector<Real>& heights)
{
  Body body;
  demandCountable(Real(plane.points.size()) * Real(heights.size()));
  const int perLayer = int(plane.points.size());
  for (const Real z : heights)
    for (const Vec3& p : plane.points)
      body.points.push_back({p.x, p.y, z});
  for (int k = 0; k + 1 < int(heights.size()); ++k)
    for (int e = 0; e < plane.elements(); ++e)
      for (int top = 0; top < 2; ++top)
        for (int corner = 0; corner < 4; ++corner)
          body.connectivity.push_back(plane.connectivity[4 * e + corner] + (k + top) * perLayer);
  return body;
}

Body box(int dimension, const Vec3& lowest, const Vec3& highest, const std::array<int, 3>& n)
{
  const auto between = [&](int axis, int i)
  { return (lowest[axis] * (n[axis] - i) + highest[axis] * i) / n[axis]; };
  return mappedGrid(
      dimension, n,
      [&](int i, int j, int k) {
        return Vec3{between(0, i), between(1, j), dimension == 3 ? between(2, k) : 0.0};
      });
}

namespace
{
/// Two colours, 0 and 1, such that the ends of every edge differ. A body of quadrilaterals or
/// hexahedra without hole has such colours: every loop of edges has an even number of them.
std::vector<int> coloursOfNodes(const Body& body)
{
  const ElementTopology& shape = topology(body.type);
  std::vector<std::vector<int>> neighbours(body.points.size());
  for (int e = 0; e < body.elements(); ++e)
    for (int side = 0; side < shape.sides; ++side)
      for (int k = 0; k < shape.nodesPerSide; ++k)
      {
        const int next = (k + 1) % shape.nodesPerSide;
        neighbours[body.connectivity[e * shape.nodes + shape.sideNodes[side][k]]].push_back(
            body.connectivity[e * shape.nodes + shape.sideNodes[side][next]]);
      }
  std::vector<int> colour(body.points.size(), -1);
  std::vector<int> queue{body.connectivity.front()};
  colour[queue.front()] = 0;
  for (std::size_t i = 0; i < queue.size(); ++i)
    for (const int other : neighbours[queue[i]])
    {
      if (colour[other] < 0)
      {
        colour[other] = 1 - colour[queue[i]];
        queue.push_back(other);
      }
      if (colour[other] == colour[queue[i]])
        fail(ExitCode::Internal, "the diagonals of a body cannot alternate");
    }
  return colour;
}
} // namespace

Body inSimplices(const Body& body)
{
  // Diagonals join nodes of colour 0. The tables are for first nodes of that colour; otherwise the
  // element is turned by a quarter.
  static const int triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
  static const int tetrahedra[5][4] = {
      {0, 2, 7, 5}, {1, 2, 0, 5}, {3, 0, 2, 7}, {4, 5, 0, 7}, {6, 2, 5, 7}};
  static const int turned[8] = {1, 2, 3, 0, 5, 6, 7, 4};
  const std::vector<int> colour = coloursOfNodes(body);
  const bool plane = body.type == ElementType::Quad4;
  Body split;
  split.type = plane ? ElementType::Tri3 : ElementType::Tet4;
  split.points = body.points;
  const int perElement = topology(body.type).nodes;
  for (int e = 0; e < body.elements(); ++e)
  {
    const int* nodes = &body.connectivity[e * perElement];
    const auto add = [&](int corner)
    { split.connectivity.push_back(nodes[colour[nodes[0]] == 0 ? corner : turned[corner]]); };
    for (const auto& triangle : triangles)
      for (int k = 0; plane && k < 3; ++k)
        add(triangle[k]);
    for (const auto& tetrahedron : tetrahedra)
      for (int k = 0; !plane && k < 4; ++k)
        add(tetrahedron[k]);
  }
  return split;
}

std::vector<Real> gradedLine(Real a, Real b, int n, Real bias)
{
  const Real ratio = n > 1 ? std::pow(bias, 1.0 / (n - 1)) : 1.0;
  std::vector<Real> ends{0.0};
  Real length = 1;
  for (int i = 0; i < n; ++i, length *= ratio)
    ends.push_back(ends.back() + length);
  std::vector<Real> line;
  for (int i = 0; i <= n; ++i)
    line.push_back((a * (ends[n] - ends[i]) + b * ends[i]) / ends[n]);
  return line;
}

Body boxOfLines(int dimension, const std::array<std::vector<Real>, 3>& lines)
{
  const auto divisions = [&](int axis) { return int(lines[axis].size()) - 1; };
  return mappedGrid(dimension, {divisions(0), divisions(1), dimension == 3 ? divisions(2) : 1},
                    [&](int i, int j, int k) {
                      return Vec3{lines[0][i], lines[1][j], dimension == 3 ? lines[2][k] : 0.0};
                    });
}

Body cornered(int dimension, const std::vector<Vec3>& corners, const std::array<int, 3>& n)
{
  return mappedGrid(dimension, n,
                    [&](int i, int j, int k)
                    {
                      const int layer[2] = {dimension == 3 ? n[2] - k : 1, k};
                      const int column[2] = {n[0] - i, i}, row[2] = {n[1] - j, j};
                      const int c[4] = {column[0] * row[0], column[1] * row[0], column[1] * row[1],
                                        column[0] * row[1]};
                      Vec3 sum{};
                      for (std::size_t a = 0; a < corners.size(); ++a)
                        sum += Real(c[a % 4]) * Real(layer[a / 4]) * corners[a];
                      return (1.0 / (Real(n[0]) * n[1] * (dimension == 3 ? n[2] : 1))) * sum;
                    });
}

namespace
{
/// A brick in a wall, in elements of the whole wall.
struct Brick
{
  int x, width, course, z, depth;
};

class WallBuilder
{
public:
  WallBuilder(int dimension, const Vec3& brick, const std::array<int, 3>& n,
              const std::vector<WallOpening>& openings)
      : dimension_(dimension), brick_(brick), n_(n), openings_(openings)
  {
  }

  void addCourse(Bond bond, int course, int bricks)
  {
    const bool odd = course % 2 == 1;
    const int whole = n_[0], half = whole / 2, end = bricks * whole;
    switch (bond)
    {
    case Bond::Running:
      if (odd)
        add({0, half, course, 0, n_[2]});
      for (int x = odd ? half : 0; x + whole <= end; x += whole)
        add({x, whole, course, 0, n_[2]});
      if (odd)
        add({end - half, half, course, 0, n_[2]});
      return;
    case Bond::Stack:
      for (int x = 0; x < end; x += whole)
        add({x, whole, course, 0, n_[2]});
      return;
    case Bond::English:
      if (!odd)
        for (int x = 0; x < end; x += whole)
          addStretchers(x, course);
      else
        addWithClosers(course, end, half,
                       [&](int x)
                       {
                         addHeader(x, course);
                         return x + half;
                       });
      return;
    case Bond::Flemish:
      if (!odd)
        for (int x = 0; x < end; x += whole + half)
        {
          addStretchers(x, course);
          if (x + whole < end)
            addHeader(x + whole, course);
        }
      else
        addWithClosers(course, end, whole,
                       [&](int x)
                       {
                         addStretchers(x, course);
                         if (x + whole + half <= end - half - half / 2)
                           addHeader(x + whole, course);
                         return x + whole + half;
                       });
      return;
    }
  }

  std::vector<Body> take() { return std::move(bodies_); }

private:
  /// A header and a queen closer at both ends; between them what `next` adds at a place: it returns
  /// the following one. @param least what has to fit for another
  template <class Next>
  void addWithClosers(int course, int end, int least, const Next& next)
  {
    const int half = n_[0] / 2, quarter = half / 2;
    addHeader(0, course);
    add({half, quarter, course, 0, 2 * n_[2]});
    for (int x = half + quarter; x + least <= end - half - quarter;)
      x = next(x);
    add({end - half - quarter, quarter, course, 0, 2 * n_[2]});
    addHeader(end - half, course);
  }

  void addStretchers(int x, int course)
  {
    for (int leaf = 0; leaf < 2; ++leaf)
      add({x, n_[0], course, leaf * n_[2], n_[2]});
  }

  void addHeader(int x, int course) { add({x, n_[0] / 2, course, 0, 2 * n_[2]}); }

  Real placeOf(int x) const { return brick_.x * x / n_[0]; }

  /// The parts of a brick that no opening takes.
  void add(const Brick& brick)
  {
    std::vector<std::pair<Real, Real>> parts{{placeOf(brick.x), placeOf(brick.x + brick.width)}};
    const Real least = 1e-9 * brick_.x;
    for (const WallOpening& opening : openings_)
    {
      if (brick.course < opening.first || brick.course > opening.last)
        continue;
      std::vector<std::pair<Real, Real>> left;
      for (const auto& [from, to] : parts)
      {
        if (std::min(to, opening.from) - from > least)
          left.push_back({from, std::min(to, opening.from)});
        if (to - std::max(from, opening.to) > least)
          left.push_back({std::max(from, opening.to), to});
      }
      parts = left;
    }
    for (const auto& [from, to] : parts)
      addPart(brick, from, to);
  }

  void addPart(const Brick& brick, Real from, Real to)
  {
    const Real whole = placeOf(brick.x + brick.width) - placeOf(brick.x);
    const bool trimmed = to - from < whole;
    const int across =
        trimmed ? std::max(1, int(std::lround(brick.width * (to - from) / whole))) : brick.width;
    const auto along = [&, from = from, to = to](int i)
    {
      // Positions count in elements of the whole wall, so that touching bricks compute the same
      // coordinates.
      if (!trimmed)
        return placeOf(brick.x + i);
      return i == 0 ? from : i == across ? to : from + (to - from) * i / across;
    };
    bodies_.push_back(mappedGrid(dimension_, {across, n_[1], brick.depth},
                                 [&](int i, int j, int k)
                                 {
                                   return Vec3{
                                       along(i), brick_.y * (brick.course * n_[1] + j) / n_[1],
                                       dimension_ == 3 ? brick_.z * (brick.z + k) / n_[2] : 0.0};
                                 }));
  }

  int dimension_;
  Vec3 brick_;
  std::array<int, 3> n_;
  const std::vector<WallOpening>& openings_;
  std::vector<Body> bodies_;
};
} // namespace

std::vector<Body> wallOfBricks(int dimension, Bond bond, const Vec3& brick, int courses, int bricks,
                               const std::array<int, 3>& n,
                               const std::vector<WallOpening>& openings)
{
  demandCountable(2.0 * courses * bricks * nodesOfGrid(dimension, n));
  WallBuilder builder(dimension, brick, n, openings);
  for (int course = 0; course < courses; ++course)
    builder.addCourse(bond, course, bricks);
  return builder.take();
}

std::vector<Body> imbricate(Real thickness, Real length, int layers, int bricks,
                            const std::array<int, 3>& n)
{
  demandCountable(Real(layers) * bricks * nodesOfGrid(2, n));
  std::vector<Body> bodies;
  for (int layer = 0; layer < layers; ++layer)
  {
    const bool shifted = layer % 2 == 0;
    for (int b = 0; b < (shifted ? bricks + 1 : bricks); ++b)
    {
      const bool isHalf = shifted && (b == 0 || b == bricks);
      const int first = shifted ? std::max(0, b * n[1] - n[1] / 2) : b * n[1];
      bodies.push_back(mappedGrid(2, {n[0], isHalf ? n[1] / 2 : n[1], 0},
                                  [&](int i, int j, int)
                                  {
                                    // Counted in half elements from the middle: symmetric to the
                                    // bit about y = 0.
                                    return Vec3{
                                        thickness * (layer * n[0] + i) / n[0],
                                        length * (2 * (first + j) - bricks * n[1]) / (2 * n[1]), 0};
                                  }));
    }
  }
  return bodies;
}

std::vector<Body> jointedRock(int dimension, const std::array<int, 3>& blocks, const Vec3& size,
                              const std::array<int, 3>& n)
{
  demandCountable(Real(blocks[0]) * blocks[1] * (dimension == 3 ? blocks[2] : 1) *
                  nodesOfGrid(dimension, n));
  std::vector<Body> bodies;
  for (int c = 0; c < (dimension == 3 ? blocks[2] : 1); ++c)
    for (int b = 0; b < blocks[1]; ++b)
      for (int a = 0; a < blocks[0]; ++a)
        bodies.push_back(
            mappedGrid(dimension, n,
                       [&](int i, int j, int k)
                       {
                         return Vec3{size.x * (a * n[0] + i) / n[0], size.y * (b * n[1] + j) / n[1],
                                     dimension == 3 ? size.z * (c * n[2] + k) / n[2] : 0.0};
                       }));
  return bodies;
}

Body disk(Real radius, int across)
{
  return RoundGrid(radius, across, false).body();
}

namespace
{
/// The cube in the middle of a ball, between half a cube with flat faces and one that is part of a
/// sphere.
struct CubeOfBall
{
  static constexpr Real size = 0.5;  ///< half an edge over the radius of the ball
  static constexpr Real round = 0.6; ///< 0: flat faces, 1: a sphere

  int divisions;

  Vec3 onCube(const std::array<int, 3>& p) const ///< in -1..1
  {
    const auto along = [&](int i) { return Real(2 * p[i] - divisions) / divisions; };
    return {along(0), along(1), along(2)};
  }
  /// On the unit sphere, by equal angles along the edges of the cube.
  Vec3 direction(const std::array<int, 3>& p) const
  {
    const Vec3 u = onCube(p);
    const Real w = std::max({std::abs(u.x), std::abs(u.y), std::abs(u.z)});
    const auto slope = [&](Real c) { return std::tan(pi / 4 * c / w); };
    const Vec3 direction{slope(u.x), slope(u.y), slope(u.z)};
    return (1 / norm(direction)) * direction;
  }
  /// For a radius of 1.
  Vec3 at(const std::array<int, 3>& p) const
  {
    const Vec3 u = onCube(p);
    const Real w = std::max({std::abs(u.x), std::abs(u.y), std::abs(u.z)});
    return w > 0 ? size * ((1 - round) * u + round * w * direction(p)) : u;
  }
};
} // namespace

Body ball(Real radius, int across)
{
  const int layers = std::max(1, across / 4), n = across - 2 * layers;
  const CubeOfBall cube{n};
  demandCountable(nodesOfGrid(3, {across, across, across}));
  Body body = mappedGrid(3, {n, n, n},
                         [&](int i, int j, int k) {
                           return radius * cube.at({i, j, k});
                         });
  // Layers between each face of the cube and the sphere; nodes on its edges belong to two faces.
  std::map<std::array<int, 3>, std::vector<int>> columns;
  const auto columnOf = [&](const std::array<int, 3>& p) -> const std::vector<int>&
  {
    std::vector<int>& column = columns[p];
    if (column.empty())
    {
      column.push_back((p[2] * (n + 1) + p[1]) * (n + 1) + p[0]);
      const Vec3 inner = cube.at(p), outer = cube.direction(p);
      for (int layer = 1; layer <= layers; ++layer)
      {
        column.push_back(int(body.points.size()));
        body.points.push_back(radius / layers *
                              (Real(layers - layer) * inner + Real(layer) * outer));
      }
    }
    return column;
  };
  for (int face = 0; face < 6; ++face)
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
      {
        const auto corner = [&](int da, int db)
        {
          std::array<int, 3> p{};
          p[face / 2] = face % 2 * n;
          // Counter-clockwise as seen from outside.
          p[(face / 2 + 1) % 3] = face % 2 ? a + da : a + db;
          p[(face / 2 + 2) % 3] = face % 2 ? b + db : b + da;
          return columnOf(p);
        };
        const std::vector<int> sides[4] = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
        for (int layer = 0; layer < layers; ++layer)
          for (int end = 0; end < 2; ++end)
            for (const std::vector<int>& side : sides)
              body.connectivity.push_back(side[layer + end]);
      }
  return body;
}

std::vector<Body> sectors(int dimension, Real inner, Real outer, Real from, Real to, int count,
                          Real length, const std::array<int, 3>& n, Real bias)
{
  demandCountable(Real(count) * nodesOfGrid(dimension, n));
  std::vector<Body> bodies;
  const std::vector<Real> radii = gradedLine(inner, outer, n[0], bias);
  const int around = count * n[1];
  for (int sector = 0; sector < count; ++sector)
    bodies.push_back(mappedGrid(dimension, n,
                                [&](int i, int j, int k)
                                {
                                  const Real r = radii[i];
                                  const int step = sector * n[1] + j;
                                  const Real degrees =
                                      (from * (around - step) + to * step) / around;
                                  const Real angle = degrees * pi / 180;
                                  return Vec3{r * std::cos(angle), r * std::sin(angle),
                                              dimension == 3 ? length * k / n[2] : 0.0};
                                }));
  return bodies;
}

std::vector<Body> barrelVault(Real inner, Real outer, Real from, Real to, int count, Real length,
                              int rows, const std::array<int, 3>& n, Real bias)
{
  demandCountable(Real(count) * (rows + 1.0) * nodesOfGrid(3, n));
  std::vector<Body> bodies;
  const int whole = n[2], end = rows * whole;
  // Grid lines of sectors as long as the vault, cut where stones end.
  const std::vector<Body> sweeps =
      sectors(3, inner, outer, from, to, count, length, {n[0], n[1], end}, bias);
  for (int sector = 0; sector < count; ++sector)
  {
    const Body& sweep = sweeps[std::size_t(sector)];
    const int layer = (n[0] + 1) * (n[1] + 1);
    std::vector<int> ends{0};
    for (int z = sector % 2 == 1 ? whole / 2 : whole; z < end; z += whole)
      ends.push_back(z);
    ends.push_back(end);
    for (std::size_t stone = 0; stone + 1 < ends.size(); ++stone)
    {
      const auto first = sweep.points.begin() + layer * ends[stone];
      bodies.push_back(mappedGrid(3, {n[0], n[1], ends[stone + 1] - ends[stone]},
                                  [&](int i, int j, int k)
                                  { return first[i + (n[0] + 1) * (j + (n[1] + 1) * k)]; }));
    }
  }
  return bodies;
}

std::vector<Body> dome(Real inner, Real outer, Real from, Real to, int courses, int count,
                       const std::array<int, 3>& n)
{
  demandCountable(Real(courses) * count * nodesOfGrid(3, n));
  std::vector<Body> bodies;
  const std::vector<Real> radii = gradedLine(inner, outer, n[0], 1);
  const int upward = courses * n[1], around = 2 * count * n[2]; // half elements round the axis
  for (int course = 0; course < courses; ++course)
    for (int stone = 0; stone < count; ++stone)
      bodies.push_back(mappedGrid(
          3, n,
          [&](int i, int j, int k)
          {
            const int step = course * n[1] + j;
            const Real elevation = (from * (upward - step) + to * step) / upward * pi / 180;
            const int turn = (2 * (stone * n[2] + k) + (course % 2) * n[2]) % around;
            const Real azimuth = 2 * pi * turn / around, level = radii[i] * std::cos(elevation);
            return Vec3{level * std::cos(azimuth), radii[i] * std::sin(elevation),
                        level * std::sin(azimuth)};
          }));
  return bodies;
}

namespace
{
/// Polar coordinates about the lowest point of a disc. A circle of radius rho about it meets the
/// disc's border under the angle asin(rho / 2 R) to the tangent; between these ends its nodes have
/// equal angles.
struct DiscCoordinates
{
  Real radius; ///< of the disc [m]

  /// Measured from the axis of symmetry, so that the mesh is symmetric to the bit.
  /// @param part of the angle between the ends, 0..1
  static Vec3 directionAt(Real leastAngle, Real part)
  {
    const Real angle = (0.5 - part) * (pi - 2 * leastAngle);
    return Vec3{std::sin(angle), std::cos(angle), 0};
  }
  Vec3 at(Real rho, Real part) const
  {
    return rho * directionAt(std::asin(rho / (2 * radius)), part);
  }
};

/// A row of elements around what there is.
/// @param arc its outer nodes, then those of the row; position: of the new nodes
void addRow(Body& body, std::vector<int>& arc, const std::function<Vec3(int)>& position)
{
  const int around = int(arc.size()) - 1;
  std::vector<int> next;
  for (int j = 0; j <= around; ++j)
  {
    next.push_back(int(body.points.size()));
    body.points.push_back(position(j));
  }
  for (int j = 0; j < around; ++j)
    body.connectivity.insert(body.connectivity.end(), {arc[j], next[j], next[j + 1], arc[j + 1]});
  arc = next;
}

/// Rows between the circle of radius `last` and the straight edge, by transfinite interpolation:
/// the ends follow the border of the disc.
void blendIntoEdge(Body& body, std::vector<int>& arc, const DiscCoordinates& disc, Real last,
                   int rows)
{
  const Real radius = disc.radius;
  const int around = int(arc.size()) - 1;
  const Real cornerDistance = std::sqrt(2.0) * radius, cornerAngle = pi / 4;
  for (int row = 1; row <= rows; ++row)
  {
    const Real rho = last * std::pow(cornerDistance / last, Real(row) / rows);
    const Real s = (rho - last) / (cornerDistance - last);
    const Vec3 chord = (1 - s) * disc.at(last, 0) + s * Vec3{radius, radius, 0};
    const Vec3 bulge = (row == rows ? Vec3{radius, radius, 0} : disc.at(rho, 0)) - chord;
    addRow(body, arc,
           [&](int j)
           {
             const Real part = Real(j) / around;
             const Vec3 ray = DiscCoordinates::directionAt(cornerAngle, part);
             const Vec3 top{j == 0        ? radius
                            : j == around ? -radius
                                          : radius * ray.x / ray.y,
                            radius, 0};
             const Vec3 straight = (1 - s) * disc.at(last, part) + s * top;
             return straight + Vec3{(1 - 2 * part) * bulge.x, bulge.y, 0};
           });
  }
}
} // namespace

Body halfDisc(Real radius, Real fine, Real fineRadius)
{
  const DiscCoordinates disc{radius};
  const int across = std::max(4, countable(2 * std::ceil(fineRadius / fine - 1e-9)));
  const RoundGrid centre(fineRadius, across, true);
  Body body = centre.body();
  for (Vec3& p : body.points)
    p = disc.at(std::hypot(p.x, p.y), std::atan2(p.y, p.x) / pi);
  std::vector<int> arc = centre.outerArc();
  const int around = int(arc.size()) - 1;

  // Rings as thick as their elements are long, up to half the radius, then blended into the edge.
  const Real last = radius / 2;
  const Real perRing = (pi - 2 * std::asin(last / (2 * radius))) / around;
  const int rings = std::max(1, int(std::lround(std::log(last / fineRadius) / perRing)));
  for (int ring = 1; ring <= rings; ++ring)
    addRow(body, arc,
           [&](int j)
           {
             return disc.at(fineRadius * std::pow(last / fineRadius, Real(ring) / rings),
                            Real(j) / around);
           });
  const int rows = std::max(1, int(std::lround(std::log(radius / last) / perRing)));
  blendIntoEdge(body, arc, disc, last, rows);
  return body;
}

Body roundNosed(Real width, Real length, int across, int along)
{
  demandCountable((Real(along) + 1) * (Real(across) + 1));
  const Real radius = width / 2;
  const RoundGrid nose(radius, across, true);
  Body body = nose.body();
  // The half disk looks up; turned by -90 degrees it looks along x, its straight edge runs from +y
  // to -y.
  for (Vec3& p : body.points)
    p = {p.y - radius, -p.x, 0};
  std::vector<int> column = nose.straightEdge();
  const std::vector<int> edge = column;
  for (int l = along - 1; l >= 0; --l)
  {
    std::vector<int> next;
    for (const int node : edge)
    {
      next.push_back(int(body.points.size()));
      body.points.push_back({-length + (length - radius) * l / along, body.points[node].y, 0});
    }
    for (int i = 0; i < across; ++i)
      body.connectivity.insert(body.connectivity.end(),
                               {next[i], next[i + 1], column[i + 1], column[i]});
    column = next;
  }
  return body;
}

Body roundBar(Real width, Real length, int across, int along)
{
  const Real radius = width / 2;
  const int nose = across / 2;
  return mappedGrid(3, {along + nose, across, across},
                    [&](int l, int i, int j)
                    {
                      const Real u = Real(2 * i - across) / across,
                                 v = Real(2 * j - across) / across;
                      const Real w = l > along ? Real(l - along) / nose : 0.0;
                      // The usual map of a cube to a ball; for w = 0 that of a square to a disk.
                      const auto ball = [](Real a, Real b, Real c)
                      { return a * std::sqrt(1 - b * b / 2 - c * c / 2 + b * b * c * c / 3); };
                      const Real x = l <= along ? -length + (length - radius) * l / along
                                                : radius * (ball(w, u, v) - 1);
                      return Vec3{x, radius * ball(u, v, w), radius * ball(v, w, u)};
                    });
}
} // namespace coplane
