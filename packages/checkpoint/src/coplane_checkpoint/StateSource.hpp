#pragma once

#include <coplane_checkpoint/KeyedRows.hpp>
#include <coplane_core/Comm.hpp>
#include <coplane_core/Real.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace coplane
{
/// What a state is restored from: named tables, lists of numbers and texts, in a file
/// (CheckpointReader) or in memory (StateTables), on any number of ranks. Where something is not
/// there, Error(ExitCode::Checkpoint) is thrown on all ranks. All calls are collective.
class StateSource
{
public:
  explicit StateSource(const Comm& comm) : comm_(&comm) {}
  virtual ~StateSource() = default;

  virtual std::string name() const = 0;    ///< for messages, e.g. the file
  virtual std::string program() const = 0; ///< version that saved it

  virtual bool has(const std::string& name) const = 0;
  virtual std::int64_t rowCount(const std::string& name) const = 0;
  /// A part of the table for each rank, in the order of the keys, rank after rank.
  /// @param columns those that are expected
  virtual KeyedRows part(const std::string& name,
                         const std::vector<std::string>& columns) const = 0;
  virtual std::vector<Real> numbers(const std::string& name) const = 0;
  virtual std::string text(const std::string& name) const = 0;

  enum class Missing
  {
    Refused,
    Zero ///< a row of zeros
  };
  /// The rows of these keys in their order, wherever they stand; for keys of one id.
  KeyedRows rowsOf(const std::string& name, const std::vector<std::string>& columns,
                   const std::vector<GlobalId>& keys, Missing missing = Missing::Refused) const;

protected:
  const Comm* comm_;
};
} // namespace coplane
