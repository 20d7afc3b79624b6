// Dynamic relaxation: stops at peaks of the kinetic energy, and the end of damping.
#include <coplane_core/Log.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/Solver.hpp>

#include <cmath>

namespace coplane
{
namespace
{
// Without stops the ratios are looked at now and then, and have to be small several times in a row:
// the kinetic energy vanishes for a moment where a motion turns.
constexpr std::int64_t checkEvery = 20, checksInARow = 5;
} // namespace

Real Solver::kineticAtHalfStep() const
{
  std::vector<ExactSum> sums(1);
  for (int n = 0; n < layout_.owned(); ++n)
    if (!followsBody_(n))
      sums[0].add(0.5 * state_.mass(n) * dot(at(state_.v, n), at(state_.v, n)));
  if (comm_->isRoot()) // every rank has all bodies
    sums[0].add(rigid_->kineticAtHalfStep());
  return ExactSum::overRanks(sums, *comm_)[0];
}

bool Solver::isAtRest() const
{
  const RelaxationOptions& wanted = model_.conditions.relaxation;
  if (wanted.energyRatio > 0)
  {
    std::vector<ExactSum> sums(1);
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      for (int e = 0; e < blocks_[b].count(); ++e)
        if (model_.mesh.blocks[b].owned[e])
          sums[0].add(blocks_[b].energy(e, ElementEnergy::Internal));
    const Real internal =
        ExactSum::overRanks(sums, *comm_)[0] + (contact_ ? contact_->energy().stored : 0);
    if (!(kineticAtHalfStep() <= wanted.energyRatio * internal))
      return false;
  }
  if (wanted.forceRatio > 0)
  {
    std::vector<ExactSum> sums(2);
    for (int n = 0; n < layout_.owned(); ++n)
    {
      sums[1].add(norm(at(state_.external, n)));
      if (!followsBody_(n))
        sums[0].add(norm(at(state_.force, n) + at(state_.external, n)));
    }
    if (comm_->isRoot())
    {
      sums[0].add(rigid_->unbalancedForce());
      sums[1].add(rigid_->reactionForce());
    }
    const std::vector<Real> totals = ExactSum::overRanks(sums, *comm_);
    if (!(totals[0] <= wanted.forceRatio * totals[1]))
      return false;
  }
  return wanted.energyRatio > 0 || wanted.forceRatio > 0;
}

void Solver::relax(Real step)
{
  const RelaxationOptions& wanted = model_.conditions.relaxation;
  if (relaxation_.ended || !model_.conditions.dampsAt(clock_.time))
    return;
  bool over = false;
  if (wanted.kinetic)
  {
    TimedRegion region("coplane::dynamics::relax");
    const Real kinetic = kineticAtHalfStep();
    const bool passed = kinetic < relaxation_.kineticBefore;
    relaxation_.kineticBefore = kinetic;
    if (!passed)
      return;
    over = isAtRest();
    stopMotion(step);
  }
  else if ((wanted.energyRatio > 0 || wanted.forceRatio > 0) && clock_.cycle > 0 &&
           clock_.cycle % checkEvery == 0)
  {
    relaxation_.below = isAtRest() ? relaxation_.below + 1 : 0;
    over = relaxation_.below >= checksInARow;
  }
  if (!over)
    return;
  relaxation_.ended = true;
  logInfo("cycle {}, t = {:.6e} s: damping ends, at rest within the ratios of damping",
          clock_.cycle, clock_.time);
}

/// Works are booked to n + 1/2 in the kick; this motion ends at n.
void Solver::takeBackWorkAhead(Real step)
{
  const NodalState& state = state_;
  const Real half = 0.5 * step;
  parallelFor(
      "coplane::dynamics::takeBackWorkAhead", layout_.owned(), KOKKOS_LAMBDA(const int n) {
        const Vec3 path = half * at(state.v, n);
        const Vec3 external = at(state.external, n), damping = at(state.damping, n),
                   localDamping = at(state.localDamping, n);
        state.externalWork(n) -= dot(external, path);
        state.dampingWork(n) += dot(damping, path);
        state.localDampingWork(n) += dot(localDamping, path);
        state.totalWork(n) -= dot(at(state.force, n) + external + damping + localDamping, path);
      });
}

/// At n, after a kick that has been booked: velocities that nothing prescribes are zero, and the
/// first half step from there follows. What the motion had is booked as work and as an impulse.
void Solver::stopMotion(Real step)
{
  const Real before = kineticAtFullStep();
  takeBackWorkAhead(step);
  const NodeVectors v = state_.v, vPrevious = state_.vPrevious;
  const NodeVectors impulse = state_.impulse, angularImpulse = state_.angularImpulse;
  const ConstNodeVectors x = state_.x;
  const ConstArray<Real> mass = state_.mass;
  const auto followsBody = followsBody_;
  const auto copy = vPrevious; // what the velocities are before the stop
  parallelFor(
      "coplane::dynamics::stopMotion", layout_.owned(), KOKKOS_LAMBDA(const int n) {
        set(copy, n, at(v, n));
        set(v, n, {});
      });
  model_.conditions.keepPrescribed(copy, v);
  parallelFor(
      "coplane::dynamics::bookStop", layout_.owned(), KOKKOS_LAMBDA(const int n) {
        if (followsBody(n))
          return;
        const Vec3 lost = mass(n) * (at(v, n) - at(copy, n));
        set(impulse, n, at(impulse, n) + lost);
        set(angularImpulse, n, at(angularImpulse, n) + cross(at(x, n), lost));
      });
  rigid_->stop(state_);
  model_.conditions.applyLoads(model_.mesh.dimension, layout_.owned(), clock_.time, state_);
  const Real dt = clock_.step;
  clock_.step = 0; // a start
  kick(step);
  clock_.step = dt;
  mirrorVelocities();
  relaxation_.work += before - kineticAtFullStep();
  relaxation_.kineticBefore = kineticAtHalfStep();
  ++relaxation_.stops;
}

Real Solver::kineticAtFullStep() const
{
  std::vector<ExactSum> sums(1);
  for (int n = 0; n < layout_.owned(); ++n)
    if (!followsBody_(n))
      sums[0].add(0.5 * state_.mass(n) * dot(at(state_.vPrevious, n), at(state_.v, n)));
  if (comm_->isRoot())
    sums[0].add(rigid_->kinetic());
  return ExactSum::overRanks(sums, *comm_)[0];
}

void Solver::mirrorVelocities()
{
  const auto v = state_.v;
  const auto vPrevious = state_.vPrevious;
  parallelFor(
      "coplane::dynamics::mirrorVelocities", layout_.owned(),
      KOKKOS_LAMBDA(const int n) { set(vPrevious, n, 2.0 * at(vPrevious, n) - at(v, n)); });
  rigid_->mirrorVelocities();
}
} // namespace coplane
