#pragma once

#include <coplane_element/detail/MeanGradient.hpp>

namespace coplane
{
// Mean-gradient operators of bodies of revolution, in the modes of MeanGradient.hpp. x is the
// radius r. The operators are integrals over the whole turn, exact for the linear and the bilinear
// map, with the weight 2 pi r that the virtual work has:
//
//     B_xI = 2 pi int r dN_I/dx dA,   B_yI = 2 pi int r dN_I/dy dA,   H_I = 2 pi int N_I dA
//
// V D_theta = sum_I v_xI H_I. The derivative of the volume is B_x + H, and B_y: a uniform pressure
// is in balance, and so is a uniform axial stress.
template <ElementType type>
struct Revolved;

template <>
struct Revolved<ElementType::Tri3>
{
  using M = Modes<ElementType::Tri3>;
  static constexpr int gradients = 2;

  /// @param meanRadius of the corners [m]
  /// @param hoop modes of H; the last is its mean
  /// @return V [m^3]
  template <class T>
  static KOKKOS_INLINE_FUNCTION T volumeGradient(const T (&x)[2][2], const T& meanRadius,
                                                 T (&b)[2][2], T (&hoop)[3])
  {
    M::volumeGradient(x, b);
    const T area = M::volume(x, b);
    const T around = T(2 * pi) * meanRadius;
    for (auto& row : b)
      for (T& value : row)
        value *= around;
    hoop[0] = hoop[1] = T(0.0);
    hoop[2] = T(2 * pi / 3) * area;
    return around * area;
  }
};

template <>
struct Revolved<ElementType::Quad4>
{
  static constexpr int gradients = 3;

  template <class T>
  static KOKKOS_INLINE_FUNCTION T volumeGradient(const T (&x)[2][3], const T& meanRadius,
                                                 T (&b)[2][3], T (&hoop)[4])
  {
    // x = mean + x0 xi + x1 eta + x2 xi eta; determinant of the map: j0 + j1 xi + j2 eta
    const T &x0 = x[0][0], &x1 = x[0][1], &x2 = x[0][2];
    const T &y0 = x[1][0], &y1 = x[1][1], &y2 = x[1][2];
    const T twoPi(2 * pi), third(1.0 / 3.0);
    const T j0 = x0 * y1 - x1 * y0;
    const T j1 = third * (x0 * y2 - x2 * y0), j2 = third * (x2 * y1 - x1 * y2);
    b[0][0] = twoPi * (meanRadius * y1 + third * (x0 * y2));
    b[0][1] = -twoPi * (meanRadius * y0 + third * (x1 * y2));
    b[0][2] = twoPi * third * (x1 * y1 - x0 * y0);
    b[1][0] = -twoPi * (meanRadius * x1 + third * (x0 * x2));
    b[1][1] = twoPi * (meanRadius * x0 + third * (x1 * x2));
    b[1][2] = twoPi * third * (x0 * x0 - x1 * x1);
    hoop[0] = twoPi * j1;
    hoop[1] = twoPi * j2;
    hoop[2] = T(0.0);
    hoop[3] = twoPi * j0;
    return T(8 * pi) * (meanRadius * j0 + (x0 * j1 + x1 * j2));
  }
};
} // namespace coplane
