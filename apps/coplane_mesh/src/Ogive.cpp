#include "Ogive.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace coplane
{
namespace
{
/// Corners of the nose: middle of its base, rim of the base (along x, along z), tip.
enum Corner
{
  middle,
  rimX,
  tip,
  rimZ, // three dimensions only
};
/// Shares of the corners in a point; their sum is 1.
using Shares = std::array<Real, 4>;

/// One nose, and the map of the simplex of its corners onto it.
class Nose
{
public:
  Nose(Real width, Real caliber)
      : radius_(width / 2), bend_(caliber * width), length_(ogiveLength(width, caliber)),
        turn_(std::asin(length_ / bend_))
  {
  }

  Vec3 operator()(const Shares& share) const
  {
    const Real scale = 1 - share[middle];
    if (scale < tiny)
      return {0, length_, 0};
    // The outer face of the simplex onto the ogive: height along the arc, angle about the axis;
    // then everything in proportion towards the middle of the base.
    const Real angle = turn_ * share[tip] / scale;
    // Points on the axis and in the planes of a quarter lie there to the bit.
    const Real r = std::max(0.0, radius_ - bend_ * (1 - std::cos(angle)));
    const Real y = length_ - bend_ * std::sin(angle);
    const Real rim = share[rimX] + share[rimZ];
    const Real about = rim < tiny ? 0 : pi / 2 * share[rimZ] / rim;
    return {share[rimX] < tiny ? 0 : scale * r * std::cos(about), length_ + scale * (y - length_),
            share[rimZ] < tiny ? 0 : scale * r * std::sin(about)};
  }

private:
  static constexpr Real tiny = 1e-12; // of shares, sums of a few fractions
  Real radius_, bend_, length_, turn_;
};

/// Puts grids together: nodes in one place become one.
class Grids
{
public:
  explicit Grids(int dimension, Real size) : dimension_(dimension), grain_(1e-9 * size)
  {
    body_.type = dimension == 3 ? ElementType::Hex8 : ElementType::Quad4;
  }

  /// Right-handed or left-handed: the elements are turned round where needed.
  void add(const std::array<int, 3>& n, const std::function<Vec3(int, int, int)>& position)
  {
    const Body grid = mappedGrid(dimension_, n, position);
    const int perElement = topology(grid.type).nodes;
    const auto corner = [&](int k) { return grid.points[grid.connectivity[k]]; };
    const Vec3 a = corner(1) - corner(0), b = corner(3) - corner(0);
    const Vec3 c = dimension_ == 3 ? corner(4) - corner(0) : Vec3{0, 0, 1};
    const bool leftHanded = dot(cross(a, b), c) < 0;
    static const int turned[8] = {0, 3, 2, 1, 4, 7, 6, 5};
    for (int e = 0; e < grid.elements(); ++e)
      for (int k = 0; k < perElement; ++k)
      {
        const int own = leftHanded ? turned[k] : k;
        body_.connectivity.push_back(nodeAt(grid.points[grid.connectivity[e * perElement + own]]));
      }
  }
  const Body& body() const { return body_; }

private:
  int nodeAt(const Vec3& x)
  {
    const auto cell = [&](Real a) { return std::llround(a / grain_); };
    const std::array<long long, 3> key{cell(x.x), cell(x.y), cell(x.z)};
    const auto [place, isNew] = nodes_.emplace(key, int(body_.points.size()));
    if (isNew)
      body_.points.push_back(x);
    return place->second;
  }

  int dimension_;
  Real grain_;
  Body body_;
  std::map<std::array<long long, 3>, int> nodes_;
};

/// Position in the part of a simplex that belongs to the corner `own`. An edge to another corner i
/// has weight[i] elements on the side of `own`, so its parts end where the shares are in proportion
/// to weights: in the middles of edges, of faces and of the simplex.
Shares sharesAt(int own, const std::vector<int>& others, const std::array<int, 4>& weight,
                const std::array<int, 3>& index)
{
  Shares sum{};
  const int subsets = 1 << others.size();
  for (int subset = 0; subset < subsets; ++subset)
  {
    Real factor = 1, total = weight[own];
    for (std::size_t k = 0; k < others.size(); ++k)
    {
      const Real along = Real(index[k]) / weight[others[k]];
      const bool in = subset >> k & 1;
      factor *= in ? along : 1 - along;
      total += in ? weight[others[k]] : 0;
    }
    sum[own] += factor * weight[own] / total;
    for (std::size_t k = 0; k < others.size(); ++k)
      if (subset >> k & 1)
        sum[others[k]] += factor * weight[others[k]] / total;
  }
  return sum;
}
} // namespace

Real ogiveLength(Real width, Real caliber)
{
  return width * std::sqrt(caliber - 0.25);
}

Body ogiveNosed(int dimension, Real width, Real caliber, Real length, int across, int nose,
                int along)
{
  const Nose shape(width, caliber);
  const Real noseLength = ogiveLength(width, caliber);
  // Of the across / 2 elements on a radius of the base, those on the side of the rim are as many as
  // the weight of the middle.
  const int half = across / 2;
  std::array<int, 4> weight{};
  weight[middle] = half / 2;
  weight[rimX] = weight[rimZ] = half - half / 2;
  weight[tip] = nose - half / 2;
  std::vector<int> corners{middle, rimX, tip};
  if (dimension == 3)
    corners.push_back(rimZ);

  Grids grids(dimension, width);
  for (const int own : corners)
  {
    std::vector<int> others, rims;
    for (const int corner : corners)
      if (corner != own)
      {
        others.push_back(corner);
        if (corner != tip)
          rims.push_back(corner);
      }
    std::array<int, 3> n{1, 1, 1};
    for (std::size_t k = 0; k < others.size(); ++k)
      n[k] = weight[others[k]];
    grids.add(n,
              [&](int i, int j, int k) {
                return shape(sharesAt(own, others, weight, {i, j, dimension == 3 ? k : 0}));
              });
    if (own == tip)
      continue;
    // The shank: the same parts of the base, swept along the axis.
    const Real shank = length - noseLength;
    std::array<int, 3> m{weight[rims[0]], along, 1};
    if (dimension == 3)
      m[2] = weight[rims[1]];
    grids.add(m,
              [&](int i, int j, int k)
              {
                Vec3 x = shape(sharesAt(own, rims, weight, {i, dimension == 3 ? k : 0, 0}));
                x.y = noseLength + shank * j / along;
                return x;
              });
  }
  return grids.body();
}
} // namespace coplane
