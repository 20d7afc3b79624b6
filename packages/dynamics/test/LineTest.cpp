// One line on hosts whose motion is given: forces in closed form, energies, momenta.
#include "LineRig.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace coplane
{
namespace
{
constexpr Real ea = 200e9 * 5e-4, grout = 2e9, boltLength = 2, headLength = 0.1; // a rock bolt

/// A plate at x = -headLength, and `segments` of equal length in grout from x = 0 on.
LineSetup boltOf(int segments)
{
  LineSetup setup;
  setup.section.area = 5e-4;
  setup.section.youngsModulus = 200e9;
  setup.bond.stiffness = grout;
  setup.points.push_back({{-headLength, 0, 0}, true, 0});
  for (int i = 0; i <= segments; ++i)
    setup.points.push_back({{boltLength * i / segments, 0, 0},
                            false,
                            boltLength / segments * (i == 0 || i == segments ? 0.5 : 1)});
  return setup;
}

/// Pulls the plate out by d [m].
void pull(Line& line, LineHosts hosts, Real d)
{
  hosts.x[0].x -= d;
  line.advance(hosts, 1, 1, 0);
}

Vec3 sum(const std::vector<Vec3>& forces)
{
  Vec3 total{};
  for (const Vec3& f : forces)
    total += f;
  return total;
}

Vec3 moment(const std::vector<Vec3>& x, const std::vector<Vec3>& forces)
{
  Vec3 total{};
  for (std::size_t i = 0; i < x.size(); ++i)
    total += cross(x[i], forces[i]);
  return total;
}
} // namespace

TEST(Line, isPulledOutOfElasticGroutByEALambdaTanhLambdaL)
{
  const Real lambda = std::sqrt(grout / ea), slope = ea * lambda * std::tanh(lambda * boltLength);
  const Real d = 1e-4; // plate; the head in series with the grout
  const Real exact = d / (headLength / ea + 1 / slope);
  Real error[2];
  for (const int refinement : {0, 1})
  {
    const LineSetup setup = boltOf(refinement == 0 ? 20 : 40);
    const LineHosts hosts = hostsOf(setup);
    Line line = installed(setup, hosts);
    pull(line, hosts, d);
    const Real force = line.segments()[0].force;
    error[refinement] = std::abs(force / exact - 1);
    // Along the bar the slip is cosh(lambda (L - x)) / cosh(lambda L) of that at the head.
    const Line::Point& middle = line.points()[std::size_t(1 + (refinement == 0 ? 10 : 20))];
    EXPECT_NEAR(middle.slip / line.points()[1].slip,
                std::cosh(lambda * boltLength / 2) / std::cosh(lambda * boltLength), 2e-3);
    EXPECT_EQ(line.unbalanced(), 0);
  }
  EXPECT_LT(error[0], 0.02);                // (lambda h)^2 / 12
  EXPECT_NEAR(error[0] / error[1], 4, 0.2); // second order
}

TEST(Line, givesNoMoreThanStrengthTimesLengthOfGrout)
{
  LineSetup setup = boltOf(20);
  setup.bond.strength = 1e5;
  const LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  for (int i = 1; i <= 50; ++i)
    pull(line, hosts, 2e-4 * i);
  EXPECT_NEAR(line.segments()[0].force, 1e5 * boltLength, 1e-4);
  // Linear along the bar.
  EXPECT_NEAR(line.segments()[10].force, 1e5 * (boltLength - 0.95), 1e-4);
  const LineEnergy energy = line.energy();
  EXPECT_GT(energy.bond, 0);
  EXPECT_NEAR(energy.remainder(), 0, 1e-8 * energy.work);
  EXPECT_EQ(line.unbalanced(), 0);
  // Half of the path back: slips the other way from twice the elastic range on.
  for (int i = 50; i >= 0; --i)
    pull(line, hosts, 2e-4 * i);
  EXPECT_NEAR(line.segments()[0].force, -1e5 * boltLength, 1e-4);
  EXPECT_NEAR(line.energy().remainder(), 0, 1e-8 * line.energy().work);
}

TEST(Line, isHeldByThePressureOfItsHostByCoulomb)
{
  LineSetup setup = boltOf(20);
  setup.bond.strength = 1e4;
  setup.bond.friction = 0.5;
  setup.bond.perimeter = 0.08;
  LineHosts hosts = hostsOf(setup);
  hosts.pressure.assign(hosts.x.size(), 2e6);
  hosts.pressure[5] = -1e6; // tension adds nothing
  Line line = installed(setup, hosts);
  for (int i = 1; i <= 50; ++i)
    pull(line, hosts, 2e-4 * i);
  const Real one = 0.5 * 0.08 * 2e6;
  EXPECT_NEAR(line.segments()[0].force, 1e4 * boltLength + one * (boltLength - 0.1), 1e-4);
}

TEST(Line, yieldsHardensAndTears)
{
  LineSetup setup;
  setup.section = {1e-4, 200e9, 400e6, 2e9, 0.05, true};
  setup.points = {{{0, 0, 0}, true, 0}, {{2, 0, 0}, true, 0}};
  LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  for (int i = 1; i <= 90; ++i) // strain 0.045
  {
    hosts.x[1].x = 2 + 1e-3 * i;
    line.advance(hosts, i, 1, 0);
  }
  // sigma = E_t (e - e_y) + sigma_y, E_t = E H / (E + H)
  const Real tangent = 200e9 * 2e9 / 202e9;
  EXPECT_NEAR(line.segments()[0].force, 1e-4 * (400e6 + tangent * (0.045 - 0.002)), 1e-3);
  LineEnergy energy = line.energy();
  EXPECT_NEAR(energy.remainder(), 0, 1e-9 * energy.work);
  EXPECT_EQ(energy.rupture, 0);
  Real expected = 0;
  for (int i = 91; i <= 110; ++i)
  {
    // What is stored, and what the force of the step before gives in the first half of the step.
    if (line.broken() == 0)
      expected = line.energy().stored + 0.5 * line.segments()[0].force * 1e-3;
    hosts.x[1].x = 2 + 1e-3 * i;
    line.advance(hosts, i, 1, 0);
  }
  energy = line.energy();
  EXPECT_EQ(line.broken(), 1);
  EXPECT_EQ(line.segments()[0].force, 0);
  EXPECT_EQ(norm(line.forces()[0]), 0);
  EXPECT_EQ(energy.stored, 0);
  EXPECT_NEAR(energy.remainder(), 0, 1e-9 * energy.work);
  EXPECT_NEAR(energy.rupture, expected, 1e-9 * expected);
}

TEST(Line, flowsAtAHigherStressTheFasterItIs)
{
  constexpr Real yield = 400e6, exponent = 0.025, reference = 1e-4, area = 1e-4, modulus = 200e9;
  LineSetup setup;
  setup.points = {{{0, 0, 0}, true, 0}, {{2, 0, 0}, true, 0}};
  const auto stressAt = [&](Real strain, Real rate, Real hardening, int steps, Line* out = nullptr)
  {
    setup.section = {area, modulus, yield, hardening, infinity, true, 0, exponent, reference};
    LineHosts hosts = hostsOf(setup);
    Line line = installed(setup, hosts);
    const Real dt = std::abs(strain) / rate / steps;
    for (int i = 1; i <= steps; ++i)
    {
      hosts.x[1].x = 2 + 2 * strain * i / steps;
      line.advance(hosts, i * dt, dt, 0);
      EXPECT_NEAR(line.energy().remainder(), 0, 1e-12 * line.energy().work);
    }
    if (out != nullptr)
      *out = line;
    return line.segments()[0].force / area;
  };
  // Long after yield all of the rate is plastic.
  for (const Real rate : {1e-3, 1.0, 100.0})
    for (const Real sign : {1.0, -1.0})
      EXPECT_NEAR(stressAt(sign * 0.02, rate, 0, 1000),
                  sign * yield * std::pow(rate / reference, exponent), 1e-6 * yield)
          << rate;
  EXPECT_NEAR(stressAt(0.02, 100, 0, 20) / stressAt(0.02, 100, 0, 2000), 1, 1e-6);
  // Not faster than the reference: as slowly.
  EXPECT_NEAR(stressAt(0.02, 1e-5, 1e9, 100), stressAt(0.02, 1e-9, 1e9, 1), 1e-3);
  EXPECT_NEAR(stressAt(0.02, reference, 0, 100), yield, 1e-3);
  // Hardening counts from where it is more than the rate.
  const Real tangent = modulus * 50e9 / 250e9;
  EXPECT_NEAR(stressAt(0.02, 100, 50e9, 1000), yield + tangent * (0.02 - yield / modulus), 1);
  EXPECT_NEAR(stressAt(0.02, 100, 1e9, 1000), yield * std::pow(1e6, exponent), 1e-4 * yield);

  // Whatever the exponent and the step: the stress is that at which it flows.
  for (const Real large : {1e-4, 0.3, 1.0})
    for (const Real dt : {1e-9, 1e-3})
    {
      setup.section = {area, modulus, yield, 0, infinity, true, 0, large, reference};
      LineHosts hosts = hostsOf(setup);
      Line one = installed(setup, hosts);
      hosts.x[1].x = 2 + 2 * 0.004;
      one.advance(hosts, dt, dt, 0);
      const Line::Segment& segment = one.segments()[0];
      const Real rate = segment.plasticStrain / dt / reference;
      EXPECT_GT(segment.plasticStrain, 0);
      EXPECT_NEAR(segment.force / area / (yield * std::pow(std::max(1.0, rate), large)), 1, 1e-9)
          << large << ' ' << dt;
    }
  setup.section.rateExponent = exponent;

  // Held still it relaxes: ds/dt = -(E r / Y) s^n with s the stress over Y and n = 1 / exponent.
  Line line(setup, {});
  const Real first = stressAt(0.02, 10, 0, 1000, &line) / yield;
  LineHosts hosts = hostsOf(setup);
  hosts.x[1].x = 2 + 2 * 0.02;
  const Real n = 1 / exponent, held = 1e-3;
  constexpr int steps = 4000;
  for (int i = 1; i <= steps; ++i)
    line.advance(hosts, 0.002 + i * held / steps, held / steps, 0);
  const Real exact =
      std::pow(std::pow(first, 1 - n) + (n - 1) * modulus * reference / yield * held, 1 / (1 - n));
  EXPECT_NEAR(line.segments()[0].force / area / yield, exact, 1e-3 * (first - exact));
  EXPECT_LT(exact, 0.97 * first);
}

TEST(Line, goesSlackWithoutCompression)
{
  LineSetup setup;
  setup.section = {1e-4, 200e9, infinity, 0, infinity, false};
  setup.points = {{{0, 0, 0}, true, 0}, {{2, 0, 0}, true, 0}};
  LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  hosts.x[1].x = 1.99;
  line.advance(hosts, 1, 1, 0);
  EXPECT_EQ(line.segments()[0].force, 0);
  hosts.x[1].x = 2.001;
  line.advance(hosts, 2, 1, 0);
  EXPECT_NEAR(line.segments()[0].force, 1e-4 * 200e9 * 5e-4, 1e-6);
}

TEST(Line, isPretensionedOverATime)
{
  LineSetup setup;
  setup.section = {1e-4, 200e9, infinity, 0, infinity, true};
  setup.points = {{{0, 0, 0}, true, 0}, {{2, 0, 0}, true, 0}};
  setup.pretension = 5e4;
  setup.pretensionTime = 4;
  setup.from = 2;
  const LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  EXPECT_FALSE(line.installed());
  for (int i = 1; i <= 10; ++i)
  {
    line.advance(hosts, i, 1, 0);
    const Real since = i < 2 ? 0 : std::min(4.0, i - 2.0);
    EXPECT_NEAR(line.segments()[0].force, 5e4 * since / 4, 1e-6);
  }
  // All work is that of the jack: T^2 L / (2 E A).
  EXPECT_NEAR(line.energy().pretension, 5e4 * 5e4 * 2 / (2 * 2e7), 1e-6);
  EXPECT_NEAR(line.energy().remainder(), 0, 1e-9);
}

TEST(Line, isThereFromItsTimeOnAndFromTheBeginningOfItsStage)
{
  LineSetup setup;
  setup.section = {1e-4, 200e9, infinity, 0, infinity, true};
  setup.points = {{{0, 0, 0}, true, 0}, {{2, 0, 0}, true, 0}};
  const Real stiffness = 1e-4 * 200e9 / 2;
  // Hosts move by 1 mm in each step of 1 s; the stage 1 begins at t = 2, with the step to t = 3.
  const auto forces = [&](Real from, int ofStage)
  {
    setup.from = from;
    setup.stage = ofStage;
    LineHosts hosts = hostsOf(setup);
    Line line = installed(setup, hosts);
    std::vector<Real> stretches;
    for (int i = 1; i <= 4; ++i)
    {
      hosts.x[1].x = 2 + 1e-3 * i;
      line.advance(hosts, i, 1, i > 2 ? 1 : 0);
      stretches.push_back(std::round(1e3 * line.segments()[0].force / stiffness));
      EXPECT_NEAR(line.energy().remainder(), 0, 1e-9);
    }
    return stretches;
  };
  using Stretches = std::vector<Real>; // [mm]
  EXPECT_EQ(forces(0, 0), (Stretches{1, 2, 3, 4}));
  EXPECT_EQ(forces(2, 0), (Stretches{0, 0, 1, 2})); // free of stress at t = 2
  EXPECT_EQ(forces(2 + 1e-12, 0), (Stretches{0, 0, 1, 2}));
  EXPECT_EQ(forces(1.5, 0), (Stretches{0, 0, 1, 2})); // at the next end of a step
  EXPECT_EQ(forces(0, 1), (Stretches{0, 0, 1, 2}));
  EXPECT_EQ(forces(2, 1), (Stretches{0, 0, 1, 2}));
  EXPECT_EQ(forces(3, 1), (Stretches{0, 0, 0, 1}));
}

TEST(Line, hasNoResultantAndNoMomentAndTurnsWithItsHosts)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<Real> number(-1, 1);
  const auto vector = [&] { return Vec3{number(random), number(random), number(random)}; };
  LineSetup setup = boltOf(12);
  setup.bond.strength = 2e5;
  setup.section.yieldStress = 300e6;
  setup.dowel = LineDowel{3e8, 2e5};
  LineHosts hosts = hostsOf(setup);
  const Vec3 joint{0.5, 0, 0};
  for (int side = 0; side < 2; ++side)
  {
    hosts.x.push_back(joint);
    hosts.alive.push_back(1);
  }
  // A turn about an axis, and the same motion seen from there.
  const Vec3 axis = normalised(Vec3{1, 2, -0.5});
  const auto turned = [&](const Vec3& v)
  {
    const Real angle = 0.7;
    return std::cos(angle) * v + std::sin(angle) * cross(axis, v) +
           (1 - std::cos(angle)) * dot(axis, v) * axis;
  };
  LineHosts there = hosts;
  for (Vec3& x : there.x)
    x = turned(x);
  Line line = installed(setup, hosts, {3}), other = installed(setup, there, {3});
  const Vec3 way = vector(); // sliding along a straight path
  for (int step = 1; step <= 20; ++step)
  {
    for (std::size_t i = 0; i < hosts.x.size(); ++i)
    {
      const bool far = i > 3 && i != hosts.x.size() - 2;
      hosts.x[i] += 1e-4 * vector() + (far ? 2e-4 * way : Vec3{});
    }
    const std::size_t near = hosts.x.size() - 2;
    hosts.x[near + 1] = hosts.x[near] + (2e-4 * step) * way; // the joint opens and slides
    for (std::size_t i = 0; i < hosts.x.size(); ++i)
      there.x[i] = turned(hosts.x[i]);
    line.advance(hosts, step, 1, 0);
    other.advance(there, step, 1, 0);
    Real most = 0;
    for (const Vec3& f : line.forces())
      most = std::max(most, norm(f));
    EXPECT_LT(norm(sum(line.forces())), 1e-12 * most);
    for (std::size_t i = 0; i < hosts.x.size(); ++i)
      EXPECT_LT(norm(turned(line.forces()[i]) - other.forces()[i]), 1e-6 * most);
    // What turns slowly keeps its direction but for the random motion of the chord.
    const Line::Dowel& dowel = line.dowels()[0];
    EXPECT_GT(norm(dowel.force), 0);
    const Vec3 twist = cross(dowel.sliding, dowel.force);
    EXPECT_LT(norm(moment(hosts.x, line.forces()) + twist), 1e-11 * most);
  }
  EXPECT_GT(line.energy().bond, 0);
  EXPECT_GT(line.energy().dowel, 0);
}

