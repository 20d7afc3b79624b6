#pragma once

#include <coplane_core/NodeViews.hpp>
#include <coplane_mesh/NodeLayout.hpp>

namespace coplane
{
/// Up to three directions per node, each with a number; directions within 20 degrees are one.
class DirectionsOfNodes
{
public:
  static constexpr int most = 3;
  static constexpr Real one = 0.94;

  explicit DirectionsOfNodes(int nodes);
  /// Unless the node has it already, or has three. The number of one that comes again with another
  /// number is lost.
  void add(int node, const Vec3& direction, int number);
  void refresh(const NodeLayout& layout) const; ///< copies from the owners. Collective.

  int count(int node) const; ///< zero vectors are no directions
  Vec3 direction(int node, int i) const { return at(directions_[i], node); }
  /// Place of a direction, -1: none.
  int find(int node, const Vec3& direction) const;
  /// The number of a direction; -1 if it came with several.
  int number(int node, int i) const { return int(at(numbers_, node)[i]); }

private:
  NodeVectors directions_[most], numbers_;
};
} // namespace coplane
