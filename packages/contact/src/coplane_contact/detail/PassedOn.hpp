#pragma once

#include <coplane_contact/PairLife.hpp>
#include <coplane_contact/PlaneState.hpp>

#include <cmath>
#include <tuple>
#include <type_traits>
#include <utility>

namespace coplane
{
namespace detail
{
/// Numbers of a type of forEachPart().
template <class T>
constexpr int partsOf()
{
  if constexpr (std::is_array_v<T>)
    return int(std::extent_v<T>) * partsOf<std::remove_extent_t<T>>();
  else
    return std::is_same_v<T, Vec3> ? 3 : 1;
}
/// Numbers of a member whose changes may make a search stale.
template <class Member>
constexpr int watchedParts(const Member& member)
{
  if constexpr (Member::stale == Stale::Unsaid || Member::stale == Stale::Never)
    return 0;
  else
    return partsOf<std::remove_reference_t<decltype(member.get(std::declval<Plane&>()))>>();
}
} // namespace detail

/// What a plane passes on, as far as a pair that takes over would be wrong with what it was at the
/// last search: of the list of PlaneState.hpp what may be stale (`Stale`), and of a plane that
/// carries nothing only whether it has absorbed a gap of the mesh.
class PassedOn
{
public:
  PassedOn() = default;
  /// @param incremental closures are sums of increments
  PassedOn(const Plane& plane, const JointLaw& law, bool incremental)
  {
    absorbed_ = plane.isBorn() && plane.history.absorbed;
    if (!(plane.area > 0))
      return;
    depth_ = std::trunc(plane.closure / (0.25 * deepestBirth * plane.depthLimit));
    int next = 0;
    forEachWatched(
        [&](const auto& member)
        {
          const auto& value = member.get(plane);
          const bool counts = matters<std::decay_t<decltype(member)>::stale>(law, incremental);
          forEachPart(value, [&](const auto& part) { numbers_[next++] = counts ? Real(part) : 0; });
        });
  }

  bool operator!=(const PassedOn& o) const
  {
    bool differs = false;
    for (int i = 0; i < count; ++i)
      differs = differs || numbers_[i] != o.numbers_[i];
    return differs;
  }
  /// Whether it explains another depth of the pairs beside it (PotentialCycle::refuse), or has come
  /// to absorb a gap or an overlap: these pairs would be taken for none, or for some, with what it
  /// was a few cycles ago.
  bool isAsDeepAs(const PassedOn& o) const
  {
    return depth_ == o.depth_ && absorbed_ == o.absorbed_;
  }

private:
  /// Calls f(member) for those whose changes may make a search stale.
  template <class F>
  static void forEachWatched(const F& f)
  {
    forEachPassed(
        [&](const auto& member)
        {
          if constexpr (std::decay_t<decltype(member)>::stale != Stale::Never)
            f(member);
        });
  }

  template <Stale when>
  static bool matters(const JointLaw& law, bool incremental)
  {
    switch (when)
    {
    case Stale::Always:
      return true;
    case Stale::WithCurve:
      return !law.curve.straight();
    case Stale::WithSoftening:
      return law.bond.softens();
    case Stale::WithSlipMemory:
      return law.remembersSlip();
    case Stale::WithClosureMemory:
      return incremental;
    case Stale::Unsaid:
    case Stale::Never:
      break;
    }
    return false;
  }

  static constexpr int count = std::apply(
      [](const auto&... member) { return (0 + ... + detail::watchedParts(member)); }, planeMembers);
  Real numbers_[count] = {};
  bool absorbed_ = false;
  Real depth_ = 0; ///< in fourths of the depth at which first overlaps are none
};
} // namespace coplane
