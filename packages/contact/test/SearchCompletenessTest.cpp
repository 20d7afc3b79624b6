#include "FaceClouds.hpp"

// Which pairs of faces may touch must depend neither on the bins nor on the ranks nor on the
// threads: the search finds what brute force finds.

namespace coplane::testing
{
namespace
{
void expectBruteForce(const Scene& scene, const CandidateRules& rules, std::size_t atLeast = 100)
{
  const Comm comm;
  const Pairs all = bruteForce(scene, rules);
  ASSERT_GE(all.size(), atLeast) << "the scene must have pairs to find";
  const RankPart part(scene, comm);
  const Pairs expected = concerning(all, part);
  for (const Real binScale : {1.0, 0.5, 2.0})
    EXPECT_EQ(search(scene, part, rules, comm, binScale).pairs, expected)
        << "bins of " << binScale << " times the usual size";
}

/// Heaps of faces at places far apart [m].
std::function<Vec3(Random&)> heaps(Real extent, Real size)
{
  return [=](Random& random)
  {
    std::normal_distribution<Real> normal;
    const auto at = std::uint64_t(20 * unit(random));
    const auto place = [&](std::uint64_t what)
    { return extent * (Real(mix(what)) / 0x1p64 - 0.5); };
    const Real dx = normal(random), dy = normal(random), dz = normal(random);
    return Vec3{place(at), place(at + 100), place(at + 200)} + size * Vec3{dx, dy, dz};
  };
}
} // namespace

TEST(SearchCompleteness, twoThousandSquaresAtRandom)
{
  expectBruteForce(Cloud{}.make(), rulesWithSkin(0.02));
}

TEST(SearchCompleteness, twoThousandSegmentsAtRandom)
{
  Cloud cloud;
  cloud.dimension = 2;
  cloud.side = 0.03;
  expectBruteForce(cloud.make(), rulesWithSkin(0.005));
}

TEST(SearchCompleteness, trianglesAndQuadrilaterals)
{
  Cloud cloud;
  cloud.corners = [](Random& random) { return unit(random) < 0.5 ? 3 : 4; };
  expectBruteForce(cloud.make(), rulesWithSkin(0.02));
}

TEST(SearchCompleteness, clustersFarApart)
{
  // Twenty heaps of size 0.05 in a box of 100: bins as large as a face would number 10^11.
  Cloud cloud;
  cloud.side = 0.02;
  cloud.middle = heaps(100, 0.05);
  expectBruteForce(cloud.make(), rulesWithSkin(0.004));
}

TEST(SearchCompleteness, clustersSoFarApartThatKeysOfBinsRepeat)
{
  // An axis has 2^19 keys; here it has 10^8 bins.
  Cloud cloud;
  cloud.count = 1000;
  cloud.side = 0.02;
  cloud.middle = heaps(1e7, 0.05);
  expectBruteForce(cloud.make(), rulesWithSkin(0.004));
}

TEST(SearchCompleteness, fewFacesHaveFlownAway)
{
  Scene scene = Cloud{1000}.make();
  for (int f = 0; f < 10; ++f)
    for (int k = 0; k < 4; ++k)
      scene.x[4 * (100 * f) + k] += std::pow(10.0, f) * Vec3{1, -2, 0.5};
  expectBruteForce(scene, rulesWithSkin(0.02));
}

TEST(SearchCompleteness, oneFaceAsLargeAsTheDomain)
{
  Scene scene = Cloud{1000}.make();
  scene.add(faceId(100000, 0), {0.5, 0.5, 0.5}, {0, 0, 1}, 1.5);
  scene.sortById();
  expectBruteForce(scene, rulesWithSkin(0.02));
}

TEST(SearchCompleteness, sizesThatDifferAThousandTimes)
{
  Cloud cloud;
  cloud.side = 0.05;
  cloud.variation = 1000;
  expectBruteForce(cloud.make(), rulesWithSkin(0.001));
  cloud.dimension = 2;
  expectBruteForce(cloud.make(), rulesWithSkin(0.001));
}

TEST(SearchCompleteness, flatDomain)
{
  // All faces lie in one plane, half of them looking up and half down: no extent along z.
  Scene scene;
  Random random(3);
  for (int i = 0; i < 1000; ++i)
  {
    const Real x = unit(random), y = unit(random);
    scene.add(faceId(i, 0), {x, y, 0.25}, {0, 0, i % 2 ? 1.0 : -1.0}, 0.04);
  }
  expectBruteForce(scene, rulesWithSkin(0.01));
}

TEST(SearchCompleteness, farFromTheOriginAndSearchedAgainAfterMotion)
{
  Scene scene = Cloud{1000}.make();
  Random random(4);
  std::normal_distribution<Real> normal;
  for (Vec3& x : scene.x)
    x += Vec3{1000, -2000, 500};
  for (int search = 0; search < 3; ++search)
  {
    expectBruteForce(scene, rulesWithSkin(0.02));
    for (std::size_t f = 0; 4 * f < scene.x.size(); ++f)
    {
      const Vec3 step = 0.05 * Vec3{normal(random), normal(random), normal(random)};
      for (int k = 0; k < 4; ++k)
        scene.x[4 * f + k] += step;
    }
  }
}

TEST(SearchCompleteness, reachLargerThanTheFaces)
{
  // Bodies that lie deep in each other: boxes grow by more than a face, the skin stays thin.
  CandidateRules rules = rulesWithSkin(0.01);
  rules.reach = 0.25;
  expectBruteForce(Cloud{1000}.make(), rules);
}

TEST(SearchCompleteness, thousandSmallCloudsOfAllKinds)
{
  // Size, shape, spread, directions and groups at random; some faces have no extent, some share a
  // node.
  const Comm comm;
  Random random(6);
  std::size_t pairs = 0;
  for (int c = 0; c < 1000; ++c)
  {
    Cloud cloud;
    cloud.seed = unsigned(c);
    cloud.count = 2 + int(40 * unit(random));
    cloud.dimension = unit(random) < 0.3 ? 2 : 3;
    cloud.side = std::pow(10.0, -1.2 * unit(random));
    cloud.variation = std::pow(10.0, 6 * unit(random) * unit(random));
    const Vec3 spread{1, unit(random) < 0.3 ? 0.0 : unit(random), unit(random) < 0.3 ? 0.0 : 1.0};
    const Vec3 middle = std::pow(10.0, 6 * unit(random)) * Vec3{unit(random), -0.5, 0.25};
    cloud.middle = [&](Random& r)
    {
      const Real x = unit(r), y = unit(r), z = unit(r);
      return middle + Vec3{spread.x * x, spread.y * y, spread.z * z};
    };
    cloud.corners = [](Random& r) { return unit(r) < 0.5 ? 3 : 4; };
    Scene scene = cloud.make();
    for (Face& face : scene.faces)
    {
      face.thickness = cloud.side * unit(random);
      face.group = int(4 * unit(random));
      if (unit(random) < 0.05)
        scene.x[face.nodes[1]] = scene.x[face.nodes[0]];
      if (unit(random) < 0.1)
        face.nodes[face.count - 1] = scene.faces[0].nodes[0];
    }
    CandidateRules rules = rulesWithSkin(cloud.side * unit(random));
    rules.reach *= 1 + std::floor(2 * unit(random));
    if (c % 2)
      rules.excluded = [](int a, int b) { return (a + b) % 3 == 0; };
    const RankPart part(scene, comm);
    const Pairs expected = concerning(bruteForce(scene, rules), part);
    const Real binScale = std::pow(2.0, std::floor(3 * unit(random)) - 1);
    ASSERT_EQ(search(scene, part, rules, comm, binScale).pairs, expected) << "cloud " << c;
    pairs += expected.size();
  }
  EXPECT_GE(comm.sum(std::int64_t(pairs)), 10000);
}

TEST(SearchCompleteness, noContactIsMissedUntilTheNextSearchIsForced)
{
  // A search is forced as soon as two nodes may have moved by more than skin/2 relative to each
  // other along an axis. Faces that move by up to skin/4 each, and then touch without any skin,
  // must have been candidates before, however deep they lie in each other. (Faces keep their
  // directions here.)
  Scene scene = Cloud{}.make();
  for (Face& face : scene.faces)
    face.thickness = 1;
  CandidateRules rules = rulesWithSkin(0.04);
  const Pairs before = bruteForce(scene, rules);
  Random random(5);
  std::uniform_real_distribution<Real> quarter(-0.25, 0.25);
  for (std::size_t f = 0; 4 * f < scene.x.size(); ++f)
  {
    const Real dx = quarter(random), dy = quarter(random), dz = quarter(random);
    for (int k = 0; k < 4; ++k)
      scene.x[4 * f + k] += rules.skin * Vec3{dx, dy, dz};
  }
  // No deeper than what was within the limit before.
  rules.depthMax -= rules.skin;
  rules.skin = rules.reach = 0;
  const Pairs touching = bruteForce(scene, rules);
  ASSERT_GE(touching.size(), 100u);
  EXPECT_TRUE(std::includes(before.begin(), before.end(), touching.begin(), touching.end()));
}

TEST(SearchCompleteness, facesThatLieInEachOtherWithinTheLimitAreCandidates)
{
  // A corner of each on one line along the normal of the common plane, at any depth up to the
  // limit, whatever the directions of opposed faces: no search before has to have seen them touch.
  Random random(8);
  std::normal_distribution<Real> normal;
  int tried = 0;
  for (int i = 0; i < 20000; ++i)
  {
    const int dimension = i % 2 ? 2 : 3;
    const auto direction = [&]
    {
      const Real x = normal(random), y = normal(random), z = normal(random);
      return normalised(Vec3{x, y, dimension == 2 ? 0 : z});
    };
    const Vec3 n0 = direction(), n1 = direction();
    CandidateRules rules = rulesWithSkin(0);
    if (!(dot(n0, n1) < -rules.cosOpposed))
      continue;
    Scene scene;
    scene.dimension = dimension;
    for (int f = 0; f < 2; ++f)
      scene.add(faceId(f, 0), {}, f == 0 ? n0 : n1, 0.2 + unit(random), 0.1 + unit(random));
    const Real depth = unit(random) * rules.depthMax *
                       std::min(scene.faces[0].thickness, scene.faces[1].thickness);
    const Vec3 arm = scene.x[0] - depth * normalised(n0 - n1) - scene.x[4];
    for (int k = 4; k < 8; ++k)
      scene.x[k] += arm;
    rules.reach = 1e-12;
    EXPECT_EQ(bruteForce(scene, rules).size(), 1u) << "pair " << i;
    ++tried;
  }
  EXPECT_GE(tried, 5000);
}

TEST(SearchCompleteness, ranksWithoutFaces)
{
  const Comm comm;
  Cloud cloud;
  cloud.count = 300;
  cloud.side = 0.2;
  const Scene scene = cloud.make();
  const CandidateRules rules = rulesWithSkin(0.02);
  const Pairs all = bruteForce(scene, rules);
  const RankPart part(scene, comm, [](int) { return 0; }); // everything belongs to rank 0
  EXPECT_EQ(search(scene, part, rules, comm).pairs, comm.isRoot() ? all : Pairs{});
}

TEST(SearchCompleteness, nothingAtAll)
{
  const Comm comm;
  EXPECT_TRUE(search({}, RankPart({}, comm), rulesWithSkin(0.01), comm).pairs.empty());
}
} // namespace coplane::testing
