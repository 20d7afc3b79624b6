#pragma once

#include "Polyhedron.hpp"

#include <string>
#include <vector>

namespace coplane
{
/// The solids of a file (STL, OBJ, PLY and whatever else Assimp reads; .json: readCompasBlocks).
/// Each is one group, object or mesh of the file; where a group has several shells that hang
/// together nowhere, each is a solid, or a cavity of the one around it. If a face is not plane, all
/// are cut into triangles. A file that cannot be read, or a surface that is not closed (an edge
/// that is not of two faces), is an Error(ExitCode::Mesh).
std::vector<Polyhedron> readSolids(const std::string& file);
} // namespace coplane
