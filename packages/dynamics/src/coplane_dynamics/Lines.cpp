#include <coplane_core/Error.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/Conditions.hpp>
#include <coplane_dynamics/Lines.hpp>
#include <coplane_mesh/Bodies.hpp>
#include <coplane_mesh/PointInElement.hpp>

#include <algorithm>
#include <cstring>
#include <numeric>

namespace coplane
{
namespace
{
constexpr GlobalId nobody = INT64_MAX;

struct Extent
{
  Vec3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};
  void add(const Vec3& x)
  {
    for (int c = 0; c < 3; ++c)
    {
      low[c] = std::min(low[c], x[c]);
      high[c] = std::max(high[c], x[c]);
    }
  }
  void grow(Real by)
  {
    for (int c = 0; c < 3; ++c)
    {
      low[c] -= by;
      high[c] += by;
    }
  }
  bool meets(const Extent& other) const
  {
    for (int c = 0; c < 3; ++c)
      if (other.high[c] < low[c] || other.low[c] > high[c])
        return false;
    return true;
  }
};

int cornersOf(const RankMesh& mesh, int b, int e, std::array<Vec3, 8>& corners)
{
  const RankMesh::Block& part = mesh.blocks[std::size_t(b)];
  const int count = topology(part.type).nodes;
  for (int k = 0; k < count; ++k)
    corners[std::size_t(k)] =
        mesh.coordinates[std::size_t(part.connectivity[std::size_t(e * count + k)])];
  return count;
}

/// Which elements of the mesh as it is at t = 0 hold places, over all ranks.
class HostSearch
{
public:
  /// Elements of this rank near one of the lines.
  HostSearch(const std::vector<LineSetup>& setups, const RankMesh& mesh, const Comm& comm)
      : mesh_(&mesh), comm_(&comm),
        bodies_(bodyLabels(mesh, std::vector<char>(mesh.blocks.size(), 1), comm))
  {
    std::vector<Extent> lines;
    for (const LineSetup& setup : setups)
    {
      Extent box;
      for (const LinePoint& point : setup.points)
        box.add(point.place);
      lines.push_back(box);
    }
    for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
      for (int e = 0; e < mesh.blocks[b].elements(); ++e)
      {
        if (!mesh.blocks[b].owned[std::size_t(e)])
          continue;
        std::array<Vec3, 8> corners;
        const int count = cornersOf(mesh, int(b), e, corners);
        Candidate candidate{int(b), e, {}};
        for (int k = 0; k < count; ++k)
          candidate.box.add(corners[std::size_t(k)]);
        candidate.box.grow(1e-6 * norm(candidate.box.high - candidate.box.low));
        if (std::any_of(lines.begin(), lines.end(),
                        [&](const Extent& line) { return candidate.box.meets(line); }))
          candidates_.push_back(candidate);
      }
  }

  struct Host
  {
    GlobalId element = nobody; ///< the lowest id of those that hold the place
    std::int64_t body = -1;
  };
  /// Collective.
  std::vector<Host> hostsOf(const std::vector<Vec3>& places) const
  {
    constexpr Real tolerance = 1e-6; // in natural coordinates
    std::vector<std::int64_t> found(places.size(), -nobody), bodies(places.size(), -1);
    // Places in their order along the longest side of what they cover.
    Extent all;
    for (const Vec3& place : places)
      all.add(place);
    const Vec3 size = places.empty() ? Vec3{} : all.high - all.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::vector<std::size_t> order(places.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b)
              { return std::pair(places[a][axis], a) < std::pair(places[b][axis], b); });
    for (const Candidate& candidate : candidates_)
      for (auto one =
               std::lower_bound(order.begin(), order.end(), candidate.box.low[axis],
                                [&](std::size_t a, Real low) { return places[a][axis] < low; });
           one != order.end() && places[*one][axis] <= candidate.box.high[axis]; ++one)
      {
        const std::size_t i = *one;
        Extent point;
        point.add(places[i]);
        if (!candidate.box.meets(point))
          continue;
        const RankMesh::Block& part = mesh_->blocks[std::size_t(candidate.block)];
        const GlobalId id = part.elementIds[std::size_t(candidate.element)];
        if (id >= -found[i])
          continue;
        std::array<Vec3, 8> corners;
        const int count = cornersOf(*mesh_, candidate.block, candidate.element, corners);
        if (pointInElement(part.type, corners.data(), places[i]).outside > tolerance)
          continue;
        found[i] = -id;
        bodies[i] = bodies_[std::size_t(part.connectivity[std::size_t(candidate.element * count)])];
      }
    std::vector<Real> most(found.begin(), found.end()); // ids are whole numbers below 2^53
    comm_->max(most);
    std::vector<Host> hosts(places.size());
    std::vector<Real> labels(places.size(), -1);
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      if (most[i] > -9e15)
        hosts[i].element = GlobalId(-most[i]);
      if (found[i] == -hosts[i].element)
        labels[i] = Real(bodies[i]);
    }
    comm_->max(labels);
    for (std::size_t i = 0; i < places.size(); ++i)
      hosts[i].body = std::int64_t(labels[i]);
    return hosts;
  }

