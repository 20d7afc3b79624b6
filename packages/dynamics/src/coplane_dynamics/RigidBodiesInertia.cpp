// Which nodes are whose, and the moments of inertia of the solid.
#include <coplane_dynamics/RigidBodies.hpp>
#include <coplane_dynamics/detail/RigidInertia.hpp>
#include <coplane_mesh/Bodies.hpp>
#include <coplane_mesh/IntegrateSolid.hpp>

#include <algorithm>

namespace coplane
{
/// The inverse; in two dimensions of the part that turns.
Mat3 inverseInertia(const Mat3& j, int dimension)
{
  if (dimension == 3)
    return inverse(j);
  Mat3 r;
  r(2, 2) = 1 / j(2, 2);
  return r;
}

std::vector<int> rigidBodiesOf(const RankMesh& part, const std::vector<char>& rigidBlocks,
                               const Comm& comm)
{
  std::vector<int> bodies = bodyLabels(part, rigidBlocks, comm);
  std::vector<int> first; // nodes of the bodies, of each the first
  for (int n = 0; n < part.ownedNodes; ++n)
    if (bodies[n] == part.nodePositions[n])
      first.push_back(bodies[n]);
  first = comm.allGather(first);
  std::sort(first.begin(), first.end());
  for (int& body : bodies)
    if (body >= 0)
      body = int(std::lower_bound(first.begin(), first.end(), body) - first.begin());
  return bodies;
}

/// Mass and centre are those of the nodes, so that momenta and weights of nodes are those of the
/// body.
void RigidBodies::findCentres(const NodalState& state)
{
  std::vector<ExactSum> sums(5 * bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    for (const int n : bodies_[b].nodes)
    {
      const Real m = state.mass(n);
      sums[5 * b].add(m);
      for (int c = 0; c < 3; ++c)
        sums[5 * b + 1 + c].add(m * state.x(n, c));
      sums[5 * b + 4].add(1);
    }
  const std::vector<Real> totals = ExactSum::overRanks(sums, *comm_);
  for (std::size_t b = 0; b < bodies_.size(); ++b)
  {
    Body& body = bodies_[b];
    const Real* total = &totals[5 * b];
    body.mass = total[0];
    body.start = body.center = (1 / body.mass) * Vec3{total[1], total[2], total[3]};
    body.allNodes = std::int64_t(total[4]);
    for (const int n : body.nodes)
      body.arms.push_back(at(state.x, n) - body.center);
  }
}

/// Moments of inertia are those of the solid.
void RigidBodies::findInertia(const RankMesh& mesh, const std::vector<char>& rigidBlocks,
                              const std::vector<ElementBlock>& blocks, const NodalState& state)
{
  findCentres(state);
  const std::size_t bodies = bodies_.size(), blockCount = mesh.blocks.size();
  std::vector<Real> reach(bodies, 0);
  for (std::size_t b = 0; b < bodies; ++b)
    for (const Vec3& arm : bodies_[b].arms)
      reach[b] = std::max(reach[b], norm(arm));
  comm_->max(reach);
  for (std::size_t b = 0; b < bodies; ++b)
    bodies_[b].reach = reach[b];
  std::vector<std::int64_t> held(bodies * blockCount, 0);
  std::vector<ExactSum> sums(6 * bodies);
  const auto add = [&](int body, Real m, const Vec3& r)
  {
    const Real moments[6] = {r.x * r.x, r.y * r.y, r.z * r.z, r.x * r.y, r.y * r.z, r.z * r.x};
    for (int i = 0; i < 6; ++i)
      sums[std::size_t(6 * body + i)].add(m * moments[i]);
  };
  std::vector<Real> others(mesh.ownedNodes, 0); // mass that deformable elements bring to a node
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    const RankMesh::Block& part = mesh.blocks[b];
    const int corners = topology(part.type).nodes;
    for (int e = 0; e < part.elements(); ++e)
    {
      const int* nodes = &part.connectivity[std::size_t(e) * corners];
      if (!rigidBlocks[b])
        for (int k = 0; k < corners; ++k)
          if (nodes[k] < mesh.ownedNodes)
            others[nodes[k]] += blocks[b].cornerMass(e, k);
      if (!rigidBlocks[b] || !part.owned[e])
        continue;
      // The owner of an element owns its node with the lowest id.
      int lowest = 0;
      for (int k = 1; k < corners; ++k)
        if (mesh.nodeIds[nodes[k]] < mesh.nodeIds[nodes[lowest]])
          lowest = k;
      const int body = bodyOfNode_[nodes[lowest]];
      held[std::size_t(body) * blockCount + b] = 1;
      Vec3 x[8];
      for (int k = 0; k < corners; ++k)
        x[k] = at(state.x, nodes[k]) - bodies_[body].center;
      const Real rho = blocks[b].mass(e) / blocks[b].referenceVolume(e);
      integrateSolid(part.type, x, [&](const Vec3& r, Real volume) { add(body, rho * volume, r); });
    }
  }
  for (std::size_t b = 0; b < bodies; ++b)
    for (std::size_t i = 0; i < bodies_[b].nodes.size(); ++i)
      if (const Real m = others[bodies_[b].nodes[i]]; m > 0)
        add(int(b), m, bodies_[b].arms[i]);
  const std::vector<Real> totals = ExactSum::overRanks(sums, *comm_);
  comm_->sum(held);
  for (std::size_t b = 0; b < bodies; ++b)
  {
    for (std::size_t k = 0; k < blockCount; ++k)
      bodies_[b].blocks.push_back(held[b * blockCount + k] > 0);
    bodies_[b].inertia = inertiaFromMoments(&totals[6 * b]);
    bodies_[b].inverseInertia = inverseInertia(bodies_[b].inertia, dimension_);
  }
}
} // namespace coplane
