#include "CubesOfTetrahedra.hpp"

#include <coplane_exodus/MeshReport.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace coplane
{
void cutIntoCubes(GmshFile& mesh)
{
  std::map<std::vector<int>, int> middles; // by the corners that they are between
  const auto middleOf = [&](std::vector<int> corners)
  {
    std::sort(corners.begin(), corners.end());
    const auto [place, isNew] = middles.insert({corners, int(mesh.coordinates.size())});
    if (isNew)
    {
      Vec3 middle{};
      for (const int corner : corners)
        middle += (1 / Real(corners.size())) * mesh.coordinates[std::size_t(corner)];
      mesh.coordinates.push_back(middle);
      mesh.nodeIds.push_back(GlobalId(mesh.nodeIds.size()) + 1);
    }
    return place->second;
  };
  std::vector<GmshFile::Element> cut;
  const auto add = [&](const GmshFile::Element& whole, int type, const std::array<int, 8>& nodes) {
    cut.push_back({whole.entity, type, GlobalId(cut.size()) + 1, nodes});
  };
  for (const GmshFile::Element& whole : mesh.elements)
  {
    const auto& n = whole.nodes;
    if (whole.type == 1)
    {
      add(whole, 1, {n[0], middleOf({n[0], n[1]})});
      add(whole, 1, {middleOf({n[0], n[1]}), n[1]});
    }
    else if (whole.type == 2)
      for (std::size_t k = 0; k < 3; ++k)
      {
        const int a = n[k], b = n[(k + 1) % 3], c = n[(k + 2) % 3];
        add(whole, 3, {a, middleOf({a, b}), middleOf({a, b, c}), middleOf({a, c})});
      }
    else
    {
      constexpr std::size_t turns[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
      for (const auto& turn : turns)
      {
        const int a = n[turn[0]], b = n[turn[1]], c = n[turn[2]], d = n[turn[3]];
        add(whole, 5,
            {a, middleOf({a, b}), middleOf({a, b, c}), middleOf({a, c}), middleOf({a, d}),
             middleOf({a, b, d}), middleOf({a, b, c, d}), middleOf({a, c, d})});
      }
    }
  }
  mesh.elements = cut;
}

Real worthOf(const std::array<Vec3, 8>& x, Real size)
{
  const ElementTopology& shape = topology(ElementType::Hex8);
  Real largest = 0;
  for (int side = 0; side < shape.sides; ++side)
  {
    const auto corner = [&](int k) { return x[std::size_t(shape.sideNodes[side][k])]; };
    largest = std::max(largest, norm(cross(corner(2) - corner(0), corner(3) - corner(1))) / 2);
  }
  if (!(largest > 0))
    return 0;
  // Of a regular tetrahedron of edge 2: volume sqrt(2) / 6, largest face sqrt(3) / 3.
  const Real height = elementVolume(ElementType::Hex8, x) / largest;
  return std::min(elementQuality(ElementType::Hex8, x), height / (size / std::sqrt(6.0)));
}
} // namespace coplane
