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
};

/// Length of the diagonal of an extent over all ranks; 0 when it is not finite.
Real diagonal(const Real* bounds)
{
  const Vec3 range{bounds[0] + bounds[3], bounds[1] + bounds[4], bounds[2] + bounds[5]};
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

bool SearchPlan::look(const Parts& parts, bool trouble)
{
  // The next positions are known now: a search falls due when one may be needed by then, from an
  // exact bound on the relative displacement of any two nodes since the last search.
  const NodalState& state = parts.state;
  const Clock& clock = parts.clock;
  Extent way, velocity;
  for (int n = 0; n < parts.layout.owned() && parts.contact; ++n)
    for (int c = 0; c < 3 && !parts.erosion.isFree(n); ++c)
    {
      way.take(c, state.x(n, c) + clock.nextStep * state.v(n, c) - state.atSearch(n, c));
      velocity.take(c, state.v(n, c));
    }
  std::vector<Real> range(way.bounds.begin(), way.bounds.end());
  range.insert(range.end(), velocity.bounds.begin(), velocity.bounds.end());
  range.push_back(parts.contact && parts.contact->passedOnHasChanged());
  range.push_back(trouble);
  parts.comm.max(range);
  if (range.back() > 0)
    return true;
  if (!parts.contact)
    return false;
  relativeSpeed_ = diagonal(&range[6]);
  const Real skin = parts.contact->skin();
  passedOnHasChanged_ = passedOnHasChanged_ || range[12] > 0;
  const int every = every_ == automatic ? mostOften : every_;
  isDue_ =
      every > 0 && (clock.cycle + 1) % every == 0 && (every_ != automatic || passedOnHasChanged_);
  for (int axis = 0; axis < 3; ++axis)
  {
    const Real moved = range[axis] + range[3 + axis];
    if (moved > -infinity && !(moved < mostSkins * skin))
      failOnAllRanks(ExitCode::Computation,
                     "cycle {}, t = {:.6e} s: nodes move {:.3e} m against each other along {} in "
                     "one step of {:.3e} s; the skin of contact is {:.3e} m. Look for a velocity, "
                     "a load or a gravity that is far too large.",
                     clock.cycle, clock.time, moved, "xyz"[axis], clock.nextStep, skin);
    isDue_ = isDue_ || moved > 0.5 * skin;
  }
  return false;
}
} // namespace coplane
