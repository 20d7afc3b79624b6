#include <coplane_core/Log.hpp>
#include <coplane_dynamics/Mirrors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

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
/// None where a symmetry does not hold nodes of one plane. Collective.
/// @param thickness gets by how much nodes may lie beside it [m]
/// @param lack gets why there are no images beyond it; null: there are
std::optional<Mirror> mirrorOf(const SymmetryPlane& plane, const Conditions& conditions,
                               const RankMesh& mesh, const Comm& comm, Real& thickness,
                               const char*& lack)
{
  const std::vector<Vec3>& x = mesh.coordinates;
  // Of the nodes that it holds, the largest of either sign and the farthest; then of all nodes; the
  // box of those that it holds.
  std::vector<Real> bounds(11, -infinity);
  bounds[2] = 0;
  for (const int node : plane.nodes)
  {
    const Vec3& place = x[std::size_t(node)];
    const Real level = dot(plane.normal, place);
    bounds[0] = std::max(bounds[0], level);
    bounds[1] = std::max(bounds[1], -level);
    bounds[2] = std::max(bounds[2], norm(place));
    for (std::size_t c = 0; c < 3; ++c)
    {
      bounds[5 + c] = std::max(bounds[5 + c], place[int(c)]);
      bounds[8 + c] = std::max(bounds[8 + c], -place[int(c)]);
    }
  }
  for (int node = 0; node < mesh.ownedNodes; ++node)
  {
    const Real level = dot(plane.normal, x[std::size_t(node)]);
    bounds[3] = std::max(bounds[3], level);
    bounds[4] = std::max(bounds[4], -level);
  }
  comm.max(bounds);
  const bool holdsNone = !std::isfinite(bounds[0]);
  // Meshes and decks have six digits at least.
  const Vec3 box{bounds[5] + bounds[8], bounds[6] + bounds[9], bounds[7] + bounds[10]};
  thickness = holdsNone ? 0 : 1e-6 * norm(box) + 1e-9 * bounds[2];
  lack = holdsNone ? "holds no node of a body that is not rigid" : "holds nodes of no one plane";
  if (holdsNone || bounds[0] + bounds[1] > thickness)
    return std::nullopt;
  Mirror mirror{plane.normal, 0.5 * (bounds[0] - bounds[1]), 0};
  // Its image shows in a plane that is more than a roller: nodes that span an area (in the flat, a
  // line), with all of the mesh on one side, and nothing that pulls along its normal.
  const auto farthest = [&](const auto& distance) // place of the node; of several the lowest
  {
    std::vector<Real> most{-infinity};
    for (const int node : plane.nodes)
      most[0] = std::max(most[0], distance(x[std::size_t(node)]));
    comm.max(most);
    std::int64_t lowest = INT64_MAX;
    for (const int node : plane.nodes)
      if (distance(x[std::size_t(node)]) == most[0])
        lowest = std::min<std::int64_t>(lowest, mesh.nodeIds[std::size_t(node)]);
    lowest = comm.min(lowest);
    std::vector<Real> place(3, -infinity);
    for (const int node : plane.nodes)
      if (mesh.nodeIds[std::size_t(node)] == lowest)
        for (int c = 0; c < 3; ++c)
          place[std::size_t(c)] = x[std::size_t(node)][c];
    comm.max(place);
    return Vec3{place[0], place[1], place[2]};
  };
  const Vec3 first = farthest([](const Vec3& place) { return norm(place); });
  const Vec3 along = farthest([&](const Vec3& place) { return norm(place - first); }) - first;
  const Vec3 aside = farthest([&](const Vec3& place) { return norm(cross(place - first, along)); });
  const bool spans = mesh.dimension == 2
                         ? norm(along) > thickness
                         : norm(cross(aside - first, along)) > thickness * norm(along);
  const bool above = bounds[3] > mirror.level + thickness,
             below = bounds[4] > -mirror.level + thickness;
  lack = !spans                                       ? "holds nodes on one line only"
         : above == below                             ? "has parts of the mesh on both sides"
         : conditions.gravity.actsAlong(plane.normal) ? "bears gravity"
                                                      : nullptr;
  if (lack == nullptr)
    mirror.side = above ? 1 : -1;
  return mirror;
}
} // namespace

