#include "detail/JointKeys.hpp"

#include <cmath>

namespace coplane
{
namespace
{
bool estimated(const BartonBandisParameters& p)
{
  return p.initialStiffness <= 0 || p.maximumClosure <= 0;
}

BandisEstimate estimateOf(const BartonBandisParameters& p)
{
  return bandisEstimate(p.roughness, p.wallStrength, p.rockStrength.value_or(p.wallStrength));
}

void checkBartonBandis(const BartonBandisParameters& p, const CardPlace& card)
{
  checkCap(p.stiffnessCap, "initial_stiffness", p.initialStiffness, card);
  if (!estimated(p) || p.roughness <= 0 || p.wallStrength <= 0)
    return;
  const BandisEstimate e = estimateOf(p);
  const bool k = p.initialStiffness > 0 || e.initialStiffness > 0;
  const bool c = p.maximumClosure > 0 || e.maximumClosure > 0;
  if (!(e.aperture > 0) || !k || !c)
    card.problem("roughness",
                 fmt::format("= {}, wall_strength = {} Pa and rock_strength = {} Pa are outside of "
                             "the range of Bandis' estimates (initial stiffness {:.4g} Pa/m, "
                             "maximum closure {:.4g} m); give initial_stiffness and "
                             "maximum_closure.",
                             p.roughness, p.wallStrength, p.rockStrength.value_or(p.wallStrength),
                             e.initialStiffness, e.maximumClosure));
}
} // namespace

JointLaw makeLaw(const BartonBandisParameters& p)
{
  JointLaw law = shearLaw(p);
  Real initialStiffness = p.initialStiffness, maximumClosure = p.maximumClosure;
  if (estimated(p))
  {
    const BandisEstimate estimate = estimateOf(p);
    if (initialStiffness <= 0)
      initialStiffness = estimate.initialStiffness;
    if (maximumClosure <= 0)
      maximumClosure = estimate.maximumClosure;
  }
  law.initialStiffness = initialStiffness;
  law.curve.inverseMaximumClosure = maximumClosure > 0 ? 1 / maximumClosure : 0;
  law.stiffnessCap = p.stiffnessCap.value_or(0);
  law.dilationSlip = p.dilationSlip.value_or(infinity);
  law.strength = JointLaw::Strength::BartonBandis;
  law.rough = {p.roughness, p.wallStrength, std::atan(p.residualFriction), p.peakSlip};
  return law;
}

JointModel BartonBandisParameters::model()
{
  using P = BartonBandisParameters;
  using namespace schema;
  return JointModelOf<P>("barton_bandis", "a rough rock joint")
      .elsewhere({"barton"})
      .has({
          number("initial_stiffness", &P::initialStiffness)
              .in("Pa/m")
              .usually(usual::stiffness)
              .elsewhere({"kn", "jkn", "kni"})
              .above(0)
              .like("2e10")
              .defaultIs("Bandis' estimate from roughness, wall_strength and rock_strength")
              .means("slope of the closure curve at zero closure"),
          number("maximum_closure", &P::maximumClosure)
              .in("m")
              .above(0)
              .like("5e-4")
              .defaultIs("Bandis' estimate from roughness, wall_strength and rock_strength")
              .means("asymptote of the hyperbola"),
          stiffnessCapKey<P>(),
      })
      .has(shearStiffnessKeys<P>())
      .has({
          dilationSlipKey<P>(),
          number("roughness", &P::roughness)
              .needed()
              .in("-")
              .elsewhere({"jrc"})
              .above(0)
              .atMost(20)
              .like("10")
              .means("joint roughness coefficient JRC"),
          number("wall_strength", &P::wallStrength)
              .needed()
              .in("Pa")
              .usually(usual::strength)
              .elsewhere({"jcs"})
              .above(0)
              .like("80e6")
              .means("joint wall compressive strength JCS"),
          number("rock_strength", &P::rockStrength)
              .in("Pa")
              .above(0)
              .like("120e6")
              .defaultIs("wall_strength")
              .means(
                  "uniaxial compressive strength of the rock, for Bandis' estimate of the closure "
                  "curve"),
          number("residual_friction", &P::residualFriction)
              .needed()
              .in("-")
              .usually(usual::friction)
              .above(0)
              .below(2.7)
              .like("0.577")
              .means("tangent of the residual friction angle"),
          number("peak_slip", &P::peakSlip)
              .needed()
              .in("m")
              .above(0)
              .like("5e-3")
              .means("slip at which the roughness is mobilised; about a hundredth of a block's "
                     "length"),
      })
      .demands(checkBartonBandis);
}
} // namespace coplane
