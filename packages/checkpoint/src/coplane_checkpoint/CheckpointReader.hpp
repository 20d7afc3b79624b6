#pragma once

#include <coplane_checkpoint/CheckpointFile.hpp>
#include <coplane_checkpoint/KeyedRows.hpp>
#include <coplane_core/Comm.hpp>

#include <memory>
#include <string>
#include <vector>

namespace coplane
{
namespace hdf5
{
class File;
}

/// Reads what CheckpointWriter has written, on any number of ranks. Throws
/// Error(ExitCode::Checkpoint) on all ranks when the file is not whole or does not have what is
/// asked for. All calls are collective.
class CheckpointReader
{
public:
  CheckpointReader(const std::string& file, const Comm& comm);
  ~CheckpointReader();

  const std::string& file() const { return file_; }
  const CheckpointHead& head() const { return head_; }

  bool has(const std::string& name) const;
  /// A part of the table for each rank, in the order of the keys, rank after rank.
  /// @param columns those that are expected
  KeyedRows part(const std::string& name, const std::vector<std::string>& columns) const;
  /// The rows of these keys in their order, wherever they stand; for keys of one id. Every key has
  /// to be there.
  KeyedRows rowsOf(const std::string& name, const std::vector<std::string>& columns,
                   const std::vector<GlobalId>& keys) const;
  std::int64_t rowCount(const std::string& name) const;
  std::vector<Real> numbers(const std::string& name) const;
  std::string text(const std::string& name) const;

private:
  template <class Action>
  auto attempt(const Action& action) const;

  std::string file_;
  const Comm* comm_;
  CheckpointHead head_;
  std::unique_ptr<hdf5::File> data_;
};
} // namespace coplane