std::vector<Mirror> Mirrors::holding(int node) const
{
  std::vector<Mirror> found;
  for (std::size_t i = 0; i < std::min(all.size(), most); ++i)
    if (ofNode[std::size_t(node)] >> i & 1)
      found.push_back(all[i]);
  return found;
}

std::uint8_t Mirrors::imaging() const
{
  std::uint8_t bits = 0;
  for (std::size_t i = 0; i < std::min(all.size(), most); ++i)
    bits |= std::uint8_t((all[i].side != 0) << i);
  return bits;
}

bool Mirrors::cut(const ExteriorFace& face) const
{
  std::uint8_t common = ofNode[std::size_t(face.nodes[0])];
  for (int k = 1; k < face.nodeCount; ++k)
    common &= ofNode[std::size_t(face.nodes[std::size_t(k)])];
  return common != 0;
}

Mirrors mirrorsOf(const Conditions& conditions, const RigidBodies& bodies, const RankMesh& mesh,
                  const NodeLayout& layout)
{
  Mirrors mirrors;
  // By owned node: the sum of 2^i over the mirrors that hold it.
  Array<Real> held("coplane::dynamics::mirrorsOfNodes", layout.size());
  const auto note = [&](int node, std::size_t mirror)
  {
    const auto bit = std::uint8_t(mirror < Mirrors::most ? 1u << mirror : 0);
    held(node) = Real(std::uint8_t(held(node)) | bit);
  };
  /// The same plane, by a tolerance for nodes beside it.
  const auto placeOf = [&](const Mirror& mirror, Real thickness)
  {
    const auto same = [&](const Mirror& other)
    {
      const Real sign = dot(other.normal, mirror.normal) < 0 ? -1 : 1;
      return norm(other.normal - sign * mirror.normal) < 1e-6 && !other.isAxis &&
             std::abs(other.level - sign * mirror.level) <= 2 * thickness;
    };
    const auto found = std::find_if(mirrors.all.begin(), mirrors.all.end(), same);
    const auto place = std::size_t(found - mirrors.all.begin());
    if (found == mirrors.all.end())
      mirrors.all.push_back(mirror);
    return place;
  };
  if (conditions.axisymmetric)
  {
    mirrors.all.push_back({{1, 0, 0}, 0, 1, true});
    for (int node = 0; node < mesh.ownedNodes; ++node)
      if (mesh.coordinates[std::size_t(node)].x == 0)
        note(node, 0);
  }
  for (const SymmetryPlane& plane : conditions.symmetries)
  {
    if (conditions.axisymmetric && plane.normal.x != 0)
      continue; // the axis, or no plane but a cone
    const char* lack = "acts in a part of the run";
    Real thickness = 0;
    if (plane.when.isAlways())
      if (const auto mirror = mirrorOf(plane, conditions, mesh, layout.comm(), thickness, lack))
      {
        const std::size_t place = placeOf(*mirror, thickness);
        for (const int node : plane.nodes)
          note(node, place);
        for (int node = 0; node < mesh.ownedNodes; ++node)
          if (const int body = bodies.bodyOf(node);
              body >= 0 && bodies.staysInPlanes(body, mirror->normal) &&
              std::abs(dot(mirror->normal, mesh.coordinates[std::size_t(node)]) - mirror->level) <=
                  thickness)
            note(node, place);
      }
    if (lack != nullptr)
      mirrors.lacks.push_back({plane.where, lack});
  }
  layout.refresh(held);
  for (int node = 0; node < layout.size(); ++node)
    mirrors.ofNode.push_back(std::uint8_t(held(node)));
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
