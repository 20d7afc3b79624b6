// A line that bends, on hosts whose motion is given: moments, forces and energies in closed form.
#include "LineRig.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace coplane
{
namespace
{
constexpr Real diameter = 0.02, length = 1, modulus = 200e9, yieldStress = 500e6;
constexpr Real area = pi / 4 * diameter * diameter;
constexpr Real secondMoment = pi / 64 * diameter * diameter * diameter * diameter;
constexpr Real plasticMoment = yieldStress * diameter * diameter * diameter / 6;

/// Tied along x from 0 on.
LineSetup barOf(int segments)
{
  LineSetup setup;
  setup.section.area = area;
  setup.section.youngsModulus = modulus;
  setup.section.diameter = diameter;
  for (int i = 0; i <= segments; ++i)
    setup.points.push_back({{length * i / segments, 0, 0}, true, 0});
  return setup;
}

/// Brings the points to `place(x, part)` while part goes from 0 to 1.
void lead(Line& line, LineHosts& hosts, const LineSetup& setup, int steps,
          const std::function<Vec3(const Vec3&, Real)>& place, Real start = 0)
{
  for (int step = 1; step <= steps; ++step)
  {
    for (std::size_t i = 0; i < hosts.x.size(); ++i)
      hosts.x[i] = place(setup.points[i].place, Real(step) / steps);
    line.advance(hosts, start + step, 1, 0);
  }
}

Vec3 turnedBy(const Vec3& v, const Vec3& axis, Real angle)
{
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) +
         (1 - std::cos(angle)) * dot(axis, v) * axis;
}

/// Two segments of half a metre, of which the second turns by the angle and keeps its length.
Vec3 knee(const Vec3& x, Real angle, Real stretch = 1)
{
  const Real behind = stretch * std::max(0.0, x.x - 0.5);
  return {std::min(x.x, 0.5) + behind * std::cos(angle), behind * std::sin(angle), 0};
}
} // namespace

TEST(LineBending, bentToACircleHasTheMomentOfItsRadius)
{
  constexpr int segments = 50;
  constexpr Real radius = 10;
  const LineSetup setup = barOf(segments);
  LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  lead(line, hosts, setup, 20,
       [&](const Vec3& x, Real part)
       {
         const Real r = radius / part;
         return Vec3{r * std::sin(x.x / r), r * (1 - std::cos(x.x / r)), 0};
       });
  const Real exact = modulus * secondMoment / radius;
  for (int i = 1; i < segments; ++i)
    EXPECT_NEAR(line.points()[std::size_t(i)].moment.z, exact, 1e-9 * exact);
  EXPECT_EQ(norm(line.points()[0].moment), 0);
  EXPECT_EQ(norm(line.points()[segments].moment), 0);
  // Chords are shorter than arcs, by (h / r)^2 / 24, and pressed.
  const Real axial = length / (2 * modulus * area) * std::pow(line.segments()[0].force, 2);
  EXPECT_NEAR(line.energy().stored - axial, exact / radius / 2 * (length - length / segments),
              1e-6 * exact / radius);
  EXPECT_NEAR(line.energy().remainder(), 0, 1e-3 * line.energy().work);
  EXPECT_EQ(line.energy().plastic, 0);
}

