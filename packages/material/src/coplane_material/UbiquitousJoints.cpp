#include <coplane_material/MaterialModel.hpp>
#include <coplane_material/detail/Demand.hpp>

#include <cmath>

namespace coplane
{
void UbiquitousJoints::startFrom(const SymTensor&, Real* history) const
{
  for (int i = 0; i < 3; ++i)
    history[NormalX + i] = normal[i];
}

UbiquitousJoints makeLaw(const UbiquitousJointParameters& p)
{
  const Real length = norm(p.jointNormal);
  demand(length > 0 && std::isfinite(length), "length of the joint normal", length, "",
         "positive; it only gives a direction");
  demand(p.jointCohesion >= 0 && std::isfinite(p.jointCohesion), "joint cohesion", p.jointCohesion,
         "Pa", "0 or more");
  demand(p.jointFriction >= 0 && std::isfinite(p.jointFriction) &&
             p.jointCohesion + p.jointFriction > 0,
         "joint friction", p.jointFriction, "", "0 or more; positive without joint cohesion");
  demand(p.jointDilation >= 0 && p.jointDilation <= p.jointFriction, "joint dilation",
         p.jointDilation, "",
         fmt::format("0 or more, and at most the joint friction ({:.6g})", p.jointFriction));
  const Real tip = p.jointFriction > 0 ? p.jointCohesion / p.jointFriction : infinity;
  demand(p.jointTensileStrength >= 0 && p.jointTensileStrength <= tip &&
             std::isfinite(p.jointTensileStrength),
         "joint tensile strength", p.jointTensileStrength, "Pa",
         fmt::format("0 or more, and at most joint cohesion / joint friction = {:.6g} Pa, the tip "
                     "of the cone",
                     tip));
  return {makeLaw(static_cast<const MohrCoulombParameters&>(p)),
          normalised(p.jointNormal),
          p.jointCohesion,
          p.jointFriction,
          p.jointDilation,
          p.jointTensileStrength};
}

namespace
{
std::string problemInTheFlat(const UbiquitousJointParameters& p, bool revolved)
{
  if (p.jointNormal.z != 0)
    return fmt::format("joint_normal has {} along z; accepted in two dimensions: 0, planes at "
                       "right angles to the mesh",
                       p.jointNormal.z);
  if (revolved && p.jointNormal.x != 0)
    return fmt::format("joint_normal has {} along the radius; accepted in a body of revolution: "
                       "[0, 1, 0], planes across its axis",
                       p.jointNormal.x);
  return "";
}
} // namespace

MaterialModel UbiquitousJointParameters::model()
{
  using P = UbiquitousJointParameters;
  using namespace schema;
  return MaterialModelOf<P>("ubiquitous_joints", "weak planes of one direction in such a matrix")
      .costs(9)
      .has(elasticKeys<P>())
      .has(frictionKeys<P>())
      .has(mohrCoulombKeys<P>())
      .has({
          vector("joint_normal", &P::jointNormal)
              .needed()
              .in("-")
              .notAllZero()
              .like("[0, 1, 0]")
              .means(
                  "normal of the planes at the start, of any length; it turns with the material"),
          number("joint_cohesion", &P::jointCohesion)
              .in("Pa")
              .atLeast(0)
              .like("1e6")
              .means("c of the planes"),
          number("joint_friction", &P::jointFriction)
              .in("-")
              .atLeast(0)
              .like("0.5")
              .means("tangent of the friction angle of the planes"),
          number("joint_dilation", &P::jointDilation)
              .in("-")
              .atLeast(0)
              .like("0.1")
              .means("tangent of the dilation angle of the planes; at most joint_friction"),
          number("joint_tensile_strength", &P::jointTensileStrength)
              .in("Pa")
              .atLeast(0)
              .like("0.2e6")
              .means("cut-off of the traction across the planes; at most joint_cohesion / "
                     "joint_friction"),
      })
      .demands(checkTable)
      .refusesInTheFlat(problemInTheFlat)
      .softensUpTo(elementThatCracks);
}
} // namespace coplane
