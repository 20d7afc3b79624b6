#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/Debris.hpp>
#include <coplane_dynamics/detail/NearestOnFace.hpp>
#include <coplane_mesh/PointInElement.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

namespace coplane
{
namespace
{
/// Stiffness of a point's contact over that of the element behind the face, modulus times length,
/// and less in proportion where the point is lighter than the element: so the step need not be
/// smaller than for the elements. A point that comes at a tenth of the speed of waves is stopped
/// within a seventh of the element [-].
constexpr Real stiffnessOfElement = 0.5;

/// A point comes no deeper in a step than this part of its way; what is more is that the way out
/// has changed [-].
constexpr Real ofItsWay = 1.1;

/// Another body that is as near to a face as this part of the element there lies on it [-].
constexpr Real besideTheSurface = 0.01;

/// Where that is asked, apart from the place in question: at the corners, this part of the way to
/// them from the middle [-].
constexpr Real nearlyAtTheCorner = 0.9;

/// Points at the surface of an element, or in a mirror, are in there, whatever rounding does; over
/// the distance from the origin [-].
constexpr Real roundOff = 1e-12;

/// What a checkpoint has of a point.
constexpr std::size_t numbersOfPoint = 6;

/// Points sorted into cubes, so that those in a box are found without asking all.
class PointGrid
{
public:
  PointGrid(const std::vector<Vec3>& points, Real edge) : points_(&points), edge_(edge)
  {
    for (int i = 0; i < int(points.size()); ++i)
      entries_.emplace_back(cubeOf(points[std::size_t(i)]), i);
    std::sort(entries_.begin(), entries_.end());
  }

  /// Calls f(point) for all points in a box.
  template <class F>
  void forEachIn(const Vec3& low, const Vec3& high, const F& f) const
  {
    const Cube first = cubeOf(low), last = cubeOf(high);
    for (std::int64_t i = first[0]; i <= last[0]; ++i)
      for (std::int64_t j = first[1]; j <= last[1]; ++j)
      {
        // Cubes along z stand together.
        auto at = std::lower_bound(entries_.begin(), entries_.end(),
                                   std::make_pair(Cube{i, j, first[2]}, 0));
        for (; at != entries_.end() && at->first <= Cube{i, j, last[2]}; ++at)
        {
          const Vec3& x = (*points_)[std::size_t(at->second)];
          bool within = true;
          for (int c = 0; c < 3; ++c)
            within = within && x[c] >= low[c] && x[c] <= high[c];
          if (within)
            f(at->second);
        }
      }
  }

private:
  using Cube = std::array<std::int64_t, 3>;
  Cube cubeOf(const Vec3& x) const
  {
    constexpr Real farthest = 1e15; // points that fly away for ever
    Cube cube;
    for (int c = 0; c < 3; ++c)
      cube[std::size_t(c)] =
          std::int64_t(std::clamp(std::floor(x[c] / edge_), -farthest, farthest));
    return cube;
  }

