#include "Polyhedron.hpp"

#include <coplane_core/Error.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace coplane
{
void demandClosed(const Polyhedron& solid, const std::string& file)
{
  std::map<std::pair<int, int>, int> facesOfEdge;
  for (const std::vector<int>& face : solid.faces)
    for (std::size_t k = 0; k < face.size(); ++k)
      ++facesOfEdge[std::minmax(face[k], face[(k + 1) % face.size()])];
  for (const auto& [edge, count] : facesOfEdge)
    if (count != 2)
    {
      const Vec3 &a = solid.points[std::size_t(edge.first)],
                 &b = solid.points[std::size_t(edge.second)];
      fail(ExitCode::Mesh,
           "{}: the surface of '{}' is not closed: the edge from ({}, {}, {}) to ({}, {}, {}) m "
           "belongs to {} face{}, and two were expected. Mend the surface, for instance by "
           "merging points that lie on each other{}.",
           file, solid.name, a.x, a.y, a.z, b.x, b.y, b.z, count, count == 1 ? "" : "s",
           count > 2 ? "; solids that touch are groups or objects of their own" : "");
    }
}

bool isPlane(const Polyhedron& solid)
{
  constexpr Real tolerance = 1e-7; // [m], that of Open Cascade
  for (const std::vector<int>& face : solid.faces)
  {
    Vec3 normal{};
    const Vec3& first = solid.points[std::size_t(face[0])];
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
      normal = normal + cross(solid.points[std::size_t(face[k])] - first,
                              solid.points[std::size_t(face[k + 1])] - first);
    for (const int corner : face)
      if (std::abs(dot(solid.points[std::size_t(corner)] - first, normal)) >
          tolerance * norm(normal))
        return false;
  }
  return true;
}
} // namespace coplane
