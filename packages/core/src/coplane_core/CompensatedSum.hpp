#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>

#include <Kokkos_Macros.hpp>

namespace coplane
{
/// Adds a term to a sum of which `rest` is what it has more than the number `sum` can hold (Knuth,
/// The Art of Computer Programming 2, 4.2.2). Small terms are not lost in a large sum, however many
/// they are.
KOKKOS_INLINE_FUNCTION void addCompensated(Real& sum, Real& rest, Real term)
{
  const Real all = term + rest, next = sum + all, added = next - sum;
  rest = (sum - (next - added)) + (all - added);
  sum = next;
}

KOKKOS_INLINE_FUNCTION void addCompensated(Vec3& sum, Vec3& rest, const Vec3& term)
{
  addCompensated(sum.x, rest.x, term.x);
  addCompensated(sum.y, rest.y, term.y);
  addCompensated(sum.z, rest.z, term.z);
}
} // namespace coplane
