#pragma once

#include <coplane_checkpoint/CheckpointReader.hpp>
#include <coplane_checkpoint/CheckpointWriter.hpp>

#include <TestFolder.hpp>
#include <cmath>
#include <limits>
#include <string>

namespace coplane
{
/// Row i of n belongs to key 7 i - 20; scattered over the ranks.
inline KeyedRows sampleRows(const Comm& comm, int n)
{
  KeyedRows rows;
  rows.columns = {"a", "b"};
  for (int i = n - 1; i >= 0; --i)
    if (i * i % comm.size() == comm.rank())
    {
      Real* row = rows.add({7 * i - 20});
      row[0] = 1.0 / (i + 1);
      row[1] = i % 5 == 0   ? -0.0
               : i % 5 == 1 ? std::nan("7")
               : i % 5 == 2 ? -infinity
                            : std::sin(i);
    }
  return rows;
}

/// Pairs of keys, not on the last rank.
inline KeyedRows samplePairs(const Comm& comm, int n)
{
  KeyedRows rows;
  rows.keySize = 2;
  rows.columns = {"c"};
  for (int i = 0; i < n; ++i)
    if (i % std::max(1, comm.size() - 1) == comm.rank())
      rows.add({i / 3, 10 - i % 3})[0] = i;
  return rows;
}

inline CheckpointWriter sample(const Comm& comm, int n = 100)
{
  CheckpointWriter out(comm);
  out.rows("nodes", sampleRows(comm, n));
  out.rows("contact/planes", samplePairs(comm, n));
  KeyedRows nothing;
  nothing.columns = {"d"};
  out.rows("elements/block_7", nothing);
  out.numbers("solver/numbers", {1, 1e-300, -0.0, std::nan("3"), infinity});
  out.numbers("none", {});
  out.text("deck", "time.end = 1\nmesh = a.e\n");
  out.text("empty", "");
  return out;
}

/// On rank 0; all ranks wait for it.
inline void setBytes(const std::string& file, const std::string& bytes, const Comm& comm)
{
  comm.barrier();
  if (comm.isRoot())
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
  comm.barrier();
}
} // namespace coplane
