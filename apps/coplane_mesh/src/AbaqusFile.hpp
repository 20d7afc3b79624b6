#pragma once

#include "GmshFile.hpp"

#include <string>
#include <vector>

namespace coplane
{
/// A file of Abaqus or CalculiX (.inp) in the terms of Gmsh: sections (or, without any, the element
/// sets of *ELEMENT) are physical groups of the highest dimension, surfaces of elements groups of
/// one dimension less, node sets groups of points.
struct AbaqusFile
{
  GmshFile mesh;
  std::vector<std::string> notes; ///< what is left out, a line each
};

/// Reads a file; errors are Error(ExitCode::Mesh) with the line.
AbaqusFile readAbaqusFile(const std::string& file);
} // namespace coplane
