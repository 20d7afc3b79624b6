#include "MendSimplices.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace coplane
{
namespace
{
template <class Nodes>
bool has(const Nodes& nodes, int node)
{
  return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
}

template <class Nodes>
Nodes sorted(Nodes nodes)
{
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

template <class Nodes>
Nodes with(Nodes nodes, int from, int to)
{
  std::replace(nodes.begin(), nodes.end(), from, to);
  return nodes;
}

/// Points of two lines nearest to each other, as shares of ab and cd.
std::pair<Real, Real> nearest(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  const Vec3 u = b - a, v = d - c, w = a - c;
  const Real uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), det = uu * vv - uv * uv;
  if (!(det > 1e-12 * uu * vv))
    return {0.5, 0.5};
  return {(uv * dot(v, w) - vv * dot(u, w)) / det, (uu * dot(v, w) - uv * dot(u, w)) / det};
}

bool isWithin(Real share)
{
  return share > 0.02 && share < 0.98;
}

/// All changes are made of three: an edge or a face is split at a point, and a node moves onto
/// another one. An edge that turns, say, is split, and the new node moves to a neighbour. What
/// makes nothing better is undone.
template <class Mesh>
class Mender
{
  static constexpr std::size_t dimension = Mesh::dimension, corners = Mesh::corners;
  using Face = typename Mesh::Face;
  using Nodes = std::array<int, corners>;
  using Corners = std::array<Vec3, corners>;

public:
  Mender(Mesh& mesh, const MendLimits& limits)
      : mesh_(mesh), limits_(limits), at_(mesh.points.size())
  {
    for (std::size_t t = 0; t < mesh.simplices.size(); ++t)
    {
      alive_.push_back(true);
      worth_.push_back(worth(mesh.simplices[t].nodes));
      for (const int node : mesh.simplices[t].nodes)
        at_[std::size_t(node)].push_back(int(t));
    }
  }

  int mend()
  {
    const int most = 20000;
    int changes = 0;
    for (bool again = true; again && changes < most;)
    {
      again = false;
      std::vector<std::pair<Real, int>> poor;
      for (std::size_t t = 0; t < alive_.size(); ++t)
        if (alive_[t] && worth_[t] < limits_.worth)
          poor.push_back({worth_[t], int(t)});
      std::sort(poor.begin(), poor.end());
      for (const auto& [worth, t] : poor)
        if (alive_[std::size_t(t)] && changes < most && improve(t))
        {
          ++changes;
          again = true;
        }
    }
    compact();
    return changes;
  }

private:
  using Change = std::function<bool()>; ///< false: not allowed

  const Vec3& point(int node) const { return mesh_.points[std::size_t(node)]; }
  const Nodes& nodesOf(int t) const { return mesh_.simplices[std::size_t(t)].nodes; }
  Corners cornersOf(const Nodes& nodes) const
  {
    Corners x;
    for (std::size_t k = 0; k < corners; ++k)
      x[k] = point(nodes[k]);
    return x;
  }
  Real worth(const Nodes& nodes) const
  {
    const Corners x = cornersOf(nodes);
    return std::copysign(worthOf(x, limits_.size), volumeOf(x));
  }
  /// The face that lies opposite to a corner.
  static Face faceWithout(const Nodes& nodes, int corner)
  {
    Face face{};
    std::size_t k = 0;
    for (const int node : nodes)
      if (node != corner)
        face[k++] = node;
    return sorted(face);
  }

  // --- what can be undone -----------------------------------------------------------------------
  void remove(int t)
  {
    alive_[std::size_t(t)] = false;
    for (const int node : nodesOf(t))
    {
      auto& at = at_[std::size_t(node)];
      at.erase(std::find(at.begin(), at.end(), t));
    }
    removed_.push_back(t);
  }

  void add(const Nodes& nodes, int group)
  {
    const int t = int(alive_.size());
    mesh_.simplices.push_back({nodes, group});
    alive_.push_back(true);
    worth_.push_back(worth(nodes));
    for (const int node : nodes)
      at_[std::size_t(node)].push_back(t);
  }

  int addNode(const Vec3& x)
  {
    mesh_.points.push_back(x);
    at_.emplace_back();
    return int(at_.size()) - 1;
  }

  int surfaceAt(const Face& face) const
  {
    const auto place = mesh_.surfaceOf.find(face);
    return place == mesh_.surfaceOf.end() ? -1 : place->second;
  }

  void setSurface(const Face& face, int surface)
  {
    const int before = surfaceAt(face);
    if (before == surface)
      return;
    faces_.push_back({face, before});
    if (surface < 0)
      mesh_.surfaceOf.erase(face);
    else
      mesh_.surfaceOf[face] = surface;
  }

  /// Where two faces become one, that of a border has the place, then that of the first joint.
  void mergeSurface(const Face& face, int surface)
  {
    if (const int there = surfaceAt(face); there >= 0)
    {
      const auto rank = [&](int s)
      {
        const auto& place = mesh_.surfaces[std::size_t(s)];
        return std::make_pair(place.border == Border::None, place.joint);
      };
      surface = rank(there) <= rank(surface) ? there : surface;
    }
    setSurface(face, surface);
  }

  void undo(std::size_t simplices, std::size_t nodes)
  {
    while (alive_.size() > simplices)
    {
      if (alive_.back())
        for (const int node : mesh_.simplices.back().nodes)
        {
          auto& at = at_[std::size_t(node)];
          at.erase(std::find(at.begin(), at.end(), int(alive_.size()) - 1));
        }
      mesh_.simplices.pop_back();
      alive_.pop_back();
      worth_.pop_back();
    }
    for (const int t : removed_)
      if (std::size_t(t) < simplices)
      {
        alive_[std::size_t(t)] = true;
        for (const int node : nodesOf(t))
          at_[std::size_t(node)].push_back(t);
      }
    for (auto change = faces_.rbegin(); change != faces_.rend(); ++change)
      if (change->second < 0)
        mesh_.surfaceOf.erase(change->first);
      else
        mesh_.surfaceOf[change->first] = change->second;
    mesh_.points.resize(nodes);
    at_.resize(nodes);
  }

  /// The least worth that a change leaves where it acts; 0 when it is not allowed or makes nothing
  /// better. It is undone unless it is to stay.
  Real attempt(const Change& change, bool stays)
  {
    const std::size_t simplices = alive_.size(), nodes = mesh_.points.size();
    removed_.clear();
    faces_.clear();
    slack_ = 0;
    std::vector<Real> before, after;
    const bool allowed = change();
    std::map<int, std::array<Real, 2>> volumes; // by group: now, and in all
    const auto count = [&](std::size_t t, Real sign)
    {
      const Real volume = volumeOf(cornersOf(mesh_.simplices[t].nodes));
      auto& sum = volumes[mesh_.simplices[t].group];
      sum[0] += sign * volume;
      sum[1] += std::abs(volume);
    };
    for (const int t : removed_)
      if (std::size_t(t) < simplices)
      {
        before.push_back(std::min(limits_.worth, worth_[std::size_t(t)]));
        count(std::size_t(t), -1);
      }
    for (std::size_t t = simplices; t < alive_.size(); ++t)
      if (alive_[t])
      {
        after.push_back(std::min(limits_.worth, worth_[t]));
        count(t, 1);
      }
    const bool filled = std::all_of(
        volumes.begin(), volumes.end(),
        [&](const auto& sum) { return std::abs(sum.second[0]) <= 1e-9 * sum.second[1] + slack_; });
    const bool better = allowed && filled && isBetter(after, before);
    if (!better || !stays)
      undo(simplices, nodes);
    return better ? std::max(1e-300, after.empty() ? limits_.worth : after.front()) : 0;
  }

  /// Whether the worst of some elements are worth more than those of others, or there are less of
  /// them. Sorts both.
  bool isBetter(std::vector<Real>& after, std::vector<Real>& before) const
  {
    std::sort(after.begin(), after.end());
    std::sort(before.begin(), before.end());
    if (!after.empty() && after.front() < std::min(before.front(), 1e-9))
      return false;
    for (std::size_t k = 0; k < before.size(); ++k)
    {
      const Real a = k < after.size() ? after[k] : limits_.worth;
      if (a < before[k] || a > before[k] + 0.01 * std::abs(before[k]))
        return a > before[k];
    }
    return false;
  }

  // --- the three changes ------------------------------------------------------------------------
  std::vector<int> around(int a, int b) const
  {
    std::vector<int> all;
    for (const int t : at_[std::size_t(a)])
      if (has(nodesOf(t), b))
        all.push_back(t);
    std::sort(all.begin(), all.end());
    return all;
  }

  int splitEdge(int a, int b, const Vec3& x)
  {
    const int middle = addNode(x);
    std::set<Face> faces; // that have the edge, or are it
    for (const int t : around(a, b))
    {
      const auto [nodes, group] = mesh_.simplices[std::size_t(t)];
      for (const int c : nodes)
        if (const Face face = faceWithout(nodes, c); has(face, a) && has(face, b))
          faces.insert(face);
      remove(t);
      add(with(nodes, a, middle), group);
      add(with(nodes, b, middle), group);
    }
    for (const Face& face : faces)
      if (const int surface = surfaceAt(face); surface >= 0)
      {
        setSurface(face, -1);
        setSurface(sorted(with(face, b, middle)), surface);
        setSurface(sorted(with(face, a, middle)), surface);
      }
    return middle;
  }

  int splitFace(const Face& face, const Vec3& x)
  {
    const int middle = addNode(x);
    for (const int t : around(face[0], face[1]))
      if (const auto [nodes, group] = mesh_.simplices[std::size_t(t)]; has(nodes, face[2]))
      {
        remove(t);
        for (const int corner : face)
          add(with(nodes, corner, middle), group);
      }
    if (const int surface = surfaceAt(face); surface >= 0)
    {
      setSurface(face, -1);
      for (const int corner : face)
        setSurface(sorted(with(face, corner, middle)), surface);
    }
    return middle;
  }

  std::map<Face, int> surfacesAt(int node) const
  {
    std::map<Face, int> all;
    for (const int t : at_[std::size_t(node)])
      for (const int left : nodesOf(t))
        if (left != node)
        {
          const Face face = faceWithout(nodesOf(t), left);
          if (const int surface = surfaceAt(face); surface >= 0)
            all[face] = surface;
        }
    return all;
  }

  bool isBorder(int surface, Border border) const
  {
    return mesh_.surfaces[std::size_t(surface)].border == border;
  }

  /// Whether a node may go to a place, for all the surfaces that it is on. @param slack by how much
  /// borders that give way may change volumes [m^3]
  bool mayGo(int node, const Vec3& place, const std::map<Face, int>& faces, Real& slack) const
  {
    const bool drawn =
        std::any_of(faces.begin(), faces.end(),
                    [&](const auto& face) { return isBorder(face.second, Border::Drawn); });
    bool gives = false;
    Real area = 0;
    for (const auto& [face, s] : faces)
    {
      const auto& surface = mesh_.surfaces[std::size_t(s)];
      const Real away = std::abs(dot(surface.normal, place - surface.point));
      const bool fixed =
          surface.border == Border::Fixed || (surface.border == Border::Wall && !drawn);
      if (away > (fixed ? 1e-9 * limits_.size : limits_.tolerance))
        return false;
      if (surface.border == Border::None)
        continue;
      gives = gives || away > 1e-9 * limits_.size;
      area += areaOf(face);
    }
    if (gives)
      slack += limits_.tolerance * area;
    return faces.empty() || norm(place - point(node)) <= limits_.reach;
  }

  Real areaOf(const Face& face) const
  {
    const Vec3 along = point(face[1]) - point(face[0]);
    if constexpr (dimension == 2)
      return norm(along);
    else
      return norm(cross(along, point(face[2]) - point(face[0]))) / 2;
  }

  std::set<int> neighboursOf(int node) const
  {
    std::set<int> neighbours;
    for (const int t : at_[std::size_t(node)])
      for (const int other : nodesOf(t))
        if (other != node)
          neighbours.insert(other);
    return neighbours;
  }

  /// Whether what is near both ends of an edge is around it: otherwise it holds something apart.
  bool isAlone(int a, int b) const
  {
    std::set<int> ring;
    for (const int t : around(a, b))
      ring.insert(nodesOf(t).begin(), nodesOf(t).end());
    const std::set<int> others = neighboursOf(b);
    for (const int node : neighboursOf(a))
      if (others.count(node) && !ring.count(node))
        return false;
    return true;
  }

  /// A node becomes another one.
  bool collapse(int node, int onto)
  {
    const std::map<Face, int> faces = surfacesAt(node);
    Real slack = 0;
    if (!mayGo(node, point(onto), faces, slack))
      return false;
    const auto isExact = [&](const auto& face) { return !isBorder(face.second, Border::None); };
    const bool isNew = at_[std::size_t(onto)].empty();
    if (slack > 0 && !isNew && !isAlone(node, onto))
      return false;
    slack_ += slack;
    if (!isNew && std::any_of(faces.begin(), faces.end(), isExact) &&
        std::none_of(faces.begin(), faces.end(),
                     [&](const auto& face) { return isExact(face) && has(face.first, onto); }))
      return false; // it would leave the border, or pinch it
    for (const auto& [face, surface] : faces)
      setSurface(face, -1);
    for (const auto& [face, surface] : faces)
      if (!has(face, onto))
        mergeSurface(sorted(with(face, node, onto)), surface);
    std::vector<int> there = at_[std::size_t(node)];
    std::sort(there.begin(), there.end());
    for (const int t : there)
    {
      const auto [nodes, group] = mesh_.simplices[std::size_t(t)];
      remove(t);
      if (!has(nodes, onto))
        add(with(nodes, node, onto), group);
    }
    return true;
  }

  bool move(int node, const Vec3& place) { return collapse(node, addNode(place)); }

  // --- what can be tried ------------------------------------------------------------------------
  /// The place as near to the wish as the surfaces of the node allow.
  Vec3 allowed(int node, Vec3 wish) const
  {
    std::set<int> surfaces;
    for (const auto& [face, surface] : surfacesAt(node))
      surfaces.insert(surface);
    std::vector<Vec3> normals; // orthonormal
    for (const int s : surfaces)
    {
      Vec3 normal = mesh_.surfaces[std::size_t(s)].normal;
      for (const Vec3& other : normals)
        normal = normal - dot(normal, other) * other;
      if (norm(normal) > 1e-3 && normals.size() < dimension)
        normals.push_back(normalised(normal));
    }
    Vec3 way = wish - point(node);
    for (const Vec3& normal : normals)
      way = way - dot(way, normal) * normal;
    return point(node) + way;
  }

  void addMoves(int t, std::vector<Change>& changes)
  {
    for (const int node : nodesOf(t))
    {
      const std::set<int> neighbours = neighboursOf(node);
      Vec3 middle{};
      for (const int n : neighbours)
        middle += (1.0 / Real(neighbours.size())) * point(n);
      std::vector<Vec3> others;
      for (const int n : nodesOf(t))
        if (n != node)
          others.push_back(point(n));
      const Vec3 along = others[1] - others[0];
      Vec3 normal{-along.y, along.x, 0};
      if constexpr (dimension == 3)
        normal = cross(along, others[2] - others[0]);
      std::vector<Vec3> wishes{middle, point(node) + 0.3 * (middle - point(node))};
      if (norm(normal) > 0)
        for (const Real step : {-0.1, 0.1, -0.3, 0.3})
          wishes.push_back(point(node) + (step * limits_.size / norm(normal)) * normal);
      for (const Vec3& wish : wishes)
        if (const Vec3 place = allowed(node, wish); norm(place - point(node)) > 1e-3 * limits_.size)
          changes.push_back([this, node, place] { return move(node, place); });
    }
  }

  /// The place on an edge nearest to a node, as a share of it.
  Real shareOf(int a, int b, int node) const
  {
    const Vec3 along = point(b) - point(a);
    return dot(point(node) - point(a), along) / dot(along, along);
  }

  /// An edge becomes a point, turns away, or goes through a node that is near.
  void addEdge(int a, int b, const Vec3& x, const std::array<int, dimension - 1>& near,
               std::vector<Change>& changes)
  {
    changes.push_back([this, a, b] { return collapse(a, b); });
    changes.push_back([this, a, b] { return collapse(b, a); });
    std::set<int> ring;
    for (const int other : around(a, b))
      for (const int node : nodesOf(other))
        if (node != a && node != b)
          ring.insert(node);
    for (const int node : ring)
    {
      changes.push_back([this, a, b, x, node] { return collapse(splitEdge(a, b, x), node); });
      const Real share = shareOf(a, b, node);
      const Vec3 foot = point(a) + share * (point(b) - point(a));
      if (isWithin(share) && has(near, node))
        changes.push_back(
            [this, a, b, foot, node]
            {
              const int middle = splitEdge(a, b, foot);
              return collapse(node, middle);
            });
    }
    changes.push_back([this, a, b, x] { return splitEdge(a, b, x) >= 0; });
  }

  void addEdges(int t, std::vector<Change>& changes)
  {
    const Nodes n = nodesOf(t);
    if constexpr (dimension == 2)
      for (std::size_t k = 0; k < 3; ++k)
      {
        const int a = n[k], b = n[(k + 1) % 3], c = n[(k + 2) % 3];
        const Real share = shareOf(a, b, c);
        const Vec3 x = point(a) + (isWithin(share) ? share : 0.5) * (point(b) - point(a));
        addEdge(a, b, x, {c}, changes);
      }
    else
    {
      constexpr std::size_t edges[6][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2},
                                           {2, 3, 0, 1}, {1, 3, 0, 2}, {1, 2, 0, 3}};
      for (const auto& edge : edges)
      {
        const int a = n[edge[0]], b = n[edge[1]], c = n[edge[2]], d = n[edge[3]];
        const auto [s, r] = nearest(point(a), point(b), point(c), point(d));
        const Vec3 x = point(a) + (isWithin(s) ? s : 0.5) * (point(b) - point(a));
        addEdge(a, b, x, {c, d}, changes);
        changes.push_back(
            [this, a, b, c, d, x]
            {
              const int middle = splitEdge(a, b, x);
              return collapse(c, middle) && collapse(d, middle);
            });
        if (isWithin(s) && isWithin(r))
        {
          const Vec3 y = point(c) + r * (point(d) - point(c));
          changes.push_back(
              [this, a, b, c, d, x, y]
              {
                const int onto = splitEdge(a, b, x);
                return collapse(splitEdge(c, d, y), onto);
              });
        }
      }
    }
  }

  void addFaces(int t, std::vector<Change>& changes)
  {
    const Nodes n = nodesOf(t);
    for (std::size_t k = 0; k < 4; ++k)
    {
      const int top = n[k];
      const Face face = faceWithout(n, top);
      const Vec3 a = point(face[0]), b = point(face[1]), c = point(face[2]);
      const Vec3 normal = cross(b - a, c - a);
      const Real square = dot(normal, normal);
      if (!(square > 0))
        continue;
      const Vec3 foot = point(top) - (dot(point(top) - a, normal) / square) * normal;
      const auto share = [&](const Vec3& p, const Vec3& q)
      { return dot(cross(p - foot, q - foot), normal) / square; };
      const bool inside = share(a, b) > 0.02 && share(b, c) > 0.02 && share(c, a) > 0.02;
      const Vec3 x = inside ? foot : (1.0 / 3) * (a + b + c);
      if (inside)
        changes.push_back(
            [this, face, x, top]
            {
              const int middle = splitFace(face, x);
              return collapse(top, middle);
            });
      std::set<int> tops;
      for (const int other : around(face[0], face[1]))
        if (has(nodesOf(other), face[2]))
          for (const int node : nodesOf(other))
            if (!has(face, node))
              tops.insert(node);
      for (const int node : tops)
        changes.push_back([this, face, x, node] { return collapse(splitFace(face, x), node); });
    }
  }

  /// Makes the best of the changes that help a simplex.
  bool improve(int t)
  {
    std::vector<Change> changes;
    addEdges(t, changes);
    if constexpr (dimension == 3)
      addFaces(t, changes);
    addMoves(t, changes);
    Real best = 0;
    const Change* chosen = nullptr;
    for (const Change& change : changes)
      if (const Real after = attempt(change, false); after > best)
      {
        best = after;
        chosen = &change;
      }
    return chosen && attempt(*chosen, true) > 0;
  }

  void compact()
  {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < alive_.size(); ++t)
      if (alive_[t])
        mesh_.simplices[kept++] = mesh_.simplices[t];
    mesh_.simplices.resize(kept);
  }

  Mesh& mesh_;
  MendLimits limits_;
  std::vector<std::vector<int>> at_; ///< simplices by node
  std::vector<bool> alive_;
  std::vector<Real> worth_;
  std::vector<int> removed_;                ///< since the attempt began
  Real slack_ = 0;                          ///< of volumes, since then [m^3]
  std::vector<std::pair<Face, int>> faces_; ///< and the surfaces that faces had
};
} // namespace

