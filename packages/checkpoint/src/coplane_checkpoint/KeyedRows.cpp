#include <coplane_checkpoint/KeyedRows.hpp>

#include <algorithm>
#include <numeric>

namespace coplane
{
namespace
{
using Key = std::vector<GlobalId>;

bool keyLess(const GlobalId* a, const GlobalId* b, int size)
{
  return std::lexicographical_compare(a, a + size, b, b + size);
}

KeyedRows emptyLike(const KeyedRows& rows)
{
  KeyedRows empty;
  empty.keySize = rows.keySize;
  empty.columns = rows.columns;
  return empty;
}

KeyedRows sortedHere(const KeyedRows& rows)
{
  std::vector<std::size_t> order(rows.count());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b)
            { return keyLess(rows.key(a), rows.key(b), rows.keySize); });
  KeyedRows sorted = emptyLike(rows);
  sorted.keys.reserve(rows.keys.size());
  sorted.numbers.reserve(rows.numbers.size());
  for (const std::size_t i : order)
  {
    sorted.keys.insert(sorted.keys.end(), rows.key(i), rows.key(i) + rows.keySize);
    sorted.numbers.insert(sorted.numbers.end(), rows.row(i), rows.row(i) + rows.columns.size());
  }
  return sorted;
}

/// Keys that part the rows of all ranks into about equal shares, one fewer than ranks.
std::vector<Key> splitters(const KeyedRows& sorted, const Comm& comm)
{
  constexpr std::size_t samplesPerRank = 64;
  std::vector<GlobalId> mine;
  const std::size_t samples = std::min(samplesPerRank, sorted.count());
  for (std::size_t s = 0; s < samples; ++s)
  {
    const GlobalId* key = sorted.key(s * sorted.count() / samples);
    mine.insert(mine.end(), key, key + sorted.keySize);
  }
  const std::vector<GlobalId> all = comm.allGather(mine);
  std::vector<Key> keys;
  for (std::size_t i = 0; i < all.size(); i += std::size_t(sorted.keySize))
    keys.emplace_back(all.begin() + std::ptrdiff_t(i),
                      all.begin() + std::ptrdiff_t(i) + sorted.keySize);
  std::sort(keys.begin(), keys.end());
  std::vector<Key> chosen;
  for (int r = 1; r < comm.size() && !keys.empty(); ++r)
    chosen.push_back(keys[keys.size() * std::size_t(r) / std::size_t(comm.size())]);
  return chosen;
}
} // namespace

Real* KeyedRows::add(std::initializer_list<GlobalId> key)
{
  keys.insert(keys.end(), key);
  numbers.resize(numbers.size() + columns.size(), 0);
  return numbers.data() + (numbers.size() - columns.size());
}

std::string KeyedRows::header() const
{
  return fmt::format("{}", fmt::join(columns, " "));
}

KeyedRows sortedOverRanks(const KeyedRows& rows, const Comm& comm)
{
  KeyedRows sorted = sortedHere(rows);
  if (comm.size() > 1)
  {
    const std::vector<Key> parts = splitters(sorted, comm);
    std::vector<std::vector<GlobalId>> keysTo(comm.size());
    std::vector<std::vector<Real>> numbersTo(comm.size());
    std::size_t to = 0;
    for (std::size_t i = 0; i < sorted.count(); ++i)
    {
      while (to < parts.size() && !keyLess(sorted.key(i), parts[to].data(), sorted.keySize))
        ++to;
      keysTo[to].insert(keysTo[to].end(), sorted.key(i), sorted.key(i) + sorted.keySize);
      numbersTo[to].insert(numbersTo[to].end(), sorted.row(i),
                           sorted.row(i) + sorted.columns.size());
    }
    sorted.keys = comm.exchange(keysTo);
    sorted.numbers = comm.exchange(numbersTo);
    sorted = sortedHere(sorted);
  }
  std::int64_t twice = 0;
  for (std::size_t i = 1; i < sorted.count(); ++i)
    twice += !keyLess(sorted.key(i - 1), sorted.key(i), sorted.keySize);
  if (comm.max(twice) > 0)
    failOnAllRanks(ExitCode::Internal, "checkpoint: a key is there twice (columns {})",
                   rows.header());
  return sorted;
}
} // namespace coplane
