#pragma once

#include <coplane_core/Vec3.hpp>
#include <coplane_dynamics/Conditions.hpp>
#include <coplane_dynamics/RigidBodies.hpp>
#include <coplane_geometry/Mirror.hpp>
#include <coplane_mesh/NodeLayout.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace coplane
{
/// The reflections together that bring a point to the side of mirrors on which bodies are.
struct Image
{
  std::array<Vec3, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; ///< orthogonal
  bool isOther = false;                                        ///< it is not the point itself

  void reflect(const Vec3& normal);
  Vec3 of(const Vec3& vector) const;   ///< here of one there
  Vec3 back(const Vec3& vector) const; ///< there of one here
};

/// The axis, and the symmetries that act in all of the run (of a stage) and hold nodes of one
/// plane. Of the mesh as it was read: so they are the same in all of the run, and after a restart.
struct Mirrors
{
  static constexpr std::size_t most = 8;

  std::vector<Mirror> all; ///< beyond which bodies have images; no two in one plane
  /// By node: bit i < 8 says that it is held in mirror i, or belongs to a rigid body that stays
  /// there; the others, that it is held in a plane beyond which there are no images.
  std::vector<std::uint16_t> ofNode;
  /// Symmetries beyond which bodies have no images, and why.
  struct Lack
  {
    std::string where; ///< in the deck
    std::string why;   ///< "it ..."
  };
  std::vector<Lack> lacks;

  std::vector<Mirror> holding(int node) const;
  /// Whether one plane, with images or without, holds all nodes of a face.
  bool leadsNowhere(const ExteriorFace& face) const;
};
/// Collective.
Mirrors mirrorsOf(const Conditions& conditions, const RigidBodies& bodies, const RankMesh& mesh,
                  const NodeLayout& layout);

/// Brings a place to the side of mirrors on which bodies are [m].
/// @param roundOff distance over that from the origin up to which it lies in a mirror [-]
Image reflectInto(const std::vector<Mirror>& mirrors, Real roundOff, Vec3& x);
} // namespace coplane
