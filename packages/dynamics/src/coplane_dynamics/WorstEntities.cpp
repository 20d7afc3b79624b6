// Which planes and elements are to be looked at when the balance degrades.
#include <coplane_core/Log.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_mesh/FaceName.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
constexpr std::size_t named = 3;

struct Entry
{
  Real badness, value;
  GlobalId a, b;
};

/// The worst of all ranks, the same on all. Collective.
std::vector<Entry> worst(std::vector<Entry> mine, const Comm& comm)
{
  const auto keepWorst = [](std::vector<Entry>& list)
  {
    const auto worse = [](const Entry& p, const Entry& q)
    { return std::tie(q.badness, p.a, p.b) < std::tie(p.badness, q.a, q.b); };
    const std::size_t kept = std::min(list.size(), named);
    std::partial_sort(list.begin(), list.begin() + std::ptrdiff_t(kept), list.end(), worse);
    list.resize(kept);
  };
  keepWorst(mine);
  std::vector<Entry> all = comm.allGather(mine);
  keepWorst(all);
  return all;
}

std::string pairName(const Entry& entry)
{
  return fmt::format("plane between {} and {}", faceName(entry.a), faceName(entry.b));
}

/// Depth over the depth limit.
Real depthOf(const Plane& plane)
{
  return plane.area > 0 ? plane.closure / plane.depthLimit : 0;
}
} // namespace

std::string Solver::worstByRemainder() const
{
  std::vector<Entry> planes;
  for (std::size_t p = 0; contact_ && p < contact_->planes().extent(0); ++p)
  {
    const Plane& plane = contact_->planes()(p);
    if (!plane.countedHere || !plane.isBorn())
      continue;
    const Real rest = plane.remainder();
    planes.push_back({std::abs(rest), rest, plane.faceId[0], plane.faceId[1]});
  }
  std::string text;
  for (const Entry& e : worst(planes, *comm_))
    text += fmt::format("\n  {}: {:.3e} J unexplained", pairName(e), e.value);
  return text;
}

std::string Solver::deepestPlanes() const
{
  std::vector<Entry> planes;
  for (std::size_t p = 0; contact_ && p < contact_->planes().extent(0); ++p)
  {
    const Plane& plane = contact_->planes()(p);
    if (plane.countedHere && plane.isBorn() && depthOf(plane) > 0)
      planes.push_back({depthOf(plane), plane.closure, plane.faceId[0], plane.faceId[1]});
  }
  std::string text;
  for (const Entry& e : worst(planes, *comm_))
    text +=
        fmt::format("\n  {}: {:.3e} m deep, {:.3g} of its limit", pairName(e), e.value, e.badness);
  return text;
}

std::string Solver::worstEntities() const
{
  std::vector<Entry> elements;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (int e = 0; e < blocks_[b].count(); ++e)
      if (model_.mesh.blocks[b].owned[e] && blocks_[b].isAlive(e))
      {
        const Real ratio = blocks_[b].volume()(e) / blocks_[b].referenceVolume()(e);
        elements.push_back({std::isnan(ratio) ? infinity : std::abs(ratio - 1), ratio,
                            model_.mesh.blocks[b].elementIds[e], 0});
      }
  std::string text = "Worst:" + worstByRemainder() + deepestPlanes();
  for (const Entry& e : worst(elements, *comm_))
    text += fmt::format("\n  element {}: volume is {:.4g} times its initial one", e.a, e.value);
  return text;
}

