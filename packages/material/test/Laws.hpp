#pragma once

#include <coplane_material/Material.hpp>

#include <ostream>
#include <string>
#include <vector>

namespace coplane::testing
{
/// A law, and a strain that takes it far from its elastic range.
struct NamedLaw
{
  std::string name;
  Material law;
  Real strain;
};
inline std::ostream& operator<<(std::ostream& out, const NamedLaw& law)
{
  return out << law.name;
}

inline std::vector<NamedLaw> allLaws()
{
  return {{"linearElastic", makeLinearElastic(200e9, 0.3, 7850), 1e-3},
          {"j2Plasticity", makeJ2Plasticity(200e9, 0.3, 7850, 400e6, 1e9), 0.01},
          {"pseudoCap", makePseudoCap(concreteC40()), 0.01}};
}
} // namespace coplane::testing