TEST(LineBending, clampedBetweenPlanesOfSymmetryShearsAsABeam)
{
  for (const int segments : {20, 40})
  {
    LineSetup setup = barOf(segments);
    setup.mirrored = {true, true};
    LineHosts hosts = hostsOf(setup);
    Line line = installed(setup, hosts);
    constexpr Real offset = 1e-6;
    lead(line, hosts, setup, 1,
         [&](const Vec3& x, Real) {
           return Vec3{x.x, offset * x.x * x.x * (3 - 2 * x.x), 0};
         });
    const Real exact = 12 * modulus * secondMoment * offset;
    // The shear goes into the end and the point beside it, as the half hinge at the end lies within
    // its segment.
    const auto& forces = line.forces();
    EXPECT_NEAR(forces[0].y + forces[1].y, exact, 1e-6 * exact);
    EXPECT_NEAR(forces[std::size_t(segments)].y + forces[std::size_t(segments - 1)].y, -exact,
                1e-6 * exact);
    EXPECT_NEAR(line.points()[0].moment.z, exact / 2, exact / segments);
    EXPECT_NEAR(line.points().back().moment.z, -exact / 2, exact / segments);
    for (int i = 2; i + 2 < segments; ++i)
      EXPECT_NEAR(line.forces()[std::size_t(i)].y, 0, 1e-6 * exact);
    // Forces, and moments from beyond both planes, are in balance.
    Vec3 moment = line.outerMoments()[0] + line.outerMoments()[1];
    for (std::size_t i = 0; i < hosts.x.size(); ++i)
      moment = moment - cross(hosts.x[i], forces[i]);
    EXPECT_LT(norm(moment), 1e-9 * exact);
    // The lowest energy of all shapes with these ends.
    EXPECT_NEAR(line.energy().stored, exact * offset / 2, 0.01 * exact * offset);
  }
}

TEST(LineBending, yieldsAtItsPlasticMomentWhichTheForceReduces)
{
  for (const bool pulled : {false, true})
  {
    LineSetup setup = barOf(2);
    setup.section.yieldStress = yieldStress;
    LineHosts hosts = hostsOf(setup);
    Line line = installed(setup, hosts);
    constexpr Real angle = 0.5, share = 0.6;
    const Real strain = pulled ? share * yieldStress / modulus : 0;
    lead(line, hosts, setup, 1, [&](const Vec3& x, Real) { return (1 + strain) * x; });
    lead(line, hosts, setup, 2000,
         [&](const Vec3& x, Real part) { return (1 + strain) * knee(x, part * angle); });
    const Real most = plasticMoment * (pulled ? 1 - share * share : 1);
    EXPECT_NEAR(line.points()[1].moment.z, most, 1e-6 * most);
    const Real stiffness = modulus * secondMoment / (length / 2);
    const LineEnergy energy = line.energy();
    EXPECT_NEAR(energy.plastic, most * (angle - most / stiffness), 1e-6 * most);
    EXPECT_NEAR(energy.remainder(), 0, 1e-6 * energy.work);
    // Back by what is elastic: no moment is left, and the angle stays.
    lead(line, hosts, setup, 100,
         [&](const Vec3& x, Real part)
         { return (1 + strain) * knee(x, angle - part * most / stiffness); });
    EXPECT_NEAR(line.points()[1].moment.z, 0, 1e-6 * most);
    EXPECT_NEAR(line.energy().plastic, energy.plastic, 1e-9 * energy.plastic);
  }
}

TEST(LineBending, yieldsAtALargerMomentTheFasterItIsBent)
{
  // Steps of 1 s; the outermost fibre has d / 2 l of the angle, l half of each segment.
  constexpr Real angle = 0.5, fibre = 0.5 * diameter / (length / 2), exponent = 0.05;
  for (const int steps : {200, 2000})
    for (const bool pulled : {false, true})
    {
      LineSetup setup = barOf(2);
      setup.section.yieldStress = yieldStress;
      setup.section.rateExponent = exponent;
      setup.section.referenceRate = angle / steps * fibre / 20;
      LineHosts hosts = hostsOf(setup);
      Line line = installed(setup, hosts);
      constexpr Real share = 0.6;
      const Real strain = pulled ? share * yieldStress / modulus : 0;
      lead(line, hosts, setup, 1, [&](const Vec3& x, Real) { return (1 + strain) * x; });
      lead(line, hosts, setup, steps,
           [&](const Vec3& x, Real part) { return (1 + strain) * knee(x, part * angle); });
      const Real most = plasticMoment * (pulled ? 1 - share * share : 1) * std::pow(20, exponent);
      EXPECT_NEAR(line.points()[1].moment.z, most, 1e-6 * most);
      EXPECT_EQ(line.energy().rupture, 0);
      EXPECT_NEAR(line.energy().remainder(), 0, 1e-4 * line.energy().work);
    }
}

