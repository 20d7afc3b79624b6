// Pairs side by side get the bits that each would get alone, whatever shares its lanes.
#include "FacePairs.hpp"

#include <coplane_contact/NearPairs.hpp>
#include <coplane_contact/detail/FacePairLanes.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <numeric>
#include <random>
#include <vector>

namespace coplane
{
namespace
{
using namespace facepairs;

constexpr Real dt = 1e-3;
constexpr std::size_t lawsInUse = 11; ///< of someLaws()

/// Pairs of all kinds: triangles and quadrilaterals, plane and warped and folded, or segments,
/// apart, touching, aligned to the last bit, new, old, bonded, on uneven gaps.
template <int Dim>
struct PairTable
{
  std::vector<FaceNodes> nodes;
  std::vector<Plane> planes;

  explicit PairTable(int count, unsigned seed)
  {
    constexpr Real z = Dim == 2 ? 0 : 1;
    std::mt19937 random(seed);
    std::uniform_real_distribution<Real> u(-1, 1);
    for (int p = 0; p < count; ++p)
    {
      const Real warps[] = {0, 0, 1e-15, .02, .2, 3};
      RandomPair pair =
          Dim == 2 ? randomSegments(random, 5) : randomPair(random, warps[random() % 6], 5);
      if (random() % 4 == 0) // the same outline
      {
        pair.b.count = pair.a.count;
        for (int i = 0; i < pair.a.count; ++i)
          pair.b.x[i] = pair.a.x[pair.a.count - 1 - i];
      }
      if (random() % 8 == 0) // apart
        for (int i = 0; i < pair.b.count; ++i)
          pair.b.x[i] = pair.b.x[i] + Vec3{3, 3, 3 * z};
      Plane plane;
      plane.face[0] = random() % 20 == 0 ? -1 : 2 * p;
      plane.face[1] = 2 * p + 1;
      plane.state = random() % 3 != 0 ? PlaneState::Open : PlaneState::Slot;
      plane.sighting = random() % 2 == 0 ? Sighting::New : Sighting::Known;
      plane.declared = random() % 5 == 0;
      plane.history.bonded = random() % 5 == 0;
      plane.joint = std::uint16_t(random() % lawsInUse);
      plane.offset = .05 * u(random);
      plane.normal = normalised(Vec3{u(random), u(random), z * u(random)});
      plane.depthLimit = random() % 2 == 0 ? 1 : .2F;
      plane.pairing = Pairing(random() % 5);
      plane.turns = std::uint8_t(random());
      plane.exits = std::uint8_t(plane.turns & random());
      plane.covered = std::uint8_t(random() & random() & random());
      plane.seams = std::uint8_t(random() & random() & ~plane.turns);
      if (p % 16 == 7) // beside each other, and deep in what they share
      {
        const Vec3 along = pair.a.x[1] - pair.a.x[0];
        pair.b.count = pair.a.count;
        for (int i = 0; i < pair.a.count; ++i)
          pair.b.x[i] = pair.a.x[pair.a.count - 1 - i] + (1 - 1e-5 * (p % 1000)) * along;
        plane.offset = .02;
        plane.depthLimit = 1;
        plane.exits = plane.turns = 0xFF;
      }
      plane.fit.normalStiffness = 10;
      plane.fit.shearStiffness = 5;
      plane.fit.stiffnessCap = 100;
      if (random() % 2 == 0)
      {
        plane.area = .5;
        plane.history.shearTraction =
            cross(plane.normal, Vec3{z * u(random), z * u(random), u(random)});
      }
      if (random() % 5 == 0)
        for (int f = 0; f < 2; ++f)
          plane.layOn(f, {.02 * u(random), {.05 * u(random), .05 * u(random)}});
      planes.push_back(plane);
      nodes.push_back(pair.a);
      nodes.push_back(pair.b);
    }
  }

  std::vector<HalfStepFace> faces(const ContactOptions& o) const
  {
    std::vector<HalfStepFace> result;
    for (const FaceNodes& face : nodes)
      result.push_back(o.forces == ContactOptions::Forces::Potential
                           ? stepA_faceAtEnd<Dim>(face)
                           : stepA_halfStepFace<Dim>(face, dt));
    return result;
  }

