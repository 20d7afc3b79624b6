#pragma once

#include "RecipeMap.hpp"
#include "Shapes.hpp"

#include <string>
#include <vector>

namespace coplane
{
/// One entry of `parts`: bodies in the part's own coordinates, and where they go.
struct Part
{
  std::string block;
  std::string keyPlace; ///< of the key `block` in the recipe, for messages
  std::vector<Body> bodies;
  Mat3 rotation; ///< about `centre`
  Vec3 centre{}; ///< in own coordinates [m]
  Vec3 offset{}; ///< added last [m]

  Vec3 place(const Vec3& own) const { return rotation * (own - centre) + centre + offset; }
};

/// Reads and makes one part.
Part readPart(const YAML::Node& node, const std::string& file, const std::string& path,
              int dimension);
} // namespace coplane
