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

std::vector<Real> EndedPlanes::numbers(const Comm& comm) const
{
  std::vector<PlaneKind> kinds;
  for (const auto& [kind, sums] : byKind_)
    kinds.push_back(kind);
  kinds = comm.allGather(kinds);
  std::sort(kinds.begin(), kinds.end());
  kinds.erase(std::unique(kinds.begin(), kinds.end()), kinds.end());
  std::vector<ExactSum> sums;
  for (const PlaneKind& kind : kinds)
  {
    const auto mine = byKind_.find(kind);
    for (int term = 0; term < PlaneEnergySums::Terms; ++term)
      sums.push_back(mine == byKind_.end() ? ExactSum{} : mine->second.sums[term]);
  }
  const std::vector<ExactSum> totals = ExactSum::totals(sums, comm);
  std::vector<Real> numbers;
  for (std::size_t k = 0; k < kinds.size(); ++k)
  {
    numbers.insert(numbers.end(),
                   {Real(kinds[k].joint), Real(kinds[k].blocks[0]), Real(kinds[k].blocks[1])});
    for (int term = 0; term < PlaneEnergySums::Terms; ++term)
    {
      const auto digits = totals[k * PlaneEnergySums::Terms + std::size_t(term)].digits();
      numbers.insert(numbers.end(), digits.begin(), digits.end());
    }
  }
  return numbers;
}

void EndedPlanes::addNumbers(const std::vector<Real>& numbers)
{
  constexpr std::size_t size = 3 + PlaneEnergySums::Terms * ExactSum::digitCount;
  for (std::size_t at = 0; at + size <= numbers.size(); at += size)
  {
    PlaneKind kind;
    kind.joint = std::uint16_t(numbers[at]);
    kind.blocks[0] = std::uint16_t(numbers[at + 1]);
    kind.blocks[1] = std::uint16_t(numbers[at + 2]);
    for (int term = 0; term < PlaneEnergySums::Terms; ++term)
      byKind_[kind].sums[term].add(
          ExactSum::fromDigits(&numbers[at + 3 + std::size_t(term) * ExactSum::digitCount]));
  }
}
} // namespace coplane
