#include <coplane_core/Error.hpp>
#include <coplane_material/Material.hpp>

#include <cmath>
#include <iterator>
#include <type_traits>

namespace coplane
{
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

/// Laws whose history depends on the place say so by startAt().
template <class Law, class = void>
constexpr bool startsAt = false;
template <class Law>
constexpr bool startsAt<Law, std::void_t<decltype(&Law::startAt)>> = true;
} // namespace

std::vector<std::string> historyNames(const Material& material)
{
  return std::visit(
      [](const auto& law)
      {
        using Law = std::decay_t<decltype(law)>;
        std::vector<std::string> names;
        if constexpr (std::is_same_v<Law, MaxwellDamped>)
          names = law.historyNames();
        else
        {
          static_assert(Law::historyCount <= maximumHistory);
          if constexpr (Law::historyCount > 0)
            names.assign(std::begin(Law::historyNames), std::end(Law::historyNames));
        }
        return names;
      },
      material);
}

std::array<Real, maximumHistory> initialHistory(const Material& material, const SymTensor& stress,
                                                const Vec3& place, Real time)
{
  std::array<Real, maximumHistory> history{};
  if (const auto* damped = std::get_if<MaxwellDamped>(&material))
    return initialHistory(damped->held->law, stress, place, time); // no overstress yet
  std::visit(
      [&](const auto& law)
      {
        if constexpr (startsFrom<std::decay_t<decltype(law)>>)
          law.startFrom(stress, history.data());
        if constexpr (startsAt<std::decay_t<decltype(law)>>)
          law.startAt(place, time, history.data());
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
        if constexpr (std::is_same_v<Law, MaxwellDamped>)
          return LawFunction{&law,
                             &advance<Law, Lanes>,
                             &advance<Law, Real>,
                             law.historyCount(),
                             law.inner.usesVolume,
                             true,
                             law.inner.hasStrength};
        else
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
        else if constexpr (std::is_same_v<std::decay_t<decltype(law)>, UbiquitousJoints>)
          return law.matrix.elastic;
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
