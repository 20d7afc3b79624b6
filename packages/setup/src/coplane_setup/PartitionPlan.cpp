#include <coplane_core/Log.hpp>
#include <coplane_material/MaterialModel.hpp>
#include <coplane_mesh/Distribute.hpp>
#include <coplane_partition/Partition.hpp>
#include <coplane_setup/Lookups.hpp>
#include <coplane_setup/PartitionPlan.hpp>

#include <algorithm>
#include <map>

namespace coplane
{
namespace
{
// What a cycle costs, in units of a hexahedron with one point and an elastic law; only how even the
// ranks are depends on it. Elements: processor time of
//   coplane_bench_elements --benchmark_filter='/elastic/serial'
// over the number of elements, rounded. A later run, on a shared AMD EPYC, gave 0.35, 0.22 and 0.17
// for the types in the order below, and 1.1 to 1.3, 1.3 and 2.5 to 3.7 for the forms.

/// Of an element of a rigid block: it is in lists, but nothing is computed for it.
constexpr Real costOfRigid = 0.02;
/// Of an exterior face with its pairs: of the bar that strikes a wall in three dimensions
/// (docs/developer/backends.md); an estimate in two. A run measures its own (Rebalancer.hpp).
constexpr Real costOfFace3d = 4, costOfFace2d = 0.6;

PartitionCosts costsOf(const Mesh& mesh, const Deck& deck)
{
  static const std::map<ElementType, Real> ofType{{ElementType::Hex8, 1},
                                                  {ElementType::Tet4, 0.4},
                                                  {ElementType::Quad4, 0.33},
                                                  {ElementType::Tri3, 0.23}};
  static const std::map<std::string, Real> ofForm{{"one_point", 1},
                                                  {"assumed_strain", 1.25},
                                                  {"nodal_pressure", 1.5},
                                                  {"full_integration", 3.2},
                                                  {"full_integration_plain", 3.2}};
  PartitionCosts costs;
  for (const Mesh::Block& block : mesh.blocks)
  {
    Real cost = ofType.at(block.type);
    if (const int card = indexOf(deck.blocks, block.name); card >= 0)
    {
      const BlockCard& ofBlock = deck.blocks[card];
      if (const int material = indexOf(deck.materials, ofBlock.material); material >= 0)
        cost *= findModel(materialModels(), deck.materials[material].model)->cost;
      cost *= ofBlock.rigid ? costOfRigid : ofForm.at(ofBlock.element);
    }
    costs.ofElement.push_back(cost);
  }
  costs.ofFace = deck.contact.enabled ? (mesh.dimension == 3 ? costOfFace3d : costOfFace2d) : 0;
  return costs;
}
} // namespace

RankMesh partOf(const MeshSlice& mesh, RankMesh home, const Deck& deck, const Comm& comm)
{
  if (comm.size() == 1)
    return home;
  const PartitionCosts costs = costsOf(mesh.mine, deck);
  const bool byCost = deck.partitionBalance == "cost";
  const std::vector<int> owners = nodeOwners(home, comm, deck.partitionMethod,
                                             byCost ? nodeCosts(home, costs) : std::vector<Real>{});
  home = RankMesh(); // makes room
  RankMesh part = distribute(mesh, owners, comm);
  const PartitionQuality quality = qualityOf(part, nodeCosts(part, costs), comm);
  logInfo("partition by {}: the most loaded rank has {:.3f} times the mean cost; {} to {} nodes a "
          "rank, and up to {} of others; {} of {} elements on several ranks",
          deck.partitionMethod, quality.imbalance, quality.fewest, quality.most,
          quality.mostOfOthers, quality.cutElements, mesh.elements());
  return part;
}

RebalanceOptions rebalanceOptionsOf(const Deck& deck, double secondsToBuild)
{
  using When = RebalanceOptions::When;
  RebalanceOptions options;
  options.when = deck.rebalance == "never"    ? When::Never
                 : deck.rebalance == "always" ? When::Always
                                              : When::Auto;
  options.every = deck.rebalanceEvery;
  options.above = deck.rebalanceAbove;
  options.method = deck.partitionMethod;
  // The solver is built once more, and its state moves there and back.
  options.firstCost = 2 * secondsToBuild;
  return options;
}
} // namespace coplane
