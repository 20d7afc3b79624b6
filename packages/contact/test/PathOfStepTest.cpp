// Forces that bend within a step: where faces meet, part, or pass a line of the mesh.
#include "BalancedForces.hpp"

namespace coplane
{
namespace
{
using namespace facepairs;

ContactOptions alongPath()
{
  ContactOptions o;
  o.followsPath = true;
  return o;
}

/// A face of four equal masses, or two, that flies against faces which stand still.
template <int Dim>
struct Flight
{
  FaceNodes moving;
  std::vector<FaceNodes> still;
  std::vector<PairPlane> planes;
  Real mass = 1; ///< of each node [kg]
  Real dt = 0;   ///< [s]
  Real unbalanced = 0;

  Vec3 drift() const
  {
    Vec3 sum{};
    for (int k = 0; k < moving.count; ++k)
      sum += moving.v[k];
    return (1.0 / moving.count) * sum;
  }
  Real kinetic() const
  {
    Real sum = 0;
    for (int k = 0; k < moving.count; ++k)
      sum += 0.5 * mass * dot(moving.v[k], moving.v[k]);
    return sum;
  }
  bool touches() const
  {
    return std::any_of(planes.begin(), planes.end(), [](const PairPlane& p) { return p.pushes(); });
  }
  void step(const ContactOptions& options)
  {
    for (int k = 0; k < moving.count; ++k)
      moving.x[k] += dt * moving.v[k];
    Vec3 impulse[4] = {};
    for (std::size_t p = 0; p < planes.size(); ++p)
    {
      updatePlane<Dim>(planes[p], still[p], moving, options, dt);
      const Resultant sum = resultant(still[p], moving, planes[p].nodal);
      Real size = 1e-300;
      for (int k = 0; k < moving.count; ++k)
        size = std::max(size, norm(planes[p].nodal[1][k]));
      unbalanced = std::max({unbalanced, norm(sum.force) / size, norm(sum.moment) / size});
      for (int k = 0; k < moving.count; ++k)
        impulse[k] += dt * planes[p].nodal[1][k];
    }
    for (int k = 0; k < moving.count; ++k)
      moving.v[k] += (1 / mass) * impulse[k];
  }
  /// Until it has come off.
  void bounce(const ContactOptions& options)
  {
    bool touched = false;
    for (int n = 0; n < 10000 && !(touched && !touches()); ++n)
    {
      step(options);
      touched = touched || touches();
    }
    EXPECT_TRUE(touched && !touches());
  }
};

/// A square, or a segment, that falls flat on another one, `phase` of a step before it touches.
template <int Dim>
Flight<Dim> flat(Real phase, Real omegaStep)
{
  Flight<Dim> flight;
  flight.dt = omegaStep / std::sqrt(1.0 / (Dim == 2 ? 2 : 4)); // stiffness 1, over all nodes
  const Real height = phase * flight.dt * 0.01;
  if (Dim == 2)
  {
    flight.still = {face({{2, 0, 0}, {-2, 0, 0}})};
    flight.moving = face({{0, height, 0}, {1, height, 0}}, {0, -0.01, 0});
  }
  else
  {
    flight.still = {face({{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}})};
    flight.moving =
        face({{0, 0, height}, {0, 1, height}, {1, 1, height}, {1, 0, height}}, {0, 0, -0.01});
  }
  flight.planes = {touchingPlane()};
  return flight;
}

/// The largest part of the energy that a flat impact changes, over all phases of the step.
template <int Dim>
Real lostFlat(Real omegaStep, const ContactOptions& options)
{
  Real most = 0;
  for (int n = 0; n < 20; ++n)
  {
    Flight<Dim> flight = flat<Dim>(0.025 + 0.05 * n, omegaStep);
    const Real before = flight.kinetic();
    flight.bounce(options);
    most = std::max(most, std::fabs(flight.kinetic() / before - 1));
    EXPECT_LE(flight.unbalanced, 1e-12);
  }
  return most;
}

template <int Dim>
void expectSmallerLosses()
{
  const Real coarse = lostFlat<Dim>(0.8, alongPath()), fine = lostFlat<Dim>(0.4, alongPath());
  EXPECT_LT(coarse, 0.12 * lostFlat<Dim>(0.8, {})); // of 0.1, the worst phase
  EXPECT_LT(fine, 0.02 * lostFlat<Dim>(0.4, {}));
  EXPECT_LT(fine, 0.06 * coarse); // of the fourth order
}

TEST(PathOfStep, blocksBounceWithTheEnergyThatTheyHad)
{
  expectSmallerLosses<2>();
  expectSmallerLosses<3>();
}

/// The largest part of the energy that changes when a square lands again, not quite level, on a
/// joint that it has crushed on one side before.
Real lostOnCrushed(const ContactOptions& options)
{
  Real most = 0;
  for (int n = 0; n < 20; ++n)
  {
    Flight<3> flight = flat<3>(0.5, 0.4);
    flight.moving = moved(flight.moving, rotation({0, 1, 0}, -0.005), {0, 0, 0.01});
    Crushing& crushing = flight.planes[0].law.curve.crushing;
    crushing.strength = 0.012;
    crushing.peak = 0.01;
    crushing.length = 0.05;
    crushing.shearWeight = 0;
    flight.bounce(options);
    EXPECT_TRUE(flight.planes[0].crushedUnevenly);
    for (int k = 0; k < flight.moving.count; ++k)
    {
      flight.moving.v[k] = {0, 0, -0.003};
      flight.moving.x[k].z += 0.05 * n * 0.003 * flight.dt;
    }
    const Real before = flight.kinetic(), crushed = flight.planes[0].hysteresisWork;
    flight.bounce(options);
    EXPECT_EQ(flight.planes[0].hysteresisWork, crushed);
    most = std::max(most, std::fabs(flight.kinetic() / before - 1));
  }
  return most;
}

TEST(PathOfStep, jointsThatAreCrushedGiveBackWhatTheyStore)
{
  const Real ends = lostOnCrushed({}), path = lostOnCrushed(alongPath());
  EXPECT_LT(path, 0.2 * ends);
}

/// A segment that lands with one end, aslant, beside a line of the mesh between two faces in one
/// plane, or on one face as long as both, and moves over the line while it bounces.
Flight<2> aslant(bool cut, Real speed)
{
  Flight<2> flight;
  flight.dt = 0.4;
  const Real c = std::cos(pi / 6), s = std::sin(pi / 6);
  flight.moving =
      face({{0.003, 0.0003, 0}, {0.003 + 0.4 * c, 0.0003 + 0.4 * s, 0}}, {-0.6 * speed, -speed, 0});
  if (cut)
    flight.still = {face({{0.4, 0, 0}, {0, 0, 0}}), face({{0, 0, 0}, {-0.4, 0, 0}})};
  else
    flight.still = {face({{0.4, 0, 0}, {-0.4, 0, 0}})};
  for (std::size_t p = 0; p < flight.still.size(); ++p)
  {
    flight.planes.push_back(touchingPlane(30));
    flight.planes.back().turns = 0b110000; // at both ends of the one that moves
  }
  return flight;
}

TEST(PathOfStep, aLineOfTheMeshIsPassedAsIfThereWereNone)
{
  Flight<2> cut = aslant(true, 0.001), whole = aslant(false, 0.001);
  const Real speed = norm(whole.drift());
  cut.bounce(alongPath());
  whole.bounce(alongPath());
  for (const PairPlane& plane : cut.planes)
    EXPECT_GT(plane.birthArea[0], 0) << "has touched";
  EXPECT_LE(norm(cut.drift() - whole.drift()), 1e-4 * speed);
  EXPECT_LE(cut.unbalanced, 1e-12);
}

/// Pairs in random attitudes that pass through kinks: forces sum to nothing, also those that come
/// after the end.
template <int Dim>
void expectBalance()
{
  std::mt19937 random(5);
  int made = 0, after = 0;
  for (int n = 0; n < 300; ++n)
  {
    RandomPair pair = Dim == 2 ? randomSegments(random, 0.05) : randomPair(random, 0.02, 0.05);
    PairPlane plane = touchingPlane(), other = plane;
    for (int cycle = 0; cycle < 20; ++cycle)
    {
      for (FaceNodes* f : {&pair.a, &pair.b})
        for (int k = 0; k < f->count; ++k)
          f->x[k] += f->v[k];
      updatePlane<Dim>(plane, pair.a, pair.b, alongPath(), 1);
      updatePlane<Dim>(other, pair.a, pair.b, {}, 1);
      if (plane.pushes())
        expectBalanced(pair, plane.nodal);
      made += plane.area > 0 && norm(plane.nodal[0][0] - other.nodal[0][0]) > 0;
      after += plane.lags;
      EXPECT_EQ(plane.stored, other.stored);
    }
  }
  EXPECT_GT(made, 100);
  EXPECT_GT(after, 10);
}

TEST(PathOfStep, forcesSumToNothing)
{
  expectBalance<2>();
  expectBalance<3>();
}

TEST(PathOfStep, whatMovesEvenlyHasTheForcesOfTheEnds)
{
  // Pressed and slid within a face: the energy is the square of the closure all along the path.
  PairPlane plane = touchingPlane(), other = plane;
  FaceNodes below = face({{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}});
  for (int n = 1; n < 10; ++n)
  {
    const FaceNodes above = moved(squareAbove(0.01 * n, {0.02, 0.01, -0.01}),
                                  rotation({0, 0, 1}, 0), {0.02 * n, 0.01 * n, 0});
    updatePlane<3>(plane, below, above, alongPath(), 1);
    updatePlane<3>(other, below, above, {}, 1);
    for (int f = 0; f < 2 && n > 2; ++f) // what makes up for the beginning has worked
      for (int k = 0; k < 4; ++k)
        EXPECT_EQ(norm(plane.nodal[f][k] - other.nodal[f][k]), 0) << n;
  }
}
} // namespace
} // namespace coplane
