#pragma once

#include "CutBlocks.hpp"
#include "ElementSizes.hpp"

#include <map>
#include <set>
#include <vector>

namespace coplane
{
/// A domain that was cut, in the geometry that is open in Gmsh.
struct CutGeometry
{
  Vec3 low{}, high{};                  ///< its box [m]
  std::map<GmshFile::Tag, int> pieces; ///< parts of joints, and whose
  std::set<GmshFile::Tag> walls;       ///< faces of openings
  SizedParts sized;
  std::vector<int> groupOfJoint; ///< numbers of the physical groups, by joint
};

/// Meshes it with Gmsh, mends what is flat and judges the rest; fills the mesh and its worst
/// element. Errors as those of cutDomain().
/// @param domain has the names of physical groups and the volumes of blocks
void meshDomain(const BlocksRecipe& recipe, const std::string& recipeFile, const MeshingWay& way,
                Stages& stages, const CutGeometry& geometry, CutDomain& domain);
} // namespace coplane
