#include "FaceClouds.hpp"

namespace coplane::testing
{
TEST(Step1GlobalSpaceLimits, areEqualOnAllRanksAndThoseOfOneRank)
{
  const Comm comm;
  const Scene scene = Cloud{}.make();
  const RankPart part(scene, comm);
  RankPart whole(scene, comm);
  whole.faces = scene.faces;
  for (Face& face : whole.faces)
    face.ownedHere = comm.isRoot(); // every face once, all on rank 0
  for (int n = 0; n < int(scene.x.size()); ++n)
    set(whole.x, n, scene.x[n]);
  const Bins split = step1_globalSpaceLimits(part.faces, part.x, rulesWithSkin(0.02), comm);
  const Bins single = step1_globalSpaceLimits(whole.faces, whole.x, rulesWithSkin(0.02), comm);
  ASSERT_EQ(split.levels.size(), single.levels.size());
  for (std::size_t level = 0; level < split.levels.size(); ++level)
  {
    EXPECT_EQ(split.levels[level].edge, single.levels[level].edge);
    EXPECT_EQ(split.levels[level].largestFace, single.levels[level].largestFace);
  }
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_EQ(split.limits.low[c], single.limits.low[c]);
    EXPECT_EQ(split.limits.high[c], single.limits.high[c]);
  }
}

TEST(Step1GlobalSpaceLimits, facesOfOneSizeShareOneLevelAndEachFaceFitsItsBins)
{
  Cloud cloud;
  cloud.variation = 1.5;
  for (const Real side : {1e-6, 0.1, 0.17, 1e6})
  {
    cloud.side = side;
    const Scene scene = cloud.make();
    const Comm comm;
    RankPart part(scene, comm);
    // Boxes of squares that look in all directions differ by a factor of 1.5 sqrt(2) = 2.1.
    const CandidateRules rules = rulesWithSkin(0.1 * side);
    const Bins bins = step1_globalSpaceLimits(part.faces, part.x, rules, comm);
    EXPECT_LE(bins.levels.size(), 3u);
    const SortedFaces sorted = step2_sortIntoBins(bins, part.faces, part.x, 3, rules);
    for (const BinEntry& entry : sorted.entries)
      if (entry.resident)
      {
        EXPECT_LE(sorted.boxes[entry.face].longestSide(), bins.levels[entry.key >> 57].edge);
      }
  }
}

TEST(FacePlanes, areThoseOfSingleFaces)
{
  for (const int dimension : {2, 3})
  {
    Cloud cloud;
    cloud.count = 1003; // in no number of lanes without a rest
    cloud.dimension = dimension;
    cloud.corners = [](Random& random) { return random() % 8 == 0 ? 3 : 4; };
    Scene scene = cloud.make();
    Random random(3);
    const NodeVectors v("v", scene.x.size());
    for (int n = 0; n < int(scene.x.size()); ++n)
    {
      scene.x[std::size_t(n)] +=
          0.01 * Vec3{unit(random), unit(random), dimension == 3 ? unit(random) : 0};
      set(v, n, {unit(random), unit(random), dimension == 3 ? unit(random) : 0});
    }
    const Face& point = scene.faces[9]; // without area
    for (int k = 1; k < point.count; ++k)
      scene.x[std::size_t(point.nodes[k])] = scene.x[std::size_t(point.nodes[0])];
    const NodeVectors x = positions(scene);
    CandidateRules rules = rulesWithSkin(0.02);
    rules.turning = 0.1;
    for (const Real ahead : {0.0, 1e-3, 0.2})
    {
      rules.motion = {v, ahead, {0.1, 0, 0}};
      const Array<FacePlane> planes =
          facePlanes(scene.faces.data(), scene.faces.size(), x, dimension, rules);
      for (std::size_t f = 0; f < scene.faces.size(); ++f)
      {
        const FacePlane one = rules.planeOf(scene.faces[f], x, dimension);
        for (int c = 0; c < 3; ++c)
        {
          ASSERT_EQ(planes(f).center[c], one.center[c]) << f;
          ASSERT_EQ(planes(f).normal[c], one.normal[c]) << f;
        }
        ASSERT_EQ(planes(f).turning, one.turning) << f;
        ASSERT_EQ(planes(f).warp, one.warp) << f;
        ASSERT_EQ(one.turning > 0, ahead > 0) << f;
      }
    }
  }
}

TEST(Step2SortIntoBins, aFaceOnABinBorderIsInBoth)
{
  //  bins of 1 m along x:  | 0 | 1 | 2 |     the limits begin in the middle of bin 0, so the face
  //  at
  //                            ^             x = 0.5 stands on a border: without a skin its box has
  //                                          no extent there; with one it reaches both sides.
  Scene scene;
  scene.add(faceId(0, 0), {0.5, 1, 1}, {1, 0, 0}, 0.5, 0);
  Bins bins;
  bins.limits.low = {0, 0, 0};
  bins.limits.high = {3, 2, 2};
  const SortedFaces sorted =
      step2_sortIntoBins(bins, scene.faces, positions(scene), 3, rulesWithSkin(0.1));
  ASSERT_EQ(sorted.entries.size(), 2u);
  EXPECT_EQ(sorted.entries[0].key, Bins::key(0, {0, 1, 1}));
  EXPECT_EQ(sorted.entries[0].corner, 7); // first bin along all axes
  EXPECT_EQ(sorted.entries[1].key, Bins::key(0, {1, 1, 1}));
  EXPECT_EQ(sorted.entries[1].corner, 6); // second bin along x
}

