#pragma once

#include <coplane_core/Error.hpp>
#include <coplane_core/Real.hpp>

#include <mpi.h>

#include <cstdint>
#include <functional>
#include <numeric>
#include <string>
#include <type_traits>
#include <vector>

namespace coplane
{
/// The ranks of a run and the few collective operations that Coplane needs. Only exact ones:
/// results that feed back into the state must not depend on the number of ranks.
class Comm
{
public:
  explicit Comm(MPI_Comm comm = MPI_COMM_WORLD);
  /// One rank, in a program that needs no MPI.
  static Comm alone();
  int rank() const { return rank_; }
  int size() const { return size_; }
  bool isRoot() const { return rank_ == 0; }
  MPI_Comm mpi() const { return comm_; }

  Real min(Real value) const;
  Real max(Real value) const;
  std::int64_t min(std::int64_t value) const;
  std::int64_t max(std::int64_t value) const;
  std::int64_t sum(std::int64_t value) const;
  void min(std::vector<Real>& values) const;
  void max(std::vector<Real>& values) const;
  void sum(std::vector<std::int64_t>& values) const;
  void sum(std::vector<std::uint64_t>& values) const; ///< modulo 2^64
  void barrier() const;

  std::string broadcast(const std::string& text, int root = 0) const;

  /// Throws Error(code) on all ranks when a text is not the same on all of them. Collective.
  void demandSame(const std::string& what, const std::string& text, ExitCode code) const;

  /// The concatenation of all ranks' items in rank order, on every rank.
  template <class T>
  std::vector<T> allGather(const std::vector<T>& mine) const
  {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<std::byte> bytes = allGatherBytes(mine.data(), mine.size() * sizeof(T));
    std::vector<T> all(bytes.size() / sizeof(T));
    if (!all.empty())
      __builtin_memcpy(all.data(), bytes.data(), bytes.size());
    return all;
  }

  /// Sends toRank[r] to rank r; returns what every rank sent here, in rank order, with the number
  /// from each in `counts`.
  template <class T>
  std::vector<T> exchange(const std::vector<std::vector<T>>& toRank,
                          std::vector<int>* counts = nullptr) const
  {
    static_assert(std::is_trivially_copyable_v<T>);
    if (size_ == 1)
    {
      if (counts)
        counts->assign(1, int(toRank[0].size()));
      return toRank[0];
    }
    std::vector<int> sendCounts;
    std::vector<T> send;
    for (const std::vector<T>& items : toRank)
    {
      sendCounts.push_back(int(items.size()));
      send.insert(send.end(), items.begin(), items.end());
    }
    const std::vector<int> received = exchangeCounts(sendCounts);
    std::vector<T> items(std::accumulate(received.begin(), received.end(), std::size_t(0)));
    exchangeItems(send.data(), sendCounts, items.data(), received, sizeof(T));
    if (counts)
      *counts = received;
    return items;
  }

  /// Runs an action that may fail on some ranks only. If it threw on any, every rank throws the
  /// error of the lowest such rank, so nobody is left waiting in a collective.
  void together(const std::function<void()>& action) const;

private:
  std::vector<std::byte> allGatherBytes(const void* data, std::size_t size) const;
  std::vector<int> exchangeCounts(const std::vector<int>& toRank) const;
  void exchangeItems(const void* send, const std::vector<int>& sendCounts, void* received,
                     const std::vector<int>& counts, std::size_t itemSize) const;

  MPI_Comm comm_; ///< MPI_COMM_NULL: a rank alone
  int rank_ = 0;
  int size_ = 1;
};
} // namespace coplane
