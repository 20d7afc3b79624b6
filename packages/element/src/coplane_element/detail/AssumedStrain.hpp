#pragma once

#include <coplane_element/detail/ObjectiveRate.hpp>

namespace coplane
{
// Stabilisation by an assumed strain (Belytschko and Bindeman 1991, 1993): hourglass modes are
// resisted as if the element were a brick with edges 2 L_i along axes that turn with it, in which
//
//   bending in the plane of two axes        is free of stress across it (plane stress there),
//   bending with the function xi eta zeta   is uniaxial tension and compression,
//   twisting                                is free of normal stress,
//
// so that a rectangular element bends exactly. With q_i[a] the rate of mode a along axis i, e_i =
// q_i[j] / L_i, and i, j, k different, energy per volume V/3:
//
//   plane:  E/(1-nu^2) e_i^2 / 2
//   solid:  E/(1-nu^2) (e_i^2 + e_j^2 + 2 nu e_i e_j) / 2 for the function that varies along k,
//           E / 3 (q_i[3] / L_i)^2 / 2 for the last mode,  mu (q_i[i] / L_j + q_j[j] / L_i)^2 / 2.
//
// A ring bends like a brick whose third direction is the hoop: bending that varies along xi has
// stress along eta and around, and the other way round. The hoop strain u_r / r has the slopes
// e_xi, e_eta at the middle, which one point does not see either (the section of a ring that turns
// has nothing else), and a part along xi eta that is taken as uniaxial:
//
//   ring:   E/(1-nu^2) (e_i^2 + e_j^2 + 2 nu e_i e_j) / 2 with e_i = q_i / L_i along eta and the
//           slope e_j = e_xi; the same with xi and eta changed;  E / 3 (q_r / r)^2 / 2.

/// Hoop slopes of a ring: d(u_r / r)/dxi and d/deta at the middle, from modes of a field along r,
/// its mean over the corners, and those of the radius.
template <class T, int count>
KOKKOS_INLINE_FUNCTION void hoopSlopes(const T (&x)[count], const T& radius, const T (&u)[count],
                                       const T& mean, T (&slope)[2])
{
  const T per = T(1.0) / radius;
  for (int k = 0; k < 2; ++k)
    slope[k] = per * (u[k] - mean * per * x[k]);
}

/// Axes and half lengths of an element.
template <class T>
struct BrickFrame
{
  Mat3Of<T> axes; ///< columns: unit vectors of the brick, orthogonal to rounding or nearly so
  T inverseLength[3];
};

/// @param x modes of the positions: column k of the first `dim` is half the edge along axis k
template <int dim, int count, class T>
KOKKOS_INLINE_FUNCTION BrickFrame<T> brickFrame(const T (&x)[dim][count])
{
  BrickFrame<T> frame;
  Mat3Of<T> directions;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      directions(i, k) = T(i == k ? 1.0 : 0.0);
  for (int k = 0; k < dim; ++k)
  {
    T squared = x[0][k] * x[0][k];
    for (int i = 1; i < dim; ++i)
      squared += x[i][k] * x[i][k];
    frame.inverseLength[k] = T(1.0) / branchFree::squareRoot(squared);
    for (int i = 0; i < dim; ++i)
      directions(i, k) = x[i][k] * frame.inverseLength[k];
  }
  // Directions of the edges are orthogonal nearly: a few rounds are enough.
  if constexpr (dim == 3)
    frame.axes = polarRotation(directions, 4);
  else
    frame.axes = polarRotationInPlane(directions);
  return frame;
}

/// Moduli by which the modes are resisted.
struct AssumedStrainModuli
{
  Real plane;   ///< E / (1 - nu^2) [Pa]
  Real poisson; ///< nu [-]
  Real young;   ///< E [Pa]
  Real shear;   ///< mu [Pa]

