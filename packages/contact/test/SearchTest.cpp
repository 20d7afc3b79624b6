#include <coplane_contact/Search.hpp>
#include <coplane_core/StateHash.hpp>
#include <coplane_mesh/ElementTopology.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <random>
#include <set>

// Steps 1 to 5 against brute force: which pairs of faces may touch must depend neither on the bins
// nor on the ranks. Every rank makes the whole scene from one seed and then keeps only what it
// would own in a run; what it does not know is NaN, so that any use of it shows.

namespace coplane
{
namespace
{
using Pair = std::pair<GlobalId, GlobalId>;
using Pairs = std::set<Pair>;

constexpr Real unknown = std::numeric_limits<Real>::quiet_NaN();

/// Faces with four nodes of their own each; node 4f + k is corner k of face f.
struct Scene
{
  int dimension = 3;
  std::vector<Vec3> x;
  std::vector<Face> faces; ///< sorted by id

  /// A square with its middle, its normal's direction and its side [m]; segments in 2D.
  void add(GlobalId id, const Vec3& middle, const Vec3& normal, Real side, Real thickness = 10)
  {
    Face face;
    face.id = id;
    face.count = dimension == 2 ? 2 : 4;
    face.thickness = thickness;
    face.modulus = 1;
    const Vec3 n = normalised(normal);
    // In the plane z = 0 the outward normal of a segment lies on the right of its direction.
    const Vec3 any = dimension == 2        ? Vec3{0, 0, 1}
                     : std::abs(n.x) < 0.6 ? Vec3{1, 0, 0}
                                           : Vec3{0, 1, 0};
    const Vec3 e1 = normalised(cross(any, n)), e2 = cross(n, e1);
    const Real h = 0.5 * side;
    const std::vector<Vec3> corners =
        dimension == 2 ? std::vector<Vec3>{middle - h * e1, middle + h * e1}
                       : std::vector<Vec3>{middle - h * e1 - h * e2, middle + h * e1 - h * e2,
                                           middle + h * e1 + h * e2, middle - h * e1 + h * e2};
    for (int k = 0; k < face.count; ++k)
    {
      face.nodes[k] = int(x.size());
      x.push_back(corners[k]);
    }
    faces.push_back(face);
  }

  void sortById()
  {
    std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.id < b.id; });
  }
};

/// `count` squares (segments in 2D) with directions at random, ids in no order of place; `middleOf`
/// gives their places.
template <class MiddleOf>
Scene randomScene(int count, int dimension, Real side, unsigned seed, MiddleOf middleOf)
{
  std::mt19937_64 random(seed);
  std::normal_distribution<Real> normal;
  std::uniform_real_distribution<Real> unit(0, 1);
  std::vector<int> elements(count);
  for (int i = 0; i < count; ++i)
    elements[i] = i / 2; // two faces of each element: they must not pair
  std::shuffle(elements.begin(), elements.end(), random);
  std::map<int, int> sides;
  Scene scene;
  scene.dimension = dimension;
  for (int i = 0; i < count; ++i)
  {
    const Vec3 direction{normal(random), normal(random), dimension == 2 ? 0 : normal(random)};
    const Vec3 middle = middleOf(random);
    scene.add(faceId(elements[i], sides[elements[i]]++), middle, direction,
              side * (0.5 + unit(random)));
  }
  scene.sortById();
  return scene;
}

Scene uniformScene(int count = 2000, int dimension = 3, Real side = 0.1)
{
  std::uniform_real_distribution<Real> unit(0, 1);
  return randomScene(count, dimension, side, 1,
                     [&](auto& random) mutable
                     {
                       const Real x = unit(random), y = unit(random), z = unit(random);
                       return Vec3{x, y, dimension == 2 ? 0 : z};
                     });
}

NodeVectors positions(const Scene& scene)
{
  NodeVectors x("x", scene.x.size());
  for (int n = 0; n < int(scene.x.size()); ++n)
    set(x, n, scene.x[n]);
  return x;
}

Box grownBox(const Face& face, const NodeVectors& x, Real skin)
{
  Box box;
  for (int k = 0; k < face.count; ++k)
    box.include(at(x, face.nodes[k]));
  box.grow(0.5 * skin);
  return box;
}