TEST(Line, slidesByItsDowelAsAnElasticPlasticSpring)
{
  LineSetup setup;
  setup.section = {1e-4, 1e6, infinity, 0, infinity, false}; // soft: the dowel alone
  setup.points = {{{-1, 0, 0}, true, 0}, {{1, 0, 0}, true, 0}};
  setup.dowel = LineDowel{1e8, 5e4};
  LineHosts hosts = hostsOf(setup);
  for (int side = 0; side < 2; ++side)
  {
    hosts.x.push_back({0, 0, 0});
    hosts.alive.push_back(1);
  }
  Line line = installed(setup, hosts, {0});
  const auto slideTo = [&](Real y)
  {
    const Real from = hosts.x[3].y;
    for (int i = 1; i <= 10; ++i)
    {
      hosts.x[1].y = hosts.x[3].y = from + (y - from) * i / 10;
      line.advance(hosts, 1, 1, 0);
    }
    return -line.forces()[3].y;
  };
  EXPECT_NEAR(slideTo(2e-4), 2e4, 1);
  EXPECT_NEAR(slideTo(1e-3), 5e4, 1);
  EXPECT_NEAR(slideTo(6e-4), 1e4, 1); // 1e-3 - 5e-4 is lost
  EXPECT_NEAR(slideTo(-1e-3), -5e4, 1);
  const Real lost = 5e4 * (5e-4 + 1e-3);
  EXPECT_NEAR(line.energy().dowel, lost, 0.05 * lost); // by the trapezoidal rule
  EXPECT_NEAR(line.energy().remainder(), 0, 1e-3 * lost);
}

