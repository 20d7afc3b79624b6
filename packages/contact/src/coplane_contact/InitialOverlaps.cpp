#include <coplane_contact/InitialOverlaps.hpp>
#include <coplane_contact/detail/PointsInBodies.hpp>
#include <coplane_geometry/FaceCorners.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>

namespace coplane
{
using namespace detail;
namespace
{
bool comesBefore(const PointInBody& a, const PointInBody& b)
{
  return std::tie(a.body[0], a.body[1], a.faceId[0], a.faceId[1], a.depth) <
         std::tie(b.body[0], b.body[1], b.faceId[0], b.faceId[1], b.depth);
}

/// Volumes of bodies, by the divergence theorem [m^3]. Collective.
std::map<int, Real> volumesOf(const std::vector<int>& bodies, const Contact& contact,
                              const ConstNodeVectors& x, const std::vector<int>& bodyOfFace)
{
  std::vector<ExactSum> sums(bodies.size());
  const int dimension = contact.options().axisymmetric ? 3 : contact.dimension();
  for (std::size_t f = 0; f < contact.localFaces().size(); ++f)
  {
    const Face& face = contact.localFaces()[f];
    const auto found = std::lower_bound(bodies.begin(), bodies.end(), bodyOfFace[f]);
    if (!face.ownedHere || found == bodies.end() || *found != bodyOfFace[f])
      continue;
    const FaceCorners corners = cornersAt(x, face);
    const Vec3 center = corners.center(), area = corners.area(contact.dimension());
    if (norm(area) > 0)
      sums[std::size_t(found - bodies.begin())].add(dot(center, normalised(area)) *
                                                    wholeArea(contact, center, area) / dimension);
  }
  const std::vector<Real> totals = ExactSum::overRanks(sums, contact.comm());
  std::map<int, Real> volumes;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    volumes[bodies[b]] = totals[b];
  return volumes;
}

/// Sums over bodies, then over blocks. The faces of either body in the other tell of the same
/// volume: the larger sum counts. It is no larger than a body. Where no face opposes the one
/// through which the way leads out, as of a nail in a plate, all faces count.
std::vector<InitialOverlap> byBlocks(const std::vector<PointInBody>& inside,
                                     const std::map<int, Real>& volumes)
{
  struct Sums
  {
    Real volume[2] = {0, 0}, facingVolume[2] = {0, 0};
    std::set<GlobalId> faces;
    const PointInBody* deepest = nullptr;
  };
  std::map<std::array<int, 4>, Sums> pairs; // blocks, bodies
  for (const PointInBody& one : inside)
  {
    const int side = one.body[0] < one.body[1] ? 0 : 1;
    Sums& pair = pairs[{std::min(one.block[0], one.block[1]), std::max(one.block[0], one.block[1]),
                        one.body[side], one.body[1 - side]}];
    pair.volume[side] += one.depth * one.area;
    pair.facingVolume[side] += one.depth * one.area * one.opposing;
    pair.faces.insert(one.faceId[0]);
    if (!pair.deepest || one.depth > pair.deepest->depth)
      pair.deepest = &one;
  }
  std::map<std::array<int, 2>, InitialOverlap> blocks;
  for (const auto& [key, pair] : pairs)
  {
    InitialOverlap& overlap = blocks[{key[0], key[1]}];
    overlap.block[0] = key[0];
    overlap.block[1] = key[1];
    overlap.faces += std::int64_t(pair.faces.size());
    const auto larger = [](const Real* two) { return std::max(two[0], two[1]); };
    const Real facing = larger(pair.facingVolume);
    overlap.volume += std::min(
        {facing > 0 ? facing : larger(pair.volume), volumes.at(key[2]), volumes.at(key[3])});
    if (pair.deepest->depth > overlap.depth)
    {
      overlap.depth = pair.deepest->depth;
      std::copy(pair.deepest->faceId, pair.deepest->faceId + 2, overlap.faceId);
    }
  }
  std::vector<InitialOverlap> overlaps;
  for (const auto& [key, overlap] : blocks)
    overlaps.push_back(overlap);
  return overlaps;
}
} // namespace

std::vector<InitialOverlap> initialOverlaps(const Contact& contact, const ConstNodeVectors& x,
                                            const std::vector<int>& bodyOfNode, bool declaredAbsorb)
{
  std::vector<int> bodyOfFace;
  for (const Face& face : contact.localFaces())
    bodyOfFace.push_back(bodyOfNode[std::size_t(face.nodes[0])]);
  std::vector<PointInBody> inside =
      pointsInBodies(pointsBelowFaces(contact, x), contact, x, bodyOfFace, declaredAbsorb);
  inside = contact.comm().allGather(inside);
  std::sort(inside.begin(), inside.end(), comesBefore);

  std::vector<int> bodies;
  for (const PointInBody& one : inside)
    bodies.insert(bodies.end(), one.body, one.body + 2);
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  if (bodies.empty())
    return {};
  return byBlocks(inside, volumesOf(bodies, contact, x, bodyOfFace));
}
} // namespace coplane