private:
  struct Candidate
  {
    int block, element;
    Extent box;
  };
  const RankMesh* mesh_;
  const Comm* comm_;
  std::vector<int> bodies_;
  std::vector<Candidate> candidates_;
};

using Host = HostSearch::Host;

struct Crossing
{
  int segment;
  Vec3 place{};
  GlobalId near, far; ///< elements
};

/// Where lines leave the body of a point on the way to the next, which lies in another, and the
/// element of that where it begins: halving of the way from both ends, for all at once. Collective.
/// @param hosts of the points of the lines, one after the other
std::vector<std::vector<Crossing>> crossingsOf(const std::vector<LineSetup>& setups,
                                               const std::vector<Host>& hosts,
                                               const HostSearch& search)
{
  constexpr int halvings = 48;
  struct Way
  {
    std::size_t line;
    int segment;
    Vec3 low, high;
    Host lowHost, highHost;
  };
  std::vector<Way> ways;
  std::size_t point = 0;
  for (std::size_t l = 0; l < setups.size(); ++l)
    for (std::size_t i = 0; i < setups[l].points.size(); ++i, ++point)
      if (setups[l].dowel && int(i) > setups[l].bare && hosts[point].body != hosts[point - 1].body)
      {
        const Vec3 &a = setups[l].points[i - 1].place, &b = setups[l].points[i].place;
        ways.push_back({l, int(i) - 1, a, b, hosts[point - 1], hosts[point]});
        ways.push_back({l, int(i) - 1, b, a, hosts[point], hosts[point - 1]});
      }
  if (ways.empty())
    return std::vector<std::vector<Crossing>>(setups.size());
  for (int halving = 0; halving < halvings; ++halving)
  {
    std::vector<Vec3> middles;
    for (const Way& way : ways)
      middles.push_back(0.5 * (way.low + way.high));
    const std::vector<Host> found = search.hostsOf(middles);
    for (std::size_t w = 0; w < ways.size(); ++w)
      if (found[w].body == ways[w].lowHost.body)
      {
        ways[w].low = middles[w];
        ways[w].lowHost = found[w];
      }
      else
      {
        ways[w].high = middles[w];
        // A gap of the joint, or a third body: the next point has to be what comes behind it.
        if (found[w].body >= 0 && found[w].body != ways[w].highHost.body)
          failOnAllRanks(
              ExitCode::Deck,
              "{}: lines.{}: between its points at ({:.6g}, {:.6g}, {:.6g}) and ({:.6g}, "
              "{:.6g}, {:.6g}) m it crosses two joints; accepted for a line with "
              "dowels: one joint at most between two points. Take shorter segments.",
              setups[ways[w].line].where, setups[ways[w].line].name,
              setups[ways[w].line].points[std::size_t(ways[w].segment)].place.x,
              setups[ways[w].line].points[std::size_t(ways[w].segment)].place.y,
              setups[ways[w].line].points[std::size_t(ways[w].segment)].place.z,
              setups[ways[w].line].points[std::size_t(ways[w].segment) + 1].place.x,
              setups[ways[w].line].points[std::size_t(ways[w].segment) + 1].place.y,
              setups[ways[w].line].points[std::size_t(ways[w].segment) + 1].place.z);
      }
  }
  std::vector<std::vector<Crossing>> crossings(setups.size());
  for (std::size_t w = 0; w < ways.size(); w += 2)
    crossings[ways[w].line].push_back(
        {ways[w].segment, ways[w].low, ways[w].lowHost.element, ways[w + 1].lowHost.element});
  return crossings;
}

std::uint64_t bitsOf(Real value)
{
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

Real realOf(std::uint64_t bits)
{
  Real value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}
} // namespace

