#include <coplane_core/ExactSum.hpp>
#include <coplane_dynamics/MassScaling.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
/// By which a mass is above what it needs, so that its step is not below the given one.
constexpr Real aboveRoundOff = 1e-9;

/// Whether a node has mass of its own that may be raised.
bool isFree(const Parts& parts, int node)
{
  return parts.state.mass(node) > 0 && !parts.motion.followsBody(node);
}
} // namespace

MassScaling::MassScaling(const TimeOptions& options, Real contactDamping)
    : options_(options), contactDamping_(contactDamping)
{
}

Real MassScaling::massPerSquaredStep(const Parts& parts, int node) const
{
  const Real k = parts.state.contactStiffness(node);
  const Real z = contactDamping_ * std::sqrt(k);
  const Real root = z + std::sqrt(z * z + parts.elements.massOverSquaredSteps(node) + 0.25 * k);
  return root * root;
}

Real MassScaling::nodeStep(const Parts& parts, int node) const
{
  const Real perSquaredStep = massPerSquaredStep(parts, node);
  return perSquaredStep < infinity ? std::sqrt(parts.state.mass(node) / perSquaredStep) : 0;
}

bool MassScaling::raise(const Parts& parts, NodalState& state, bool atStart) const
{
  const Real step = target();
  const MassScaling* const self = this;
  return parallelMin(
             "coplane::dynamics::raiseMasses", state.owned(), KOKKOS_LAMBDA(const int n) {
               if (!isFree(parts, n))
                 return Real(0);
               const Real needed =
                   (1 + aboveRoundOff) * step * step * self->massPerSquaredStep(parts, n);
               // Not finite: an element has turned inside out, of which the stable step tells.
               if (!(needed > state.mass(n)) || !(needed < infinity))
                 return Real(0);
               const Real more = needed - state.mass(n);
               state.mass(n) += more;
               state.addedMass(n) += more;
               if (atStart)
                 return Real(-1);
               const Vec3 v = at(state.v, n), momentum = more * v;
               const Real energy = 0.5 * dot(momentum, v);
               state.externalWork(n) += energy;
               state.totalWork(n) += energy;
               set(state.impulse, n, at(state.impulse, n) + momentum);
               set(state.angularImpulse, n,
                   at(state.angularImpulse, n) + cross(at(state.x, n), momentum));
               return Real(-1);
             }) < 0;
}

Real MassScaling::stable(const Parts& parts) const
{
  const Real elements = parts.elements.smallestStep();
  if (!(elements > 0))
    return 0;
  const MassScaling* const self = this;
  const Real nodes = parallelMin(
      "coplane::dynamics::stableStep", parts.layout.owned(), KOKKOS_LAMBDA(const int n) {
        return isFree(parts, n) ? self->nodeStep(parts, n) : infinity;
      });
  return std::min(nodes, std::max(target(), elements));
}

std::vector<AddedMass> MassScaling::byBlock(const Parts& parts)
{
  constexpr std::size_t perBlock = 6;
  const NodalState& state = parts.state;
  std::vector<ExactSum> sums(perBlock * parts.blocks().size());
  for (std::size_t b = 0; b < parts.blocks().size(); ++b)
  {
    const RankMesh::Block& part = parts.mesh().blocks[b];
    const int corners = topology(part.type).nodes;
    ExactSum* const mine = &sums[perBlock * b];
    for (int i = 0; i < int(part.connectivity.size()); ++i)
    {
      const int n = part.connectivity[std::size_t(i)];
      if (n >= parts.layout.owned())
        continue;
      const Real own = parts.blocks()[b].cornerMass(i / corners, i % corners);
      mine[0].add(own);
      if (!(state.addedMass(n) > 0))
        continue;
      const Real added = state.addedMass(n) * (own / (state.mass(n) - state.addedMass(n)));
      const Vec3 momentum = added * at(state.v, n);
      mine[1].add(added);
      for (int c = 0; c < 3; ++c)
        mine[2 + c].add(momentum[c]);
      mine[5].add(0.5 * dot(momentum, at(state.vPrevious, n)));
    }
  }
  const std::vector<Real> totals = ExactSum::overRanks(sums, parts.comm);
  std::vector<AddedMass> blocks;
  for (std::size_t b = 0; b < parts.blocks().size(); ++b)
  {
    const Real* const total = &totals[perBlock * b];
    blocks.push_back({total[0], total[1], {total[2], total[3], total[4]}, total[5]});
  }
  return blocks;
}

std::string MassScaling::beyondLimit(const Parts& parts) const
{
  const std::vector<AddedMass> blocks = byBlock(parts);
  std::string text;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    if (blocks[b].ratio() > options_.massScaling->limit)
      text += fmt::format("{}block '{}' {:.3g} times its mass", text.empty() ? "" : ", ",
                          parts.model.blocks[b].name, blocks[b].ratio());
  return text.empty()
             ? text
             : fmt::format(
                   "cycle {}, t = {:.6e} s: for time.mass_scaling.step = {:g} s masses were "
                   "raised beyond time.mass_scaling.limit = {:g}: {} would be added. Give "
                   "a smaller step, which takes its square of mass, or a larger limit if "
                   "inertia does not matter there.",
                   parts.clock.cycle, parts.clock.time, options_.massScaling->step,
                   options_.massScaling->limit, text);
}
} // namespace coplane
