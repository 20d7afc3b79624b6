#include <coplane_material/MaterialModel.hpp>
#include <coplane_material/detail/Demand.hpp>

#include <cmath>

namespace coplane
{
HoekBrown::Constants hoekBrownConstants(Real intactConstant, Real gsi, Real disturbance)
{
  const Real m = intactConstant * std::exp((gsi - 100) / (28 - 14 * disturbance));
  const Real s = std::exp((gsi - 100) / (9 - 3 * disturbance));
  const Real a = 0.5 + (std::exp(-gsi / 15) - std::exp(-20.0 / 3.0)) / 6;
  return {m, s, a, std::pow(s, a)};
}

HoekBrown makeLaw(const HoekBrownParameters& p)
{
  HoekBrown law{};
  law.elastic = makeLaw(static_cast<const ElasticParameters&>(p));
  demand(p.intactStrength > 0 && std::isfinite(p.intactStrength), "intact strength",
         p.intactStrength, "Pa", "positive, e.g. 50e6");
  demand(p.intactConstant > 0 && std::isfinite(p.intactConstant), "intact constant m_i",
         p.intactConstant, "", "positive, e.g. 10 (4 to 33 for rocks)");
  demand(p.gsi > 0 && p.gsi <= 100, "GSI", p.gsi, "", "above 0 and at most 100");
  demand(p.disturbance >= 0 && p.disturbance <= 1, "disturbance D", p.disturbance, "",
         "0 (as found) to 1 (blasted)");
  const Real residualGsi = p.residualGsi.value_or(p.gsi);
  demand(residualGsi > 0 && residualGsi <= p.gsi, "residual GSI", residualGsi, "",
         fmt::format("above 0 and at most the GSI ({:.6g})", p.gsi));
  if (residualGsi < p.gsi)
    demand(p.shearEnergy > 0 && std::isfinite(p.shearEnergy), "shear energy", p.shearEnergy,
           "J/m^2", "positive where the residual GSI is below the GSI, e.g. 10e3");
  else
    demand(p.shearEnergy == 0, "shear energy", p.shearEnergy, "J/m^2",
           "left out without a residual GSI below the GSI");
  demand(p.fractureEnergy >= 0 && std::isfinite(p.fractureEnergy), "fracture energy",
         p.fractureEnergy, "J/m^2", "0 (no softening) or more");

  law.intactStrength = p.intactStrength;
  law.peak = hoekBrownConstants(p.intactConstant, p.gsi, p.disturbance);
  law.residual = hoekBrownConstants(p.intactConstant, residualGsi, p.disturbance);
  law.shearEnergy = p.shearEnergy;
  law.fractureEnergy = p.fractureEnergy;

  const Real tip = law.tip(law.peak);
  law.tensileStrength = p.tensileStrength.value_or(tip);
  demand(law.tensileStrength >= 0 && law.tensileStrength <= tip && std::isfinite(tip),
         "tensile strength", law.tensileStrength, "Pa",
         fmt::format(
             "0 or more, and at most s sigma_ci / m_b = {:.6g} Pa, the tip of the criterion", tip));
  // N of the plane that touches the criterion in an unconfined test is (sqrt(1 + t^2) + t)^2.
  const Real slope = 1 + law.peak.a * law.peak.m * std::pow(law.peak.s, law.peak.a - 1);
  const Real friction = 0.5 * (slope - 1) / std::sqrt(slope), t = p.dilation;
  demand(t >= 0 && t <= friction, "dilation", t, "",
         fmt::format("0 or more, and at most the friction without confinement ({:.6g})", friction));
  law.dilation = std::pow(std::sqrt(1 + t * t) + t, 2);
  return law;
}

namespace
{
SofteningLimit limit(const HoekBrownParameters& p)
{
  const HoekBrown law = makeLaw(p);
  const Real fall = law.uniaxialStrength(law.peak) - law.uniaxialStrength(law.residual);
  const SofteningLimit cracks = limitOf(p.fractureEnergy, p.youngsModulus, law.tensileStrength,
                                        "fracture_energy", "tensile_strength"),
                       slips = limitOf(p.shearEnergy, p.youngsModulus, fall, "shear_energy",
                                       "the fall to residual_gsi");
  return cracks.size < slips.size ? cracks : slips;
}
} // namespace

MaterialModel HoekBrownParameters::model()
{
  using P = HoekBrownParameters;
  using namespace schema;
  return MaterialModelOf<P>("hoek_brown", "Hoek and Brown's rock mass")
      .costs(4)
      .has(elasticKeys<P>())
      .has({
          number("intact_strength", &P::intactStrength)
              .needed()
              .in("Pa")
              .usually(usual::strength)
              .elsewhere({"sigci", "ucs"})
              .above(0)
              .like("50e6")
              .means("sigma_ci, uniaxial strength of pieces without joints"),
          number("intact_constant", &P::intactConstant)
              .needed()
              .in("-")
              .above(0)
              .like("12")
              .means("m_i, 4 to 33 for rocks"),
          number("gsi", &P::gsi)
              .needed()
              .in("-")
              .above(0)
              .atMost(100)
              .like("50")
              .means("geological strength index of the rock mass"),
          number("disturbance", &P::disturbance)
              .in("-")
              .atLeast(0)
              .atMost(1)
              .like("0.5")
              .means("D: 0 as found, 1 blasted"),
          number("dilation", &P::dilation)
              .in("-")
              .atLeast(0)
              .like("0.1")
              .means("tangent of the dilation angle; flow is never more than normal to the "
                     "criterion"),
          number("tensile_strength", &P::tensileStrength)
              .in("Pa")
              .atLeast(0)
              .defaultIs("the tip of the criterion")
              .like("20e3")
              .means("cut-off of the largest principal stress; at most the tip"),
          number("residual_gsi", &P::residualGsi)
              .in("-")
              .above(0)
              .atMost(100)
              .defaultIs("gsi")
              .like("20")
              .means("geological strength index after much slip; needs shear_energy"),
          number("shear_energy", &P::shearEnergy)
              .in("J/m^2")
              .atLeast(0)
              .like("6e3")
              .means("by which the uniaxial strength falls to the residual one, per area of a slip "
                     "plane"),
          number("fracture_energy", &P::fractureEnergy)
              .in("J/m^2")
              .atLeast(0)
              .like("50")
              .means("by which the cut-off falls, per area of a crack; 0: it stays"),
      })
      .softensUpTo(limit);
}
} // namespace coplane