  const std::vector<Vec3>* points_;
  Real edge_;
  std::vector<std::pair<Cube, int>> entries_;
};

struct Corners
{
  int count = 0;
  std::array<Vec3, 8> x{};
  Vec3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
  Real longestSide() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
};

/// Of an ExteriorFace the element behind it, or an element.
template <class Place>
Corners cornersOf(const Place& place, const RankMesh& mesh, const NodeVectors& x)
{
  const RankMesh::Block& part = mesh.blocks[std::size_t(place.block)];
  Corners corners;
  corners.count = topology(part.type).nodes;
  for (int k = 0; k < corners.count; ++k)
  {
    const Vec3 corner = at(x, part.connectivity[std::size_t(place.element * corners.count + k)]);
    corners.x[std::size_t(k)] = corner;
    for (int c = 0; c < 3; ++c)
    {
      corners.low[c] = std::min(corners.low[c], corner[c]);
      corners.high[c] = std::max(corners.high[c], corner[c]);
    }
  }
  return corners;
}

/// Along the normal of a face of an element, out of it; of length 1, or 0 where it has no area.
Vec3 outwardOf(const Corners& element, int count, const Vec3* c)
{
  Vec3 inside, middle;
  for (int k = 0; k < element.count; ++k)
    inside += (1.0 / element.count) * element.x[std::size_t(k)];
  for (int k = 0; k < count; ++k)
    middle += (1.0 / count) * c[k];
  Vec3 normal = count == 2   ? cross(c[1] - c[0], Vec3{0, 0, 1})
                : count == 3 ? cross(c[1] - c[0], c[2] - c[0])
                             : cross(c[2] - c[0], c[3] - c[1]);
  if (dot(normal, middle - inside) < 0)
    normal = -normal;
  const Real length = norm(normal);
  return length > 0 ? (1 / length) * normal : Vec3{};
}

/// Places a little beyond a face, over all of it: near its corners and beside one on it.
std::array<Vec3, 5> placesBeyond(const Corners& element, int count, const Vec3* c,
                                 const Vec3& place)
{
  Vec3 middle;
  for (int k = 0; k < count; ++k)
    middle += (1.0 / count) * c[k];
  const Vec3 off = (besideTheSurface * element.longestSide()) * outwardOf(element, count, c);
  std::array<Vec3, 5> places;
  for (int k = 0; k < 4; ++k)
    places[std::size_t(k)] = middle + nearlyAtTheCorner * (c[k < count ? k : 0] - middle) + off;
  places[4] = place + (1 - nearlyAtTheCorner) * (middle - place) + off;
  return places;
}

std::uint64_t bitsOf(Real value)
{
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}
} // namespace

namespace
{
/// Stiffness of the contact of a point as heavy as the element behind the face, or heavier [N/m].
Real stiffnessOf(const ExteriorFace& face, const RankMesh& mesh, const ElementForces& elements,
                 bool ofRevolution)
{
  const ElementBlock& block = elements.blocks()[std::size_t(face.block)];
  Real length = 1; // thickness
  if (mesh.dimension == 3)
    length = block.referenceLength()(face.element);
  else if (ofRevolution)
  {
    length = 0;
    for (int k = 0; k < face.nodeCount; ++k)
      length +=
          2 * pi / face.nodeCount * mesh.coordinates[std::size_t(face.nodes[std::size_t(k)])].x;
  }
  return stiffnessOfElement * pWaveModulus(block.material()) * length;
}
} // namespace

void Debris::renew(const std::vector<FreeNode>& mine, std::vector<ExteriorFace> exterior,
                   const Mirrors& mirrors, const std::vector<int>& bodyOfNode, const RankMesh& mesh,
                   const ElementForces& elements, const NodeLayout& layout)
{
  // The owner of a node at the surface has the face there and all elements of the node.
  std::vector<char> isAtSurface(std::size_t(mesh.nodes()), 0);
  for (const ExteriorFace& face : exterior)
    for (int k = 0; k < face.nodeCount; ++k)
      isAtSurface[std::size_t(face.nodes[std::size_t(k)])] = 1;
  near_.clear();
  for (int b = 0; b < int(mesh.blocks.size()); ++b)
  {
    const RankMesh::Block& part = mesh.blocks[std::size_t(b)];
    const int corners = topology(part.type).nodes;
    for (int e = 0; e < part.elements(); ++e)
    {
      const int* const nodes = &part.connectivity[std::size_t(e * corners)];
      if (elements.blocks()[std::size_t(b)].isAlive(e) &&
          std::any_of(nodes, nodes + corners, [&](int n) { return isAtSurface[std::size_t(n)]; }))
        near_.push_back({b, e, bodyOfNode[std::size_t(nodes[0])]});
    }
  }
  exterior.erase(std::remove_if(exterior.begin(), exterior.end(),
                                [&](const ExteriorFace& face)
                                { return mirrors.leadsNowhere(face); }),
                 exterior.end());
  faces_ = std::move(exterior);
  mirrors_ = mirrors.all;
  bodies_.clear();
  std::vector<Real> most{0, 0};
  for (const ExteriorFace& face : faces_)
  {
    bodies_.push_back(bodyOfNode[std::size_t(face.nodes[0])]);
    const Real stiffness = stiffnessOf(face, mesh, elements, ofRevolution_);
    most[0] = std::max(most[0], stiffness);
    most[1] = std::max(most[1],
                       stiffness / elements.blocks()[std::size_t(face.block)].mass(face.element));
  }
  comm_->max(most);
  stiffest_ = most[0];
  stiffestPerMass_ = most[1];
  std::vector<FreeNode> nodes = comm_->allGather(mine);
  std::sort(nodes.begin(), nodes.end(),
            [](const FreeNode& a, const FreeNode& b) { return a.id < b.id; });
  const std::vector<Point> before = std::move(points_);
  points_.clear();
  for (const auto& [id, mass, share] : nodes)
  {
    Point point;
    point.id = id;
    point.mass = mass;
    point.share = share;
    const int node = layout.localNode(id);
    point.node = node < layout.owned() ? node : -1;
    const auto known =
        std::lower_bound(before.begin(), before.end(), id,
                         [](const Point& p, GlobalId wanted) { return p.id < wanted; });
    // Of a point that was in no such element nobody knows how deep it lies in faces laid bare now.
    if (known != before.end() && known->id == id && known->inside)
    {
      point.offset = known->offset;
      point.distance = known->distance;
      point.speed = known->speed;
      point.between = known->between;
      point.inside = true;
    }
    points_.push_back(point);
  }
}

/// What a field of nodes has at the points. One rank has a point, the others add zeros: whole
/// numbers have no rounding.
std::vector<Vec3> Debris::ofPoints(const NodeVectors& field) const
{
  std::vector<std::uint64_t> bits(3 * points_.size(), 0);
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (points_[i].node >= 0)
      for (int c = 0; c < 3; ++c)
        bits[3 * i + std::size_t(c)] = bitsOf(field(points_[i].node, c));
  comm_->sum(bits);
  std::vector<Vec3> x(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i)
    for (int c = 0; c < 3; ++c)
      std::memcpy(&x[i][c], &bits[3 * i + std::size_t(c)], sizeof(Real));
  return x;
}

/// On the side of mirrors on which bodies are. Collective.
std::vector<Vec3> Debris::placesOfPoints(const NodalState& state)
{
  std::vector<Vec3> x = ofPoints(state.x);
  for (std::size_t i = 0; i < points_.size(); ++i)
    points_[i].image = reflectInto(mirrors_, roundOff, x[i]);
  return x;
}

/// Longest side of the boxes of this rank's elements at the surface [m].
Real Debris::longestElement(const RankMesh& mesh, const NodalState& state) const
{
  Real longest = 0;
  for (const NearSurface& element : near_)
    longest = std::max(longest, cornersOf(element, mesh, state.x).longestSide());
  return longest;
}

/// Points in elements at the surface, each once, with the body of the lowest element there.
std::vector<Debris::Inside> Debris::findInside(const std::vector<Vec3>& x, const RankMesh& mesh,
                                               const NodalState& state) const
{
  struct Found
  {
    int point, body;
    GlobalId element;
  };
  const Real edge = longestElement(mesh, state);
  std::vector<Found> mine;
  if (edge > 0 && std::isfinite(edge))
  {
    const PointGrid grid(x, edge);
    for (const NearSurface& element : near_)
    {
      const Corners corners = cornersOf(element, mesh, state.x);
      const RankMesh::Block& part = mesh.blocks[std::size_t(element.block)];
      const Real hair = roundOff * (norm(corners.low) + norm(corners.high));
      const Vec3 margin{hair, hair, hair};
      grid.forEachIn(
          corners.low - margin, corners.high + margin,
          [&](int point)
          {
            if (pointInElement(part.type, corners.x.data(), x[std::size_t(point)]).outside <=
                hair / corners.longestSide())
              mine.push_back({point, element.body, part.elementIds[std::size_t(element.element)]});
          });
    }
  }
  std::vector<Found> all = comm_->allGather(mine);
  std::sort(all.begin(), all.end(),
            [](const Found& a, const Found& b)
            { return std::tie(a.point, a.element) < std::tie(b.point, b.element); });
  std::vector<Inside> inside;
  for (const Found& found : all)
    if (inside.empty() || inside.back().point != found.point)
      inside.push_back({found.point, found.body});
  return inside;
}

/// The faces beside which points lie that are in bodies: those of these bodies, and others that
/// look away from the point; by point, the nearest first.
std::vector<Debris::WayOut> Debris::facesBeside(const std::vector<Inside>& inside,
                                                const std::vector<Vec3>& x, const RankMesh& mesh,
                                                const ElementForces& elements,
                                                const NodalState& state) const
{
  std::vector<WayOut> beside;
  std::vector<Vec3> places;
  for (const Inside& one : inside)
    places.push_back(x[std::size_t(one.point)]);
  const std::vector<Vec3> v = ofPoints(state.v);
  const Real edge = longestElement(mesh, state);
  if (!(edge > 0 && std::isfinite(edge)))
    return beside;
  const PointGrid grid(places, edge);
  for (std::size_t f = 0; f < faces_.size(); ++f)
  {
    const ExteriorFace& face = faces_[f];
    const Corners corners = cornersOf(face, mesh, state.x);
    const Real reach = 2 * corners.longestSide(); // also into the element beside the one behind
    const Vec3 margin{reach, reach, reach};
    std::array<Vec3, 4> c{};
    for (int k = 0; k < face.nodeCount; ++k)
      c[std::size_t(k)] = at(state.x, face.nodes[std::size_t(k)]);
    const auto look = [&](int i)
    {
      const Inside& one = inside[std::size_t(i)];
      const NearestOnFace nearest = nearestOnFace(face.nodeCount, c.data(), places[std::size_t(i)]);
      WayOut way;
      way.point = one.point;
      way.body = bodies_[f];
      way.count = face.nodeCount;
      way.face = face.id;
      way.distance = norm(nearest.way);
      if (!std::isfinite(way.distance) ||
          (way.body != one.body &&
           !(dot(outwardOf(corners, face.nodeCount, c.data()), nearest.way) > 0)))
        return;
      way.outward = way.distance > 0 ? (1 / way.distance) * nearest.way : Vec3{};
      way.beyond =
          placesBeyond(corners, face.nodeCount, c.data(), places[std::size_t(i)] + nearest.way);
      way.weights = nearest.weights;
      Vec3 apart = points_[std::size_t(one.point)].image.of(v[std::size_t(one.point)]);
      for (int k = 0; k < face.nodeCount; ++k)
        apart = apart - nearest.weights[std::size_t(k)] * at(state.v, face.nodes[std::size_t(k)]);
      way.speed = norm(apart);
      const Real heavy = elements.blocks()[std::size_t(face.block)].mass(face.element);
      way.stiffness = stiffnessOf(face, mesh, elements, ofRevolution_) *
                      std::min(points_[std::size_t(one.point)].share,
                               points_[std::size_t(one.point)].mass / heavy);
      beside.push_back(way);
    };
    grid.forEachIn(corners.low - margin, corners.high + margin, look);
  }
  std::sort(beside.begin(), beside.end());
  return beside;
}

/// Which of these ways out end at other bodies that lie on the whole face. Collective.
std::vector<char> Debris::areCovered(const std::vector<WayOut>& ways, const RankMesh& mesh,
                                     const NodalState& state) const
{
  std::vector<Vec3> places;
  for (const WayOut& way : ways)
    places.insert(places.end(), way.beyond.begin(), way.beyond.end());
  const std::size_t each = ways.empty() ? 1 : ways.front().beyond.size();
  std::vector<std::uint64_t> taken(places.size(), 0);
  const Real edge = longestElement(mesh, state);
  if (edge > 0 && std::isfinite(edge))
  {
    const PointGrid grid(places, edge);
    for (const NearSurface& element : near_)
    {
      const Corners corners = cornersOf(element, mesh, state.x);
      const ElementType type = mesh.blocks[std::size_t(element.block)].type;
      grid.forEachIn(corners.low, corners.high,
                     [&](int i)
                     {
                       const Vec3& place = places[std::size_t(i)];
                       if (element.body != ways[std::size_t(i) / each].body &&
                           pointInElement(type, corners.x.data(), place).outside <= 0)
                         taken[std::size_t(i)] = 1;
                     });
    }
  }
  comm_->sum(taken);
  std::vector<char> covered;
  for (std::size_t w = 0; w < ways.size(); ++w)
    covered.push_back(std::all_of(taken.begin() + long(w * each),
                                  taken.begin() + long((w + 1) * each),
                                  [](std::uint64_t count) { return count > 0; }));
  return covered;
}

/// For each of these points the nearest face of its body, and the nearest over which it can leave,
/// if there is one: faces on which other bodies lie lead nowhere, but behind them faces of these
/// bodies may lead out. Points that have come in over such a face, between two bodies, leave by it.
/// Collective.
std::vector<Debris::WaysOut> Debris::findWaysOut(const std::vector<Inside>& inside,
                                                 const std::vector<Vec3>& x, const RankMesh& mesh,
                                                 const ElementForces& elements,
                                                 const NodalState& state) const
{
  if (inside.empty()) // on all ranks
    return {};
  // Of points in the middle between faces all of them count, so that what is symmetric stays so.
  constexpr Real roundOff = 1 + 1e-9;
  const auto keepNearest = [](std::vector<WayOut>& ways)
  {
    std::vector<WayOut> kept;
    Real first = 0;
    for (const WayOut& way : ways)
    {
      const bool isNew = kept.empty() || kept.back().point != way.point;
      if (isNew)
        first = way.distance;
      if (isNew || (way.distance <= roundOff * first && way.face != kept.back().face))
        kept.push_back(way);
    }
    ways = kept;
  };
  const std::vector<WayOut> beside = facesBeside(inside, x, mesh, elements, state);
  const auto isOwn = [&](const WayOut& way)
  {
    const auto found = std::lower_bound(inside.begin(), inside.end(), way.point,
                                        [](const Inside& a, int point) { return a.point < point; });
    return found->body == way.body;
  };
  std::vector<WayOut> mine;
  std::copy_if(beside.begin(), beside.end(), std::back_inserter(mine), isOwn);
  keepNearest(mine);
  std::vector<WayOut> nearest = comm_->allGather(mine);
  std::sort(nearest.begin(), nearest.end());
  keepNearest(nearest);
  const std::vector<char> covered = areCovered(nearest, mesh, state);
  std::vector<WaysOut> ways;
  bool isSought = false;
  for (std::size_t i = 0; i < nearest.size(); ++i)
  {
    if (ways.empty() || ways.back().point() != nearest[i].point)
      ways.emplace_back();
    ways.back().nearest.push_back(nearest[i]);
    if (!covered[i] || points_[std::size_t(nearest[i].point)].between)
      ways.back().open.push_back(nearest[i]);
  }
  for (const WaysOut& its : ways)
    isSought = isSought || its.open.empty();
  if (!isSought)
    return ways;

  /// Null for a point without a face.
  const auto waysOf = [&](int point) -> WaysOut*
  {
    const auto found =
        std::lower_bound(ways.begin(), ways.end(), point,
                         [](const WaysOut& w, int wanted) { return w.point() < wanted; });
    return found != ways.end() && found->point() == point ? &*found : nullptr;
  };
  std::vector<WayOut> others;
  for (const WayOut& way : beside)
    if (const WaysOut* const its = waysOf(way.point);
        its && its->open.empty() && its->nearest.front().face != way.face)
      others.push_back(way);
  others = comm_->allGather(others);
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end(),
                           [](const WayOut& a, const WayOut& b)
                           { return a.point == b.point && a.face == b.face; }),
               others.end());
  const std::vector<char> leadNowhere = areCovered(others, mesh, state);
  for (std::size_t i = 0; i < others.size(); ++i)
    if (std::vector<WayOut>& open = waysOf(others[i].point)->open;
        !leadNowhere[i] && (open.empty() || others[i].distance <= roundOff * open.front().distance))
      open.push_back(others[i]);
  return ways;
}

