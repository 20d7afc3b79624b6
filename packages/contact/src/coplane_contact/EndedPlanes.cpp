#include <coplane_contact/EndedPlanes.hpp>

namespace coplane
{
void PlaneEnergySums::add(const Plane& plane, Real stored)
{
  sums[Work].add(plane.work);
  sums[Stored].add(stored);
  sums[Friction].add(plane.frictionWork);
  sums[Hysteresis].add(plane.hysteresisWork);
  sums[Fracture].add(plane.fractureWork);
  sums[Damping].add(plane.dampingWork);
}

void PlaneEnergySums::add(const PlaneEnergySums& other)
{
  for (int term = 0; term < Terms; ++term)
    sums[term].add(other.sums[term]);
}

ContactEnergy PlaneEnergySums::energyOf(const Real* totals)
{
  ContactEnergy energy;
  energy.work = totals[Work];
  energy.stored = totals[Stored];
  energy.friction = totals[Friction];
  energy.hysteresis = totals[Hysteresis];
  energy.fracture = totals[Fracture];
  energy.damping = totals[Damping];
  energy.eroded = totals[Eroded];
  return energy;
}
} // namespace coplane
