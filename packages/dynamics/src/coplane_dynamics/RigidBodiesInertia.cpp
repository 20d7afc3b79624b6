// Which nodes are whose, and the moments of inertia of the solid.
#include <coplane_dynamics/RigidBodies.hpp>
#include <coplane_dynamics/detail/RigidInertia.hpp>
#include <coplane_mesh/Bodies.hpp>

#include <algorithm>

namespace coplane
{
Mat3 inertiaFromMoments(const Real* s) // xx yy zz xy yz zx of sum m r r^T
{
  Mat3 j;
  const Real trace = s[0] + s[1] + s[2];
  j(0, 0) = trace - s[0];
  j(1, 1) = trace - s[1];
  j(2, 2) = trace - s[2];
  j(0, 1) = j(1, 0) = -s[3];
  j(1, 2) = j(2, 1) = -s[4];
  j(2, 0) = j(0, 2) = -s[5];
  return j;
}

/// The inverse; in two dimensions of the part that turns.
Mat3 inverseInertia(const Mat3& j, int dimension)
{
  if (dimension == 3)
    return inverse(j);
  Mat3 r;
  r(2, 2) = 1 / j(2, 2);
  return r;
}

namespace
{
/// Calls f(point, volume) for points whose sum integrates second moments exactly.
template <class F>
void integrate(ElementType type, const Vec3* x, F&& f)
{
  constexpr Real point[3] = {-0.77459666924148337704, 0, 0.77459666924148337704};
  constexpr Real weight[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
  constexpr int xi[8] = {-1, 1, 1, -1, -1, 1, 1, -1}, eta[8] = {-1, -1, 1, 1, -1, -1, 1, 1},
                zeta[8] = {-1, -1, -1, -1, 1, 1, 1, 1};
  if (type == ElementType::Tri3)
  {
    // Midpoints of the sides: exact to the second degree.
    const Real area = 0.5 * cross(x[1] - x[0], x[2] - x[0]).z;
    for (int k = 0; k < 3; ++k)
      f(0.5 * (x[k] + x[(k + 1) % 3]), area / 3);
    return;
  }
  if (type == ElementType::Tet4)
  {
    // Four points, exact to the second degree (Keast 1986).
    constexpr Real a = 0.58541019662496845446, b = 0.13819660112501051518;
    const Real volume = dot(cross(x[1] - x[0], x[2] - x[0]), x[3] - x[0]) / 6;
    const Vec3 sum = x[0] + x[1] + x[2] + x[3];
    for (int k = 0; k < 4; ++k)
      f((a - b) * x[k] + b * sum, volume / 4);
    return;
  }
  const bool flat = type == ElementType::Quad4;
  const int nodes = flat ? 4 : 8;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < (flat ? 1 : 3); ++k)
      {
        const Real p = point[i], q = point[j], r = flat ? -1 : point[k];
        Vec3 at{}, g[3]{};
        for (int n = 0; n < nodes; ++n)
        {
          const Real a = 0.5 * (1 + xi[n] * p), b = 0.5 * (1 + eta[n] * q),
                     c = 0.5 * (1 + zeta[n] * r);
          at += (a * b * c) * x[n];
          g[0] += (0.5 * xi[n] * b * c) * x[n];
          g[1] += (a * 0.5 * eta[n] * c) * x[n];
          g[2] += (a * b * 0.5 * zeta[n]) * x[n];
        }
        if (flat)
          f(at, weight[i] * weight[j] * cross(g[0], g[1]).z);
        else
          f(at, weight[i] * weight[j] * weight[k] * dot(cross(g[0], g[1]), g[2]));
      }
}
} // namespace

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
      integrate(part.type, x, [&](const Vec3& r, Real volume) { add(body, rho * volume, r); });
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
