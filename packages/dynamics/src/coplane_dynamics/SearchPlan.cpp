#include <coplane_core/Backend.hpp>
#include <coplane_core/Error.hpp>
#include <coplane_dynamics/SearchPlan.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace coplane
{
namespace
{
constexpr Real mostSkins = 1e8; // of relative motion in one step

/// Largest and negated least components of vectors of the nodes that elements hold.
struct Extent
{
  std::array<Real, 6> bounds{-infinity, -infinity, -infinity, -infinity, -infinity, -infinity};

  void take(int axis, Real value)
  {
    bounds[axis] = std::max(bounds[axis], value);
    bounds[3 + axis] = std::max(bounds[3 + axis], -value);
  }
  void add(const Extent& other)
  {
    for (std::size_t i = 0; i < bounds.size(); ++i)
      bounds[i] = std::max(bounds[i], other.bounds[i]);
  }
};

struct Extents
{
  Extent way, unforeseen, sincePassing, velocity;

  void add(const Extents& other)
  {
    way.add(other.way);
    unforeseen.add(other.unforeseen);
    sincePassing.add(other.sincePassing);
    velocity.add(other.velocity);
  }
};

/// From the least to the largest along an axis.
Real width(const Real* bounds, int axis)
{
  return bounds[axis] + bounds[3 + axis];
}

/// Whether nothing is as wide as that along any axis; what is not finite is not.
bool isWithin(Real most, const Real* bounds)
{
  for (int axis = 0; axis < 3; ++axis)
    if (width(bounds, axis) > most)
      return false;
  return true;
}

/// Length of the diagonal of an extent over all ranks; 0 when it is not finite.
Real diagonal(const Real* bounds)
{
  const Vec3 range{width(bounds, 0), width(bounds, 1), width(bounds, 2)};
  return std::isfinite(dot(range, range)) ? norm(range) : 0;
}
} // namespace

void SearchPlan::start(const Parts& parts)
{
  Extent velocity;
  for (int n = 0; n < parts.layout.owned(); ++n)
    for (int c = 0; c < 3 && !parts.erosion.isFree(n); ++c)
      velocity.take(c, parts.state.v(n, c));
  std::vector<Real> range(velocity.bounds.begin(), velocity.bounds.end());
  parts.comm.max(range);
  relativeSpeed_ = diagonal(range.data());
}

bool SearchPlan::look(const Parts& parts, bool trouble, bool again)
{
  // The next positions are known now: a search falls due when one may be needed by then, from exact
  // bounds on the relative displacement of any two nodes since the last search, and on what that
  // search did not foresee of it.
  const NodalState& state = parts.state;
  const Clock& clock = parts.clock;
  const Real foreseen = foresees_ ? std::min(timeSince(clock.time + clock.nextStep), ahead_) : 0;
  const auto take = [&](Extents& all, std::size_t node)
  {
    const int n = int(node);
    if (parts.erosion.isFree(n))
      return;
    for (int c = 0; c < 3; ++c)
    {
      const Real next = state.x(n, c) + clock.nextStep * state.v(n, c);
      const Real gone = next - state.atSearch(n, c);
      all.way.take(c, gone);
      all.unforeseen.take(c, gone - foreseen * state.velocityAtSearch(n, c));
      all.sincePassing.take(c, next - state.atPassing(n, c));
      all.velocity.take(c, state.v(n, c));
    }
  };
  const Extents all =
      sumInParts("coplane::dynamics::extents",
                 parts.contact ? std::size_t(parts.layout.owned()) : 0, Extents{}, take);
  std::vector<Real> range;
  for (const Extent* extent : {&all.way, &all.unforeseen, &all.sincePassing, &all.velocity})
    range.insert(range.end(), extent->bounds.begin(), extent->bounds.end());
  range.push_back(parts.contact && parts.contact->passedOnHasChanged());
  range.push_back(parts.contact && parts.contact->depthsHaveChanged());
  range.push_back(trouble);
  parts.comm.max(range);
  if (range.back() > 0)
    return true;
  if (!parts.contact)
    return false;
  relativeSpeed_ = diagonal(&range[18]);
  const Real *const moved = &range[0], *const strayed = &range[6];
  const Real skin = parts.contact->skin();
  passedOnHasChanged_ = passedOnHasChanged_ || range[24] > 0;
  const auto comes = [&](int every) { return every > 0 && (clock.cycle + 1) % every == 0; };
  isDue_ = comes(every_);
  // A run that has been restarted does not know any more what has changed in the last cycle.
  isPassingDue_ = (again && isPassingDue_) || range[25] > 0 ||
                  (every_ == automatic && ((comes(mostOften) && passedOnHasChanged_) ||
                                           !isWithin(0.5 * skin, &range[12])));
  // What lies on the way that the search foresaw is covered, and so is what has stayed where it
  // was.
  if (!isWithin(0.5 * skin, moved) && !isWithin(0.5 * skin, strayed))
    isDue_ = true;
  for (int axis = 0; axis < 3; ++axis)
    if (const Real least = std::min(width(moved, axis), width(strayed, axis));
        least > -infinity && !(least < mostSkins * skin))
      failOnAllRanks(ExitCode::Computation,
                     "cycle {}, t = {:.6e} s: nodes move {:.3e} m against each other along {} in "
                     "one step of {:.3e} s; the skin of contact is {:.3e} m. Look for a velocity, "
                     "a load or a gravity that is far too large.",
                     clock.cycle, clock.time, least, "xyz"[axis], clock.nextStep, skin);
  return false;
}
} // namespace coplane
