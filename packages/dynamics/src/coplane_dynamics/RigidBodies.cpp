#include <coplane_dynamics/RigidBodies.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace coplane
{
namespace
{
Mat3 inertiaFromMoments(const Real* s) // xx yy zz xy yz zx of sum m r r^T
{
  Mat3 j;
  const Real trace = s[0] + s[1] + s[2];
  j(0, 0) = trace - s[0];
  j(1, 1) = trace - s[1];
  j(2, 2) = trace - s[2];
  j(0, 1) = j(1, 0) = -s[3];
  j(1, 2) = j(2, 1) = -s[4];
  j(2, 0) = j(0, 2) = -s[5];
  return j;
}

/// The inverse; in two dimensions of the part that turns.
Mat3 inverseInertia(const Mat3& j, int dimension)
{
  if (dimension == 3)
    return inverse(j);
  Mat3 r;
  r(2, 2) = 1 / j(2, 2);
  return r;
}

/// Calls f(point, volume) for points whose sum integrates second moments exactly.
template <class F>
void integrate(ElementType type, const Vec3* x, F&& f)
{
  constexpr Real point[3] = {-0.77459666924148337704, 0, 0.77459666924148337704};
  constexpr Real weight[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
  constexpr int xi[8] = {-1, 1, 1, -1, -1, 1, 1, -1}, eta[8] = {-1, -1, 1, 1, -1, -1, 1, 1},
                zeta[8] = {-1, -1, -1, -1, 1, 1, 1, 1};
  if (type == ElementType::Tri3)
  {
    // Midpoints of the sides: exact to the second degree.
    const Real area = 0.5 * cross(x[1] - x[0], x[2] - x[0]).z;
    for (int k = 0; k < 3; ++k)
      f(0.5 * (x[k] + x[(k + 1) % 3]), area / 3);
    return;
  }
  if (type == ElementType::Tet4)
  {
    // Four points, exact to the second degree (Keast 1986).
    constexpr Real a = 0.58541019662496845446, b = 0.13819660112501051518;
    const Real volume = dot(cross(x[1] - x[0], x[2] - x[0]), x[3] - x[0]) / 6;
    const Vec3 sum = x[0] + x[1] + x[2] + x[3];
    for (int k = 0; k < 4; ++k)
      f((a - b) * x[k] + b * sum, volume / 4);
    return;
  }
  const bool flat = type == ElementType::Quad4;
  const int nodes = flat ? 4 : 8;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < (flat ? 1 : 3); ++k)
      {
        const Real p = point[i], q = point[j], r = flat ? -1 : point[k];
        Vec3 at{}, g[3]{};
        for (int n = 0; n < nodes; ++n)
        {
          const Real a = 0.5 * (1 + xi[n] * p), b = 0.5 * (1 + eta[n] * q),
                     c = 0.5 * (1 + zeta[n] * r);
          at += (a * b * c) * x[n];
          g[0] += (0.5 * xi[n] * b * c) * x[n];
          g[1] += (a * 0.5 * eta[n] * c) * x[n];
          g[2] += (a * b * 0.5 * zeta[n]) * x[n];
        }
        if (flat)
          f(at, weight[i] * weight[j] * cross(g[0], g[1]).z);
        else
          f(at, weight[i] * weight[j] * weight[k] * dot(cross(g[0], g[1]), g[2]));
      }
}
} // namespace

std::vector<int> rigidBodiesOf(const Mesh& mesh, const std::vector<char>& rigidBlocks)
{
  std::vector<int> root(mesh.nodes());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int n)
  {
    while (root[n] != n)
      n = root[n] = root[root[n]];
    return n;
  };
  std::vector<char> rigid(mesh.nodes(), 0);
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    if (!rigidBlocks[b])
      continue;
    const Mesh::Block& block = mesh.blocks[b];
    const int corners = topology(block.type).nodes;
    for (std::size_t i = 0; i < block.connectivity.size(); ++i)
    {
      const int node = block.connectivity[i];
      rigid[node] = 1;
      const int p = find(node), q = find(block.connectivity[i / corners * corners]);
      root[std::max(p, q)] = std::min(p, q);
    }
  }
  std::vector<int> bodies(mesh.nodes(), -1);
  int count = 0;
  for (int n = 0; n < mesh.nodes(); ++n)
    if (rigid[n])
    {
      const int first = find(n); // the least of its body
      bodies[n] = first == n ? count++ : bodies[first];
    }
  return bodies;
}

