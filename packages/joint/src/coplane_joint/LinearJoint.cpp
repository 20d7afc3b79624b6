#include "detail/JointKeys.hpp"

namespace coplane
{
namespace
{
void checkLinear(const LinearParameters& p, const CardPlace& card)
{
  checkCoulomb(p, card);
  checkBending(p, 1, card);
}
} // namespace

JointLaw makeLaw(const LinearParameters& p)
{
  JointLaw law = coulombLaw(p);
  law.initialStiffness = p.normalStiffness;
  if (p.tensileStrength > 0)
  {
    law.bond.kind = Bond::Kind::Brittle;
    law.bond.tensileStrength = p.tensileStrength;
    law.bond.resistsBending = p.resistsBending;
  }
  return law;
}

JointModel LinearParameters::model()
{
  using P = LinearParameters;
  using namespace schema;
  return JointModelOf<P>("linear", "a given stiffness")
      .elsewhere({"coulomb", "mohr_coulomb", "area"})
      .has({
          number("normal_stiffness", &P::normalStiffness)
              .needed()
              .in("Pa/m")
              .usually(usual::stiffness)
              .elsewhere({"kn", "jkn"})
              .above(0)
              .means("traction per closure, and per opening of a bond")
              .like("2e10"),
      })
      .has(coulombKeys<P>())
      .has({
          cohesionKey<P>(),
          number("tensile_strength", &P::tensileStrength)
              .in("Pa")
              .usually(usual::stress)
              .elsewhere({"jten", "ft", "tension"})
              .atLeast(0)
              .like("2e5")
              .means("of a declared joint, until it breaks at once: in tension, or when it slips; "
                     "0: no "
                     "bond"),
          resistsBendingKey<P>(),
      })
      .demands(checkLinear);
}
} // namespace coplane
