#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_material/Material.hpp>
#include <coplane_schema/CardModel.hpp>

#include <functional>
#include <string>
#include <vector>

namespace coplane
{
/// The largest element that can follow the softening of a material.
struct SofteningLimit
{
  Real size = infinity;      ///< [m]
  std::string energy = "";   ///< the key of the energy that softening takes
  std::string strength = ""; ///< what falls
};

/// A model that cards in `materials` may name, and what other parts ask of it.
struct MaterialModel : CardModel<Material>
{
  Real cost = 1;    ///< time of an element's update over that with linear_elastic
  std::string sets; ///< of the library: YAML, cards by their names; sources in the manual
  /// What is wrong with the parameters in two dimensions, plane or revolved; empty: never anything.
  std::function<std::string(const void* parameters, bool revolved)> problemInTheFlat;
  std::function<SofteningLimit(const void* parameters)> softening; ///< empty: does not soften
};

/// Every model, in the order of the manual.
const std::vector<MaterialModel>& materialModels();

/// A model under construction (CardModelBuilder), with the words of materials.
template <class P>
class MaterialModelOf : public CardModelBuilder<MaterialModelOf<P>, MaterialModel, P>
{
public:
  using CardModelBuilder<MaterialModelOf<P>, MaterialModel, P>::CardModelBuilder;

