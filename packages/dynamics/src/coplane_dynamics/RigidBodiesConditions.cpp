// Conditions on the motion of rigid bodies.
#include <coplane_dynamics/RigidBodies.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
void RigidBodies::takeConditions(Conditions& conditions)
{
  if (empty())
    return;
  // Which bodies a condition holds, the same on all ranks.
  const auto take = [&](std::vector<int>& nodes, const Window& when, const std::string& what,
                        const std::string& where)
  {
    std::vector<std::int64_t> held(bodies_.size(), 0);
    for (const int n : nodes)
      if (bodyOfNode_[n] >= 0)
        ++held[bodyOfNode_[n]];
    comm_->sum(held);
    for (std::size_t b = 0; b < held.size(); ++b)
      if (held[b] > 0 && held[b] < bodies_[b].allNodes)
        failOnAllRanks(ExitCode::Deck,
                       "{}: {} holds {} of the {} nodes of a rigid body with its centre at "
                       "({}, {}, {}) m; accepted: all of them or none. Use a node set with the "
                       "whole block.",
                       where, what, held[b], bodies_[b].allNodes, bodies_[b].center.x,
                       bodies_[b].center.y, bodies_[b].center.z);
    if (!when.isAlways() &&
        std::any_of(held.begin(), held.end(), [](std::int64_t count) { return count > 0; }))
      failOnAllRanks(ExitCode::Deck,
                     "{}: {} with `from` or `until` holds a rigid body; accepted on rigid "
                     "bodies: conditions for the whole run or stage. Use rigid_motion with "
                     "functions of t, or change the conditions in a stage.",
                     where, what);
    nodes.erase(
        std::remove_if(nodes.begin(), nodes.end(), [&](int n) { return bodyOfNode_[n] >= 0; }),
        nodes.end());
    return held;
  };
  for (SymmetryPlane& plane : conditions.symmetries)
  {
    const auto held = take(plane.nodes, plane.when, "a symmetry plane", plane.where);
    for (std::size_t b = 0; b < held.size(); ++b)
      if (held[b] > 0)
        constrain(bodies_[b], {plane.normal, {}});
  }
  for (PrescribedVelocity& condition : conditions.velocities)
  {
    const std::size_t before = condition.nodes.size();
    const auto held =
        take(condition.nodes, condition.when, "a condition on velocities", condition.where);
    for (std::size_t b = 0; b < held.size(); ++b)
      for (int c = 0; c < 3 && held[b] > 0; ++c)
        if (condition.components[c] && c < dimension_)
        {
          Vec3 axis{};
          axis[c] = 1;
          if (!condition.velocity[c])
            constrain(bodies_[b], {axis, {}});
          else
            constrain(bodies_[b],
                      {axis,
                       [condition, c](const KickTimes& times, Real before)
                       { return condition.speed(condition.velocity[c], times, before); },
                       condition.of == PrescribedVelocity::Of::Acceleration ? condition.velocity[c]
                                                                            : OfTime()});
        }
    const bool lost = condition.hasField() && condition.nodes.size() < before;
    if (comm_->max(std::int64_t(lost)) > 0)
      failOnAllRanks(ExitCode::Deck,
                     "{}: the motion of a rigid body is prescribed by an expression of x, y "
                     "or z; accepted: numbers, tables and expressions of t. Its points cannot move "
                     "apart.",
                     condition.where);
  }
  takeMotions(conditions.rigidMotions);
}

void RigidBodies::demandPossible(Conditions conditions) const
{
  RigidBodies trial = *this;
  for (Body& body : trial.bodies_)
  {
    body.constraints.clear();
    body.turning = Body::Turning::Free;
  }
  trial.takeConditions(conditions);
}

void RigidBodies::takeMotions(const std::vector<RigidMotion>& motions)
{
  for (const RigidMotion& motion : motions)
    for (Body& body : bodies_)
    {
      if (!body.blocks[motion.block])
        continue;
      if (body.isHeld())
        failOnAllRanks(ExitCode::Deck,
                       "{}: the rigid body with its centre at ({}, {}, {}) m has a given "
                       "rigid_motion and another condition on its motion; accepted: one of them. "
                       "Take its nodes out of the node set, or leave out rigid_motion.",
                       motion.where, body.center.x, body.center.y, body.center.z);
      for (int c = 0; c < dimension_; ++c)
        if (motion.components[c])
        {
          Constraint& constraint = body.constraints.emplace_back();
          constraint.direction[c] = 1;
          if (motion.velocity[c])
            constraint.speed = [speed = motion.velocity[c]](const KickTimes& times, Real)
            { return speed(times.middle()); };
        }
      if (motion.spin)
      {
        body.turning = Body::Turning::Given;
        body.spinOfTime = *motion.spin;
      }
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

bool RigidBodies::staysInPlanes(int body, const Vec3& normal) const
{
  const Body& b = bodies_[std::size_t(body)];
  constexpr Real roundOff = 1e-6; // decks have six digits at least
  Vec3 free = normal;             // what nothing holds of it
  std::vector<Vec3> held;
  for (const Constraint& c : b.constraints)
  {
    Vec3 direction = c.direction;
    for (const Vec3& other : held)
      direction -= dot(direction, other) * other;
    if (c.speed || !(norm(direction) > roundOff))
      continue;
    held.push_back(normalised(direction));
    free -= dot(free, held.back()) * held.back();
  }
  bool turnsOut = b.turning == Body::Turning::Free ||
                  (b.turning == Body::Turning::AboutAxis && norm(cross(b.axis, normal)) > roundOff);
  for (int c = 0; c < 3 && b.turning == Body::Turning::Given; ++c)
  {
    Vec3 axis{};
    axis[c] = 1;
    const Vec3 across = cross(normal, axis);
    turnsOut = turnsOut || (norm(across) > roundOff && b.spinOfTime.actsAlong(normalised(across)));
  }
  return norm(free) < roundOff && !turnsOut;
}

void RigidBodies::applyConstraints(Body& body, const KickTimes& times, const Vec3& before) const
{
  const Real t = times.middle(), dt = times.step;
  for (const Constraint& c : body.constraints)
  {
    const Real speed = c.speed ? c.speed(times, dot(before, c.direction)) : 0;
    body.velocity += (speed - dot(body.velocity, c.direction)) * c.direction;
  }
  if (body.turning == Body::Turning::None)
    body.angularMomentum = {};
  if (body.turning != Body::Turning::Given)
    return;
  body.givenSpin = body.spinOfTime(t);
  if (dimension_ == 2)
    body.givenSpin = {0, 0, body.givenSpin.z};
  // The turn of a step is Cayley's: a slightly larger vector makes its angle exact.
  const Real angle = dt * norm(body.givenSpin);
  if (angle > 1)
    failOnAllRanks(ExitCode::Computation,
                   "t = {:.6e} s: a rigid body with given angular_velocity would turn by {} rad in "
                   "one step of {:.3e} s; accepted: 1 rad. Give time.maximum_step.",
                   t, angle, dt);
  if (angle > 0)
    body.givenSpin = (std::tan(0.5 * angle) / (0.5 * angle)) * body.givenSpin;
}
} // namespace coplane