Lines::Lines(const std::vector<LineSetup>& setups, const RankMesh& mesh, const Comm& comm)
    : comm_(&comm), owned_(mesh.ownedNodes)
{
  if (setups.empty())
    return;
  const HostSearch search(setups, mesh, comm);
  std::vector<Vec3> places;
  for (const LineSetup& setup : setups)
    for (const LinePoint& point : setup.points)
      places.push_back(point.place);
  const std::vector<Host> hosts = search.hostsOf(places);
  std::size_t point = 0;
  for (const LineSetup& setup : setups)
    for (const LinePoint& one : setup.points)
      if (hosts[point++].element == nobody)
        failOnAllRanks(ExitCode::Deck,
                       "{}: lines.{}: its point at ({:.6g}, {:.6g}, {:.6g}) m is in no element of "
                       "the mesh; accepted: points in elements, at t = 0. Move or shorten the "
                       "line, or choose another number of segments.",
                       setup.where, setup.name, one.place.x, one.place.y, one.place.z);
  const auto crossings = crossingsOf(setups, hosts, search);

  std::vector<Vec3> allPlaces;
  std::vector<GlobalId> allHosts;
  point = 0;
  for (std::size_t l = 0; l < setups.size(); ++l)
  {
    const std::vector<LinePoint>& points = setups[l].points;
    firstPoints_.push_back(int(allPlaces.size()));
    for (std::size_t i = 0; i < points.size(); ++i, ++point)
    {
      allPlaces.push_back(points[i].place);
      allHosts.push_back(hosts[point].element);
      axes_.push_back(normalised(points[std::min(i + 1, points.size() - 1)].place -
                                 points[i > 0 ? i - 1 : 0].place));
    }
    std::vector<int> segments;
    for (const Crossing& crossing : crossings[l])
    {
      segments.push_back(crossing.segment);
      for (const GlobalId host : {crossing.near, crossing.far})
      {
        allPlaces.push_back(crossing.place);
        allHosts.push_back(host);
        axes_.push_back({});
      }
    }
    pointsOf_.push_back(int(points.size()));
    lines_.emplace_back(setups[l], segments);
  }
  points_ = int(allPlaces.size());
  embed(allPlaces, allHosts, mesh);
}

void Lines::embed(const std::vector<Vec3>& places, const std::vector<GlobalId>& hosts,
                  const RankMesh& mesh)
{
  std::vector<std::pair<GlobalId, int>> wanted; // in the order of elements
  for (std::size_t i = 0; i < hosts.size(); ++i)
    wanted.push_back({hosts[i], int(i)});
  std::sort(wanted.begin(), wanted.end());
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    const RankMesh::Block& part = mesh.blocks[b];
    for (int e = 0; e < part.elements(); ++e)
    {
      const GlobalId id = part.elementIds[std::size_t(e)];
      for (auto at = std::lower_bound(wanted.begin(), wanted.end(), std::pair(id, -1));
           at != wanted.end() && at->first == id; ++at)
      {
        Embedded one;
        one.point = at->second;
        one.block = int(b);
        one.element = e;
        one.owned = part.owned[std::size_t(e)] != 0;
        std::array<Vec3, 8> corners;
        one.count = cornersOf(mesh, int(b), e, corners);
        for (int k = 0; k < one.count; ++k)
          one.nodes[std::size_t(k)] = part.connectivity[std::size_t(e * one.count + k)];
        one.weights =
            pointInElement(part.type, corners.data(), places[std::size_t(one.point)]).weights;
        embedded_.push_back(one);
      }
    }
  }
  std::sort(embedded_.begin(), embedded_.end(),
            [](const Embedded& a, const Embedded& b) { return a.point < b.point; });
}

std::vector<LineHosts> Lines::gatherHosts(const ElementForces& elements,
                                          const NodalState& state) const
{
  // One rank has the element of a point, the others add zeros: whole numbers have no rounding.
  constexpr std::size_t words = 5;
  std::vector<std::uint64_t> bits(words * std::size_t(points_), 0);
  for (const Embedded& one : embedded_)
  {
    if (!one.owned)
      continue;
    Vec3 x{};
    for (int k = 0; k < one.count; ++k)
      x += one.weights[std::size_t(k)] * at(state.x, one.nodes[std::size_t(k)]);
    const ElementBlock& block = elements.blocks()[std::size_t(one.block)];
    const auto stress = block.stress();
    const SymTensor s{stress(0, one.element), stress(1, one.element), stress(2, one.element),
                      stress(3, one.element), stress(4, one.element), stress(5, one.element)};
    const Vec3& axis = axes_[std::size_t(one.point)];
    const Real pressure = -0.5 * (s.xx + s.yy + s.zz - dot(axis, dot(s, axis)));
    std::uint64_t* const mine = &bits[words * std::size_t(one.point)];
    for (int c = 0; c < 3; ++c)
      mine[c] = bitsOf(x[c]);
    mine[3] = block.isAlive(one.element);
    mine[4] = bitsOf(pressure);
  }
  comm_->sum(bits);
  std::vector<LineHosts> hosts(lines_.size());
  for (std::size_t l = 0; l < lines_.size(); ++l)
  {
    const int first = firstPoints_[l], end = l + 1 < lines_.size() ? firstPoints_[l + 1] : points_;
    for (int i = first; i < end; ++i)
    {
      const std::uint64_t* const one = &bits[words * std::size_t(i)];
      hosts[l].x.push_back({realOf(one[0]), realOf(one[1]), realOf(one[2])});
      hosts[l].alive.push_back(one[3] != 0);
      if (i - first < pointsOf_[l])
        hosts[l].pressure.push_back(realOf(one[4]));
    }
  }
  return hosts;
}