TEST(Line, countsSlidingFromItsInstallationOn)
{
  LineSetup setup;
  setup.section = {1e-4, 1e6, infinity, 0, infinity, false};
  setup.points = {{{-1, 0, 0}, true, 0}, {{1, 0, 0}, true, 0}};
  setup.dowel = LineDowel{1e8, infinity};
  setup.from = 1;
  LineHosts hosts = hostsOf(setup);
  for (int side = 0; side < 2; ++side)
  {
    hosts.x.push_back({0, 0, 0});
    hosts.alive.push_back(1);
  }
  Line line = installed(setup, hosts, {0});
  hosts.x[1].y = hosts.x[3].y = 5e-3; // before there is a line
  line.advance(hosts, 0.5, 0.5, 0);
  line.advance(hosts, 1, 0.5, 0);
  EXPECT_TRUE(line.installed());
  EXPECT_NEAR(norm(line.dowels()[0].force), 0, 1e-6);
  EXPECT_NEAR(line.energy().remainder(), 0, 1e-9);
  hosts.x[1].y = hosts.x[3].y = 6e-3;
  line.advance(hosts, 2, 1, 0);
  // Across the chord, which turns.
  const auto across = [](Real slid) { return slid * 2 / std::hypot(2, slid); };
  EXPECT_NEAR(norm(line.dowels()[0].force), 1e8 * (across(6e-3) - across(5e-3)), 1e-6);
}

