#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>
#include <coplane_mesh/ElementTopology.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// A whole mesh as a file has it. "Index" means the position in the file, counted from 0 (elements:
/// blocks one after another); "id" is the number that users see (Exodus id map).
struct Mesh
{
  struct Block
  {
    GlobalId id = 0;
    std::string name; ///< never empty: block_<id> when the file has none
    ElementType type = ElementType::Hex8;
    std::vector<GlobalId> elementIds;
    std::vector<int> connectivity; ///< node indices, topology(type).nodes per element
    std::vector<int> bodyIds;      ///< one per element; 0 when the file has no attribute body_id
    int elements() const { return int(elementIds.size()); }
  };
  struct NodeSet
  {
    GlobalId id = 0;
    std::string name;       ///< nodelist_<id> when the file has none
    std::vector<int> nodes; ///< node indices
  };
  struct SideSet
  {
    GlobalId id = 0;
    std::string name;          ///< surface_<id> when the file has none
    std::vector<int> elements; ///< element indices
    std::vector<int> sides;    ///< counted from 0, one per element entry
  };

  std::string title;
  int dimension = 3;
  std::vector<GlobalId> nodeIds;
  std::vector<Vec3> coordinates; ///< [m]; z = 0 in two dimensions
  std::vector<Block> blocks;
  std::vector<NodeSet> nodeSets;
  std::vector<SideSet> sideSets;
  std::vector<std::array<std::string, 4>> qaRecords; ///< program, version, date, time

  int nodes() const { return int(nodeIds.size()); }
  int elements() const
  {
    int n = 0;
    for (const Block& block : blocks)
      n += block.elements();
    return n;
  }
};
} // namespace coplane