RigidBodies::RigidBodies(const RankMesh& mesh, const std::vector<int>& bodyOfNode,
                         const std::vector<char>& rigidBlocks,
                         const std::vector<ElementBlock>& blocks, const NodalState& state,
                         const Comm& comm)
    : comm_(&comm), dimension_(mesh.dimension)
{
  std::int64_t count = 0;
  for (const int body : bodyOfNode)
    count = std::max(count, std::int64_t(body) + 1);
  bodies_.resize(std::size_t(comm.max(count)));
  if (bodies_.empty())
    return;
  bodyOfNode_.assign(bodyOfNode.begin(), bodyOfNode.begin() + mesh.ownedNodes);
  for (int n = 0; n < mesh.ownedNodes; ++n)
    if (bodyOfNode_[n] >= 0)
      bodies_[bodyOfNode_[n]].nodes.push_back(n);
  findInertia(mesh, rigidBlocks, blocks, state);
}

void RigidBodies::findInertia(const RankMesh& mesh, const std::vector<char>& rigidBlocks,
                              const std::vector<ElementBlock>& blocks, const NodalState& state)
{
  // Mass and centre are those of the nodes, so that momenta and weights of nodes are those of the
  // body; moments of inertia are those of the solid.
  const std::size_t bodies = bodies_.size();
  std::vector<ExactSum> sums(5 * bodies);
  for (std::size_t b = 0; b < bodies; ++b)
    for (const int n : bodies_[b].nodes)
    {
      const Real m = state.mass(n);
      sums[5 * b].add(m);
      for (int c = 0; c < 3; ++c)
        sums[5 * b + 1 + c].add(m * state.x(n, c));
      sums[5 * b + 4].add(1);
    }
  std::vector<Real> totals = ExactSum::overRanks(sums, *comm_);
  for (std::size_t b = 0; b < bodies; ++b)
  {
    Body& body = bodies_[b];
    const Real* total = &totals[5 * b];
    body.mass = total[0];
    body.center = (1 / body.mass) * Vec3{total[1], total[2], total[3]};
    body.allNodes = std::int64_t(total[4]);
    for (const int n : body.nodes)
      body.arms.push_back(at(state.x, n) - body.center);
  }

  sums.assign(6 * bodies, ExactSum{});
  const auto add = [&](int body, Real m, const Vec3& r)
  {
    const Real moments[6] = {r.x * r.x, r.y * r.y, r.z * r.z, r.x * r.y, r.y * r.z, r.z * r.x};
    for (int i = 0; i < 6; ++i)
      sums[std::size_t(6 * body + i)].add(m * moments[i]);
  };
  std::vector<Real> others(mesh.ownedNodes, 0); // mass that deformable elements bring to a node
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    const RankMesh::Block& part = mesh.blocks[b];
    const int corners = topology(part.type).nodes;
    for (int e = 0; e < part.elements(); ++e)
    {
      const int* nodes = &part.connectivity[std::size_t(e) * corners];
      if (!rigidBlocks[b])
        for (int k = 0; k < corners; ++k)
          if (nodes[k] < mesh.ownedNodes)
            others[nodes[k]] += blocks[b].cornerMass(e, k);
      if (!rigidBlocks[b] || !part.owned[e])
        continue;
      // The owner of an element owns its node with the lowest id.
      int lowest = 0;
      for (int k = 1; k < corners; ++k)
        if (mesh.nodeIds[nodes[k]] < mesh.nodeIds[nodes[lowest]])
          lowest = k;
      const int body = bodyOfNode_[nodes[lowest]];
      Vec3 x[8];
      for (int k = 0; k < corners; ++k)
        x[k] = at(state.x, nodes[k]) - bodies_[body].center;
      const Real rho = blocks[b].mass(e) / blocks[b].referenceVolume()(e);
      integrate(part.type, x, [&](const Vec3& r, Real volume) { add(body, rho * volume, r); });
    }
  }
  for (std::size_t b = 0; b < bodies; ++b)
    for (std::size_t i = 0; i < bodies_[b].nodes.size(); ++i)
      if (const Real m = others[bodies_[b].nodes[i]]; m > 0)
        add(int(b), m, bodies_[b].arms[i]);
  totals = ExactSum::overRanks(sums, *comm_);
  for (std::size_t b = 0; b < bodies; ++b)
  {
    bodies_[b].inertia = inertiaFromMoments(&totals[6 * b]);
    bodies_[b].inverseInertia = inverseInertia(bodies_[b].inertia, dimension_);
  }
}

