#include <coplane_dynamics/Line.hpp>

#include <algorithm>
#include <cmath>

// Bending of lines: docs/theory/lines.md. Between its points a bar is straight; at a point it bends
// by the angle between its segments, as a hinge with the stiffness of half of each.

namespace coplane
{
namespace
{
/// Below this angle the direction in which a bar is bent has no meaning for how it lies [rad].
constexpr Real nearlyStraight = 0.01;

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

bool Line::isTornAt(std::size_t i) const
{
  return (i > 0 && segments_[i - 1].broken != 0) ||
         (i < segments_.size() && segments_[i].broken != 0);
}

Real Line::plasticMoment(std::size_t i) const
{
  if (isTornAt(i))
    return 0;
  Real most = infinity;
  for (const std::size_t s : {i - 1, i}) // i - 1 of the first point is no segment
    if (s < segments_.size())
    {
      const Segment& segment = segments_[s];
      const Real yield =
          section_.area * (section_.yieldStress + section_.hardeningModulus * segment.hardening);
      const Real share = segment.force / yield;
      most = std::min(most,
                      yield * 2 * section_.diameter / (3 * pi) * std::max(0.0, 1 - share * share));
    }
  return most;
}

Line::BendingLosses Line::bend(const std::vector<Vec3>& x, Real dt)
{
  // A bar that has turned back on itself, or has no length there, has no mean direction.
  constexpr Real folded = 1e-6;
  const auto hasMean = [](const Hinge& hinge)
  { return 1 + dot(hinge.before, hinge.behind) > folded; };
  BendingLosses lost;
  for (std::size_t i = 0; i < points_.size(); ++i)
  {
    Point& point = points_[i];
    Vec3& moment = point.moment;
    if (!bendsAt(i))
    {
      moment = point.axis = {}; // also of one that has become an end
      continue;
    }
    const Hinge before = hingeAt(i, x_), now = hingeAt(i, x);
    const Real stiffness = bendingStiffness(i);
    if (!hasMean(before) || !hasMean(now) || !(1 + dot(before.mean(), now.mean()) > folded))
    {
      lost.rupture += 0.5 * dot(moment, moment) / stiffness;
      moment = point.axis = {};
      continue;
    }
    const auto onward = [&](const Vec3& v) { return carried(v, before.mean(), now.mean()); };
    const Vec3 from = onward(before.angle()), to = now.angle();
    const Real fromSize = norm(from), toSize = norm(to);
    const auto axisOf = [](const Vec3& angle, Real size, const Vec3& otherwise)
    { return size > 0 ? (1 / size) * angle : otherwise; };
    // The bar turns freely about itself, so only the angle counts. Where it goes through straight,
    // or past it by less than its kink, it has come to the other side: the angle is negative.
    const Vec3 held = onward(point.axis);
    const Real fromSign = dot(from, held) < 0 ? -1 : 1;
    const Vec3 former = fromSign * axisOf(from, fromSize, fromSign * held);
    const Real start = std::copysign(norm(moment), dot(onward(moment), former));
    const Real kink = std::abs(fromSign * fromSize - start / stiffness);
    const Real near = std::min(nearlyStraight, 0.5 * kink);
    const Vec3 step = to - from;
    const Real missed = // by which it misses being straight on its way
        dot(from, step) < 0 && dot(to, step) > 0 ? norm(cross(from, to)) / norm(step)
                                                 : std::min(fromSize, toSize);
    const bool isHeld = fromSize < near || toSize < near;
    const bool passes = isHeld ? fromSign * dot(to, held) < 0 : missed < near && dot(to, from) < 0;
    const Real toSign = passes ? -fromSign : fromSign;
    const Real change = toSign * (passes ? fromSize + toSize - 2 * missed : toSize - fromSize);
    const Vec3 axis = toSign * axisOf(to, toSize, toSign * held);
    const Real trial = start + stiffness * change;
    const Real most = plasticMoment(i);
    Real end = trial;
    if (!(most > 0))
      end = 0;
    else if (std::abs(trial) > most)
    {
      // The plastic strain of the outermost fibre is the angle times that.
      const Real fibre = 0.5 * section_.diameter / bendingLength(i);
      const Real flow =
          flowAtRate(std::abs(trial), stiffness, most, section_.referenceRate * dt / fibre);
      end = std::copysign(std::abs(trial) - stiffness * flow, trial);
    }
    (isTornAt(i) ? lost.rupture : lost.plastic) += 0.5 * (start + end) * (trial - end) / stiffness;
    moment = end * axis;
    point.axis = toSize < near ? held : axis;
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
    // A moment is as stiff across itself as it is large for its angle.
    const Real angle = std::max(norm(hingeAt(i, x).angle()), nearlyStraight);
    const Real k = std::max(bendingStiffness(i), norm(points_[i].moment) / angle),
               sum = g[0] + g[1] + g[2];
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