TEST(LineBending, losesNoEnergyAsTornWhileItFlowsFast)
{
  LineSetup setup = barOf(2);
  setup.section.yieldStress = yieldStress;
  setup.section.rateExponent = 0.05;
  setup.section.referenceRate = 1e-6;
  LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  lead(line, hosts, setup, 100,
       [&](const Vec3& x, Real part) { return (1 + 0.01 * part) * knee(x, part * 0.2); });
  EXPECT_GT(line.segments()[0].force, area * yieldStress);
  EXPECT_EQ(line.energy().rupture, 0);
  EXPECT_NEAR(line.energy().remainder(), 0, 1e-3 * line.energy().work);
}

TEST(LineBending, turnsWithItsHostsWithoutWork)
{
  LineSetup setup = barOf(2);
  setup.section.yieldStress = yieldStress;
  LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  lead(line, hosts, setup, 200, [&](const Vec3& x, Real part) { return knee(x, 0.3 * part); });
  lead(line, hosts, setup, 20,
       [&](const Vec3& x, Real part) { return knee(x, 0.3 - 0.01 * part); });
  const LineEnergy before = line.energy();
  const Vec3 moment = line.points()[1].moment;
  ASSERT_GT(before.plastic, 0);
  ASSERT_GT(norm(moment), 0.1 * plasticMoment);
  for (const Vec3& axis : {Vec3{1, 0, 0}, normalised(Vec3{1, 2, -0.5}), Vec3{0, 0, 1}})
  {
    Line turning = line;
    LineHosts there = hosts;
    constexpr int steps = 50;
    for (int step = 1; step <= steps; ++step)
    {
      const Real angle = 2.0 * step / steps;
      for (std::size_t i = 0; i < there.x.size(); ++i)
        there.x[i] = turnedBy(hosts.x[i], axis, angle);
      turning.advance(there, step, 1, 0);
    }
    EXPECT_LT(norm(turning.points()[1].moment - turnedBy(moment, axis, 2)), 1e-9 * norm(moment));
    EXPECT_NEAR(turning.energy().stored, before.stored, 1e-9 * before.stored);
    EXPECT_NEAR(turning.energy().plastic, before.plastic, 1e-9 * before.plastic);
  }
}

TEST(LineBending, hasNoResultantAndNoMoment)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<Real> number(-1, 1);
  LineSetup setup = barOf(6);
  setup.section.yieldStress = yieldStress;
  LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  for (int step = 1; step <= 20; ++step)
  {
    for (Vec3& x : hosts.x)
      x += 2e-3 * Vec3{number(random), number(random), number(random)};
    line.advance(hosts, step, 1, 0);
    Real most = 0;
    Vec3 force{}, moment{};
    for (std::size_t i = 0; i < hosts.x.size(); ++i)
    {
      force += line.forces()[i];
      moment += cross(hosts.x[i], line.forces()[i]);
      most = std::max(most, norm(line.forces()[i]));
    }
    EXPECT_LT(norm(force), 1e-12 * most);
    EXPECT_LT(norm(moment), 1e-12 * most);
  }
}

