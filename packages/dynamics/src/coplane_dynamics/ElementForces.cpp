#include <coplane_core/Error.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_core/WorkWatch.hpp>
#include <coplane_dynamics/ElementForces.hpp>

#include <algorithm>
#include <numeric>

namespace coplane
{
ElementForces::ElementForces(const RankMesh& mesh, const std::vector<BlockSetup>& setups,
                             const BulkViscosity& viscosity, NodalState& state)
{
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    const RankMesh::Block& part = mesh.blocks[b];
    const BlockSetup& setup = setups[b];
    blocks_.emplace_back(part.type, setup.material, setup.hourglass, viscosity, part.connectivity,
                         setup.element);
    ElementBlock& block = blocks_.back();
    block.initialise(state.x);
    gathers_.push_back(gatherOf(part, mesh.ownedNodes));
    rigid_.push_back(setup.rigid);
  }
  sumMasses(state);
}

void ElementForces::sumMasses(NodalState& state) const
{
  for (int n = 0; n < state.owned(); ++n)
    state.mass(n) = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
  {
    const int corners = topology(blocks_[b].type()).nodes;
    for (int n = 0; n < state.owned(); ++n)
      for (const int entry : gathers_[b][n])
        if (!blocks_[b].isTakenOut(entry / corners))
          state.mass(n) += blocks_[b].cornerMass(entry / corners, entry % corners);
  }
  for (int n = 0; n < state.owned(); ++n)
    state.mass(n) += state.addedMass(n);
}

ElementForces::Gather ElementForces::gatherOf(const RankMesh::Block& part, int owned)
{
  const int corners = topology(part.type).nodes;
  std::vector<int> order(part.elements());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int p, int q) { return part.elementIds[p] < part.elementIds[q]; });
  return {std::size_t(owned), [&](const auto& visit)
          {
            for (const int e : order)
              for (int k = 0; k < corners; ++k)
                if (const int node = part.connectivity[e * corners + k]; node < owned)
                  visit(std::size_t(node), e * corners + k);
          }};
}

void ElementForces::initialise(std::size_t block, const ConstNodeVectors& x, Real time)
{
  blocks_[block].initialise(x, time);
  const NodeVectors atRest("coplane::dynamics::atRest", x.extent(0));
  blocks_[block].update(x, atRest, 0, {});
}

void ElementForces::setInitialStress(const Model& model)
{
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (int e = 0; e < blocks_[b].count() && !isRigid(b); ++e)
      blocks_[b].setInitialStress(e, model.blocks[b].stressOfElement(model.mesh, int(b), e));
}

void ElementForces::update(const NodalState& state, const NodeLayout& layout, Real dt,
                           WorkTimes& work)
{
  TimedRegion region("coplane::element::update");
  for (std::size_t b = 0; b < blocks_.size(); ++b)
  {
    if (isRigid(b))
      continue;
    const ConstArray<Real> dilatation = nodalDilatation(b, state, layout, dt, work);
    const WorkWatch watch(work.elements[b]);
    blocks_[b].update(state.x, state.v, dt, dilatation);
  }
}

void ElementForces::addNodalTensions(const NodalState& state, const NodeLayout& layout,
                                     WorkTimes& work)
{
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (!isRigid(b) && blocks_[b].options().form == ElementForm::NodalPressure)
      addNodalTension(b, state, layout, work);
}

/// Sums around every node of two numbers of the living elements of one block, the first over the
/// second. Collective.
template <class Above, class Below>
const Array<Real>& ElementForces::meanAtNodes(std::size_t b, const NodeLayout& layout,
                                              const Above& above, const Below& below)
{
  if (int(atNodes_.extent(0)) != layout.size())
    atNodes_ = Array<Real>("coplane::dynamics::atNodes", layout.size());
  const auto gather = gathers_[b].view();
  const auto mean = atNodes_;
  const ElementBlock* const elements = &blocks_[b];
  const int corners = topology(elements->type()).nodes;
  parallelFor(
      "coplane::dynamics::meanAtNodes", layout.owned(), KOKKOS_LAMBDA(const int n) {
        Real sum = 0, weight = 0;
        for (const int entry : gather[n])
          if (elements->isAlive(entry / corners))
          {
            sum += above(entry / corners);
            weight += below(entry / corners);
          }
        mean(n) = weight > 0 ? sum / weight : 0;
      });
  layout.refresh(atNodes_);
  return atNodes_;
}

/// The mean stress of an element acts through the volumes that its nodes give to all elements
/// around them. Collective.
void ElementForces::addNodalTension(std::size_t b, const NodalState& state,
                                    const NodeLayout& layout, WorkTimes& work)
{
  ElementBlock& block = blocks_[b];
  const auto tensions = block.meanTension();
  const auto volumes = block.volume();
  const ConstArray<Real> tension = meanAtNodes(
      b, layout, [tensions](int e) { return tensions(0, e); },
      [volumes](int e) { return volumes(e); });
  const WorkWatch watch(work.elements[b]);
  block.addNodalTension(state.x, tension);
}