  MaterialModelOf& costs(Real factor)
  {
    this->model_.cost = factor;
    return *this;
  }
  MaterialModelOf& comesAs(const std::string& sets)
  {
    this->model_.sets = sets;
    return *this;
  }
  MaterialModelOf& refusesInTheFlat(std::string (*problem)(const P&, bool revolved))
  {
    this->model_.problemInTheFlat = [problem](const void* parameters, bool revolved)
    { return problem(*static_cast<const P*>(parameters), revolved); };
    return *this;
  }
  MaterialModelOf& softensUpTo(SofteningLimit (*limit)(const P&))
  {
    this->model_.softening = [limit](const void* parameters)
    { return limit(*static_cast<const P*>(parameters)); };
    return *this;
  }
};

namespace schema
{
// Keys that several laws have. P has to have the members.

template <class P>
Key density(const UsualRange& range = usual::density)
{
  return number<P, Real>("density", &P::density)
      .needed()
      .in("kg/m^3")
      .usually(range)
      .elsewhere({"rho", "ro", "dens", "mass_density"})
      .above(0)
      .like("7850")
      .means("mass per reference volume");
}

/// Of P, a struct with the members of ElasticParameters.
template <class P>
std::vector<Key> elasticKeys()
{
  return {
      density<P>(),
      number<P, Real>("youngs_modulus", &P::youngsModulus)
          .needed()
          .in("Pa")
          .usually(usual::modulus)
          .elsewhere({"E", "young", "elastic_modulus", "modulus", "Emod"})
          .above(0)
          .like("210e9")
          .means("Young's modulus"),
      number<P, Real>("poisson_ratio", &P::poissonRatio)
          .needed()
          .in("-")
          .usually(usual::poisson)
          .elsewhere({"nu", "pr", "poisson", "poissons_ratio"})
          .above(-1)
          .below(0.5)
          .like("0.3")
          .means("Poisson's ratio"),
  };
}

/// Of P, a struct with the members of EosParameters.
template <class P>
std::vector<Key> equationOfStateKeys()
{
  using Kind = EquationOfState::Kind;
  return {
      choice<P, Kind>("eos", &P::eos, eosWords())
          .like("linear")
          .means("equation of state for the pressure: rate form with the elastic bulk modulus; "
                 "linear in density; about the shock line; the same with pores that close"),
      number<P, Real>("sound_speed", &P::soundSpeed)
          .in("m/s")
          .atLeast(0)
          .like("4570")
          .means("c0 of the shock speed c0 + s up of the solid"),
      number<P, Real>("shock_slope", &P::shockSlope)
          .in("-")
          .atLeast(0)
          .like("1.49")
          .means("s of the shock speed"),
      number<P, Real>("grueneisen", &P::grueneisen)
          .in("-")
          .atLeast(0)
          .like("1.93")
          .means("Grueneisen's Gamma at the reference density"),
      number<P, Real>("distension", &P::distension)
          .in("-")
          .atLeast(1)
          .like("1.5")
          .means("p_alpha: density of the solid over that of the porous material"),
      number<P, Real>("crush_start", &P::crushStart)
          .in("Pa")
          .atLeast(0)
          .like("0.2e9")
          .means("p_alpha: pressure from which pores close"),
      number<P, Real>("crush_end", &P::crushEnd)
          .in("Pa")
          .atLeast(0)
          .like("2e9")
          .means("p_alpha: pressure at which none is left"),
  };
}

/// Of P, a struct with cohesion, friction and dilation.
template <class P>
std::vector<Key> frictionKeys()
{
  return {
      number<P, Real>("cohesion", &P::cohesion)
          .in("Pa")
          .usually(usual::strength)
          .elsewhere({"c", "coh"})
          .atLeast(0)
          .like("5e6")
          .means("c"),
      number<P, Real>("friction", &P::friction)
          .in("-")
          .usually(usual::friction)
          .elsewhere({"phi", "friction_angle", "fric", "mu"})
          .atLeast(0)
          .like("0.6")
          .means("tangent of the friction angle"),
      number<P, Real>("dilation", &P::dilation)
          .in("-")
          .usually(usual::friction)
          .elsewhere({"psi", "dilation_angle", "dil"})
          .atLeast(0)
          .like("0.2")
          .means("tangent of the dilation angle; at most friction"),
  };
}

/// What Mohr and Coulomb's law has beside them: of P, derived from MohrCoulombParameters.
template <class P>
std::vector<Key> mohrCoulombKeys()
{
  return {
      number<P, Real>("residual_cohesion", &P::residualCohesion)
          .in("Pa")
          .atLeast(0)
          .like("1e6")
          .means("c after much slip, when shear_energy is given"),
      number<P, Real>("tensile_strength", &P::tensileStrength)
          .in("Pa")
          .usually(usual::strength)
          .elsewhere({"ft", "tension", "ten", "tensile"})
          .atLeast(0)
          .like("2e6")
          .means("cut-off of the largest principal stress; at most cohesion / friction"),
      number<P, Real>("shear_energy", &P::shearEnergy)
          .in("J/m^2")
          .atLeast(0)
          .like("500")
          .means("by which cohesion falls, per area of a slip plane; 0: it stays"),
      number<P, Real>("fracture_energy", &P::fractureEnergy)
          .in("J/m^2")
          .usually(usual::fractureEnergy)
          .elsewhere({"gf"})
          .atLeast(0)
          .like("100")
          .means("by which tensile strength falls, per area of a crack; 0: it stays"),
      numbers<P, std::vector<Real>>("plastic_shears", &P::plasticShears)
          .in("-")
          .atLeast(0)
          .like("[0, 0.02]")
          .means("plastic shears of a table of cohesion and friction, rising from 0; 2 to 8; "
                 "the last values stay beyond it. The softening depends on the size of "
                 "elements"),
      numbers<P, std::vector<Real>>("cohesions", &P::cohesions)
          .in("Pa")
          .atLeast(0)
          .like("[5e6, 1e6]")
          .means("c at plastic_shears"),
      numbers<P, std::vector<Real>>("frictions", &P::frictions)
          .in("-")
          .atLeast(0)
          .like("[0.7, 0.5]")
          .means("tangents of the friction angle at plastic_shears; not below dilation"),
  };
}
} // namespace schema

/// The table of cohesion and friction beside the keys that it replaces.
void checkTable(const MohrCoulombParameters& parameters, const CardPlace& place);

/// G E / (fall of strength)^2: larger elements would have to spring back while they soften.
inline SofteningLimit limitOf(Real energy, Real youngsModulus, Real fall, const char* energyKey,
                              const char* strengthKey)
{
  return {energy > 0 && fall > 0 ? energy * youngsModulus / (fall * fall) : infinity, energyKey,
          strengthKey};
}

/// Of a P that cracks with a fracture energy.
template <class P>
SofteningLimit elementThatCracks(const P& p)
{
  return limitOf(p.fractureEnergy, p.youngsModulus, p.tensileStrength, "fracture_energy",
                 "tensile_strength");
}

/// The elastic constants with the bulk modulus of the equation of state, if there is one.
LinearElastic withPressureOf(const EquationOfState& eos, LinearElastic elastic);

/// Keys that have no effect with this equation of state: beside elastic constants, and alone.
void checkEquationOfState(const EosParameters& parameters, const CardPlace& place);
void checkEquationOfStateAlone(const EosParameters& parameters, const CardPlace& place);
} // namespace coplane
