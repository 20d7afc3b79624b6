#pragma once

#include <coplane_core/Vec3.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// A solid by its closed surface of plane polygons.
struct Polyhedron
{
  std::string name;
  std::vector<Vec3> points; ///< [m]
  std::vector<std::vector<int>> faces;
  std::vector<Polyhedron> cavities; ///< holes inside, which do not reach the surface
};

/// The solids of a file (STL, OBJ, PLY and whatever else Assimp reads). Each is one group, object
/// or mesh of the file; where a group has several shells that hang together nowhere, each is a
/// solid, or a cavity of the one around it. If a face is not plane, all are cut into triangles. A
/// file that cannot be read, or a surface that is not closed (an edge that is not of two faces), is
/// an Error(ExitCode::Mesh).
std::vector<Polyhedron> readSolids(const std::string& file);
} // namespace coplane
