#include "Shapes.hpp"

#include <cmath>

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
    body_.dimension = 2;
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

Body mappedGrid(int dimension, const std::array<int, 3>& n,
                const std::function<Vec3(int, int, int)>& position)
{
  Body body;
  body.dimension = dimension;
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

std::vector<Body> runningBond(int dimension, const Vec3& brick, int courses, int bricks,
                              const std::array<int, 3>& n)
{
  std::vector<Body> bodies;
  for (int course = 0; course < courses; ++course)
  {
    const bool shifted = course % 2 == 1;
    for (int b = 0; b < (shifted ? bricks + 1 : bricks); ++b)
    {
      // Positions count in elements of the whole wall, so that touching bricks compute the same
      // coordinates.
      const bool isHalf = shifted && (b == 0 || b == bricks);
      const int first = shifted ? std::max(0, b * n[0] - n[0] / 2) : b * n[0];
      bodies.push_back(mappedGrid(dimension, {isHalf ? n[0] / 2 : n[0], n[1], n[2]},
                                  [&](int i, int j, int k)
                                  {
                                    return Vec3{brick.x * (first + i) / n[0],
                                                brick.y * (course * n[1] + j) / n[1],
                                                dimension == 3 ? brick.z * k / n[2] : 0.0};
                                  }));
    }
  }
  return bodies;
}

std::vector<Body> imbricate(Real thickness, Real length, int layers, int bricks,
                            const std::array<int, 3>& n)
{
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

Body roundNosed(Real width, Real length, int across, int along)
{
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
