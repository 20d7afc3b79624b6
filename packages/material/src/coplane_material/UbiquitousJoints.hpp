#pragma once

#include <coplane_geometry/PlaneAxes.hpp>
#include <coplane_material/MohrCoulomb.hpp>

namespace coplane
{
/// Weak planes of one orientation everywhere in a matrix of Mohr and Coulomb: ubiquitous joints, as
/// of geotechnical codes (Itasca, FLAC, Constitutive Models). With the normal n of
/// the planes, sn = n.s.n (tension positive) and the shear traction t across n: |t| + sn tan(phi)
/// <= c and sn <= st. Slip along t, dilation tan(psi) per slip; opening along n. Perfectly plastic
/// planes; the matrix softens as MohrCoulomb does. Both criteria hold at the end of the step, and
/// the plastic strains of matrix and planes both belong to the stress there: which of them comes
/// first does not matter. docs/theory/materials.md has the formulas.
///
/// The planes are a surface of the material: the normal follows f^-T of the step, which is
/// MaterialPoint::rotation where the material only turns, and leaves planes that only slip as they
/// are.
struct UbiquitousJoints
{
  MohrCoulomb matrix;
  Vec3 normal;          ///< n at the start, of length 1 [-]
  Real cohesion;        ///< c of the planes [Pa]
  Real friction;        ///< tan(phi) of the planes [-]
  Real dilation;        ///< tan(psi) of the planes [-]; 0 <= tan(psi) <= tan(phi)
  Real tensileStrength; ///< st, across the planes [Pa]; at most c / tan(phi)

  enum
  {
    Slip = MohrCoulomb::historyCount, // plastic shear strain along the planes [-]
    Opening,                          // plastic strain across them, of dilation too [-]
    NormalX,
    NormalY,
    NormalZ
  };
  static constexpr int historyCount = NormalZ + 1;
  static constexpr const char* historyNames[] = {"equivalent_plastic_strain",
                                                 "plastic_shear",
                                                 "crack_opening",
                                                 "plane_slip",
                                                 "plane_opening",
                                                 "plane_normal_x",
                                                 "plane_normal_y",
                                                 "plane_normal_z"};
  static constexpr bool usesVolume = true, changesTangent = false, hasStrength = true;

  /// The normal is part of the history.
  void startFrom(const SymTensor& stress, Real* history) const;

  template <class T>
  KOKKOS_INLINE_FUNCTION void operator()(MaterialPoint<T>& point) const
  {
    using branchFree::choose;
    const T zero(0.0), one(1.0);
    const Axes<T> axes = axesOf(normalAfter(point));
    for (int i = 0; i < 3; ++i)
      point.history[NormalX + i] = axes.n[i];
    SymTensorOf<T> trial = point.stress;
    matrix.elastic.addElasticIncrement(point.strainIncrement, trial);

    // Unknown is x, what the planes take away from the traction across them. The matrix returns
    // from what is left of the trial stress to a stress with the traction t; the planes return from
    // t + x and take y(x) away. Where y = x the stress satisfies both.
    const auto matrixAfter = [&](const Traction<T>& x)
    {
      MaterialPoint<T> inner = point;
      inner.strainIncrement = {zero, zero, zero, zero, zero, zero};
      inner.stress = relieved(trial, axes, x);
      matrix(inner);
      return inner;
    };
    const auto missing = [&](const Traction<T>& x)
    {
      const Traction<T> t = tractionOf(matrixAfter(x).stress, axes);
      const Traction<T> y = takenByPlanes<T>({t.n + x.n, t.a + x.a, t.b + x.b});
      return Traction<T>{x.n - y.n, x.a - y.a, x.b - y.b};
    };
    Traction<T> x{zero, zero, zero};
    MaterialPoint<T> end = matrixAfter(x);
    const Traction<T> first = takenByPlanes(tractionOf(end.stress, axes));
    const auto yields = sizeOf(first) > zero;
    if (branchFree::anyOf(yields))
    {
      const T qTrial = vonMisesOf(deviatorOf(trial));
      x = takenTogether(missing, chosen(yields, first, x), takenByPlanes(tractionOf(trial, axes)),
                        qTrial + branchFree::absolute(meanOf(trial)), yields);
      end = matrixAfter(x);
      const T perShear(1 / matrix.elastic.shearModulus), perNormal(1 / normalModulus());
      const T lost = keepWithinPlanes(yields, axes, end.stress);
      const Traction<T> t = tractionOf(end.stress, axes);
      end.dissipation += branchFree::positivePart(perNormal * x.n * t.n +
                                                  perShear * (x.a * t.a + x.b * t.b) + lost);
      end.history[Slip] += perShear * branchFree::squareRoot(x.a * x.a + x.b * x.b);
      end.history[Opening] += perNormal * x.n;
      // Bending falls by the factors of both returns.
      const T q = vonMisesOf(deviatorOf(relieved(trial, axes, x)));
      end.bendingScale *= choose(q < qTrial, q / qTrial, one);
    }
    for (int i = 0; i < historyCount; ++i)
      point.history[i] = end.history[i];
    point.stress = end.stress;
    point.dissipation = end.dissipation;
    point.bendingScale = end.bendingScale;
  }

private:
  static constexpr int mostRounds = 30, mostCuts = 5;
  /// Of what is missing: over the strength of the matrix, and over the size of the trial stress.
  static constexpr Real strengthTolerance = 1e-12, rounding = 1e-14;
  /// Differences for slopes: over what is missing, and at least over the strength of the matrix.
  static constexpr Real nudgeShare = 1e-3, leastNudge = 1e-6;
  /// By which what is missing may grow on a step towards y(x), by rounding.
  static constexpr Real allowedGrowth = 1e-6;
  /// Steps end within this much of the size of the trial stress.
  static constexpr Real farthest = 10;

