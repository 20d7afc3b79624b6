#pragma once

#include "GmshFile.hpp"

#include <coplane_core/Real.hpp>

#include <gmsh.h>
#include <vector>

namespace coplane
{
// What is asked of the geometry that is open in Gmsh.

using Entity = GmshFile::Tag; ///< dimension and tag, as Gmsh has them
using Entities = std::vector<Entity>;

/// Tags of what borders an entity, one dimension lower.
inline std::vector<int> bordersOf(const Entity& entity)
{
  std::vector<int> above, below;
  gmsh::model::getAdjacencies(entity.first, entity.second, above, below);
  return below;
}

/// Tags of what an entity borders, one dimension higher; none where it ends inside of a block.
inline std::vector<int> blocksAt(const Entity& entity)
{
  std::vector<int> above, below;
  gmsh::model::getAdjacencies(entity.first, entity.second, above, below);
  return above;
}

/// Length, area or volume.
inline Real measureOf(const Entity& entity)
{
  double measure = 0;
  gmsh::model::occ::getMass(entity.first, entity.second, measure);
  return measure;
}
} // namespace coplane
