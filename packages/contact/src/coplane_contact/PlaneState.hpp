#pragma once

#include <coplane_contact/Plane.hpp>
#include <coplane_core/StateHash.hpp>

#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

// The one list of what a plane remembers. Checkpoints, the hash of the state, what is passed on to
// other pairs, and the files of planes are made from it.

namespace coplane
{
/// What becomes of a number when a pair takes over from living planes (Inheritance.hpp).
enum class Passing : std::uint8_t
{
  None,        ///< it begins anew
  Mean,        ///< mean of the donors by their areas
  MeanOfBonds, ///< mean of those that are bonded, if the pair is bonded now
  Turned,      ///< a vector in the plane: mean, turned into the new plane
  Majority,    ///< a flag: that of most of the area
  Any          ///< a flag: whether any of them has it
};

/// When a change of a number that is passed on makes the last search stale: pairs that take over
/// from the plane get what it was at that search. Said of every such number, else it does not
/// compile; detail/PassedOn.hpp looks at them after every update of a plane that carries.
enum class Stale : std::uint8_t
{
  Unsaid, ///< of what is not passed on
  Always,
  WithCurve,         ///< where the closure curve is none that is straight: it remembers its maximum
  WithSoftening,     ///< where the bond softens
  WithSlipMemory,    ///< where friction or dilation hang on the slip
  WithClosureMemory, ///< where closures are sums of increments; depths count by themselves
  Never              ///< and `neverStale` says why
};

/// Something that a plane remembers from cycle to cycle. What it means stands at the member of
/// `Plane` or `JointState`.
template <Passing how, Stale when, class Get>
struct PlaneMember
{
  static constexpr Passing passing = how;
  static constexpr Stale stale = when;
  const char* name; ///< in checkpoints; for vectors and arrays the beginning of the names
  const char* unit;
  Get get;                          ///< reference to it in a plane; in a donor, too, if passed on
  const char* column = nullptr;     ///< in files of planes; none: not written
  const char* leftOut = nullptr;    ///< why neither checkpoints nor the hash have it; none: they do
  const char* neverStale = nullptr; ///< why, where `stale` is Never