TEST(Line, losesWhatItsDeadHostsHeld)
{
  LineSetup setup = boltOf(20);
  setup.bond.strength = 1e5;
  LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  for (int i = 1; i <= 50; ++i)
    pull(line, hosts, 2e-4 * i);
  for (std::size_t i = 1; i <= 10; ++i) // grout from x = 0 to 0.95 is gone
    hosts.alive[i] = 0;
  pull(line, hosts, 2e-4 * 50);
  EXPECT_EQ(line.segments().size(), 11u);
  EXPECT_NEAR(line.segments()[0].length, headLength + 1, 1e-12);
  EXPECT_LE(line.segments()[0].force, 1e5 * 1.05 + 1e-4);
  pull(line, hosts, 2e-4 * 60);
  EXPECT_NEAR(line.segments()[0].force, 1e5 * 1.05, 1e-4);
  const LineEnergy energy = line.energy();
  EXPECT_GT(energy.rupture, 0);
  EXPECT_NEAR(energy.remainder(), 0, 1e-8 * energy.work);
  hosts.alive[0] = 0; // the plate
  pull(line, hosts, 2e-4 * 60);
  for (const Line::Segment& segment : line.segments())
    EXPECT_LT(std::abs(segment.force), 1e5 * 1.05);
  EXPECT_LT(norm(sum(line.forces())), 1e-9);
  EXPECT_NEAR(line.energy().remainder(), 0, 1e-8 * energy.work);
}

