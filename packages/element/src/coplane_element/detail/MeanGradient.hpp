#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_mesh/ElementTopology.hpp>

#include <Kokkos_Core.hpp>

namespace coplane
{
// Mean-gradient operators of the one-point elements (Flanagan and Belytschko 1981), written in
// "modes": instead of its value in every corner, a field is described by its share of each sign
// pattern of the corners. With the corner signs xi, eta, zeta of the parent square or cube,
//
//   u(corner I) = mean + u[0] xi_I + u[1] eta_I + ...        u[k] = (1/n) sum_I pattern_k(I) u_I
//
//   Tri3   patterns: sqrt(3/2) (-1, 1, 0), sqrt(1/2) (-1, -1, 2) | none    n = 3
//   Quad4  patterns: xi, eta | xi eta                              n = 4
//   Tet4   patterns: (-1, 1, -1, 1), (-1, -1, 1, 1), (1, -1, -1, 1) | none     n = 4
//   Hex8   patterns: xi, eta, zeta | eta zeta, zeta xi, xi eta, xi eta zeta       n = 8
//
// Patterns right of the bar are the hourglass base vectors. Volume gradients B_iI = dV/dx_iI,
// contractions with B and hourglass shapes are short in this basis because each of them has few
// modes; nothing is approximated. Triangles and tetrahedra have no corner signs: their patterns are
// chosen like the others, orthogonal, without mean, of squared length n, so that one kernel serves
// all shapes. T is Real or Lanes.
template <ElementType type>
struct Modes;

template <>
struct Modes<ElementType::Tri3>
{
  static constexpr int dimension = 2, nodes = 3, count = 2, hourglass = 0;
  static constexpr int gradients = 2;
  static constexpr Real rootOfHalf = 0.70710678118654752440;        ///< sqrt(1/2)
  static constexpr Real rootOfThreeHalves = 1.22474487139158904910; ///< sqrt(3/2)

  template <class T>
  static KOKKOS_INLINE_FUNCTION void fromCorners(const T (&u)[3], T (&mode)[2])
  {
    const T step = u[1] - u[0];
    mode[0] = T(rootOfThreeHalves / 3) * step;
    mode[1] = T(rootOfHalf / 3) * ((u[2] - u[0]) + (u[2] - u[1]));
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION void toCorners(const T (&mode)[2], T (&u)[3])
  {
    const T along = T(rootOfThreeHalves) * mode[0], up = T(rootOfHalf) * mode[1];
    u[0] = -along - up;
    u[1] = along - up;
    u[2] = up + up;
  }

  /// dA/dx = 1/2 [y2-y3, y3-y1, y1-y2] and so on.
  template <class T>
  static KOKKOS_INLINE_FUNCTION void volumeGradient(const T (&x)[2][2], T (&b)[2][2])
  {
    const T factor(0.5 * rootOfThreeHalves / rootOfHalf); // sqrt(3)/2
    b[0][0] = factor * x[1][1];
    b[0][1] = -factor * x[1][0];
    b[1][0] = -factor * x[0][1];
    b[1][1] = factor * x[0][0];
  }

  /// V = sum_I x_I B_xI [m^3], unit thickness.
  template <class T>
  static KOKKOS_INLINE_FUNCTION T volume(const T (&x)[2][2], const T (&b)[2][2])
  {
    return T(3.0) * (x[0][0] * b[0][0] + x[0][1] * b[0][1]);
  }
};

template <>
struct Modes<ElementType::Quad4>
{
  static constexpr int dimension = 2, nodes = 4, count = 3, hourglass = 1;
  static constexpr int gradients = 2; ///< modes that B has; the others vanish

  template <class T>
  static KOKKOS_INLINE_FUNCTION void fromCorners(const T (&u)[4], T (&mode)[3])
  {
    const T bottom = u[0] + u[1], top = u[2] + u[3];
    const T bottomStep = u[1] - u[0], topStep = u[2] - u[3];
    mode[0] = T(0.25) * (bottomStep + topStep);
    mode[1] = T(0.25) * (top - bottom);
    mode[2] = T(0.25) * (topStep - bottomStep);
  }

