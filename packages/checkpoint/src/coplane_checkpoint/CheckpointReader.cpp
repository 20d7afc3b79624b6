#include <coplane_checkpoint/CheckpointReader.hpp>
#include <coplane_checkpoint/Hdf5Calls.hpp>

#include <algorithm>
#include <limits>

namespace coplane
{
/// All ranks make the same calls on the same file, so they fail alike.
template <class Action>
auto CheckpointReader::attempt(const Action& action) const
{
  try
  {
    return action();
  }
  catch (const hdf5::Failure& failure)
  {
    failOnAllRanks(ExitCode::Checkpoint,
                   "{}: the checkpoint does not have what this program looks for: {}. Restart with "
                   "the program that wrote it ({}).",
                   file_, failure.what(), head_.program);
  }
}

CheckpointReader::CheckpointReader(const std::string& file, const Comm& comm)
    : file_(file), comm_(&comm)
{
  const std::string problem = verifyCheckpoint(file, comm, head_);
  if (!problem.empty())
    failOnAllRanks(ExitCode::Checkpoint,
                   "{}: this checkpoint cannot be used: {}. Restart from another one, or start "
                   "without --restart.",
                   file, problem);
  data_ = attempt([&] { return std::make_unique<hdf5::File>(file, hdf5::File::Mode::Read, comm); });
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

KeyedRows CheckpointReader::rowsOf(const std::string& name, const std::vector<std::string>& columns,
                                   const std::vector<GlobalId>& keys) const
{
  const KeyedRows mine = part(name, columns);
  // Which rank has which keys: the first key of each part.
  // Parts without rows stand at the end.
  const std::vector<GlobalId> first = comm_->allGather(std::vector<GlobalId>{
      mine.count() > 0 ? mine.keys[0] : std::numeric_limits<GlobalId>::max()});
  std::vector<std::vector<GlobalId>> ask(comm_->size());
  std::vector<std::pair<int, std::size_t>> place; // of each key: rank, position in what is asked
  for (const GlobalId key : keys)
  {
    const auto after = std::upper_bound(first.begin(), first.end(), key);
    const int rank = after == first.begin() ? 0 : int(after - first.begin()) - 1;
    place.emplace_back(rank, ask[rank].size());
    ask[rank].push_back(key);
  }
  std::vector<int> counts;
  const std::vector<GlobalId> asked = comm_->exchange(ask, &counts);
  std::vector<std::vector<Real>> answer(comm_->size());
  std::int64_t missing = -1;
  std::size_t next = 0;
  for (int r = 0; r < comm_->size(); ++r)
    for (int i = 0; i < counts[r]; ++i)
    {
      const GlobalId key = asked[next++];
      const auto found = std::lower_bound(mine.keys.begin(), mine.keys.end(), key);
      if (found == mine.keys.end() || *found != key)
      {
        missing = key;
        continue;
      }
      const Real* row = mine.row(std::size_t(found - mine.keys.begin()));
      answer[r].insert(answer[r].end(), row, row + columns.size());
    }
  missing = comm_->max(missing);
  if (missing >= 0)
    failOnAllRanks(ExitCode::Checkpoint,
                   "{}: the checkpoint has no row of id {} in '{}': it belongs to another mesh.",
                   file_, missing, name);
  const std::vector<Real> received = comm_->exchange(answer);
  std::vector<std::size_t> start(comm_->size() + 1, 0);
  for (int r = 0; r < comm_->size(); ++r)
    start[r + 1] = start[r] + ask[r].size();
  KeyedRows rows;
  rows.columns = columns;
  rows.keys = keys;
  rows.numbers.reserve(keys.size() * columns.size());
  for (const auto& [rank, position] : place)
  {
    const Real* row = received.data() + (start[rank] + position) * columns.size();
    rows.numbers.insert(rows.numbers.end(), row, row + columns.size());
  }
  return rows;
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
