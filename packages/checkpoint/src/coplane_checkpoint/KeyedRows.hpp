#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_core/Real.hpp>

#include <initializer_list>
#include <string>
#include <vector>

namespace coplane
{
/// A table of numbers whose rows belong to keys: global ids, one or several for each row.
struct KeyedRows
{
  int keySize = 1;
  std::vector<std::string> columns;
  std::vector<GlobalId> keys; ///< keySize for each row
  std::vector<Real> numbers;  ///< as many as there are columns for each row

  std::size_t count() const { return keys.size() / std::size_t(keySize); }
  const GlobalId* key(std::size_t row) const { return &keys[row * std::size_t(keySize)]; }
  const Real* row(std::size_t row) const { return numbers.data() + row * columns.size(); }
  /// Adds a row; returns its numbers, zeros, to be filled in.
  Real* add(std::initializer_list<GlobalId> key);

  /// Names of the columns in one line.
  std::string header() const;
};

/// Orders the rows of all ranks by their keys: rank after rank holds a part without gaps. What all
/// parts together hold does not depend on the number of ranks. Every key has to be there once.
/// Collective.
KeyedRows sortedOverRanks(const KeyedRows& rows, const Comm& comm);
} // namespace coplane
