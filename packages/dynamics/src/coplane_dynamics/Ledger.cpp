#include <coplane_core/Backend.hpp>
#include <coplane_core/ExactSum.hpp>
#include <coplane_dynamics/Ledger.hpp>
#include <coplane_dynamics/Parts.hpp>
#include <coplane_dynamics/Relaxation.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
Real EnergyBalance::scale() const
{
  return std::max({std::abs(initial), std::abs(kinetic), std::abs(internal), std::abs(externalWork),
                   chemical, std::abs(eroded), std::abs(contact.work), std::abs(lines.work),
                   std::abs(massDamping), std::abs(localDamping), std::abs(kineticDamping)});
}

namespace
{
enum Term
{
  Kinetic,
  Internal,
  Plastic,
  Bending,
  Hourglass,
  Viscous,
  Chemical,
  Eroded,
  Damping,
  LocalDamping,
  External,
  Nodal,
  Terms
};
using EnergySums = ExactSums; // by Term

/// Works are booked to n + 1/2: what lies ahead of n is taken off.
void addNode(const Parts& parts, int n, EnergySums& sums)
{
  const NodalState& state = parts.state;
  if (!parts.motion.followsBody(n))
    sums[Kinetic].add(0.5 * state.mass(n) * dot(at(state.vPrevious, n), at(state.v, n)));
  for (const Term term : {Kinetic, Nodal})
    sums[term].add(state.swing(n));
  const Vec3 ahead = (0.5 * parts.clock.nextStep) * at(state.v, n);
  const Vec3 external = at(state.external, n), damping = at(state.damping, n),
             localDamping = at(state.localDamping, n);
  sums[Damping].add(state.dampingWork(n) + dot(damping, ahead));
  sums[LocalDamping].add(state.localDampingWork(n) + dot(localDamping, ahead));
  sums[External].add(state.externalWork(n) - dot(external, ahead));
  sums[Nodal].add(state.totalWork(n) -
                  dot(at(state.force, n) + external + damping + localDamping, ahead));
}

void addElements(const Parts& parts, EnergySums& sums)
{
  constexpr std::pair<Term, ElementEnergy> kinds[] = {{Internal, ElementEnergy::Internal},
                                                      {Plastic, ElementEnergy::PlasticDissipation},
                                                      {Bending, ElementEnergy::PlasticBending},
                                                      {Hourglass, ElementEnergy::Hourglass},
                                                      {Viscous, ElementEnergy::Viscous}};
  for (std::size_t b = 0; b < parts.blocks().size(); ++b)
  {
    const ElementBlock& block = parts.blocks()[b];
    sums.add(sumInParts("coplane::dynamics::energies", std::size_t(block.count()),
                        EnergySums{std::vector<ExactSum>(Terms)},
                        [&](EnergySums& mine, std::size_t e)
                        {
                          if (!parts.mesh().blocks[b].owned[e])
                            return;
                          for (const auto& [term, kind] : kinds)
                            mine[term].add(block.energy(int(e), kind));
                          mine[Chemical].add(block.chemicalEnergy(int(e)));
                        }));
  }
  for (const ExactSum& block : parts.erosion.energies())
    sums[Eroded].add(block);
}

void addBodies(const RigidBodies& bodies, EnergySums& sums)
{
  sums[Kinetic].add(bodies.kinetic());
  sums[Damping].add(bodies.dampingWork());
  sums[LocalDamping].add(bodies.localDampingWork());
  sums[External].add(bodies.reactionWork());
  for (const Real work : {bodies.reactionWork(), -bodies.dampingWork(), -bodies.localDampingWork()})
    sums[Nodal].add(work);
}
} // namespace

EnergyBalance Ledger::energy(const Parts& parts, const RelaxationState& relaxation) const
{
  EnergySums sums =
      sumInParts("coplane::dynamics::energies", std::size_t(parts.layout.owned()),
                 EnergySums{std::vector<ExactSum>(Terms)},
                 [&](EnergySums& mine, std::size_t n) { addNode(parts, int(n), mine); });
  addElements(parts, sums);
  if (parts.comm.isRoot()) // every rank has all bodies
    addBodies(parts.bodies(), sums);
  const std::vector<Real> totals = ExactSum::overRanks(sums.each, parts.comm);
  EnergyBalance balance;
  balance.kinetic = totals[Kinetic];
  balance.chemical = totals[Chemical];
  balance.internal = totals[Internal] + balance.chemical;
  balance.plastic = totals[Plastic];
  balance.bending = totals[Bending];
  balance.hourglass = totals[Hourglass];
  balance.viscous = totals[Viscous];
  balance.eroded = totals[Eroded];
  balance.massDamping = totals[Damping];
  balance.localDamping = totals[LocalDamping];
  balance.lines = parts.lines.energy(); // every rank has all lines
  balance.externalWork = totals[External] + balance.lines.pretension;
  balance.kineticDamping = relaxation.work;
  balance.nodalWork = totals[Nodal] - relaxation.work;
  if (parts.contact)
    balance.contact = parts.contact->energy();
  if (parts.debris)
    balance.debris = parts.debris->energy();
  balance.initial = initialEnergy_.total();
  return balance;
}

Momenta Ledger::momenta(const Parts& parts) const
{
  const NodalState& state = parts.state;
  const auto addNode = [&](ExactSums& sums, std::size_t node)
  {
    const int n = int(node);
    const Vec3 p = state.mass(n) * at(state.v, n) + at(state.underWay, n);
    const Vec3 l = cross(at(state.x, n), p);
    const bool isOwn = !parts.motion.followsBody(n);
    for (int c = 0; c < 3; ++c)
    {
      if (isOwn)
      {
        sums[c].add(p[c]);
        sums[3 + c].add(l[c]);
      }
      sums[6 + c].add(state.impulse(n, c));
      sums[9 + c].add(state.angularImpulse(n, c));
    }
    if (isOwn)
      sums[12].add(norm(p));
  };
  ExactSums sums = sumInParts("coplane::dynamics::momenta", std::size_t(parts.layout.owned()),
                              ExactSums{std::vector<ExactSum>(13)}, addNode);
  for (int b = 0; b < parts.bodies().count() && parts.comm.isRoot();
       ++b) // every rank has all bodies
  {
    const RigidBodies::BodyMomenta body = parts.bodies().momenta(b);
    for (int c = 0; c < 3; ++c)
    {
      sums[c].add(body.linear[c]);
      sums[3 + c].add(body.angular[c]);
      sums[6 + c].add(body.impulse[c]);
      sums[9 + c].add(body.angularImpulse[c]);
    }
    sums[12].add(body.magnitude);
  }
  const std::vector<Real> totals = ExactSum::overRanks(sums.each, parts.comm);
  Momenta momenta;
  momenta.linear = {totals[0], totals[1], totals[2]};
  momenta.angular = {totals[3], totals[4], totals[5]};
  momenta.impulse = {totals[6], totals[7], totals[8]};
  momenta.angularImpulse = {totals[9], totals[10], totals[11]};
  momenta.magnitude = totals[12];
  if (parts.model.axisymmetric())
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

void Ledger::open(const Parts& parts, const RelaxationState& relaxation)
{
  initialEnergy_ = {};
  initialEnergy_ = energy(parts, relaxation);
  initialMomenta_ = momenta(parts);
  // Momenta before any impulse: the first half kick has happened already.
  initialMomenta_.linear -= initialMomenta_.impulse;
  initialMomenta_.angular -= initialMomenta_.angularImpulse;
}
} // namespace coplane
