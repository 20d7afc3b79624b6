#include <coplane_mesh/ContiguousRange.hpp>
#include <coplane_mesh/Redistribution.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace coplane
{
namespace
{
constexpr int items = 23;

/// Ids 10, 13, 16, ... dealt like cards.
std::vector<GlobalId> dealt(const Comm& comm)
{
  std::vector<GlobalId> ids;
  for (int i = comm.rank(); i < items; i += comm.size())
    ids.push_back(10 + 3 * i);
  return ids;
}

std::vector<GlobalId> contiguous(const Comm& comm)
{
  const IndexRange range = contiguousRange(items, comm.rank(), comm.size());
  std::vector<GlobalId> ids;
  for (int i = range.first; i < range.first + range.count; ++i)
    ids.push_back(10 + 3 * i);
  return ids;
}

Real valueOf(GlobalId id)
{
  return std::cos(Real(id)) / 7;
}

std::vector<Real> valuesOf(const std::vector<GlobalId>& ids)
{
  std::vector<Real> values;
  for (const GlobalId id : ids)
    values.push_back(valueOf(id));
  return values;
}
} // namespace

TEST(Redistribution, sortsDealtItemsIntoContiguousRanges)
{
  const Comm comm;
  const Redistribution move(comm, dealt(comm), contiguous(comm));
  EXPECT_EQ(move.move(valuesOf(dealt(comm))), valuesOf(contiguous(comm)));
}

TEST(Redistribution, givesAnIdToEveryRankThatWantsIt)
{
  const Comm comm;
  std::vector<GlobalId> all;
  for (int i = items - 1; i >= 0; --i) // in an order of their own
    all.push_back(10 + 3 * i);
  const Redistribution move(comm, dealt(comm), all);
  EXPECT_EQ(move.move(valuesOf(dealt(comm))), valuesOf(all));
}

TEST(Redistribution, copiesBits)
{
  // A sum into a fresh row would turn -0 into +0.
  const Comm comm;
  const Redistribution move(comm, dealt(comm), contiguous(comm));
  const std::vector<Real> moved = move.move(std::vector<Real>(dealt(comm).size(), -0.0));
  for (const Real value : moved)
    EXPECT_TRUE(value == 0 && std::signbit(value));
}

TEST(Redistribution, movesTablesWithAnyNumberOfColumnsOneAfterAnother)
{
  const Comm comm;
  const std::vector<GlobalId> source = dealt(comm), target = contiguous(comm);
  const Redistribution move(comm, source, target);
  for (const int columns : {3, 1, 6})
  {
    Table<Real> from("from", source.size(), columns), to("to", target.size(), columns);
    for (std::size_t i = 0; i < source.size(); ++i)
      for (int c = 0; c < columns; ++c)
        from(i, c) = valueOf(source[i]) + c;
    move.move(from, to);
    for (std::size_t i = 0; i < target.size(); ++i)
      for (int c = 0; c < columns; ++c)
        EXPECT_EQ(to(i, c), valueOf(target[i]) + c);
  }
}

TEST(Redistribution, ranksMayGiveOrWantNothing)
{
  // Rank 0 has everything, the last rank wants everything.
  const Comm comm;
  std::vector<GlobalId> all;
  for (int i = 0; i < items; ++i)
    all.push_back(10 + 3 * i);
  const std::vector<GlobalId> none;
  const auto& source = comm.rank() == 0 ? all : none;
  const auto& target = comm.rank() == comm.size() - 1 ? all : none;
  const Redistribution move(comm, source, target);
  EXPECT_EQ(move.move(valuesOf(source)), valuesOf(target));
}
} // namespace coplane
