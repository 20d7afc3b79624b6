#include <coplane_core/Error.hpp>
#include <coplane_material/Material.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
constexpr int samples = 81, trials = 200; // frequencies; widths of the row of elements
constexpr Real widest = 1.5;              // width of the row over that of the band, as logarithms

using Row = std::array<Real, MaxwellElements::most>;

/// Shares for which loss - 2 ratio (storage - 1) is nearest to 2 ratio at the frequencies: linear
/// in them. Normal equations, by elimination with pivots on the diagonal (positive definite).
bool findShares(Real ratio, const std::vector<Real>& frequencies, MaxwellElements& elements)
{
  const int n = elements.count;
  std::array<Row, MaxwellElements::most> matrix{};
  Row right{};
  for (const Real frequency : frequencies)
  {
    Row row{};
    for (int k = 0; k < n; ++k)
    {
      const Real x = 2 * pi * frequency * elements.time[std::size_t(k)];
      row[std::size_t(k)] = (x - 2 * ratio * x * x) / (1 + x * x);
    }
    for (int i = 0; i < n; ++i)
    {
      right[std::size_t(i)] += 2 * ratio * row[std::size_t(i)];
      for (int j = 0; j < n; ++j)
        matrix[std::size_t(i)][std::size_t(j)] += row[std::size_t(i)] * row[std::size_t(j)];
    }
  }
  for (int i = 0; i < n; ++i)
  {
    const Real pivot = matrix[std::size_t(i)][std::size_t(i)];
    if (!(pivot > 0))
      return false;
    for (int r = i + 1; r < n; ++r)
    {
      const Real factor = matrix[std::size_t(r)][std::size_t(i)] / pivot;
      for (int c = i; c < n; ++c)
        matrix[std::size_t(r)][std::size_t(c)] -= factor * matrix[std::size_t(i)][std::size_t(c)];
      right[std::size_t(r)] -= factor * right[std::size_t(i)];
    }
  }
  for (int i = n - 1; i >= 0; --i)
  {
    Real sum = right[std::size_t(i)];
    for (int c = i + 1; c < n; ++c)
      sum -= matrix[std::size_t(i)][std::size_t(c)] * elements.share[std::size_t(c)];
    elements.share[std::size_t(i)] = sum / matrix[std::size_t(i)][std::size_t(i)];
    if (!(elements.share[std::size_t(i)] > 0))
      return false;
  }
  return true;
}
} // namespace

Real MaxwellElements::added() const
{
  Real sum = 0;
  for (int k = 0; k < count; ++k)
    sum += share[std::size_t(k)];
  return sum;
}

Real MaxwellElements::storage(Real frequency) const
{
  Real sum = 1;
  for (int k = 0; k < count; ++k)
  {
    const Real x = 2 * pi * frequency * time[std::size_t(k)];
    sum += share[std::size_t(k)] * x * x / (1 + x * x);
  }
  return sum;
}

Real MaxwellElements::loss(Real frequency) const
{
  Real sum = 0;
  for (int k = 0; k < count; ++k)
  {
    const Real x = 2 * pi * frequency * time[std::size_t(k)];
    sum += share[std::size_t(k)] * x / (1 + x * x);
  }
  return sum;
}

MaxwellFit fitMaxwell(Real ratio, Real low, Real high, int count)
{
  if (!(ratio > 0) || !(low > 0) || !(high > low) || count < 1 || count > MaxwellElements::most)
    fail(ExitCode::Internal, "Maxwell elements: {} of ratio {} from {} to {} Hz", count, ratio, low,
         high);
  std::vector<Real> frequencies;
  for (int i = 0; i < samples; ++i)
    frequencies.push_back(low * std::pow(high / low, i / Real(samples - 1)));
  MaxwellFit best;
  Real least = infinity;
  const int widths = count == 1 ? 1 : trials;
  for (int trial = 1; trial <= widths; ++trial)
  {
    MaxwellFit fit;
    fit.elements.count = count;
    for (int k = 0; k < count; ++k)
    {
      const Real place = count == 1 ? 0 : k / Real(count - 1) - 0.5;
      const Real width = widest * trial / widths;
      fit.elements.time[std::size_t(k)] =
          1 / (2 * pi * std::sqrt(low * high) * std::pow(high / low, place * width));
    }
    if (!findShares(ratio, frequencies, fit.elements))
      continue;
    fit.least = infinity;
    for (const Real frequency : frequencies)
    {
      fit.least = std::min(fit.least, fit.elements.ratio(frequency));
      fit.largest = std::max(fit.largest, fit.elements.ratio(frequency));
    }
    const Real off = std::max(ratio - fit.least, fit.largest - ratio);
    if (off < least)
    {
      least = off;
      best = fit;
    }
  }
  if (best.elements.count == 0)
    fail(ExitCode::Deck,
         "{} Maxwell elements give no ratio of {} from {} to {} Hz; accepted: smaller ratios, "
         "narrower bands.",
         count, ratio, low, high);
  return best;
}

std::vector<std::string> MaxwellDamped::historyNames() const
{
  std::vector<std::string> names = coplane::historyNames(held->law);
  for (int k = 1; k <= elements.count; ++k)
    for (const char* component : {"xx", "yy", "zz", "xy", "yz", "zx"})
      names.push_back("maxwell_" + std::to_string(k) + "_" + component);
  names.emplace_back("maxwell_dissipation");
  return names;
}

Material withMaxwell(const Material& law, const MaxwellElements& elements, bool volumetric)
{
  MaxwellDamped damped;
  damped.held = std::make_shared<const HeldMaterial>(HeldMaterial{law});
  damped.inner = lawFunction(damped.held->law);
  damped.elastic = elasticity(law);
  damped.elements = elements;
  damped.volumetric = volumetric;
  if (!(damped.elastic.shearModulus > 0))
    fail(ExitCode::Deck, "its material has no shear modulus; accepted: materials with one.");
  if (damped.historyCount() > maximumHistory)
    fail(ExitCode::Deck, "its material has too many variables for {} elements; accepted: {}.",
         elements.count, (maximumHistory - 1 - damped.inner.historyCount) / MaxwellDamped::rows);
  return damped;
}
} // namespace coplane
