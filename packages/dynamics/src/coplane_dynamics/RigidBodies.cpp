#include <coplane_core/CompensatedSum.hpp>
#include <coplane_dynamics/RigidBodies.hpp>
#include <coplane_dynamics/detail/RigidInertia.hpp>
#include <coplane_mesh/IntegrateSolid.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace coplane
{
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
    applyConstraints(body, {0, 0, 0}, body.velocity);
    body.spin = spinOf(body, 0);
    if (body.turning == Body::Turning::AboutAxis || body.turning == Body::Turning::Given)
      body.angularMomentum = body.inertia * body.spin;
    for (std::size_t i = 0; i < body.nodes.size(); ++i)
      set(state.v, body.nodes[i], body.velocity + cross(body.spin, body.arms[i]));
  }
}

namespace
{
constexpr std::size_t forceTerms = 16; // force, torque; stiffness k of nodes: k, k r, k r r^T

/// Adds the terms of a node.
/// @param r from the centre; k: stiffness against which it moves [N/m]
void addNode(const Vec3& r, const Vec3& f, Real k, ExactSum* sum)
{
  const Vec3 t = cross(r, f);
  for (int c = 0; c < 3; ++c)
  {
    if (f[c] != 0)
      sum[c].add(f[c]);
    if (t[c] != 0)
      sum[3 + c].add(t[c]);
  }
  if (k == 0)
    return;
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
} // namespace

void RigidBodies::sumForces(const NodalState& state, const Array<Real>& contactStiffness,
                            const std::function<Real(int)>& elementStep)
{
  if (empty())
    return;
  std::vector<ExactSum> sums(forceTerms * bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    for (const int n : bodies_[b].nodes)
    {
      const Real omega = 2 / elementStep(n); // of deformable elements that share the node
      addNode(at(state.x, n) - bodies_[b].center, at(state.force, n) + at(state.external, n),
              contactStiffness(n) + state.mass(n) * omega * omega, &sums[forceTerms * b]);
    }
  const std::vector<Real> totals = ExactSum::overRanks(sums, *comm_);
  for (std::size_t b = 0; b < bodies_.size(); ++b)
  {
    Body& body = bodies_[b];
    const Real* total = &totals[forceTerms * b];
    body.given = {{total[0], total[1], total[2]}, {total[3], total[4], total[5]}};
    body.frequencySquared = frequencyBound(body, total + 6);
    const Real sum = dot(body.given.force, body.given.force) +
                     dot(body.given.torque, body.given.torque) + body.frequencySquared;
    if (!std::isfinite(sum))
      body.frequencySquared = infinity;
  }
}

/// Springs k at the nodes give the energy sum k |V + w x r|^2 / 2. Its largest frequency is bounded
/// by that of the matrix of the norms of its blocks [1/s^2].
/// @param spring sums of k, k r, k r r^T
Real RigidBodies::frequencyBound(const Body& body, const Real* spring) const
{
  const Mat3 stiffness = inertiaFromMoments(spring + 4);
  const Real translation = spring[0] / body.mass;
  Real turning = 0, coupling = 0;
  const Vec3 moment{spring[1], spring[2], spring[3]};
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
    const auto rowNorm = [](const Mat3& m, int i)
    { return std::abs(m(i, 0)) + std::abs(m(i, 1)) + std::abs(m(i, 2)); };
    Real trace = 0, rows = 0, largestInverse = 0;
    for (int i = 0; i < 3; ++i)
    {
      trace += product(i, i);
      rows = std::max(rows, rowNorm(product, i));
      largestInverse = std::max(largestInverse, rowNorm(turned, i));
    }
    turning = std::min(trace, rows);
    coupling = dot(moment, moment) / body.mass * largestInverse;
  }
  const Real difference = translation - turning;
  return 0.5 * (translation + turning + std::sqrt(difference * difference + 4 * coupling));
}

Real RigidBodies::stableStep() const
{
  Real largest = 0;
  for (const Body& body : bodies_)
    largest = std::max(largest, body.frequencySquared);
  return largest > 0 ? 2 / std::sqrt(largest) : infinity;
}

Real RigidBodies::massThatYields(int body) const
{
  const Body& of = bodies_[std::size_t(body)];
  // Directions that are given, each beside those before it.
  std::vector<Vec3> given;
  for (const Constraint& constraint : of.constraints)
  {
    Vec3 beside = constraint.direction;
    for (const Vec3& one : given)
      beside = beside - dot(one, beside) * one;
    if (norm(beside) > 1e-6)
      given.push_back(normalised(beside));
  }
  if (int(given.size()) < dimension_)
    return of.mass;
  if (of.turning != Body::Turning::Free && of.turning != Body::Turning::AboutAxis)
    return infinity;
  Real least = of.inertia(2, 2);
  for (int c = 0; c < 2 && dimension_ == 3; ++c)
    least = std::min(least, of.inertia(c, c));
  return least / (of.reach * of.reach);
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
  if (body.turning == Body::Turning::Given)
    return body.givenSpin;
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

void RigidBodies::kick(const KickTimes& times, Real massDamping, Real localDamping,
                       const NodalState& state)
{
  const Real dtKick = times.kick, dt = times.step;
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
    if (localDamping > 0 && !body.isHeld())
      body.localDamping = {drag(body.given.force, body.velocity),
                           drag(body.given.torque, body.spin)};
    const Vec3 force = body.given.force + body.localDamping.force;
    const Vec3 torque = body.given.torque + body.localDamping.torque;
    body.velocity = (1 / (1 + half)) * ((1 - half) * body.velocity + (dtKick / body.mass) * force);
    body.angularMomentum = (1 / (1 + half)) * ((1 - half) * body.angularMomentum + dtKick * torque);
    if (dimension_ == 2)
      body.angularMomentum = {0, 0, body.angularMomentum.z};
    const Vec3 freeVelocity = body.velocity, freeMomentum = body.angularMomentum;
    applyConstraints(body, times, body.previousVelocity);
    body.spin = spinOf(body, dt);
    const Turn step = Turn{1, (0.5 * dt) * body.spin}.normalised();
    if ((body.turning == Body::Turning::AboutAxis && dimension_ == 3) ||
        body.turning == Body::Turning::Given)
    {
      const Turn middle = step.half().after(body.turn);
      body.angularMomentum = middle(body.inertia * middle.back()(body.spin));
    }
    body.reaction = {};
    if (body.isHeld())
      body.reaction = {((1 + half) * body.mass / dtKick) * (body.velocity - freeVelocity),
                       ((1 + half) / dtKick) * (body.angularMomentum - freeMomentum)};
    body.damping = {(-0.5 * massDamping * body.mass) * (body.previousVelocity + body.velocity),
                    (-0.5 * massDamping) * (body.previousAngularMomentum + body.angularMomentum)};
    const Vec3 outer = body.reaction.force + body.damping.force + body.localDamping.force;
    body.impulse += dtKick * outer;
    body.angularImpulse += dtKick * (cross(body.center, outer) + body.reaction.torque +
                                     body.damping.torque + body.localDamping.torque);
    body.nextCenter = body.center;
    body.nextCenterRest = body.centerRest;
    addCompensated(body.nextCenter, body.nextCenterRest, dt * body.velocity);
    if (!state.keepsRests)
      body.nextCenterRest = {};
    body.nextTurn = step.after(body.turn);
    moveNodes(body, dt, state);
  }
}

void RigidBodies::moveNodes(Body& body, Real dt, const NodalState& state) const
{
  for (std::size_t i = 0; i < body.nodes.size(); ++i)
  {
    const int n = body.nodes[i];
    // Differences of places first, which are exact far from the origin: what places are known to
    // there, over a step, would be much.
    const Vec3 way = ((body.nextCenter - at(state.x, n)) + body.nextTurn(body.arms[i])) +
                     (body.nextCenterRest - at(state.xRest, n));
    set(state.v, n, (1 / dt) * way);
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
    body.centerRest = body.nextCenterRest;
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

void RigidBodies::stop(const KickTimes& times, const NodalState& state)
{
  for (Body& body : bodies_)
  {
    const Vec3 velocity = body.velocity, angularMomentum = body.angularMomentum;
    body.velocity = {};
    for (const Constraint& c : body.constraints)
    {
      // To n, from where a start with half a step goes on.
      const Real ahead = c.acceleration ? 0.5 * times.step * c.acceleration(times.t) : 0;
      body.velocity += (dot(velocity - body.velocity, c.direction) - ahead) * c.direction;
    }
    if (body.turning != Body::Turning::Given)
      body.angularMomentum = body.spin = {};
    const Vec3 lost = body.mass * (body.velocity - velocity);
    body.impulse += lost;
    body.angularImpulse += cross(body.center, lost) + (body.angularMomentum - angularMomentum);
    for (const int n : body.nodes)
      set(state.v, n, body.velocity + cross(body.spin, at(state.x, n) - body.center));
  }
}

Real RigidBodies::kinetic(int b) const
{
  const Body& body = bodies_[b];
  return 0.5 * body.mass * dot(body.previousVelocity, body.velocity) +
         0.25 * (dot(body.previousAngularMomentum, body.spin) +
                 dot(body.angularMomentum, body.previousSpin));
}

Real RigidBodies::kinetic() const
{
  ExactSum sum;
  for (int b = 0; b < count(); ++b)
    sum.add(kinetic(b));
  return sum.value();
}

Real RigidBodies::kineticAtHalfStep() const
{
  ExactSum sum;
  for (const Body& body : bodies_)
    sum.add(0.5 *
            (body.mass * dot(body.velocity, body.velocity) + dot(body.angularMomentum, body.spin)));
  return sum.value();
}

Real RigidBodies::Body::gyration() const
{
  return std::sqrt((inertia(0, 0) + inertia(1, 1) + inertia(2, 2)) / (2 * mass));
}

Real RigidBodies::unbalancedForce() const
{
  ExactSum sum;
  for (const Body& body : bodies_)
    sum.add(norm(body.given.force + body.reaction.force) +
            norm(body.given.torque + body.reaction.torque) / body.gyration());
  return sum.value();
}

Real RigidBodies::reactionForce() const
{
  ExactSum sum;
  for (const Body& body : bodies_)
    sum.add(norm(body.reaction.force) + norm(body.reaction.torque) / body.gyration());
  return sum.value();
}

RigidBodies::BodyMotion RigidBodies::motion(int b) const
{
  const Body& body = bodies_[b];
  return {body.center - body.start, 0.5 * (body.previousVelocity + body.velocity),
          0.5 * (body.previousSpin + body.spin), body.reaction.force, body.reaction.torque};
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