  /// Corner values of a field without mean.
  template <class T>
  static KOKKOS_INLINE_FUNCTION void toCorners(const T (&mode)[3], T (&u)[4])
  {
    const T bottomStep = mode[0] - mode[2], topStep = mode[0] + mode[2];
    u[0] = -mode[1] - bottomStep;
    u[1] = bottomStep - mode[1];
    u[2] = mode[1] + topStep;
    u[3] = mode[1] - topStep;
  }

  /// Modes of B from those of the positions: dA/dx = 1/2 [y2-y4, y3-y1, y4-y2, y1-y3] and so on.
  template <class T>
  static KOKKOS_INLINE_FUNCTION void volumeGradient(const T (&x)[2][3], T (&b)[2][2])
  {
    b[0][0] = x[1][1];
    b[0][1] = -x[1][0];
    b[1][0] = -x[0][1];
    b[1][1] = x[0][0];
  }

  /// V = sum_I x_I B_xI [m^3], unit thickness.
  template <class T>
  static KOKKOS_INLINE_FUNCTION T volume(const T (&x)[2][3], const T (&b)[2][2])
  {
    return T(4.0) * (x[0][0] * b[0][0] + x[0][1] * b[0][1]);
  }
};

template <>
struct Modes<ElementType::Tet4>
{
  static constexpr int dimension = 3, nodes = 4, count = 3, hourglass = 0;
  static constexpr int gradients = 3;