/// Why the run cannot go on; empty: it can. Collective.
std::string Solver::brokenBalance(const EnergyBalance& balance) const
{
  const std::string now = fmt::format("cycle {}, t = {:.6e} s", clock_.cycle, clock_.time);
  const Real scale = balance.scale();
  if (!(std::abs(balance.error()) <= model_.time.energyTolerance * scale))
    return fmt::format(
        "{}: the energy balance is off by {:.3e} J of {:.3e} J in play (accepted: {} of it, "
        "time.energy_tolerance). {}\nLower time.step_factor or refine the mesh there.",
        now, balance.error(), scale, model_.time.energyTolerance, worstEntities());
  // Areas that grow under load bring energy that no other term shows.
  const Real gain = -balance.contact.remainder();
  if (!(gain <= model_.time.contactGainTolerance * scale))
    return fmt::format(
        "{}: contact has made {:.3e} J out of nothing, of {:.3e} J in play (accepted: {} of it, "
        "time.contact_gain_tolerance). Worst:{}\nLook at the planes named: where bodies "
        "penetrate deeply, use stiffer joints, smaller elements or a smaller contact.depth_max.",
        now, gain, scale, model_.time.contactGainTolerance, worstByRemainder());
  return "";
}

void Solver::warnOfCaps(const std::string& now)
{
  std::vector<Entry> planes;
  for (std::size_t p = 0; p < contact_->planes().extent(0); ++p)
  {
    const Plane& plane = contact_->planes()(p);
    if (plane.countedHere && plane.area > 0 &&
        contact_->lawOf(plane).capped(plane.fit, plane.history))
      planes.push_back(
          {plane.history.maximumClosure, plane.fit.stiffnessCap, plane.faceId[0], plane.faceId[1]});
  }
  const Real count = Real(comm_->sum(std::int64_t(planes.size())));
  if (!(count >= std::max(Real(1), 2 * warned_.capped)))
    return;
  warned_.capped = count;
  std::string text;
  for (const Entry& e : worst(planes, *comm_))
    text +=
        fmt::format("\n  {}: closed by {:.3e} m, cap {:.3e} Pa/m", pairName(e), e.badness, e.value);
  logWarning("stiffness cap",
             fmt::format("{}: {} planes have reached joints.stiffness_cap: beyond it they are "
                         "softer than their closure curve. Give a larger one where that matters; "
                         "the step gets shorter. First:{}",
                         now, count, text));
}

void Solver::warnOfTrouble(const EnergyBalance& balance)
{
  // Every warning waits until things are twice as bad as at the last one of its kind.
  const auto isWorse = [](Real value, Real first, Real& warned)
  {
    if (!(value >= std::max(first, 2 * warned)))
      return false;
    warned = value;
    return true;
  };
  const std::string now = fmt::format("cycle {}, t = {:.6e} s", clock_.cycle, clock_.time);
  const Real scale = balance.scale();
  if (scale > 0)
  {
    const Real error = std::abs(balance.error()) / scale;
    if (isWorse(error, errorToWarn * model_.time.energyTolerance, warned_.error))
      logWarning("energy balance",
                 fmt::format("{}: the energy balance is off by {:.2e} of the energy in play; the "
                             "run stops at {} (time.energy_tolerance). {}",
                             now, error, model_.time.energyTolerance, worstEntities()));
    // What contact gains is worse than what it loses.
    const Real remainder = balance.contact.remainder() / scale;
    if (isWorse(remainder > 0 ? remainder / lossToWarn : -remainder / gainToWarn, 1,
                warned_.remainder))
      logWarning("contact remainder",
                 fmt::format("{}: contact has {} {:.2e} J, {:.2e} of the energy in play, by areas "
                             "that changed under load. Worst:{}",
                             now, remainder > 0 ? "lost" : "gained",
                             std::abs(balance.contact.remainder()), std::abs(remainder),
                             worstByRemainder()));
  }
  if (!contact_)
    return;
  warnOfCaps(now);
  const std::int64_t tooDeep = contact_->counts().tooDeep;
  if (isWorse(Real(tooDeep), 1, warned_.tooDeep))
    logWarning(
        "planes too deep",
        fmt::format("{}: {} planes are deeper than contact.depth_max. Raise the stiffness of "
                    "the joint or lower time.step_factor. Worst:{}",
                    now, tooDeep, deepestPlanes()));
}
} // namespace coplane
