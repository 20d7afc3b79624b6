#pragma once

#include <coplane_dynamics/MassScaling.hpp>
#include <coplane_dynamics/Parts.hpp>
#include <coplane_dynamics/StepGrowth.hpp>

#include <string>

namespace coplane
{
/// What limits the time step.
struct StepControl
{
  Real stableStep = infinity;           ///< without the safety factor [s]
  GlobalId node = 0;                    ///< the node with it (the lowest id when several have)
  bool scaledMass = false;              ///< masses are raised for this step and no larger one
  bool motion = false;                  ///< the motion of faces limits it, see TimeStep::motionStep
  bool meeting = false;                 ///< that of rigid bodies does, see TimeStep::meetingStep
  Real relativeSpeed = 0, thinnest = 0; ///< with motion or meeting [m/s], [m]
  bool rigid = false;                   ///< a rigid body, which has the node, is what limits it
  bool contact = false;        ///< whether contact adds more than elements to its frequency
  bool line = false;           ///< with contact: most of that by a line
  std::string freeField;       ///< side set whose free-field column limits it; empty: none does
  GlobalId element = 0;        ///< of those around the node the one with the smallest step
  GlobalId faceId[2] = {0, 0}; ///< the plane that adds most to the node's contact stiffness, if any
  /// "element 12 at node 7", or "contact at node 7, most by side 1 of element 3 against side ..."
  std::string text() const;
};

/// What the motion of faces relative to each other may not pass in a step.
struct MotionLimits
{
  Real thinnest = infinity; ///< least thickness of an element behind a face [m]
  /// Of rigid bodies that can give way the least mass over stiffness of contact, per area, and
  /// length of the body; in two dimensions over 1 m in place of the length [m s^2]
  Real massOverStiffness = infinity;
};

/// Chooses the time step.
class TimeStep
{
public:
  /// @param contactDamping the larger damping ratio of planes [-]
  TimeStep(const TimeOptions& options, Real contactDamping)
      : options_(options), contactDamping_(contactDamping), scaling_(options, contactDamping)
  {
  }

  const MassScaling& scaling() const { return scaling_; }
  /// Of all elements, contacts and rigid bodies of this rank [s]; 0 when an element has turned
  /// inside out, or a force or stiffness is no number.
  Real stable(const Parts& parts) const;
  /// Of elements and contacts at an owned node, in each of its steps in a cycle [s].
  Real nodeStep(const Parts& parts, int node) const;
  /// Of rigid bodies and free fields [s].
  Real stableOfBodies(const Parts& parts) const;
  /// The step of the next cycle. The arguments are the same on all ranks. Collective.
  /// @param stable of all ranks [s]
  /// @param limits of all ranks
  /// @param relativeSpeed bound on the speed of any two nodes relative to each other [m/s]
  Real choose(Real stable, const MotionLimits& limits, Real relativeSpeed, const Parts& parts);
  /// A bound of the first step, for what looks ahead before it is known, from `elements`, the
  /// stable step of the elements of all ranks [s].
  void boundFirst(Real elements, const MotionLimits& limits, Real relativeSpeed);
  /// Stable step that the last step was chosen from [s].
  Real chosenFrom() const { return stable_; }
  /// Whether the motion of faces bounds the step below this part of what a stable step, with its
  /// safety factor, allows.
  bool motionIsFasterThan(Real part, Real relativeSpeed, Real stable) const
  {
    return motionStep(limits_.thinnest, relativeSpeed) < part * options_.stepFactor * stable;
  }
  /// How far nodes move against each other in a stable step, over the thinnest element [-].
  Real motionInStableStep(Real relativeSpeed, Real stable) const
  {
    return limits_.thinnest > 0 ? relativeSpeed * stable / limits_.thinnest : 0;
  }
  /// Bound for the step after the one in progress [s].
  Real largestNext() const { return largestNext_; }
  /// Collective.
  /// @param mine limits of this rank
  StepControl control(const Parts& parts, const MotionLimits& mine, Real relativeSpeed) const;
  /// In which faces move by a fraction of the thinnest element behind one, relative to each other:
  /// no face may jump over an element, nor deep into it, between two looks at their closure [s].
  static Real motionStep(Real thinnest, Real relativeSpeed)
  {
    return relativeSpeed > 0 ? motionPerStep * thinnest / relativeSpeed : infinity;
  }
  /// In which rigid bodies that meet with an edge or a corner keep their energy. What touches there
  /// gets wider as it gets deeper, so it has no stiffness yet by which a step could be told [s].
  Real meetingStep(Real massOverStiffness, Real relativeSpeed) const
  {
    return relativeSpeed > 0
               ? options_.stepFactor * std::cbrt(partInMeeting * massOverStiffness / relativeSpeed)
               : infinity;
  }

  /// Calls f(number) for all that a restart needs, in the order of checkpoints.
  template <class Self, class F>
  static void forEachNumber(Self& self, F&& number)
  {
    number(self.growth_.calm);
    number(self.largestNext_);
  }

private:
  Real bodyStep(const Parts& parts) const; ///< of rigid bodies [s]
  Real dampingRate(Real frequency) const;

  static constexpr Real motionPerStep = 0.2; ///< of the thickness of an element
  static constexpr Real partInMeeting = 0.02;

  TimeOptions options_;
  Real contactDamping_;
  MassScaling scaling_;
  StepGrowth growth_;
  Real largestNext_ = 0;
  Real stable_ = infinity; ///< that the last step was chosen from
  MotionLimits limits_;    ///< the same
};
} // namespace coplane
