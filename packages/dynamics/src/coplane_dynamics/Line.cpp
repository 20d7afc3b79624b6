#include <coplane_core/Log.hpp>
#include <coplane_dynamics/Conditions.hpp>
#include <coplane_dynamics/Line.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
bool Line::willChange(Real t, Real end, int stage) const
{
  if (removed_ || stage_ > stage)
    return false;
  if (!installed_)
    return from_ < end && until_ > from_;
  return (pretension_ > 0 && t < installTime_ + pretensionTime_) || until_ < end;
}

LineEnergy& LineEnergy::operator+=(const LineEnergy& other)
{
  work += other.work;
  pretension += other.pretension;
  stored += other.stored;
  plastic += other.plastic;
  bond += other.bond;
  dowel += other.dowel;
  rupture += other.rupture;
  return *this;
}

/// A possible state of bar and grout with these slips.
struct Line::Trial
{
  Real dt = 0;             ///< of the step [s]
  std::vector<Real> slips; ///< of the points [m]
  std::vector<Segment> segments;
  std::vector<Real> barStiffness; ///< tangents of the segments [N/m]
  std::vector<Real> plasticSlips, bondForces, bondStiffness;
  std::vector<Real> residual; ///< out of balance along the bar, 0 where tied [N]
};

Line::Line(const LineSetup& setup, const std::vector<int>& dowels)
    : name_(setup.name), section_(setup.section), bond_(setup.bond),
      dowel_(setup.dowel.value_or(LineDowel{})), pretension_(setup.pretension),
      pretensionTime_(setup.pretensionTime), from_(setup.from), until_(setup.until),
      stage_(setup.stage), mirrored_(setup.mirrored), lastIndex_(int(setup.points.size()) - 1)
{
  for (std::size_t i = 0; i < setup.points.size(); ++i)
  {
    const LinePoint& point = setup.points[i];
    points_.push_back({int(i), point.tied, point.bonded});
    if (i == 0)
      continue;
    segments_.emplace_back();
    segments_.back().length = norm(point.place - setup.points[i - 1].place);
  }
  for (const int segment : dowels)
  {
    dowels_.emplace_back();
    dowels_.back().segment = segment;
  }
  const std::size_t count = points_.size() + 2 * dowels_.size();
  forces_.resize(count);
  stiffness_.resize(count);
}

Real Line::prestrainAt(Real t) const
{
  if (pretension_ == 0)
    return 0;
  const Real part = pretensionTime_ > 0 ? std::min(1.0, (t - installTime_) / pretensionTime_) : 1;
  return part * pretension_ / axialStiffness();
}

/// With the hosts as they are in x_: there is no force yet.
void Line::install(const LineHosts& hosts, Real time)
{
  installed_ = true;
  installTime_ = time;
  const std::size_t all = points_.size();
  detachFromDead(hosts);
  if (points_.size() < all)
    logWarning(
        "lines without hosts",
        fmt::format("lines.{}: {} of its {} points are let go, as the blocks that they lie in "
                    "are not there when it is installed, at t = {:.6g} s. A line that holds a "
                    "block which a stage adds is given that stage.",
                    name_, all - points_.size(), all, time));
  for (std::size_t s = 0; s < segments_.size(); ++s)
    segments_[s].chord =
        norm(x_[std::size_t(points_[s + 1].index)] - x_[std::size_t(points_[s].index)]);
  if (!segments_.empty())
  {
    ends_[0] = directionOf(0, x_);
    ends_[1] = directionOf(segments_.size() - 1, x_);
  }
  // What joints have slid before is nothing to a dowel.
  const std::size_t first = x_.size() - 2 * dowels_.size();
  for (std::size_t d = 0; d < dowels_.size(); ++d)
    if (const auto over = segmentOver(dowels_[d].segment))
    {
      const Vec3 along = normalised(x_[std::size_t(points_[*over + 1].index)] -
                                    x_[std::size_t(points_[*over].index)]);
      dowels_[d].plastic = across(x_[first + 2 * d + 1] - x_[first + 2 * d], along);
    }
}

