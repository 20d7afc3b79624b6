#include <coplane_contact/detail/DeclaredJoints.hpp>
#include <coplane_contact/detail/PointsInBodies.hpp>
#include <coplane_core/Lists.hpp>
#include <coplane_geometry/FaceCorners.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

namespace coplane::detail
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
  Real thickness = 0; ///< of the element behind the face [m]
  bool isCut = false; ///< the face lies in a plane of symmetry
};

/// The faces that this rank owns, in a grid across each axis.
class BodySurfaces
{
public:
  BodySurfaces(const Contact& contact, const ConstNodeVectors& x,
               const std::vector<int>& bodyOfFace)
      : first_(contact.localFaces().data()), x_(x), bodyOfFace_(bodyOfFace),
        dimension_(contact.dimension())
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
  }

  const Box& box() const { return all_; }
  int body(const Face& face) const { return bodyOfFace_[std::size_t(&face - first_)]; }

  /// Calls visit(face, leaves) for every face of this rank ahead on the ray, with how often it
  /// leaves a body there; entering counts negative.
  template <class Visit>
  void forEachCrossing(const Ray& ray, const Visit& visit) const
  {
    if (faces_.empty())
      return;
    const Grid& grid = gridAcross(ray.axis);
    for (const int f : grid.column(ray.from))
    {
      const Box& box = boxes_[f];
      if (ray.sign > 0 ? box.high[ray.axis] < ray.from[ray.axis]
                       : box.low[ray.axis] > ray.from[ray.axis])
        continue;
      if (isBeside(box, grid.u, ray) || (grid.v >= 0 && isBeside(box, grid.v, ray)))
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
            face.group,       face.id,
            face.thickness,   face.isCut()};
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

  const Grid& gridAcross(int axis) const
  {
    if (!grids_[axis])
      grids_[axis] = filled(axis);
    return *grids_[axis];
  }

  /// Along an axis, of all boxes but for a few at both ends: fragments that have flown away would
  /// leave the others in a few bins.
  std::pair<Real, Real> extentOfMost(int axis) const
  {
    std::vector<Real> low, high;
    for (const Box& box : boxes_)
    {
      low.push_back(box.low[axis]);
      high.push_back(box.high[axis]);
    }
    const std::size_t few = boxes_.size() / 50;
    std::nth_element(low.begin(), low.begin() + std::ptrdiff_t(few), low.end());
    std::nth_element(high.begin(), high.end() - 1 - std::ptrdiff_t(few), high.end());
    return {low[few], *(high.end() - 1 - std::ptrdiff_t(few))};
  }

  Grid filled(int axis) const
  {
    Grid grid;
    grid.u = dimension_ == 2 ? 1 - axis : (axis + 1) % 3;
    grid.v = dimension_ == 2 ? -1 : (axis + 2) % 3;
    const Real wanted = std::max<Real>(1, Real(faces_.size()));
    const int across[2] = {grid.u, grid.v};
    for (int d = 0; d < (dimension_ == 2 ? 1 : 2); ++d)
    {
      const auto [low, high] = extentOfMost(across[d]);
      grid.low[d] = low;
      grid.bins[d] = int(std::min(1e4, dimension_ == 2 ? wanted : std::ceil(std::sqrt(wanted))));
      grid.perBin[d] = high > low ? grid.bins[d] / (high - low) : 0;
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
    return grid;
  }

  /// Whether a ray passes a box by more than the round-off of windingAround(), which tells the
  /// rest: so it finds nothing either.
  static bool isBeside(const Box& box, int across, const Ray& ray)
  {
    const Real low = box.low[across], high = box.high[across], at = ray.from[across];
    const Real margin = 1e-12 * (std::abs(low) + std::abs(high));
    return at < low - margin || at > high + margin;
  }

  /// How often the face's outline, seen along the axis, goes round the ray counter-clockwise. An
  /// edge that two faces share gives the same answer for both: no ray slips through between them.
  int windingAround(const Face& face, const Ray& ray) const
  {
    const Grid& grid = gridAcross(ray.axis);
    const int u = grid.u, v = grid.v;
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

  const Face* first_;
  const ConstNodeVectors& x_;
  const std::vector<int>& bodyOfFace_;
  int dimension_;
  Box all_;
  std::vector<const Face*> faces_;
  std::vector<Box> boxes_;
  mutable std::optional<Grid> grids_[3]; ///< made when they are asked for
};

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

/// From a point out of another body.
struct WayOut
{
  int votes = 0; ///< rays that say that the point is inside
  Real depth = infinity;
  const Crossing* through = nullptr;
};

/// In which other bodies a point lies, and the least way out of each, from what the rays along all
/// axes met.
std::map<int, WayOut> waysOut(const PointBelow& point, int ownBody,
                              const std::vector<Crossing>* rays, int count, WaysOut ways)
{
  constexpr Real behind = 0.25; // cosine between two faces
  std::map<int, WayOut> others;
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
        if (c.body == body && c.leaves > 0 && !c.isCut &&
            (!nearest || std::tie(c.way, c.faceId) < std::tie(nearest->way, nearest->faceId)))
          nearest = &c;
      WayOut& out = others[body];
      ++out.votes;
      if (!nearest || (ways == WaysOut::NotBehind && dot(point.normal, nearest->normal) > behind))
        continue;
      // The face is as far from the surface as the point, less what the point lies below it.
      const Real depth = std::min(nearest->way, std::abs(nearest->depth)) +
                         smallestOverlap * point.face->thickness;
      if (!out.through ||
          std::tie(depth, nearest->faceId) < std::tie(out.depth, out.through->faceId))
      {
        out.depth = depth;
        out.through = nearest;
      }
    }
  }
  return others;
}

