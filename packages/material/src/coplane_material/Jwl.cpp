#include <coplane_material/MaterialModel.hpp>
#include <coplane_material/detail/Demand.hpp>

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace coplane
{
Real Jwl::timeToBurn(const Vec3& place, Real time) const
{
  Real earliest = points > 0 ? infinity : 0;
  for (int i = 0; i < points; ++i)
  {
    const Real wait = time > 0 ? std::max(delay[i] - time, 0.0) : delay[i];
    earliest = std::min(earliest, norm(place - point[i]) / speed + wait);
  }
  return earliest;
}

DetonationState detonationState(const Jwl& law)
{
  // On the curve of Hugoniot E = E0 + p (1 - V) / 2, so p = (a + b E0) / (1 - b (1 - V) / 2); the
  // line of Rayleigh that touches it is the least p / (1 - V).
  const auto pressure = [&](Real volume)
  {
    const Jwl::Products<Real> p = law.productsAt(volume);
    return (p.a + p.b * law.energy) / (1 - 0.5 * p.b * (1 - volume));
  };
  const auto slope = [&](Real volume) { return pressure(volume) / (1 - volume); };
  Real low = 0.5, high = 0.99;
  while (high - low > 1e-9)
  {
    const Real left = (2 * low + high) / 3, right = (low + 2 * high) / 3;
    if (slope(left) < slope(right))
      high = right;
    else
      low = left;
  }
  const Real volume = 0.5 * (low + high);
  return {volume, pressure(volume), std::sqrt(slope(volume) / law.elastic.density)};
}

namespace
{
/// The front is led at the speed of the card, behind it stands what the products make of it: they
/// have to belong together.
void checkDetonation(const Jwl& law, const JwlParameters& p)
{
  const DetonationState own = detonationState(law);
  demand(std::abs(own.speed - p.detonationSpeed) < 0.05 * own.speed, "detonation speed",
         p.detonationSpeed, "m/s",
         fmt::format("within 5 % of {:.5g} m/s, the speed at which products with these jwl_a to "
                     "jwl_r2, omega, detonation_energy and density detonate",
                     own.speed));
  demand(
      std::abs(own.pressure - p.detonationPressure) < 0.15 * own.pressure, "detonation pressure",
      p.detonationPressure, "Pa",
      fmt::format("within 15 % of {:.5g} Pa, that of products with these jwl_a to jwl_r2, omega, "
                  "detonation_energy and density",
                  own.pressure));
}

void demandConstants(const JwlParameters& p)
{
  demand(p.density > 0, "density", p.density, "kg/m^3", "positive");
  demand(p.a > 0, "A", p.a, "Pa", "positive");
  demand(p.b >= 0, "B", p.b, "Pa", "0 or more");
  demand(p.r2 > 0, "R2", p.r2, "", "positive");
  demand(p.r1 > p.r2, "R1", p.r1, "", fmt::format("above R2 ({:.6g})", p.r2));
  demand(p.omega > 0 && p.omega < 2, "omega", p.omega, "", "positive and below 2");
  demand(p.detonationEnergy > 0, "detonation energy", p.detonationEnergy, "J/m^3", "positive");
  demand(p.detonationSpeed > 0, "detonation speed", p.detonationSpeed, "m/s", "positive");
  const Real inertia = p.density * p.detonationSpeed * p.detonationSpeed;
  demand(
      p.detonationPressure > 0 && p.detonationPressure < 0.5 * inertia, "detonation pressure",
      p.detonationPressure, "Pa",
      fmt::format("positive and below half of density * detonation_speed^2 = {:.6g} Pa", inertia));
  demand(p.bulkModulus >= 0 && p.bulkModulus < inertia, "bulk modulus", p.bulkModulus, "Pa",
         fmt::format("positive and below density * detonation_speed^2 = {:.6g} Pa, or 0: a ninth "
                     "of that",
                     inertia));
  demand(int(p.lightingPoints.size()) <= Jwl::mostPoints, "number of lighting points",
         Real(p.lightingPoints.size()), "", fmt::format("at most {}", Jwl::mostPoints));
  demand(p.lightingTimes.empty() || p.lightingTimes.size() == p.lightingPoints.size(),
         "number of lighting times", Real(p.lightingTimes.size()), "",
         fmt::format("one for each of the {} lighting points", p.lightingPoints.size()));
}
} // namespace

Jwl makeLaw(const JwlParameters& p)
{
  demandConstants(p);
  const Real inertia = p.density * p.detonationSpeed * p.detonationSpeed;
  Jwl law{};
  law.a = p.a;
  law.b = p.b;
  law.r1 = p.r1;
  law.r2 = p.r2;
  law.omega = p.omega;
  law.energy = p.detonationEnergy;
  law.speed = p.detonationSpeed;
  law.detonationVolume = 1 - p.detonationPressure / inertia;
  law.unburntModulus = p.bulkModulus > 0 ? p.bulkModulus : inertia / 9;
  // Behind a detonation matter leaves the front at the speed of sound: rho c = rho0 D.
  law.elastic = {p.density, inertia * law.detonationVolume, 0};
  law.points = int(p.lightingPoints.size());
  for (int i = 0; i < law.points; ++i)
  {
    const std::vector<Real>& place = p.lightingPoints[std::size_t(i)];
    law.point[i] = {place[0], place[1], place.size() > 2 ? place[2] : 0.0};
    law.delay[i] = p.lightingTimes.empty() ? 0 : p.lightingTimes[std::size_t(i)];
  }
  checkDetonation(law, p);
  return law;
}

MaterialModel JwlParameters::model()
{
  using P = JwlParameters;
  using namespace schema;
  return MaterialModelOf<P>("jwl", "high explosive with programmed burn")
      .costs(1.5)
      .has({
          schema::density<P>(),
          number("jwl_a", &P::a)
              .needed()
              .in("Pa")
              .above(0)
              .like("371.2e9")
              .means("A of the products' pressure"),
          number("jwl_b", &P::b)
              .needed()
              .in("Pa")
              .atLeast(0)
              .like("3.231e9")
              .means("B of the products' pressure"),
          number("jwl_r1", &P::r1).needed().in("-").above(0).like("4.15").means("R1; above jwl_r2"),
          number("jwl_r2", &P::r2).needed().in("-").above(0).like("0.95").means("R2"),
          number("omega", &P::omega)
              .needed()
              .in("-")
              .above(0)
              .below(2)
              .like("0.3")
              .means("Grueneisen's Gamma of the products"),
          number("detonation_energy", &P::detonationEnergy)
              .needed()
              .in("J/m^3")
              .above(0)
              .like("7e9")
              .means("E0, chemical energy per initial volume"),
          number("detonation_speed", &P::detonationSpeed)
              .needed()
              .in("m/s")
              .above(0)
              .like("6930")
              .means("D, speed of the front"),
          number("detonation_pressure", &P::detonationPressure)
              .needed()
              .in("Pa")
              .above(0)
              .like("21e9")
              .means("p_CJ, of Chapman and Jouguet, behind the front"),
          number("bulk_modulus", &P::bulkModulus)
              .in("Pa")
              .atLeast(0)
              .like("9e9")
              .means("of the unburnt explosive; 0: density * (detonation_speed / 3)^2"),
          points("lighting_points", &P::lightingPoints)
              .shownBy<P>([](const P& p) { return fmt::format("{}", p.lightingPoints); })
              .like("[[0, 0, 0]]")
              .defaultIs("none: all burns from the start")
              .means("where fronts start [m]; at most 16"),
          numbers("lighting_times", &P::lightingTimes)
              .in("s")
              .like("[0]")
              .defaultIs("0 each")
              .means("when, one for each point"),
      })
      .comesAs(R"(
tnt: {model: jwl, density: 1630, jwl_a: 371.2e9, jwl_b: 3.231e9, jwl_r1: 4.15, jwl_r2: 0.95, omega: 0.3,
      detonation_energy: 7e9, detonation_speed: 6930, detonation_pressure: 21e9}
composition_b: {model: jwl, density: 1717, jwl_a: 524.2e9, jwl_b: 7.678e9, jwl_r1: 4.2, jwl_r2: 1.1, omega: 0.34,
                detonation_energy: 8.5e9, detonation_speed: 7980, detonation_pressure: 29.5e9}
c4: {model: jwl, density: 1601, jwl_a: 609.77e9, jwl_b: 12.95e9, jwl_r1: 4.5, jwl_r2: 1.4, omega: 0.25,
     detonation_energy: 9e9, detonation_speed: 8193, detonation_pressure: 28e9}
petn: {model: jwl, density: 1770, jwl_a: 617.1e9, jwl_b: 16.926e9, jwl_r1: 4.4, jwl_r2: 1.2, omega: 0.25,
       detonation_energy: 10.1e9, detonation_speed: 8300, detonation_pressure: 33.5e9}
)");
}
} // namespace coplane