Real volumeOf(const std::array<Vec3, 3>& x)
{
  return cross(x[1] - x[0], x[2] - x[0]).z / 2;
}

Real volumeOf(const std::array<Vec3, 4>& x)
{
  return dot(cross(x[1] - x[0], x[2] - x[0]), x[3] - x[0]) / 6;
}

Real worthOf(const std::array<Vec3, 4>& x, Real size)
{
  const Real volume = 6 * volumeOf(x);
  Real most = 0, widest = 0;
  for (std::size_t k = 0; k < 4; ++k)
  {
    const Vec3 a = x[(k + 1) % 4] - x[k], b = x[(k + 2) % 4] - x[k], c = x[(k + 3) % 4] - x[k];
    most = std::max(most, norm(a) * norm(b) * norm(c));
    widest = std::max(widest, norm(cross(x[(k + 2) % 4] - x[(k + 1) % 4], c - a)));
  }
  if (!(most > 0 && widest > 0))
    return 0;
  return std::min(std::sqrt(2.0) * volume / most, volume / widest / (std::sqrt(2.0 / 3) * size));
}

Real worthOf(const std::array<Vec3, 3>& x, Real size)
{
  const Real a = norm(x[1] - x[0]), b = norm(x[2] - x[1]), c = norm(x[0] - x[2]);
  const Real longest = std::max({a, b, c}), shortest = std::min({a, b, c});
  const Real area = norm(cross(x[1] - x[0], x[2] - x[0])), regular = std::sqrt(0.75);
  if (!(shortest > 0))
    return 0;
  return std::min(area * shortest / (a * b * c), area / longest / size) / regular;
}

int mend(TrianglesWithSurfaces& mesh, const MendLimits& limits)
{
  return Mender(mesh, limits).mend();
}

int mend(TetrahedraWithSurfaces& mesh, const MendLimits& limits)
{
  return Mender(mesh, limits).mend();
}
} // namespace coplane