  /// The normal of the planes and two axes in them.
  template <class T>
  struct Axes
  {
    Vec3Of<T> n, a, b;
  };
  /// Its components along these [Pa].
  template <class T>
  struct Traction
  {
    T n, a, b;
    KOKKOS_FORCEINLINE_FUNCTION T& operator[](int i) { return i == 0 ? n : i == 1 ? a : b; }
    KOKKOS_FORCEINLINE_FUNCTION const T& operator[](int i) const
    {
      return i == 0 ? n : i == 1 ? a : b;
    }
  };
  template <class Mask, class T>
  KOKKOS_FORCEINLINE_FUNCTION static Traction<T> chosen(const Mask& mask, const Traction<T>& a,
                                                        const Traction<T>& b)
  {
    return {branchFree::choose(mask, a.n, b.n), branchFree::choose(mask, a.a, b.a),
            branchFree::choose(mask, a.b, b.b)};
  }

  /// x with missing(x) = x - y(x) = 0, in the lanes of `yields`. Newton's steps with slopes by
  /// differences, shortened while that helps; else y(x), and longer steps that way where nothing
  /// changes. With associated flow y(x) never falls behind x: both returns are projections. A lane
  /// that is there is frozen.
  /// @param first after the matrix; returned for lanes that do not yield
  /// @param other a start as if the matrix were elastic
  /// @param reach size of the trial stress [Pa]
  template <class T, class Missing>
  KOKKOS_INLINE_FUNCTION Traction<T> takenTogether(const Missing& missing, const Traction<T>& first,
                                                   const Traction<T>& other, const T& reach,
                                                   const branchFree::MaskOf<T>& yields) const
  {
    const T tolerance = T(strengthTolerance * strength()) + T(rounding) * reach;
    Search<T> at{first, missing(first), T(1.0)};
    auto open = yields && sizeOf(at.r) > tolerance;
    if (branchFree::anyOf(open))
    {
      const Traction<T> rOther = missing(other);
      const auto nearer = open && sizeOf(rOther) < sizeOf(at.r);
      at.x = chosen(nearer, other, at.x);
      at.r = chosen(nearer, rOther, at.r);
      open = open && sizeOf(at.r) > tolerance;
    }
    for (int k = 0; k < mostRounds && branchFree::anyOf(open); ++k)
    {
      stepAlong(missing, newtonStep(missing, at), reach, open, at);
      open = open && sizeOf(at.r) > tolerance;
    }
    return at.x;
  }

  /// Where a search is.
  template <class T>
  struct Search
  {
    Traction<T> x, r; ///< x and missing(x) [Pa]
    T stretch;        ///< of steps towards y(x), which grow while Newton's do not help [-]
  };

  KOKKOS_INLINE_FUNCTION Real strength() const { return matrix.cohesion + matrix.tensileStrength; }

  /// Newton's step to be taken from x, with slopes by differences.
  template <class T, class Missing>
  KOKKOS_INLINE_FUNCTION Traction<T> newtonStep(const Missing& missing, const Search<T>& at) const
  {
    const T nudge = branchFree::larger(T(nudgeShare) * sizeOf(at.r), T(leastNudge * strength()));
    Mat3Of<T> slopes;
    for (int j = 0; j < 3; ++j)
    {
      const T h = branchFree::choose(at.r[j] > T(0.0), -nudge, nudge);
      Traction<T> beside = at.x;
      beside[j] += h;
      const Traction<T> there = missing(beside);
      for (int i = 0; i < 3; ++i)
        slopes(i, j) = (there[i] - at.r[i]) / h;
    }
    const Mat3Of<T> inverted = inverse(slopes);
    Traction<T> step;
    for (int i = 0; i < 3; ++i)
      step[i] = inverted(i, 0) * at.r.n + inverted(i, 1) * at.r.a + inverted(i, 2) * at.r.b;
    return step;
  }