/// Every pair judged, without bins or ranks.
Pairs bruteForce(const Scene& scene, const CandidateRules& rules)
{
  std::vector<Face> faces = scene.faces;
  for (Face& face : faces)
    face.local = true;
  const NodeVectors x = positions(scene);
  std::vector<Box> boxes;
  for (const Face& face : faces)
    boxes.push_back(grownBox(face, x, rules.skin));
  Pairs pairs;
  for (std::size_t p = 0; p < faces.size(); ++p)
    for (std::size_t q = p + 1; q < faces.size(); ++q)
      if (judgePair(faces[p], faces[q], boxes[p], boxes[q], facePlane(faces[p], x, scene.dimension),
                    facePlane(faces[q], x, scene.dimension), x, rules) == Verdict::Candidate)
        pairs.insert({faces[p].id, faces[q].id});
  return pairs;
}

/// Owner of a node: faces mostly stay together, but every tenth has its nodes all over the ranks.
int ownerOf(int node, const Comm& comm)
{
  const std::uint64_t face = node / 4;
  return int(mix(mix(face) % 10 == 0 ? std::uint64_t(node) + 77777 : face) % comm.size());
}

/// One rank's part of a scene. Numbers of nodes are those of the scene.
struct RankPart
{
  std::vector<Face> faces;
  NodeVectors x;
  std::vector<GlobalId> nodeIds;

  RankPart(const Scene& scene, const Comm& comm, bool onlyRank0 = false)
      : x("x", scene.x.size()), nodeIds(scene.x.size())
  {
    const auto owner = [&](int node) { return onlyRank0 ? 0 : ownerOf(node, comm); };
    for (int n = 0; n < int(scene.x.size()); ++n)
    {
      nodeIds[n] = n;
      set(x, n, {unknown, unknown, unknown});
    }
    for (Face face : scene.faces)
    {
      for (int k = 0; k < face.count; ++k)
        face.local = face.local || owner(face.nodes[k]) == comm.rank();
      if (!face.local)
        continue;
      face.ownedHere = owner(face.nodes[0]) == comm.rank(); // the node with the lowest id
      for (int k = 0; k < face.count; ++k)
        set(x, face.nodes[k], scene.x[face.nodes[k]]);
      faces.push_back(face);
    }
  }
};

struct Found
{
  Pairs pairs;
  Ghosts ghosts;
  std::vector<InteractingRank> ranks;
  Bins bins;
};

/// Steps 1 to 5 as the solver calls them; the size of bins may be scaled.
Found search(const Scene& scene, RankPart part, const CandidateRules& rules, const Comm& comm,
             Real binScale = 1, const std::vector<Donor>& planes = {})
{
  Found found;
  found.bins = step1_globalSpaceLimits(part.faces, part.x, rules.skin, comm);
  found.bins.edge *= binScale;
  const SortedFaces sorted = step2_sortIntoBins(found.bins, part.faces, part.x, rules.skin);
  found.ranks = step3_interactingRanks(sorted, comm);
  found.ghosts = step4_copyGhostFaces(found.ranks, sorted, part.faces, part.nodeIds, planes, comm);
  std::vector<Face> faces = part.faces;
  for (const GhostFace& ghost : found.ghosts.faces)
  {
    Face face;
    face.id = ghost.id;
    face.count = ghost.count;
    face.block = ghost.block;
    face.thickness = ghost.thickness;
    face.modulus = ghost.modulus;
    for (int k = 0; k < ghost.count; ++k)
    {
      face.nodes[k] = int(ghost.nodes[k]);
      set(part.x, face.nodes[k], scene.x[face.nodes[k]]);
    }
    faces.push_back(face);
  }
  for (const CandidatePair& pair :
       step5_candidatePairs(found.bins, faces, part.x, scene.dimension, rules))
  {
    const bool isNew = found.pairs.insert({faces[pair.lower].id, faces[pair.higher].id}).second;
    EXPECT_TRUE(isNew) << "a pair came twice";
    EXPECT_LT(faces[pair.lower].id, faces[pair.higher].id);
  }
  return found;
}

/// Of all pairs, those with a face that is local on this rank: what the rank has to find.
Pairs concerning(const Pairs& all, const RankPart& part)
{
  std::set<GlobalId> local;
  for (const Face& face : part.faces)
    local.insert(face.id);
  Pairs mine;
  for (const Pair& pair : all)
    if (local.count(pair.first) || local.count(pair.second))
      mine.insert(pair);
  return mine;
}

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

CandidateRules rulesWithSkin(Real skin)
{
  CandidateRules rules;
  rules.skin = skin;
  return rules;
}
} // namespace

// --- completeness: bins and ranks find what brute force finds ------------------------------------

