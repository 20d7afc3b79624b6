#pragma once

#include <coplane_element/detail/ElementShape.hpp>
#include <coplane_element/detail/HughesWinget.hpp>

namespace coplane
{
/// The mean motion of an element from n to n + 1, seen from the positions in its middle.
template <ElementType type, Geometry geometry>
struct MeanMotion
{
  using Shape = ElementShape<type, geometry>;
  using Field = typename Shape::Field;
  static constexpr int dim = Shape::dim;
  static constexpr int gradients = Shape::gradients;
  static constexpr bool revolved = Shape::revolved;

  Field middle;                    ///< positions at n + 1/2 [m]
  Lanes volume = Lanes(0.0);       ///< there [m^3]
  Lanes volumeChange = Lanes(0.0); ///< tr(D) dt V at n + 1/2 [m^3]
  Lanes traceG = Lanes(0.0);       ///< sum of b_jI^2 over nodes and axes [1/m^2]
  SymTensorOf<Lanes> strain;       ///< D dt of the element's own motion, on which its forces work

  /// Also gives the point its displacement gradient, strain increment and rotation (Hughes and
  /// Winget).
  /// @param x positions at n + 1 [m], v velocities at n + 1/2 [m/s]
  KOKKOS_FORCEINLINE_FUNCTION void find(const Field& x, const Field& v, Real dt,
                                        MaterialPoint<Lanes>& point)
  {
    Shape::findMiddle(x, v, dt, middle);
    findDisplacementGradient(v, dt, point.displacementGradient);
    const Mat3Of<Lanes>& l = point.displacementGradient;
    findSymmetricPart(l, strain);
    findSymmetricPart(l, point.strainIncrement);
    if constexpr (dim == 3)
      point.rotation = hughesWinget(l);
    else
      hughesWingetInPlane(l, point.rotation);
    volumeChange = (strain.xx + strain.yy + strain.zz) * volume;
  }

private:
  /// L_ij dt = dt sum_I v_iI b_jI; also volume and traceG.
  KOKKOS_FORCEINLINE_FUNCTION void findDisplacementGradient(const Field& v, Real dt,
                                                            Mat3Of<Lanes>& l)
  {
    constexpr int nodes = Shape::nodes;
    const typename Shape::Gradient g = Shape::gradientAt(middle);
    volume = g.volume;
    const Lanes inverseVolume = Lanes(1.0) / volume;
    const Lanes factor = Lanes(nodes) * inverseVolume * Lanes(dt);
    if constexpr (dim == 2)
      for (int i = 0; i < 3; ++i)
        l(i, 2) = l(2, i) = Lanes(0.0);
    Lanes squares(0.0);
    for (int j = 0; j < dim; ++j)
    {
      for (int i = 0; i < dim; ++i)
      {
        Lanes sum = v.modes[i][0] * g.b[j][0];
#pragma GCC unroll 8
        for (int k = 1; k < gradients; ++k)
          sum += v.modes[i][k] * g.b[j][k];
        l(i, j) = sum * factor;
      }
#pragma GCC unroll 8
      for (int k = 0; k < gradients; ++k)
        squares += g.b[j][k] * g.b[j][k];
    }
    if constexpr (revolved)
    {
      Lanes sum = v.mean * g.hoop[gradients];
      for (int k = 0; k < gradients; ++k)
        sum += v.modes[0][k] * g.hoop[k];
      l(2, 2) = sum * factor;
    }
    traceG = Lanes(nodes) * squares * inverseVolume * inverseVolume;
  }
};
} // namespace coplane
