#pragma once

#include <coplane_checkpoint/KeyedRows.hpp>
#include <coplane_core/Comm.hpp>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace coplane
{
/// Collects named tables, lists of numbers and texts, and writes them to one HDF5 file, all ranks
/// together. It knows nothing of physics. The file has the same bytes on any number of ranks.
class CheckpointWriter
{
public:
  explicit CheckpointWriter(const Comm& comm) : comm_(&comm) {}

  /// Every key on exactly one rank. Columns are the same on all ranks. Collective.
  void rows(const std::string& name, const KeyedRows& rows);
  /// The same on all ranks; rank 0's are written.
  void numbers(const std::string& name, std::vector<Real> values);
  void text(const std::string& name, std::string value);

  /// Writes beside the file, reads everything back and compares, makes it safe against a loss of
  /// power, and renames: whoever looks sees the old or the new file, whole. Throws
  /// Error(ExitCode::Output) on all ranks with the reason. Collective.
  void write(const std::string& file, std::int64_t cycle, Real time) const;

private:
  struct Table
  {
    std::string name;
    KeyedRows rows; ///< this rank's part in the global order
    std::int64_t first = 0, total = 0;
  };
  std::string writeData(const std::string& file) const;
  std::string readBack(const std::string& file) const;
  std::uint64_t dataBytes() const;

  const Comm* comm_;
  std::vector<Table> tables_;
  std::vector<std::pair<std::string, std::vector<Real>>> numbers_;
  std::vector<std::pair<std::string, std::string>> texts_;
};
} // namespace coplane