/// Its force does the work of half a step more, and what it stores then is lost. Slips, strains and
/// torn segments stay as they were.
void Line::takeOut(const LineHosts& hosts)
{
  const Real before = energy().stored, work = hostWork(hosts.x);
  removed_ = true;
  for (Segment& segment : segments_)
    segment.force = 0;
  for (Point& point : points_)
  {
    point.bondForce = 0;
    point.moment = {};
  }
  for (Dowel& dowel : dowels_)
  {
    dowel.gone = 1;
    dowel.force = {};
  }
  std::fill(forces_.begin(), forces_.end(), Vec3{});
  outerMoments_ = {};
  std::fill(stiffness_.begin(), stiffness_.end(), 0);
  energy_.work += work;
  energy_.rupture += before + work;
  x_ = hosts.x;
}

/// The segments beside a point become one with the sum of their elongations.
void Line::remove(std::size_t point)
{
  if (point > 0 && point + 1 < points_.size())
  {
    Segment& a = segments_[point - 1];
    const Segment& b = segments_[point];
    const Real whole = a.length + b.length;
    const auto mean = [&](Real of, Real and_) { return (a.length * of + b.length * and_) / whole; };
    if (installed_ && !x_.empty())
    {
      const Vec3& x = x_[std::size_t(points_[point].index)];
      const Vec3& xa = x_[std::size_t(points_[point - 1].index)];
      const Vec3& xb = x_[std::size_t(points_[point + 1].index)];
      a.chord = norm(xb - xa) - (norm(x - xa) - a.chord) - (norm(xb - x) - b.chord);
    }
    a.strain = mean(a.strain, b.strain);
    a.plasticStrain = mean(a.plasticStrain, b.plasticStrain);
    a.hardening = mean(a.hardening, b.hardening);
    a.broken = std::max(a.broken, b.broken);
    a.force = a.broken != 0 ? 0 : mean(a.force, b.force);
    // Those beside it keep their elastic angles.
    for (const std::size_t beside : {point - 1, point + 1})
      if (bendsAt(beside))
        points_[beside].moment =
            (bendingLength(beside) /
             (bendingLength(beside) + 0.5 * (beside < point ? b.length : a.length))) *
            points_[beside].moment;
    a.length = whole;
  }
  if (!segments_.empty())
    segments_.erase(segments_.begin() + std::ptrdiff_t(std::min(point, segments_.size() - 1)));
  points_.erase(points_.begin() + std::ptrdiff_t(point));
}

bool Line::detachFromDead(const LineHosts& hosts)
{
  const std::size_t before = points_.size();
  for (std::size_t i = points_.size(); i-- > 0;)
    if (!hosts.alive[std::size_t(points_[i].index)])
      remove(i);
  return points_.size() != before;
}

std::vector<Real> Line::chords(const std::vector<Vec3>& x) const
{
  std::vector<Real> chords;
  for (std::size_t s = 0; s < segments_.size(); ++s)
    chords.push_back(norm(x[std::size_t(points_[s + 1].index)] - x[std::size_t(points_[s].index)]));
  return chords;
}

Vec3 Line::directionOf(std::size_t segment, const std::vector<Vec3>& x) const
{
  return normalised(x[std::size_t(points_[segment + 1].index)] -
                    x[std::size_t(points_[segment].index)]);
}

Real Line::slipStrength(const Point& point, const LineHosts& hosts) const
{
  if (point.tied)
    return infinity;
  const Real pressure = std::max(0.0, hosts.pressure[std::size_t(point.index)]);
  return point.bonded * (bond_.strength + bond_.friction * bond_.perimeter * pressure);
}

Real Line::flowAtRate(Real trial, Real stiffness, Real yield, Real reference) const
{
  const Real slow = (trial - yield) / stiffness, exponent = section_.rateExponent;
  if (!(exponent > 0 && reference > 0 && slow > reference))
    return slow;
  // Over the logarithm u of p / reference what the left side has more is concave and falls: from
  // the right Newton's method goes straight to the root.
  Real u = std::log(slow / reference);
  for (int step = 0; step < 100; ++step)
  {
    const Real elastic = stiffness * reference * std::exp(u),
               flows = yield * std::exp(exponent * u);
    const Real change = (trial - elastic - flows) / (elastic + exponent * flows);
    u += change;
    if (std::abs(change) <= 1e-15 * (1 + std::abs(u) + 1 / exponent))
      break;
  }
  return reference * std::exp(u);
}

/// Of a bar in a step.
struct Line::Flow
{
  Real strain = 0;    ///< plastic [-]
  Real hardening = 0; ///< change of the stress at which it flows, over that [Pa]
};