/// Dilatation of the step at every node from the elements of one block around it; empty where the
/// block does not ask for it. Collective when it does.
ConstArray<Real> ElementForces::nodalDilatation(std::size_t b, const NodalState& state,
                                                const NodeLayout& layout, Real dt, WorkTimes& work)
{
  ElementBlock& block = blocks_[b];
  if (block.options().form != ElementForm::NodalPressure || dt == 0)
    return {};
  {
    const WorkWatch watch(work.elements[b]);
    block.findVolumeChanges(state.x, state.v, dt);
  }
  const auto changes = block.volumeChanges();
  return meanAtNodes(
      b, layout, [changes](int e) { return changes(0, e); },
      [changes](int e) { return changes(1, e); });
}

namespace
{
/// Adds the forces of the elements of a block to owned nodes.
void gatherBlock(const ListsView<int>& gather, const ElementBlock& block, bool first,
                 const NodeVectors& force)
{
  // Corners of all elements one after another, as the entries count them.
  const Real* const cornerForce = block.cornerForce().data();
  parallelFor(
      "coplane::dynamics::gatherForces", int(force.extent(0)), KOKKOS_LAMBDA(const int n) {
        Vec3 sum = first ? Vec3{} : at(force, n);
        for (const int entry : gather[n])
        {
          const Real* const f = cornerForce + 3 * std::size_t(entry);
          sum += {f[0], f[1], f[2]};
        }
        set(force, n, sum);
      });
}
} // namespace

void ElementForces::gather(const NodeVectors& force) const
{
  TimedRegion region("coplane::dynamics::gatherForces");
  bool first = true;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
  {
    if (isRigid(b))
      continue;
    gatherBlock(gathers_[b].view(), blocks_[b], first, force);
    first = false;
  }
  if (first)
    Kokkos::deep_copy(force, 0.0);
}

Real ElementForces::smallestStep() const
{
  Real least = infinity;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (!isRigid(b))
      least = std::min(least, blocks_[b].smallestStableStep());
  return least;
}

Real ElementForces::leastStepAround(int node) const
{
  Real least = infinity;
  forEachAround(node,
                [&](std::size_t b, int e) { least = std::min(least, blocks_[b].stableStep(e)); });
  return least;
}

Real ElementForces::massOverSquaredSteps(int node) const
{
  Real sum = 0;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
  {
    if (isRigid(b))
      continue;
    const int corners = topology(blocks_[b].type()).nodes;
    for (const int entry : gathers_[b][node])
    {
      const Real step = blocks_[b].stableStep(entry / corners);
      sum += blocks_[b].cornerMass(entry / corners, entry % corners) / (step * step);
    }
  }
  return sum;
}

GlobalId ElementForces::limitingElement(const RankMesh& mesh, int node) const
{
  Real least = infinity;
  GlobalId limiting = 0;
  forEachAround(node,
                [&](std::size_t b, int e)
                {
                  const Real step = blocks_[b].stableStep(e);
                  const GlobalId id = mesh.blocks[b].elementIds[e];
                  if (step < least || (step == least && id < limiting))
                  {
                    least = step;
                    limiting = id;
                  }
                });
  return limiting;
}

void ElementForces::throwIfInverted(const Model& model, const Clock& clock) const
{
  for (std::size_t b = 0; b < blocks_.size(); ++b)
  {
    const int e = isRigid(b) ? -1 : blocks_[b].invertedElement();
    if (e >= 0)
      fail(ExitCode::Computation,
           "cycle {}, t = {:.6e} s: element {} (block '{}') has turned inside out or has a force "
           "that is not finite; its volume is {:.3e} m^3. Refine the mesh there, lower "
           "time.step_factor, or raise blocks.<name>.hourglass.stiffness.",
           clock.cycle, clock.time, model.mesh.blocks[b].elementIds[e], model.blocks[b].name,
           blocks_[b].volume(e));
  }
}

namespace
{
std::string nameOfBlock(const RankMesh::Block& block)
{
  return fmt::format("elements/block_{}", block.id);
}
} // namespace

void ElementForces::save(const RankMesh& mesh, StateTables& out) const
{
  for (std::size_t b = 0; b < blocks_.size(); ++b)
  {
    const RankMesh::Block& part = mesh.blocks[b];
    KeyedRows elements;
    elements.columns = blocks_[b].stateColumns();
    for (int e = 0; e < part.elements(); ++e)
      if (part.owned[e])
        blocks_[b].saveState(e, elements.add({part.elementIds[e]}));
    out.rows(nameOfBlock(part), elements);
  }
}

void ElementForces::restore(const RankMesh& mesh, const StateSource& in)
{
  for (std::size_t b = 0; b < blocks_.size(); ++b)
  {
    const RankMesh::Block& part = mesh.blocks[b];
    const KeyedRows rows = in.rowsOf(nameOfBlock(part), blocks_[b].stateColumns(), part.elementIds);
    for (int e = 0; e < part.elements(); ++e)
      blocks_[b].restoreState(e, rows.row(std::size_t(e)));
  }
}
} // namespace coplane