void Debris::findForces(const RankMesh& mesh, const ElementForces& elements,
                        const NodalState& state, Real dt)
{
  forces_.clear();
  fromOutside_.clear();
  stiffness_.clear();
  stored_ = 0;
  touching_ = 0;
  const std::vector<Vec3> x = placesOfPoints(state);
  const std::vector<WaysOut> ways =
      findWaysOut(findInside(x, mesh, state), x, mesh, elements, state);
  const std::vector<Point> before = points_;
  for (Point& point : points_)
  {
    point.goOnWithoutFace(ofItsWay * point.speed * dt);
    // A bound by rows on what its contact adds: the point and its place on the face move apart. At
    // once, for the step has to be short enough when it meets a face; and four times as much, as of
    // planes that bodies chatter on: elements ask for no less, but rigid bodies have no step.
    if (point.node >= 0)
      stiffness_.emplace_back(point.node,
                              4 * 2 * std::min(stiffest_, stiffestPerMass_ * point.mass));
  }
  for (const WaysOut& its : ways)
  {
    Point& point = points_[std::size_t(its.point())];
    const Point& was = before[std::size_t(its.point())];
    const auto isWithinItsWay = [&](const WayOut& way)
    { return way.distance <= ofItsWay * way.speed * dt; };
    const bool cameBetween = !was.inside &&
                             !(!its.open.empty() && isWithinItsWay(its.open.front())) &&
                             isWithinItsWay(its.nearest.front());
    if (its.open.empty() && !cameBetween)
      continue;
    const std::vector<WayOut>& by = cameBetween ? its.nearest : its.open;
    const WayOut& one = by.front();
    point.inside = true;
    point.between = was.between || cameBetween;
    point.distance = one.distance;
    point.speed = one.speed;
    // A way out that has become longer than the point can have come is another one: no energy comes
    // of that.
    if (was.inside)
      point.offset = std::min(
          was.offset + std::max(one.distance - was.distance - ofItsWay * one.speed * dt, 0.0),
          one.distance);
    else // or the point came from the inside of the body
      point.offset = isWithinItsWay(one) ? std::min(was.offset, one.distance) : one.distance;
    const Real depth = one.distance - point.offset;
    if (!(depth > 0))
      continue;
    ++touching_;
    for (const WayOut& way : by)
      push(point, x[std::size_t(its.point())], way, depth, 1 / Real(by.size()), mesh, state);
  }
}

