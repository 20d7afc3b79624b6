#include "MendTetrahedra.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace coplane
{
namespace
{
using Face = TetrahedraWithSurfaces::Face;
using Nodes = std::array<int, 4>;

Real volumeOf(const std::array<Vec3, 4>& x)
{
  return dot(cross(x[1] - x[0], x[2] - x[0]), x[3] - x[0]) / 6;
}

Face faceOf(int a, int b, int c)
{
  Face face{a, b, c};
  std::sort(face.begin(), face.end());
  return face;
}

bool has(const Nodes& nodes, int node)
{
  return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
}

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
class Mender
{
public:
  Mender(TetrahedraWithSurfaces& mesh, const MendLimits& limits)
      : mesh_(mesh), limits_(limits), at_(mesh.points.size())
  {
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    {
      alive_.push_back(true);
      worth_.push_back(worth(mesh.tetrahedra[t].nodes));
      for (const int node : mesh.tetrahedra[t].nodes)
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
  const Nodes& nodesOf(int t) const { return mesh_.tetrahedra[std::size_t(t)].nodes; }
  std::array<Vec3, 4> cornersOf(const Nodes& n) const
  {
    return {point(n[0]), point(n[1]), point(n[2]), point(n[3])};
  }
  Real worth(const Nodes& nodes) const { return worthOf(cornersOf(nodes), limits_.size); }

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
    mesh_.tetrahedra.push_back({nodes, group});
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
        return std::make_pair(!place.exact, place.joint);
      };
      surface = rank(there) <= rank(surface) ? there : surface;
    }
    setSurface(face, surface);
  }

  void undo(std::size_t tetrahedra, std::size_t nodes)
  {
    while (alive_.size() > tetrahedra)
    {
      if (alive_.back())
        for (const int node : mesh_.tetrahedra.back().nodes)
        {
          auto& at = at_[std::size_t(node)];
          at.erase(std::find(at.begin(), at.end(), int(alive_.size()) - 1));
        }
      mesh_.tetrahedra.pop_back();
      alive_.pop_back();
      worth_.pop_back();
    }
    for (const int t : removed_)
      if (std::size_t(t) < tetrahedra)
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
    const std::size_t tetrahedra = alive_.size(), nodes = mesh_.points.size();
    removed_.clear();
    faces_.clear();
    std::vector<Real> before, after;
    const bool allowed = change();
    std::map<int, std::array<Real, 2>> volumes; // by group: now, and in all
    const auto count = [&](std::size_t t, Real sign)
    {
      const Real volume = volumeOf(cornersOf(mesh_.tetrahedra[t].nodes));
      auto& sum = volumes[mesh_.tetrahedra[t].group];
      sum[0] += sign * volume;
      sum[1] += std::abs(volume);
    };
    for (const int t : removed_)
      if (std::size_t(t) < tetrahedra)
      {
        before.push_back(std::min(limits_.worth, worth_[std::size_t(t)]));
        count(std::size_t(t), -1);
      }
    for (std::size_t t = tetrahedra; t < alive_.size(); ++t)
      if (alive_[t])
      {
        after.push_back(std::min(limits_.worth, worth_[t]));
        count(t, 1);
      }
    const bool filled = std::all_of(volumes.begin(), volumes.end(),
                                    [](const auto& sum)
                                    { return std::abs(sum.second[0]) <= 1e-9 * sum.second[1]; });
    const bool better = allowed && filled && isBetter(after, before);
    if (!better || !stays)
      undo(tetrahedra, nodes);
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
    for (const int t : around(a, b))
    {
      const auto [nodes, group] = mesh_.tetrahedra[std::size_t(t)];
      for (const int c : nodes)
        if (c != a && c != b)
          if (const int surface = surfaceAt(faceOf(a, b, c)); surface >= 0)
          {
            setSurface(faceOf(a, b, c), -1);
            setSurface(faceOf(a, middle, c), surface);
            setSurface(faceOf(middle, b, c), surface);
          }
      remove(t);
      add(with(nodes, a, middle), group);
      add(with(nodes, b, middle), group);
    }
    return middle;
  }

  int splitFace(const Face& face, const Vec3& x)
  {
    const int middle = addNode(x);
    for (const int t : around(face[0], face[1]))
      if (const auto [nodes, group] = mesh_.tetrahedra[std::size_t(t)]; has(nodes, face[2]))
      {
        remove(t);
        for (const int corner : face)
          add(with(nodes, corner, middle), group);
      }
    if (const int surface = surfaceAt(face); surface >= 0)
    {
      setSurface(face, -1);
      setSurface(faceOf(face[0], face[1], middle), surface);
      setSurface(faceOf(face[1], face[2], middle), surface);
      setSurface(faceOf(face[2], face[0], middle), surface);
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
          Face face{};
          std::size_t k = 0;
          for (const int other : nodesOf(t))
            if (other != left)
              face[k++] = other;
          std::sort(face.begin(), face.end());
          if (const int surface = surfaceAt(face); surface >= 0)
            all[face] = surface;
        }
    return all;
  }

  /// Whether a node may go to a place, for all the surfaces that it is on.
  bool mayGo(int node, const Vec3& place, const std::map<Face, int>& faces) const
  {
    for (const auto& [face, s] : faces)
    {
      const auto& surface = mesh_.surfaces[std::size_t(s)];
      const Real away = std::abs(dot(surface.normal, place - surface.point));
      if (away > (surface.exact ? 1e-9 * limits_.size : limits_.tolerance))
        return false;
    }
    return faces.empty() || norm(place - point(node)) <= limits_.reach;
  }

  /// A node becomes another one.
  bool collapse(int node, int onto)
  {
    const std::map<Face, int> faces = surfacesAt(node);
    if (!mayGo(node, point(onto), faces))
      return false;
    const auto isExact = [&](const auto& face)
    { return mesh_.surfaces[std::size_t(face.second)].exact; };
    const bool isNew = at_[std::size_t(onto)].empty();
    if (!isNew && std::any_of(faces.begin(), faces.end(), isExact) &&
        std::none_of(faces.begin(), faces.end(),
                     [&](const auto& face) {
                       return isExact(face) &&
                              std::count(face.first.begin(), face.first.end(), onto);
                     }))
      return false; // it would leave the border, or pinch it
    for (const auto& [face, surface] : faces)
      setSurface(face, -1);
    for (const auto& [face, surface] : faces)
      if (std::find(face.begin(), face.end(), onto) == face.end())
      {
        Face now = face;
        std::replace(now.begin(), now.end(), node, onto);
        std::sort(now.begin(), now.end());
        mergeSurface(now, surface);
      }
    std::vector<int> there = at_[std::size_t(node)];
    std::sort(there.begin(), there.end());
    for (const int t : there)
    {
      const auto [nodes, group] = mesh_.tetrahedra[std::size_t(t)];
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
      if (norm(normal) > 1e-3 && normals.size() < 3)
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
      std::set<int> neighbours;
      for (const int other : at_[std::size_t(node)])
        for (const int n : nodesOf(other))
          if (n != node)
            neighbours.insert(n);
      Vec3 middle{};
      for (const int n : neighbours)
        middle += (1.0 / Real(neighbours.size())) * point(n);
      std::vector<Vec3> others;
      for (const int n : nodesOf(t))
        if (n != node)
          others.push_back(point(n));
      const Vec3 normal = cross(others[1] - others[0], others[2] - others[0]);
      std::vector<Vec3> wishes{middle, point(node) + 0.3 * (middle - point(node))};
      if (norm(normal) > 0)
        for (const Real step : {-0.1, 0.1, -0.3, 0.3})
          wishes.push_back(point(node) + (step * limits_.size / norm(normal)) * normal);
      for (const Vec3& wish : wishes)
        if (const Vec3 place = allowed(node, wish); norm(place - point(node)) > 1e-3 * limits_.size)
          changes.push_back([this, node, place] { return move(node, place); });
    }
  }

  void addEdges(int t, std::vector<Change>& changes)
  {
    const Nodes n = nodesOf(t);
    constexpr int edges[6][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2},
                                 {2, 3, 0, 1}, {1, 3, 0, 2}, {1, 2, 0, 3}};
    for (int e = 0; e < 6; ++e)
    {
      const int a = n[std::size_t(edges[e][0])], b = n[std::size_t(edges[e][1])],
                c = n[std::size_t(edges[e][2])], d = n[std::size_t(edges[e][3])];
      changes.push_back([this, a, b] { return collapse(a, b); });
      changes.push_back([this, a, b] { return collapse(b, a); });
      const auto [s, r] = nearest(point(a), point(b), point(c), point(d));
      const Vec3 x = point(a) + (isWithin(s) ? s : 0.5) * (point(b) - point(a));
      std::set<int> ring;
      for (const int other : around(a, b))
        for (const int node : nodesOf(other))
          if (node != a && node != b)
            ring.insert(node);
      for (const int node : ring)
      {
        // The edge turns away, or goes through a node that is near.
        changes.push_back([this, a, b, x, node] { return collapse(splitEdge(a, b, x), node); });
        const Vec3 along = point(b) - point(a);
        const Real share = dot(point(node) - point(a), along) / dot(along, along);
        const Vec3 foot = point(a) + share * along;
        if (isWithin(share) && (node == c || node == d))
          changes.push_back(
              [this, a, b, foot, node]
              {
                const int middle = splitEdge(a, b, foot);
                return collapse(node, middle);
              });
      }
      changes.push_back([this, a, b, x] { return splitEdge(a, b, x) >= 0; });
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

  void addFaces(int t, std::vector<Change>& changes)
  {
    const Nodes n = nodesOf(t);
    for (std::size_t k = 0; k < 4; ++k)
    {
      const int top = n[k];
      const Face face = faceOf(n[(k + 1) % 4], n[(k + 2) % 4], n[(k + 3) % 4]);
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
            if (std::find(face.begin(), face.end(), node) == face.end())
              tops.insert(node);
      for (const int node : tops)
        changes.push_back([this, face, x, node] { return collapse(splitFace(face, x), node); });
    }
  }

  /// Makes the best of the changes that help a tetrahedron.
  bool improve(int t)
  {
    std::vector<Change> changes;
    addEdges(t, changes);
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
        mesh_.tetrahedra[kept++] = mesh_.tetrahedra[t];
    mesh_.tetrahedra.resize(kept);
  }

  TetrahedraWithSurfaces& mesh_;
  MendLimits limits_;
  std::vector<std::vector<int>> at_; ///< tetrahedra by node
  std::vector<bool> alive_;
  std::vector<Real> worth_;
  std::vector<int> removed_;                ///< since the attempt began
  std::vector<std::pair<Face, int>> faces_; ///< and the surfaces that faces had
};
} // namespace

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

int mendTetrahedra(TetrahedraWithSurfaces& mesh, const MendLimits& limits)
{
  return Mender(mesh, limits).mend();
}
} // namespace coplane
