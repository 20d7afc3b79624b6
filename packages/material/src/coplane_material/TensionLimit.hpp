#pragma once

#include <coplane_core/BranchFree.hpp>

namespace coplane
{
/// Mean tension that is elastic up to a limit, which damage lowers: what was stored beyond the new
/// limit is lost. Work of the step at the mean of the stresses at its ends, as in the energy of the
/// element, less what is stored more: less than nothing in a step that comes to the limit, of which
/// the mean gives less work than is stored. With a tension that is linear in mu an opening at a
/// limit takes L (J - 1) / J, so that the integral over mu is per volume now [J/m^3].
/// @param before mean stress at the start of the step; elasticBefore, elastic: without the limit,
///        at its start and end; limit at its end [Pa]; tension positive
template <class T>
KOKKOS_INLINE_FUNCTION T lostToTension(const T& before, const T& elasticBefore, const T& elastic,
                                       const T& limit, const T& bulkModulus)
{
  using branchFree::choose, branchFree::smaller;
  const T half(0.5), zero(0.0);
  const auto stored = [&](const T& whole, const T& borne)
  { return borne * (whole - half * borne); };
  const T first = smaller(before, elasticBefore);
  const T work = half * (first + limit) * (elastic - elasticBefore);
  const T lost = (work - stored(elastic, limit) + stored(elasticBefore, first)) / bulkModulus;
  return choose(elastic > limit, choose(before > limit, lost, smaller(lost, zero)), zero);
}
} // namespace coplane