  void move()
  {
    for (FaceNodes& face : nodes)
      for (int i = 0; i < face.count; ++i)
        face.x[i] += dt * face.v[i];
  }
};

/// The third is a bond that resists bending and breaks here and there, then come five that are
/// crushed: by compression, by shear more than by that, with dilation, and the first two with loss
/// of stiffness. The last three dilate: dry, bonded, and brittle.
std::vector<JointLaw> someLaws()
{
  JointLaw law;
  law.friction = .3;
  law.curve.inverseMaximumClosure = .1;
  JointLaw other = law;
  other.dynamicFriction = .1;
  other.curve.inverseMaximumClosure = 10;
  JointLaw bent;
  bent.friction = .3;
  bent.bond = Bond::softening(Bond::Kind::Linear, 1, 1, .3, .3);
  bent.bond.resistsBending = true;
  JointLaw crushed;
  crushed.friction = .3;
  crushed.curve.crushing.strength = .3;
  crushed.curve.crushing.peak = .02;
  crushed.curve.crushing.length = .1;
  JointLaw sheared = crushed;
  sheared.friction = .8;
  sheared.curve.crushing.strength = 3;
  JointLaw lifted = sheared;
  lifted.dilation = .1;
  JointLaw softened = crushed, softenedByShear = sheared;
  softened.curve.crushing.loss = softenedByShear.curve.crushing.loss = .5;
  JointLaw dilating;
  dilating.friction = .5;
  dilating.dilation = .2;
  JointLaw bonded = dilating, brittle = dilating;
  bonded.bond = Bond::softening(Bond::Kind::Linear, .02, .02, .3, .3);
  brittle.bond.kind = Bond::Kind::Brittle;
  brittle.bond.tensileStrength = .01;
  brittle.cohesion = .01;
  const std::vector<JointLaw> all{law,      other,           bent,     crushed, sheared, lifted,
                                  softened, softenedByShear, dilating, bonded,  brittle};
  EXPECT_EQ(all.size(), lawsInUse);
  return all;
}

ContactOptions damped(ContactOptions o)
{
  o.dampNormal = .1;
  o.dampShear = .05;
  return o;
}

ContactOptions someOptions(ContactOptions::Area area, ContactOptions::Weights weights)
{
  return damped(options(area, weights));
}

bool sameBits(const Plane& a, const Plane& b)
{
  return std::memcmp(static_cast<const void*>(&a), static_cast<const void*>(&b), sizeof(Plane)) ==
         0;
}
/// Planes with the tables beside them that the lanes work on.
struct Slots
{
  explicit Slots(const std::vector<Plane>& of)
      : planes(of), places(of.size()), faces(of.size()), activity(of.size(), Activity::Awake)
  {
    for (std::size_t p = 0; p < of.size(); ++p)
      places[p] = &planes[p];
    for (std::size_t p = 0; p < of.size(); ++p)
      std::copy(of[p].face, of[p].face + 2, faces[p].face);
  }
  /// All that have faces, so many side by side in one piece.
  template <int Dim>
  void update(const std::vector<HalfStepFace>& halfStep, const std::vector<JointLaw>& laws,
              const ContactOptions& options, int atOnce = PairLanes<Dim>::atOnce)
  {
    const PairTables pairs{nullptr,     places.data(), faces.data(), activity.data(),
                           laws.data(), false,         &changed};
    NearPairs near;
    near.list(pairs, int(planes.size()), halfStep.size());
    const int count = int(near.slots().size());
    for (int first = 0; first < count; first += atOnce)
      PairLanes<Dim>(pairs, halfStep.data(), options, dt)
          .update(near.slots().data() + first, std::min(atOnce, count - first));
  }

  Slots(const Slots&) = delete; // places are of these planes

