#include <coplane_core/Comm.hpp>

#include <numeric>

namespace coplane
{
Comm::Comm(MPI_Comm comm) : comm_(comm)
{
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &size_);
}

namespace
{
template <class T>
T reduced(T value, MPI_Datatype type, MPI_Op operation, MPI_Comm comm)
{
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, type, operation, comm);
  return value;
}

template <class T>
void reduceAll(std::vector<T>& values, MPI_Datatype type, MPI_Op operation, MPI_Comm comm)
{
  MPI_Allreduce(MPI_IN_PLACE, values.data(), int(values.size()), type, operation, comm);
}

std::vector<int> offsetsOf(const std::vector<int>& counts)
{
  std::vector<int> offsets(counts.size(), 0);
  for (std::size_t r = 1; r < counts.size(); ++r)
    offsets[r] = offsets[r - 1] + counts[r - 1];
  return offsets;
}
} // namespace

Real Comm::min(Real value) const
{
  return reduced(value, MPI_DOUBLE, MPI_MIN, comm_);
}
Real Comm::max(Real value) const
{
  return reduced(value, MPI_DOUBLE, MPI_MAX, comm_);
}
std::int64_t Comm::min(std::int64_t value) const
{
  return reduced(value, MPI_INT64_T, MPI_MIN, comm_);
}
std::int64_t Comm::max(std::int64_t value) const
{
  return reduced(value, MPI_INT64_T, MPI_MAX, comm_);
}
std::int64_t Comm::sum(std::int64_t value) const
{
  return reduced(value, MPI_INT64_T, MPI_SUM, comm_);
}
void Comm::min(std::vector<Real>& values) const
{
  reduceAll(values, MPI_DOUBLE, MPI_MIN, comm_);
}
void Comm::max(std::vector<Real>& values) const
{
  reduceAll(values, MPI_DOUBLE, MPI_MAX, comm_);
}
void Comm::sum(std::vector<std::int64_t>& values) const
{
  reduceAll(values, MPI_INT64_T, MPI_SUM, comm_);
}
void Comm::sum(std::vector<std::uint64_t>& values) const
{
  reduceAll(values, MPI_UINT64_T, MPI_SUM, comm_);
}
void Comm::barrier() const
{
  MPI_Barrier(comm_);
}

std::string Comm::broadcast(const std::string& text, int root) const
{
  std::int64_t length = std::int64_t(text.size());
  MPI_Bcast(&length, 1, MPI_INT64_T, root, comm_);
  std::string result = rank_ == root ? text : std::string(std::size_t(length), ' ');
  MPI_Bcast(result.data(), int(length), MPI_CHAR, root, comm_);
  return result;
}

std::vector<std::byte> Comm::allGatherBytes(const void* data, std::size_t size) const
{
  const int mine = int(size);
  std::vector<int> counts(size_);
  MPI_Allgather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, comm_);
  const std::vector<int> offsets = offsetsOf(counts);
  std::vector<std::byte> all(std::size_t(offsets.back()) + counts.back());
  MPI_Allgatherv(data, mine, MPI_BYTE, all.data(), counts.data(), offsets.data(), MPI_BYTE, comm_);
  return all;
}

std::vector<std::byte> Comm::exchangeBytes(const std::vector<std::vector<std::byte>>& toRank,
                                           std::vector<int>& counts) const
{
  std::vector<int> sendCounts(size_);
  std::vector<std::byte> send;
  for (int r = 0; r < size_; ++r)
  {
    sendCounts[r] = int(toRank[r].size());
    send.insert(send.end(), toRank[r].begin(), toRank[r].end());
  }
  counts.assign(size_, 0);
  MPI_Alltoall(sendCounts.data(), 1, MPI_INT, counts.data(), 1, MPI_INT, comm_);
  const std::vector<int> sendOffsets = offsetsOf(sendCounts);
  const std::vector<int> offsets = offsetsOf(counts);
  std::vector<std::byte> received(std::size_t(offsets.back()) + counts.back());
  MPI_Alltoallv(send.data(), sendCounts.data(), sendOffsets.data(), MPI_BYTE, received.data(),
                counts.data(), offsets.data(), MPI_BYTE, comm_);
  return received;
}

void Comm::together(const std::function<void()>& action) const
{
  std::string text;
  int code = 0;
  try
  {
    action();
  }
  catch (const Error& error)
  {
    text = error.what();
    code = int(error.code());
  }
  catch (const std::exception& error)
  {
    text = error.what();
    code = int(ExitCode::Internal);
  }
  const std::int64_t lowest = min(std::int64_t(code == 0 ? size_ : rank_));
  if (lowest == size_)
    return;
  text = broadcast(text, int(lowest));
  MPI_Bcast(&code, 1, MPI_INT, int(lowest), comm_);
  throw Error(ExitCode(code), text, true);
}
} // namespace coplane