TEST(SearchCompleteness, twoThousandSquaresAtRandom)
{
  expectBruteForce(uniformScene(), rulesWithSkin(0.02));
}

TEST(SearchCompleteness, twoThousandSegmentsAtRandom)
{
  expectBruteForce(uniformScene(2000, 2, 0.03), rulesWithSkin(0.005));
}

TEST(SearchCompleteness, clustersFarApart)
{
  // Twenty heaps of size 0.1 in a box of 100: bins as large as a face would number 10^9.
  std::normal_distribution<Real> normal;
  std::uniform_int_distribution<int> heap(0, 19);
  const Scene scene =
      randomScene(2000, 3, 0.02, 2,
                  [&](auto& random)
                  {
                    const auto at = std::uint64_t(heap(random));
                    const Vec3 middle{Real(mix(at) % 100), Real(mix(at + 100) % 100),
                                      Real(mix(at + 200) % 100)};
                    const Real dx = normal(random), dy = normal(random), dz = normal(random);
                    return middle + 0.05 * Vec3{dx, dy, dz};
                  });
  expectBruteForce(scene, rulesWithSkin(0.004));
}

TEST(SearchCompleteness, oneFaceAsLargeAsTheDomain)
{
  Scene scene = uniformScene(1000);
  scene.add(faceId(100000, 0), {0.5, 0.5, 0.5}, {0, 0, 1}, 1.5);
  scene.sortById();
  expectBruteForce(scene, rulesWithSkin(0.02));
}

TEST(SearchCompleteness, flatDomain)
{
  // All faces lie in one plane, half of them looking up and half down: no extent along z.
  Scene scene;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<Real> unit(0, 1);
  for (int i = 0; i < 1000; ++i)
  {
    const Real x = unit(random), y = unit(random);
    scene.add(faceId(i, 0), {x, y, 0.25}, {0, 0, i % 2 ? 1.0 : -1.0}, 0.04);
  }
  expectBruteForce(scene, rulesWithSkin(0.01));
}

TEST(SearchCompleteness, farFromTheOriginAndSearchedAgainAfterMotion)
{
  Scene scene = uniformScene(1000);
  std::mt19937_64 random(4);
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

TEST(SearchCompleteness, noContactIsMissedUntilTheNextSearchIsForced)
{
  // A search is forced as soon as two nodes may have moved by more than skin/2 relative to each
  // other along an axis. Faces that move by up to skin/4 each, and then touch without any skin,
  // must have been candidates before. (Faces keep their directions here, and the depth limit is
  // off.)
  Scene scene = uniformScene();
  CandidateRules rules = rulesWithSkin(0.04);
  rules.depthMax = 100;
  const Pairs before = bruteForce(scene, rules);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<Real> quarter(-0.25, 0.25);
  for (std::size_t f = 0; 4 * f < scene.x.size(); ++f)
  {
    const Real dx = quarter(random), dy = quarter(random), dz = quarter(random);
    for (int k = 0; k < 4; ++k)
      scene.x[4 * f + k] += rules.skin * Vec3{dx, dy, dz};
  }
  rules.skin = 0;
  const Pairs touching = bruteForce(scene, rules);
  ASSERT_GE(touching.size(), 100u);
  EXPECT_TRUE(std::includes(before.begin(), before.end(), touching.begin(), touching.end()));
}

TEST(SearchCompleteness, ranksWithoutFaces)
{
  const Comm comm;
  const Scene scene = uniformScene(300, 3, 0.2);
  const CandidateRules rules = rulesWithSkin(0.02);
  const Pairs all = bruteForce(scene, rules);
  const RankPart part(scene, comm, true); // everything belongs to rank 0
  EXPECT_EQ(search(scene, part, rules, comm).pairs, comm.isRoot() ? all : Pairs{});
}

TEST(SearchCompleteness, nothingAtAll)
{
  const Comm comm;
  EXPECT_TRUE(search({}, RankPart({}, comm), rulesWithSkin(0.01), comm).pairs.empty());
}

// --- steps 1 to 4 --------------------------------------------------------------------------------

TEST(Step1GlobalSpaceLimits, areEqualOnAllRanksAndThoseOfOneRank)
{
  const Comm comm;
  const Scene scene = uniformScene();
  const RankPart part(scene, comm);
  RankPart whole(scene, comm);
  whole.faces = scene.faces;
  for (Face& face : whole.faces)
    face.ownedHere = comm.isRoot(); // every face once, all on rank 0
  for (int n = 0; n < int(scene.x.size()); ++n)
    set(whole.x, n, scene.x[n]);
  const Bins split = step1_globalSpaceLimits(part.faces, part.x, 0.02, comm);
  const Bins single = step1_globalSpaceLimits(whole.faces, whole.x, 0.02, comm);
  EXPECT_EQ(split.edge, single.edge);
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_EQ(split.limits.low[c], single.limits.low[c]);
    EXPECT_EQ(split.limits.high[c], single.limits.high[c]);
  }
}