  template <class T>
  static KOKKOS_INLINE_FUNCTION void fromCorners(const T (&u)[4], T (&mode)[3])
  {
    const T quarter(0.25);
    mode[0] = quarter * ((u[1] - u[0]) + (u[3] - u[2]));
    mode[1] = quarter * ((u[2] - u[0]) + (u[3] - u[1]));
    mode[2] = quarter * ((u[0] - u[1]) + (u[3] - u[2]));
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION void toCorners(const T (&mode)[3], T (&u)[4])
  {
    u[0] = mode[2] - (mode[0] + mode[1]);
    u[1] = mode[0] - (mode[1] + mode[2]);
    u[2] = mode[1] - (mode[0] + mode[2]);
    u[3] = mode[0] + mode[1] + mode[2];
  }

  /// With V = (8/3) det of the modes of x, y, z: B_x = (2/3) (y x z), and so on.
  template <class T>
  static KOKKOS_INLINE_FUNCTION void volumeGradient(const T (&x)[3][3], T (&b)[3][3])
  {
    gradientAlong(x[1], x[2], b[0]);
    gradientAlong(x[2], x[0], b[1]);
    gradientAlong(x[0], x[1], b[2]);
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION T volume(const T (&x)[3][3], const T (&b)[3][3])
  {
    return T(4.0) * (x[0][0] * b[0][0] + x[0][1] * b[0][1] + x[0][2] * b[0][2]);
  }

private:
  template <class T>
  static KOKKOS_INLINE_FUNCTION void gradientAlong(const T (&y)[3], const T (&z)[3], T (&b)[3])
  {
    const T factor(2.0 / 3.0);
    b[0] = factor * (y[1] * z[2] - y[2] * z[1]);
    b[1] = factor * (y[2] * z[0] - y[0] * z[2]);
    b[2] = factor * (y[0] * z[1] - y[1] * z[0]);
  }
};

template <>
struct Modes<ElementType::Hex8>
{
  static constexpr int dimension = 3, nodes = 8, count = 7, hourglass = 4;
  static constexpr int gradients = 6;

  template <class T>
  static KOKKOS_INLINE_FUNCTION void fromCorners(const T (&u)[8], T (&mode)[7])
  {
    // sums and differences along zeta, then xi, then eta
    const T s0 = u[4] + u[0], s1 = u[5] + u[1], s2 = u[6] + u[2], s3 = u[7] + u[3];
    const T d0 = u[4] - u[0], d1 = u[5] - u[1], d2 = u[6] - u[2], d3 = u[7] - u[3];
    const T sFront = s0 + s1, sBack = s2 + s3, sFrontStep = s1 - s0, sBackStep = s2 - s3;
    const T dFront = d0 + d1, dBack = d2 + d3, dFrontStep = d1 - d0, dBackStep = d2 - d3;
    const T eighth(0.125);
    mode[0] = eighth * (sFrontStep + sBackStep);
    mode[1] = eighth * (sBack - sFront);
    mode[2] = eighth * (dFront + dBack);
    mode[3] = eighth * (dBack - dFront);
    mode[4] = eighth * (dFrontStep + dBackStep);
    mode[5] = eighth * (sBackStep - sFrontStep);
    mode[6] = eighth * (dBackStep - dFrontStep);
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION void toCorners(const T (&mode)[7], T (&u)[8])
  {
    // values at eta = -1 (front) and +1 (back): s even and d odd in zeta
    const T sFrontStep = mode[0] - mode[5], sBackStep = mode[0] + mode[5];
    const T dFront = mode[2] - mode[3], dBack = mode[2] + mode[3];
    const T dFrontStep = mode[4] - mode[6], dBackStep = mode[4] + mode[6];
    const T s0 = -mode[1] - sFrontStep, s1 = sFrontStep - mode[1];
    const T s2 = mode[1] + sBackStep, s3 = mode[1] - sBackStep;
    const T d0 = dFront - dFrontStep, d1 = dFront + dFrontStep;
    const T d2 = dBack + dBackStep, d3 = dBack - dBackStep;
    u[0] = s0 - d0;
    u[1] = s1 - d1;
    u[2] = s2 - d2;
    u[3] = s3 - d3;
    u[4] = s0 + d0;
    u[5] = s1 + d1;
    u[6] = s2 + d2;
    u[7] = s3 + d3;
  }

  /// Modes of B_xI = integral of the determinant of (grad N_I, grad y, grad z) over the parent
  /// cube, exact for the trilinear map; y and z are the next axes in cyclic order.
  template <class T>
  static KOKKOS_INLINE_FUNCTION void volumeGradient(const T (&x)[3][7], T (&b)[3][6])
  {
    gradientAlong(x[1], x[2], b[0]);
    gradientAlong(x[2], x[0], b[1]);
    gradientAlong(x[0], x[1], b[2]);
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION T volume(const T (&x)[3][7], const T (&b)[3][6])
  {
    return T(8.0) * ((x[0][0] * b[0][0] + x[0][1] * b[0][1] + x[0][2] * b[0][2]) +
                     (x[0][3] * b[0][3] + x[0][4] * b[0][4] + x[0][5] * b[0][5]));
  }

private:
  template <class T>
  static KOKKOS_INLINE_FUNCTION void gradientAlong(const T (&y)[7], const T (&z)[7], T (&b)[6])
  {
    const T third(1.0 / 3.0);
    b[0] = (y[1] * z[2] - y[2] * z[1]) + third * (y[5] * z[4] - y[4] * z[5]);
    b[1] = (y[2] * z[0] - y[0] * z[2]) + third * (y[3] * z[5] - y[5] * z[3]);
    b[2] = (y[0] * z[1] - y[1] * z[0]) + third * (y[4] * z[3] - y[3] * z[4]);
    b[3] = third * ((y[2] * z[4] - y[4] * z[2]) + (y[5] * z[1] - y[1] * z[5]));
    b[4] = third * ((y[0] * z[5] - y[5] * z[0]) + (y[3] * z[2] - y[2] * z[3]));
    b[5] = third * ((y[1] * z[3] - y[3] * z[1]) + (y[4] * z[0] - y[0] * z[4]));
  }
};
} // namespace coplane