  /// Goes as much of Newton's step as helps, else towards y(x), in the lanes that are open.
  template <class T, class Missing>
  KOKKOS_INLINE_FUNCTION void stepAlong(const Missing& missing, const Traction<T>& newton,
                                        const T& reach, const branchFree::MaskOf<T>& open,
                                        Search<T>& at) const
  {
    using branchFree::choose;
    const T one(1.0), size = sizeOf(at.r);
    Traction<T> next = at.x, rNext = at.r;
    auto searching = open;
    for (int cut = 0; cut < mostCuts + 2 && branchFree::anyOf(searching); ++cut)
    {
      const bool byNewton = cut < mostCuts, last = cut == mostCuts + 1;
      const T part = byNewton ? T(1.0 / (1 << cut)) : last ? one : at.stretch;
      Traction<T> there = at.x;
      for (int i = 0; i < 3; ++i)
        there[i] -= part * (byNewton ? newton[i] : at.r[i]);
      const Traction<T> rThere = missing(there);
      const T bound = byNewton ? (one - T(0.5) * part) * size : T(1 + allowedGrowth) * size;
      // Far away digits are lost, and with them what is missing.
      auto good = searching && sizeOf(rThere) < bound && sizeOf(there) < T(farthest) * reach;
      if (last)
        good = searching;
      next = chosen(good, there, next);
      rNext = chosen(good, rThere, rNext);
      if (!byNewton)
        at.stretch =
            choose(good, last ? branchFree::larger(T(0.25) * at.stretch, one) : T(2.0) * at.stretch,
                   at.stretch);
      searching = searching && !good;
    }
    at.x = chosen(open, next, at.x);
    at.r = chosen(open, rNext, at.r);
  }

  /// What is left over the strength of the planes goes along a straight line towards a hydrostatic
  /// stress, which planes and matrix bear: rounding, or more where the rounds came to their end.
  /// Returns the work that is lost [J/m^3].
  template <class T>
  KOKKOS_INLINE_FUNCTION T keepWithinPlanes(const branchFree::MaskOf<T>& yields,
                                            const Axes<T>& axes, SymTensorOf<T>& stress) const
  {
    using branchFree::choose;
    const T zero(0.0), one(1.0);
    const Traction<T> t = tractionOf(stress, axes);
    const T mean = meanOf(stress), middle = branchFree::smaller(mean, T(-matrix.cohesion));
    const T sheared = branchFree::positivePart(shearOver(t));
    const T pulled = branchFree::positivePart(t.n - T(tensileStrength));
    const T part =
        choose(yields,
               branchFree::larger(sheared / (sheared + T(cohesion) - T(friction) * middle),
                                  pulled / (pulled + T(tensileStrength) - middle)),
               zero);
    const auto falls = part > zero;
    const SymTensorOf<T> s = deviatorOf(stress);
    const T meanThere = mean + part * (middle - mean);
    const SymTensorOf<T> there = stressOf(s, one - part, meanThere);
    stress = coplane::chosen(falls, there, stress);
    return part * (T(0.5 / matrix.elastic.shearModulus) * (one - part) * contract(s, s) +
                   T(1 / matrix.elastic.bulkModulus) * (mean - middle) * meanThere);
  }

  KOKKOS_INLINE_FUNCTION Real normalModulus() const
  {
    return matrix.elastic.bulkModulus + 4.0 / 3.0 * matrix.elastic.shearModulus;
  }