void Debris::push(const Point& point, const Vec3& place, const WayOut& by, Real depth, Real share,
                  const RankMesh& mesh, const NodalState& state)
{
  const Real stiffness = share * by.stiffness;
  stored_ += 0.5 * stiffness * depth * depth;
  const Vec3 force = (stiffness * depth) * by.outward;
  if (point.node >= 0)
  {
    const Vec3 there = point.image.back(force);
    forces_.emplace_back(point.node, there);
    if (point.image.isOther)
      fromOutside_.push_back(
          {point.node, there - force, cross(at(state.x, point.node), there) - cross(place, force)});
  }
  const auto face = std::lower_bound(faces_.begin(), faces_.end(), by.face,
                                     [](const ExteriorFace& f, GlobalId id) { return f.id < id; });
  if (face == faces_.end() || face->id != by.face)
    return; // none of its nodes is owned here
  for (int k = 0; k < by.count; ++k)
    if (const int node = face->nodes[std::size_t(k)]; node < mesh.ownedNodes)
    {
      const Real weight = by.weights[std::size_t(k)];
      forces_.emplace_back(node, -weight * force);
      stiffness_.emplace_back(node, 2 * std::abs(weight) * stiffness);
    }
}

void Debris::bookHalfStep(const NodalState& state, Real dt)
{
  for (const auto& [node, force] : forces_)
    work_.add(-0.5 * dt * dot(force, at(state.v, node)));
}

