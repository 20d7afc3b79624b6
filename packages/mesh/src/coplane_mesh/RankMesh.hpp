#pragma once

#include <coplane_mesh/Mesh.hpp>

#include <array>
#include <string>
#include <unordered_map>
#include <vector>

namespace coplane
{
/// This rank's part of the mesh. Every node has one owner; a rank holds every element that touches
/// a node it owns, so some elements are held, and computed, by several ranks from identical data.
///
/// Local node numbers: owned nodes first, then the other nodes of held elements; NodeLayout appends
/// the nodes of ghost faces.
struct RankMesh
{
  struct Block
  {
    int meshBlock = 0; ///< position of the block in the mesh file
    ElementType type = ElementType::Hex8;
    std::vector<GlobalId> elementIds;
    std::vector<int> positions;    ///< of the elements within their block of the file
    std::vector<int> connectivity; ///< local nodes
    std::vector<int> bodyIds;
    std::vector<char>
        owned; ///< 1 where this rank owns the element's lowest-id node: counted and written here
    GlobalId id = 0; ///< of the block in the mesh file
    int elements() const { return int(elementIds.size()); }
  };
  struct Side
  {
    int block, element, side; ///< block and element of this rank, side counted from 0
    int position = 0;         ///< in the side set of the file
  };

  int dimension = 3;
  int ownedNodes = 0;
  std::vector<GlobalId> nodeIds;
  std::vector<int> nodePositions;  ///< of the nodes in the file
  std::vector<Vec3> coordinates;   ///< [m]
  std::vector<int> ownersOfOthers; ///< ranks of the nodes after the owned ones
  std::vector<Block> blocks;       ///< all blocks of the file, some perhaps without elements here
  std::vector<std::vector<int>> nodeSets;  ///< owned local nodes of each node set of the file
  std::vector<std::vector<Side>> sideSets; ///< sides of held elements of each side set of the file

  int nodes() const { return int(nodeIds.size()); }
};

/// A face that belongs to exactly one element. Local: this rank owns at least one of its nodes.
struct ExteriorFace
{
  GlobalId id = 0; ///< faceId(element id, side)
  int block = 0, element = 0, side = 0;
  int nodeCount = 0;
  std::array<int, 4> nodes{-1, -1, -1, -1}; ///< local nodes, outward normal by the right-hand rule
  bool ownedHere = false;                   ///< this rank owns its node with the lowest id
};

/// The local exterior faces of this rank, sorted by id. Held elements suffice to find them: all
/// elements that touch an owned node are here, hence also the one behind a face that has such a
/// node.
std::vector<ExteriorFace> exteriorFaces(const RankMesh& mesh);

/// All sides of all held elements that have an owned node, to find the exterior faces of a body
/// that loses elements: a face between a dead element and a living one becomes exterior. A face
/// keeps its id, and its corners their order, as long as its element lives.
class ElementSides
{
public:
  explicit ElementSides(const RankMesh& mesh);

  /// The local faces that belong to exactly one living element, sorted by id.
  /// @param alive [block][element] of the mesh
  std::vector<ExteriorFace> exterior(const std::vector<std::vector<char>>& alive) const;

private:
  std::vector<ExteriorFace> sides_; ///< those with the same nodes stand together
  std::vector<int> start_;          ///< of the sides with the same nodes; one more at the end
};
} // namespace coplane