/// Adds the bodies that a point lies in.
void findBodies(const PointBelow& point, int ownBody, const std::vector<Crossing>* rays, int count,
                const Contact& contact, bool declaredAbsorb, WaysOut ways,
                std::vector<PointInBody>& inside)
{
  const auto ruleWith = [&](const Crossing& crossing)
  { return contact.rules().between(point.face->group, crossing.group); };
  for (const auto& [body, out] : waysOut(point, ownBody, rays, count, ways))
  {
    if (2 * out.votes <= count || !out.through)
      continue;
    bool excluded = false;
    for (int i = 0; i < count; ++i)
      for (const Crossing& crossing : rays[i])
        excluded = excluded || (crossing.body == body && ruleWith(crossing).excluded);
    const bool isJoint = ruleWith(*out.through).declared && out.depth <= widestJoint * point.size;
    if (excluded || (declaredAbsorb && isJoint))
      continue;
    const Crossing& through = *out.through;
    inside.push_back({{ownBody, body},
                      {point.face->block, through.block},
                      {point.face->id, through.faceId},
                      out.depth,
                      std::min(point.face->thickness, through.thickness),
                      point.area,
                      std::max(0.0, -dot(point.normal, through.normal))});
  }
}

std::vector<PointBelow> pointsBelow(const Contact& contact, const ConstNodeVectors& x,
                                    bool atCorners)
{
  std::vector<PointBelow> points;
  for (const Face& face : contact.localFaces())
  {
    if (!face.ownedHere || face.isCut())
      continue;
    const FaceCorners corners = cornersAt(x, face);
    const Vec3 center = corners.center(), vectorArea = corners.area(contact.dimension());
    const Vec3 normal = normalised(vectorArea);
    const Vec3 below = (-smallestOverlap * face.thickness) * normal;
    if (!(norm(below) > 0)) // a face without area
      continue;
    const Real area = wholeArea(contact, center, vectorArea) / (atCorners ? 1 + face.count : 1);
    const Real size = faceSize(norm(vectorArea), contact.dimension());
    points.push_back({&face, center + below, normal, area, size});
    for (int k = 0; k < face.count && atCorners; ++k)
      points.push_back(
          {&face, 0.1 * center + 0.9 * at(x, face.nodes[k]) + below, normal, area, size});
  }
  return points;
}
} // namespace

Real wholeArea(const Contact& contact, const Vec3& center, const Vec3& vectorArea)
{
  return norm(vectorArea) * (contact.options().axisymmetric ? 2 * pi * center.x : 1);
}

std::vector<PointBelow> pointsBelowCentres(const Contact& contact, const ConstNodeVectors& x)
{
  return pointsBelow(contact, x, false);
}

std::vector<PointBelow> pointsBelowFaces(const Contact& contact, const ConstNodeVectors& x)
{
  return pointsBelow(contact, x, true);
}

std::vector<PointInBody> pointsInBodies(const std::vector<PointBelow>& points,
                                        const Contact& contact, const ConstNodeVectors& x,
                                        const std::vector<int>& bodyOfFace, bool declaredAbsorb,
                                        WaysOut ways)
{
  const Comm& comm = contact.comm();
  const BodySurfaces surfaces(contact, x, bodyOfFace);
  const std::vector<Box> boxes = comm.allGather(std::vector<Box>{surfaces.box()});

  // One ray each, and its sum only: nearly all points lie in their own body alone.
  std::vector<Ray> rays;
  for (const PointBelow& point : points)
    rays.push_back({point.point, 0, 1});
  const auto counts = askAll<int>(
      rays, boxes,
      [&](const Ray& ray, std::vector<int>& answers)
      { answers.push_back(surfaces.countLeavings(ray)); },
      comm);
  std::vector<const PointBelow*> suspects;
  rays.clear();
  const int raysEach = 2 * contact.dimension();
  for (std::size_t p = 0; p < points.size(); ++p)
  {
    int bodies = 0;
    for (const int leavings : counts[p])
      bodies += leavings;
    if (bodies == 1)
      continue;
    suspects.push_back(&points[p]);
    for (int axis = 0; axis < contact.dimension(); ++axis)
      for (const int sign : {-1, 1})
        rays.push_back({points[p].point, axis, sign});
  }
  const auto crossings = askAll<Crossing>(
      rays, boxes,
      [&](const Ray& ray, std::vector<Crossing>& answers)
      {
        surfaces.forEachCrossing(ray, [&](const Face& face, int leaves)
                                 { answers.push_back(surfaces.crossing(face, ray, leaves)); });
      },
      comm);
  std::vector<PointInBody> inside;
  for (std::size_t s = 0; s < suspects.size(); ++s)
    findBodies(*suspects[s], surfaces.body(*suspects[s]->face),
               &crossings[s * std::size_t(raysEach)], raysEach, contact, declaredAbsorb, ways,
               inside);
  return inside;
}
} // namespace coplane::detail
