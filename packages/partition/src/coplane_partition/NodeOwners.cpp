#include <coplane_partition/Partition.hpp>

#include <Teuchos_DefaultMpiComm.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Zoltan2_BasicVectorAdapter.hpp>
#include <Zoltan2_GraphAdapter.hpp>
#include <Zoltan2_PartitioningProblem.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
constexpr int fewestNodesPerRank = 8;
using Types = Zoltan2::BasicUserTypes<double, int, long long>;

/// Solves a problem of Zoltan2.
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
  return std::vector<int>(parts, parts + count);
}

std::vector<long long> idsOf(const RankMesh& part)
{
  return std::vector<long long>(part.nodePositions.begin(),
                                part.nodePositions.begin() + part.ownedNodes);
}

/// By positions.
std::vector<int> geometricOwners(const RankMesh& part, const Vec3* places, const Comm& comm,
                                 const std::string& method, const std::vector<Real>& costs)
{
  using Adapter = Zoltan2::BasicVectorAdapter<Types>;
  const std::vector<long long> ids = idsOf(part);
  std::vector<std::vector<double>> axes(part.dimension, std::vector<double>(part.ownedNodes));
  for (int i = 0; i < part.ownedNodes; ++i)
    for (int c = 0; c < part.dimension; ++c)
      axes[c][i] = places[i][c];
  std::vector<const double*> columns, weights;
  for (const auto& axis : axes)
    columns.push_back(axis.data());
  if (!costs.empty())
    weights.push_back(costs.data());
  std::vector<int> strides(part.dimension, 1), weightStrides(weights.size(), 1);
  Adapter adapter(part.ownedNodes, ids.data(), columns, strides, weights, weightStrides);
  return partsOf(adapter, method, comm, part.ownedNodes);
}

/// The nodes that a part owns, and with each all nodes that share an element with it.
class NodeGraph : public Zoltan2::GraphAdapter<Types>
{
public:
  NodeGraph(const RankMesh& part, const std::vector<Real>& costs) : ids_(idsOf(part)), starts_(1, 0)
  {
    if (!costs.empty())
      costs_ = costs.data();
    std::vector<std::vector<gno_t>> lists(part.ownedNodes);
    for (const RankMesh::Block& block : part.blocks)
    {
      const std::size_t nodes = std::size_t(topology(block.type).nodes);
      for (std::size_t i = 0; i < block.connectivity.size(); ++i)
        if (const int own = block.connectivity[i]; own < part.ownedNodes)
          for (std::size_t k = i / nodes * nodes; k < (i / nodes + 1) * nodes; ++k)
            lists[own].push_back(part.nodePositions[block.connectivity[k]]);
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

std::vector<int> nodeOwners(const RankMesh& part, const Comm& comm, const std::string& method,
                            const std::vector<Real>& costs, const std::vector<Vec3>* places)
{
  if (comm.size() == 1)
    return std::vector<int>(part.ownedNodes, 0);
  const std::int64_t nodes = comm.sum(std::int64_t(part.ownedNodes));
  if (nodes < std::int64_t(fewestNodesPerRank) * comm.size())
  {
    std::vector<int> owners;
    for (int n = 0; n < part.ownedNodes; ++n)
      owners.push_back(int(part.nodePositions[n] * std::int64_t(comm.size()) / nodes));
    return owners;
  }
  if (method != "hypergraph")
    return geometricOwners(part, places ? places->data() : part.coordinates.data(), comm, method,
                           costs);
  NodeGraph graph(part, costs);
  return partsOf(graph, "phg", comm, part.ownedNodes);
}
} // namespace coplane