void Lines::addForces(const ElementForces& elements, NodalState& state, Real t, Real dt, int stage,
                      bool alone)
{
  if (empty())
    return;
  TimedRegion region("coplane::dynamics::lines");
  const std::vector<LineHosts> hosts = gatherHosts(elements, state);
  std::vector<const Vec3*> forces;
  std::vector<Real> stiffness;
  for (std::size_t l = 0; l < lines_.size(); ++l)
  {
    lines_[l].advance(hosts[l], t, dt, stage);
    for (const Vec3& force : lines_[l].forces())
      forces.push_back(&force);
    stiffness.insert(stiffness.end(), lines_[l].stiffness().begin(), lines_[l].stiffness().end());
  }
  const auto forEachOwned = [&](auto&& action)
  {
    for (const Embedded& one : embedded_)
      for (int k = 0; k < one.count; ++k)
        if (one.nodes[std::size_t(k)] < owned_)
          action(one.nodes[std::size_t(k)], std::size_t(one.point), one.weights[std::size_t(k)]);
  };
  if (alone)
    forEachOwned([&](int node, std::size_t, Real) { state.contactStiffness(node) = 0; });
  forEachOwned(
      [&](int node, std::size_t point, Real weight)
      {
        set(state.force, node, at(state.force, node) + weight * *forces[point]);
        state.contactStiffness(node) += std::abs(weight) * stiffness[point];
      });
}

void Lines::bookOuterMoments(NodalState& state, Real dt) const
{
  for (std::size_t l = 0; l < lines_.size(); ++l)
    for (const int end : {0, 1})
    {
      const Vec3& moment = lines_[l].outerMoments()[std::size_t(end)];
      if (norm(moment) == 0)
        continue;
      const int point = firstPoints_[l] + (end == 0 ? 0 : pointsOf_[l] - 1);
      for (auto one =
               std::lower_bound(embedded_.begin(), embedded_.end(), point,
                                [](const Embedded&e, int wanted) { return e.point < wanted; });
           one != embedded_.end() && one->point == point; ++one)
        if (const int node = one->nodes[0]; node < owned_) // any node: it is part of a sum
          set(state.angularImpulse, node, at(state.angularImpulse, node) + dt * moment);
    }
}

Real Lines::stiffnessAt(int node) const
{
  std::vector<Real> stiffness;
  for (const Line& line : lines_)
    stiffness.insert(stiffness.end(), line.stiffness().begin(), line.stiffness().end());
  Real sum = 0;
  for (const Embedded& one : embedded_)
    for (int k = 0; k < one.count; ++k)
      if (one.nodes[std::size_t(k)] == node)
        sum += std::abs(one.weights[std::size_t(k)]) * stiffness[std::size_t(one.point)];
  return sum;
}

LineEnergy Lines::energy() const
{
  LineEnergy energy;
  for (const Line& line : lines_)
    energy += line.energy();
  return energy;
}

namespace
{
constexpr const char* linesState = "lines/state";
} // namespace

void Lines::save(StateTables& out) const
{
  if (empty())
    return;
  std::vector<Real> numbers;
  for (const Line& line : lines_)
    line.save(numbers);
  out.numbers(linesState, numbers);
}

void Lines::restore(const StateSource& in)
{
  if (empty())
    return;
  const std::vector<Real> numbers = in.numbers(linesState);
  const Real* next = numbers.data();
  for (Line& line : lines_)
    line.restore(next);
}

void Lines::addTo(StateHash& hash, std::uint64_t field) const
{
  for (std::size_t l = 0; l < lines_.size(); ++l)
    lines_[l].addTo(hash, field, GlobalId(l));
}
} // namespace coplane
