#pragma once

#include <coplane_checkpoint/CheckpointFile.hpp>
#include <coplane_checkpoint/StateSource.hpp>

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
class CheckpointReader : public StateSource
{
public:
  CheckpointReader(const std::string& file, const Comm& comm);
  ~CheckpointReader() override;

  const std::string& file() const { return file_; }
  const CheckpointHead& head() const { return head_; }

  std::string name() const override { return file_; }
  std::string program() const override { return head_.program; }
  bool has(const std::string& name) const override;
  std::int64_t rowCount(const std::string& name) const override;
  KeyedRows part(const std::string& name, const std::vector<std::string>& columns) const override;
  std::vector<Real> numbers(const std::string& name) const override;
  std::string text(const std::string& name) const override;

private:
  template <class Action>
  auto attempt(const Action& action) const;

  std::string file_;
  CheckpointHead head_;
  std::unique_ptr<hdf5::File> data_;
};
} // namespace coplane