TEST(Line, staysTornWhereTheHostBesideTheTearDies)
{
  LineSetup setup;
  setup.section = {1e-4, 200e9, infinity, 0, 0.01, true};
  for (int i = 0; i <= 4; ++i)
    setup.points.push_back({{Real(i), 0, 0}, true, 0});
  LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  for (const Real way : {0.004, 0.008, 0.012}) // the second segment tears, the third is pulled
  {
    hosts.x[2].x = 2 + way;
    hosts.x[3].x = 3 + 1.5 * way;
    hosts.x[4].x = 4 + 1.5 * way;
    line.advance(hosts, way, 0.004, 0);
  }
  ASSERT_EQ(line.segments()[1].broken, 1);
  ASSERT_GT(line.segments()[2].force, 0);
  hosts.alive[2] = 0;
  for (int step = 1; step <= 3; ++step)
  {
    hosts.x[3].x += 0.01;
    hosts.x[4].x += 0.01;
    line.advance(hosts, step, 1, 0);
    EXPECT_EQ(line.segments()[1].broken, 1);
    EXPECT_EQ(line.segments()[1].force, 0);
    EXPECT_EQ(line.forces()[1].x, line.segments()[0].force == 0 ? 0 : -line.segments()[0].force);
  }
  EXPECT_NEAR(line.energy().remainder(), 0, 1e-9 * line.energy().work);
}

