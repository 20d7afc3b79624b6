#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace coplane
{
/// What a file of Gmsh holds (format 4.1, text or binary), elements of order one.
struct GmshFile
{
  using Tag = std::pair<int, int>; ///< dimension and number
  struct Element
  {
    Tag entity;   ///< of the geometry
    int type = 0; ///< Gmsh's number: 15 point, 1 line, 2 triangle, 3 quadrilateral, 4 tet, 5 hex
    GlobalId id = 0;
    std::array<int, 8> nodes{}; ///< positions in nodeIds
  };
  std::map<Tag, std::string> physicalNames;
  std::map<Tag, std::vector<int>> physicalsOfEntity; ///< numbers of the groups of its dimension
  std::vector<GlobalId> nodeIds;
  std::vector<Vec3> coordinates; ///< [m]
  std::vector<Element> elements;
};

/// Nodes of an element of Gmsh's type; 0 for types that are not read.
int nodesOfGmshType(int type);

/// Reads a file; errors are Error(ExitCode::Mesh) with the line, or the byte in a binary file.
GmshFile readGmshFile(const std::string& file);
} // namespace coplane