TEST(Step2SortIntoBins, aFaceOnABinBorderIsInBoth)
{
  //  bins of 1 m along x:  | 0 | 1 | 2 |     the face stands on the border x = 1: without a skin
  //  its
  //                            ^             box has no extent there; with one it reaches both
  //                            sides.
  Scene scene;
  scene.add(faceId(0, 0), {1, 0.5, 0.5}, {1, 0, 0}, 0.5);
  Bins bins;
  bins.limits.low = {0, 0, 0};
  bins.limits.high = {3, 1, 1};
  const SortedFaces sorted = step2_sortIntoBins(bins, scene.faces, positions(scene), 0.1);
  ASSERT_EQ(sorted.entries.size(), 2u);
  EXPECT_EQ(sorted.entries[0].first, Bins::key({0, 0, 0}));
  EXPECT_EQ(sorted.entries[1].first, Bins::key({1, 0, 0}));
}

TEST(Step3InteractingRanks, areMutualShareTheSameBinsAndNeverThisRank)
{
  const Comm comm;
  const Scene scene = uniformScene();
  const RankPart part(scene, comm);
  const Bins bins = step1_globalSpaceLimits(part.faces, part.x, 0.02, comm);
  const SortedFaces sorted = step2_sortIntoBins(bins, part.faces, part.x, 0.02);
  std::vector<std::vector<std::uint64_t>> toRank(comm.size());
  std::vector<std::uint64_t> mine;
  for (const InteractingRank& other : step3_interactingRanks(sorted, comm))
  {
    EXPECT_NE(other.rank, comm.rank());
    EXPECT_TRUE(std::is_sorted(other.commonBins.begin(), other.commonBins.end()));
    toRank[other.rank] = other.commonBins;
    mine.insert(mine.end(), other.commonBins.begin(), other.commonBins.end());
  }
  // What the others hold in common with this rank, in rank order, is what this rank found.
  EXPECT_EQ(comm.exchange(toRank), mine);
}

TEST(Step4CopyGhostFaces, bringsEachForeignFaceOnceSortedAndAsItsOwnerHasIt)
{
  const Comm comm;
  const Scene scene = uniformScene();
  const RankPart part(scene, comm);
  std::set<GlobalId> local;
  for (const Face& face : part.faces)
    local.insert(face.id);
  const Found found = search(scene, part, rulesWithSkin(0.02), comm);
  GlobalId last = -1;
  for (const GhostFace& ghost : found.ghosts.faces)
  {
    EXPECT_GT(ghost.id, last);
    last = ghost.id;
    EXPECT_FALSE(local.count(ghost.id));
    const auto original = std::find_if(scene.faces.begin(), scene.faces.end(),
                                       [&](const Face& face) { return face.id == ghost.id; });
    ASSERT_NE(original, scene.faces.end());
    EXPECT_EQ(ghost.thickness, original->thickness);
    for (int k = 0; k < 4; ++k)
      EXPECT_EQ(ghost.nodes[k], original->nodes[k]);
  }
  EXPECT_EQ(found.ghosts.faces.empty(), comm.size() == 1);
}

TEST(Step4CopyGhostFaces, bringsTheLivingPlanesOfGhostFacesEachOnce)
{
  // Every rank holds the planes between its local faces and any others. A ghost face must bring all
  // planes it has, also those with faces that this rank does not know.
  const Comm comm;
  const Scene scene = uniformScene();
  const CandidateRules rules = rulesWithSkin(0.02);
  const Pairs all = bruteForce(scene, rules);
  const RankPart part(scene, comm);
  std::vector<Donor> planes;
  for (const Pair& pair : concerning(all, part))
  {
    Donor donor;
    donor.faceId[0] = pair.first;
    donor.faceId[1] = pair.second;
    donor.area = Real(pair.first) + 1e-3 * Real(pair.second);
    planes.push_back(donor);
  }
  const Ghosts ghosts = search(scene, part, rules, comm, 1, planes).ghosts;
  std::set<GlobalId> ghostIds;
  for (const GhostFace& ghost : ghosts.faces)
    ghostIds.insert(ghost.id);
  Pairs received, expected;
  for (const Donor& donor : ghosts.donors)
  {
    EXPECT_TRUE(received.insert({donor.faceId[0], donor.faceId[1]}).second) << "a plane came twice";
    EXPECT_EQ(donor.area, Real(donor.faceId[0]) + 1e-3 * Real(donor.faceId[1]));
  }
  for (const Pair& pair : all)
    if (ghostIds.count(pair.first) || ghostIds.count(pair.second))
      expected.insert(pair);
  EXPECT_TRUE(std::includes(received.begin(), received.end(), expected.begin(), expected.end()));
}