TEST(LineBending, halfABarAtAPlaneOfSymmetryIsHalfOfTheWhole)
{
  constexpr int segments = 8;
  LineSetup whole = barOf(2 * segments), half = barOf(segments);
  for (LinePoint& point : whole.points)
    point.place.x = 2 * point.place.x - 1; // from -1 to 1
  half.mirrored = {true, false};
  for (LineSetup* setup : {&whole, &half})
    setup->section.yieldStress = yieldStress;
  LineHosts hosts = hostsOf(whole), halfHosts = hostsOf(half);
  Line line = installed(whole, hosts), other = installed(half, halfHosts);
  const auto bent = [](const Vec3& x, Real part) {
    return Vec3{x.x, 0.005 * part * std::exp(-100 * x.x * x.x), 0};
  };
  lead(line, hosts, whole, 100, bent);
  lead(other, halfHosts, half, 100, bent);
  ASSERT_GT(line.energy().plastic, 0);
  const Real scale = norm(line.points()[segments].moment);
  ASSERT_GT(scale, 0);
  EXPECT_NEAR(other.points()[0].moment.z, line.points()[segments].moment.z, 1e-9 * scale);
  EXPECT_NEAR(2 * other.forces()[0].y, line.forces()[segments].y, 1e-9 * scale / 0.1);
  for (int i = 1; i <= segments; ++i)
    EXPECT_NEAR(other.forces()[std::size_t(i)].y, line.forces()[std::size_t(segments + i)].y,
                1e-9 * scale / 0.1);
  EXPECT_NEAR(2 * other.energy().plastic, line.energy().plastic, 1e-9 * line.energy().plastic);
}

TEST(LineBending, goesOnFromWhatWasSavedAndLosesWhatDeadHostsHeld)
{
  LineSetup setup = barOf(6);
  setup.section.yieldStress = yieldStress;
  setup.mirrored = {true, false};
  const auto bent = [](const Vec3& x, Real part) {
    return Vec3{x.x, 0.01 * part * x.x * x.x, 0.004 * part * std::sin(25 * x.x)};
  };
  LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  lead(line, hosts, setup, 50, bent);
  ASSERT_GT(line.energy().plastic, 0);
  for (const std::size_t i : {0, 1, 2, 3, 4, 5})
    ASSERT_GT(norm(line.points()[i].moment), 0.05 * plasticMoment) << i;
  std::vector<Real> numbers;
  line.save(numbers);
  Line again(setup, {});
  const Real* next = numbers.data();
  again.restore(next);
  EXPECT_EQ(next, numbers.data() + numbers.size());
  for (Line* one : {&line, &again})
  {
    LineHosts there = hosts;
    lead(
        *one, there, setup, 1, [&](const Vec3& x, Real) { return bent(x, 0.97); }, 50);
    const LineEnergy before = one->energy();
    there.alive[2] = 0; // its neighbours keep their angles, over longer segments
    lead(
        *one, there, setup, 1, [&](const Vec3& x, Real) { return bent(x, 0.97); }, 51);
    EXPECT_GT(one->energy().rupture, 0);
    EXPECT_LT(one->energy().stored, before.stored);
    EXPECT_NEAR(one->energy().remainder(), before.remainder(), 1e-9 * before.work);
    there.alive[0] = 0; // the plane of symmetry has gone with its host
    lead(
        *one, there, setup, 1, [&](const Vec3& x, Real) { return bent(x, 0.96); }, 52);
    EXPECT_EQ(norm(one->points()[0].moment), 0);
    EXPECT_GT(norm(one->points()[2].moment), 0);
  }
  for (std::size_t i = 0; i < hosts.x.size(); ++i)
  {
    EXPECT_EQ(line.forces()[i].y, again.forces()[i].y);
    EXPECT_EQ(line.forces()[i].z, again.forces()[i].z);
  }
  EXPECT_EQ(line.energy().plastic, again.energy().plastic);
  EXPECT_EQ(line.energy().rupture, again.energy().rupture);
}

