#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_core/NodeViews.hpp>
#include <coplane_mesh/RankMesh.hpp>
#include <coplane_mesh/Redistribution.hpp>

#include <optional>
#include <unordered_map>
#include <vector>

namespace coplane
{
/// Numbers the nodes that this rank knows: owned, other nodes of held elements, nodes of ghost
/// faces; and refreshes the copies from their owners.
class NodeLayout
{
public:
  NodeLayout(const Comm& comm, const RankMesh& mesh);

  const Comm& comm() const { return *comm_; }
  int owned() const { return owned_; }
  int ofElements() const { return ofElements_; } ///< owned and other nodes of held elements
  int size() const { return int(ids_.size()); }
  const std::vector<GlobalId>& ids() const { return ids_; }
  /// Local number of a node, -1 when this rank does not know it.
  int localNode(GlobalId id) const;

  /// Replaces the nodes of ghost faces. Ids that are known already are not doubled. The import is
  /// rebuilt only when the list changed on some rank; returns whether it was. Collective.
  bool setGhostNodes(const std::vector<GlobalId>& ids);

  /// Copies positions and velocities of owned nodes to all their copies: the one message of a
  /// cycle. Collective.
  void refresh(const NodeVectors& x, const NodeVectors& v) const;
  /// The same for one number per node. Collective.
  void refresh(const Array<Real>& values) const;

private:
  void rebuild();

  const Comm* comm_;
  int owned_ = 0;
  int ofElements_ = 0;
  std::vector<GlobalId> ids_;
  std::unordered_map<GlobalId, int> localNodes_;
  std::optional<Redistribution> import_;
  Table<Real> from_, to_;
};
} // namespace coplane