TEST(Line, isTakenOutWithWhatItStores)
{
  LineSetup setup = boltOf(8);
  setup.until = 2;
  const LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  pull(line, hosts, 1e-3);
  const LineEnergy before = line.energy();
  const Real force = line.forces()[0].x, stored = before.stored;
  ASSERT_GT(stored, 1);
  LineHosts there = hosts;
  there.x[0].x -= 1.5e-3;
  line.advance(there, 2, 1, 0);
  EXPECT_TRUE(line.removed());
  for (std::size_t i = 0; i < hosts.x.size(); ++i)
  {
    EXPECT_EQ(norm(line.forces()[i]), 0);
    EXPECT_EQ(line.stiffness()[i], 0);
  }
  // Half a step's work of the force that it had.
  const LineEnergy after = line.energy();
  EXPECT_EQ(after.stored, 0);
  EXPECT_NEAR(after.work - before.work, 0.5 * force * 0.5e-3, 1e-12 * stored);
  EXPECT_NEAR(after.rupture, stored + 0.5 * force * 0.5e-3, 1e-12 * stored);
  EXPECT_NEAR(after.remainder(), before.remainder(), 1e-12 * stored);

  // It stays away, from what was saved too.
  std::vector<Real> numbers;
  line.save(numbers);
  Line again(setup, {});
  const Real* next = numbers.data();
  again.restore(next);
  EXPECT_EQ(next, numbers.data() + numbers.size());
  for (Line* one : {&line, &again})
  {
    pull(*one, hosts, 3e-3);
    EXPECT_TRUE(one->removed());
    EXPECT_EQ(norm(one->forces()[0]), 0);
    EXPECT_EQ(one->energy().work, after.work);
  }
}

TEST(Line, goesOnFromWhatWasSaved)
{
  LineSetup setup = boltOf(20);
  setup.bond.strength = 1e5;
  LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  pull(line, hosts, 2e-3);
  hosts.alive[4] = 0;
  pull(line, hosts, 3e-3);
  std::vector<Real> numbers;
  line.save(numbers);
  Line again(setup, {});
  const Real* next = numbers.data();
  again.restore(next);
  EXPECT_EQ(next, numbers.data() + numbers.size());
  pull(line, hosts, 1e-3);
  pull(again, hosts, 1e-3);
  for (std::size_t i = 0; i < hosts.x.size(); ++i)
    EXPECT_EQ(line.forces()[i].x, again.forces()[i].x);
  EXPECT_EQ(line.energy().bond, again.energy().bond);
}

