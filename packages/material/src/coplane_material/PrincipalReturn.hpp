#pragma once

#include <coplane_core/ElementaryFunctions.hpp>
#include <coplane_material/LinearElastic.hpp>
#include <coplane_material/Principal.hpp>

#include <type_traits>

namespace coplane
{
// Return of principal stresses s1 >= s2 >= s3 to a shear criterion with a tension cut-off
// (MohrCoulomb, HoekBrown): to faces, edges and corners, as of de Souza Neto et al. (2008), section
// 8.2. The stress ends on one, two or three surfaces; sets of them are tried one after another.
namespace principalReturn
{
enum Surface : int
{
  Face13, ///< the criterion of s1 and s3
  Face12, ///< of s1 and s2, beside Face13 where s2 = s3
  Face23, ///< of s2 and s3, beside Face13 where s1 = s2
  Cut1,   ///< s1 at the tensile strength
  Cut2,   ///< s2, beside Cut1
  Cut3    ///< s3, beside these
};

/// Surfaces on which the stress ends.
struct Set
{
  int count;
  Surface surface[3];

  constexpr bool cuts() const { return surface[count - 1] >= Cut1; }
  constexpr bool slides() const { return surface[0] < Cut1; }
};

/// From the fewest surfaces to the most; the corner of pure tension is the last resort.
inline constexpr Set sets[] = {{1, {Face13}},
                               {1, {Cut1}},
                               {2, {Face13, Face23}},
                               {2, {Face13, Face12}},
                               {2, {Face13, Cut1}},
                               {2, {Cut1, Cut2}},
                               {3, {Face13, Face12, Cut1}},
                               {3, {Face13, Face23, Cut1}},
                               {3, {Face13, Cut1, Cut2}},
                               {3, {Cut1, Cut2, Cut3}}};
inline constexpr int setCount = sizeof(sets) / sizeof(*sets);

/// Normal of a surface: slope s1 - s3, and so on, or one stress.
template <class T>
KOKKOS_INLINE_FUNCTION void direction(Surface surface, const T& slope, T (&n)[3])
{
  n[0] = n[1] = n[2] = T(0.0);
  if (surface >= Cut1)
    n[surface - Cut1] = T(1.0);
  else
  {
    n[surface == Face23 ? 1 : 0] = slope;
    n[surface == Face12 ? 1 : 2] = T(-1.0);
  }
}

/// Direction of plastic flow, and the stress that it takes away [Pa].
/// @param slope N_psi [-]; S is Real where all elements have the same, else T
template <class S>
KOKKOS_INLINE_FUNCTION void flowOf(const LinearElastic& elastic, Surface surface, const S& slope,
                                   S (&g)[3], S (&dg)[3])
{
  direction(surface, slope, g);
  const S lambda(elastic.bulkModulus - 2.0 / 3.0 * elastic.shearModulus);
  for (int i = 0; i < 3; ++i)
    dg[i] = lambda * (g[0] + g[1] + g[2]) + S(2 * elastic.shearModulus) * g[i];
}

/// Multipliers that bring a trial stress onto all surfaces of a set, which are planes.
/// @param slope N of the faces, flowSlope N_psi [-]
/// @param bond, cut strengths of faces and cut-off [Pa]
template <class T, class S>
KOKKOS_INLINE_FUNCTION void solve(const LinearElastic& elastic, const Set& set, const T (&trial)[3],
                                  const T& slope, const S& flowSlope, const T& bond, const T& cut,
                                  T (&multiplier)[3])
{
  const T one(1.0), zero(0.0);
  Mat3Of<T> a{{{one, zero, zero}, {zero, one, zero}, {zero, zero, one}}};
  T over[3] = {zero, zero, zero};
  for (int i = 0; i < set.count; ++i)
  {
    T n[3];
    direction(set.surface[i], slope, n);
    over[i] =
        n[0] * trial[0] + n[1] * trial[1] + n[2] * trial[2] - (set.surface[i] >= Cut1 ? cut : bond);
    for (int j = 0; j < set.count; ++j)
    {
      S g[3], dg[3];
      flowOf(elastic, set.surface[j], flowSlope, g, dg);
      a.a[i][j] = n[0] * T(dg[0]) + n[1] * T(dg[1]) + n[2] * T(dg[2]);
    }
  }
  const Mat3Of<T> b = inverse(a);
  for (int i = 0; i < set.count; ++i)
    multiplier[i] = b.a[i][0] * over[0] + b.a[i][1] * over[1] + b.a[i][2] * over[2];
}

/// Plastic strains of a return.
template <class T>
struct Flow
{
  T strain[3] = {T(0.0), T(0.0), T(0.0)}; ///< along the principal axes [-]
  T slip = T(0.0);                        ///< plastic shear of the faces [-]
  T opening = T(0.0);                     ///< of the cut-off [-]

