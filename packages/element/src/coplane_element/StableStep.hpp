#pragma once

#include <coplane_core/BranchFree.hpp>
#include <coplane_core/Real.hpp>

namespace coplane
{
// How fast can an element vibrate? With n corners, the lumped mass rho V / n in each and the mean
// gradient b, its strain modes have the frequencies
//
//     omega^2 = (n / rho) eigenvalues of  B^T C B.
//
// In the principal axes of g_jk = sum_I b_jI b_kI, the normal strains give the matrix lambda s s^T
// + 2 mu diag(g), s_i = sqrt(g_i), and the shear strains mu (g_i + g_j), which is never more. The
// largest eigenvalue of that matrix is 2 mu y, y the largest root of
//
//     y^3 - (1+c) I1 y^2 + (1+2c) I2 y - (1+3c) I3 = 0,     c = lambda / (2 mu),  I1, I2, I3 the
//     invariants of g
//
// (all roots are real; in two dimensions I3 = 0 and one root y = 0 drops out). Negative lambda is
// replaced by zero: an upper bound.

/// Largest root y of the cubic above, never below it: Newton's method from above on a polynomial
/// with real roots only falls towards the largest one. It starts at mean + sqrt(2) standard
/// deviation of the roots, the exact value when the other two coincide (a cube, or a rod). After
/// three rounds the rest is at most a few percent, and only for flat shapes without lambda.
template <class T>
KOKKOS_INLINE_FUNCTION T fastestStrainMode(const T& i1, const T& i2, const T& i3, Real c)
{
  using namespace branchFree;
  const T scale = T(1.0) / i1;
  const T a = T(1.0 + c);
  const T b = T(1.0 + 2 * c) * (i2 * scale * scale);
  const T d = T(1.0 + 3 * c) * (i3 * scale * scale * scale);
  const T mean = T((1.0 + c) / 3);
  const T variance =
      positivePart(T((1.0 + c) * (1.0 + c) / 3 - (1.0 + c) * (1.0 + c) / 9) - T(2.0 / 3.0) * b);
  T y = mean + squareRoot(T(2.0) * variance);
  for (int round = 0; round < 3; ++round)
  {
    const T value = ((y - a) * y + b) * y - d;
    const T slope = (T(3.0) * y - T(2.0) * a) * y + b;
    // A larger slope makes a smaller step: still from above, and safe where all roots coincide.
    y -= positivePart(value) / larger(slope, T(1e-6));
  }
  return y * i1;
}

/// The same in two dimensions, in closed form.
template <class T>
KOKKOS_INLINE_FUNCTION T fastestStrainMode(const T& i1, const T& i2, Real c)
{
  const T a = T(1.0 + c) * i1;
  return T(0.5) *
         (a + branchFree::squareRoot(branchFree::positivePart(a * a - T(4 * (1.0 + 2 * c)) * i2)));
}

template <int dim, class T>
KOKKOS_INLINE_FUNCTION T traceOf(const T (&g)[dim][dim])
{
  if constexpr (dim == 3)
    return g[0][0] + g[1][1] + g[2][2];
  else
    return g[0][0] + g[1][1];
}

/// The same of the matrix g.
template <int dim, class T>
KOKKOS_INLINE_FUNCTION T fastestStrainMode(const T (&g)[dim][dim], Real c)
{
  if constexpr (dim == 3)
  {
    const T m0 = g[1][1] * g[2][2] - g[1][2] * g[1][2];
    const T m1 = g[0][0] * g[2][2] - g[0][2] * g[0][2];
    const T m2 = g[0][0] * g[1][1] - g[0][1] * g[0][1];
    const T det = g[0][0] * m0 - g[0][1] * (g[0][1] * g[2][2] - g[1][2] * g[0][2]) +
                  g[0][2] * (g[0][1] * g[1][2] - g[1][1] * g[0][2]);
    return fastestStrainMode(traceOf(g), m0 + m1 + m2, det, c);
  }
  else
    return fastestStrainMode(traceOf(g), g[0][0] * g[1][1] - g[0][1] * g[0][1], c);
}

/// Squared frequency bound of the strain modes of a body of revolution, with a mass in each corner:
/// the largest eigenvalue of C G with the strains (r, axial, hoop, shear) and
/// G = sum_I (V/m_I) e_I e_I^T over the motions of the corners, bounded by trace((C G)^8)^(1/8): at
/// most 19 % too high, and rounding when one mode is much faster than the others.
/// @param b gradients over the volume of the corners [1/m]
/// @param hoop H_I / V [1/m]; weight V / m_I [m^3/kg]
template <int nodes, class T>
KOKKOS_INLINE_FUNCTION T fastestRevolvedMode(const T (&b)[2][nodes], const T (&hoop)[nodes],
                                             const T (&weight)[nodes], Real lambda, Real mu)
{
  T g[4][4];
  for (auto& row : g)
    for (T& value : row)
      value = T(0.0);
  for (int c = 0; c < nodes; ++c)
  {
    const T radial[4] = {b[0][c], T(0.0), hoop[c], b[1][c]};
    const T axial[4] = {T(0.0), b[1][c], T(0.0), b[0][c]};
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        g[i][j] += weight[c] * (radial[i] * radial[j] + axial[i] * axial[j]);
  }
  T s[4][4], trace(0.0);
  for (int j = 0; j < 4; ++j)
  {
    const T sum = T(lambda) * (g[0][j] + g[1][j] + g[2][j]);
    for (int i = 0; i < 3; ++i)
      s[i][j] = sum + T(2 * mu) * g[i][j];
    s[3][j] = T(mu) * g[3][j];
    trace += s[j][j];
  }
  const T scale = T(1.0) / trace;
  for (auto& row : s)
    for (T& value : row)
      value *= scale;
  for (int squaring = 0; squaring < 2; ++squaring)
  {
    T next[4][4];
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        next[i][j] = s[i][0] * s[0][j] + s[i][1] * s[1][j] + s[i][2] * s[2][j] + s[i][3] * s[3][j];
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        s[i][j] = next[i][j];
  }
  T eighth(0.0);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      eighth += s[i][j] * s[j][i];
  using branchFree::squareRoot;
  return trace * squareRoot(squareRoot(squareRoot(eighth)));
}

/// Bound of the largest eigenvalue of A + H for matrices that are not negative, from those of A and
/// H and from the squared norm of A^(1/2) H^(1/2) (Kittaneh 2002). Strain modes and hourglass modes
/// of a parallelepiped do not mix (coupling 0, the larger wins).
template <class T>
KOKKOS_INLINE_FUNCTION T largestOfSum(const T& strain, const T& hourglass, const T& couplingSquared)
{
  const T difference = strain - hourglass;
  return T(0.5) * ((strain + hourglass) +
                   branchFree::squareRoot(difference * difference + T(4.0) * couplingSquared));
}

/// Largest stable step of central differences whose damping force lags half a step: dt^2 omega^2 /
/// 4 + dt damping / 2 <= 1.
/// @param omegaSquared largest eigenvalue of M^-1 K [1/s^2]
/// @param damping largest eigenvalue of M^-1 C [1/s]
template <class T>
KOKKOS_INLINE_FUNCTION T stableStep(const T& omegaSquared, const T& damping)
{
  // dt = (2/omega) (sqrt(1 + z^2) - z), z = damping / (2 omega), written without cancellation
  const T half = T(0.5) * damping;
  return T(2.0) / (branchFree::squareRoot(omegaSquared + half * half) + half);
}
} // namespace coplane
