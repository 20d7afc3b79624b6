#include <coplane_dynamics/ModelExtent.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
ModelExtent extentOf(const RankMesh& mesh, const Comm& comm)
{
  std::vector<Real> most(6, -infinity); // largest and minus least of each axis
  for (const Vec3& x : mesh.coordinates)
    for (int c = 0; c < 3; ++c)
    {
      most[std::size_t(2 * c)] = std::max(most[std::size_t(2 * c)], x[c]);
      most[std::size_t(2 * c + 1)] = std::max(most[std::size_t(2 * c + 1)], -x[c]);
    }
  comm.max(most);
  ModelExtent extent;
  for (std::size_t c = 0; c < 6; c += 2)
  {
    extent.size = std::max(extent.size, most[c] + most[c + 1]);
    extent.farthest = std::max({extent.farthest, std::abs(most[c]), std::abs(most[c + 1])});
  }
  return extent;
}
} // namespace coplane
