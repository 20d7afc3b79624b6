#include <coplane_checkpoint/StateTables.hpp>
#include <coplane_core/Version.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
/// The entry of this name; throws on all ranks, which have the same ones.
template <class Entries>
auto find(const Entries& entries, const std::string& name)
{
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const auto& entry) { return entry.first == name; });
  if (found == entries.end())
    failOnAllRanks(ExitCode::Checkpoint, "the state in memory has no '{}'", name);
  return found;
}
} // namespace

void StateTables::rows(const std::string& name, const KeyedRows& rows)
{
  Table table;
  table.name = name;
  table.rows = sortedOverRanks(rows, *comm_);
  const auto counts = comm_->allGather(std::vector<std::int64_t>{std::int64_t(table.rows.count())});
  for (int r = 0; r < comm_->size(); ++r)
  {
    table.first += r < comm_->rank() ? counts[r] : 0;
    table.total += counts[r];
  }
  tables_.push_back(std::move(table));
}

void StateTables::numbers(const std::string& name, std::vector<Real> values)
{
  numbers_.emplace_back(name, std::move(values));
}

void StateTables::text(const std::string& name, std::string value)
{
  texts_.emplace_back(name, std::move(value));
}

std::string StateTables::program() const
{
  return version().number;
}

bool StateTables::has(const std::string& name) const
{
  const auto isNamed = [&](const auto& entry) { return entry.first == name; };
  const auto isOfTable = [&](const Table& table)
  {
    for (const char* part : {"", "/keys", "/numbers", "/columns"})
      if (name == table.name + part)
        return true;
    return false;
  };
  return std::any_of(tables_.begin(), tables_.end(), isOfTable) ||
         std::any_of(numbers_.begin(), numbers_.end(), isNamed) ||
         std::any_of(texts_.begin(), texts_.end(), isNamed);
}

const StateTables::Table& StateTables::table(const std::string& name) const
{
  const auto found = std::find_if(tables_.begin(), tables_.end(),
                                  [&](const Table& table) { return table.name == name; });
  if (found == tables_.end())
    failOnAllRanks(ExitCode::Checkpoint, "{} has no table '{}'", this->name(), name);
  return *found;
}

std::int64_t StateTables::rowCount(const std::string& name) const
{
  return table(name).total;
}

KeyedRows StateTables::part(const std::string& name, const std::vector<std::string>& columns) const
{
  const KeyedRows& rows = table(name).rows;
  if (rows.columns != columns)
    failOnAllRanks(ExitCode::Checkpoint, "{}: '{}' has other columns", this->name(), name);
  return rows;
}

std::vector<Real> StateTables::numbers(const std::string& name) const
{
  const auto found = find(numbers_, name);
  return comm_->allGather(comm_->isRoot() ? found->second : std::vector<Real>{});
}

std::string StateTables::text(const std::string& name) const
{
  return comm_->broadcast(find(texts_, name)->second);
}
} // namespace coplane