  constexpr PlaneMember writtenAs(const char* column_) const
  {
    return {name, unit, get, column_, leftOut, neverStale};
  }
  constexpr PlaneMember notKept(const char* why) const
  {
    return {name, unit, get, column, why, neverStale};
  }
  constexpr PlaneMember notStaleBecause(const char* why) const
  {
    static_assert(stale == Stale::Never, "only what never makes a search stale has a reason");
    return {name, unit, get, column, leftOut, why};
  }
};

template <Passing how = Passing::None, Stale when = Stale::Unsaid, class Get>
constexpr PlaneMember<how, when, Get> planeMember(const char* name, const char* unit, Get get)
{
  return {name, unit, get};
}

/// All members of a plane, in the order of the columns of checkpoints.
inline constexpr auto planeMembers = std::make_tuple(
    planeMember(
        "face_id", "-", [](auto& p) -> auto& { return p.faceId; })
        .notKept("the key, by which checkpoints and the hash know the plane"),
    planeMember(
        "face", "-", [](auto& p) -> auto& { return p.face; })
        .notKept("places in tables of one rank; none while it was missed by searches"),
    planeMember(
        "counted_here", "-", [](auto& p) -> auto& { return p.countedHere; })
        .notKept("differs between ranks; follows from who owns face 0"),
    planeMember(
        "node_stiffness", "N/m", [](auto& p) -> auto& { return p.nodeStiffness; }),
    planeMember(
        "joint", "-", [](auto& p) -> auto& { return p.joint; })
        .writtenAs("joint"),
    planeMember(
        "block", "-", [](auto& p) -> auto& { return p.block; }),
    planeMember(
        "state", "-", [](auto& p) -> auto& { return p.state; })
        .writtenAs("state"),
    planeMember(
        "sighting", "-", [](auto& p) -> auto& { return p.sighting; }),
    planeMember(
        "refusal", "-", [](auto& p) -> auto& { return p.refusal; }),
    planeMember(
        "lags", "-", [](auto& p) -> auto& { return p.lags; }),
    planeMember(
        "lineage", "-", [](auto& p) -> auto& { return p.lineage; }),
    planeMember(
        "declared", "-", [](auto& p) -> auto& { return p.declared; })
        .writtenAs("declared"),
    planeMember(
        "too_deep", "-", [](auto& p) -> auto& { return p.tooDeep; })
        .writtenAs("too_deep"),
    planeMember(
        "pairing", "-", [](auto& p) -> auto& { return p.pairing; }),
    planeMember(
        "unseen", "-", [](auto& p) -> auto& { return p.unseen; }),
    planeMember(
        "exits", "-", [](auto& p) -> auto& { return p.exits; }),
    planeMember(
        "turns", "-", [](auto& p) -> auto& { return p.turns; }),
    planeMember(
        "covered", "-", [](auto& p) -> auto& { return p.covered; }),
    planeMember(
        "seams", "-", [](auto& p) -> auto& { return p.seams; }),
    planeMember(
        "fit_normal_stiffness", "Pa/m", [](auto& p) -> auto& { return p.fit.normalStiffness; }),
    planeMember(
        "fit_stiffness_cap", "Pa/m", [](auto& p) -> auto& { return p.fit.stiffnessCap; }),
    planeMember(
        "fit_shear_stiffness", "Pa/m", [](auto& p) -> auto& { return p.fit.shearStiffness; }),
    planeMember(
        "area", "m²", [](auto& p) -> auto& { return p.area; })
        .writtenAs("area"),
    planeMember(
        "overlap", "m²", [](auto& p) -> auto& { return p.overlap; })
        .writtenAs("overlap"),
    planeMember(
        "force", "N", [](auto& p) -> auto& { return p.nodal; }),
    planeMember(
        "normal", "-", [](auto& p) -> auto& { return p.normal; })
        .writtenAs("normal"),
    planeMember(
        "point", "m", [](auto& p) -> auto& { return p.pointOfContact; }),
    planeMember(
        "gap", "m", [](auto& p) -> auto& { return p.gap; }),
    planeMember<Passing::Mean, Stale::Always>(
        "offset", "m", [](auto& p) -> auto& { return p.offset; })
        .writtenAs("offset"),
    planeMember<Passing::Any, Stale::Never>(
        "absorbed", "-", [](auto& p) -> auto& { return p.history.absorbed; })
        .notStaleBecause("it changes only where the offset does"),
    planeMember(
        "absorbed_unevenly", "-", [](auto& p) -> auto& { return p.history.absorbedUnevenly; }),
    planeMember(
        "laid", "m", [](auto& p) -> auto& { return p.laid; }),
    planeMember(
        "planned", "J", [](auto& p) -> auto& { return p.planned; }),
    planeMember(
        "debt", "J", [](auto& p) -> auto& { return p.debt; }),
    planeMember(
        "across_joint", "-", [](auto& p) -> auto& { return p.acrossJoint; }),
    planeMember<Passing::Mean, Stale::WithCurve>(
        "maximum_closure", "m", [](auto& p) -> auto& { return p.history.maximumClosure; })
        .writtenAs("maximum_closure"),
    planeMember<Passing::Turned, Stale::Never>(
        "shear", "Pa", [](auto& p) -> auto& { return p.history.shearTraction; })
        .notStaleBecause("areas begin small, so that the force of what was missed is small, too")
        .writtenAs("shear_traction"),
    planeMember<Passing::Mean, Stale::WithSlipMemory>(
        "slip", "m", [](auto& p) -> auto& { return p.history.slip; })
        .writtenAs("slip"),
    planeMember<Passing::MeanOfBonds, Stale::WithSoftening>(
        "opening", "m", [](auto& p) -> auto& { return p.history.opening; })
        .writtenAs("opening"),
    planeMember<Passing::MeanOfBonds, Stale::WithSoftening>(
        "shearing", "m", [](auto& p) -> auto& { return p.history.shearing; })
        .writtenAs("shearing"),
    planeMember<Passing::Majority, Stale::Always>(
        "bonded", "-", [](auto& p) -> auto& { return p.history.bonded; })
        .writtenAs("bonded"),
    planeMember<Passing::Mean, Stale::WithClosureMemory>(
        "closure", "m", [](auto& p) -> auto& { return p.closure; })
        .writtenAs("closure"),
    planeMember(
        "normal_traction", "Pa", [](auto& p) -> auto& { return p.normalTraction; })
        .writtenAs("normal_traction"),
    planeMember(
        "depth_limit", "m", [](auto& p) -> auto& { return p.depthLimit; }),
    planeMember(
        "normal_damping", "N", [](auto& p) -> auto& { return p.normalDamping; }),
    planeMember(
        "birth_area", "m²", [](auto& p) -> auto& { return p.birthArea; }),
    planeMember(
        "stored", "J", [](auto& p) -> auto& { return p.stored; })
        .writtenAs("stored"),
    planeMember(
        "closure_memory", "m, J or m^2", [](auto& p) -> auto& { return p.closureMemory; }),
    planeMember(
        "crushed_unevenly", "-", [](auto& p) -> auto& { return p.crushedUnevenly; }),
    planeMember(
        "crushed_at_center", "m", [](auto& p) -> auto& { return p.history.crushedAtCenter; }),
    planeMember(
        "work", "J", [](auto& p) -> auto& { return p.work; })
        .writtenAs("work"),
    planeMember(
        "friction_work", "J", [](auto& p) -> auto& { return p.frictionWork; })
        .writtenAs("friction"),
    planeMember(
        "hysteresis_work", "J", [](auto& p) -> auto& { return p.hysteresisWork; })
        .writtenAs("hysteresis"),
    planeMember(
        "fracture_work", "J", [](auto& p) -> auto& { return p.fractureWork; })
        .writtenAs("fracture"),
    planeMember(
        "damping_work", "J", [](auto& p) -> auto& { return p.dampingWork; })
        .writtenAs("damping"));

/// Calls f(member) for all of the list.
template <class F>
void forEachMember(F&& f)
{
  std::apply([&](const auto&... member) { (f(member), ...); }, planeMembers);
}

/// Calls f(member) for those that are passed on.
template <class F>
void forEachPassed(F&& f)
{
  forEachMember(
      [&](const auto& member)
      {
        using Member = std::decay_t<decltype(member)>;
        static_assert((Member::passing != Passing::None) == (Member::stale != Stale::Unsaid),
                      "say of what is passed on, and only of that, when it makes a search stale");
        if constexpr (Member::passing != Passing::None)
          f(member);
      });
}

/// Calls f(number&) for the numbers that a member consists of.
template <class T, class F>
void forEachPart(T& value, F&& f)
{
  if constexpr (std::is_array_v<T>)
    for (auto& part : value)
      forEachPart(part, f);
  else if constexpr (std::is_same_v<std::remove_const_t<T>, Vec3>)
    for (auto* const part : {&value.x, &value.y, &value.z})
      f(*part);
  else
    f(value);
}

/// Calls f(number&) for all that checkpoints and the hash have of a plane, const or not.
template <class PlaneOrConst, class F>
void forEachNumber(PlaneOrConst& plane, F&& f)
{
  forEachMember(
      [&](const auto& member)
      {
        if (!member.leftOut)
          forEachPart(member.get(plane), f);
      });
}

/// Names of these numbers.
std::vector<std::string> namesOfNumbers();

/// Whether they are the same in two planes.
bool sameNumbers(const Plane& a, const Plane& b);

/// Adds these numbers to the hash of a state, as field `what`.
void addTo(StateHash& hash, std::uint64_t what, const Plane& plane);
} // namespace coplane
