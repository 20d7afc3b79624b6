#include <coplane_core/Abort.hpp>
#include <coplane_core/Comm.hpp>

namespace coplane
{
Comm::Comm(MPI_Comm comm) : comm_(comm)
{
  if (comm_ == MPI_COMM_NULL)
    return;
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &size_);
}

Comm Comm::alone()
{
  return Comm(MPI_COMM_NULL);
}

namespace
{
template <class T>
T reduced(T value, MPI_Datatype type, MPI_Op operation, MPI_Comm comm)
{
  if (comm != MPI_COMM_NULL)
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, type, operation, comm);
  return value;
}

template <class T>
void reduceAll(std::vector<T>& values, MPI_Datatype type, MPI_Op operation, MPI_Comm comm)
{
  if (comm != MPI_COMM_NULL)
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
  if (comm_ != MPI_COMM_NULL)
    MPI_Barrier(comm_);
}

std::string Comm::broadcast(const std::string& text, int root) const
{
  if (comm_ == MPI_COMM_NULL)
    return text;
  std::int64_t length = std::int64_t(text.size());
  MPI_Bcast(&length, 1, MPI_INT64_T, root, comm_);
  std::string result = rank_ == root ? text : std::string(std::size_t(length), ' ');
  MPI_Bcast(result.data(), int(length), MPI_CHAR, root, comm_);
  return result;
}

std::vector<std::byte> Comm::allGatherBytes(const void* data, std::size_t size) const
{
  if (comm_ == MPI_COMM_NULL)
  {
    const auto* bytes = static_cast<const std::byte*>(data);
    return std::vector<std::byte>(bytes, bytes + size);
  }
  const int mine = int(size);
  std::vector<int> counts(size_);
  MPI_Allgather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, comm_);
  const std::vector<int> offsets = offsetsOf(counts);
  std::vector<std::byte> all(std::size_t(offsets.back()) + counts.back());
  MPI_Allgatherv(data, mine, MPI_BYTE, all.data(), counts.data(), offsets.data(), MPI_BYTE, comm_);
  return all;
}

std::vector<int> Comm::exchangeCounts(const std::vector<int>& toRank) const
{
  std::vector<int> counts(size_, 0);
  MPI_Alltoall(toRank.data(), 1, MPI_INT, counts.data(), 1, MPI_INT, comm_);
  return counts;
}

void Comm::exchangeItems(const void* send, const std::vector<int>& sendCounts, void* received,
                         const std::vector<int>& counts, std::size_t itemSize) const
{
  // Counted in items, not in bytes: numbers of bytes may exceed an int.
  MPI_Datatype item;
  MPI_Type_contiguous(int(itemSize), MPI_BYTE, &item);
  MPI_Type_commit(&item);
  const std::vector<int> sendOffsets = offsetsOf(sendCounts);
  const std::vector<int> offsets = offsetsOf(counts);
  MPI_Alltoallv(send, sendCounts.data(), sendOffsets.data(), item, received, counts.data(),
                offsets.data(), item, comm_);
  MPI_Type_free(&item);
}

void Comm::demandSame(const std::string& what, const std::string& text, ExitCode code) const
{
  if (size_ == 1)
    return;
  const std::string first = broadcast(text);
  const int other = int(min(std::int64_t(text == first ? size_ : rank_)));
  if (other == size_)
    return;
  failOnAllRanks(code,
                 "the ranks were not started alike: {} of rank 0 is\n  {}\nand that of rank {} is"
                 "\n  {}\nAccepted: one command for all ranks, which see the same files.",
                 what, first, other, broadcast(text, other));
}

void Comm::together(const std::function<void()>& action) const
{
  std::string text;
  int code = 0;
  try
  {
    action();
  }
  catch (const std::exception& error)
  {
    text = textOf(error);
    code = int(codeOf(error));
  }
  const std::int64_t lowest = min(std::int64_t(code == 0 ? size_ : rank_));
  if (lowest == size_)
    return;
  text = broadcast(text, int(lowest));
  if (comm_ != MPI_COMM_NULL)
    MPI_Bcast(&code, 1, MPI_INT, int(lowest), comm_);
  throw Error(ExitCode(code), text, true);
}
} // namespace coplane
