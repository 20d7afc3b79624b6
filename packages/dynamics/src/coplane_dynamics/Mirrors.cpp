#include <coplane_dynamics/Mirrors.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace coplane
{
void Image::reflect(const Vec3& normal)
{
  // (1 - 2 n n^T) rows
  const Vec3 across = normal.x * rows[0] + normal.y * rows[1] + normal.z * rows[2];
  for (int c = 0; c < 3; ++c)
    rows[std::size_t(c)] -= 2 * normal[c] * across;
  isOther = true;
}

Vec3 Image::of(const Vec3& vector) const
{
  return {dot(rows[0], vector), dot(rows[1], vector), dot(rows[2], vector)};
}

Vec3 Image::back(const Vec3& vector) const
{
  return vector.x * rows[0] + vector.y * rows[1] + vector.z * rows[2];
}

namespace
{
/// Symmetries in one plane.
struct Group
{
  Vec3 normal{};
  Real level = 0, thickness = 0; ///< of its nodes, and by how much they may lie beside it [m]
  std::vector<int> nodes;
  std::vector<std::string> where;
};

/// Plane of the nodes that a symmetry holds; null where they are in one, else why not. Collective.
const char* measure(const SymmetryPlane& plane, const RankMesh& mesh, const Comm& comm,
                    Group& group)
{
  // Largest level of either sign; the box; the farthest.
  std::vector<Real> bounds(9, -infinity);
  for (const int node : plane.nodes)
  {
    const Vec3& place = mesh.coordinates[std::size_t(node)];
    const Real level = dot(plane.normal, place);
    bounds[0] = std::max(bounds[0], level);
    bounds[1] = std::max(bounds[1], -level);
    for (std::size_t c = 0; c < 3; ++c)
    {
      bounds[2 + c] = std::max(bounds[2 + c], place[int(c)]);
      bounds[5 + c] = std::max(bounds[5 + c], -place[int(c)]);
    }
    bounds[8] = std::max(bounds[8], norm(place));
  }
  comm.max(bounds);
  if (!std::isfinite(bounds[0]))
    return "holds no node of a body that is not rigid";
  const Vec3 box{bounds[2] + bounds[5], bounds[3] + bounds[6], bounds[4] + bounds[7]};
  // Meshes and decks have six digits at least.
  group = {plane.normal,
           0.5 * (bounds[0] - bounds[1]),
           1e-6 * norm(box) + 1e-9 * bounds[8],
           plane.nodes,
           {plane.where}};
  return bounds[0] + bounds[1] > group.thickness ? "holds nodes of no one plane" : nullptr;
}

/// Whether the nodes span an area, in the flat a line. Collective.
bool spans(const Group& group, const RankMesh& mesh, const Comm& comm)
{
  const std::vector<Vec3>& x = mesh.coordinates;
  const auto farthest = [&](const auto& distance) // place of the node; of several the lowest
  {
    std::vector<Real> most{-infinity};
    for (const int node : group.nodes)
      most[0] = std::max(most[0], distance(x[std::size_t(node)]));
    comm.max(most);
    std::int64_t lowest = INT64_MAX;
    for (const int node : group.nodes)
      if (distance(x[std::size_t(node)]) == most[0])
        lowest = std::min<std::int64_t>(lowest, mesh.nodeIds[std::size_t(node)]);
    lowest = comm.min(lowest);
    std::vector<Real> place(3, -infinity);
    for (const int node : group.nodes)
      if (mesh.nodeIds[std::size_t(node)] == lowest)
        for (int c = 0; c < 3; ++c)
          place[std::size_t(c)] = x[std::size_t(node)][c];
    comm.max(place);
    return Vec3{place[0], place[1], place[2]};
  };
  const Vec3 first = farthest([](const Vec3& place) { return norm(place); });
  const Vec3 along = farthest([&](const Vec3& place) { return norm(place - first); }) - first;
  if (mesh.dimension == 2)
    return norm(along) > group.thickness;
  const Vec3 aside = farthest([&](const Vec3& place) { return norm(cross(place - first, along)); });
  return norm(cross(aside - first, along)) > group.thickness * norm(along);
}

/// On which side all of the mesh lies, 1 or -1; 0: on both, or none. Collective.
int sideOf(const Group& group, const RankMesh& mesh, const Comm& comm)
{
  std::vector<Real> beside{-infinity, -infinity};
  for (int node = 0; node < mesh.ownedNodes; ++node)
  {
    const Real height = dot(group.normal, mesh.coordinates[std::size_t(node)]) - group.level;
    beside[0] = std::max(beside[0], height);
    beside[1] = std::max(beside[1], -height);
  }
  comm.max(beside);
  return int(beside[0] > group.thickness) - int(beside[1] > group.thickness);
}

/// The symmetries that act in all of the run, by plane; `lacks` gets the others. Collective.
std::vector<Group> groupsOf(const Conditions& conditions, const RankMesh& mesh, const Comm& comm,
                            std::vector<Mirrors::Lack>& lacks)
{
  std::vector<Group> groups;
  for (const SymmetryPlane& plane : conditions.symmetries)
  {
    if (conditions.axisymmetric && plane.normal.x == 1)
      continue; // the axis
    Group group;
    const char* lack = !plane.when.isAlways() ? "acts in a part of the run"
                       : conditions.axisymmetric && std::abs(plane.normal.x) > 1e-6
                           ? "is a cone"
                           : measure(plane, mesh, comm, group);
    if (lack != nullptr)
    {
      lacks.push_back({plane.where, lack});
      continue;
    }
    const auto same = std::find_if(groups.begin(), groups.end(),
                                   [&](const Group& other)
                                   {
                                     const Real sign = dot(other.normal, group.normal) < 0 ? -1 : 1;
                                     return norm(other.normal - sign * group.normal) < 1e-6 &&
                                            std::abs(other.level - sign * group.level) <=
                                                2 * std::max(other.thickness, group.thickness);
                                   });
    if (same == groups.end())
    {
      groups.push_back(group);
      continue;
    }
    same->thickness = std::max(same->thickness, group.thickness);
    same->nodes.insert(same->nodes.end(), group.nodes.begin(), group.nodes.end());
    same->where.push_back(plane.where);
  }
  return groups;
}
} // namespace

std::vector<Mirror> Mirrors::holding(int node) const
{
  std::vector<Mirror> found;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (ofNode[std::size_t(node)] >> i & 1)
      found.push_back(all[i]);
  return found;
}

bool Mirrors::leadsNowhere(const ExteriorFace& face) const
{
  std::uint16_t common = ofNode[std::size_t(face.nodes[0])];
  for (int k = 1; k < face.nodeCount; ++k)
    common &= ofNode[std::size_t(face.nodes[std::size_t(k)])];
  return common != 0;
}

Mirrors mirrorsOf(const Conditions& conditions, const RigidBodies& bodies, const RankMesh& mesh,
                  const NodeLayout& layout)
{
  const Comm& comm = layout.comm();
  Mirrors mirrors;
  Array<Real> held("coplane::dynamics::mirrorsOfNodes", layout.size()); // Mirrors::ofNode
  const auto note = [&](int node, std::size_t bit)
  { held(node) = Real(std::uint16_t(held(node)) | (bit < 16 ? 1u << bit : 0u)); };
  if (conditions.axisymmetric)
  {
    mirrors.all.push_back({{1, 0, 0}, 0, 1, true});
    for (int node = 0; node < mesh.ownedNodes; ++node)
      if (mesh.coordinates[std::size_t(node)].x == 0)
        note(node, 0);
  }
  std::size_t nextOfOthers = Mirrors::most;
  for (const Group& group : groupsOf(conditions, mesh, comm, mirrors.lacks))
  {
    const int side = sideOf(group, mesh, comm);
    const char* const lack = !spans(group, mesh, comm) ? "holds nodes on one line only"
                             : side == 0               ? "has parts of the mesh on both sides"
                             : conditions.gravity.actsAlong(group.normal) ? "bears gravity"
                             : mirrors.all.size() == Mirrors::most        ? "is the ninth"
                                                                          : nullptr;
    const std::size_t bit = lack == nullptr ? mirrors.all.size() : nextOfOthers++;
    if (lack == nullptr)
      mirrors.all.push_back({group.normal, group.level, side});
    for (const std::string& where : lack != nullptr ? group.where : std::vector<std::string>())
      mirrors.lacks.push_back({where, lack});
    for (const int node : group.nodes)
      note(node, bit);
    for (int node = 0; node < mesh.ownedNodes && lack == nullptr; ++node)
      if (const int body = bodies.bodyOf(node);
          body >= 0 && bodies.staysInPlanes(body, group.normal) &&
          std::abs(dot(group.normal, mesh.coordinates[std::size_t(node)]) - group.level) <=
              group.thickness)
        note(node, bit);
  }
  layout.refresh(held);
  for (int node = 0; node < layout.size(); ++node)
    mirrors.ofNode.push_back(std::uint16_t(held(node)));
  return mirrors;
}

Image reflectInto(const std::vector<Mirror>& mirrors, Real roundOff, Vec3& x)
{
  Image image;
  constexpr int most = 1000; // points without end are not followed for ever
  bool isHere = false;
  for (int reflections = 0; !isHere && reflections < most;)
  {
    isHere = true;
    for (const Mirror& mirror : mirrors)
      if (const Real height = dot(mirror.normal, x) - mirror.level;
          mirror.side * height < -roundOff * norm(x))
      {
        x -= 2 * height * mirror.normal;
        image.reflect(mirror.normal);
        isHere = false;
        ++reflections;
      }
  }
  return image;
}
} // namespace coplane
