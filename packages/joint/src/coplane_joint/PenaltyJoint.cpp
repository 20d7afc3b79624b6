#include "detail/JointKeys.hpp"

namespace coplane
{
JointLaw makeLaw(const PenaltyParameters& p)
{
  JointLaw law = coulombLaw(p);
  law.penalty = true;
  law.stiffnessFraction = p.stiffnessFraction;
  return law;
}

JointModel PenaltyParameters::model()
{
  using P = PenaltyParameters;
  using namespace schema;
  return JointModelOf<P>("penalty", "stiffness from the elements behind the faces")
      .takesStiffnessFromElements()
      .has({
          number("stiffness_fraction", &P::stiffnessFraction)
              .in("-")
              .above(0)
              .like("0.7")
              .means("normal stiffness over 1 / (h1/M1 + h2/M2), with thickness h and "
                     "wave modulus M of the two elements"),
      })
      .has(coulombKeys<P>())
      .has({cohesionKey<P>()})
      .demands(checkCoulomb);
}
} // namespace coplane
