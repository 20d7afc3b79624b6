#include <coplane_dynamics/Line.hpp>

#include <algorithm>
#include <cmath>

// Bending of lines: docs/theory/lines.md. Between its points a bar is straight; at a point it bends
// by the angle between its segments, as a hinge with the stiffness of half of each.

namespace coplane
{
namespace
{
/// Rotates by the least rotation that brings the unit vector `from` to `to`.
Vec3 carried(const Vec3& v, const Vec3& from, const Vec3& to)
{
  const Vec3 axis = cross(from, to);
  const Real cosine = dot(from, to);
  return cosine * v + cross(axis, v) + (dot(axis, v) / (1 + cosine)) * axis;
}

/// Angle from one unit vector to another, about the axis of their rotation [rad].
Vec3 angleBetween(const Vec3& a, const Vec3& b)
{
  const Vec3 axis = cross(a, b);
  const Real sine = norm(axis);
  return sine > 0 ? (std::atan2(sine, dot(a, b)) / sine) * axis : Vec3{};
}
} // namespace

/// What a point has beside it.
struct Line::Hinge
{
  Vec3 before{}, behind{}; ///< directions of the bar [-]
  Vec3 mean() const { return normalised(before + behind); }
  Vec3 angle() const { return angleBetween(before, behind); }
};

bool Line::bendsAt(std::size_t i) const
{
  if (section_.diameter == 0 || points_.size() < 2)
    return false;
  const bool isFirst = i == 0, isLast = i + 1 == points_.size();
  return (!isFirst || (mirrored_[0] && points_[i].index == 0)) &&
         (!isLast || (mirrored_[1] && points_[i].index == lastIndex_));
}

Line::Hinge Line::hingeAt(std::size_t i, const std::vector<Vec3>& x) const
{
  // Beyond a plane of symmetry it goes on as its mirror image: the direction there is held.
  return {i > 0 ? directionOf(i - 1, x) : ends_[0],
          i < segments_.size() ? directionOf(i, x) : ends_[1]};
}

Real Line::bendingLength(std::size_t i) const
{
  return 0.5 *
         ((i > 0 ? segments_[i - 1].length : 0) + (i < segments_.size() ? segments_[i].length : 0));
}

Real Line::bendingStiffness(std::size_t i) const
{
  // Second moment A d^2 / 16, of one bar or of several.
  return axialStiffness() * section_.diameter * section_.diameter / 16 / bendingLength(i);
}

Real Line::plasticMoment(std::size_t i) const
{
  Real most = infinity;
  for (const std::size_t s : {i - 1, i}) // i - 1 of the first point is no segment
    if (s < segments_.size())
    {
      const Segment& segment = segments_[s];
      if (segment.broken != 0)
        return 0;
      const Real yield =
          section_.area * (section_.yieldStress + section_.hardeningModulus * segment.hardening);
      const Real share = segment.force / yield;
      most = std::min(most,
                      yield * 2 * section_.diameter / (3 * pi) * std::max(0.0, 1 - share * share));
    }
  return most;
}

Real Line::bend(const std::vector<Vec3>& x)
{
  // A bar that has turned back on itself, or has no length there, has no mean direction.
  constexpr Real folded = 1e-6;
  const auto hasMean = [](const Hinge& hinge)
  { return 1 + dot(hinge.before, hinge.behind) > folded; };
  Real lost = 0;
  for (std::size_t i = 0; i < points_.size(); ++i)
  {
    Vec3& moment = points_[i].moment;
    if (!bendsAt(i))
    {
      moment = {}; // also of one that has become an end
      continue;
    }
    const Hinge before = hingeAt(i, x_), now = hingeAt(i, x);
    const Real stiffness = bendingStiffness(i);
    if (!hasMean(before) || !hasMean(now) || !(1 + dot(before.mean(), now.mean()) > folded))
    {
      lost += 0.5 * dot(moment, moment) / stiffness;
      moment = {};
      continue;
    }
    // The bar turns freely about itself: only the angle counts, about an axis that goes with it.
    const Vec3 from = before.angle(), to = now.angle();
    const auto axisOf = [](const Vec3& angle, const Vec3& otherwise)
    { return norm(angle) > 0 ? normalised(angle) : otherwise; };
    const Vec3 former = axisOf(from, norm(moment) > 0 ? normalised(moment) : Vec3{});
    const Vec3 carriedOn = carried(former, before.mean(), now.mean());
    Vec3 axis = axisOf(to, carriedOn);
    if (dot(axis, carriedOn) < 0) // bent through straight, to the other side
      axis = -1.0 * axis;
    const Real start = std::copysign(norm(moment), dot(moment, former));
    const Real trial = start + stiffness * (dot(to, axis) - norm(from));
    const Real most = plasticMoment(i);
    const Real end = std::min(std::max(trial, -most), most);
    lost += 0.5 * (start + end) * (trial - end) / stiffness;
    moment = end * axis;
  }
  return lost;
}

void Line::addBendingForces(const std::vector<Vec3>& x)
{
  outerMoments_ = {};
  for (std::size_t i = 0; i < points_.size(); ++i)
  {
    if (!bendsAt(i))
      continue;
    // Each segment gets the moment as a couple at its ends.
    for (const std::size_t s : {i - 1, i})
    {
      if (s >= segments_.size())
        continue;
      const auto a = std::size_t(points_[s].index), b = std::size_t(points_[s + 1].index);
      const Vec3 chord = x[b] - x[a];
      if (!(norm(chord) > 0))
        continue;
      const Vec3 force = ((s == i ? -1 : 1) / dot(chord, chord)) * cross(points_[i].moment, chord);
      forces_[b] += force;
      forces_[a] -= force;
      if (i == 0 || i + 1 == points_.size())
        outerMoments_[i == 0 ? 0 : 1] = cross(chord, force);
    }
  }
}

void Line::addBendingStiffness(const std::vector<Vec3>& x)
{
  for (std::size_t i = 0; i < points_.size(); ++i)
  {
    if (!bendsAt(i) || !(plasticMoment(i) > 0))
      continue;
    // The angle is g x for small ways: a row of k g g^T.
    Real g[3] = {0, 0, 0};
    std::size_t of[3] = {0, std::size_t(points_[i].index), 0};
    for (const std::size_t s : {i - 1, i})
    {
      if (s >= segments_.size())
        continue;
      const auto a = std::size_t(points_[s].index), b = std::size_t(points_[s + 1].index);
      const Real chord = norm(x[b] - x[a]), turn = chord > 0 ? 1 / chord : 0;
      g[1] += turn;
      g[s == i ? 2 : 0] += turn;
      of[s == i ? 2 : 0] = s == i ? b : a;
    }
    const Real k = bendingStiffness(i), sum = g[0] + g[1] + g[2];
    for (int end = 0; end < 3; ++end)
      stiffness_[of[end]] += k * g[end] * sum;
  }
}

Real Line::storedByBending() const
{
  Real stored = 0;
  for (std::size_t i = 0; i < points_.size(); ++i)
    if (bendsAt(i))
      stored += 0.5 * dot(points_[i].moment, points_[i].moment) / bendingStiffness(i);
  return stored;
}
} // namespace coplane
