#pragma once

#include <coplane_material/Invariants.hpp>
#include <coplane_material/LinearElastic.hpp>

namespace coplane
{
/// Compressible neo-Hookean rubber: sigma = K/2 (J - 1/J) I + mu/J dev(J^(-2/3) b), of the energy
/// K/4 (J^2 - 1 - 2 ln J) + mu/2 (J^(-2/3) tr b - 3). b = f b f^T is advanced by the exact
/// increment of the deformation, f = (I - l/2)^-1 (I + l/2), so closed paths close.
struct NeoHookean
{
  LinearElastic elastic; ///< at no strain

  static constexpr int historyCount = 6;
  static constexpr const char* historyNames[] = {"left_cauchy_green_xx", "left_cauchy_green_yy",
                                                 "left_cauchy_green_zz", "left_cauchy_green_xy",
                                                 "left_cauchy_green_yz", "left_cauchy_green_zx"};
  static constexpr bool usesVolume = false, changesTangent = true, hasStrength = false;

  /// The reference is the shape at the start.
  void startFrom(const SymTensor& stress, Real* history) const;

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    const T half(0.5), one(1.0), third(1.0 / 3.0);
    Mat3Of<T> minus, plus;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        const T l = half * point.displacementGradient(i, j);
        minus(i, j) = i == j ? one - l : -l;
        plus(i, j) = i == j ? one + l : l;
      }
    const Mat3Of<T> f = inverse(minus) * plus;
    T* const h = point.history;
    const Mat3Of<T> old{{{h[0], h[3], h[5]}, {h[3], h[1], h[4]}, {h[5], h[4], h[2]}}};
    const Mat3Of<T> half2 = f * old;
    const auto entry = [&](int i, int j)
    { return half2(i, 0) * f(j, 0) + half2(i, 1) * f(j, 1) + half2(i, 2) * f(j, 2); };
    const SymTensorOf<T> b{entry(0, 0), entry(1, 1), entry(2, 2),
                           entry(0, 1), entry(1, 2), entry(2, 0)};
    h[0] = b.xx;
    h[1] = b.yy;
    h[2] = b.zz;
    h[3] = b.xy;
    h[4] = b.yz;
    h[5] = b.zx;

    const T ratio = branchFree::squareRoot(determinantOf(b));
    const T root = branchFree::cubeRoot(ratio);
    const T shear = T(elastic.shearModulus) / (ratio * root * root); // mu J^(-5/3)
    const SymTensorOf<T> deviator = deviatorOf(b);
    point.stress = stressOf(deviator, shear, half * T(elastic.bulkModulus) * (ratio - one / ratio));

    // Wave moduli: along n, K/2 (J + 1/J) + mu J^(-5/3) (5/9 tr b - b_nn / 3), and for shear waves
    // mu J^(-5/3) b_nn; bounds of b_nn are tr b / 3 +- sqrt(2/3) |dev b|.
    const T trace = b.xx + b.yy + b.zz;
    const T spread = branchFree::squareRoot(T(2.0 / 3.0) * contract(deviator, deviator));
    const T least = branchFree::positivePart(third * trace - spread);
    const T along = half * T(elastic.bulkModulus) * (ratio + one / ratio) +
                    shear * (T(5.0 / 9.0) * trace - third * least);
    const T across = shear * (third * trace + spread);
    point.stiffening = branchFree::larger(along, across) *
                       T(1 / (elastic.bulkModulus + 4.0 / 3.0 * elastic.shearModulus));
  }
};

struct NeoHookeanParameters : ElasticParameters
{
  static MaterialModel model();
};
NeoHookean makeLaw(const NeoHookeanParameters& parameters);
} // namespace coplane
