#include <coplane_core/Backend.hpp>
#include <coplane_core/Log.hpp>

#include <gtest/gtest.h>
#include <mpi.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace
{
/// What the ranks say that print no course of the tests.
class FailuresOfRank : public testing::EmptyTestEventListener
{
public:
  explicit FailuresOfRank(int rank) : rank_(rank) {}
  void OnTestPartResult(const testing::TestPartResult& result) override
  {
    if (result.failed())
      std::fprintf(stderr, "rank %d: %s:%d: %s\n", rank_,
                   result.file_name() ? result.file_name() : "?", result.line_number(),
                   result.message());
  }

private:
  int rank_;
};
} // namespace

int main(int argc, char** argv)
{
  MPI_Init(&argc, &argv);
  ::testing::InitGoogleTest(&argc, argv);
  Kokkos::InitArguments arguments;
  arguments.num_threads = 2;
  coplane::Backend backend = coplane::Backend::Serial;
  for (int i = 1; i + 1 < argc; ++i)
  {
    if (std::string(argv[i]) == "--backend" && std::string(argv[i + 1]) == "threads")
      backend = coplane::Backend::Threads;
    if (std::string(argv[i]) == "--threads")
      arguments.num_threads = std::stoi(argv[i + 1]);
  }
  Kokkos::initialize(arguments);
  coplane::setBackend(backend);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  coplane::logSetup(rank == 0, true);
  if (rank != 0)
  {
    auto& listeners = ::testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new FailuresOfRank(rank));
  }
  int failed = RUN_ALL_TESTS();
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  if (failed && rank == 0)
    std::printf("a test failed on some rank\n");
  Kokkos::finalize();
  MPI_Finalize();
  return failed;
}
