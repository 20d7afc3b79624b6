// A program of somebody else, who has installed Coplane: prints the version and a traction of 6.
#include <coplane_contact/ContactEnergy.hpp>
#include <coplane_core/Version.hpp>
#include <coplane_joint/JointLaw.hpp>

#include <cstdio>

int main()
{
  coplane::JointLaw law;
  law.penalty = false;
  law.initialStiffness = 2;
  const coplane::SmoothStep<coplane::Real> one(2.0);
  std::printf("%s %g\n", coplane::version().number.c_str(),
              one.value * law.curve.at(law.fittedTo(1, 1, 1, 1), 3).traction);
}
