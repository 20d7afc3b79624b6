#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_dynamics/Conditions.hpp>
#include <coplane_dynamics/Model.hpp>

#include <array>
#include <map>
#include <vector>

namespace coplane
{
/// A face of a free-field side, as all ranks know it.
struct FreeFieldFaceRecord
{
  GlobalId id = 0;
  int block = 0;
  int count = 0;
  GlobalId nodes[4] = {0, 0, 0, 0};
  Vec3 corners[4];                              ///< at the start, in the order of the side [m]
  Real volume = 0;                              ///< of the element behind it [m^3]
  Real normalImpedance = 0, shearImpedance = 0; ///< [Pa s/m]
};

/// A layer of the side between two neighbouring heights of its nodes.
struct FreeFieldLayer
{
  FreeFieldFaceRecord face; ///< the one with the lowest id stands for all
  Real depth = 0;           ///< of the element across the side [m]
  Real breadth = 1;         ///< of the face along the side; 1 in two dimensions [m]
};

/// A vertical side, divided into layers by the heights of its nodes; the same on all ranks.
struct FreeFieldLayers
{
  Vec3 up{}, normal{}, along{};           ///< unit: against gravity, outward, and the third one
  Real offset = 0;                        ///< of the plane along its normal [m]
  std::vector<Real> heights;              ///< of levels, rising [m]
  std::vector<FreeFieldLayer> layers;     ///< between them
  std::vector<GlobalId> nodeOfLevel;      ///< the lowest id
  std::vector<Vec3> placeOfLevel;         ///< of that node at the start [m]
  std::vector<std::int64_t> nodesOfLevel; ///< how many there are
  /// Levels of the corners of this rank's faces, by face id.
  std::map<GlobalId, std::array<int, 4>> levels;
  int levelAt(Real height) const; ///< the nearest
};

/// Whether this rank owns the node of a face that has the lowest id: so is each face on one rank,
/// and one that has it; the rank that owns the element behind it may not.
bool isOfThisRank(const LoadedSide& side, const RankMesh& mesh);

/// Throws on all ranks where the side is not vertical and plane, where a face does not reach from
/// one height of nodes to the next, where a layer has several blocks, where the side is not a
/// rectangle, or where it is cut into parts that have nodes of their own. Collective.
FreeFieldLayers freeFieldLayers(const FreeFieldBoundary& boundary, const Model& model,
                                const Comm& comm);
} // namespace coplane
