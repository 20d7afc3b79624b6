#pragma once

#include <coplane_contact/Search.hpp>
#include <coplane_core/StateHash.hpp>
#include <coplane_mesh/ElementTopology.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <set>

// Scenes of many faces for the tests of the search, brute force, and the search as ranks run it.
// Every rank makes the whole scene from one seed and then keeps only what it would own in a run;
// what it does not know is NaN, so that any use of it shows.

namespace coplane::testing
{
using Pair = std::pair<GlobalId, GlobalId>;
using Pairs = std::set<Pair>;
using Random = std::mt19937_64;

constexpr Real unknown = std::numeric_limits<Real>::quiet_NaN();

inline Real unit(Random& random)
{
  return std::uniform_real_distribution<Real>(0, 1)(random);
}

/// Faces with four nodes of their own each; node 4f + k is corner k of face f.
struct Scene
{
  int dimension = 3;
  std::vector<Vec3> x;
  std::vector<Face> faces; ///< sorted by id

  /// A square with its middle, its normal's direction and its side [m]; half of it when corners is
  /// 3; segments in 2D.
  Face& add(GlobalId id, const Vec3& middle, const Vec3& normal, Real side, Real thickness = 0.1,
            int corners = 4)
  {
    Face face;
    face.id = id;
    face.count = dimension == 2 ? 2 : corners;
    face.thickness = thickness;
    face.modulus = 1;
    const Vec3 n = normalised(normal);
    // In the plane z = 0 the outward normal of a segment lies on the right of its direction.
    const Vec3 any = dimension == 2        ? Vec3{0, 0, 1}
                     : std::abs(n.x) < 0.6 ? Vec3{1, 0, 0}
                                           : Vec3{0, 1, 0};
    const Vec3 e1 = normalised(cross(any, n)), e2 = cross(n, e1);
    const Real h = 0.5 * side;
    if (dimension == 2)
      for (const Real sign : {-1, 1, 1, 1})
        x.push_back(middle + (sign * h) * e1);
    else
      for (const Vec3& corner : {middle - h * e1 - h * e2, middle + h * e1 - h * e2,
                                 middle + h * e1 + h * e2, middle - h * e1 + h * e2})
        x.push_back(corner);
    for (int k = 0; k < face.count; ++k)
      face.nodes[k] = int(x.size()) - 4 + k;
    faces.push_back(face);
    return faces.back();
  }

  void sortById()
  {
    std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.id < b.id; });
  }
};

/// Faces with directions at random, ids in no order of place.
struct Cloud
{
  int count = 2000;
  int dimension = 3;
  unsigned seed = 1;
  Real side = 0.1;    ///< of the middle face [m]
  Real variation = 3; ///< largest side over smallest
  std::function<Vec3(Random&)> middle = [](Random& random)
  {
    const Real x = unit(random), y = unit(random), z = unit(random);
    return Vec3{x, y, z};
  };
  std::function<int(Random&)> corners = [](Random&) { return 4; };

  Scene make() const
  {
    Random random(seed);
    std::normal_distribution<Real> normal;
    std::vector<int> elements(count);
    for (int i = 0; i < count; ++i)
      elements[i] = i / 2; // two faces of each element: they must not pair
    std::shuffle(elements.begin(), elements.end(), random);
    std::map<int, int> sides;
    Scene scene;
    scene.dimension = dimension;
    for (int i = 0; i < count; ++i)
    {
      const Real nx = normal(random), ny = normal(random), nz = normal(random);
      Vec3 place = middle(random);
      if (dimension == 2)
        place.z = 0;
      const Real size = side * std::pow(variation, unit(random) - 0.5);
      scene.add(faceId(elements[i], sides[elements[i]]++), place, {nx, ny, dimension == 2 ? 0 : nz},
                size, size, corners(random));
    }
    scene.sortById();
    return scene;
  }
};

inline CandidateRules rulesWithSkin(Real skin)
{
  CandidateRules rules;
  rules.skin = rules.reach = skin;
  return rules;
}

inline NodeVectors positions(const Scene& scene)
{
  NodeVectors x("x", scene.x.size());
  for (int n = 0; n < int(scene.x.size()); ++n)
    set(x, n, scene.x[n]);
  return x;
}

/// Every pair judged, without bins or ranks.
inline Pairs bruteForce(const Scene& scene, const CandidateRules& rules)
{
  std::vector<Face> faces = scene.faces;
  const NodeVectors x = positions(scene);
  std::vector<Box> boxes;
  std::vector<FacePlane> planes;
  for (Face& face : faces)
  {
    face.local = true;
    planes.push_back(facePlane(face, x, scene.dimension));
    boxes.push_back(contactBox(face, planes.back(), x, rules));
  }
  Pairs pairs;
  for (std::size_t p = 0; p < faces.size(); ++p)
    for (std::size_t q = p + 1; q < faces.size(); ++q)
      if (judgePair(faces[p], faces[q], boxes[p], boxes[q], planes[p], planes[q], x, rules) ==
          Verdict::Candidate)
        pairs.insert({faces[p].id, faces[q].id});
  return pairs;
}

/// Owner of a node: faces mostly stay together, but every tenth has its nodes all over the ranks.
inline int ownerOf(int node, const Comm& comm)
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

  using Owner = std::function<int(int)>;
  RankPart(const Scene& scene, const Comm& comm)
      : RankPart(scene, comm, [&](int node) { return ownerOf(node, comm); })
  {
  }
  RankPart(const Scene& scene, const Comm& comm, const Owner& owner)
      : x("x", scene.x.size()), nodeIds(scene.x.size())
  {
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
      face.ownedHere = owner(face.nodes[0]) == comm.rank();
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
inline Found search(const Scene& scene, RankPart part, const CandidateRules& rules,
                    const Comm& comm, Real binScale = 1, const std::vector<Donor>& planes = {})
{
  Found found;
  found.bins = step1_globalSpaceLimits(part.faces, part.x, rules, comm);
  for (Bins::Level& level : found.bins.levels)
    level.edge *= binScale;
  const SortedFaces sorted =
      step2_sortIntoBins(found.bins, part.faces, part.x, scene.dimension, rules);
  found.ranks = step3_interactingRanks(sorted, comm);
  found.ghosts = step4_copyGhostFaces(found.ranks, sorted, part.faces, part.nodeIds, planes, comm);
  std::vector<Face> faces = part.faces;
  for (const GhostFace& ghost : found.ghosts.faces)
  {
    faces.push_back(toFace(ghost, [](GlobalId node) { return int(node); }));
    for (int k = 0; k < ghost.count; ++k)
      set(part.x, int(ghost.nodes[k]), scene.x[ghost.nodes[k]]);
  }
  Pair last{-1, -1};
  const SortedFaces withGhosts =
      step2_sortIntoBins(found.bins, faces, part.x, scene.dimension, rules);
  for (const CandidatePair& pair : step5_candidatePairs(withGhosts, faces, part.x, rules))
  {
    const Pair ids{faces[pair.lower].id, faces[pair.higher].id};
    EXPECT_LT(ids.first, ids.second);
    EXPECT_LT(last, ids) << "pairs come once each, sorted by their keys";
    last = ids;
    found.pairs.insert(ids);
  }
  return found;
}

/// Of all pairs, those with a face that is local on this rank: what the rank has to find.
inline Pairs concerning(const Pairs& all, const RankPart& part)
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
} // namespace coplane::testing
