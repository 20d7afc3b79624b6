#include <coplane_core/Error.hpp>
#include <coplane_core/Rotate.hpp>
#include <coplane_material/Invariants.hpp>
#include <coplane_material/MaterialProbe.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace coplane
{
namespace
{
std::array<Real, 6> componentsOf(const SymTensor& s)
{
  return {s.xx, s.yy, s.zz, s.xy, s.yz, s.zx};
}

Mat3 gradientOf(const std::array<Real, 6>& e)
{
  return {{{e[0], e[3], e[5]}, {e[3], e[1], e[4]}, {e[5], e[4], e[2]}}};
}

Mat3 identityPlus(Real factor, const Mat3& l)
{
  Mat3 r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r(i, j) = (i == j ? 1.0 : 0.0) + factor * l(i, j);
  return r;
}

/// Solves a x = b for n unknowns by elimination with pivots; false when a is singular.
bool solve(int n, Real (&a)[6][6], Real (&b)[6])
{
  for (int k = 0; k < n; ++k)
  {
    int pivot = k;
    for (int i = k + 1; i < n; ++i)
      if (std::abs(a[i][k]) > std::abs(a[pivot][k]))
        pivot = i;
    if (!(std::abs(a[pivot][k]) > 0))
      return false;
    std::swap(a[pivot], a[k]);
    std::swap(b[pivot], b[k]);
    for (int i = k + 1; i < n; ++i)
    {
      const Real f = a[i][k] / a[k][k];
      for (int j = k; j < n; ++j)
        a[i][j] -= f * a[k][j];
      b[i] -= f * b[k];
    }
  }
  for (int k = n - 1; k >= 0; --k)
  {
    for (int j = k + 1; j < n; ++j)
      b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return true;
}
} // namespace

MaterialProbe::MaterialProbe(const Material& material, Real size, const SymTensor& start)
    : material_(material), names_(historyNames(material)), size_(size), stress_(start),
      history_(initialHistory(material, start))
{
}

void MaterialProbe::advance(const Mat3& l, Real dt)
{
  const Mat3 whole = inverse(identityPlus(-0.5, l)) * identityPlus(0.5, l);
  const Real next = volumeRatio_ * determinant(whole);
  // Positions in the middle of the step are the mean of those at its ends: (I - l/2)^-1.
  const Real half = volumeRatio_ / determinant(identityPlus(-0.5, l));
  const auto mean = [&](int i, int j) { return 0.5 * (l(i, j) + l(j, i)); };
  MaterialPoint<Real> point;
  point.dt = dt;
  const SymTensor de = {l(0, 0), l(1, 1), l(2, 2), mean(0, 1), mean(1, 2), mean(2, 0)};
  point.displacementGradient = l;
  Mat3 spin;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      spin(i, j) = 0.5 * (l(i, j) - l(j, i));
  point.rotation = inverse(identityPlus(-0.5, spin)) * identityPlus(0.5, spin);
  point.strainIncrement = turnedToEnd(de, point.rotation);
  point.volumeRatio = next;
  point.halfVolumeRatio = half;
  point.energy = energy_;
  point.size = size_;
  point.oldStress = stress_;
  point.stress = rotated(stress_, point.rotation);
  std::copy(history_.begin(), history_.end(), point.history);
  lawFunction(material_)(point);
  std::copy(point.history, point.history + maximumHistory, history_.begin());
  energy_ += 0.5 * half * (contract(stress_, de) + contract(point.stress, de));
  dissipation_ += half * point.dissipation;
  stress_ = point.stress;
  strain_ = sumOf(strain_, 1.0, de);
  stiffening_ = point.stiffening;
  volumeRatio_ = next;
  time_ += dt;
}

/// The strain increments that are sought for a step, and how far they are from what is asked.
struct MaterialProbe::Search
{
  Search(const MaterialProbe& from, const ProbeStep& asked)
      : start(from), step(asked), increment(asked.value), modulus(pWaveModulus(from.material_)),
        trial(from)
  {
    for (int k = 0; k < 6; ++k)
      if (step.stressGiven[k])
      {
        increment[k] = from.lastIncrement_[k];
        unknown[unknowns++] = k;
      }
      else
        most = std::max(most, 20 * std::abs(step.value[k]));
    look();
    if (std::isfinite(worst))
      return;
    for (int i = 0; i < unknowns; ++i)
      increment[unknown[i]] = 0;
    look();
  }

  MaterialProbe after(const std::array<Real, 6>& de) const
  {
    MaterialProbe probe = start;
    probe.advance(gradientOf(de), step.dt);
    return probe;
  }

  /// The trial with the present increment, and what is missing.
  void look()
  {
    trial = after(increment);
    const auto s = componentsOf(trial.stress_);
    worst = 0;
    for (int i = 0; i < unknowns; ++i)
    {
      residual[i] = step.value[unknown[i]] - s[unknown[i]];
      worst = std::max(worst, std::abs(residual[i]));
    }
    for (const Real each : s)
      if (!std::isfinite(each)) // no number
        worst = std::numeric_limits<Real>::infinity();
    for (int i = 0; i < unknowns; ++i)
      if (std::abs(increment[unknown[i]]) > most) // another answer than the nearest
        worst = std::numeric_limits<Real>::infinity();
  }

  void moveFrom(const std::array<Real, 6>& from, const Real (&move)[6], Real part)
  {
    increment = from;
    for (int i = 0; i < unknowns; ++i)
      increment[unknown[i]] += part * move[i];
    look();
  }

  /// Newton's move, with the elastic modulus where the law has no slope.
  void newton(Real (&move)[6]) const
  {
    // Small enough to stay on one branch of the law, large enough for its digits.
    const Real h = std::max(1e-10, 1e-3 * worst / modulus);
    Real jacobian[6][6];
    for (int j = 0; j < unknowns; ++j)
    {
      std::array<Real, 6> nudged = increment;
      const Real sign = residual[j] > 0 ? 1 : -1;
      nudged[unknown[j]] += sign * h;
      const auto s = componentsOf(after(nudged).stress_), s0 = componentsOf(trial.stress_);
      for (int i = 0; i < unknowns; ++i)
        jacobian[i][j] = (s[unknown[i]] - s0[unknown[i]]) / (sign * h);
    }
    std::copy(residual, residual + 6, move);
    if (!solve(unknowns, jacobian, move))
      for (int i = 0; i < unknowns; ++i)
        move[i] = residual[i] / modulus;
  }

  /// One iteration: shorter moves until one is better.
  void improve()
  {
    Real move[6], creep[6];
    newton(move);
    for (int i = 0; i < unknowns; ++i)
      creep[i] = residual[i] / modulus;
    const std::array<Real, 6> from = increment;
    const Real before = worst;
    Real part = 1;
    for (int cut = 0; cut < 12; ++cut, part *= 0.5)
    {
      moveFrom(from, move, part);
      if (worst < before)
        return;
    }
    // At a kink of the law no direction of Newton's helps: creep with the elastic modulus, which
    // is stiffer than any answer.
    moveFrom(from, creep, 1);
  }

  const MaterialProbe& start;
  const ProbeStep& step;
  std::array<Real, 6> increment;
  Real modulus, most = 0.02; // most: of the strain increments that are looked at
  int unknown[6], unknowns = 0;
  MaterialProbe trial;
  Real residual[6] = {};
  Real worst = 0;
};

Real MaterialProbe::tryStep(const ProbeStep& step)
{
  Search search(*this, step);
  const auto goodEnough = [&]
  { return search.worst <= 1e-9 * (vonMises() + std::abs(pressure())) + 1e-13 * search.modulus; };
  for (int iteration = 0; iteration < 1000 && std::isfinite(search.worst) && !goodEnough();
       ++iteration)
    search.improve();
  if (!(search.worst <= 1e-5 * (vonMises() + std::abs(pressure())) + 1e-9 * search.modulus))
    return search.worst;
  *this = search.trial;
  lastIncrement_ = search.increment;
  return 0;
}

void MaterialProbe::advance(const ProbeStep& step)
{
  // What one step does not reach, some smaller ones may: behind a crack that closes, or a peak.
  constexpr int mostParts = 64;
  const auto from = componentsOf(stress_);
  const Real end = time_ + step.dt;
  Real off = 0;
  for (int parts = 1; parts <= mostParts; parts *= 4)
  {
    MaterialProbe probe = *this;
    ProbeStep part = step;
    part.dt = step.dt / parts;
    off = 0;
    for (int i = 1; i <= parts && off == 0; ++i)
    {
      for (int k = 0; k < 6; ++k)
        if (!step.stressGiven[k])
          part.value[k] = step.value[k] / parts;
        else if (i < parts)
          part.value[k] = from[k] + (step.value[k] - from[k]) * i / parts;
        else
          part.value[k] = step.value[k];
      off = probe.tryStep(part);
    }
    if (off == 0)
    {
      *this = probe;
      return;
    }
  }
  const std::string lack =
      std::isfinite(off) ? fmt::format("off by {:.3g} Pa", off) : "none near is a number";
  fail(
      ExitCode::Computation,
      "no strain increment gives the stresses asked for at t = {} s, in up to {} parts of the step "
      "({}). The material cannot bear them, or the step is too large: take more steps.",
      end, mostParts, lack);
}

Real MaterialProbe::pressure() const
{
  return -meanOf(stress_);
}

Real MaterialProbe::vonMises() const
{
  return vonMisesOf(deviatorOf(stress_));
}

Real MaterialProbe::history(const std::string& name) const
{
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end())
    fail(ExitCode::Internal, "material probe: the law has no variable '{}'", name);
  return history_[std::size_t(found - names_.begin())];
}
} // namespace coplane
