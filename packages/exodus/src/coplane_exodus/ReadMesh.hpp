#pragma once

#include <coplane_mesh/Mesh.hpp>

#include <string>

namespace coplane
{
/// Reads a whole Exodus II file (any netCDF kind) in this process; no MPI. Ids come from the id
/// maps, names and node and side sets from the file, body ids from the element attribute `body_id`.
/// Element blocks of type QUAD, QUAD4, HEX and HEX8 (any case); empty blocks without a type are
/// skipped. When the file does not exist but its parts for N ranks do (MeshParts.hpp), these are
/// read and put together. Distribution factors and other attributes are not kept. Throws
/// Error(ExitCode::Mesh) with file, finding and advice when the file is missing, unreadable or
/// unusable.
Mesh readMesh(const std::string& file);
} // namespace coplane
