#include <coplane_core/ExactSum.hpp>
#include <coplane_core/Text.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_mesh/IntegrateSolid.hpp>
#include <coplane_output/Fragments.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <unordered_map>

namespace coplane
{
namespace
{
/// Disjoint sets of whole numbers; the root of a set is its least member.
class Sets
{
public:
  explicit Sets(std::size_t count) : parent_(count)
  {
    std::iota(parent_.begin(), parent_.end(), std::size_t(0));
  }
  std::size_t rootOf(std::size_t i)
  {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::size_t a, std::size_t b)
  {
    a = rootOf(a);
    b = rootOf(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

private:
  std::vector<std::size_t> parent_;
};

/// Two labels that are of one body, or a label and an element of another rank.
struct Edge
{
  GlobalId a, b;
  bool operator<(const Edge& other) const { return a < other.a || (a == other.a && b < other.b); }
  bool operator==(const Edge& other) const { return a == other.a && b == other.b; }
};

template <class T>
void keepOneOfEach(std::vector<T>& items)
{
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

/// Finds the bodies of a rank, and then what they are part of.
class Connections
{
public:
  Connections(const Solver& solver, Real damage)
      : solver_(solver), mesh_(solver.mesh()), nodes_(std::size_t(mesh_.nodes()))
  {
    joinByNodes(damage);
    joinByBonds();
    labelHere();
    if (solver.comm().size() > 1)
      joinRanks();
  }

  /// Per block and element; 0: of none.
  std::vector<std::vector<GlobalId>> ofElements()
  {
    std::vector<std::vector<GlobalId>> bodies(mesh_.blocks.size());
    for (std::size_t b = 0; b < mesh_.blocks.size(); ++b)
      for (int e = 0; e < mesh_.blocks[b].elements(); ++e)
        bodies[b].push_back(connects_[b][e] ? bodyOf(labelOfNode(firstNode(b, e))) : 0);
    return bodies;
  }
  /// Bodies here of which other ranks may have a part, ascending; with the elements of none.
  std::vector<GlobalId> onSeveralRanks()
  {
    std::vector<GlobalId> bodies{0};
    for (const std::size_t root : reaching_)
      bodies.push_back(bodyOf(labels_[root]));
    keepOneOfEach(bodies);
    return bodies;
  }

private:
  int corners(std::size_t b) const { return topology(mesh_.blocks[b].type).nodes; }
  const int* nodesOf(std::size_t b, int e) const
  {
    return &mesh_.blocks[b].connectivity[std::size_t(e) * corners(b)];
  }
  std::size_t firstNode(std::size_t b, int e) const { return std::size_t(nodesOf(b, e)[0]); }
  GlobalId labelOfNode(std::size_t node) { return labels_[nodes_.rootOf(node)]; }
  GlobalId bodyOf(GlobalId label) const
  {
    const auto found = bodyOfLabel_.find(label);
    return found == bodyOfLabel_.end() ? label : found->second;
  }

  void joinByNodes(Real damage)
  {
    for (std::size_t b = 0; b < mesh_.blocks.size(); ++b)
    {
      const RankMesh::Block& part = mesh_.blocks[b];
      const ElementBlock& block = solver_.blocks()[b];
      const int row = block.historyRow("damage");
      connects_.emplace_back();
      for (int e = 0; e < part.elements(); ++e)
      {
        const bool whole = block.isAlive(e) && !(row >= 0 && block.history(row, e) >= damage);
        connects_[b].push_back(whole);
        if (!whole)
          continue;
        nodeOfElement_[part.elementIds[e]] = firstNode(b, e);
        for (int k = 1; k < corners(b); ++k)
          nodes_.unite(firstNode(b, e), std::size_t(nodesOf(b, e)[k]));
      }
    }
  }

  /// Planes are known to all ranks that have one of their faces.
  void joinByBonds()
  {
    if (!solver_.hasContact())
      return;
    const Contact& contact = solver_.contact();
    const auto& planes = contact.planes();
    for (std::size_t p = 0; p < planes.size(); ++p)
    {
      const Plane& plane = planes[p];
      // A bond without area carries nothing: its faces have left each other.
      if (!plane.isBorn() || !plane.history.bonded || !(plane.area > 0))
        continue;
      const GlobalId a = elementOfFace(plane.faceId[0]), b = elementOfFace(plane.faceId[1]);
      const auto here = nodeOfElement_.find(a), there = nodeOfElement_.find(b);
      const bool hasA = here != nodeOfElement_.end(), hasB = there != nodeOfElement_.end();
      if (hasA && hasB)
        nodes_.unite(here->second, there->second);
      else if (hasA || hasB) // held by another rank, or crushed
        far_.push_back({GlobalId(hasA ? here->second : there->second), hasA ? b : a});
    }
  }

  void labelHere()
  {
    labels_.assign(std::size_t(mesh_.nodes()), 0);
    for (const auto& [id, node] : nodeOfElement_)
    {
      GlobalId& label = labels_[nodes_.rootOf(node)];
      label = label == 0 ? id : std::min(label, id);
    }
  }

  /// An element that several ranks hold is the same to all of them: the rank that owns it hears
  /// what the others call its body.
  void joinRanks()
  {
    const Comm& comm = solver_.comm();
    std::vector<std::vector<Edge>> toOwner(std::size_t(comm.size()));
    for (std::size_t b = 0; b < mesh_.blocks.size(); ++b)
      for (int e = 0; e < mesh_.blocks[b].elements(); ++e)
        if (connects_[b][e] && !mesh_.blocks[b].owned[e])
        {
          reaching_.push_back(nodes_.rootOf(firstNode(b, e)));
          toOwner[std::size_t(ownerOf(b, e))].push_back(
              {labels_[reaching_.back()], mesh_.blocks[b].elementIds[e]});
        }
    std::vector<Edge> ofElements = comm.exchange(toOwner);
    std::vector<Edge> bonds;
    for (const Edge& bond : far_)
    {
      reaching_.push_back(nodes_.rootOf(std::size_t(bond.a)));
      bonds.push_back({labels_[reaching_.back()], bond.b});
    }
    keepOneOfEach(bonds);
    for (const Edge& bond : comm.allGather(bonds))
      ofElements.push_back(bond);

    std::vector<Edge> edges;
    for (const Edge& edge : ofElements)
    {
      const auto found = nodeOfElement_.find(edge.b);
      if (found == nodeOfElement_.end())
        continue; // of a bond to an element elsewhere
      reaching_.push_back(nodes_.rootOf(found->second));
      const GlobalId mine = labels_[reaching_.back()];
      if (mine != edge.a)
        edges.push_back({std::min(mine, edge.a), std::max(mine, edge.a)});
    }
    keepOneOfEach(reaching_);
    keepOneOfEach(edges);
    edges = comm.allGather(edges);

    std::vector<GlobalId> labels;
    for (const Edge& edge : edges)
    {
      labels.push_back(edge.a);
      labels.push_back(edge.b);
    }
    keepOneOfEach(labels);
    const auto placeOf = [&](GlobalId label)
    { return std::size_t(std::lower_bound(labels.begin(), labels.end(), label) - labels.begin()); };
    Sets sets(labels.size());
    for (const Edge& edge : edges)
      sets.unite(placeOf(edge.a), placeOf(edge.b));
    for (std::size_t i = 0; i < labels.size(); ++i)
      bodyOfLabel_[labels[i]] = labels[sets.rootOf(i)];
  }

  /// Rank of the node with the lowest id.
  int ownerOf(std::size_t b, int e) const
  {
    int lowest = nodesOf(b, e)[0];
    for (int k = 1; k < corners(b); ++k)
      if (mesh_.nodeIds[nodesOf(b, e)[k]] < mesh_.nodeIds[lowest])
        lowest = nodesOf(b, e)[k];
    return lowest < mesh_.ownedNodes ? solver_.comm().rank()
                                     : mesh_.ownersOfOthers[lowest - mesh_.ownedNodes];
  }

  const Solver& solver_;
  const RankMesh& mesh_;
  Sets nodes_;                                              ///< local nodes of one body
  std::vector<std::vector<char>> connects_;                 ///< [block][element]
  std::unordered_map<GlobalId, std::size_t> nodeOfElement_; ///< of those that connect
  std::vector<Edge> far_;             ///< bonds: a node here, and an element that is not
  std::vector<GlobalId> labels_;      ///< of roots of nodes: least id of the elements here
  std::vector<std::size_t> reaching_; ///< roots whose body other ranks may have a part of
  std::unordered_map<GlobalId, GlobalId> bodyOfLabel_; ///< where other ranks have a part
};

/// Mass and moments of an element about its own centre, from its corners.
struct Share
{
  Real mass;
  Vec3 center, momentum, angular; ///< angular momentum about the centre
  Real second[6];                 ///< sum of m r r^T: xx yy zz xy yz zx
  Vec3 lowest, highest;
};

void addSecond(Real* s, Real mass, const Vec3& r)
{
  s[0] += mass * r.x * r.x;
  s[1] += mass * r.y * r.y;
  s[2] += mass * r.z * r.z;
  s[3] += mass * r.x * r.y;
  s[4] += mass * r.y * r.z;
  s[5] += mass * r.z * r.x;
}

void widen(Vec3& lowest, Vec3& highest, const Vec3& x)
{
  for (int c = 0; c < 3; ++c)
  {
    lowest[c] = std::min(lowest[c], x[c]);
    highest[c] = std::max(highest[c], x[c]);
  }
}

/// Positions, and velocities at the same time, of all nodes of held elements: copies of nodes of
/// other ranks do not have the velocities of the last kick.
struct NodesNow
{
  NodeVectors x, v;

  explicit NodesNow(const Solver& solver)
      : x("coplane::output::x", solver.layout().size()),
        v("coplane::output::v", solver.layout().size())
  {
    const NodalState& state = solver.state();
    for (int n = 0; n < solver.layout().owned(); ++n)
      for (int c = 0; c < 3; ++c)
      {
        x(n, c) = state.x(n, c);
        v(n, c) = 0.5 * (state.vPrevious(n, c) + state.v(n, c));
      }
    solver.layout().refresh(x, v);
  }
};

/// Angular velocity with which the moments turn; none where they are those of a line or a point.
Vec3 spinOf(const Real* s, const Vec3& angular, bool flat)
{
  const Real trace = s[0] + s[1] + s[2];
  if (flat)
    return {0, 0, trace > 0 ? angular.z / trace : 0}; // in the plane of the mesh
  const Mat3 inertia = inertiaFromMoments(s);
  const Vec3 first{inertia(0, 0), inertia(1, 0), inertia(2, 0)};
  const Vec3 second{inertia(0, 1), inertia(1, 1), inertia(2, 1)};
  const Vec3 third{inertia(0, 2), inertia(1, 2), inertia(2, 2)};
  const Real determinant = dot(first, cross(second, third));
  if (!(determinant > 1e-12 * trace * trace * trace))
    return {};
  return inverse(inertia) * angular;
}

/// A rigid body turns with the moments of the solid, not with those of masses at its nodes.
void takeSolid(const RankMesh::Block& part, const ElementBlock& block, const NodesNow& motion,
               int e, Share& share)
{
  const ElementTopology& shape = topology(part.type);
  const Vec3 spin = spinOf(share.second, share.angular, shape.dimension == 2);
  Vec3 x[8];
  for (int k = 0; k < shape.nodes; ++k)
    x[k] = at(motion.x, part.connectivity[std::size_t(e * shape.nodes + k)]) - share.center;
  std::fill_n(share.second, 6, 0.0);
  const Real density = share.mass / block.referenceVolume(e);
  integrateSolid(part.type, x,
                 [&](const Vec3& r, Real volume) { addSecond(share.second, density * volume, r); });
  share.angular = inertiaFromMoments(share.second) * spin;
}

Share shareOf(const Solver& solver, const NodesNow& motion, std::size_t b, int e)
{
  const RankMesh::Block& part = solver.mesh().blocks[b];
  const ElementBlock& block = solver.blocks()[b];
  const int corners = topology(part.type).nodes;
  const int* const nodes = &part.connectivity[std::size_t(e) * corners];
  Share share{};
  share.lowest = {infinity, infinity, infinity};
  share.highest = {-infinity, -infinity, -infinity};
  for (int k = 0; k < corners; ++k)
  {
    const Real m = block.cornerMass(e, k);
    share.mass += m;
    share.center += m * at(motion.x, nodes[k]);
    widen(share.lowest, share.highest, at(motion.x, nodes[k]));
  }
  share.center = (1 / share.mass) * share.center;
  for (int k = 0; k < corners; ++k)
  {
    const Vec3 r = at(motion.x, nodes[k]) - share.center;
    const Real m = block.cornerMass(e, k);
    const Vec3 p = m * at(motion.v, nodes[k]);
    share.momentum += p;
    share.angular += cross(r, p);
    addSecond(share.second, m, r);
  }
  if (solver.model().blocks[b].rigid)
    takeSolid(part, block, motion, e, share);
  return share;
}

/// Sums over elements of a body, about a point; exact, so in any order.
struct Sums
{
  static constexpr int count = 16; ///< m, m r, m v, angular momentum, m r r^T
  std::array<ExactSum, count> of;
  std::int64_t elements = 0;
  Vec3 lowest{infinity, infinity, infinity}, highest{-infinity, -infinity, -infinity};

  void add(const Share& s, const Vec3& reference)
  {
    const Vec3 r = s.center - reference;
    Real second[6];
    std::copy(s.second, s.second + 6, second);
    addSecond(second, s.mass, r);
    const Vec3 angular = s.angular + cross(r, s.momentum);
    of[0].add(s.mass);
    for (int c = 0; c < 3; ++c)
    {
      of[1 + c].add(s.mass * r[c]);
      of[4 + c].add(s.momentum[c]);
      of[7 + c].add(angular[c]);
    }
    for (int i = 0; i < 6; ++i)
      of[10 + i].add(second[i]);
    ++elements;
    widen(lowest, highest, s.lowest);
    widen(lowest, highest, s.highest);
  }
};

/// What a rank has of a body.
struct Part
{
  GlobalId id;
  std::int64_t elements;
  Vec3 reference, lowest, highest;
  std::array<std::array<Real, ExactSum::digitCount>, Sums::count> digits;

  Part(GlobalId body, const Vec3& about, const Sums& sums)
      : id(body), elements(sums.elements), reference(about), lowest(sums.lowest),
        highest(sums.highest)
  {
    for (int i = 0; i < Sums::count; ++i)
      digits[i] = sums.of[i].digits();
  }
  Part() = default;

  void addTo(Sums& sums) const
  {
    for (int i = 0; i < Sums::count; ++i)
      sums.of[i].add(ExactSum::fromDigits(digits[i].data()));
    sums.elements += elements;
    widen(sums.lowest, sums.highest, lowest);
    widen(sums.lowest, sums.highest, highest);
  }
};

Fragment fragmentOf(GlobalId id, const Vec3& reference, const Sums& sums, bool flat)
{
  std::array<Real, Sums::count> v;
  for (int i = 0; i < Sums::count; ++i)
    v[i] = sums.of[i].value();
  Fragment f;
  f.id = id;
  f.elements = sums.elements;
  f.lowest = sums.lowest;
  f.highest = sums.highest;
  f.mass = v[0];
  const Vec3 shift = (1 / f.mass) * Vec3{v[1], v[2], v[3]}, momentum{v[4], v[5], v[6]};
  f.center = reference + shift;
  f.velocity = (1 / f.mass) * momentum;
  f.angularMomentum = Vec3{v[7], v[8], v[9]} - cross(shift, momentum);
  addSecond(&v[10], -f.mass, shift);
  f.spin = spinOf(&v[10], f.angularMomentum, flat);
  return f;
}

/// An element of this rank that is in the model.
struct Place
{
  GlobalId body, element;
  std::size_t block;
  int local;
  bool operator<(const Place& other) const
  {
    return body < other.body || (body == other.body && element < other.element);
  }
};

std::vector<Place> placesOf(const Solver& solver, const ConnectedBodies& bodies)
{
  std::vector<Place> places;
  for (std::size_t b = 0; b < bodies.ofElement.size(); ++b)
  {
    const RankMesh::Block& part = solver.mesh().blocks[b];
    for (int e = 0; e < part.elements(); ++e)
      if (part.owned[e] && !solver.blocks()[b].isTakenOut(e))
        places.push_back({bodies.ofElement[b][e], part.elementIds[e], b, e});
  }
  std::sort(places.begin(), places.end());
  return places;
}

/// The point that sums are about: the centre of the element whose id is the body's.
struct Reference
{
  GlobalId body;
  Vec3 center;
  bool operator<(const Reference& other) const { return body < other.body; }
};
} // namespace

ConnectedBodies findBodies(const Solver& solver, Real damage)
{
  Connections connections(solver, damage);
  return {connections.ofElements(), connections.onSeveralRanks()};
}

const ConnectedBodies& BodiesOfCycle::at(const Solver& solver)
{
  if (solver.clock().cycle != cycle_)
    bodies_ = findBodies(solver, damage_);
  cycle_ = solver.clock().cycle;
  return bodies_;
}

std::vector<Fragment> sumsOf(const Solver& solver, const ConnectedBodies& bodies)
{
  const Comm& comm = solver.comm();
  const bool flat = solver.mesh().dimension == 2;
  const NodesNow motion(solver);
  const std::vector<Place> places = placesOf(solver, bodies);
  const auto isOnSeveral = [&](GlobalId body)
  { return std::binary_search(bodies.onSeveralRanks.begin(), bodies.onSeveralRanks.end(), body); };
  std::vector<Reference> references;
  for (const Place& place : places)
    if (place.body == place.element && isOnSeveral(place.body))
      references.push_back({place.body, shareOf(solver, motion, place.block, place.local).center});
  references = comm.allGather(references);
  std::sort(references.begin(), references.end());

  std::vector<std::vector<Part>> parts(std::size_t(comm.size()));
  std::vector<std::vector<Fragment>> toRoot(std::size_t(comm.size()));
  for (std::size_t i = 0; i < places.size();)
  {
    const GlobalId body = places[i].body;
    const bool several = isOnSeveral(body);
    Vec3 reference{}; // of the elements of none
    if (several && body != 0)
      reference =
          std::lower_bound(references.begin(), references.end(), Reference{body, {}})->center;
    else if (!several)
      reference = shareOf(solver, motion, places[i].block, places[i].local).center;
    Sums sums;
    for (; i < places.size() && places[i].body == body; ++i)
      sums.add(shareOf(solver, motion, places[i].block, places[i].local), reference);
    if (several)
      parts[std::size_t(body % comm.size())].emplace_back(body, reference, sums);
    else
      toRoot[0].push_back(fragmentOf(body, reference, sums, flat));
  }
  std::vector<Part> here = comm.exchange(parts);
  std::sort(here.begin(), here.end(), [](const Part& a, const Part& b) { return a.id < b.id; });
  for (std::size_t i = 0; i < here.size();)
  {
    const Part& first = here[i];
    Sums sums;
    for (; i < here.size() && here[i].id == first.id; ++i)
      here[i].addTo(sums);
    toRoot[0].push_back(fragmentOf(first.id, first.reference, sums, flat));
  }
  std::vector<Fragment> all = comm.exchange(toRoot);
  std::sort(all.begin(), all.end(),
            [](const Fragment& a, const Fragment& b) { return a.id < b.id; });
  return all;
}

FragmentsObserver::FragmentsObserver(const Comm& comm, FragmentsOptions options)
    : options_(std::move(options)), schedule_(options_.when)
{
  std::optional<TextPosition> position;
  if (!options_.positions.empty())
  {
    const auto found = options_.positions.find("fragments");
    position = TextPosition::from(found == options_.positions.end() ? "" : found->second);
    lastCycle_ = position->cycle;
  }
  const std::string header =
      "time[s],cycle,fragment,elements,mass[kg],center_x[m],center_y[m],center_z[m],"
      "velocity_x[m/s],velocity_y[m/s],velocity_z[m/s],"
      "angular_momentum_x[kg m^2/s],angular_momentum_y[kg m^2/s],angular_momentum_z[kg m^2/s],"
      "spin_x[rad/s],spin_y[rad/s],spin_z[rad/s],"
      "low_x[m],low_y[m],low_z[m],high_x[m],high_y[m],high_z[m]";
  comm.together(
      [&]
      {
        if (comm.isRoot() && !table_.open(options_.file, header, position))
          table_.add(header + "\n");
      });
}

void FragmentsObserver::start(const Solver& solver)
{
  schedule_.startAt(solver.clock().time);
  if (options_.positions.empty())
    write(solver);
}

void FragmentsObserver::endOfCycle(const Solver& solver)
{
  const bool due = schedule_.isDue(solver.clock().time);
  if (due || solver.resultsRequested())
    write(solver);
}

void FragmentsObserver::endOfStage(const Solver& solver)
{
  if (solver.clock().cycle != lastCycle_)
    write(solver);
}

void FragmentsObserver::savePosition(std::map<std::string, std::string>& positions) const
{
  if (table_.isOpen())
    positions["fragments"] = table_.position(lastCycle_).text();
}

void FragmentsObserver::finish(const Solver& solver, const Ending&)
{
  if (solver.clock().cycle != lastCycle_)
    write(solver);
}

void FragmentsObserver::write(const Solver& solver)
{
  TimedRegion region("coplane::output::fragments");
  const std::vector<Fragment> fragments = sumsOf(solver, options_.bodies->at(solver));
  solver.comm().together(
      [&]
      {
        if (!table_.isOpen())
          return;
        std::string lines;
        for (const Fragment& f : fragments)
        {
          lines += fmt::format("{:.17g},{},{},{},{:.17g}", solver.clock().time,
                               solver.clock().cycle, f.id, f.elements, f.mass);
          for (const Vec3& v :
               {f.center, f.velocity, f.angularMomentum, f.spin, f.lowest, f.highest})
            for (int c = 0; c < 3; ++c)
              lines += fmt::format(",{:.17g}", v[c]);
          lines += "\n";
        }
        table_.add(lines);
      });
  lastCycle_ = solver.clock().cycle;
}
} // namespace coplane
