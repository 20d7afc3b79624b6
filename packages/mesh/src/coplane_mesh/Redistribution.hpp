#pragma once

#include <coplane_core/Backend.hpp>
#include <coplane_core/Comm.hpp>

#include <memory>
#include <vector>

namespace coplane
{
/// Moves rows of numbers between two layouts of the same ids: a Tpetra::Import between two maps.
/// Bits are copied, never summed.
class Redistribution
{
public:
  /// `sourceIds`: every id on exactly one rank. `targetIds`: any of these ids, on as many ranks as
  /// want them.
  Redistribution(const Comm& comm, const std::vector<GlobalId>& sourceIds,
                 const std::vector<GlobalId>& targetIds);
  ~Redistribution();
  Redistribution(Redistribution&&) noexcept;
  Redistribution& operator=(Redistribution&&) noexcept;

  /// source: rows of this rank's source ids, [row][column]; target: rows of its target ids.
  /// Collective.
  void move(const ConstTable<Real>& source, const Table<Real>& target) const;

  /// Convenience for output: one column.
  std::vector<Real> move(const std::vector<Real>& source) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Rows [first, first + count) of n rows that rank r of p holds when they are dealt out evenly in
/// order.
struct ContiguousRange
{
  std::int64_t first = 0;
  std::int64_t count = 0;
};
inline ContiguousRange contiguousRange(std::int64_t n, int rank, int ranks)
{
  const std::int64_t first = n * rank / ranks;
  return {first, n * (rank + 1) / ranks - first};
}
} // namespace coplane
