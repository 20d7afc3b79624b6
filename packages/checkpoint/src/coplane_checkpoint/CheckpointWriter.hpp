#pragma once

#include <coplane_checkpoint/StateTables.hpp>
#include <coplane_core/TextFile.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace coplane
{
/// Collects named tables, lists of numbers and texts, and writes them to one HDF5 file, all ranks
/// together. The file has the same bytes on any number of ranks.
class CheckpointWriter : public StateTables
{
public:
  using StateTables::StateTables;

  /// Writes beside the file, reads everything back and compares, makes it safe against a loss of
  /// power, and renames: whoever looks sees the old or the new file, whole. Throws
  /// Error(ExitCode::Output) on all ranks with the reason. Collective.
  /// @param replaced of rank 0: the file, when others may take its name
  void write(const std::string& file, std::int64_t cycle, Real time,
             ReplacedFile* replaced = nullptr) const;

private:
  std::vector<std::uint64_t> makeFile(const std::string& name) const;
  std::string writeSkeleton(const std::string& draft, std::vector<std::uint64_t>& places) const;
  template <class Action>
  void forOwnRows(const std::vector<std::uint64_t>& places, const Action& action) const;
  std::uint64_t dataBytes() const;
};
} // namespace coplane
