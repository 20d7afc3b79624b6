#include <coplane_contact/FacePairSteps.hpp>
#include <coplane_dynamics/Conditions.hpp>

#include <algorithm>

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

void Conditions::prescribeVelocities(Real t, const NodeVectors& v) const
{
  for (const SymmetryPlane& plane : symmetries)
    for (const int n : plane.nodes)
    {
      const Vec3 velocity = at(v, n);
      set(v, n, velocity - dot(velocity, plane.normal) * plane.normal);
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