  std::vector<Plane> planes;
  std::vector<Plane*> places;
  std::vector<SlotFaces> faces;
  std::vector<Activity> activity;
  PassedOnChanges changed;
};
} // namespace

namespace
{
/// What the pairs of a run have been, in all cycles.
struct Seen
{
  int carrying = 0, irregular = 0, woken = 0, asleep = 0;
  int uneven = 0, byShear = 0, even = 0; ///< crushed
  int loaded = 0, begun = 0;             ///< on the curve that stiffens most
  int narrow = 0;                        ///< closed, and too narrow to carry
  int lifted = 0;                        ///< by slip of a dry joint
  int bent = 0, lagging = 0;             ///< forces within a step; after the end of a contact
};

template <int Dim>
Seen expectTheBitsOfOnePairAtATime(const ContactOptions& o)
{
  const std::vector<JointLaw> laws = someLaws();
  PairTable<Dim> table(3000, 21);
  std::vector<Plane> alone = table.planes;
  Slots together(table.planes);
  Seen seen;
  for (int cycle = 0; cycle < 15; ++cycle, table.move())
  {
    const std::vector<HalfStepFace> faces = table.faces(o);
    for (Plane& plane : alone)
      if (plane.face[0] >= 0)
      {
        const HalfStepFace &a = faces[plane.face[0]], &b = faces[plane.face[1]];
        const bool wasUneven = plane.crushedUnevenly, carried = plane.area > 0;
        const Real most = plane.history.maximumClosure, offset = plane.offset;
        updateByForces<Dim>(plane, a, b, laws[plane.joint], o, dt);
        EXPECT_TRUE(std::isfinite(norm(plane.forceOn(0))) && std::isfinite(plane.stored));
        seen.carrying += plane.area > 0;
        (carried ? seen.loaded : seen.begun) +=
            plane.joint == 1 && plane.history.maximumClosure > most && plane.area > 0;
        seen.narrow += plane.isBorn() && plane.area == 0 && plane.overlap > 0 &&
                       plane.closure > 0 && plane.exits != 0 && !plane.isRefused();
        seen.lifted += carried && plane.joint >= 8 && !plane.history.bonded &&
                       plane.state == PlaneState::Slip && plane.offset > offset;
        seen.bent += plane.planned != 0;
        seen.lagging += plane.lags;
        seen.uneven += plane.crushedUnevenly;
        seen.byShear += plane.crushedUnevenly && !wasUneven && plane.crushing().along[0] == 0 &&
                        plane.crushing().along[1] == 0;
        seen.even +=
            laws[plane.joint].crushesUnevenly() && !plane.crushedUnevenly && plane.area > 0;
        const TrialPlane trial = stepB_trialPointOfContact<Dim>(a, b);
        seen.irregular += Dim == 3 && trial.opposed &&
                          !isConvex(stepC_projectOntoPlane<Dim>(trial, a, dt).p, a.count);
      }
    const std::vector<Activity> before = together.activity;
    together.update<Dim>(faces, laws, o);
    for (std::size_t p = 0; p < alone.size(); ++p)
    {
      if (!sameBits(alone[p], together.planes[p]))
      {
        ADD_FAILURE() << p << " in cycle " << cycle;
        return seen;
      }
      seen.woken += before[p] == Activity::Asleep && together.activity[p] != Activity::Asleep;
    }
  }
  seen.asleep =
      int(std::count(together.activity.begin(), together.activity.end(), Activity::Asleep));
  return seen;
}

std::vector<ContactOptions> allOptions()
{
  std::vector<ContactOptions> all;
  for (const auto area : allAreas)
    for (const auto weights : allWeights)
      all.push_back(someOptions(area, weights));
  all.push_back(ContactOptions{}); // the potential
  all.push_back(damped(ContactOptions{}));
  all.back().followsPath = true;
  all.push_back(damped(ContactOptions{}));
  return all;
}

void expectBentForces(const Seen& seen, const ContactOptions& o)
{
  EXPECT_EQ(seen.bent > 100, o.followsPath) << seen.bent;
  EXPECT_EQ(seen.lagging > 10, o.followsPath) << seen.lagging;
}

void expectCrushing(const Seen& seen)
{
  EXPECT_GT(seen.uneven, 1000);
  EXPECT_GT(seen.byShear, 20);
  EXPECT_GT(seen.loaded, 100);
  EXPECT_GT(seen.begun, 20);
  EXPECT_GT(seen.even, 1000);
  EXPECT_GT(seen.lifted, 200);
}
} // namespace

TEST(PairLanes, haveTheBitsOfOnePairAtATime)
{
  for (const ContactOptions& o : allOptions())
  {
    const Seen seen = expectTheBitsOfOnePairAtATime<3>(o);
    expectBentForces(seen, o);
    EXPECT_GT(seen.asleep, 300);
    EXPECT_GT(seen.woken, 5);
    EXPECT_GT(seen.carrying, 5000);
    EXPECT_GT(seen.irregular, 100);
    if (o.forces != ContactOptions::Forces::Potential)
      continue;
    expectCrushing(seen);
    EXPECT_GT(seen.narrow, 100);
  }
}

TEST(PairLanes, haveTheBitsOfOnePairAtATimeInTwoDimensions)
{
  for (const ContactOptions& o : allOptions())
  {
    const Seen seen = expectTheBitsOfOnePairAtATime<2>(o);
    expectBentForces(seen, o);
    EXPECT_GT(seen.asleep, 100);
    EXPECT_GT(seen.carrying, 5000);
    if (o.forces == ContactOptions::Forces::Potential)
      expectCrushing(seen);
  }
}

namespace
{
template <int Dim>
void expectTheSameInAnotherOrder(const ContactOptions& o)
{
  const std::vector<JointLaw> laws = someLaws();
  PairTable<Dim> table(2000, 5);
  const std::vector<HalfStepFace> faces = table.faces(o);
  std::vector<int> order(table.planes.size());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  std::vector<Plane> inAnotherOrder;
  for (const int p : order)
    inAnotherOrder.push_back(table.planes[p]);
  Slots sorted(table.planes), shuffled(inAnotherOrder);
  sorted.update<Dim>(faces, laws, o);
  shuffled.update<Dim>(faces, laws, o, 7);
  for (std::size_t i = 0; i < order.size(); ++i)
    ASSERT_TRUE(sameBits(sorted.planes[order[i]], shuffled.planes[i])) << order[i];
}
} // namespace

TEST(PairLanes, doNotDependOnTheirNeighbours)
{
  for (const ContactOptions& o :
       {damped(ContactOptions{}),
        someOptions(ContactOptions::Area::Penetrating, ContactOptions::Weights::Pressure)})
  {
    expectTheSameInAnotherOrder<3>(o);
    expectTheSameInAnotherOrder<2>(o);
  }
}

TEST(StepA_HalfStepFaces, haveTheBitsOfOneFaceAtATime)
{
  std::mt19937 random(11);
  for (int n = 0; n < 500; ++n)
  {
    FaceNodes faces[laneCount];
    for (FaceNodes& face : faces)
    {
      do
        face = randomPair(random, .2).a;
      while (face.count != 3 + n % 2);
      if (random() % 10 == 0)
        face.x[1] = face.x[2] = face.x[0]; // degenerate
    }
    FaceNodesOf<Lanes> together;
    together.count = faces[0].count;
    together.mass = branchFree::gathered<Lanes>([&](int i) { return faces[i].mass; });
    const auto vector = [&](const auto& get) -> Vec3Of<Lanes>
    {
      const auto each = [&](int k)
      { return branchFree::gathered<Lanes>([&](int i) { return get(faces[i])[k]; }); };
      return {each(0), each(1), each(2)};
    };
    for (int k = 0; k < together.count; ++k)
    {
      together.x[k] = vector([&](const FaceNodes& f) { return f.x[k]; });
      together.v[k] = vector([&](const FaceNodes& f) { return f.v[k]; });
    }
    HalfStepFace result[laneCount], *to[laneCount];
    for (int i = 0; i < laneCount; ++i)
      to[i] = &result[i];
    stepA_faces(together, ContactOptions::Forces::CommonNormal, dt, to);
    const auto same = [](const Vec3& a, const Vec3& b)
    { return a.x == b.x && a.y == b.y && a.z == b.z; };
    for (int i = 0; i < laneCount; ++i)
    {
      const HalfStepFace one = stepA_halfStepFace<3>(faces[i], dt);
      EXPECT_TRUE(same(one.center, result[i].center) && same(one.normal, result[i].normal) &&
                  same(one.spin, result[i].spin) && one.area == result[i].area &&
                  one.massPerArea == result[i].massPerArea);
      for (int k = 0; k < one.count; ++k)
        EXPECT_TRUE(same(one.x[k], result[i].x[k]) && same(one.v[k], result[i].v[k]));
    }
  }
}
} // namespace coplane