TEST(LineBending, isBentToTheOtherSideAsABarIs)
{
  // Perfectly plastic, to and fro: the moment changes by twice its limit over 2 M / k, and every
  // half cycle takes M times its angle beyond that.
  LineSetup setup = barOf(2);
  setup.section.yieldStress = yieldStress;
  LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  const Real elastic = 2 * plasticMoment / (modulus * secondMoment / (length / 2));
  Real angle = 0, lost = 0;
  for (const Real to : {0.4, -0.3, 0.2})
  {
    const Real from = angle;
    lead(line, hosts, setup, 1000,
         [&](const Vec3& x, Real part) { return knee(x, from + part * (to - from)); });
    lost += plasticMoment * (std::abs(to - from) - (from == 0 ? elastic / 2 : elastic));
    angle = to;
    EXPECT_NEAR(line.points()[1].moment.z, std::copysign(plasticMoment, to - from),
                1e-9 * plasticMoment);
    EXPECT_NEAR(line.energy().plastic, lost, 1e-6 * lost);
  }
}

TEST(LineBending, isBentToTheOtherSideAlsoWhereItMissesStraightByAHair)
{
  const Real elastic = plasticMoment / (modulus * secondMoment / (length / 2));
  for (const Real aside : {0.0, 1e-6, 1e-4, 1e-3})
    for (const int steps : {20, 1000, 20000})
    {
      LineSetup setup = barOf(2);
      setup.section.yieldStress = yieldStress;
      LineHosts hosts = hostsOf(setup);
      Line line = installed(setup, hosts);
      const auto bent = [&](Real angle) {
        return [=](const Vec3& x, Real) { return knee(x, angle) + Vec3{0, 0, aside * x.x * x.x}; };
      };
      Real last = 0;
      for (const Real to : {0.3, -0.2})
      {
        lead(line, hosts, setup, steps,
             [&](const Vec3& x, Real part) { return bent(last + part * (to - last))(x, part); });
        last = to;
      }
      EXPECT_NEAR(line.points()[1].moment.z, -plasticMoment, 0.02 * plasticMoment)
          << aside << " " << steps;
      // What it misses straight by, twice, is taken for bent.
      const Real lost = plasticMoment * (0.3 - elastic + 0.5 - 2 * elastic);
      EXPECT_NEAR(line.energy().plastic, lost, plasticMoment * (3 * aside + 0.01 / steps))
          << aside << " " << steps;
      EXPECT_NEAR(line.energy().remainder(), 0, plasticMoment * 0.5 / steps + 1e-9)
          << aside << " " << steps;
    }
}

TEST(LineBending, anElasticBarThatWhirlsResistsAlongItsAngle)
{
  LineSetup setup = barOf(2);
  LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  for (const Real tilt : {1e-4, 0.005, 0.05})
    for (int step = 1; step <= 40; ++step)
    {
      hosts.x[2] = hosts.x[1] +
                   turnedBy(knee({1, 0, 0}, tilt) - knee({0.5, 0, 0}, tilt), {1, 0, 0}, 0.3 * step);
      line.advance(hosts, step, 1, 0);
      const Real exact = tilt * modulus * secondMoment / (length / 2);
      const Vec3 moment = line.points()[1].moment;
      EXPECT_LT(norm(moment - turnedBy({0, 0, exact}, {1, 0, 0}, 0.3 * step)), 1e-6 * exact)
          << tilt << " " << step;
    }
}

TEST(LineBending, whatATornBarStoredInBendingIsRupture)
{
  LineSetup setup = barOf(2);
  setup.section.yieldStress = yieldStress;
  setup.section.ruptureStrain = 0.1;
  LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  const Real elastic = plasticMoment / (modulus * secondMoment / (length / 2));
  lead(line, hosts, setup, 100,
       [&](const Vec3& x, Real part) { return knee(x, 0.5 * elastic * part); });
  const LineEnergy before = line.energy();
  const Real bending = before.stored;
  ASSERT_NEAR(bending, 0.125 * plasticMoment * elastic, 1e-6 * bending);
  // Both segments tear in one step, and were not pulled before.
  lead(line, hosts, setup, 1, [&](const Vec3& x, Real) { return 1.2 * knee(x, 0.5 * elastic); });
  EXPECT_EQ(line.broken(), 2);
  EXPECT_EQ(norm(line.points()[1].moment), 0);
  EXPECT_EQ(line.energy().plastic, 0);
  EXPECT_NEAR(line.energy().rupture, bending, 1e-6 * bending);
  EXPECT_NEAR(line.energy().remainder(), before.remainder(), 1e-9 * bending);
}

