#include <coplane_checkpoint/CheckpointReader.hpp>
#include <coplane_checkpoint/detail/Hdf5Calls.hpp>

#include <algorithm>
#include <optional>
#include <utility>

namespace coplane
{
/// Every rank reads by itself; one that fails takes the others along.
template <class Action>
auto CheckpointReader::attempt(const Action& action) const
{
  std::optional<decltype(action())> result;
  comm_->together(
      [&]
      {
        try
        {
          result.emplace(action());
        }
        catch (const hdf5::Failure& failure)
        {
          fail(ExitCode::Checkpoint,
               "{}: the checkpoint does not have what this program looks for: {}. Restart with the "
               "program that wrote it ({}).",
               file_, failure.what(), head_.program);
        }
      });
  return std::move(*result);
}

CheckpointReader::CheckpointReader(const std::string& file, const Comm& comm)
    : StateSource(comm), file_(file)
{
  const std::string problem = verifyCheckpoint(file, comm, head_);
  if (!problem.empty())
    failOnAllRanks(ExitCode::Checkpoint,
                   "{}: this checkpoint cannot be used: {}. Restart from another one, or start "
                   "without --restart.",
                   file, problem);
  data_ = attempt([&] { return std::make_unique<hdf5::File>(file, hdf5::File::Mode::Read); });
}

CheckpointReader::~CheckpointReader() = default;

bool CheckpointReader::has(const std::string& name) const
{
  return data_->has(name);
}

std::int64_t CheckpointReader::rowCount(const std::string& name) const
{
  return attempt([&] { return data_->shape(name + "/keys").rows; });
}

KeyedRows CheckpointReader::part(const std::string& name,
                                 const std::vector<std::string>& columns) const
{
  return attempt(
      [&]
      {
        KeyedRows rows;
        rows.columns = columns;
        hdf5::Part part = data_->shape(name + "/keys");
        if (data_->readText(name + "/columns") != rows.header())
          throw hdf5::Failure("'" + name + "' has other columns");
        const std::int64_t ranks = comm_->size(), rank = comm_->rank();
        part.first = part.rows / ranks * rank + std::min(part.rows % ranks, rank);
        part.count = part.rows / ranks + (rank < part.rows % ranks);
        rows.keySize = int(part.columns);
        data_->read(name + "/keys", part, rows.keys);
        part.columns = std::int64_t(columns.size());
        data_->read(name + "/numbers", part, rows.numbers);
        return rows;
      });
}

std::vector<Real> CheckpointReader::numbers(const std::string& name) const
{
  return attempt(
      [&]
      {
        std::vector<Real> values;
        hdf5::Part part = data_->shape(name);
        part.count = part.rows;
        data_->read(name, part, values);
        return values;
      });
}

std::string CheckpointReader::text(const std::string& name) const
{
  return attempt([&] { return data_->readText(name); });
}
} // namespace coplane
