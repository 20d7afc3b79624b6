#include <coplane_contact/LostContact.hpp>
#include <coplane_core/ExactSum.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/BalanceWatch.hpp>
#include <coplane_dynamics/ModelExtent.hpp>
#include <coplane_dynamics/WorstEntities.hpp>
#include <coplane_mesh/FaceName.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace coplane
{
namespace
{
// When warn() speaks: at this fraction of the error at which the run stops; at these fractions of
// the energy in play that contact has lost or gained by the remainder.
constexpr Real errorToWarn = 0.2, lossToWarn = 0.1, gainToWarn = 0.02;
/// Of the surface of all bodies: less that is lost does not end a run. Fragments may be.
constexpr Real lostToStop = 0.003;
/// Stable steps for which bodies that come back have been lost: up to 60 (fast_blocks).
constexpr Real stepsToBeLost = 75;

/// Whether to warn: every warning waits until things are twice as bad as at the last of its kind.
bool isWorse(Real value, Real first, Real& warned)
{
  if (!(value >= std::max(first, 2 * warned)))
    return false;
  warned = value;
  return true;
}

std::string now(const Clock& clock)
{
  return fmt::format("cycle {}, t = {:.6e} s", clock.cycle, clock.time);
}
} // namespace

void BalanceWatch::open(const EnergyBalance& initial, const Parts& parts)
{
  const NodalState& state = parts.state;
  std::vector<ExactSum> mass(1);
  for (int n = 0; n < parts.layout.owned(); ++n)
    mass[0].add(state.mass(n));
  const ModelExtent extent = extentOf(parts.mesh(), parts.comm);
  // Thousands of units in the last place of what moves, and some of where it does.
  const Real length = 1e-12 * extent.size + 4 * extent.digits();
  const Real speed = length / parts.clock.nextStep;
  roundOff_ = ExactSum::overRanks(mass, parts.comm)[0] * speed * speed;
  inPlay_ = inPlayOf(initial);
  if (parts.contact)
    accepted_ = bodiesInEachOther(*parts.contact, parts.state.x);
}

/// Least gain that ends the run, or that warn() has to tell of.
Real BalanceWatch::leastNews(Real inPlay, const Parts& parts) const
{
  return inPlay * std::min(parts.model.time.contactGainTolerance,
                           gainToWarn * std::max(1.0, 2 * warned_.remainder));
}

/// Minus the remainder of the planes of this rank, at a fraction of the cost of the exact sum. The
/// bits depend on ranks and threads [J].
Real BalanceWatch::gainHere(const Contact& contact)
{
  if (ended_.atSearch != contact.searches())
  {
    ended_ = {contact.searches(), 0};
    for (const auto& [kind, energies] : contact.ended().byKind())
    {
      std::array<Real, PlaneEnergySums::Terms> totals;
      for (std::size_t term = 0; term < totals.size(); ++term)
        totals[term] = energies.sums[term].value();
      ended_.gain -= PlaneEnergySums::energyOf(totals.data()).remainder();
    }
  }
  return contact.gainHere() + ended_.gain;
}

bool BalanceWatch::mayHaveGained(const Parts& parts)
{
  if (!parts.contact)
    return false;
  constexpr Real rounding = 1e-9; // of the energy in play: what sums of ranks differ by
  const Real left = leastNews(inPlay_, parts) - summed_.all - rounding * inPlay_;
  return !(gainHere(*parts.contact) - summed_.here <= left / parts.comm.size());
}

bool BalanceWatch::hasGained(const EnergyBalance& balance, const Parts& parts)
{
  const Real gain = -balance.contact.remainder();
  summed_ = {gain, gainHere(*parts.contact)};
  // Never less than at the last look: the bound could not tell whether it is news.
  return !(gain <= leastNews(std::max(inPlay_, inPlayOf(balance)), parts));
}

std::string BalanceWatch::broken(const EnergyBalance& balance, const Parts& parts) const
{
  const Real scale = inPlayOf(balance);
  if (!(std::abs(balance.error()) <= parts.model.time.energyTolerance * scale))
    return fmt::format(
        "{}: the energy balance is off by {:.3e} J of {:.3e} J in play (accepted: {} of it, "
        "time.energy_tolerance). {}\nLower time.step_factor or refine the mesh there.",
        now(parts.clock), balance.error(), scale, parts.model.time.energyTolerance,
        worstEntities(parts));
  // Areas that grow under load bring energy that no other term shows.
  const Real gain = -balance.contact.remainder();
  if (!(gain <= parts.model.time.contactGainTolerance * scale))
    return fmt::format(
        "{}: contact has made {:.3e} J out of nothing, of {:.3e} J in play (accepted: {} of it, "
        "time.contact_gain_tolerance). Worst:{}\nLook at the planes named: where bodies "
        "penetrate deeply, use stiffer joints, smaller elements or a smaller contact.depth_max.",
        now(parts.clock), gain, scale, parts.model.time.contactGainTolerance,
        worstByRemainder(parts));
  return "";
}

void BalanceWatch::acceptOverlapsOf(const std::vector<int>& blocks)
{
  coming_.insert(coming_.end(), blocks.begin(), blocks.end());
}

void BalanceWatch::saveBodies(StateTables& out) const
{
  std::vector<Real> numbers{Real(accepted_.size())};
  for (const BodyPair& pair : accepted_)
    numbers.insert(numbers.end(), pair.begin(), pair.end());
  numbers.insert(numbers.end(), coming_.begin(), coming_.end());
  out.numbers("solver/bodies_in_each_other", numbers);
}

void BalanceWatch::restoreBodies(const StateSource& in)
{
  const std::vector<Real> numbers = in.numbers("solver/bodies_in_each_other");
  const std::size_t pairs = numbers.empty() ? 0 : std::size_t(numbers[0]);
  if (numbers.size() < 1 + 2 * pairs)
    failOnAllRanks(ExitCode::Checkpoint, "{}: pairs of bodies are missing.", in.name());
  accepted_.clear();
  for (std::size_t i = 0; i < pairs; ++i)
    accepted_.push_back({int(numbers[1 + 2 * i]), int(numbers[2 + 2 * i])});
  coming_.assign(numbers.begin() + std::ptrdiff_t(1 + 2 * pairs), numbers.end());
}

std::string BalanceWatch::goesThrough(const Parts& parts, Real stableStep)
{
  TimedRegion region("coplane::dynamics::lostContact");
  if (!coming_.empty())
  {
    const std::vector<BodyPair> old = std::move(accepted_);
    const std::vector<BodyPair> added =
        bodiesInEachOther(*parts.contact, parts.state.x, std::exchange(coming_, {}));
    accepted_.clear();
    std::set_union(old.begin(), old.end(), added.begin(), added.end(),
                   std::back_inserter(accepted_));
  }
  const LostContact found = lostContact(*parts.contact, parts.state.x, accepted_);
  const Real lost = found.lost;
  const auto nameOf = [&](int side)
  { return parts.model.blocks[std::size_t(found.block[side])].name; };
  const auto told = [&]
  {
    return fmt::format(
        "{}: {} faces lie in other bodies, deeper than contact begins, and carry nothing, on "
        "{:.2e} "
        "m2, while contact carries on {:.2e} m2. Deepest: {} of block '{}', {:.3g} m in block '{}' "
        "behind {}.",
        now(parts.clock), found.faces, lost, found.carrying, faceName(found.faceId[0]), nameOf(0),
        found.depth, nameOf(1), faceName(found.faceId[1]));
  };
  constexpr const char* advice = "Where soft bodies are pressed together deeply, raise "
                                 "joints.<name>.stiffness_fraction or give the joint a stiffness; "
                                 "where bodies are fast, refine the mesh or use materials that "
                                 "yield or break.";
  const Real time = parts.clock.time;
  if (!(lost > found.carrying && lost > lostToStop * found.surface))
    lostSince_ = -1;
  else if (lostSince_ < 0)
    lostSince_ = time;
  if (lostSince_ >= 0 && time - lostSince_ > stepsToBeLost * stableStep)
  {
    const std::string through = told() + " Bodies go through each other.";
    if (parts.model.stopWhereContactIsLost)
      return fmt::format("{}\n{} contact.lost_contact: warn goes on all the same.", through,
                         advice);
    if (isWorse(lost, 0, warned_.through))
      logWarning("bodies go through each other", through + " " + advice);
  }
  else if (lost > 0 && isWorse(lost, 0, warned_.lost))
    logWarning("contact is lost", fmt::format("{} {}", told(), advice));
  return "";
}

void BalanceWatch::warn(const EnergyBalance& balance, const Parts& parts)
{
  inPlay_ = inPlayOf(balance);
  if (inPlay_ > 0)
    warnOfBalance(balance, parts);
  if (parts.contact)
    warnOfPlanes(parts);
}

void BalanceWatch::warnOfBalance(const EnergyBalance& balance, const Parts& parts)
{
  const Real scale = inPlayOf(balance);
  const Real tolerance = parts.model.time.energyTolerance;
  const Real error = std::abs(balance.error()) / scale;
  if (isWorse(error, errorToWarn * tolerance, warned_.error))
    logWarning("energy balance",
               fmt::format("{}: the energy balance is off by {:.2e} of the energy in play; the run "
                           "stops at {} (time.energy_tolerance). {}",
                           now(parts.clock), error, tolerance, worstEntities(parts)));
  // What is gained is worse than what is lost.
  const auto warnOf =
      [&](const char* kind, const char* what, Real joules, const auto& why, Real& warned)
  {
    const Real share = joules / scale;
    if (isWorse(share > 0 ? share / lossToWarn : -share / gainToWarn, 1, warned))
      logWarning(kind, fmt::format("{}: {} {} {:.2e} J, {:.2e} of the energy in play, {}",
                                   now(parts.clock), what, joules > 0 ? "lost" : "gained",
                                   std::abs(joules), std::abs(share), why()));
  };
  warnOf(
      "contact remainder", "contact has", balance.contact.remainder(),
      [&] { return "by areas that changed under load. Worst:" + worstByRemainder(parts); },
      warned_.remainder);
  warnOf(
      "debris remainder", "points of debris have", balance.debris.remainder(),
      [] { return std::string("that no other term shows. Lower time.step_factor."); },
      warned_.debris);
  warnOf(
      "line remainder", "lines have", balance.lines.remainder(),
      [] { return std::string("that no other term shows. Lower time.step_factor."); },
      warned_.lines);
}

void BalanceWatch::warnOfPlanes(const Parts& parts)
{
  const CappedPlanes capped = cappedPlanes(parts);
  if (isWorse(Real(capped.count), 1, warned_.capped))
    logWarning("stiffness cap",
               fmt::format("{}: {} planes have reached joints.stiffness_cap: beyond it they are "
                           "softer than their closure curve. Give a larger one where that matters; "
                           "the step gets shorter. First:{}",
                           now(parts.clock), capped.count, capped.first));
  const std::int64_t tooDeep = parts.contact->counts().tooDeep;
  if (isWorse(Real(tooDeep), 1, warned_.tooDeep))
    logWarning("planes too deep",
               fmt::format("{}: {} planes are deeper than contact.depth_max. Raise the stiffness "
                           "of the joint or lower time.step_factor. Worst:{}",
                           now(parts.clock), tooDeep, deepestPlanes(parts)));
}
} // namespace coplane
