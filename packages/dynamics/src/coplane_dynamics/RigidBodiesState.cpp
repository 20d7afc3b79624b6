// The rigid bodies' part of a checkpoint.
#include <coplane_dynamics/RigidBodies.hpp>

namespace coplane
{
template <class F>
void RigidBodies::forEachNumber(Body& body, F&& f)
{
  const auto vector = [&](Vec3& v)
  {
    f(v.x);
    f(v.y);
    f(v.z);
  };
  for (Turn* turn : {&body.turn, &body.nextTurn})
  {
    f(turn->w);
    vector(turn->v);
  }
  for (Vec3* v :
       {&body.center, &body.nextCenter, &body.centerRest, &body.nextCenterRest, &body.velocity,
        &body.previousVelocity, &body.angularMomentum, &body.previousAngularMomentum, &body.spin,
        &body.previousSpin, &body.givenSpin, &body.impulse, &body.angularImpulse})
    vector(*v);
  for (Wrench* wrench : {&body.given, &body.reaction, &body.damping, &body.localDamping})
  {
    vector(wrench->force);
    vector(wrench->torque);
  }
  for (Real* number :
       {&body.frequencySquared, &body.reactionWork, &body.dampingWork, &body.localDampingWork})
    f(*number);
}

void RigidBodies::save(StateTables& out) const
{
  std::vector<Real> numbers;
  for (Body body : bodies_)
    forEachNumber(body, [&](Real& value) { numbers.push_back(value); });
  out.numbers("rigid_bodies", numbers);
}

void RigidBodies::restore(const StateSource& in)
{
  const std::vector<Real> numbers = in.numbers("rigid_bodies");
  std::size_t at = 0;
  for (Body& body : bodies_)
    forEachNumber(body,
                  [&](Real& value)
                  {
                    if (at < numbers.size())
                      value = numbers[at];
                    ++at;
                  });
  if (at != numbers.size())
    failOnAllRanks(ExitCode::Checkpoint,
                   "{}: the checkpoint has {} numbers of rigid bodies, this run needs {}. Restart "
                   "with the mesh, the deck and the program that it was written with.",
                   in.name(), numbers.size(), at);
}

void RigidBodies::zeroDisplacements()
{
  for (Body& body : bodies_)
    body.start = body.center;
}

void RigidBodies::saveZero(StateTables& out) const
{
  std::vector<Real> numbers;
  for (const Body& body : bodies_)
    numbers.insert(numbers.end(), {body.start.x, body.start.y, body.start.z});
  out.numbers("rigid_bodies_zero", numbers);
}

void RigidBodies::restoreZero(const StateSource& in)
{
  const std::vector<Real> numbers = in.numbers("rigid_bodies_zero");
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    bodies_[b].start = {numbers.at(3 * b), numbers.at(3 * b + 1), numbers.at(3 * b + 2)};
}
} // namespace coplane
