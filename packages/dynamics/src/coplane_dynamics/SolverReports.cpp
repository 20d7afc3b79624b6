// What the solver tells of its state: sums over all ranks with the same bits for any number of
// them.
#include <coplane_core/StateHash.hpp>
#include <coplane_dynamics/Solver.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace coplane
{
EnergyBalance Solver::energy() const
{
  enum Term
  {
    Kinetic,
    Internal,
    Plastic,
    Hourglass,
    Viscous,
    Damping,
    LocalDamping,
    External,
    Nodal,
    Terms
  };
  std::vector<ExactSum> sums(Terms);
  for (int n = 0; n < layout_.owned(); ++n)
  {
    sums[Kinetic].add(0.5 * state_.mass(n) * dot(at(state_.vPrevious, n), at(state_.v, n)));
    sums[Damping].add(state_.dampingWork(n));
    sums[LocalDamping].add(state_.localDampingWork(n));
    sums[External].add(state_.externalWork(n));
    sums[Nodal].add(state_.totalWork(n));
  }
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (int e = 0; e < blocks_[b].count(); ++e)
      if (model_.mesh.blocks[b].owned[e])
      {
        sums[Internal].add(blocks_[b].energy(e, ElementEnergy::Internal));
        sums[Plastic].add(blocks_[b].energy(e, ElementEnergy::PlasticDissipation));
        sums[Hourglass].add(blocks_[b].energy(e, ElementEnergy::Hourglass));
        sums[Viscous].add(blocks_[b].energy(e, ElementEnergy::Viscous));
      }
  const std::vector<Real> totals = ExactSum::overRanks(sums, *comm_);
  EnergyBalance balance;
  balance.kinetic = totals[Kinetic];
  balance.internal = totals[Internal];
  balance.plastic = totals[Plastic];
  balance.hourglass = totals[Hourglass];
  balance.viscous = totals[Viscous];
  balance.massDamping = totals[Damping];
  balance.localDamping = totals[LocalDamping];
  balance.externalWork = totals[External];
  balance.nodalWork = totals[Nodal];
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
      sums[c].add(p[c]);
      sums[3 + c].add(l[c]);
      sums[6 + c].add(state_.impulse(n, c));
      sums[9 + c].add(state_.angularImpulse(n, c));
    }
    sums[12].add(norm(p));
  }
  const std::vector<Real> totals = ExactSum::overRanks(sums, *comm_);
  Momenta momenta;
  momenta.linear = {totals[0], totals[1], totals[2]};
  momenta.angular = {totals[3], totals[4], totals[5]};
  momenta.impulse = {totals[6], totals[7], totals[8]};
  momenta.angularImpulse = {totals[9], totals[10], totals[11]};
  momenta.magnitude = totals[12];
  momenta.initialLinear = initialMomenta_.linear;
  momenta.initialAngular = initialMomenta_.angular;
  return momenta;
}

StepControl Solver::stepControl() const
{
  StepControl control;
  int node = -1;
  for (int n = 0; n < layout_.owned(); ++n)
  {
    if (!(state_.mass(n) > 0))
      continue;
    const Real omega = 2 / elementStep_(n);
    const Real step = 2 / std::sqrt(omega * omega + contactStiffness_(n) / state_.mass(n));
    if (step < control.stableStep ||
        (step == control.stableStep && layout_.ids()[n] < layout_.ids()[node]))
    {
      control.stableStep = step;
      node = n;
    }
  }
  const Real least = comm_->min(control.stableStep);
  constexpr GlobalId none = std::numeric_limits<GlobalId>::max();
  const bool mine = node >= 0 && control.stableStep == least;
  control.node = comm_->min(mine ? layout_.ids()[node] : none);
  bool contact = false;
  if (mine && layout_.ids()[node] == control.node)
  {
    const Real omega = 2 / elementStep_(node);
    contact = contactStiffness_(node) / state_.mass(node) > omega * omega;
  }
  control.contact = comm_->max(std::int64_t(contact)) > 0;
  control.stableStep = least;
  return control;
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
      if (!plane.countedHere || !plane.born)
        continue;
      const Real values[] = {plane.area,
                             plane.offset,
                             plane.closure,
                             plane.history.maximumClosure,
                             plane.history.shearTraction.x,
                             plane.history.shearTraction.y,
                             plane.history.shearTraction.z,
                             plane.history.slip,
                             plane.force.x,
                             plane.force.y,
                             plane.force.z,
                             plane.work,
                             plane.frictionWork,
                             plane.hysteresisWork,
                             plane.fractureWork,
                             plane.history.opening,
                             plane.history.shearing};
      std::uint64_t component = mix(std::uint64_t(plane.faceId[1]));
      for (const Real value : values)
        hash.add(PlaneField, plane.faceId[0], component++, value);
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

std::string Solver::worstEntities() const
{
  // Candidates of every rank, sorted by badness; the three worst are named.
  struct Entry
  {
    Real badness, value;
    GlobalId a, b;
  };
  const auto worst = [&](std::vector<Entry> mine)
  {
    const auto worse = [](const Entry& p, const Entry& q)
    { return std::tie(q.badness, p.a, p.b) < std::tie(p.badness, q.a, q.b); };
    std::sort(mine.begin(), mine.end(), worse);
    mine.resize(std::min<std::size_t>(mine.size(), 3));
    std::vector<Entry> all = comm_->allGather(mine);
    std::sort(all.begin(), all.end(), worse);
    all.resize(std::min<std::size_t>(all.size(), 3));
    return all;
  };
  std::string text;
  if (contact_)
  {
    std::vector<Entry> planes;
    for (std::size_t p = 0; p < contact_->planes().extent(0); ++p)
    {
      const Plane& plane = contact_->planes()(p);
      if (!plane.countedHere || !plane.born)
        continue;
      const Real rest = plane.work - plane.stored(contact_->lawOf(plane)) - plane.frictionWork -
                        plane.hysteresisWork - plane.fractureWork - plane.dampingWork;
      planes.push_back({std::abs(rest), rest, plane.faceId[0], plane.faceId[1]});
    }
    for (const Entry& e : worst(planes))
      text += fmt::format(
          "\n  plane between side {} of element {} and side {} of element {}: {:.3e} J unexplained",
          sideOfFace(e.a) + 1, elementOfFace(e.a), sideOfFace(e.b) + 1, elementOfFace(e.b),
          e.value);
  }
  std::vector<Entry> elements;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (int e = 0; e < blocks_[b].count(); ++e)
      if (model_.mesh.blocks[b].owned[e])
      {
        const Real ratio = blocks_[b].volume()(e) / blocks_[b].referenceVolume()(e);
        elements.push_back({std::isnan(ratio) ? infinity : std::abs(ratio - 1), ratio,
                            model_.mesh.blocks[b].elementIds[e], 0});
      }
  for (const Entry& e : worst(elements))
    text += fmt::format("\n  element {}: volume is {:.4g} times its initial one", e.a, e.value);
  return "Worst:" + text;
}
} // namespace coplane
