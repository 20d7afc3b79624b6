#include <coplane_contact/FacePairSteps.hpp>
#include <coplane_dynamics/Conditions.hpp>

#include <algorithm>
#include <map>

namespace coplane
{
void Conditions::applyLoads(int dimension, int ownedNodes, Real t, NodalState& state) const
{
  const auto external = state.external;
  const auto damping = state.damping;
  const ConstArray<Real> mass = state.mass;
  const ConstNodeVectors v = state.v;
  const Vec3 g = gravity;
  const Real alpha = t < massDampingUntil ? massDamping : 0;
  parallelFor(
      "coplane::dynamics::applyLoads", ownedNodes, KOKKOS_LAMBDA(const int n) {
        set(external, n, mass(n) * g);
        set(damping, n, (-alpha * mass(n)) * at(v, n));
      });
  for (const FacePressure& load : pressures)
  {
    const Real pressure = load.pressure(t);
    for (const FacePressure::Side& side : load.sides)
    {
      Vec3 corners[4];
      for (int k = 0; k < side.count; ++k)
        corners[k] = at(state.x, side.nodes[k]);
      const Vec3 area =
          dimension == 2 ? vectorArea<2>(corners, side.count) : vectorArea<3>(corners, side.count);
      const Vec3 share = (-pressure / side.count) * area;
      for (int k = 0; k < side.count; ++k)
        if (side.nodes[k] < ownedNodes)
          set(external, side.nodes[k], at(external, side.nodes[k]) + share);
    }
  }
}

std::vector<Conditions::Projection> Conditions::projections() const
{
  constexpr Real dependent =
      1e-6; // sine of the angle below which a normal counts as one that is there already
  std::map<int, std::vector<Vec3>> normalsOf;
  for (const SymmetryPlane& plane : symmetries)
    for (const int node : plane.nodes)
    {
      std::vector<Vec3>& earlier = normalsOf[node];
      Vec3 normal = plane.normal;
      for (const Vec3& other : earlier)
        normal -= dot(normal, other) * other;
      if (norm(normal) > dependent)
        earlier.push_back(normalised(normal));
    }
  std::vector<Projection> result;
  for (const auto& [node, normals] : normalsOf)
    for (const Vec3& normal : normals)
      result.push_back({node, normal});
  return result;
}

void Conditions::prescribeVelocities(Real t, const NodeVectors& v) const
{
  prescribeVelocities(t, v, projections());
}

void Conditions::prescribeVelocities(Real t, const NodeVectors& v,
                                     const std::vector<Projection>& fromSymmetry) const
{
  for (const Projection& projection : fromSymmetry)
  {
    const Vec3 velocity = at(v, projection.node);
    set(v, projection.node, velocity - dot(velocity, projection.normal) * projection.normal);
  }
  for (const PrescribedVelocity& condition : velocities)
    for (int c = 0; c < 3; ++c)
    {
      if (!condition.components[c])
        continue;
      const Real value = condition.velocity[c] ? condition.velocity[c](t) : 0;
      for (const int n : condition.nodes)
        v(n, c) = value;
    }
}

std::vector<int> Conditions::constrainedNodes() const
{
  std::vector<int> nodes;
  for (const SymmetryPlane& plane : symmetries)
    nodes.insert(nodes.end(), plane.nodes.begin(), plane.nodes.end());
  for (const PrescribedVelocity& condition : velocities)
    nodes.insert(nodes.end(), condition.nodes.begin(), condition.nodes.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}
} // namespace coplane