// --- step 5: reasons to refuse -------------------------------------------------------------------

namespace
{
/// Two squares of side 1 face to face, `gap` apart along z; judged with a skin of 0.1 m.
Verdict judgeSquares(Real gap, Real thickness, const std::function<void(Face&, Face&)>& change = {},
                     const Vec3& secondNormal = {0, 0, -1}, CandidateRules rules = {})
{
  Scene scene;
  scene.add(faceId(1, 0), {0, 0, 0}, {0, 0, 1}, 1, thickness);
  scene.add(faceId(2, 0), {0.2, 0.1, gap}, secondNormal, 1, thickness);
  Face a = scene.faces[0], b = scene.faces[1];
  a.local = b.local = true;
  if (change)
    change(a, b);
  const NodeVectors x = positions(scene);
  rules.skin = 0.1;
  return judgePair(a, b, grownBox(a, x, 0.1), grownBox(b, x, 0.1), facePlane(a, x, 3),
                   facePlane(b, x, 3), x, rules);
}
} // namespace

TEST(Step5CandidatePairs, squaresFaceToFaceWithinTheSkinAreACandidate)
{
  EXPECT_EQ(judgeSquares(0.05, 1), Verdict::Candidate);
  EXPECT_EQ(judgeSquares(-0.05, 1), Verdict::Candidate); // overlapping
}

TEST(Step5CandidatePairs, squaresFartherApartThanTheSkinAreNot)
{
  EXPECT_EQ(judgeSquares(0.11, 1), Verdict::TooFarApart);
}

TEST(Step5CandidatePairs, facesOfTheSameElementAreNeverPaired)
{
  EXPECT_EQ(judgeSquares(0.05, 1, [](Face& a, Face& b) { b.id = faceId(elementOfFace(a.id), 3); }),
            Verdict::SameElement);
}

TEST(Step5CandidatePairs, twoGhostsAreLeftToTheRanksThatOwnThem)
{
  EXPECT_EQ(judgeSquares(0.05, 1, [](Face& a, Face& b) { a.local = b.local = false; }),
            Verdict::BothGhost);
  EXPECT_EQ(judgeSquares(0.05, 1, [](Face& a, Face&) { a.local = false; }), Verdict::Candidate);
}

TEST(Step5CandidatePairs, facesThatShareANodeAreNeighboursOfOneBody)
{
  EXPECT_EQ(judgeSquares(0.05, 1, [](Face& a, Face& b) { b.nodes[2] = a.nodes[0]; }),
            Verdict::SharedNode);
}

TEST(Step5CandidatePairs, facesThatLookTheSameWayAreNotOpposed)
{
  EXPECT_EQ(judgeSquares(0.05, 1, {}, {0, 0, 1}), Verdict::NotOpposed);
  // At right angles, as the top of one brick and the side of the next.
  EXPECT_EQ(judgeSquares(0.05, 1, {}, {1, 0, 0}), Verdict::NotOpposed);
}

TEST(Step5CandidatePairs, oppositeFacesOfAThinBodyDoNotFaceEachOther)
{
  // A plate 0.1 m thick, two elements of 0.05 m: its bottom (looking down) lies 0.1 m below its
  // top. As a pair they would overlap by twice the elements' thickness; the limit is 0.6 of it.
  EXPECT_EQ(judgeSquares(-0.1, 0.05), Verdict::TooFarApart);
  EXPECT_EQ(judgeSquares(-0.02, 0.05), Verdict::Candidate);
}

TEST(Step5CandidatePairs, excludedBlocksAreNotPaired)
{
  CandidateRules rules;
  rules.excluded = [](int a, int b) { return a == 0 && b == 0; };
  EXPECT_EQ(judgeSquares(0.05, 1, {}, {0, 0, -1}, rules), Verdict::Excluded);
}
} // namespace coplane
