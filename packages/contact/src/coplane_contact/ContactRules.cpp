#include <coplane_contact/ContactRules.hpp>

#include <algorithm>

namespace coplane
{
HyperbolicCoulombJoint JointRecipe::fittedTo(Real h0, Real M0, Real h1, Real M1) const
{
  HyperbolicCoulombJoint law;
  law.initialStiffness = penalty ? stiffnessFraction / (h0 / M0 + h1 / M1) : initialStiffness;
  law.inverseMaximumClosure = inverseMaximumClosure;
  if (inverseMaximumClosure > 0)
    law.stiffnessCap = std::max(law.initialStiffness,
                                stiffnessCap ? *stiffnessCap : 0.5 * std::min(M0 / h0, M1 / h1));
  law.shearStiffness = shearStiffness ? *shearStiffness : shearRatio * law.initialStiffness;
  law.friction = friction;
  law.cohesion = cohesion;
  return law;
}
} // namespace coplane
