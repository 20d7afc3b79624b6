#include <coplane_dynamics/Ledger.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
Real EnergyBalance::scale() const
{
  return std::max({std::abs(initial), std::abs(kinetic), std::abs(internal), std::abs(externalWork),
                   std::abs(eroded), std::abs(contact.work), std::abs(massDamping),
                   std::abs(localDamping), std::abs(kineticDamping)});
}
} // namespace coplane
