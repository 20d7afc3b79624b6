#include <coplane_dynamics/Line.hpp>

#include <algorithm>

namespace coplane
{
LineEnergy Line::energy() const
{
  LineEnergy energy = energy_;
  for (const Segment& segment : segments_)
    energy.stored += 0.5 * segment.force * segment.force * segment.length / axialStiffness();
  for (const Point& point : points_)
    if (!point.tied)
      energy.stored += 0.5 * point.bondForce * point.bondForce / (point.bonded * bond_.stiffness);
  energy.stored += storedByBending();
  for (const Dowel& dowel : dowels_)
    if (dowel.gone == 0)
      energy.stored += 0.5 * dot(dowel.force, dowel.force) / dowel_.stiffness;
  return energy;
}

int Line::broken() const
{
  return int(std::count_if(segments_.begin(), segments_.end(),
                           [](const Segment& segment) { return segment.broken != 0; }));
}

/// All that changes, but for the numbers of points and segments.
template <class Self, class F>
void Line::forEachNumber(Self& self, F&& number)
{
  const auto vector = [&](auto& v)
  {
    number(v.x);
    number(v.y);
    number(v.z);
  };
  number(self.installTime_);
  number(self.prestrain_);
  number(self.unbalanced_);
  for (auto& point : self.points_)
  {
    for (auto* value : {&point.slip, &point.plasticSlip, &point.bondForce})
      number(*value);
    if (self.bends())
      for (auto* v : {&point.moment, &point.axis})
        vector(*v);
  }
  for (auto& s : self.segments_)
    for (auto* value :
         {&s.length, &s.chord, &s.strain, &s.plasticStrain, &s.hardening, &s.force, &s.broken})
      number(*value);
  for (auto& dowel : self.dowels_)
  {
    number(dowel.gone);
    vector(dowel.sliding);
    vector(dowel.plastic);
    vector(dowel.force);
  }
  for (auto& x : self.x_)
    vector(x);
  for (auto* pair : {&self.ends_, &self.outerMoments_})
    for (auto& one : *pair)
      if (self.bends())
        vector(one);
  for (auto& force : self.forces_)
    vector(force);
  for (auto& stiffness : self.stiffness_)
    number(stiffness);
  auto& e = self.energy_;
  for (auto* value : {&e.work, &e.pretension, &e.plastic, &e.bond, &e.dowel, &e.rupture})
    number(*value);
  auto& most = self.extremes_;
  for (auto* value :
       {&most.greatestForce, &most.leastForce, &most.greatestSlip, &most.timeOfGreatestForce})
    number(*value);
}

void Line::save(std::vector<Real>& numbers) const
{
  numbers.push_back(removed_ ? 2 : installed_);
  numbers.push_back(Real(x_.size()));
  numbers.push_back(Real(points_.size()));
  for (const Point& point : points_)
    numbers.push_back(point.index);
  forEachNumber(*this, [&](const Real& value) { numbers.push_back(value); });
}

void Line::restore(const Real*& numbers)
{
  removed_ = *numbers == 2;
  installed_ = *numbers++ != 0;
  x_.resize(std::size_t(*numbers++));
  std::vector<Point> points(std::size_t(*numbers++));
  for (Point& point : points)
    point = points_[std::size_t(*numbers++)];
  points_ = points;
  segments_.resize(points_.empty() ? 0 : points_.size() - 1);
  forEachNumber(*this, [&](Real& value) { value = *numbers++; });
}

void Line::addTo(StateHash& hash, std::uint64_t field, GlobalId id) const
{
  std::vector<Real> numbers;
  save(numbers);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    hash.add(field, id, i, numbers[i]);
}
} // namespace coplane