/// @param stress of a bar that does not flow in the step, without sign [Pa]
/// @param dt 0: however slowly [s]
Line::Flow Line::flowOf(Real stress, Real hardening, Real dt) const
{
  const Real modulus = section_.youngsModulus;
  const Real above = stress - (section_.yieldStress + section_.hardeningModulus * hardening);
  if (!(above > 0))
    return {};
  const Real hardened = above / (modulus + section_.hardeningModulus);
  const Real fast = flowAtRate(stress, modulus, section_.yieldStress, section_.referenceRate * dt);
  if (!(fast < hardened)) // the larger of the stresses at which it flows
    return {hardened, section_.hardeningModulus};
  return {fast, section_.rateExponent * (stress - modulus * fast) / fast};
}

void Line::evaluate(const std::vector<Real>& chords, const std::vector<Real>& strengths,
                    Real prestrain, Trial& trial) const
{
  const std::size_t count = points_.size();
  trial.segments = segments_;
  trial.barStiffness.assign(segments_.size(), 0);
  trial.plasticSlips.resize(count);
  trial.bondForces.assign(count, 0);
  trial.bondStiffness.assign(count, 0);
  trial.residual.assign(count, 0);
  const Real ea = axialStiffness();
  for (std::size_t s = 0; s < segments_.size(); ++s)
  {
    Segment& segment = trial.segments[s];
    segment.strain =
        (chords[s] - segment.chord + trial.slips[s + 1] - trial.slips[s]) / segment.length +
        prestrain;
    if (segment.broken != 0)
      continue;
    segment.force = ea * (segment.strain - segment.plasticStrain);
    Real tangent = ea;
    if (!section_.compression && segment.force < 0)
      segment.force = tangent = 0;
    if (const Flow flow =
            flowOf(std::abs(segment.force) / section_.area, segment.hardening, trial.dt);
        flow.strain > 0)
    {
      segment.plasticStrain += segment.force > 0 ? flow.strain : -flow.strain;
      segment.hardening += flow.strain;
      segment.force = ea * (segment.strain - segment.plasticStrain);
      tangent = ea * flow.hardening / (section_.youngsModulus + flow.hardening);
    }
    trial.barStiffness[s] = tangent / segment.length;
  }
  for (std::size_t i = 0; i < count; ++i)
  {
    trial.plasticSlips[i] = points_[i].plasticSlip;
    if (points_[i].tied)
      continue;
    const Real k = points_[i].bonded * bond_.stiffness;
    Real& force = trial.bondForces[i];
    force = k * (trial.slips[i] - points_[i].plasticSlip);
    trial.bondStiffness[i] = k;
    if (std::abs(force) > strengths[i])
    {
      force = std::copysign(strengths[i], force);
      trial.plasticSlips[i] = trial.slips[i] - force / k;
      trial.bondStiffness[i] = 0;
    }
    trial.residual[i] = (i < segments_.size() ? trial.segments[i].force : 0) -
                        (i > 0 ? trial.segments[i - 1].force : 0) - force;
  }
}

