#include "Rig.hpp"

#include <coplane_core/ExactSum.hpp>
#include <coplane_core/StateHash.hpp>
#include <coplane_partition/Partition.hpp>

#include <algorithm>

namespace coplane
{
std::vector<int> ownersBy(const std::string& method, const Mesh& mesh, const Comm& comm)
{
  std::vector<int> owners(std::size_t(mesh.nodes()), comm.size() - 1);
  if (method == "scattered")
    for (int n = 0; n < mesh.nodes(); ++n)
      owners[std::size_t(n)] = n % comm.size();
  else if (method != "last")
    owners = nodeOwners(mesh, comm, method);
  return owners;
}

Model rockModel(const Mesh& mesh, const Comm& comm, Real friction, const std::string& method)
{
  Model model;
  model.contact = WithForces::usual;
  model.mesh = distribute(mesh, ownersBy(method, mesh, comm), comm.rank());
  model.blocks.resize(mesh.blocks.size());
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    model.blocks[b].name = mesh.blocks[b].name;
    model.blocks[b].material = makeLinearElastic(1e9, 0.25, 1000);
  }
  JointRecipe joint;
  joint.law.friction = friction;
  model.contactRules.joints = {joint};
  model.contactRules.tellApart(int(mesh.blocks.size()));
  return model;
}

Mesh twoCubes(Real gap)
{
  Mesh mesh;
  addBox(mesh, "lower", {2, 2, 2}, {0, 0, 0}, {1, 1, 1});
  addBox(mesh, "upper", {2, 2, 2}, {0.125, 0.0625, 1 + gap}, {1, 1, 1});
  return mesh;
}

Model slidingCubes(const Comm& comm, const std::string& method)
{
  Model model = rockModel(twoCubes(), comm, 0.25, method);
  model.blocks[1].velocity = {0.5, 0.25, -1};
  return model;
}

std::vector<int> ownedNodesWhere(const RankMesh& mesh,
                                 const std::function<bool(const Vec3&)>& chosen)
{
  std::vector<int> nodes;
  for (int n = 0; n < mesh.ownedNodes; ++n)
    if (chosen(mesh.coordinates[n]))
      nodes.push_back(n);
  return nodes;
}

std::vector<FacePressure::Side> sidesWhere(const RankMesh& mesh,
                                           const std::function<bool(const Vec3&)>& chosen)
{
  std::vector<FacePressure::Side> sides;
  for (const ExteriorFace& face : exteriorFaces(mesh))
  {
    bool all = true;
    for (int k = 0; k < face.nodeCount; ++k)
      all = all && chosen(mesh.coordinates[face.nodes[k]]);
    if (all)
      sides.push_back({face.id, face.nodeCount, face.nodes});
  }
  return sides;
}

FacePressure pressureWhere(const RankMesh& mesh, Real pressure,
                           const std::function<bool(const Vec3&)>& chosen)
{
  return {sidesWhere(mesh, chosen), [pressure](Real) { return pressure; }};
}

Model everything(const Comm& comm, const std::string& method)
{
  Mesh mesh;
  addBox(mesh, "lower", {3, 3, 2}, {0, 0, 0}, {1, 1, 1});
  addBox(mesh, "upper", {2, 2, 2}, {0.1, 0.2, 1}, {0.8, 0.8, 0.8});
  addBox(mesh, "rigid", {2, 1, 1}, {0.3, 0.3, 1.81}, {0.5, 0.4, 0.3});
  Model model = rockModel(mesh, comm, 0.25, method);
  model.rigidBodyOfNode = rigidBodiesOf(model.mesh, {0, 0, 1}, comm);
  model.blocks[2].rigid = true;
  model.blocks[0].erosion.volumeRatio = {0.9985, 1.5};
  model.blocks[1].velocity = {3, 2, -25};
  model.blocks[2].velocity = {1, 0, -26};
  model.blocks[2].angularVelocity = {2, 3, 10};
  model.blocks[2].center = {0.5, 0.5, 2};
  model.conditions.gravity = VectorOfTime(0, 0, -9.81);
  model.conditions.massDamping = [](Real t) { return 10 + 1e4 * t; };
  model.conditions.localDamping = 0.02;
  model.conditions.pressures = {
      pressureWhere(model.mesh, 1e5, [](const Vec3& x) { return x.z == 0; })};
  model.contact.dampNormal = model.contact.dampShear = 0.05;
  model.searchEvery = 7;
  model.time.energyTolerance = infinity;
  return model;
}

Vec3 sumOverRanks(const NodeVectors& vectors, int owned, const Comm& comm)
{
  std::vector<ExactSum> sums(3);
  for (int n = 0; n < owned; ++n)
    for (int c = 0; c < 3; ++c)
      sums[c].add(vectors(n, c));
  const std::vector<Real> totals = ExactSum::overRanks(sums, comm);
  return {totals[0], totals[1], totals[2]};
}

Real largest(const NodeVectors& vectors, int owned, const Comm& comm)
{
  Real most = 0;
  for (int n = 0; n < owned; ++n)
    most = std::max(most, norm(at(vectors, n)));
  return comm.max(most);
}

std::uint64_t nodeHash(const Solver& solver)
{
  StateHash hash;
  for (int n = 0; n < solver.layout().owned(); ++n)
    for (int c = 0; c < 3; ++c)
    {
      hash.add(1, solver.layout().ids()[n], c, solver.state().x(n, c));
      hash.add(2, solver.layout().ids()[n], c, solver.state().v(n, c));
    }
  std::vector<std::uint64_t> total{hash.part()};
  solver.comm().sum(total);
  return total[0];
}

void cycles(Solver& solver, int n)
{
  for (int i = 0; i < n; ++i)
    solver.advance();
}
} // namespace coplane
