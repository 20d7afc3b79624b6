#pragma once

#include <coplane_core/BranchFree.hpp>
#include <coplane_core/Lanes.hpp>

namespace coplane
{
// Bending that one point does not see flows where its stress and that of the point together reach
// the strength. Hourglass forces Q on the amplitudes of modes that move along a half edge x_k
// belong to a stress 3 (Q.x_k) / V at the faces of a brick, whatever stiffness they come from (work
// Q q = V/3 sigma q/L). A rectangle flows throughout where that is 3/2 of the strength, so
//
//   s = 2 (Q.x_k) / V   is its part in the strength,  4 (Q.x_k) / V for the mode xi eta zeta
//
// (the mean of |xi| is 1/2, that of |xi eta| 1/4), and in plane strain, where bending keeps the
// volume by a stress across the plane, sqrt(3)/2 of it. Two fibres that carry the point's stress
// plus and minus this one return to the surface along themselves: both fall by
// Y / sqrt(q^2 + sum s^2), with the point's von Mises stress q before it flows. Where the point
// flows by itself that is the factor of its own return, and bending relaxes with it.

/// s of all modes together, squared [Pa^2]: of two bendings that vary along one axis the von Mises
/// stress, else the sum of squares.
/// @param x modes of the positions: the first `dim` are half edges [m]; volume [m^3]
/// @param force on the modes [N]
template <int dim, int modes, int count, class T>
KOKKOS_INLINE_FUNCTION T bendingSquared(const T (&x)[dim][count], const T& volume,
                                        const T (&force)[modes][dim])
{
  T sum(0.0), along[modes][dim];
  for (int a = 0; a < modes; ++a)
    for (int k = 0; k < dim; ++k)
    {
      along[a][k] = x[0][k] * force[a][0];
      for (int i = 1; i < dim; ++i)
        along[a][k] += x[i][k] * force[a][i];
      sum += T(dim == 2 ? 3.0 : a < 3 ? 4.0 : 16.0) * along[a][k] * along[a][k];
    }
  if constexpr (dim == 3)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < i; ++j)
        sum -= T(4.0) * along[i][j] * along[j][i];
  return sum / (volume * volume);
}

/// By which hourglass forces fall, 1 where nothing flows.
/// @param strength Y [Pa]; trialMises q of the point [Pa]; bendingSquared [Pa^2]
/// @param floor   least strength, so that modes do not run free where nothing bears [Pa]
template <class T>
KOKKOS_INLINE_FUNCTION T hourglassReturn(const T& strength, const T& trialMises,
                                         const T& bendingSquared, Real floor)
{
  const T most = branchFree::larger(strength, T(floor));
  const T whole = trialMises * trialMises + bendingSquared;
  const auto flows = whole > most * most && bendingSquared > T(0.0);
  if (!branchFree::anyOf(flows))
    return T(1.0);
  return branchFree::choose(flows, most / branchFree::squareRoot(whole), T(1.0));
}
} // namespace coplane
