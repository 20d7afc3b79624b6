#pragma once

#include <coplane_exodus/MeshReport.hpp>
#include <coplane_mesh/Mesh.hpp>

#include <string>
#include <utility>
#include <vector>

namespace coplane
{
// What the commands of coplane_mesh have in common.

/// A line on standard output.
void print(const std::string& text);

/// Throws Error(Usage) unless the output is a file of its own. @param inputs with what messages
/// call them
void demandDistinct(const std::vector<std::pair<std::string, std::string>>& inputs,
                    const std::string& output);

/// Prints what the mesh is and what was found, and writes it; nobody else writes the file
/// meanwhile. Throws Error(Mesh) when no computation can use the mesh. @param source what messages
/// call the origin of the mesh
void reportAndWrite(const Mesh& mesh, const std::string& source, const std::string& output);

/// The report alone. @param source as above
void reportOn(const Mesh& mesh, const std::string& source);
} // namespace coplane
