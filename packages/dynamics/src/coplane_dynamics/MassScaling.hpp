#pragma once

#include <coplane_dynamics/Parts.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// What mass scaling has given to a block, over all ranks. Of nodes that blocks share each block
/// has the part that it has of their own mass.
struct AddedMass
{
  Real own = 0;     ///< mass of its elements [kg]
  Real added = 0;   ///< [kg]
  Vec3 momentum{};  ///< of what is added, at n + 1/2 [N s]
  Real kinetic = 0; ///< of what is added, 1/2 sum m v(n-1/2).v(n+1/2) [J]

  Real ratio() const { return own > 0 ? added / own : 0; }
};

/// Raises the masses of nodes until elements, planes and lines allow a given step. What is added
/// has inertia and no weight, and never leaves a node.
///
/// Elements have omega_e^2 as a bound of their frequencies with their own lumped masses m_en, so
/// u.K u <= sum_n u_n^2 sum_e omega_e^2 m_en + k_n u_n^2 with the stiffness k_n of planes and lines
/// at the nodes. Hence no frequency of the whole is above omega if every node has
/// m_n omega^2 >= sum_e omega_e^2 m_en + k_n. Dampings are in the stable steps dt_e of elements;
/// that of planes, 4 zeta sqrt(k_n / m_n), makes the condition of a node for the step dt
///
///     sqrt(m_n) >= dt (zeta sqrt(k_n) + sqrt(zeta^2 k_n + sum_e m_en / dt_e^2 + k_n / 4)).
class MassScaling
{
public:
  /// @param contactDamping the larger damping ratio of planes [-]
  MassScaling(const TimeOptions& options, Real contactDamping);
  bool acts() const { return options_.massScaling.has_value(); }

  /// Raises masses of owned nodes. Velocities stay: what comes has momentum and kinetic energy, and
  /// is booked as an impulse and external work at n + 1/2, or not, at the start. Whether some were
  /// raised on this rank.
  bool raise(const Parts& parts, NodalState& state, bool atStart) const;
  /// Stable step at an owned node, without safety factor; 0 when a stiffness is no number [s].
  Real nodeStep(const Parts& parts, int node) const;
  /// Stable step of elements, planes and lines of this rank; no larger than what masses are raised
  /// for, unless elements allow that without [s].
  Real stable(const Parts& parts) const;
  /// Stable step that masses are raised for [s].
  Real target() const { return options_.massScaling->step / options_.stepFactor; }

  /// Of each block. Collective.
  static std::vector<AddedMass> byBlock(const Parts& parts);
  /// Which blocks have more than the limit; empty: none. Collective.
  std::string beyondLimit(const Parts& parts) const;

private:
  /// m_n over the square of its stable step [kg/s^2].
  Real massPerSquaredStep(const Parts& parts, int node) const;

  TimeOptions options_;
  Real contactDamping_;
};
} // namespace coplane
