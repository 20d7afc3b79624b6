#include <coplane_core/Error.hpp>
#include <coplane_material/MaterialModel.hpp>

#include <fmt/format.h>

namespace coplane
{
using Kind = EquationOfState::Kind;

namespace
{
const std::string& wordOf(Kind kind)
{
  for (const auto& [word, one] : eosWords())
    if (one == kind)
      return word;
  fail(ExitCode::Internal, "an equation of state without a word");
}
} // namespace

const std::vector<std::pair<std::string, Kind>>& eosWords()
{
  static const std::vector<std::pair<std::string, Kind>> words{
      {"none", Kind::None},
      {"linear", Kind::Linear},
      {"mie_grueneisen", Kind::MieGrueneisen},
      {"p_alpha", Kind::PAlpha}};
  return words;
}

EquationOfState equationOfState(const EosParameters& p, Real density, Real bulkModulus)
{
  EquationOfState eos;
  eos.kind = p.eos;
  if (p.eos == Kind::None)
    return eos;
  if (p.eos == Kind::Linear && bulkModulus > 0)
  {
    eos.stiffness = bulkModulus;
    return eos;
  }
  const auto demand = [&](bool good, const char* key, Real value, const char* accepted)
  {
    if (!good)
      fail(ExitCode::Deck, "material: {} is {}, but eos: {} needs {}.", key, value, wordOf(p.eos),
           accepted);
  };
  demand(p.soundSpeed > 0, "sound_speed", p.soundSpeed, "a positive one [m/s]");
  eos.slope = p.shockSlope;
  eos.gamma = p.grueneisen;
  if (p.eos == Kind::PAlpha)
  {
    demand(p.distension > 1, "distension", p.distension, "one above 1");
    demand(p.crushStart > 0, "crush_start", p.crushStart, "a positive one [Pa]");
    demand(p.crushEnd > p.crushStart, "crush_end", p.crushEnd, "one above crush_start");
    eos.distension = p.distension;
    eos.crushStart = p.crushStart;
    eos.crushEnd = p.crushEnd;
  }
  eos.stiffness = density * eos.distension * p.soundSpeed * p.soundSpeed;
  return eos;
}

LinearElastic withPressureOf(const EquationOfState& eos, LinearElastic elastic)
{
  if (eos.kind != Kind::None)
    elastic.bulkModulus = eos.stiffness / eos.distension;
  return elastic;
}

namespace
{
/// @param alone without elastic constants: linear takes the sound speed
void checkKeys(const EosParameters& p, bool alone, const CardPlace& card)
{
  if (p.eos != Kind::MieGrueneisen && p.eos != Kind::PAlpha)
    for (const char* key : {"sound_speed", "shock_slope", "grueneisen"})
      if (card.gives(key) && !(alone && std::string(key) == "sound_speed"))
        card.problem(key, fmt::format("has no effect with eos: {}; remove it or choose "
                                      "mie_grueneisen or p_alpha.",
                                      wordOf(p.eos)));
  if (p.eos != Kind::PAlpha)
    for (const char* key : {"distension", "crush_start", "crush_end"})
      if (card.gives(key))
        card.problem(key, fmt::format("has no effect with eos: {}; remove it or choose p_alpha.",
                                      wordOf(p.eos)));
}
} // namespace

void checkEquationOfState(const EosParameters& p, const CardPlace& card)
{
  checkKeys(p, false, card);
}

void checkEquationOfStateAlone(const EosParameters& p, const CardPlace& card)
{
  checkKeys(p, true, card);
}
} // namespace coplane
