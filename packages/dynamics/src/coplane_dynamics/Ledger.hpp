#pragma once

#include <coplane_contact/Contact.hpp>
#include <coplane_core/Vec3.hpp>
#include <coplane_dynamics/DebrisEnergy.hpp>
#include <coplane_dynamics/Line.hpp>

namespace coplane
{
/// All energies at one time, sums over all ranks with the same bits for any number of them [J].
struct EnergyBalance
{
  Real kinetic = 0;  ///< 1/2 sum m v(n-1/2).v(n+1/2)
  Real internal = 0; ///< of the elements: elastic and plastic work, and what `chemical` has added
  Real plastic = 0;  ///< part of internal that is lost
  Real bending = 0;  ///< part of plastic: of bending within elements (HourglassReturn.hpp)
  Real hourglass = 0;
  Real viscous = 0;        ///< bulk viscosity
  Real eroded = 0;         ///< of elements that have died, when they died
  ContactEnergy contact;   ///< stored, friction, hysteresis, damping, remainder
  LineEnergy lines;        ///< stored, plastic, bond, dowel, rupture, remainder
  DebrisEnergy debris;     ///< stored, remainder: of mass points that faces stop
  Real massDamping = 0;    ///< taken out by mass-proportional damping
  Real localDamping = 0;   ///< taken out by local damping
  Real kineticDamping = 0; ///< taken out by stops at peaks of the kinetic energy
  Real externalWork = 0;   ///< of loads and reactions, and of pretension of lines
  Real chemical = 0;       ///< released by explosives, a source as external work is
  Real initial = 0;        ///< total at the start
  Real nodalWork = 0;      ///< of all forces on nodes; kinetic energy minus its initial value, to
                           ///< round-off at constant dt

  Real total() const
  {
    return kinetic + internal + hourglass + viscous + eroded + contact.work + lines.work +
           debris.work + massDamping + localDamping + kineticDamping;
  }
  /// What the balance lacks; the contact remainder is part of contact.work and listed by itself.
  Real error() const { return total() - externalWork - chemical - initial; }
  /// The energy in play, by which errors are judged.
  Real scale() const;
};

/// Momenta at n + 1/2 and what external forces have added.
struct Momenta
{
  Vec3 linear{};  ///< sum m v [N s]
  Vec3 angular{}; ///< sum x(n) x m v(n+1/2), about the origin [N m s]
  Vec3 impulse{}; ///< of loads, reactions and damping since the start
  Vec3 angularImpulse{};
  Vec3 initialLinear{};
  Vec3 initialAngular{};
  Vec3 linearError() const { return linear - initialLinear - impulse; }
  Vec3 angularError() const { return angular - initialAngular - angularImpulse; }
  Real magnitude = 0; ///< sum m |v|, by which errors are judged
};

struct Parts;
struct RelaxationState;

/// Sums energies and momenta, and keeps what they were at first.
class Ledger
{
public:
  /// At the end of the start, after the first kick. Collective.
  void open(const Parts& parts, const RelaxationState& relaxation);
  const EnergyBalance& initialEnergy() const { return initialEnergy_; }
  // Over all ranks, the same bits on all. Collective.
  EnergyBalance energy(const Parts& parts, const RelaxationState& relaxation) const;
  Momenta momenta(const Parts& parts) const;

  /// Calls f(name, struct) for what a restart needs: structs of nothing but numbers.
  template <class Self, class F>
  static void forEachStruct(Self& self, F&& f)
  {
    f("solver/initial_energy", self.initialEnergy_);
    f("solver/initial_momenta", self.initialMomenta_);
  }

private:
  EnergyBalance initialEnergy_;
  Momenta initialMomenta_;
};
} // namespace coplane
