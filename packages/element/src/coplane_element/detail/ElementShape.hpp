#pragma once

#include <coplane_element/detail/Batch.hpp>
#include <coplane_element/detail/Revolved.hpp>

namespace coplane
{
/// Fields and mean-gradient operators of a batch of elements. Functions are inlined by force: a
/// call between them costs small elements up to a quarter of their time.
template <ElementType type, Geometry geometry>
struct ElementShape
{
  using M = Modes<type>;
  static constexpr bool revolved = geometry == Geometry::Axisymmetric;
  static constexpr int dim = M::dimension;
  static constexpr int nodes = M::nodes;
  static constexpr bool hasHourglass = M::hourglass > 0;
  /// Modes that the operators have; the others vanish.
  static constexpr int gradients = []
  {
    if constexpr (revolved)
      return Revolved<type>::gradients;
    else
      return M::gradients;
  }();

  /// Positions [m] or velocities [m/s].
  struct Field
  {
    Lanes modes[dim][M::count]; ///< of each component (MeanGradient.hpp)
    Lanes mean = Lanes(0.0);    ///< over the corners, of the component along r; rings only
  };

  /// Operators at some positions, and the volume there.
  struct Gradient
  {
    Lanes b[dim][gradients];                  ///< modes of dV/dx, of rings without the hoop part
    Lanes hoop[revolved ? gradients + 1 : 1]; ///< modes of H, the last its mean (Revolved.hpp)
    Lanes volume;                             ///< [m^3]
  };

  /// Positions and velocities of the nodes as fields.
  static KOKKOS_FORCEINLINE_FUNCTION void gather(const ElementKernelData& data, int first, Field& x,
                                                 Field& v)
  {
    // By corners, for the places of their nodes to stay in registers.
    const int* const node = &data.connectivity(first, 0);
    const Real *const positions = data.x.data(), *const velocities = data.v.data();
    Lanes atCorners[2][dim][nodes];
    for (int c = 0; c < nodes; ++c)
    {
      std::size_t place[laneCount];
      for (int lane = 0; lane < laneCount; ++lane)
        place[lane] = std::size_t(3) * std::size_t(node[lane * nodes + c]);
      for (int i = 0; i < dim; ++i)
      {
        atCorners[0][i][c] = Lanes([&](auto lane) { return positions[place[int(lane)] + i]; });
        atCorners[1][i][c] = Lanes([&](auto lane) { return velocities[place[int(lane)] + i]; });
      }
    }
    fieldOf(atCorners[0], x);
    fieldOf(atCorners[1], v);
  }

  /// Positions in the middle of the step that ended at x with the velocities v.
  static KOKKOS_FORCEINLINE_FUNCTION void findMiddle(const Field& x, const Field& v, Real dt,
                                                     Field& middle)
  {
    const Lanes half(0.5 * dt);
    for (int i = 0; i < dim; ++i)
      for (int k = 0; k < M::count; ++k)
        middle.modes[i][k] = x.modes[i][k] - half * v.modes[i][k];
    if constexpr (revolved)
      middle.mean = x.mean - half * v.mean;
  }

  static KOKKOS_FORCEINLINE_FUNCTION Gradient gradientAt(const Field& x)
  {
    Gradient g;
    if constexpr (revolved)
      g.volume = Revolved<type>::volumeGradient(x.modes, x.mean, g.b, g.hoop);
    else
    {
      M::volumeGradient(x.modes, g.b);
      g.volume = M::volume(x.modes, g.b);
    }
    return g;
  }

  /// V^(1/3), or A^(1/2) of the section [m]. The cube root is one step of Halley's method from the
  /// reference length: exact to 1 % while the volume stays between half and twice the first one;
  /// the viscosity needs no more.
  static KOKKOS_FORCEINLINE_FUNCTION Lanes lengthOf(const ElementKernelData& data,
                                                    const Gradient& g, int first)
  {
    if constexpr (revolved)
      return stdx::sqrt(
          branchFree::positivePart(Lanes(nodes / (2 * pi)) * g.hoop[gradients])); // of the area
    else if constexpr (dim == 2)
      return stdx::sqrt(branchFree::positivePart(g.volume));
    else
    {
      const Lanes reference = load(&data.referenceVolume(first));
      return load(&data.referenceLength(first)) * (reference + Lanes(2.0) * g.volume) /
             (Lanes(2.0) * reference + g.volume);
    }
  }

  /// Modes k >= gradients are 0.
  static KOKKOS_FORCEINLINE_FUNCTION Lanes modeOf(const Lanes (&operators)[gradients], int k)
  {
    return k < gradients ? operators[k < gradients ? k : 0] : Lanes(0.0);
  }

private:
  /// Corner 0 is taken off first: a far origin or a common speed then costs no digits.
  static KOKKOS_FORCEINLINE_FUNCTION void fieldOf(const Lanes (&atCorners)[dim][nodes],
                                                  Field& field)
  {
    for (int i = 0; i < dim; ++i)
    {
      const Lanes(&corner)[nodes] = atCorners[i];
      Lanes u[nodes];
      u[0] = Lanes(0.0);
#pragma GCC unroll 8
      for (int c = 1; c < nodes; ++c)
        u[c] = corner[c] - corner[0];
      M::fromCorners(u, field.modes[i]);
      if (revolved && i == 0)
      {
        Lanes sum = u[1];
        for (int c = 2; c < nodes; ++c)
          sum += u[c];
        field.mean = corner[0] + Lanes(1.0 / nodes) * sum;
      }
    }
  }
};
} // namespace coplane
