// What the solver tells of its state: sums over all ranks with the same bits for any number of
// them.
#include <coplane_contact/PlaneState.hpp>
#include <coplane_core/StateHash.hpp>
#include <coplane_dynamics/Solver.hpp>

namespace coplane
{
EnergyBalance Solver::energy() const
{
  enum Term
  {
    Kinetic,
    Internal,
    Plastic,
    Bending,
    Hourglass,
    Viscous,
    Eroded,
    Damping,
    LocalDamping,
    External,
    Nodal,
    Terms
  };
  std::vector<ExactSum> sums(Terms);
  for (int n = 0; n < layout_.owned(); ++n)
  {
    if (!followsBody_(n))
      sums[Kinetic].add(0.5 * state_.mass(n) * dot(at(state_.vPrevious, n), at(state_.v, n)));
    const Vec3 ahead = (0.5 * clock_.nextStep) * at(state_.v, n);
    const Vec3 external = at(state_.external, n), damping = at(state_.damping, n),
               localDamping = at(state_.localDamping, n);
    sums[Damping].add(state_.dampingWork(n) + dot(damping, ahead));
    sums[LocalDamping].add(state_.localDampingWork(n) + dot(localDamping, ahead));
    sums[External].add(state_.externalWork(n) - dot(external, ahead));
    sums[Nodal].add(state_.totalWork(n) -
                    dot(at(state_.force, n) + external + damping + localDamping, ahead));
  }
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (int e = 0; e < blocks_[b].count(); ++e)
      if (model_.mesh.blocks[b].owned[e])
      {
        sums[Internal].add(blocks_[b].energy(e, ElementEnergy::Internal));
        sums[Plastic].add(blocks_[b].energy(e, ElementEnergy::PlasticDissipation));
        sums[Bending].add(blocks_[b].energy(e, ElementEnergy::PlasticBending));
        sums[Hourglass].add(blocks_[b].energy(e, ElementEnergy::Hourglass));
        sums[Viscous].add(blocks_[b].energy(e, ElementEnergy::Viscous));
      }
  if (comm_->isRoot()) // every rank has all bodies
  {
    sums[Kinetic].add(rigid_->kinetic());
    sums[Damping].add(rigid_->dampingWork());
    sums[LocalDamping].add(rigid_->localDampingWork());
    sums[External].add(rigid_->reactionWork());
    for (const Real work :
         {rigid_->reactionWork(), -rigid_->dampingWork(), -rigid_->localDampingWork()})
      sums[Nodal].add(work);
  }
  for (const ExactSum& block : erodedEnergy_)
    sums[Eroded].add(block);
  const std::vector<Real> totals = ExactSum::overRanks(sums, *comm_);
  EnergyBalance balance;
  balance.kinetic = totals[Kinetic];
  balance.internal = totals[Internal];
  balance.plastic = totals[Plastic];
  balance.bending = totals[Bending];
  balance.hourglass = totals[Hourglass];
  balance.viscous = totals[Viscous];
  balance.eroded = totals[Eroded];
  balance.massDamping = totals[Damping];
  balance.localDamping = totals[LocalDamping];
  balance.externalWork = totals[External];
  balance.kineticDamping = relaxation_.work;
  balance.nodalWork = totals[Nodal] - relaxation_.work;
  if (contact_)
    balance.contact = contact_->energy();
  balance.initial = initialEnergy_.total();
  return balance;
}

Momenta Solver::momenta() const
{
  std::vector<ExactSum> sums(13);
  for (int n = 0; n < layout_.owned(); ++n)
  {
    const Vec3 p = state_.mass(n) * at(state_.v, n);
    const Vec3 l = cross(at(state_.x, n), p);
    for (int c = 0; c < 3; ++c)
    {
      if (!followsBody_(n))
      {
        sums[c].add(p[c]);
        sums[3 + c].add(l[c]);
      }
      sums[6 + c].add(state_.impulse(n, c));
      sums[9 + c].add(state_.angularImpulse(n, c));
    }
    if (!followsBody_(n))
      sums[12].add(norm(p));
  }
  for (int b = 0; b < rigid_->count() && comm_->isRoot(); ++b) // every rank has all bodies
  {
    const RigidBodies::BodyMomenta body = rigid_->momenta(b);
    for (int c = 0; c < 3; ++c)
    {
      sums[c].add(body.linear[c]);
      sums[3 + c].add(body.angular[c]);
      sums[6 + c].add(body.impulse[c]);
      sums[9 + c].add(body.angularImpulse[c]);
    }
    sums[12].add(body.magnitude);
  }
  const std::vector<Real> totals = ExactSum::overRanks(sums, *comm_);
  Momenta momenta;
  momenta.linear = {totals[0], totals[1], totals[2]};
  momenta.angular = {totals[3], totals[4], totals[5]};
  momenta.impulse = {totals[6], totals[7], totals[8]};
  momenta.angularImpulse = {totals[9], totals[10], totals[11]};
  momenta.magnitude = totals[12];
  if (model_.axisymmetric())
  {
    // Only the momentum along the axis does not vanish over the turn.
    momenta.linear = {0, momenta.linear.y, 0};
    momenta.impulse = {0, momenta.impulse.y, 0};
    momenta.angular = momenta.angularImpulse = {};
  }
  momenta.initialLinear = initialMomenta_.linear;
  momenta.initialAngular = initialMomenta_.angular;
  return momenta;
}

std::uint64_t Solver::stateHash() const
{
  StateHash hash;
  enum Field : std::uint64_t
  {
    Position = 1,
    Velocity,
    Element = 100,
    PlaneField = 200,
    Time = 300
  };
  for (int n = 0; n < layout_.owned(); ++n)
    for (int c = 0; c < 3; ++c)
    {
      hash.add(Position, layout_.ids()[n], c, state_.x(n, c));
      hash.add(Velocity, layout_.ids()[n], c, state_.v(n, c));
    }
  for (std::size_t b = 0; b < blocks_.size(); ++b)
  {
    const RankMesh::Block& part = model_.mesh.blocks[b];
    std::uint64_t field = Element;
    blocks_[b].forEachState(
        [&](const char*, int components, const auto& values)
        {
          for (int e = 0; e < part.elements(); ++e)
            if (part.owned[e])
              for (int c = 0; c < components; ++c)
                hash.add(field, part.elementIds[e], c, values(c, e));
          ++field;
        });
  }
  if (contact_)
    for (std::size_t p = 0; p < contact_->planes().extent(0); ++p)
    {
      const Plane& plane = contact_->planes()(p);
      if (plane.countedHere && plane.isBorn())
        addTo(hash, PlaneField, plane);
    }
  if (comm_->isRoot())
  {
    hash.add(Time, clock_.cycle, 0, clock_.time);
    hash.add(Time, clock_.cycle, 1, clock_.nextStep);
  }
  std::vector<std::uint64_t> total{hash.part()};
  comm_->sum(total);
  return total[0];
}
} // namespace coplane
