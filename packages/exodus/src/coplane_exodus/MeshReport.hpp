#pragma once

#include <coplane_mesh/Mesh.hpp>

#include <array>
#include <string>
#include <vector>

namespace coplane
{
/// Sizes of a mesh and everything about it that a computation would stumble over.
struct MeshReport
{
  struct BadElement
  {
    GlobalId element = 0;
    std::string block;
    Real volume = 0; ///< [m^3]; in two dimensions [m^2] times one metre
  };
  struct NodePair
  {
    GlobalId first = 0, second = 0;
  };
  struct BlockSummary
  {
    GlobalId id = 0;
    std::string name;
    std::string type;
    int elements = 0;
    int bodies = 0;  ///< parts that share no node with each other
    Real volume = 0; ///< [m^3], or [m^2] times one metre
  };

  int dimension = 3;
  int nodes = 0;
  int elements = 0;
  int bodies = 0;                         ///< parts that share no node with each other
  Vec3 lowest{}, highest{};               ///< bounding box [m]
  Real shortestEdge = 0, longestEdge = 0; ///< [m]
  std::vector<BlockSummary> blocks;
  std::vector<BadElement> inverted;      ///< volume zero or negative
  std::vector<BadElement> repeatedNodes; ///< a node occurs twice in the element
  std::vector<GlobalId> unusedNodes;     ///< of no element
  std::vector<NodePair> coincident;      ///< two nodes of one body at one place

  /// No computation can start with inverted elements or repeated nodes; the other findings are for
  /// the eye.
  bool usable() const { return inverted.empty() && repeatedNodes.empty(); }
};

MeshReport reportMesh(const Mesh& mesh);

/// One sentence per kind of finding, with ids (the first few of many) and advice; empty for a
/// faultless mesh.
std::vector<std::string> meshProblems(const MeshReport& report);
std::vector<std::string> meshProblems(const Mesh& mesh);

/// Area of a quadrilateral times one metre, or volume of a trilinear hexahedron (Flanagan &
/// Belytschko 1981) [m^3]; negative when the element is inside out. `corners` holds
/// topology(type).nodes positions.
Real elementVolume(ElementType type, const std::array<Vec3, 8>& corners);
} // namespace coplane