/// Newton's method for the minimum of a convex energy with pieces of second order. Where grout or
/// bar flow, a small part of their stiffness is kept in the matrix, not in the forces; a search
/// along the direction sees to it that every step descends.
void Line::solve(const std::vector<Real>& chords, const std::vector<Real>& strengths,
                 Real prestrain, Trial& trial)
{
  constexpr int mostSteps = 200, mostLooks = 40;
  constexpr Real keptStiffness = 1e-4, tolerance = 1e-11, roundOff = 1e-14;
  const std::size_t count = points_.size();
  trial.slips.clear();
  for (const Point& point : points_)
    trial.slips.push_back(point.slip);
  evaluate(chords, strengths, prestrain, trial);
  const Real ea = axialStiffness();
  std::vector<Real> way(count), diagonal(count), above(count);
  for (int step = 0; step < mostSteps; ++step)
  {
    Real most = 0, scale = 0;
    for (const Real r : trial.residual)
      most = std::max(most, std::abs(r));
    for (const Segment& segment : trial.segments)
      scale = std::max(scale, std::abs(segment.force));
    for (const Real force : trial.bondForces)
      scale = std::max(scale, std::abs(force));
    if (!(most > tolerance * scale + roundOff * ea))
      return;
    // Tridiagonal and positive definite.
    const auto bar = [&](std::size_t s)
    { return std::max(trial.barStiffness[s], keptStiffness * ea / segments_[s].length); };
    for (std::size_t i = 0; i < count; ++i)
    {
      if (points_[i].tied)
      {
        diagonal[i] = 1;
        above[i] = way[i] = 0;
        continue;
      }
      diagonal[i] =
          std::max(trial.bondStiffness[i], keptStiffness * points_[i].bonded * bond_.stiffness) +
          (i > 0 ? bar(i - 1) : 0) + (i < segments_.size() ? bar(i) : 0);
      above[i] = i + 1 < count && !points_[i + 1].tied ? -bar(i) : 0;
      way[i] = trial.residual[i];
      if (i > 0 && !points_[i - 1].tied)
      {
        const Real factor = above[i - 1] / diagonal[i - 1];
        diagonal[i] -= factor * above[i - 1];
        way[i] -= factor * way[i - 1];
      }
    }
    for (std::size_t i = count; i-- > 0;)
    {
      if (i + 1 < count)
        way[i] -= above[i] * way[i + 1];
      way[i] /= diagonal[i];
    }
    const std::vector<Real> from = trial.slips;
    /// Derivative of the energy along the way.
    const auto slope = [&](Real part)
    {
      for (std::size_t i = 0; i < count; ++i)
        trial.slips[i] = from[i] + part * way[i];
      evaluate(chords, strengths, prestrain, trial);
      Real sum = 0;
      for (std::size_t i = 0; i < count; ++i)
        sum -= trial.residual[i] * way[i];
      return sum;
    };
    Real first = 0;
    for (std::size_t i = 0; i < count; ++i)
      first -= trial.residual[i] * way[i];
    Real low = 0, high = 1, slopeLow = first, slopeHigh = slope(1);
    if (slopeHigh <= 0.5 * std::abs(first))
      continue;
    for (int look = 0; look < mostLooks; ++look) // false position after Illinois
    {
      const Real part = low + (high - low) * slopeLow / (slopeLow - slopeHigh);
      const Real here = slope(part);
      if (std::abs(here) <= 0.1 * std::abs(first))
        break;
      if (here < 0)
      {
        low = part;
        slopeLow = here;
        slopeHigh *= 0.5;
      }
      else
      {
        high = part;
        slopeHigh = here;
        slopeLow *= 0.5;
      }
    }
  }
  ++unbalanced_;
}

Real Line::hostWork(const std::vector<Vec3>& x) const
{
  Real work = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    work -= 0.5 * dot(forces_[i], x[i] - x_[i]);
  return work;
}

/// Trapezoidal works, as central differences do them on the nodes: what is stored, lost and booked
/// then adds up but for the turning of chords.
void Line::advance(const LineHosts& hosts, Real t, Real dt, int stage)
{
  if (x_.empty())
    x_ = hosts.x;
  if (!installed_)
  {
    const bool isBefore = !Window::isReached(from_, t) || stage < stage_;
    // A time is that of the end of a step; a stage begins with the step that is over now.
    const bool isNow = !Window::isReached(from_, t - dt);
    if (isBefore || isNow)
      x_ = hosts.x;
    if (isBefore)
      return;
    install(hosts, isNow ? t : t - dt);
  }
  if (removed_)
    return;
  if (Window::isReached(until_, t))
    return takeOut(hosts);
  const Real before = energy().stored;
  const Real prestrain = prestrainAt(t), pull = prestrain - prestrain_;
  const auto pretensionWork = [&]
  {
    Real work = 0;
    for (const Segment& segment : segments_)
      work += 0.5 * segment.force * segment.length * pull;
    return work;
  };
  Real work = hostWork(hosts.x), pretension = pretensionWork();
  bool torn = detachFromDead(hosts);

  const std::vector<Real> chords = this->chords(hosts.x);
  std::vector<Real> strengths;
  for (const Point& point : points_)
    strengths.push_back(slipStrength(point, hosts));
  Trial trial;
  trial.dt = dt;
  for (bool again = true; again;)
  {
    solve(chords, strengths, prestrain, trial);
    again = false;
    for (std::size_t s = 0; s < segments_.size(); ++s)
      if (segments_[s].broken == 0 && trial.segments[s].strain >= section_.ruptureStrain)
      {
        segments_[s].broken = 1;
        segments_[s].force = 0;
        again = torn = true;
      }
  }
  Real plastic = 0, bond = 0;
  for (std::size_t s = 0; s < segments_.size(); ++s)
    plastic += 0.5 * (segments_[s].force + trial.segments[s].force) *
               (trial.segments[s].plasticStrain - segments_[s].plasticStrain) * segments_[s].length;
  segments_ = trial.segments;
  for (std::size_t i = 0; i < points_.size(); ++i)
  {
    Point& point = points_[i];
    bond +=
        0.5 * (point.bondForce + trial.bondForces[i]) * (trial.plasticSlips[i] - point.plasticSlip);
    point.slip = trial.slips[i];
    point.plasticSlip = trial.plasticSlips[i];
    point.bondForce = trial.bondForces[i];
    extremes_.greatestSlip = std::max(extremes_.greatestSlip, std::abs(point.slip));
  }
  for (const Segment& segment : segments_)
  {
    if (segment.force > extremes_.greatestForce)
    {
      extremes_.greatestForce = segment.force;
      extremes_.timeOfGreatestForce = t;
    }
    extremes_.leastForce = std::min(extremes_.leastForce, segment.force);
  }
  const Real slidBefore = energy_.dowel;
  torn = slideDowels(hosts) || torn;
  const BendingLosses lost = bend(hosts.x, dt);
  plastic += lost.plastic;
  torn = torn || lost.rupture > 0; // what is missing then is booked below
  findForces(hosts.x);
  findStiffness(hosts.x);
  work += hostWork(hosts.x);
  pretension += pretensionWork();
  x_ = hosts.x;
  prestrain_ = prestrain;
  energy_.work += work + pretension;
  if (dt > 0)
    energy_.pretension += pretension;
  energy_.plastic += plastic;
  energy_.bond += bond;
  if (torn)
    energy_.rupture += before + work + pretension - plastic - bond - (energy_.dowel - slidBefore) -
                       energy().stored;
}

