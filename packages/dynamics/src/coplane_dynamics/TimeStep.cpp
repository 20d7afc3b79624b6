#include <coplane_core/Log.hpp>
#include <coplane_dynamics/TimeStep.hpp>
#include <coplane_element/StableStep.hpp>
#include <coplane_mesh/FaceName.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace coplane
{
std::string StepControl::text() const
{
  if (!(stableStep < infinity) && !motion && !meeting)
    return "nothing: no element deforms and nothing touches";
  if (motion)
    return fmt::format(
        "the motion of faces: at {:.4g} m/s relative to each other they may not pass "
        "more than a fraction of the thinnest element behind one, {:.4g} m, in a "
        "step",
        relativeSpeed, thinnest);
  if (meeting)
    return fmt::format("rigid bodies that may meet with an edge or a corner, at up to {:.4g} m/s",
                       relativeSpeed);
  if (!freeField.empty())
    return fmt::format("the free-field column beside side set '{}'", freeField);
  if (scaledMass)
    return "time.mass_scaling.step, for which masses are raised";
  if (rigid)
    return fmt::format("contact of the rigid body with node {}", node);
  if (!contact)
    return fmt::format("element {} at node {}", element, node);
  if (line)
    return fmt::format("a line at node {}", node);
  return fmt::format("contact at node {}, most by {} against {}", node, faceName(faceId[0]),
                     faceName(faceId[1]));
}

/// Bound on the rate by which contact damping acts, from a bound on the frequency of contact [1/s]
/// (docs/theory/scp.md, "Stable step with contact").
Real TimeStep::dampingRate(Real frequency) const
{
  return 4 * contactDamping_ * frequency;
}

Real TimeStep::nodeStep(const Parts& parts, int node) const
{
  if (scaling_.acts())
    return scaling_.nodeStep(parts, node);
  const Real stiffness = parts.state.contactStiffness(node),
             elements = parts.elements.leastStepAround(node);
  if (stiffness == 0)
    return elements;
  const Real omega = 2 / elements, contact = stiffness / parts.state.mass(node);
  const Real squared = omega * omega + contact;
  return squared > 0 ? stableStep(squared, dampingRate(std::sqrt(contact))) : 0;
}

Real TimeStep::bodyStep(const Parts& parts) const
{
  const Real frequency = 2 / parts.bodies().stableStep();
  return frequency > 0 ? stableStep(frequency * frequency, dampingRate(frequency)) : infinity;
}

Real TimeStep::stableOfBodies(const Parts& parts) const
{
  return std::min(bodyStep(parts), parts.motion.freeFields().stableStep());
}

Real TimeStep::stable(const Parts& parts) const
{
  if (scaling_.acts())
    return std::min({stableOfBodies(parts), scaling_.stable(parts)});
  const auto stiffness = parts.state.contactStiffness;
  const auto mass = parts.state.mass;
  const NodalMotion* const motion = &parts.motion;
  if (options_.subcyclingLevels > 1)
  {
    // By nodes throughout: those that are substepped allow that much longer cycles.
    const auto substeps = parts.state.substeps;
    return std::min(stableOfBodies(parts), parallelMin(
                                               "coplane::dynamics::stableStep",
                                               parts.layout.owned(), KOKKOS_LAMBDA(const int n) {
                                                 return !(mass(n) > 0) || motion->followsBody(n)
                                                            ? infinity
                                                            : substeps(n) * nodeStep(parts, n);
                                               }));
  }
  const Real least = std::min(stableOfBodies(parts), parts.elements.smallestStep());
  if (!parts.contact && parts.lines.empty())
    return least;
  const Real atContacts = parallelMin(
      "coplane::dynamics::stableStep", parts.layout.owned(), KOKKOS_LAMBDA(const int n) {
        if (stiffness(n) == 0 || !(mass(n) > 0) || motion->followsBody(n))
          return infinity;
        return nodeStep(parts, n);
      });
  return std::min(least, atContacts);
}

namespace
{
/// When neither elements nor contact limit the step (rigid bodies in free flight): a thousandth of
/// the run, and no node may leave the skin of contact in one step. Collective.
Real stepOfFreeBodies(const Parts& parts)
{
  constexpr Real ofTheRun = 1e-3;
  const Real step = ofTheRun * parts.model.time.end;
  if (!parts.contact)
    return step;
  const NodalState& state = parts.state;
  std::vector<Real> fastest{0, 0};
  for (int n = 0; n < parts.layout.owned(); ++n)
  {
    fastest[0] = std::max(fastest[0], norm(at(state.v, n)));
    if (state.mass(n) > 0)
      fastest[1] =
          std::max(fastest[1], norm(at(state.force, n) + at(state.external, n)) / state.mass(n));
  }
  parts.comm.max(fastest);
  // v dt + a dt^2 is at most a quarter of the skin for each of two bodies.
  const Real room = 0.25 * parts.contact->skin();
  const Real root = std::sqrt(fastest[0] * fastest[0] + 4 * fastest[1] * room);
  return fastest[0] + root > 0 ? std::min(step, 2 * room / (fastest[0] + root)) : step;
}
} // namespace

Real TimeStep::choose(Real stable, const MotionLimits& limits, Real relativeSpeed,
                      const Parts& parts)
{
  const Clock& clock = parts.clock;
  stable_ = stable;
  limits_ = limits;
  Real step = options_.stepFactor * stable;
  if (scaling_.acts() && stable == scaling_.target())
    step = options_.massScaling->step; // without rounding
  step = std::min({step, motionStep(limits.thinnest, relativeSpeed),
                   meetingStep(limits.massOverStiffness, relativeSpeed)});
  if (options_.maximumStep)
    step = std::min(step, *options_.maximumStep);
  if (options_.fixedStep)
  {
    if (*options_.fixedStep > step)
      logWarning("fixed step above the stable step",
                 fmt::format("cycle {}: time.fixed_step = {:.4e} s is above the stable step with "
                             "its safety factor, {:.4e} s",
                             clock.cycle, *options_.fixedStep, step));
    step = *options_.fixedStep;
  }
  if (!(step < infinity))
    step = stepOfFreeBodies(parts);
  if (!options_.fixedStep)
    step = growth_.next(step, clock.nextStep);
  largestNext_ = options_.fixedStep ? step : StepGrowth::perCycle * step;
  return step;
}

void TimeStep::boundFirst(Real elements, const MotionLimits& limits, Real relativeSpeed)
{
  limits_ = limits;
  if (scaling_.acts())
    elements = std::max(elements, scaling_.target());
  elements = std::ldexp(elements, options_.subcyclingLevels - 1); // a cycle may be so much longer
  Real least = std::min({options_.stepFactor * elements, motionStep(limits.thinnest, relativeSpeed),
                         meetingStep(limits.massOverStiffness, relativeSpeed)});
  least = std::min(least, options_.maximumStep.value_or(infinity));
  least = options_.fixedStep.value_or(least);
  largestNext_ = least < infinity ? least : 0; // else nothing moves relative to anything
}

namespace
{
/// The plane that adds most to the stiffness of a node: the ids of its faces.
void namePlaneAt(const Contact& contact, int node, GlobalId* faceId)
{
  // Planes stand in the order of their keys: the first of several equal ones is named.
  Real most = 0;
  for (std::size_t p = 0; p < contact.planes().size(); ++p)
  {
    const Plane& plane = contact.planes()[p];
    if (plane.face[0] < 0 || !(plane.nodeStiffness > most))
      continue;
    for (int side = 0; side < 2; ++side)
    {
      const Face& face = contact.faces()[plane.face[side]];
      if (std::find(face.nodes, face.nodes + face.count, node) == face.nodes + face.count)
        continue;
      most = plane.nodeStiffness;
      std::copy(plane.faceId, plane.faceId + 2, faceId);
    }
  }
}
} // namespace

StepControl TimeStep::control(const Parts& parts, const MotionLimits& mine,
                              Real relativeSpeed) const
{
  const std::vector<GlobalId>& ids = parts.layout.ids();
  const Array<Real>&stiffness = parts.state.contactStiffness, &mass = parts.state.mass;
  StepControl control;
  int node = -1;
  for (int n = 0; n < parts.layout.owned(); ++n)
  {
    if (!(mass(n) > 0) || parts.motion.followsBody(n))
      continue;
    const Real step = parts.state.substeps(n) * nodeStep(parts, n);
    if (step < control.stableStep ||
        (node >= 0 && step == control.stableStep && ids[n] < ids[node]))
    {
      control.stableStep = step;
      node = n;
    }
  }
  const Real here = control.stableStep, bodies = bodyStep(parts);
  const Real least = parts.comm.min(here);
  control.stableStep = std::min(least, bodies);
  if (scaling_.acts())
  {
    const Real cap = std::max(scaling_.target(), parts.comm.min(parts.elements.smallestStep()));
    control.scaledMass = cap <= control.stableStep && cap == scaling_.target();
    control.stableStep = std::min(control.stableStep, cap);
  }
  if (const FreeFieldColumn* const column = parts.motion.freeFields().columnWithLeastStep();
      column && column->stableStep() < control.stableStep)
  {
    control.stableStep = column->stableStep();
    control.freeField = column->name();
    control.scaledMass = false;
  }
  if (parts.contact)
  {
    control.relativeSpeed = relativeSpeed;
    control.thinnest = parts.comm.min(mine.thinnest);
    const Real motion = motionStep(control.thinnest, relativeSpeed),
               meeting = meetingStep(parts.comm.min(mine.massOverStiffness), relativeSpeed),
               waves = options_.stepFactor * control.stableStep;
    control.motion = motion < waves && motion <= meeting;
    control.meeting = meeting < waves && meeting < motion;
  }
  if (bodies < least)
  {
    control.rigid = control.contact = true;
    control.node = parts.bodies().nodeThatLimits(parts.layout);
    return control;
  }
  constexpr GlobalId none = std::numeric_limits<GlobalId>::max();
  const bool candidate = node >= 0 && here == least;
  control.node = parts.comm.min(candidate ? ids[node] : none);
  if (candidate && ids[node] == control.node)
  {
    const Real omega = 2 / parts.elements.leastStepAround(node);
    control.contact = stiffness(node) / mass(node) > omega * omega;
    control.line = control.contact && parts.lines.stiffnessAt(node) > 0.5 * stiffness(node);
    control.element = parts.elements.limitingElement(parts.mesh(), node);
    if (parts.contact)
      namePlaneAt(*parts.contact, node, control.faceId);
  }
  control.contact = parts.comm.max(std::int64_t(control.contact)) > 0;
  control.line = parts.comm.max(std::int64_t(control.line)) > 0;
  for (GlobalId* id : {&control.element, &control.faceId[0], &control.faceId[1]})
    *id = parts.comm.max(*id);
  return control;
}
} // namespace coplane
