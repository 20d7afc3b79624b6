#include <coplane_checkpoint/StateSource.hpp>

#include <algorithm>
#include <limits>

namespace coplane
{
KeyedRows StateSource::rowsOf(const std::string& name, const std::vector<std::string>& columns,
                              const std::vector<GlobalId>& keys, Missing ofMissing) const
{
  const KeyedRows mine = part(name, columns);
  // Which rank has which keys: the first key of each part. A part without rows takes that of the
  // next one, so that nobody asks there.
  constexpr GlobalId none = std::numeric_limits<GlobalId>::max();
  std::vector<GlobalId> first =
      comm_->allGather(std::vector<GlobalId>{mine.count() > 0 ? mine.keys[0] : none});
  for (std::size_t r = first.size() - 1; r > 0; --r)
    if (first[r - 1] == none)
      first[r - 1] = first[r];
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
        if (ofMissing == Missing::Refused)
          missing = key;
        else
          answer[r].insert(answer[r].end(), columns.size(), 0.0);
        continue;
      }
      const Real* row = mine.row(std::size_t(found - mine.keys.begin()));
      answer[r].insert(answer[r].end(), row, row + columns.size());
    }
  missing = comm_->max(missing);
  if (missing >= 0)
    failOnAllRanks(ExitCode::Checkpoint,
                   "{}: the checkpoint has no row of id {} in '{}': it belongs to another mesh.",
                   this->name(), missing, name);
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
} // namespace coplane