void Debris::bookImages(NodalState& state, Real dt) const
{
  for (const auto& [node, force, moment] : fromOutside_)
  {
    set(state.impulse, node, at(state.impulse, node) + dt * force);
    set(state.angularImpulse, node, at(state.angularImpulse, node) + dt * moment);
  }
}

void Debris::addForces(const RankMesh& mesh, const ElementForces& elements, NodalState& state,
                       Real dt)
{
  bookHalfStep(state, dt);
  forces_.clear();
  fromOutside_.clear();
  stored_ = 0;
  touching_ = 0;
  if (points_.empty()) // on all ranks
    return;
  TimedRegion region("coplane::dynamics::debris");
  findForces(mesh, elements, state, dt);
  bookHalfStep(state, dt);
  for (const auto& [node, force] : forces_)
  {
    set(state.force, node, at(state.force, node) + force);
    set(state.contactForce, node, at(state.contactForce, node) + force);
  }
  for (const auto& [node, stiffness] : stiffness_)
    state.contactStiffness(node) += stiffness;
}

DebrisEnergy Debris::energy() const
{
  std::vector<ExactSum> sums{work_};
  return {ExactSum::overRanks(sums, *comm_)[0], stored_};
}

void Debris::save(StateTables& out) const
{
  std::vector<ExactSum> sums{work_};
  std::vector<Real> numbers;
  for (const Real digit : ExactSum::totals(sums, *comm_)[0].digits())
    numbers.push_back(digit);
  for (const Point& point : points_)
    numbers.insert(numbers.end(), {point.offset, point.mass, point.distance, point.speed,
                                   Real(point.inside), Real(point.between)});
  out.numbers("debris/state", numbers);
}

