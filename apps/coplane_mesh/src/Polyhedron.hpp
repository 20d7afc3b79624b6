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
  bool support = false;             ///< stands still; files of assemblies say so
};

/// A surface that is not closed (an edge that is not of two faces) is an Error(ExitCode::Mesh).
void demandClosed(const Polyhedron& solid, const std::string& file);

/// Whether all corners of all faces lie on planes, as Gmsh demands.
bool isPlane(const Polyhedron& solid);
} // namespace coplane
