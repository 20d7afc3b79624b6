#include <coplane_material/MaterialModel.hpp>
#include <coplane_material/detail/Demand.hpp>

namespace coplane
{
Fluid makeLaw(const IdealGasParameters& p)
{
  const Real density = p.density, ratio = p.heatRatio, pressure = p.pressure;
  demand(density > 0, "density", density, "kg/m^3", "positive");
  demand(ratio > 1, "ratio of specific heats", ratio, "", "above 1, e.g. 1.4");
  demand(pressure > 0, "reference pressure", pressure, "Pa",
         "positive: that of the initial stress of its blocks, from which the first sound speed "
         "comes");
  EquationOfState eos;
  eos.kind = EquationOfState::Kind::IdealGas;
  eos.gamma = ratio;
  return {{density, ratio * pressure, 0}, eos};
}

Fluid makeFluid(Real density, const EquationOfState& eos)
{
  demand(density > 0, "density", density, "kg/m^3", "positive");
  demand(eos.stiffness > 0, "bulk modulus", eos.stiffness, "Pa", "positive");
  return {{density, eos.stiffness / eos.distension, 0}, eos};
}

Fluid makeLaw(const FluidParameters& p)
{
  return makeFluid(p.density, equationOfState(p, p.density, 0));
}

namespace
{
void checkFluid(const FluidParameters& p, const CardPlace& card)
{
  const DeckNode* const given = card.node.find("eos");
  if (p.eos == EquationOfState::Kind::None && given && given->text != "none")
    return; // was reported where it was read
  if (p.eos == EquationOfState::Kind::None)
    card.problem("eos", "is missing; a fluid has nothing else. Accepted: one of linear, "
                        "mie_grueneisen, p_alpha, with sound_speed.");
  else
    checkEquationOfStateAlone(p, card);
}
} // namespace

MaterialModel FluidParameters::model()
{
  using P = FluidParameters;
  return MaterialModelOf<P>("fluid", "an equation of state without strength")
      .has({schema::density<P>()})
      .has(schema::equationOfStateKeys<P>())
      .demands(checkFluid);
}

MaterialModel IdealGasParameters::model()
{
  using P = IdealGasParameters;
  using namespace schema;
  return MaterialModelOf<P>("ideal_gas", "gas")
      .has({
          schema::density<P>(usual::gasDensity),
          number("heat_ratio", &P::heatRatio)
              .needed()
              .in("-")
              .above(1)
              .like("1.4")
              .means("ratio of specific heats"),
          number("pressure", &P::pressure)
              .needed()
              .in("Pa")
              .above(0)
              .like("1e5")
              .means("initial pressure, for the first sound speed; the state itself comes from the "
                     "initial stress of the block"),
      });
}
} // namespace coplane