  /// Equivalent plastic strain [-].
  KOKKOS_INLINE_FUNCTION T equivalent() const
  {
    const T mean = T(1.0 / 3.0) * (strain[0] + strain[1] + strain[2]);
    T squares(0.0);
    for (int i = 0; i < 3; ++i)
      squares += (strain[i] - mean) * (strain[i] - mean);
    return branchFree::squareRoot(T(2.0 / 3.0) * squares);
  }
};

/// Returns the stresses s [Pa] in the lanes that yield.
/// @param tolerance of stresses [Pa]
/// @param multipliersOf (set, open lanes, multiplier): finds the multipliers of a set; returns
///        N_psi of its flow, Real or T
/// @param bears (set, stress): where surfaces that are not in the set bear the stress
template <class T, class MultipliersOf, class Bears>
KOKKOS_INLINE_FUNCTION Flow<T> returnTo(const LinearElastic& elastic, T (&s)[3],
                                        const branchFree::MaskOf<T>& yields, const T& tolerance,
                                        const MultipliersOf& multipliersOf, const Bears& bears)
{
  using branchFree::choose;
  const T zero(0.0);
  const T trial[3] = {s[0], s[1], s[2]};
  Flow<T> flow;
  auto open = yields;
  for (int k = 0; k < setCount && branchFree::anyOf(open); ++k)
  {
    const Set& set = sets[k];
    T multiplier[3] = {zero, zero, zero}, result[3] = {trial[0], trial[1], trial[2]};
    const auto slope = multipliersOf(set, open, multiplier);
    T strain[3] = {zero, zero, zero};
    for (int m = 0; m < set.count; ++m)
    {
      std::decay_t<decltype(slope)> g[3], dg[3];
      flowOf(elastic, set.surface[m], slope, g, dg);
      for (int i = 0; i < 3; ++i)
      {
        result[i] -= T(dg[i]) * multiplier[m];
        strain[i] += T(g[i]) * multiplier[m];
      }
    }
    auto good = open && bears(set, result) && result[0] - result[1] > -tolerance &&
                result[1] - result[2] > -tolerance;
    for (int m = 0; m < set.count; ++m)
      good = good && multiplier[m] >= zero;
    if (k == setCount - 1)
      good = open;
    for (int i = 0; i < 3; ++i)
    {
      s[i] = choose(good, result[i], s[i]);
      flow.strain[i] = choose(good, strain[i], flow.strain[i]);
    }
    for (int m = 0; m < set.count; ++m)
    {
      const bool opens = set.surface[m] >= Cut1;
      flow.slip += choose(good, opens ? zero : (T(1.0) + T(slope)) * multiplier[m], zero);
      flow.opening += choose(good, opens ? multiplier[m] : zero, zero);
    }
    open = open && !good;
  }
  return flow;
}

/// The tensile strength after some opening that is smeared over the element: it falls
/// exponentially, such that the energy per area of a crack does not depend on the size [Pa].
/// @param energy G_I [J/m^2]; 0: it does not fall
template <class T>
KOKKOS_INLINE_FUNCTION T tensionAfter(Real strength, Real energy, const T& opening, const T& size)
{
  if (energy <= 0)
    return T(strength);
  return T(strength) * branchFree::exponential(T(-strength / energy) * opening * size);
}

/// The factor by which bending falls: that of the return, and no more than what is left of the
/// strength [Pa].
template <class T>
KOKKOS_INLINE_FUNCTION T bendingKept(const T& factor, const T& bending, const T& most)
{
  return branchFree::choose(factor * bending > most, most / bending, factor);
}
} // namespace principalReturn
} // namespace coplane
