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
} // namespace coplane
