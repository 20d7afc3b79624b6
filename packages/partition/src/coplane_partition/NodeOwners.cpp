#include <coplane_mesh/ContiguousRange.hpp>
#include <coplane_partition/Partition.hpp>

#include <Teuchos_DefaultMpiComm.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Zoltan2_BasicVectorAdapter.hpp>
#include <Zoltan2_PartitioningProblem.hpp>

namespace coplane
{
namespace
{
constexpr int fewestNodesPerRank = 8;
}

std::vector<int> nodeOwners(const Mesh& mesh, const Comm& comm, const std::string& method)
{
  const int nodes = mesh.nodes();
  if (comm.size() == 1)
    return std::vector<int>(nodes, 0);
  if (nodes < fewestNodesPerRank * comm.size())
  {
    std::vector<int> owners(nodes);
    for (int n = 0; n < nodes; ++n)
      owners[n] = int(std::int64_t(n) * comm.size() / nodes);
    return owners;
  }

  using Types = Zoltan2::BasicUserTypes<double, int, long long>;
  using Adapter = Zoltan2::BasicVectorAdapter<Types>;
  const IndexRange range = contiguousRange(nodes, comm.rank(), comm.size());
  std::vector<long long> ids(range.count);
  std::vector<std::vector<double>> axes(mesh.dimension, std::vector<double>(range.count));
  for (int i = 0; i < range.count; ++i)
  {
    ids[i] = range.first + i;
    for (int c = 0; c < mesh.dimension; ++c)
      axes[c][i] = mesh.coordinates[range.first + i][c];
  }
  std::vector<const double*> columns;
  for (const auto& axis : axes)
    columns.push_back(axis.data());
  std::vector<int> strides(mesh.dimension, 1);
  std::vector<const double*> noWeights;
  std::vector<int> noStrides;
  Adapter adapter(int(range.count), ids.data(), columns, strides, noWeights, noStrides);

  Teuchos::ParameterList parameters;
  parameters.set("algorithm", method);
  parameters.set("num_global_parts", comm.size());
  parameters.set("imbalance_tolerance", 1.05);
  if (method == "rcb")
  {
    Teuchos::ParameterList& zoltan = parameters.sublist("zoltan_parameters", false);
    zoltan.set("debug_level", "0"); // else Zoltan prints its parameters
  }
  Zoltan2::PartitioningProblem<Adapter> problem(
      &adapter, &parameters, Teuchos::rcp(new Teuchos::MpiComm<int>(comm.mpi())));
  problem.solve();
  const auto* parts = problem.getSolution().getPartListView();
  return comm.allGather(std::vector<int>(parts, parts + range.count));
}
} // namespace coplane