void RigidBodies::takeConditions(Conditions& conditions)
{
  if (empty())
    return;
  // Which bodies a condition holds, the same on all ranks.
  const auto take = [&](std::vector<int>& nodes, const std::string& what)
  {
    std::vector<std::int64_t> held(bodies_.size(), 0);
    for (const int n : nodes)
      if (bodyOfNode_[n] >= 0)
        ++held[bodyOfNode_[n]];
    comm_->sum(held);
    for (std::size_t b = 0; b < held.size(); ++b)
      if (held[b] > 0 && held[b] < bodies_[b].allNodes)
        failOnAllRanks(ExitCode::Deck,
                       "conditions: {} holds {} of the {} nodes of a rigid body with its centre at "
                       "({}, {}, {}) m; accepted: all of them or none. Use a node set with the "
                       "whole block.",
                       what, held[b], bodies_[b].allNodes, bodies_[b].center.x, bodies_[b].center.y,
                       bodies_[b].center.z);
    nodes.erase(
        std::remove_if(nodes.begin(), nodes.end(), [&](int n) { return bodyOfNode_[n] >= 0; }),
        nodes.end());
    return held;
  };
  for (SymmetryPlane& plane : conditions.symmetries)
  {
    const auto held = take(plane.nodes, "a symmetry plane");
    for (std::size_t b = 0; b < held.size(); ++b)
      if (held[b] > 0)
        constrain(bodies_[b], {plane.normal, {}});
  }
  for (PrescribedVelocity& condition : conditions.velocities)
  {
    const std::size_t before = condition.nodes.size();
    const auto held = take(condition.nodes, "a condition of type fixed or velocity");
    for (std::size_t b = 0; b < held.size(); ++b)
      for (int c = 0; c < 3 && held[b] > 0; ++c)
        if (condition.components[c] && c < dimension_)
        {
          Vec3 axis{};
          axis[c] = 1;
          if (!condition.velocity[c])
            constrain(bodies_[b], {axis, {}});
          else
            constrain(bodies_[b], {axis, [condition, c](Real t, Real dt)
                                   { return condition.speed(condition.velocity[c], t, dt); }});
        }
    const bool lost = condition.hasField() && condition.nodes.size() < before;
    if (comm_->max(std::int64_t(lost)) > 0)
      failOnAllRanks(
          ExitCode::Deck,
          "conditions: the motion of a rigid body is prescribed by an expression of x, y "
          "or z; accepted: numbers, tables and expressions of t. Its points cannot move "
          "apart.");
  }
}

void RigidBodies::constrain(Body& body, const Constraint& constraint)
{
  const Vec3& direction = constraint.direction;
  // A body of which all points keep their speed along a direction turns about that direction only.
  const Vec3 axis = dimension_ == 2 ? Vec3{0, 0, 1} : body.axis;
  const bool first = body.turning == Body::Turning::Free && dimension_ == 3;
  if (first || norm(cross(axis, direction)) < 1e-9)
  {
    body.axis = direction;
    body.turning = body.turning == Body::Turning::None ? body.turning : Body::Turning::AboutAxis;
  }
  else
    body.turning = Body::Turning::None;
  body.constraints.push_back(constraint);
}

void RigidBodies::applyConstraints(Body& body, Real t, Real dt) const
{
  for (const Constraint& c : body.constraints)
  {
    const Real speed = c.speed ? c.speed(t, dt) : 0;
    body.velocity += (speed - dot(body.velocity, c.direction)) * c.direction;
  }
  if (body.turning == Body::Turning::None)
    body.angularMomentum = {};
}

