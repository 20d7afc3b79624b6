#pragma once

#include <coplane_core/NodeViews.hpp>
#include <coplane_mesh/NodeLayout.hpp>

#include <vector>

namespace coplane
{
/// Normals of the faces around each node: all of them, so that it does not matter in which order
/// faces come. A normal is told from others by its bits: both ends of an edge have those of the
/// faces on both sides of it.
class NormalsOfNodes
{
public:
  explicit NormalsOfNodes(int nodes) : nodes_(nodes) {}
  void add(int node, const Vec3& normal);
  void refresh(const NodeLayout& layout); ///< copies from the owners. Collective.

  /// Nodes have up to so many.
  int most() const { return int(normals_.size()); }
  /// Zero: none, and none behind it.
  Vec3 normal(int node, int i) const { return at(normals_[i], node); }
  bool has(int node, const Vec3& normal) const;

private:
  void grow();

  int nodes_;
  std::vector<NodeVectors> normals_;
};
} // namespace coplane
