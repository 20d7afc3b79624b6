#pragma once

#include <coplane_mesh/Mesh.hpp>

#include <string>

namespace coplane
{
/// Writes a mesh as an Exodus II file of 8-byte reals, in this process; no MPI. Ids, names and QA
/// records are the mesh's, the block attribute `body_id` is written always. It takes its name when
/// it is whole; what has the name and is no mesh of coplane_mesh is put aside. Throws
/// Error(ExitCode::Output) when it cannot be written.
void writeMesh(const Mesh& mesh, const std::string& file);
} // namespace coplane