void RigidBodies::start(NodalState& state)
{
  if (empty())
    return;
  std::vector<ExactSum> sums(12 * bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    for (std::size_t i = 0; i < bodies_[b].nodes.size(); ++i)
    {
      const int n = bodies_[b].nodes[i];
      const Vec3& r = bodies_[b].arms[i];
      const Vec3 p = state.mass(n) * at(state.v, n), l = cross(r, p);
      const Real m = state.mass(n);
      const Real terms[12] = {p.x,           p.y,           p.z,           l.x,
                              l.y,           l.z,           m * r.x * r.x, m * r.y * r.y,
                              m * r.z * r.z, m * r.x * r.y, m * r.y * r.z, m * r.z * r.x};
      for (int k = 0; k < 12; ++k)
        sums[12 * b + std::size_t(k)].add(terms[k]);
    }
  const std::vector<Real> totals = ExactSum::overRanks(sums, *comm_);
  for (std::size_t b = 0; b < bodies_.size(); ++b)
  {
    Body& body = bodies_[b];
    const Real* total = &totals[12 * b];
    body.velocity = (1 / body.mass) * Vec3{total[0], total[1], total[2]};
    // The spin that fits the velocities of the nodes best.
    const Mat3 ofNodes = inverseInertia(inertiaFromMoments(total + 6), dimension_);
    body.angularMomentum = body.inertia * (ofNodes * Vec3{total[3], total[4], total[5]});
    if (dimension_ == 2)
      body.angularMomentum = {0, 0, body.angularMomentum.z};
    applyConstraints(body, 0, 0);
    body.spin = spinOf(body, 0);
    if (body.turning == Body::Turning::AboutAxis)
      body.angularMomentum = body.inertia * body.spin;
    for (std::size_t i = 0; i < body.nodes.size(); ++i)
      set(state.v, body.nodes[i], body.velocity + cross(body.spin, body.arms[i]));
  }
}

void RigidBodies::sumForces(const NodalState& state, const Array<Real>& contactStiffness,
                            const std::function<Real(int)>& elementStep)
{
  if (empty())
    return;
  constexpr std::size_t terms = 16; // force, torque; stiffness k of nodes: k, k r, k r r^T
  std::vector<ExactSum> sums(terms * bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    for (const int n : bodies_[b].nodes)
    {
      ExactSum* const sum = &sums[terms * b];
      const Vec3 r = at(state.x, n) - bodies_[b].center;
      const Vec3 f = at(state.force, n) + at(state.external, n), t = cross(r, f);
      for (int c = 0; c < 3; ++c)
      {
        if (f[c] != 0)
          sum[c].add(f[c]);
        if (t[c] != 0)
          sum[3 + c].add(t[c]);
      }
      const Real omega = 2 / elementStep(n); // of deformable elements that share the node
      const Real k = contactStiffness(n) + state.mass(n) * omega * omega;
      if (k == 0)
        continue;
      const Real values[10] = {k,
                               k * r.x,
                               k * r.y,
                               k * r.z,
                               k * r.x * r.x,
                               k * r.y * r.y,
                               k * r.z * r.z,
                               k * r.x * r.y,
                               k * r.y * r.z,
                               k * r.z * r.x};
      for (int i = 0; i < 10; ++i)
        sum[6 + i].add(values[i]);
    }
  const std::vector<Real> totals = ExactSum::overRanks(sums, *comm_);
  for (std::size_t b = 0; b < bodies_.size(); ++b)
  {
    Body& body = bodies_[b];
    const Real* total = &totals[terms * b];
    body.given = {{total[0], total[1], total[2]}, {total[3], total[4], total[5]}};
    // Springs at the nodes give the energy sum k |V + w x r|^2 / 2. Its largest frequency is
    // bounded by that of the matrix of the norms of its blocks.
    const Mat3 stiffness = inertiaFromMoments(total + 10);
    const Real translation = total[6] / body.mass;
    Real turning = 0, coupling = 0;
    const Vec3 moment{total[7], total[8], total[9]};
    if (dimension_ == 2)
    {
      turning = stiffness(2, 2) * body.inverseInertia(2, 2);
      coupling = dot(moment, moment) / body.mass * body.inverseInertia(2, 2);
    }
    else
    {
      // Largest eigenvalue of J^-1 K: at most its trace, and at most a norm of rows.
      Mat3 turned; // J^-1 in the present turn
      for (int c = 0; c < 3; ++c)
      {
        Vec3 axis{};
        axis[c] = 1;
        const Vec3 column = body.turn(body.inverseInertia * body.turn.back()(axis));
        for (int i = 0; i < 3; ++i)
          turned(i, c) = column[i];
      }
      const Mat3 product = turned * stiffness;
      Real trace = 0, rows = 0, largestInverse = 0;
      for (int i = 0; i < 3; ++i)
      {
        trace += product(i, i);
        rows = std::max(rows, std::abs(product(i, 0)) + std::abs(product(i, 1)) +
                                  std::abs(product(i, 2)));
        largestInverse = std::max(largestInverse, std::abs(turned(i, 0)) + std::abs(turned(i, 1)) +
                                                      std::abs(turned(i, 2)));
      }
      turning = std::min(trace, rows);
      coupling = dot(moment, moment) / body.mass * largestInverse;
    }
    const Real difference = translation - turning;
    body.frequencySquared =
        0.5 * (translation + turning + std::sqrt(difference * difference + 4 * coupling));
    const Real sum = dot(body.given.force, body.given.force) +
                     dot(body.given.torque, body.given.torque) + body.frequencySquared;
    if (!std::isfinite(sum))
      body.frequencySquared = infinity;
  }
}

Real RigidBodies::stableStep() const
{
  Real largest = 0;
  for (const Body& body : bodies_)
    largest = std::max(largest, body.frequencySquared);
  return largest > 0 ? 2 / std::sqrt(largest) : infinity;
}

GlobalId RigidBodies::nodeThatLimits(const NodeLayout& layout) const
{
  std::size_t worst = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    if (bodies_[b].frequencySquared > bodies_[worst].frequencySquared)
      worst = b;
  GlobalId lowest = std::numeric_limits<GlobalId>::max();
  if (!empty())
    for (const int n : bodies_[worst].nodes)
      lowest = std::min(lowest, layout.ids()[n]);
  return comm_->min(lowest);
}

Vec3 RigidBodies::spinOf(const Body& body, Real dt) const
{
  if (body.turning == Body::Turning::None)
    return {};
  if (dimension_ == 2)
    return {0, 0, body.angularMomentum.z * body.inverseInertia(2, 2)};
  if (body.turning == Body::Turning::AboutAxis)
  {
    const Vec3 inBody = body.turn.back()(body.axis); // the axis stays where it is in the body too
    return (dot(body.axis, body.angularMomentum) / dot(inBody, body.inertia * inBody)) * body.axis;
  }
  // w = J^-1 L with the turn half a step ahead, which depends on w: a fixed point.
  Vec3 w = body.spin;
  for (int round = 0; round < 100; ++round)
  {
    const Turn half = Turn{1, (0.5 * dt) * w}.normalised().half().after(body.turn);
    const Vec3 next = half(body.inverseInertia * half.back()(body.angularMomentum));
    const Real change = norm(next - w);
    w = next;
    if (!(change > 1e-15 * norm(w)))
      break;
  }
  return w;
}

void RigidBodies::kick(Real dtKick, Real dt, Real t, Real massDamping, Real localDamping,
                       const NodalState& state)
{
  const Real half = 0.5 * dtKick * massDamping;
  const auto drag = [&](const Vec3& given, const Vec3& speed)
  {
    Vec3 force{};
    for (int c = 0; c < 3; ++c)
    {
      const Real size = localDamping * std::abs(given[c]);
      force[c] = speed[c] > 0 ? -size : speed[c] < 0 ? size : 0;
    }
    return force;
  };
  for (Body& body : bodies_)
  {
    body.previousVelocity = body.velocity;
    body.previousAngularMomentum = body.angularMomentum;
    body.previousSpin = body.spin;
    body.localDamping = {};
    if (localDamping > 0 && body.constraints.empty())
      body.localDamping = {drag(body.given.force, body.velocity),
                           drag(body.given.torque, body.spin)};
    const Vec3 force = body.given.force + body.localDamping.force;
    const Vec3 torque = body.given.torque + body.localDamping.torque;
    body.velocity = (1 / (1 + half)) * ((1 - half) * body.velocity + (dtKick / body.mass) * force);
    body.angularMomentum = (1 / (1 + half)) * ((1 - half) * body.angularMomentum + dtKick * torque);
    if (dimension_ == 2)
      body.angularMomentum = {0, 0, body.angularMomentum.z};
    const Vec3 freeVelocity = body.velocity, freeMomentum = body.angularMomentum;
    applyConstraints(body, t + 0.5 * dt, dt);
    body.spin = spinOf(body, dt);
    const Turn step = Turn{1, (0.5 * dt) * body.spin}.normalised();
    if (body.turning == Body::Turning::AboutAxis && dimension_ == 3)
    {
      const Turn middle = step.half().after(body.turn);
      body.angularMomentum = middle(body.inertia * middle.back()(body.spin));
    }
    body.reaction = {};
    if (!body.constraints.empty())
      body.reaction = {((1 + half) * body.mass / dtKick) * (body.velocity - freeVelocity),
                       ((1 + half) / dtKick) * (body.angularMomentum - freeMomentum)};
    body.damping = {(-0.5 * massDamping * body.mass) * (body.previousVelocity + body.velocity),
                    (-0.5 * massDamping) * (body.previousAngularMomentum + body.angularMomentum)};
    const Vec3 outer = body.reaction.force + body.damping.force + body.localDamping.force;
    body.impulse += dtKick * outer;
    body.angularImpulse += dtKick * (cross(body.center, outer) + body.reaction.torque +
                                     body.damping.torque + body.localDamping.torque);
    body.nextCenter = body.center + dt * body.velocity;
    body.nextTurn = step.after(body.turn);
    moveNodes(body, dt, state);
  }
}

void RigidBodies::moveNodes(Body& body, Real dt, const NodalState& state) const
{
  for (std::size_t i = 0; i < body.nodes.size(); ++i)
  {
    const int n = body.nodes[i];
    const Vec3 next = body.nextCenter + body.nextTurn(body.arms[i]);
    set(state.v, n, (1 / dt) * (next - at(state.x, n)));
  }
}

void RigidBodies::mirrorVelocities()
{
  for (Body& body : bodies_)
  {
    const auto mirror = [](Vec3& previous, const Vec3& now) { previous = 2.0 * previous - now; };
    mirror(body.previousVelocity, body.velocity);
    mirror(body.previousAngularMomentum, body.angularMomentum);
    mirror(body.previousSpin, body.spin);
  }
}

void RigidBodies::drift(Real dt)
{
  for (Body& body : bodies_)
  {
    bookWork(body, dt, body.velocity, body.spin);
    body.center = body.nextCenter;
    body.turn = body.nextTurn;
  }
}

void RigidBodies::bookWork(Body& body, Real dt, const Vec3& velocity, const Vec3& spin)
{
  const auto work = [&](const Wrench& w)
  { return 0.5 * dt * (dot(w.force, velocity) + dot(w.torque, spin)); };
  body.reactionWork += work(body.reaction);
  body.dampingWork -= work(body.damping);
  body.localDampingWork -= work(body.localDamping);
}

void RigidBodies::bookSecondHalf(Real dt)
{
  for (Body& body : bodies_)
    bookWork(body, dt, body.previousVelocity, body.previousSpin);
}

Real RigidBodies::kinetic() const
{
  ExactSum sum;
  for (const Body& body : bodies_)
  {
    sum.add(0.5 * body.mass * dot(body.previousVelocity, body.velocity));
    sum.add(0.25 * (dot(body.previousAngularMomentum, body.spin) +
                    dot(body.angularMomentum, body.previousSpin)));
  }
  return sum.value();
}

Real RigidBodies::reactionWork() const
{
  ExactSum sum;
  for (const Body& body : bodies_)
    sum.add(body.reactionWork);
  return sum.value();
}

Real RigidBodies::dampingWork() const
{
  ExactSum sum;
  for (const Body& body : bodies_)
    sum.add(body.dampingWork);
  return sum.value();
}

Real RigidBodies::localDampingWork() const
{
  ExactSum sum;
  for (const Body& body : bodies_)
    sum.add(body.localDampingWork);
  return sum.value();
}

RigidBodies::BodyMomenta RigidBodies::momenta(int b) const
{
  const Body& body = bodies_[b];
  BodyMomenta m;
  m.linear = body.mass * body.velocity;
  m.angular = cross(body.center, m.linear) + body.angularMomentum;
  m.impulse = body.impulse;
  m.angularImpulse = body.angularImpulse;
  m.magnitude = norm(m.linear);
  return m;
}
} // namespace coplane