void Debris::restore(const StateSource& in, const RankMesh& mesh, const ElementForces& elements,
                     const NodalState& state)
{
  const std::vector<Real> numbers = in.numbers("debris/state");
  if (numbers.size() != ExactSum::digitCount + numbersOfPoint * points_.size())
    failOnAllRanks(ExitCode::Checkpoint,
                   "{}: it has {} points of debris and should have {}. Restart with the program "
                   "that wrote it ({}).",
                   in.name(),
                   (std::int64_t(numbers.size()) - ExactSum::digitCount) /
                       std::int64_t(numbersOfPoint),
                   points_.size(), in.program());
  if (comm_->isRoot())
    work_ = ExactSum::fromDigits(numbers.data());
  for (std::size_t i = 0; i < points_.size(); ++i)
  {
    Point& point = points_[i];
    const Real* const of = &numbers[ExactSum::digitCount + numbersOfPoint * i];
    point.offset = of[0];
    point.mass = of[1];
    point.distance = of[2];
    point.speed = of[3];
    point.inside = of[4] != 0;
    point.between = of[5] != 0;
  }
  // The forces where they are, which nothing has moved. Velocities are those after the kick, which
  // points have not been looked at with.
  const std::vector<Point> saved = points_;
  if (!points_.empty())
    findForces(mesh, elements, state, 0);
  for (std::size_t i = 0; i < points_.size(); ++i)
  {
    const Image image = points_[i].image;
    points_[i] = saved[i];
    points_[i].image = image;
  }
}

void Debris::addTo(StateHash& hash, std::uint64_t field) const
{
  for (const Point& point : points_)
    hash.add(field, point.id, 0, point.offset);
}
} // namespace coplane
