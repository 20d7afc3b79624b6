#pragma once

#include <coplane_checkpoint/StateSource.hpp>

#include <utility>

namespace coplane
{
/// Named tables, lists of numbers and texts that a state is saved to, in memory. CheckpointWriter
/// puts them into a file; a state can also be restored from here, which is how a run takes another
/// partition. It knows nothing of physics. All calls are collective.
class StateTables : public StateSource
{
public:
  using StateSource::StateSource;

  /// Every key on exactly one rank. Columns are the same on all ranks.
  void rows(const std::string& name, const KeyedRows& rows);
  /// The same on all ranks; rank 0's count.
  void numbers(const std::string& name, std::vector<Real> values);
  void text(const std::string& name, std::string value);

  std::string name() const override { return "the state in memory"; }
  std::string program() const override;
  bool has(const std::string& name) const override;
  std::int64_t rowCount(const std::string& name) const override;
  KeyedRows part(const std::string& name, const std::vector<std::string>& columns) const override;
  std::vector<Real> numbers(const std::string& name) const override;
  std::string text(const std::string& name) const override;

protected:
  struct Table
  {
    std::string name;
    KeyedRows rows; ///< this rank's part in the global order
    std::int64_t first = 0, total = 0;
  };
  std::vector<Table> tables_;
  std::vector<std::pair<std::string, std::vector<Real>>> numbers_;
  std::vector<std::pair<std::string, std::string>> texts_;

private:
  const Table& table(const std::string& name) const;
};
} // namespace coplane
