#pragma once

#include <coplane_core/BranchFree.hpp>
#include <coplane_core/Lanes.hpp>
#include <coplane_element/detail/Cofactors.hpp>

namespace coplane
{
// Bending that one point does not see is one more component of the stress that the law returns to
// its surface. Hourglass forces Q on the amplitudes of modes belong to stresses of a brick with
// half edges L_k, whatever stiffness they come from: those of a mode that moves along edge k do the
// work of a stress 3 Q_k L_k / V at its faces that is linear across it (Q q = V/3 sigma q/L). A
// rectangle flows throughout where that is 3/2 of the strength, so
//
//   s = 2 Q_k L_k / V  is its part in the von Mises stress,  4 Q_k L_k / V for the mode xi eta zeta
//
// (the mean of |xi| is 1/2, that of |xi eta| 1/4), and in plane strain, where a stress across keeps
// the volume, sqrt(3)/2 of it. Two bendings that vary along one axis count by their own von Mises
// stress. Modes that twist, u_i along xi_j xi_k, are shears tau_ij over L_i and L_j: with Q_i
// L_i^-1 = A_ij + A_ik, A_ij = V/3 tau_ij / (L_i L_j), their part is 3 (2/3 tau_ij)^2.
//
// Half edges need not be at right angles: Q_k are components along them. MaterialPoint tells the
// law s^2, and what is left of s when it has flowed.

/// Components of Q along half edges, over their lengths, Q = sum of them times x_k; squared
/// lengths.
template <int dim, int modes, int count, class T>
KOKKOS_INLINE_FUNCTION void alongEdges(const T (&x)[dim][count], const T (&force)[modes][dim],
                                       T (&component)[modes][dim], T (&lengthSquared)[dim])
{
  T edge[dim][dim], dual[dim][dim]; // dual_k . edge_j = delta_kj
  for (int k = 0; k < dim; ++k)
    for (int i = 0; i < dim; ++i)
      edge[k][i] = x[i][k];
  inverseTransposed(edge, dual);
  for (int k = 0; k < dim; ++k)
  {
    lengthSquared[k] = x[0][k] * x[0][k];
    for (int i = 1; i < dim; ++i)
      lengthSquared[k] += x[i][k] * x[i][k];
    for (int a = 0; a < modes; ++a)
    {
      component[a][k] = dual[k][0] * force[a][0];
      for (int i = 1; i < dim; ++i)
        component[a][k] += dual[k][i] * force[a][i];
    }
  }
}

/// s^2 of all modes together [Pa^2].
/// @param x modes of the positions: the first `dim` are half edges [m]; volume [m^3]
/// @param force on the modes [N]
template <int dim, int modes, int count, class T>
KOKKOS_INLINE_FUNCTION T bendingSquared(const T (&x)[dim][count], const T& volume,
                                        const T (&force)[modes][dim])
{
  T q[modes][dim], lengthSquared[dim], sum(0.0);
  alongEdges<dim>(x, force, q, lengthSquared);
  if constexpr (dim == 2)
    for (int k = 0; k < 2; ++k)
    {
      const T s = q[0][k] * lengthSquared[k];
      sum += T(3.0) * s * s;
    }
  else
    for (int i = 0; i < 3; ++i)
    {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      // mode j moves along i, and mode i along j, both linear along k
      const T a = q[j][i] * lengthSquared[i], b = q[i][j] * lengthSquared[j];
      const T last = q[3][i] * lengthSquared[i];
      const T twist = q[i][i] + q[j][j] - q[k][k];
      sum += T(4.0) * (a * a + b * b - a * b) + T(16.0) * last * last +
             T(3.0) * twist * twist * lengthSquared[i] * lengthSquared[j];
    }
  return sum / (volume * volume);
}

/// The same of a ring, whose bending that varies along one half edge has a stress around as well.
/// @param hoopForce on the slopes of the hoop strain along the half edges [N m]
template <int modes, int count, class T>
KOKKOS_INLINE_FUNCTION T bendingSquaredOfRing(const T (&x)[2][count], const T& volume,
                                              const T (&force)[modes][2], const T (&hoopForce)[2])
{
  T q[modes][2], lengthSquared[2], sum(0.0);
  alongEdges<2>(x, force, q, lengthSquared);
  for (int k = 0; k < 2; ++k)
  {
    const T s = q[0][k] * lengthSquared[k];
    const T& around = hoopForce[1 - k];
    sum += T(4.0) * (s * s + around * around - s * around);
  }
  return sum / (volume * volume);
}
} // namespace coplane
