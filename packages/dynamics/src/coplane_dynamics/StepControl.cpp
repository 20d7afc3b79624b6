// What limits the time step, by name.
#include <coplane_dynamics/Solver.hpp>
#include <coplane_element/StableStep.hpp>
#include <coplane_mesh/FaceName.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace coplane
{
std::string StepControl::text() const
{
  if (motion)
    return fmt::format(
        "the motion of faces: at {:.4g} m/s relative to each other they may not pass "
        "more than a fraction of the thinnest element behind one, {:.4g} m, in a "
        "step",
        relativeSpeed, thinnest);
  if (rigid)
    return fmt::format("contact of the rigid body with node {}", node);
  if (!contact)
    return fmt::format("element {} at node {}", element, node);
  return fmt::format("contact at node {}, most by {} against {}", node, faceName(faceId[0]),
                     faceName(faceId[1]));
}

Real Solver::leastElementStep(int node) const
{
  Real least = infinity;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
  {
    if (isRigid(b))
      continue;
    const int corners = topology(blocks_[b].type()).nodes;
    for (int i = gathers_[b].start(node); i < gathers_[b].start(node + 1); ++i)
      least = std::min(least, blocks_[b].stableStep()(gathers_[b].entry(i) / corners));
  }
  return least;
}

Real Solver::nodeStep(int node) const
{
  const Real stiffness = contactStiffness_(node), elements = leastElementStep(node);
  if (stiffness == 0)
    return elements;
  const Real omega = 2 / elements, contact = stiffness / state_.mass(node);
  const Real squared = omega * omega + contact;
  return squared > 0 ? coplane::stableStep(squared, contactDamping(std::sqrt(contact))) : 0;
}

Real Solver::contactDamping(Real frequency) const
{
  return 4 * std::max(model_.contact.dampNormal, model_.contact.dampShear) * frequency;
}

Real Solver::rigidStep() const
{
  const Real frequency = 2 / rigid_->stableStep();
  return frequency > 0 ? coplane::stableStep(frequency * frequency, contactDamping(frequency))
                       : infinity;
}

Real Solver::stableStep() const
{
  Real least = rigidStep();
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (!isRigid(b))
      least = std::min(least, blocks_[b].smallestStableStep());
  if (!contact_)
    return least;
  const auto stiffness = contactStiffness_;
  const auto mass = state_.mass;
  const auto followsBody = followsBody_;
  const Solver* const solver = this;
  const Real atContacts = parallelMin(
      "coplane::dynamics::stableStep", layout_.owned(), KOKKOS_LAMBDA(const int n) {
        if (stiffness(n) == 0 || !(mass(n) > 0) || followsBody(n))
          return infinity;
        return solver->nodeStep(n);
      });
  return std::min(least, atContacts);
}

StepControl Solver::stepControl() const
{
  StepControl control;
  int node = -1;
  for (int n = 0; n < layout_.owned(); ++n)
  {
    if (!(state_.mass(n) > 0) || followsBody_(n))
      continue;
    const Real step = nodeStep(n);
    if (step < control.stableStep ||
        (step == control.stableStep && layout_.ids()[n] < layout_.ids()[node]))
    {
      control.stableStep = step;
      node = n;
    }
  }
  const Real least = comm_->min(control.stableStep);
  if (contact_)
  {
    control.relativeSpeed = relativeSpeed_;
    control.thinnest = comm_->min(contact_->thinnestElement());
    control.motion =
        motionStep(control.thinnest) < model_.time.stepFactor * std::min(least, rigidStep());
  }
  if (rigidStep() < least)
  {
    control.stableStep = rigidStep();
    control.rigid = control.contact = true;
    control.node = rigid_->nodeThatLimits(layout_);
    return control;
  }
  constexpr GlobalId none = std::numeric_limits<GlobalId>::max();
  const bool mine = node >= 0 && control.stableStep == least;
  control.node = comm_->min(mine ? layout_.ids()[node] : none);
  bool contact = false;
  if (mine && layout_.ids()[node] == control.node)
  {
    const Real omega = 2 / leastElementStep(node);
    contact = contactStiffness_(node) / state_.mass(node) > omega * omega;
  }
  control.contact = comm_->max(std::int64_t(contact)) > 0;
  control.stableStep = least;
  if (mine && layout_.ids()[node] == control.node)
    nameWhatLimits(node, control);
  for (GlobalId* id : {&control.element, &control.faceId[0], &control.faceId[1]})
    *id = comm_->max(*id);
  return control;
}

void Solver::nameWhatLimits(int node, StepControl& control) const
{
  Real least = infinity;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
  {
    if (isRigid(b))
      continue;
    const int corners = topology(blocks_[b].type()).nodes;
    for (int i = gathers_[b].start(node); i < gathers_[b].start(node + 1); ++i)
    {
      const int element = gathers_[b].entry(i) / corners;
      const Real step = blocks_[b].stableStep()(element);
      const GlobalId id = model_.mesh.blocks[b].elementIds[element];
      if (step < least || (step == least && id < control.element))
      {
        least = step;
        control.element = id;
      }
    }
  }
  if (!contact_)
    return;
  // Planes stand in the order of their keys: the first of several equal ones is named.
  Real most = 0;
  for (std::size_t p = 0; p < contact_->planes().extent(0); ++p)
  {
    const Plane& plane = contact_->planes()(p);
    if (plane.face[0] < 0 || !(plane.nodeStiffness > most))
      continue;
    for (int side = 0; side < 2; ++side)
    {
      const Face& face = contact_->faces()[plane.face[side]];
      for (int k = 0; k < face.count; ++k)
        if (face.nodes[k] == node)
        {
          most = plane.nodeStiffness;
          control.faceId[0] = plane.faceId[0];
          control.faceId[1] = plane.faceId[1];
        }
    }
  }
}
} // namespace coplane
