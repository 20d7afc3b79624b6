#include <coplane_mesh/ContiguousRange.hpp>
#include <coplane_partition/Partition.hpp>

#include <Teuchos_DefaultMpiComm.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Zoltan2_BasicVectorAdapter.hpp>
#include <Zoltan2_GraphAdapter.hpp>
#include <Zoltan2_PartitioningProblem.hpp>

#include <algorithm>
#include <numeric>

namespace coplane
{
namespace
{
constexpr int fewestNodesPerRank = 8;
using Types = Zoltan2::BasicUserTypes<double, int, long long>;

/// Solves a problem of Zoltan2 and gives everybody the parts of all.
template <class Adapter>
std::vector<int> partsOf(Adapter& adapter, const std::string& algorithm, const Comm& comm,
                         std::int64_t count)
{
  Teuchos::ParameterList parameters;
  parameters.set("algorithm", algorithm);
  parameters.set("num_global_parts", comm.size());
  parameters.set("imbalance_tolerance", 1.05);
  if (algorithm != "multijagged") // methods of Zoltan, which print their parameters
    parameters.sublist("zoltan_parameters", false).set("debug_level", "0");
  Zoltan2::PartitioningProblem<Adapter> problem(
      &adapter, &parameters, Teuchos::rcp(new Teuchos::MpiComm<int>(comm.mpi())));
  problem.solve();
  const auto* parts = problem.getSolution().getPartListView();
  return comm.allGather(std::vector<int>(parts, parts + count));
}

/// By positions.
std::vector<int> geometricOwners(int dimension, const std::vector<Vec3>& places, const Comm& comm,
                                 const std::string& method, const IndexRange& range,
                                 const std::vector<Real>& costs)
{
  using Adapter = Zoltan2::BasicVectorAdapter<Types>;
  std::vector<long long> ids(range.count);
  std::vector<std::vector<double>> axes(dimension, std::vector<double>(range.count));
  for (int i = 0; i < range.count; ++i)
  {
    ids[i] = range.first + i;
    for (int c = 0; c < dimension; ++c)
      axes[c][i] = places[range.first + i][c];
  }
  std::vector<const double*> columns, weights;
  for (const auto& axis : axes)
    columns.push_back(axis.data());
  if (!costs.empty())
    weights.push_back(costs.data() + range.first);
  std::vector<int> strides(dimension, 1), weightStrides(weights.size(), 1);
  Adapter adapter(int(range.count), ids.data(), columns, strides, weights, weightStrides);
  return partsOf(adapter, method, comm, range.count);
}

/// The nodes of a rank's range, and with each all nodes that share an element with it.
class NodeGraph : public Zoltan2::GraphAdapter<Types>
{
public:
  NodeGraph(const Mesh& mesh, const IndexRange& range, const std::vector<Real>& costs)
      : ids_(range.count), starts_(1, 0)
  {
    std::iota(ids_.begin(), ids_.end(), gno_t(range.first));
    if (!costs.empty())
      costs_ = costs.data() + range.first;
    std::vector<std::vector<gno_t>> lists(range.count);
    for (const Mesh::Block& block : mesh.blocks)
    {
      const int nodes = topology(block.type).nodes;
      for (std::size_t i = 0; i < block.connectivity.size(); ++i)
      {
        const int own = block.connectivity[i] - range.first;
        if (own < 0 || own >= range.count)
          continue;
        const auto element = block.connectivity.begin() + std::ptrdiff_t(i / nodes * nodes);
        lists[own].insert(lists[own].end(), element, element + nodes);
      }
    }
    for (std::vector<gno_t>& list : lists)
    {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
      neighbors_.insert(neighbors_.end(), list.begin(), list.end());
      starts_.push_back(offset_t(neighbors_.size()));
    }
  }

  size_t getLocalNumVertices() const override { return ids_.size(); }
  size_t getLocalNumEdges() const override { return neighbors_.size(); }
  void getVertexIDsView(const gno_t*& ids) const override { ids = ids_.data(); }
  void getEdgesView(const offset_t*& starts, const gno_t*& neighbors) const override
  {
    starts = starts_.data();
    neighbors = neighbors_.data();
  }
  int getNumWeightsPerVertex() const override { return costs_ ? 1 : 0; }
  void getVertexWeightsView(const scalar_t*& weights, int& stride, int) const override
  {
    weights = costs_;
    stride = 1;
  }
  bool useDegreeAsVertexWeight(int) const override { return false; }

private:
  std::vector<gno_t> ids_, neighbors_;
  std::vector<offset_t> starts_;
  const Real* costs_ = nullptr;
};
} // namespace

std::vector<int> nodeOwners(const Mesh& mesh, const Comm& comm, const std::string& method,
                            const std::vector<Real>& costs, const std::vector<Vec3>* places)
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
  const IndexRange range = contiguousRange(nodes, comm.rank(), comm.size());
  if (method != "hypergraph")
    return geometricOwners(mesh.dimension, places ? *places : mesh.coordinates, comm, method, range,
                           costs);
  NodeGraph graph(mesh, range, costs);
  return partsOf(graph, "phg", comm, range.count);
}
} // namespace coplane
