#pragma once

#include <coplane_joint/JointLaw.hpp>

namespace coplane
{
/// One point of a joint that is led by its gap and slip, with the ledger of its work per area. The
/// normal is z; slip is in x and y, of the higher face relative to the lower one.
class JointPoint
{
public:
  JointPoint(const JointLaw& law, const JointFit& fit, bool declared) : law_(law), fit_(fit)
  {
    state_.bonded = declared && law.cohesive();
  }

  /// Work of the mean tractions of a step is booked.
  void moveTo(Real gap, const Vec3& slip, Real dt);

  /// The gap at which the traction equals traction + stiffness (gap - from), after a step to this
  /// slip; the point itself does not move. Throws Error(ExitCode::Computation).
  Real balancedGap(const Vec3& slip, Real dt, Real traction, Real stiffness, Real from) const;

  Real closureUnder(Real traction) const { return law_.closureUnder(fit_, traction); }
  const JointLaw& law() const { return law_; }
  const JointState& state() const { return state_; }
  const JointResponse& response() const { return response_; }
  Real time() const { return time_; }
  Real gap() const { return gap_; }
  Real offset() const { return offset_; }
  Real closure() const { return offset_ - gap_; }
  const Vec3& slip() const { return slip_; }
  Real work() const { return work_; }
  Real stored() const { return law_.stored(fit_, closure(), state_); }
  Real friction() const { return friction_; }
  Real fracture() const { return fracture_; }
  Real hysteresis() const { return hysteresis_; }

private:
  JointLaw law_;
  JointFit fit_;
  JointState state_;
  JointResponse response_;
  Vec3 slip_{};
  Real time_ = 0, gap_ = 0, offset_ = 0;
  Real work_ = 0, friction_ = 0, fracture_ = 0, hysteresis_ = 0;
};
} // namespace coplane
