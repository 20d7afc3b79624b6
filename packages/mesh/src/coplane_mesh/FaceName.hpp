#pragma once

#include <coplane_mesh/ElementTopology.hpp>

#include <fmt/format.h>

#include <string>

namespace coplane
{
/// How messages name a face: by what the mesh and the files of planes call it, sides counted
/// from 1.
inline std::string faceName(GlobalId face)
{
  return fmt::format("side {} of element {}", sideOfFace(face) + 1, elementOfFace(face));
}
} // namespace coplane