/// Position among the segments of the one that goes from point `index` of the setup, or one before
/// it, to the next, or one behind it.
std::optional<std::size_t> Line::segmentOver(int index) const
{
  for (std::size_t s = 0; s < segments_.size(); ++s)
    if (points_[s].index <= index && points_[s + 1].index > index)
      return s;
  return std::nullopt;
}

/// Their energy is a function of the relative place of both sides across the chord. Whether one has
/// gone.
bool Line::slideDowels(const LineHosts& hosts)
{
  bool gone = false;
  const std::size_t first = hosts.pressure.size();
  for (std::size_t d = 0; d < dowels_.size(); ++d)
  {
    Dowel& dowel = dowels_[d];
    const std::size_t near = first + 2 * d, far = near + 1;
    const auto over = segmentOver(dowel.segment);
    if (dowel.gone == 0 &&
        (!over || segments_[*over].broken != 0 || !hosts.alive[near] || !hosts.alive[far]))
    {
      gone = true;
      dowel.gone = 1;
      dowel.force = {};
    }
    if (dowel.gone != 0)
      continue;
    const Vec3 along = normalised(hosts.x[std::size_t(points_[*over + 1].index)] -
                                  hosts.x[std::size_t(points_[*over].index)]);
    dowel.sliding = across(hosts.x[far] - hosts.x[near], along);
    // What is lost turns with the line.
    const Vec3 flat = across(dowel.plastic, along);
    const Real size = norm(flat);
    Vec3 plastic = size > 0 ? (norm(dowel.plastic) / size) * flat : Vec3{};
    // Both sides are the same place told from two elements: what is at rest has no round-off to
    // carry as energy.
    constexpr Real roundOff = 1e-15;
    const Vec3 elastic = dowel.sliding - plastic;
    Vec3 force = norm(elastic) > roundOff * (norm(hosts.x[near]) + norm(hosts.x[far]))
                     ? dowel_.stiffness * elastic
                     : Vec3{};
    if (const Real most = norm(force); most > dowel_.strength)
    {
      force = (dowel_.strength / most) * force;
      const Vec3 flowed = dowel.sliding - (1 / dowel_.stiffness) * force;
      energy_.dowel += 0.5 * dot(dowel.force + force, flowed - plastic);
      plastic = flowed;
    }
    dowel.plastic = plastic;
    dowel.force = force;
  }
  return gone;
}

