#pragma once

#include <coplane_core/ExactSum.hpp>
#include <coplane_core/StateHash.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_partition/Partition.hpp>

#include <gtest/gtest.h>

#include <BoxMesh.hpp>
#include <functional>
#include <string>

namespace coplane
{
/// By a method of nodeOwners(), or with scattered nodes, or all on the last rank.
inline std::vector<int> ownersBy(const std::string& method, const Mesh& mesh, const Comm& comm)
{
  std::vector<int> owners(std::size_t(mesh.nodes()), comm.size() - 1);
  if (method == "scattered")
    for (int n = 0; n < mesh.nodes(); ++n)
      owners[std::size_t(n)] = n % comm.size();
  else if (method != "last")
    owners = nodeOwners(mesh, comm, method);
  return owners;
}

/// Tests of what contact by either way of computing forces has in common: while one of them runs,
/// models are made with the usual options of its parameter.
struct WithForces : testing::TestWithParam<ContactOptions::Forces>
{
  WithForces() { usual = ContactOptions::with(GetParam()); }
  ~WithForces() override { usual = {}; }
  static bool potential() { return usual.forces == ContactOptions::Forces::Potential; }

  static auto both()
  {
    return testing::Values(ContactOptions::Forces::Potential, ContactOptions::Forces::CommonNormal);
  }
  static std::string name(const testing::TestParamInfo<ParamType>& info)
  {
    return info.param == ContactOptions::Forces::Potential ? "potential" : "commonNormal";
  }

  inline static ContactOptions usual;
};

/// Every block of the same elastic rock (1 GPa, 0.25, 1000 kg/m^3: waves run at 1095 m/s), every
/// pair of blocks with the same penalty law.
inline Model rockModel(const Mesh& mesh, const Comm& comm, Real friction = 0,
                       const std::string& method = "multijagged")
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

/// Two cubes of 2^3 elements of 0.5 m, the upper one shifted so that every face meets several.
///
///      +-------+        z
///      | upper |        |
///    +-+-----+-+        +-- x
///    | lower |
///    +-------+
inline Mesh twoCubes(Real gap = 0)
{
  Mesh mesh;
  addBox(mesh, "lower", {2, 2, 2}, {0, 0, 0}, {1, 1, 1});
  addBox(mesh, "upper", {2, 2, 2}, {0.125, 0.0625, 1 + gap}, {1, 1, 1});
  return mesh;
}

/// The upper cube falls on the lower one and slides over it.
inline Model slidingCubes(const Comm& comm, const std::string& method = "multijagged")
{
  Model model = rockModel(twoCubes(), comm, 0.25, method);
  model.blocks[1].velocity = {0.5, 0.25, -1};
  return model;
}

inline std::vector<int> ownedNodesWhere(const RankMesh& mesh,
                                        const std::function<bool(const Vec3&)>& chosen)
{
  std::vector<int> nodes;
  for (int n = 0; n < mesh.ownedNodes; ++n)
    if (chosen(mesh.coordinates[n]))
      nodes.push_back(n);
  return nodes;
}

/// Exterior faces of which all corners are chosen.
inline std::vector<FacePressure::Side> sidesWhere(const RankMesh& mesh,
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

inline FacePressure pressureWhere(const RankMesh& mesh, Real pressure,
                                  const std::function<bool(const Vec3&)>& chosen)
{
  return {sidesWhere(mesh, chosen), [pressure](Real) { return pressure; }};
}

/// A body that is partly rigid slides over one that loses elements, under loads and damping.
inline Model everything(const Comm& comm, const std::string& method = "multijagged")
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

/// Sum over the owned nodes of all ranks.
inline Vec3 sumOverRanks(const NodeVectors& vectors, int owned, const Comm& comm)
{
  std::vector<ExactSum> sums(3);
  for (int n = 0; n < owned; ++n)
    for (int c = 0; c < 3; ++c)
      sums[c].add(vectors(n, c));
  const std::vector<Real> totals = ExactSum::overRanks(sums, comm);
  return {totals[0], totals[1], totals[2]};
}

/// Largest |vector| of all nodes of all ranks.
inline Real largest(const NodeVectors& vectors, int owned, const Comm& comm)
{
  Real most = 0;
  for (int n = 0; n < owned; ++n)
    most = std::max(most, norm(at(vectors, n)));
  return comm.max(most);
}

/// Hash of positions and velocities, without planes and elements.
inline std::uint64_t nodeHash(const Solver& solver)
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

inline void cycles(Solver& solver, int n)
{
  for (int i = 0; i < n; ++i)
    solver.advance();
}

/// Counts its calls and remembers how the run ended.
struct Recorder : Observer
{
  int starts = 0, ends = 0;
  Ending ending;
  void start(const Solver&) override { ++starts; }
  void endOfCycle(const Solver&) override { ++ends; }
  void finish(const Solver&, const Ending& how) override { ending = how; }
};
} // namespace coplane
