#include "MeshFaces.hpp"

#include <coplane_core/Error.hpp>

#include <algorithm>
#include <numeric>

namespace coplane
{
std::vector<ElementPlace> placesOfElements(const Mesh& mesh)
{
  std::vector<ElementPlace> places;
  for (int b = 0; b < int(mesh.blocks.size()); ++b)
    for (int e = 0; e < mesh.blocks[b].elements(); ++e)
      places.push_back({b, e});
  return places;
}

std::vector<MeshFace> facesOf(const Mesh& mesh)
{
  struct Side
  {
    std::array<int, 4> sortedNodes;
    int element, side;
    std::array<int, 4> nodes;
  };
  std::vector<Side> sides;
  int element = 0;
  for (const Mesh::Block& block : mesh.blocks)
  {
    const ElementTopology& shape = topology(block.type);
    for (int e = 0; e < block.elements(); ++e, ++element)
      for (int s = 0; s < shape.sides; ++s)
      {
        std::array<int, 4> nodes{-1, -1, -1, -1};
        for (int k = 0; k < shape.nodesPerSide; ++k)
          nodes[k] = block.connectivity[e * shape.nodes + shape.sideNodes[s][k]];
        std::array<int, 4> sorted = nodes;
        std::sort(sorted.begin(), sorted.end());
        sides.push_back({sorted, element, s, nodes});
      }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b)
            {
              return std::tie(a.sortedNodes, a.element, a.side) <
                     std::tie(b.sortedNodes, b.element, b.side);
            });
  std::vector<MeshFace> faces;
  for (std::size_t i = 0; i < sides.size(); ++i)
  {
    if (i == 0 || sides[i].sortedNodes != sides[i - 1].sortedNodes)
      faces.push_back({0, {-1, -1}, {-1, -1}, sides[i].nodes});
    MeshFace& face = faces.back();
    if (face.count == 2)
    {
      const auto places = placesOfElements(mesh);
      const auto id = [&](int e)
      { return mesh.blocks[places[e].block].elementIds[places[e].index]; };
      fail(ExitCode::Mesh,
           "the elements {}, {} and {} share one face; a face belongs to one element or to two. "
           "Repair the mesh there.",
           id(face.elements[0]), id(face.elements[1]), id(sides[i].element));
    }
    face.elements[face.count] = sides[i].element;
    face.sides[face.count++] = sides[i].side;
  }
  std::sort(faces.begin(), faces.end(),
            [](const MeshFace& a, const MeshFace& b) {
              return std::pair(a.elements[0], a.sides[0]) < std::pair(b.elements[0], b.sides[0]);
            });
  return faces;
}

Vec3 centreOf(const Mesh& mesh, const MeshFace& face)
{
  Vec3 sum{};
  int nodes = 0;
  for (const int node : face.nodes)
    if (node >= 0)
    {
      sum += mesh.coordinates[node];
      ++nodes;
    }
  return (1.0 / nodes) * sum;
}

namespace
{
/// Normal to a face, of the length of its area.
Vec3 vectorAreaOf(const Mesh& mesh, const MeshFace& face)
{
  const auto x = [&](int k) { return mesh.coordinates[face.nodes[k]]; };
  if (mesh.dimension == 2)
  {
    const Vec3 edge = x(1) - x(0);
    return {edge.y, -edge.x, 0};
  }
  const Vec3 last = face.nodes[3] < 0 ? x(0) : x(3); // of a triangle: x(0), x(1), x(2), x(0)
  return 0.5 * cross(x(2) - x(0), last - x(1));
}
} // namespace

Vec3 normalOf(const Mesh& mesh, const MeshFace& face)
{
  return normalised(vectorAreaOf(mesh, face));
}

Real areaOf(const Mesh& mesh, const MeshFace& face)
{
  return norm(vectorAreaOf(mesh, face));
}

Real sizeOf(const Mesh& mesh)
{
  Vec3 low{infinity, infinity, infinity}, high = -low;
  for (const Vec3& x : mesh.coordinates)
    for (int axis = 0; axis < 3; ++axis)
    {
      low[axis] = std::min(low[axis], x[axis]);
      high[axis] = std::max(high[axis], x[axis]);
    }
  return norm(high - low);
}

std::vector<int> bodiesOfElements(const Mesh& mesh)
{
  std::vector<int> parent(mesh.nodes());
  std::iota(parent.begin(), parent.end(), 0);
  const auto rootOf = [&](int node)
  {
    while (parent[node] != node)
      node = parent[node] = parent[parent[node]];
    return node;
  };
  for (const Mesh::Block& block : mesh.blocks)
  {
    const int perElement = topology(block.type).nodes;
    for (int e = 0; e < block.elements(); ++e)
      for (int k = 1; k < perElement; ++k)
        parent[rootOf(block.connectivity[e * perElement + k])] =
            rootOf(block.connectivity[e * perElement]);
  }
  std::vector<int> numberOf(mesh.nodes(), 0), bodies;
  int count = 0;
  for (const Mesh::Block& block : mesh.blocks)
    for (int e = 0; e < block.elements(); ++e)
    {
      int& number = numberOf[rootOf(block.connectivity[e * topology(block.type).nodes])];
      if (number == 0)
        number = ++count;
      bodies.push_back(number);
    }
  return bodies;
}
} // namespace coplane