TEST(LineBending, aKinkAtTheStartIsFreeAndTurnsFreelyAboutItsBar)
{
  LineSetup setup = barOf(2);
  for (LinePoint& point : setup.points)
    point.place = knee(point.place, 0.5);
  LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  for (int step = 1; step <= 50; ++step)
  {
    hosts.x[2] = setup.points[1].place +
                 turnedBy(setup.points[2].place - setup.points[1].place, {1, 0, 0}, 0.06 * step);
    line.advance(hosts, step, 1, 0);
    EXPECT_LT(norm(line.points()[1].moment), 1e-9 * plasticMoment);
  }
  // Opened by 0.01 rad it has the moment of that, about the axis that it has now.
  hosts.x[2] = setup.points[1].place +
               turnedBy(knee({1, 0, 0}, 0.51) - knee({0.5, 0, 0}, 0.51), {1, 0, 0}, 0.06 * 50);
  line.advance(hosts, 51, 1, 0);
  const Real exact = 0.01 * modulus * secondMoment / (length / 2);
  EXPECT_NEAR(norm(line.points()[1].moment), exact, 1e-9 * exact);
}

TEST(LineBending, isNoStifferThanItsBound)
{
  LineSetup setup = barOf(6);
  setup.mirrored = {true, false};
  const LineHosts hosts = hostsOf(setup);
  const Line line = installed(setup, hosts);
  std::vector<Real> rows(hosts.x.size(), 0);
  for (std::size_t j = 0; j < hosts.x.size(); ++j)
  {
    Line moved = line;
    LineHosts there = hosts;
    there.x[j].z += 1e-9;
    moved.advance(there, 1, 1, 0);
    for (std::size_t i = 0; i < hosts.x.size(); ++i)
      rows[i] += std::abs(moved.forces()[i].z) / 1e-9;
  }
  LineSetup straight = setup;
  straight.section.diameter = 0;
  const Line without = installed(straight, hosts);
  for (std::size_t i = 0; i < rows.size(); ++i)
    EXPECT_LE(rows[i], 1.001 * (line.stiffness()[i] - without.stiffness()[i]));
  EXPECT_GT(rows[3], 0.9 * (line.stiffness()[3] - without.stiffness()[3]));
}

TEST(LineBending, withAMomentNearStraightIsNoStifferThanItsBoundAcross)
{
  LineSetup setup = barOf(2);
  setup.section.yieldStress = 3 * yieldStress;
  LineHosts hosts = hostsOf(setup);
  Line line = installed(setup, hosts);
  Real last = 0;
  for (const Real to : {1.0, 0.012})
  {
    lead(line, hosts, setup, 200,
         [&](const Vec3& x, Real part) { return knee(x, last + part * (to - last)); });
    last = to;
  }
  const Real elastic = modulus * secondMoment / (length / 2);
  ASSERT_GT(norm(line.points()[1].moment), 5 * elastic * last); // as stiff as a longer lever
  constexpr Real way = 1e-7;
  Line moved = line;
  LineHosts there = hosts;
  there.x[2].z += way;
  moved.advance(there, 1, 1, 0);
  LineSetup thin = setup;
  thin.section.diameter = 0;
  Line without = installed(thin, hostsOf(thin));
  without.advance(hosts, 1, 1, 0);
  Real row = 0;
  for (std::size_t i = 0; i < 3; ++i)
    row += std::abs(moved.forces()[i].z - line.forces()[i].z) / way;
  const Real bound = line.stiffness()[2] - without.stiffness()[2];
  EXPECT_LE(row, 1.001 * bound);
  EXPECT_GT(row, 0.5 * bound);
}
} // namespace coplane
