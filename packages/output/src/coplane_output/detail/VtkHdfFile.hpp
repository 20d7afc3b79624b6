#pragma once

#include <coplane_output/detail/PlanePoints.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace coplane
{
/// How many rows and steps a VTKHDF file has room for.
struct VtkHdfRoom
{
  std::int64_t rows = 0, steps = 0;
};

/// A VTKHDF file (version 2.0, an UnstructuredGrid of vertices with Steps) without its tables: all
/// that HDF5 itself keeps in it. Tables have their places, with room for rows and steps to come;
/// only the times are as many as there are steps, since readers take all of them. So a step is
/// added by writing its rows to their places and then the few bytes in which the skeletons of n and
/// n + 1 steps differ: 8 bytes of the number of steps, then 8 of the number of times.
struct VtkHdfSkeleton
{
  std::vector<std::pair<std::uint64_t, std::string>> pieces; ///< place and bytes
  std::uint64_t bytes = 0;                                   ///< of the file
  std::map<std::string, std::uint64_t> places;               ///< of tables, by path under VTKHDF
};

/// @param writer text that stands near the beginning of the file, in an attribute
/// @param steps at least 1
/// @param columns names, components and kinds of values
/// @throws MemoryFile::Failure, hdf5::Failure
VtkHdfSkeleton vtkHdfSkeleton(const std::string& writer, const std::vector<PlaneColumn>& columns,
                              const std::vector<std::string>& joints, const VtkHdfRoom& room,
                              std::int64_t steps);
} // namespace coplane