  /// n at the end of the step: f^-T n, of length 1, with f^-1 = (I + l/2)^-1 (I - l/2).
  template <class T>
  KOKKOS_INLINE_FUNCTION static Vec3Of<T> normalAfter(const MaterialPoint<T>& point)
  {
    const T half(0.5), one(1.0);
    Mat3Of<T> minus, plus; // transposed
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
      {
        const T l = half * point.displacementGradient(j, i);
        minus(i, j) = i == j ? one - l : -l;
        plus(i, j) = i == j ? one + l : l;
      }
    const T* const h = point.history;
    const Vec3Of<T> n = minus * (inverse(plus) * Vec3Of<T>{h[NormalX], h[NormalY], h[NormalZ]});
    return (one / branchFree::squareRoot(dot(n, n))) * n;
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION static Axes<T> axesOf(const Vec3Of<T>& n)
  {
    const PlaneAxesOf<T> axes = planeAxes<3>(n);
    return {n, axes.e1, axes.e2};
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION static Traction<T> tractionOf(const SymTensorOf<T>& s, const Axes<T>& axes)
  {
    const Vec3Of<T>& n = axes.n;
    const Vec3Of<T> t{s.xx * n.x + s.xy * n.y + s.zx * n.z, s.xy * n.x + s.yy * n.y + s.yz * n.z,
                      s.zx * n.x + s.yz * n.y + s.zz * n.z};
    return {dot(t, n), dot(t, axes.a), dot(t, axes.b)};
  }

  /// The stress when opening and slip of the planes have taken x from the traction: an opening e
  /// takes e ((K - 2G/3) I + 2G n n), a slip g takes G (g n + n g).
  template <class T>
  KOKKOS_INLINE_FUNCTION SymTensorOf<T> relieved(const SymTensorOf<T>& s, const Axes<T>& axes,
                                                 const Traction<T>& x) const
  {
    const Real lambda = matrix.elastic.bulkModulus - 2.0 / 3.0 * matrix.elastic.shearModulus;
    const T all = T(lambda / normalModulus()) * x.n, along = x.n - all;
    const Vec3Of<T>& n = axes.n;
    const Vec3Of<T> g = x.a * axes.a + x.b * axes.b;
    const auto entry = [&](int i, int j)
    { return along * n[i] * n[j] + (g[i] * n[j] + n[i] * g[j]); };
    return {s.xx - all - entry(0, 0), s.yy - all - entry(1, 1), s.zz - all - entry(2, 2),
            s.xy - entry(0, 1),       s.yz - entry(1, 2),       s.zx - entry(2, 0)};
  }

  /// By the elastic energy of what is taken away: in it neither return takes two stresses apart.
  template <class T>
  KOKKOS_INLINE_FUNCTION T sizeOf(const Traction<T>& x) const
  {
    const Real weight = matrix.elastic.shearModulus / normalModulus();
    return branchFree::squareRoot(T(weight) * x.n * x.n + x.a * x.a + x.b * x.b);
  }
  /// |t| + sn tan(phi) - c.
  template <class T>
  KOKKOS_INLINE_FUNCTION T shearOver(const Traction<T>& t) const
  {
    return branchFree::squareRoot(t.a * t.a + t.b * t.b) + T(friction) * t.n - T(cohesion);
  }

  /// What slip and opening take away from an elastic traction, exactly: slip alone, where it ends
  /// below the cut-off; else the cut-off, and slip down to the corner with it where there is more
  /// shear.
  template <class T>
  KOKKOS_INLINE_FUNCTION Traction<T> takenByPlanes(const Traction<T>& t) const
  {
    using branchFree::choose;
    const Real shearModulus = matrix.elastic.shearModulus, normalModulus = this->normalModulus();
    const T zero(0.0), shear = branchFree::squareRoot(t.a * t.a + t.b * t.b);
    // Taken from the shear traction; dilation takes dilation * normalModulus / shearModulus times
    // that from the other.
    const Real dilating = dilation * normalModulus / shearModulus;
    const T sliding = branchFree::positivePart(shearOver(t) * T(1 / (1 + friction * dilating)));
    const auto below = t.n - T(dilating) * sliding <= T(tensileStrength);
    const Real corner = branchFree::positivePart(cohesion - friction * tensileStrength);
    const T taken = choose(below, sliding, branchFree::positivePart(shear - T(corner)));
    const T share = choose(shear > zero, taken / shear, zero);
    return {choose(below, T(dilating) * sliding, t.n - T(tensileStrength)), share * t.a,
            share * t.b};
  }
};

/// What a user says of a rock with weak planes: of the matrix, and of the planes.
struct UbiquitousJointParameters : MohrCoulombParameters
{
  Vec3 jointNormal{0, 0, 0};     ///< of any length but 0 [-]
  Real jointCohesion = 0;        ///< [Pa]
  Real jointFriction = 0;        ///< tan(phi) [-]
  Real jointDilation = 0;        ///< tan(psi) [-]; at most the joint friction
  Real jointTensileStrength = 0; ///< [Pa]; at most joint cohesion / joint friction

  static MaterialModel model();
};
/// Throws Error(ExitCode::Deck) with what is wrong.
UbiquitousJoints makeLaw(const UbiquitousJointParameters& parameters);
} // namespace coplane
