#include "VoronoiCells.hpp"

#include <algorithm>
#include <cmath>
#include <voro++/voro++.hh>

namespace coplane
{
namespace
{
/// Calls `visit(point, cell, position)` for every point and its cell.
template <class Visit>
void forCells(const std::vector<Vec3>& points, const Vec3& low, const Vec3& high,
              const Visit& visit)
{
  // About five points in each bin, as the manual of Voro++ advises.
  const int bins = std::max(1, int(std::cbrt(Real(points.size()) / 5)));
  voro::container all(low.x, high.x, low.y, high.y, low.z, high.z, bins, bins, bins, false, false,
                      false, 8);
  for (std::size_t p = 0; p < points.size(); ++p)
    all.put(int(p), points[p].x, points[p].y, points[p].z);
  voro::c_loop_all loop(all);
  voro::voronoicell_neighbor cell;
  if (loop.start())
    do
      if (all.compute_cell(cell, loop))
        visit(loop.pid(), cell);
    while (loop.inc());
}
} // namespace

std::vector<JointSurface> voronoiSurfaces(const VoronoiCard& card, int joint, int seed,
                                          int dimension, const Vec3& low, const Vec3& high)
{
  // Cells of the plane are prisms whose points lie halfway up.
  Vec3 bottom = low, top = high;
  if (dimension == 2)
  {
    bottom.z = -0.5;
    top.z = 0.5;
  }
  Draws draws(seed, joint);
  std::vector<Vec3> points(std::size_t(card.cells));
  for (Vec3& point : points)
    for (int axis = 0; axis < dimension; ++axis)
      point[axis] = low[axis] + (high[axis] - low[axis]) * draws.uniform();
  for (int pass = 0; pass < card.relaxations; ++pass)
  {
    std::vector<Vec3> middles = points;
    forCells(points, bottom, top,
             [&](int point, voro::voronoicell_neighbor& cell)
             {
               Vec3 middle{};
               cell.centroid(middle.x, middle.y, middle.z);
               for (int axis = 0; axis < dimension; ++axis)
                 middles[std::size_t(point)][axis] += middle[axis];
             });
    points = middles;
  }
  std::vector<JointSurface> surfaces;
  forCells(points, bottom, top,
           [&](int point, voro::voronoicell_neighbor& cell)
           {
             const Vec3 centre = points[std::size_t(point)];
             std::vector<int> neighbours, faces;
             std::vector<double> places;
             cell.neighbors(neighbours);
             cell.face_vertices(faces);
             cell.vertices(centre.x, centre.y, centre.z, places);
             std::size_t at = 0;
             for (const int neighbour : neighbours)
             {
               const int count = faces[at++];
               if (neighbour > point) // borders of the box are negative
               {
                 std::vector<Vec3> corners;
                 for (int k = 0; k < count; ++k)
                 {
                   const double* x = &places[3 * std::size_t(faces[at + std::size_t(k)])];
                   if (dimension == 3)
                     corners.push_back({x[0], x[1], x[2]});
                   else if (x[2] < 0)
                     corners.push_back({x[0], x[1], 0});
                 }
                 surfaces.push_back({joint, corners, ""});
               }
               at += std::size_t(count);
             }
           });
  return surfaces;
}
} // namespace coplane
