#include <coplane_contact/InitialOverlaps.hpp>
#include <coplane_contact/detail/DeclaredJoints.hpp>
#include <coplane_core/Lists.hpp>
#include <coplane_geometry/FaceCorners.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace coplane
{
namespace
{
/// From a point along an axis.
struct Ray
{
  Vec3 from{};
  int axis = 0;
  int sign = 1;
};

/// Where a ray leaves or enters a body.
struct Crossing
{
  Real way = 0;   ///< from the start of the ray [m]
  Real depth = 0; ///< of its start below the face, along the face's normal [m]
  Vec3 normal{};
  int leaves = 1; ///< -1: enters
  int body = 0;
  int block = 0, group = 0;
  GlobalId faceId = 0;
};

/// The faces that this rank owns, in a grid across each axis.
class Surfaces
{
public:
  Surfaces(const Contact& contact, const ConstNodeVectors& x, const std::vector<int>& bodyOfNode)
      : contact_(contact), x_(x), bodyOfNode_(bodyOfNode), dimension_(contact.dimension())
  {
    for (const Face& face : contact.localFaces())
      if (face.ownedHere)
      {
        Box box;
        for (int k = 0; k < face.count; ++k)
          box.include(at(x, face.nodes[k]));
        all_.include(box);
        faces_.push_back(&face);
        boxes_.push_back(box);
      }
    for (int axis = 0; axis < dimension_; ++axis)
      fill(axis);
  }

  const Box& box() const { return all_; }
  int body(const Face& face) const { return bodyOfNode_[face.nodes[0]]; }

  /// Calls visit(face, leaves) for every face of this rank ahead on the ray, with how often it
  /// leaves a body there; entering counts negative.
  template <class Visit>
  void forEachCrossing(const Ray& ray, const Visit& visit) const
  {
    const Grid& grid = grids_[ray.axis];
    if (faces_.empty())
      return;
    for (const int f : grid.column(ray.from))
    {
      const Box& box = boxes_[f];
      if (ray.sign > 0 ? box.high[ray.axis] < ray.from[ray.axis]
                       : box.low[ray.axis] > ray.from[ray.axis])
        continue;
      const int turns = windingAround(*faces_[f], ray);
      if (turns != 0 && wayTo(*faces_[f], ray) > 0)
        visit(*faces_[f], ray.sign * turns);
    }
  }

  int countLeavings(const Ray& ray) const
  {
    int count = 0;
    forEachCrossing(ray, [&](const Face&, int leaves) { count += leaves; });
    return count;
  }

  Crossing crossing(const Face& face, const Ray& ray, int leaves) const
  {
    const auto [center, area] = plane(face);
    const Vec3 normal = normalised(area);
    return {wayTo(face, ray), dot(center - ray.from, normal),
            normal,           leaves,
            body(face),       face.block,
            face.group,       face.id};
  }

  /// Centre [m] and vector area [m^2].
  std::pair<Vec3, Vec3> plane(const Face& face) const
  {
    const FaceCorners corners = cornersAt(x_, face);
    return {corners.center(), corners.area(dimension_)};
  }

private:
  /// Columns of bins along an axis.
  struct Grid
  {
    int u = 1, v = 2; ///< axes across; v < 0: in two dimensions there is only one
    Real low[2] = {0, 0}, perBin[2] = {0, 0};
    int bins[2] = {1, 1};
    Lists<int> faces; ///< by bin

    int bin(int direction, Real value) const
    {
      const Real place = (value - low[direction]) * perBin[direction];
      return place > 0 ? int(std::min(place, Real(bins[direction] - 1))) : 0;
    }
    /// Faces in the column of a point.
    Stretch<int> column(const Vec3& p) const
    {
      return faces[std::size_t(bin(0, p[u])) * bins[1] + (v < 0 ? 0 : bin(1, p[v]))];
    }
  };

  void fill(int axis)
  {
    Grid& grid = grids_[axis];
    grid.u = dimension_ == 2 ? 1 - axis : (axis + 1) % 3;
    grid.v = dimension_ == 2 ? -1 : (axis + 2) % 3;
    const Real wanted = std::max<Real>(1, Real(faces_.size()));
    const int across[2] = {grid.u, grid.v};
    for (int d = 0; d < (dimension_ == 2 ? 1 : 2); ++d)
    {
      const Real extent = all_.high[across[d]] - all_.low[across[d]];
      grid.low[d] = all_.low[across[d]];
      grid.bins[d] = int(std::min(1e4, dimension_ == 2 ? wanted : std::ceil(std::sqrt(wanted))));
      grid.perBin[d] = extent > 0 ? grid.bins[d] / extent : 0;
    }
    const auto forEachBin = [&](const Box& box, const auto& visit)
    {
      const int v0 = grid.v < 0 ? 0 : grid.bin(1, box.low[grid.v]);
      const int v1 = grid.v < 0 ? 0 : grid.bin(1, box.high[grid.v]);
      for (int i = grid.bin(0, box.low[grid.u]); i <= grid.bin(0, box.high[grid.u]); ++i)
        for (int j = v0; j <= v1; ++j)
          visit(std::size_t(i) * std::size_t(grid.bins[1]) + std::size_t(j));
    };
    grid.faces = {std::size_t(grid.bins[0]) * std::size_t(grid.bins[1]), [&](const auto& visit)
                  {
                    for (std::size_t f = 0; f < faces_.size(); ++f)
                      forEachBin(boxes_[f], [&](std::size_t bin) { visit(bin, int(f)); });
                  }};
  }

  /// How often the face's outline, seen along the axis, goes round the ray counter-clockwise. An
  /// edge that two faces share gives the same answer for both: no ray slips through between them.
  int windingAround(const Face& face, const Ray& ray) const
  {
    const int u = grids_[ray.axis].u, v = grids_[ray.axis].v;
    if (dimension_ == 2)
    {
      const bool first = x_(face.nodes[0], u) <= ray.from[u];
      const bool second = x_(face.nodes[1], u) <= ray.from[u];
      if (first == second)
        return 0;
      return first == (ray.axis == 0) ? 1 : -1;
    }
    int turns = 0;
    for (int k = 0; k < face.count; ++k)
    {
      const Vec3 p = at(x_, face.nodes[k]), q = at(x_, face.nodes[(k + 1) % face.count]);
      const bool first = p[v] <= ray.from[v], second = q[v] <= ray.from[v];
      if (first == second)
        continue;
      const Vec3 &low = first ? p : q, &high = first ? q : p;
      const Real at = low[u] + (ray.from[v] - low[v]) * ((high[u] - low[u]) / (high[v] - low[v]));
      if (ray.from[u] < at)
        turns += first ? 1 : -1;
    }
    return turns;
  }

  Real wayTo(const Face& face, const Ray& ray) const
  {
    const auto [center, area] = plane(face);
    const Real along = area[ray.axis];
    Vec3 r = center - ray.from;
    const Real ahead = r[ray.axis];
    r[ray.axis] = 0;
    const Real way = along != 0 ? ahead + dot(r, area) / along : ahead;
    return ray.sign * way;
  }

  const Contact& contact_;
  const ConstNodeVectors& x_;
  const std::vector<int>& bodyOfNode_;
  int dimension_;
  Box all_;
  std::vector<const Face*> faces_;
  std::vector<Box> boxes_;
  Grid grids_[3];
};

/// Of the whole turn where bodies are those of revolution [m^2].
Real wholeArea(const Contact& contact, const Vec3& center, const Vec3& vectorArea)
{
  return norm(vectorArea) * (contact.options().axisymmetric ? 2 * pi * center.x : 1);
}

/// A point just below a face, with its share of the face's area.
struct Sample
{
  const Face* face;
  Vec3 point{}, normal{};
  Real area = 0;
  Real size = 0; ///< of the face [m]
};

std::vector<Sample> samplesOf(const Contact& contact, const Surfaces& surfaces,
                              const ConstNodeVectors& x)
{
  std::vector<Sample> samples;
  for (const Face& face : contact.localFaces())
  {
    if (!face.ownedHere)
      continue;
    const auto [center, vectorArea] = surfaces.plane(face);
    const Vec3 normal = normalised(vectorArea);
    const Vec3 below = (-smallestOverlap * face.thickness) * normal;
    if (!(norm(below) > 0)) // a face without area
      continue;
    const Real area = wholeArea(contact, center, vectorArea) / (1 + face.count);
    const Real size = faceSize(norm(vectorArea), contact.dimension());
    samples.push_back({&face, center + below, normal, area, size});
    for (int k = 0; k < face.count; ++k)
      samples.push_back(
          {&face, 0.1 * center + 0.9 * at(x, face.nodes[k]) + below, normal, area, size});
  }
  return samples;
}

/// Answers of all ranks to rays, ray by ray. `ask(ray, answers)` appends those of this rank.
/// Collective.
template <class Answer, class Ask>
std::vector<std::vector<Answer>> askAll(const std::vector<Ray>& rays, const std::vector<Box>& boxes,
                                        const Ask& ask, const Comm& comm)
{
  std::vector<std::vector<Ray>> send(comm.size());
  std::vector<std::vector<std::size_t>> whose(comm.size());
  for (std::size_t i = 0; i < rays.size(); ++i)
    for (int r = 0; r < comm.size(); ++r)
    {
      bool meets = rays[i].sign > 0 ? boxes[r].high[rays[i].axis] >= rays[i].from[rays[i].axis]
                                    : boxes[r].low[rays[i].axis] <= rays[i].from[rays[i].axis];
      for (int c = 0; c < 3; ++c)
        meets = meets && (c == rays[i].axis || (boxes[r].low[c] <= rays[i].from[c] &&
                                                rays[i].from[c] <= boxes[r].high[c]));
      if (!meets)
        continue;
      send[r].push_back(rays[i]);
      whose[r].push_back(i);
    }
  std::vector<int> asked;
  const std::vector<Ray> questions = comm.exchange(send, &asked);
  std::vector<std::vector<int>> countsTo(comm.size());
  std::vector<std::vector<Answer>> answersTo(comm.size());
  auto question = questions.begin();
  for (int r = 0; r < comm.size(); ++r)
    for (int i = 0; i < asked[r]; ++i, ++question)
    {
      const std::size_t before = answersTo[r].size();
      ask(*question, answersTo[r]);
      countsTo[r].push_back(int(answersTo[r].size() - before));
    }
  const std::vector<int> counts = comm.exchange(countsTo);
  const std::vector<Answer> answers = comm.exchange(answersTo);
  std::vector<std::vector<Answer>> byRay(rays.size());
  auto count = counts.begin();
  auto answer = answers.begin();
  for (int r = 0; r < comm.size(); ++r)
    for (const std::size_t i : whose[r])
    {
      byRay[i].insert(byRay[i].end(), answer, answer + *count);
      answer += *count++;
    }
  return byRay;
}

/// A sample that lies in another body.
struct Inside
{
  int body[2]; ///< of the sample, and the other one
  int block[2];
  GlobalId faceId[2];
  Real depth;
  Real volume;       ///< below the sample
  Real facingVolume; ///< the part of it for which its face opposes the other one
};

bool comesBefore(const Inside& a, const Inside& b)
{
  return std::tie(a.body[0], a.body[1], a.faceId[0], a.faceId[1], a.depth) <
         std::tie(b.body[0], b.body[1], b.faceId[0], b.faceId[1], b.depth);
}

/// In which other bodies a sample lies, and the least way out of each, from what the rays along all
/// axes met.
void findBodies(const Sample& sample, int ownBody, const std::vector<Crossing>* rays, int count,
                const Contact& contact, bool declaredAbsorb, std::vector<Inside>& inside)
{
  std::map<int, std::pair<int, Inside>> others; // rays that say inside, way out
  for (int i = 0; i < count; ++i)
  {
    std::map<int, int> leavings;
    for (const Crossing& crossing : rays[i])
      leavings[crossing.body] += crossing.leaves;
    for (const auto& [body, times] : leavings)
    {
      if (body == ownBody || times < 1)
        continue;
      const Crossing* nearest = nullptr;
      for (const Crossing& c : rays[i])
        if (c.body == body && c.leaves > 0 &&
            (!nearest || std::tie(c.way, c.faceId) < std::tie(nearest->way, nearest->faceId)))
          nearest = &c;
      auto& [votes, out] = others.emplace(body, std::make_pair(0, Inside{})).first->second;
      // The face is as far from the surface as the sample, less what the sample lies below it.
      const Real depth = std::min(nearest->way, std::abs(nearest->depth)) +
                         smallestOverlap * sample.face->thickness;
      if (++votes == 1 || std::tie(depth, nearest->faceId) < std::tie(out.depth, out.faceId[1]))
        out = {{ownBody, body},
               {sample.face->block, nearest->block},
               {sample.face->id, nearest->faceId},
               depth,
               depth * sample.area,
               depth * sample.area * std::max(0.0, -dot(sample.normal, nearest->normal))};
    }
  }
  for (const auto& [body, found] : others)
    if (2 * found.first > count)
    {
      int group = 0;
      for (int i = 0; i < count; ++i)
        for (const Crossing& crossing : rays[i])
          if (crossing.faceId == found.second.faceId[1])
            group = crossing.group;
      const ContactRule& rule = contact.rules().between(sample.face->group, group);
      const bool isJoint = rule.declared && found.second.depth <= widestJoint * sample.size;
      if (rule.excluded || (declaredAbsorb && isJoint))
        continue;
      inside.push_back(found.second);
    }
}

/// Volumes of bodies, by the divergence theorem [m^3]. Collective.
std::map<int, Real> volumesOf(const std::vector<int>& bodies, const Contact& contact,
                              const Surfaces& surfaces)
{
  std::vector<ExactSum> sums(bodies.size());
  const int dimension = contact.options().axisymmetric ? 3 : contact.dimension();
  for (const Face& face : contact.localFaces())
  {
    const auto found = std::lower_bound(bodies.begin(), bodies.end(), surfaces.body(face));
    if (!face.ownedHere || found == bodies.end() || *found != surfaces.body(face))
      continue;
    const auto [center, area] = surfaces.plane(face);
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
std::vector<InitialOverlap> byBlocks(const std::vector<Inside>& inside,
                                     const std::map<int, Real>& volumes)
{
  struct BodyPair
  {
    Real volume[2] = {0, 0}, facingVolume[2] = {0, 0};
    std::set<GlobalId> faces;
    const Inside* deepest = nullptr;
  };
  std::map<std::array<int, 4>, BodyPair> pairs; // blocks, bodies
  for (const Inside& one : inside)
  {
    const int side = one.body[0] < one.body[1] ? 0 : 1;
    BodyPair& pair =
        pairs[{std::min(one.block[0], one.block[1]), std::max(one.block[0], one.block[1]),
               one.body[side], one.body[1 - side]}];
    pair.volume[side] += one.volume;
    pair.facingVolume[side] += one.facingVolume;
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
  const Comm& comm = contact.comm();
  const Surfaces surfaces(contact, x, bodyOfNode);
  const std::vector<Box> boxes = comm.allGather(std::vector<Box>{surfaces.box()});
  const std::vector<Sample> samples = samplesOf(contact, surfaces, x);

  // One ray each, and its sum only: nearly all samples lie in their own body alone.
  std::vector<Ray> rays;
  for (const Sample& sample : samples)
    rays.push_back({sample.point, 0, 1});
  const auto counts = askAll<int>(
      rays, boxes,
      [&](const Ray& ray, std::vector<int>& answers)
      { answers.push_back(surfaces.countLeavings(ray)); },
      comm);
  std::vector<const Sample*> suspects;
  rays.clear();
  const int raysEach = 2 * contact.dimension();
  for (std::size_t s = 0; s < samples.size(); ++s)
  {
    int bodies = 0;
    for (const int leavings : counts[s])
      bodies += leavings;
    if (bodies == 1)
      continue;
    suspects.push_back(&samples[s]);
    for (int axis = 0; axis < contact.dimension(); ++axis)
      for (const int sign : {-1, 1})
        rays.push_back({samples[s].point, axis, sign});
  }
  const auto crossings = askAll<Crossing>(
      rays, boxes,
      [&](const Ray& ray, std::vector<Crossing>& answers)
      {
        surfaces.forEachCrossing(ray, [&](const Face& face, int leaves)
                                 { answers.push_back(surfaces.crossing(face, ray, leaves)); });
      },
      comm);
  std::vector<Inside> inside;
  for (std::size_t s = 0; s < suspects.size(); ++s)
    findBodies(*suspects[s], surfaces.body(*suspects[s]->face),
               &crossings[s * std::size_t(raysEach)], raysEach, contact, declaredAbsorb, inside);
  inside = comm.allGather(inside);
  std::sort(inside.begin(), inside.end(), comesBefore);

  std::vector<int> bodies;
  for (const Inside& one : inside)
    bodies.insert(bodies.end(), one.body, one.body + 2);
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  if (bodies.empty())
    return {};
  return byBlocks(inside, volumesOf(bodies, contact, surfaces));
}
} // namespace coplane