TEST(Line, isNoStifferThanItsBoundAcrossAnOpenJoint)
{
  LineSetup setup;
  setup.section = {1e-4, 1e6, infinity, 0, infinity, false};
  setup.points = {{{-1, 0, 0}, true, 0}, {{1, 0, 0}, true, 0}};
  setup.dowel = LineDowel{1e8, infinity};
  LineHosts hosts = hostsOf(setup);
  for (const Real x : {-0.9, 0.8}) // the joint is nearly as wide as the segment
  {
    hosts.x.push_back({x, 0, 0});
    hosts.alive.push_back(1);
  }
  const Line line = installed(setup, hosts, {0});
  std::vector<Real> rows(hosts.x.size(), 0);
  for (std::size_t j = 0; j < hosts.x.size(); ++j)
  {
    Line moved = line;
    LineHosts there = hosts;
    there.x[j].y += 1e-7;
    moved.advance(there, 1, 1, 0);
    for (std::size_t i = 0; i < hosts.x.size(); ++i)
      rows[i] += std::abs(moved.forces()[i].y) / 1e-7;
  }
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    EXPECT_GT(rows[i], 0.5 * 1e8);
    EXPECT_LE(rows[i], 1.001 * line.stiffness()[i]);
  }
}

TEST(Line, isNoStifferThanItsBoundWhereItTurns)
{
  LineSetup setup;
  setup.section.area = 5e-4;
  setup.section.youngsModulus = 200e9;
  setup.bond.stiffness = grout;
  constexpr int leg = 20;
  constexpr Real step = 0.1;
  for (int i = 0; i <= 2 * leg; ++i)
    setup.points.push_back({{step * std::min(i, leg), step * std::max(0, i - leg), 0},
                            false,
                            i == 0 || i == 2 * leg ? 0.5 * step : step});
  LineHosts hosts = hostsOf(setup);
  const Line line = installed(setup, hosts);
  Line moved = line;
  const Vec3 outwards = normalised(Vec3{1, -1, 0});
  hosts.x[leg] += 1e-7 * outwards;
  moved.advance(hosts, 1, 1, 0);
  const Real stiffness = -dot(moved.forces()[leg], outwards) / 1e-7;
  EXPECT_GT(stiffness, 1.5 * grout * step); // more than its own grout
  EXPECT_LE(stiffness, 1.001 * line.stiffness()[leg]);
}

TEST(Line, isNoStifferThanItsBound)
{
  // Rows of the stiffness by differences, while everything is elastic.
  for (const bool stiffGrout : {false, true})
  {
    LineSetup setup = boltOf(8);
    setup.bond.stiffness = stiffGrout ? 1e13 : 1e7;
    const LineHosts hosts = hostsOf(setup);
    const Line line = installed(setup, hosts);
    std::vector<Real> rows(hosts.x.size(), 0);
    for (std::size_t j = 0; j < hosts.x.size(); ++j)
    {
      Line moved = line;
      LineHosts there = hosts;
      there.x[j].x += 1e-7;
      moved.advance(there, 1, 1, 0);
      for (std::size_t i = 0; i < hosts.x.size(); ++i)
        rows[i] += std::abs(moved.forces()[i].x) / 1e-7;
    }
    const Real largest = *std::max_element(rows.begin(), rows.end());
    const Real bound = *std::max_element(line.stiffness().begin(), line.stiffness().end());
    EXPECT_LE(largest,
              2.01 * bound); // a row of a matrix below a diagonal one may be twice as large
    EXPECT_GE(largest, 0.2 * bound);
  }
}

TEST(Line, knowsWhetherItWillChange) // within a stage that ends at 10 s
{
  LineSetup setup = boltOf(4);
  const LineHosts hosts = hostsOf(setup);
  EXPECT_FALSE(installed(setup, hosts).willChange(0, 10, 0));
  setup.pretension = 1e4;
  setup.pretensionTime = 2;
  setup.stage = 1;
  Line line(setup, {});
  EXPECT_FALSE(line.willChange(1, 10, 0)); // another stage
  EXPECT_TRUE(line.willChange(1, 10, 1));
  line.advance(hosts, 5, 1, 1);
  EXPECT_TRUE(line.willChange(5, 10, 1));
  EXPECT_FALSE(line.willChange(7, 10, 1));
  setup.until = 9;
  EXPECT_TRUE(Line(setup, {}).willChange(8, 10, 1));
  setup.until = 12;
  setup.from = 11;
  EXPECT_FALSE(Line(setup, {}).willChange(8, 10, 1)); // after the end
}
} // namespace coplane
