#include <coplane_core/Error.hpp>
#include <coplane_material/Material.hpp>

#include <cmath>
#include <iterator>
#include <type_traits>

namespace coplane
{
LinearElastic makeLinearElastic(Real youngsModulus, Real poissonRatio, Real density)
{
  if (!(youngsModulus > 0) || !std::isfinite(youngsModulus))
    fail(ExitCode::Deck,
         "material: Young's modulus is {} Pa, but must be positive. Give E in pascals, e.g. 200e9.",
         youngsModulus);
  if (!(poissonRatio > -1 && poissonRatio < 0.5))
    fail(ExitCode::Deck,
         "material: Poisson's ratio is {}, but must lie between -1 and 0.5 (0.5 would be "
         "incompressible). Use 0.49 at most for nearly incompressible solids.",
         poissonRatio);
  if (!(density > 0) || !std::isfinite(density))
    fail(ExitCode::Deck,
         "material: density is {} kg/m^3, but must be positive. Give it in SI units, e.g. 7850.",
         density);
  return {density, youngsModulus / (3 * (1 - 2 * poissonRatio)),
          youngsModulus / (2 * (1 + poissonRatio))};
}

J2Plasticity makeJ2Plasticity(Real youngsModulus, Real poissonRatio, Real density, Real yieldStress,
                              Real hardeningModulus)
{
  if (!(yieldStress > 0))
    fail(ExitCode::Deck,
         "material: yield stress is {} Pa, but must be positive. Use the model linear_elastic for "
         "a material that does not yield.",
         yieldStress);
  if (!(hardeningModulus >= 0) || !std::isfinite(hardeningModulus))
    fail(ExitCode::Deck,
         "material: hardening modulus is {} Pa, but must not be negative. Softening depends on the "
         "mesh and is not offered; use 0 for perfect plasticity.",
         hardeningModulus);
  return {makeLinearElastic(youngsModulus, poissonRatio, density), yieldStress, hardeningModulus};
}

namespace
{
template <class Law, class T>
void advance(const void* law, MaterialPoint<T>& point)
{
  (*static_cast<const Law*>(law))(point);
}

/// Laws whose history does not start from zeros, or that have to know of an initial stress, say so
/// by startFrom().
template <class Law, class = void>
constexpr bool startsFrom = false;
template <class Law>
constexpr bool startsFrom<Law, std::void_t<decltype(&Law::startFrom)>> = true;
} // namespace

std::vector<std::string> historyNames(const Material& material)
{
  return std::visit(
      [](const auto& law)
      {
        using Law = std::decay_t<decltype(law)>;
        static_assert(Law::historyCount <= maximumHistory);
        std::vector<std::string> names;
        if constexpr (Law::historyCount > 0)
          names.assign(std::begin(Law::historyNames), std::end(Law::historyNames));
        return names;
      },
      material);
}

std::array<Real, maximumHistory> initialHistory(const Material& material, const SymTensor& stress)
{
  std::array<Real, maximumHistory> history{};
  std::visit(
      [&](const auto& law)
      {
        if constexpr (startsFrom<std::decay_t<decltype(law)>>)
          law.startFrom(stress, history.data());
      },
      material);
  return history;
}

LawFunction lawFunction(const Material& material)
{
  return std::visit(
      [](const auto& law)
      {
        using Law = std::decay_t<decltype(law)>;
        return LawFunction{&law,
                           &advance<Law, Lanes>,
                           &advance<Law, Real>,
                           Law::historyCount,
                           Law::usesVolume,
                           Law::changesTangent,
                           Law::hasStrength};
      },
      material);
}

const LinearElastic& elasticity(const Material& material)
{
  return std::visit(
      [](const auto& law) -> const LinearElastic&
      {
        if constexpr (std::is_same_v<std::decay_t<decltype(law)>, LinearElastic>)
          return law;
        else
          return law.elastic;
      },
      material);
}

Real soundSpeed(const Material& material)
{
  return std::sqrt(pWaveModulus(material) / density(material));
}
} // namespace coplane