void Line::findForces(const std::vector<Vec3>& x)
{
  forces_.assign(x.size(), Vec3{});
  for (std::size_t s = 0; s < segments_.size(); ++s)
  {
    const std::size_t a = std::size_t(points_[s].index), b = std::size_t(points_[s + 1].index);
    const Vec3 chord = x[b] - x[a];
    const Real length = norm(chord);
    if (!(length > 0))
      continue;
    const Vec3 pull = (segments_[s].force / length) * chord;
    forces_[a] += pull;
    forces_[b] -= pull;
  }
  addBendingForces(x);
  const std::size_t first = x.size() - 2 * dowels_.size();
  for (std::size_t d = 0; d < dowels_.size(); ++d)
  {
    const Dowel& dowel = dowels_[d];
    if (dowel.gone != 0)
      continue;
    const std::size_t s = *segmentOver(dowel.segment);
    const std::size_t near = first + 2 * d, far = near + 1, a = std::size_t(points_[s].index),
                      b = std::size_t(points_[s + 1].index);
    forces_[near] += dowel.force;
    forces_[far] -= dowel.force;
    // The derivative by the direction of the chord takes up the moment of an open joint.
    const Vec3 chord = x[b] - x[a];
    const Real lever = dot(x[far] - x[near], chord) / dot(chord, chord);
    forces_[b] += lever * dowel.force;
    forces_[a] -= lever * dowel.force;
  }
}

/// The energy is a minimum over slips, so that any slips bound it: none; those of a bar that stands
/// still; and, where one point is tied, those of a bar that moves with it. The lowest bound counts.
void Line::findStiffness(const std::vector<Vec3>& x)
{
  const Real ea = axialStiffness();
  std::vector<Real> stuck(x.size(), 0), still(x.size(), 0), stiff(x.size(), 0);
  for (std::size_t s = 0; s < segments_.size(); ++s)
  {
    const Point *const a = &points_[s], *const b = &points_[s + 1];
    const Real k = segments_[s].broken != 0 ? 0 : ea / segments_[s].length;
    for (const Point* end : {a, b})
    {
      stuck[std::size_t(end->index)] += 2 * k;
      if (end->tied)
        still[std::size_t(end->index)] += (a->tied && b->tied ? 2 : 1) * k;
    }
  }
  // Where the line turns, what moves the point lengthens one of the segments beside it.
  for (std::size_t i = 1; i + 1 < points_.size(); ++i)
    if (!points_[i].tied && segments_[i - 1].broken == 0 && segments_[i].broken == 0)
    {
      const Vec3 turn = directionOf(i, x) - directionOf(i - 1, x);
      const Real k = dot(turn, turn) * ea / std::max(segments_[i - 1].length, segments_[i].length);
      still[std::size_t(points_[i].index)] += k;
      stiff[std::size_t(points_[i].index)] += k;
    }
  Real grout = 0;
  for (const Point& point : points_)
    if (!point.tied)
    {
      const Real k = point.bonded * bond_.stiffness;
      still[std::size_t(point.index)] += k;
      stiff[std::size_t(point.index)] += 2 * k;
      grout += k;
    }
  const auto isTied = [](const Point& point) { return point.tied; };
  const bool oneTied = std::count_if(points_.begin(), points_.end(), isTied) == 1;
  if (oneTied)
    stiff[std::size_t(std::find_if(points_.begin(), points_.end(), isTied)->index)] = 2 * grout;
  const auto most = [](const std::vector<Real>& of)
  { return of.empty() ? 0 : *std::max_element(of.begin(), of.end()); };
  stiffness_ = most(still) < most(stuck) ? still : stuck;
  if (oneTied && most(stiff) < most(stiffness_))
    stiffness_ = stiff;
  // A pulled chord also resists across itself.
  for (std::size_t s = 0; s < segments_.size(); ++s)
  {
    const std::size_t a = std::size_t(points_[s].index), b = std::size_t(points_[s + 1].index);
    const Real length = norm(x[b] - x[a]);
    for (const std::size_t end : {a, b})
      stiffness_[end] += length > 0 ? 2 * std::abs(segments_[s].force) / length : 0;
  }
  addBendingStiffness(x);
  const std::size_t first = x.size() - 2 * dowels_.size();
  for (std::size_t d = 0; d < dowels_.size(); ++d)
  {
    if (dowels_[d].gone != 0)
      continue;
    // Sliding is that of both sides less `lever` times the way of the ends of the chord.
    const std::size_t near = first + 2 * d, far = near + 1, s = *segmentOver(dowels_[d].segment),
                      a = std::size_t(points_[s].index), b = std::size_t(points_[s + 1].index);
    const Vec3 chord = x[b] - x[a];
    const Real lever = std::abs(dot(x[far] - x[near], chord)) / dot(chord, chord),
               k = 2 * (1 + lever) * dowel_.stiffness;
    for (const std::size_t side : {near, far})
      stiffness_[side] += k;
    for (const std::size_t end : {a, b})
      stiffness_[end] += lever * k;
  }
}
} // namespace coplane
