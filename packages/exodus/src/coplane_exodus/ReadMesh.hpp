#pragma once

#include <coplane_mesh/MeshSlice.hpp>

#include <string>

namespace coplane
{
/// Reads an Exodus II file (any netCDF kind), every rank its slice. Ids come from the id maps,
/// names and node and side sets from the file, body ids from the element attribute `body_id`.
/// Element blocks of type TRI3, QUAD4, TETRA4 and HEX8 and their other names (any case); empty
/// blocks without a type are skipped. When the file does not exist but its parts for N ranks do
/// (MeshParts.hpp), these are dealt out to the ranks, read and put together. Distribution factors
/// and other attributes are not kept. Throws Error(ExitCode::Mesh) on all ranks, with file, finding
/// and advice, when the file is missing, unreadable or unusable. Collective.
MeshSlice readMesh(const std::string& file, const Comm& comm);

/// The whole mesh, in this process; no MPI.
Mesh readMesh(const std::string& file);

/// Opens a file, reads the beginning of every list in it and closes it; errors are for who reads
/// the whole. `coplane_mesh probe` does it in a process of its own with files that the HDF5 library
/// may not survive.
void probeMeshFile(const std::string& file);
} // namespace coplane
