#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_core/Real.hpp>

#include <cstdint>
#include <string>

namespace coplane
{
/// What stands in the first bytes of a checkpoint, in front of the HDF5 data, as lines of text. The
/// checksum covers all bytes behind, so that HDF5 never reads a file that is not whole.
struct CheckpointHead
{
  static constexpr int version = 24;              ///< of the format
  static constexpr std::uint64_t headBytes = 512; ///< the user block of HDF5

  std::int64_t cycle = 0;
  Real time = 0; ///< [s]
  std::string program;
  std::uint64_t bytes = 0;    ///< of the file
  std::uint64_t checksum = 0; ///< of the bytes from headBytes on

  std::string text() const;
};

/// Reads the head alone. Returns what is wrong with the file, empty: nothing that can be seen from
/// its head and its size. Not collective.
std::string inspectCheckpoint(const std::string& file, CheckpointHead& head);

/// Checksum of all bytes of a file from headBytes on: a sum of mixed words, shared out to the
/// ranks. Collective.
/// @param problem what kept this rank from reading its part, if something did
std::uint64_t checksumOfCheckpoint(const std::string& file, std::uint64_t bytes, const Comm& comm,
                                   std::string& problem);

/// Reads the whole file. Returns what is wrong with it, the same on all ranks. Collective.
std::string verifyCheckpoint(const std::string& file, const Comm& comm, CheckpointHead& head);
} // namespace coplane