TEST(Step2SortIntoBins, aFaceThatIsCutIsInNoBin)
{
  // Two that look at each other; one has none, two of four, or all of its nodes in a mirror.
  for (const int held : {0, 2, 4})
  {
    Scene scene;
    scene.add(faceId(1, 0), {0.5, 1, 1}, {1, 0, 0}, 0.5, 0);
    scene.add(faceId(2, 0), {0.501, 1, 1}, {-1, 0, 0}, 0.5, 0);
    for (Face& face : scene.faces)
      face.local = true;
    for (int k = 0; k < 4; ++k)
      scene.faces[0].mirrors[k] = k < held ? 2 : 1;
    for (int k = 0; k < held; ++k)
      scene.faces[1].mirrors[k] = 4;
    if (held < 4)
      scene.faces[0].mirrors[3] = 0;
    const Comm comm(MPI_COMM_SELF);
    const CandidateRules rules = rulesWithSkin(0.01);
    const Bins bins = step1_globalSpaceLimits(scene.faces, positions(scene), rules, comm);
    const SortedFaces sorted = step2_sortIntoBins(bins, scene.faces, positions(scene), 3, rules);
    EXPECT_EQ(sorted.entries.empty(), held == 4) << held;
    EXPECT_EQ(sorted.boxes[0].overlaps(sorted.boxes[1]), held < 4) << held;
    EXPECT_EQ(step5_candidatePairs(sorted, scene.faces, positions(scene), rules).size(),
              held < 4 ? 1u : 0u);
  }
}

TEST(Box, hasNothingOfAnEmptyOne)
{
  Box box;
  box.include(Box());
  EXPECT_FALSE(box.overlaps(box));
  box.include(Vec3{1, 2, 3});
  box.include(Box());
  EXPECT_EQ(norm(box.low - Vec3{1, 2, 3}), 0);
  EXPECT_EQ(norm(box.high - Vec3{1, 2, 3}), 0);
}

TEST(Step2SortIntoBins, entriesAreSortedAndLargeFacesEnterFewBins)
{
  // One face is ten thousand times as large as the others: it enters bins of its own size, which
  // are at most eight, and so do the others.
  Scene scene = Cloud{}.make();
  scene.add(faceId(100000, 0), {0.5, 0.5, 0.5}, {1, 2, 3}, 1000);
  const Comm comm;
  RankPart part(scene, comm, [&](int) { return comm.rank(); });
  const Bins bins = step1_globalSpaceLimits(part.faces, part.x, rulesWithSkin(0.02), comm);
  const SortedFaces sorted = step2_sortIntoBins(bins, part.faces, part.x, 3, rulesWithSkin(0.02));
  std::map<int, std::map<int, int>> binsOfFace; // by face and level
  std::set<std::pair<int, int>> resident;
  for (std::size_t e = 0; e < sorted.entries.size(); ++e)
  {
    const BinEntry& entry = sorted.entries[e];
    EXPECT_LE(sorted.entries[e == 0 ? 0 : e - 1].key, entry.key);
    ++binsOfFace[entry.face][int(entry.key >> 57)];
    if (entry.resident)
      resident.insert({entry.face, int(entry.key >> 57)});
  }
  EXPECT_EQ(binsOfFace.size(), scene.faces.size());
  EXPECT_EQ(resident.size(), scene.faces.size()) << "each face is resident of one level";
  for (const auto& [face, levels] : binsOfFace)
    for (const auto& [level, count] : levels)
      EXPECT_LE(count, 8) << "face " << face << " on level " << level;
}

TEST(Step3InteractingRanks, areMutualShareTheSameBinsAndNeverThisRank)
{
  const Comm comm;
  const Scene scene = Cloud{}.make();
  const RankPart part(scene, comm);
  const Bins bins = step1_globalSpaceLimits(part.faces, part.x, rulesWithSkin(0.02), comm);
  const SortedFaces sorted = step2_sortIntoBins(bins, part.faces, part.x, 3, rulesWithSkin(0.02));
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
  Scene scene = Cloud{}.make();
  for (Face& face : scene.faces)
  {
    face.block = int(face.id % 7);
    face.group = int(face.id % 5);
  }
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
    EXPECT_EQ(ghost.block, original->block);
    EXPECT_EQ(ghost.group, original->group);
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
  const Scene scene = Cloud{}.make();
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

TEST(Step4CopyGhostFaces, bringsOnlyFacesThatReachIntoTheBoxOfThisRank)
{
  // Ranks own slabs; a huge face of rank 0 has one bin in common with everything, yet faces
  // that cannot touch anything of the other rank stay where they are.
  const Comm comm;
  Scene scene = Cloud{}.make();
  scene.add(faceId(100000, 0), {0.01, 0.5, 0.5}, {1, 0, 0}, 3);
  scene.sortById();
  const auto slab = [&](int node)
  { return std::clamp(int(comm.size() * scene.x[4 * (node / 4)].x), 0, comm.size() - 1); };
  const RankPart part(scene, comm, slab);
  const CandidateRules rules = rulesWithSkin(0.02);
  const Found found = search(scene, part, rules, comm);
  EXPECT_EQ(found.pairs, concerning(bruteForce(scene, rules), part));
  const NodeVectors x = positions(scene);
  Box mine;
  const auto boxOf = [&](const Face& face)
  { return contactBox(face, facePlane(face, x, 3), x, rules); };
  for (const Face& face : part.faces)
    mine.include(boxOf(face));
  for (const GhostFace& ghost : found.ghosts.faces)
  {
    const Face face = toFace(ghost, [](GlobalId node) { return int(node); });
    EXPECT_TRUE(mine.overlaps(boxOf(face)));
  }
  for (const InteractingRank& other : found.ranks)
    EXPECT_TRUE(mine.overlaps(other.box));
}
} // namespace coplane::testing