  AssumedStrainModuli(Real lambda, Real mu)
      : plane(4 * mu * (lambda + mu) / (lambda + 2 * mu)), poisson(0.5 * lambda / (lambda + mu)),
        young(mu * (3 * lambda + 2 * mu) / (lambda + mu)), shear(mu)
  {
  }
  /// The same for a ring, without the part over the radius.
  Real largestOfRing() const { return plane * (1 + std::abs(poisson)); }
  /// Bound of all stiffnesses, over V / 3 and the shortest half length squared (Gershgorin).
  template <int dim>
  Real largest() const
  {
    if (dim == 2)
      return plane;
    const Real bending = plane * (1 + std::abs(poisson));
    return std::max({bending, 4 * shear, young / 3});
  }
};

/// Increments of the hourglass forces from those of the modes, q dt [m]; both in global axes.
template <int dim, int modes, class T>
KOKKOS_INLINE_FUNCTION void
assumedStrainForces(const BrickFrame<T>& frame, const AssumedStrainModuli& moduli, const T& volume,
                    const T (&increment)[modes][dim], T (&force)[modes][dim])
{
  const Mat3Of<T>& r = frame.axes;
  const T third = T(1.0 / 3.0) * volume;
  const T(&inverse)[3] = frame.inverseLength;
  T q[modes][dim], p[modes][dim];
  for (int a = 0; a < modes; ++a)
    for (int i = 0; i < dim; ++i)
    {
      q[a][i] = r(0, i) * increment[a][0];
      for (int j = 1; j < dim; ++j)
        q[a][i] += r(j, i) * increment[a][j];
    }
  if constexpr (dim == 2)
    for (int i = 0; i < 2; ++i)
      p[0][i] = third * T(moduli.plane) * inverse[i] * inverse[i] * q[0][i];
  else
  {
    for (int i = 0; i < 3; ++i)
      p[i][i] = T(0.0);
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
        if (i != j)
          p[j][i] = third * T(moduli.plane) * inverse[i] *
                    (inverse[i] * q[j][i] + T(moduli.poisson) * (inverse[j] * q[i][j]));
      p[3][i] = third * T(moduli.young / 3) * inverse[i] * inverse[i] * q[3][i];
      const int j = (i + 1) % 3;
      const T twist = third * T(moduli.shear) * (inverse[j] * q[i][i] + inverse[i] * q[j][j]);
      p[i][i] += twist * inverse[j];
      p[j][j] += twist * inverse[i];
    }
  }
  for (int a = 0; a < modes; ++a)
    for (int i = 0; i < dim; ++i)
    {
      force[a][i] = r(i, 0) * p[a][0];
      for (int j = 1; j < dim; ++j)
        force[a][i] += r(i, j) * p[a][j];
    }
}

/// Increments of the forces of a ring: on the mode of the section, in global axes, and on the two
/// hoop slopes [N m].
/// @param increment of the mode, q dt [m]; slope: of the hoop slopes [-]
template <class T>
KOKKOS_INLINE_FUNCTION void
assumedStrainForcesOfRing(const BrickFrame<T>& frame, const AssumedStrainModuli& moduli,
                          const T& volume, const T& radius, const T (&increment)[1][2],
                          const T (&slope)[2], T (&force)[1][2], T (&hoopForce)[2])
{
  const Mat3Of<T>& r = frame.axes;
  const T third = T(1.0 / 3.0) * volume;
  const T plane(moduli.plane), poisson(moduli.poisson);
  T p[2];
  for (int i = 0; i < 2; ++i)
  {
    const int j = 1 - i; // the mode along axis i is bending that varies along axis j
    const T along =
        frame.inverseLength[i] * (r(0, i) * increment[0][0] + r(1, i) * increment[0][1]);
    p[i] = third * plane * frame.inverseLength[i] * (along + poisson * slope[j]);
    hoopForce[j] = third * plane * (slope[j] + poisson * along);
  }
  for (int i = 0; i < 2; ++i)
    force[0][i] = r(i, 0) * p[0] + r(i, 1) * p[1];
  force[0][0] += third * T(moduli.young / 3) * increment[0][0] / (radius * radius);
}
} // namespace coplane
