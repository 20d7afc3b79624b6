#include <coplane_exodus/detail/FindingsOverRanks.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace coplane
{
namespace
{
using Cell = std::array<std::int64_t, 3>;

struct Face
{
  int set, position; ///< in the set
  GlobalId element;
  int side, count;
  Vec3 centre, normal;
  std::array<Vec3, 4> corners;
};

/// A face in one of the cells of a grid near its centre.
struct Visit
{
  Face face;
  Cell cell;
  bool isHome; ///< the cell holds the centre
  int number;  ///< of the face, on its rank
};

Cell cellOf(const Vec3& x, Real edge)
{
  Cell cell;
  for (int c = 0; c < 3; ++c)
    cell[c] = std::int64_t(std::floor(x[c] / edge));
  return cell;
}

bool sameCorners(const Face& a, const Face& b, Real tolerance)
{
  const auto isOf = [&](const Face& face, const Vec3& x)
  {
    return std::any_of(face.corners.begin(), face.corners.begin() + face.count,
                       [&](const Vec3& y) { return norm(x - y) <= tolerance; });
  };
  return a.count == b.count && std::all_of(a.corners.begin(), a.corners.begin() + a.count,
                                           [&](const Vec3& x) { return isOf(b, x); });
}

bool arePartners(const Face& a, const Face& b, Real tolerance)
{
  return a.element != b.element && dot(a.normal, b.normal) < 0 && sameCorners(a, b, tolerance);
}

/// Faces of all side sets, each on one rank.
std::vector<Face> facesOf(const RankMesh& home)
{
  std::vector<Face> faces;
  for (std::size_t s = 0; s < home.sideSets.size(); ++s)
    for (const RankMesh::Side& side : home.sideSets[s])
    {
      const RankMesh::Block& block = home.blocks[side.block];
      if (!block.owned[side.element])
        continue;
      const ElementTopology& shape = topology(block.type);
      Face face{int(s),
                side.position,
                block.elementIds[side.element],
                side.side,
                shape.nodesPerSide,
                {},
                {},
                {}};
      for (int k = 0; k < face.count; ++k)
      {
        face.corners[k] = home.coordinates[block.connectivity[side.element * shape.nodes +
                                                              shape.sideNodes[side.side][k]]];
        face.centre += (1.0 / face.count) * face.corners[k];
      }
      const auto& x = face.corners;
      face.normal = face.count == 2 ? Vec3{x[1].y - x[0].y, x[0].x - x[1].x, 0}
                                    : cross(x[2] - x[0], (face.count == 3 ? x[0] : x[3]) - x[1]);
      faces.push_back(face);
    }
  return faces;
}

/// Which faces have a partner. Faces meet in the cells of a grid, and cells are dealt out to ranks.
std::vector<char> facesWithPartner(const std::vector<Face>& faces, const Boxes& boxes,
                                   Real tolerance, const Comm& comm)
{
  const Real edge = 4 * tolerance;
  std::vector<std::vector<Visit>> toRank(comm.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    const Vec3& centre = faces[i].centre;
    std::vector<Cell> cells; // that hold centres within the tolerance
    for (int corner = 0; corner < 8; ++corner)
    {
      const Cell cell = cellOf(centre + Vec3{corner & 1 ? tolerance : -tolerance,
                                             corner & 2 ? tolerance : -tolerance,
                                             corner & 4 ? tolerance : -tolerance},
                               edge);
      if (std::find(cells.begin(), cells.end(), cell) == cells.end())
        cells.push_back(cell);
    }
    for (const Cell& cell : cells)
      toRank[boxes.rankOf({edge * Real(cell[0]), edge * Real(cell[1]), edge * Real(cell[2])})]
          .push_back({faces[i], cell, cell == cellOf(centre, edge), int(i)});
  }
  std::vector<int> counts;
  const std::vector<Visit> visits = comm.exchange(toRank, &counts);
  std::map<std::pair<int, Cell>, std::vector<std::size_t>> atHome; // by set and cell
  for (std::size_t i = 0; i < visits.size(); ++i)
    if (visits[i].isHome)
      atHome[{visits[i].face.set, visits[i].cell}].push_back(i);
  std::vector<std::vector<char>> answers(comm.size());
  std::size_t next = 0;
  for (int r = 0; r < comm.size(); ++r)
    for (int i = 0; i < counts[r]; ++i, ++next)
    {
      const Visit& visit = visits[next];
      const auto there = atHome.find({visit.face.set, visit.cell});
      answers[r].push_back(
          there != atHome.end() &&
          std::any_of(there->second.begin(), there->second.end(),
                      [&](std::size_t other)
                      { return arePartners(visit.face, visits[other].face, tolerance); }));
    }
  const std::vector<char> found = comm.exchange(answers);
  std::vector<char> withPartner(faces.size(), 0);
  next = 0;
  for (const std::vector<Visit>& sent : toRank)
    for (const Visit& visit : sent)
      if (found[next++])
        withPartner[visit.number] = 1;
  return withPartner;
}
} // namespace

std::vector<MeshReport::Joint> findJoints(const MeshSlice& slice, const RankMesh& home,
                                          const Boxes& boxes, Real tolerance, const Comm& comm)
{
  std::vector<MeshReport::Joint> joints;
  if (!(tolerance > 0) || slice.mine.sideSets.empty())
    return joints;
  const std::vector<Face> faces = facesOf(home);
  const std::vector<char> withPartner = facesWithPartner(faces, boxes, tolerance, comm);
  std::vector<std::int64_t> counts(slice.mine.sideSets.size(), 0);
  for (std::size_t i = 0; i < faces.size(); ++i)
    counts[faces[i].set] += withPartner[i];
  comm.sum(counts);
  for (std::size_t s = 0; s < counts.size(); ++s)
  {
    if (counts[s] < 2)
      continue;
    struct Side
    {
      GlobalId element;
      int side;
    };
    std::vector<Ordered<Side>> alone;
    for (std::size_t i = 0; i < faces.size(); ++i)
      if (faces[i].set == int(s) && !withPartner[i])
        alone.push_back({faces[i].position, {faces[i].element, faces[i].side + 1}});
    const Findings<Side> found = findingsOf(alone, comm);
    MeshReport::Joint joint{
        slice.mine.sideSets[s].id, slice.mine.sideSets[s].name, counts[s] / 2, {found.count, {}}};
    for (const Side& side : found.first)
      joint.alone.first.emplace_back(side.element, side.side);
    joints.push_back(std::move(joint));
  }
  return joints;
}
} // namespace coplane
