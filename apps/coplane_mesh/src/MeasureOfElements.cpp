#include "MeasureOfElements.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace coplane
{
Real measureOfElements(const GmshFile& mesh, int dimension)
{
  Real sum = 0;
  std::vector<std::array<int, 3>> faces;
  for (const GmshFile::Element& element : mesh.elements)
  {
    if (element.entity.first != dimension)
      continue;
    const auto& n = element.nodes;
    const auto x = [&](std::size_t k) { return mesh.coordinates[std::size_t(n[k])]; };
    if (dimension == 2)
    {
      const std::size_t last = std::size_t(nodesOfGmshType(element.type)) - 1;
      sum +=
          norm(last == 2 ? cross(x(1) - x(0), x(2) - x(0)) : cross(x(2) - x(0), x(3) - x(1))) / 2;
      continue;
    }
    sum += std::abs(dot(cross(x(1) - x(0), x(2) - x(0)), x(3) - x(0))) / 6;
    for (std::size_t k = 0; k < 4; ++k)
    {
      faces.push_back({n[(k + 1) % 4], n[(k + 2) % 4], n[(k + 3) % 4]});
      std::sort(faces.back().begin(), faces.back().end());
    }
  }
  std::sort(faces.begin(), faces.end());
  for (std::size_t f = 2; f < faces.size(); ++f)
    if (faces[f] == faces[f - 2])
      return std::numeric_limits<Real>::quiet_NaN();
  return sum;
}
} // namespace coplane
