#include <coplane_dynamics/Conditions.hpp>
#include <coplane_geometry/FaceCorners.hpp>
#include <coplane_mesh/ElementTopology.hpp>

#include <algorithm>
#include <map>

namespace coplane
{
std::array<Vec3, 4> cornerAreas(int dimension, const Vec3* x, int count, bool axisymmetric)
{
  if (dimension == 2)
  {
    const Vec3 half = 0.5 * vectorArea<2>(x, count);
    if (axisymmetric) // 2 pi int N_I r ds
      return {(2 * pi / 3 * (2 * x[0].x + x[1].x)) * half,
              (2 * pi / 3 * (x[0].x + 2 * x[1].x)) * half};
    return {half, half};
  }
  if (count == 3)
  {
    const Vec3 third = (1.0 / 3) * vectorArea<3>(x, count);
    return {third, third, third};
  }
  // x = mean + a xi + b eta + c xi eta; dx/dxi x dx/deta = a x b + a x c xi + c x b eta
  const Vec3 a = 0.25 * ((x[1] - x[0]) + (x[2] - x[3]));
  const Vec3 b = 0.25 * ((x[3] - x[0]) + (x[2] - x[1]));
  const Vec3 c = 0.25 * ((x[0] - x[1]) + (x[2] - x[3]));
  const Vec3 quarter = cross(a, b), alongXi = (1.0 / 3) * cross(a, c),
             alongEta = (1.0 / 3) * cross(c, b);
  return {quarter - alongXi - alongEta, quarter + alongXi - alongEta, quarter + alongXi + alongEta,
          quarter - alongXi + alongEta};
}

namespace
{
std::array<Vec3, 4> presentAreas(int dimension, const LoadedSide& side, const ConstNodeVectors& x,
                                 bool axisymmetric)
{
  return cornerAreas(dimension, cornersAt(x, side).x, side.count, axisymmetric);
}

template <class Force>
void addToCorners(const LoadedSide& side, int ownedNodes, const NodeVectors& external,
                  const Force& force)
{
  for (int k = 0; k < side.count; ++k)
    if (side.nodes[k] < ownedNodes)
      set(external, side.nodes[k], at(external, side.nodes[k]) + force(k));
}
} // namespace

void Conditions::applyLoads(int dimension, int ownedNodes, Real t, Real dt, NodalState& state) const
{
  const auto external = state.external;
  const ConstArray<Real> mass = state.mass, added = state.addedMass;
  const Vec3 g = gravity(t);
  parallelFor(
      "coplane::dynamics::applyLoads", ownedNodes,
      KOKKOS_LAMBDA(const int n) { set(external, n, (mass(n) - added(n)) * g); });
  for (const FacePressure& load : pressures)
  {
    if (!load.when.holds(t))
      continue;
    const Real everywhere = load.field ? 0 : load.pressure(t);
    for (const LoadedSide& side : load.sides)
    {
      const Real pressure = load.field ? load.field(t, side.place) : everywhere;
      const std::array<Vec3, 4> areas = presentAreas(dimension, side, state.x, axisymmetric);
      addToCorners(side, ownedNodes, external, [&](int k) { return -pressure * areas[k]; });
    }
  }
  for (const FaceTraction& load : tractions)
  {
    if (!load.when.holds(t))
      continue;
    const bool varies = bool(load.field[0]);
    const Vec3 everywhere = varies ? Vec3{} : load.traction(t);
    for (const LoadedSide& side : load.sides)
    {
      Vec3 traction = everywhere;
      for (int c = 0; c < 3 && varies; ++c)
        traction[c] = load.field[c](t, side.place);
      const std::array<Vec3, 4> areas = presentAreas(dimension, side, state.x, axisymmetric);
      const Vec3 normal = normalOf(areas);
      addToCorners(side, ownedNodes, external,
                   [&](int k) { return dot(areas[k], normal) * traction; });
    }
  }
  for (const AirBlast& blast : airBlasts)
    for (const BlastSide& face : blast.sides)
    {
      const Real pressure = blast.when.holds(t) ? face.wave.meanPressure(t, dt) : 0;
      if (!(pressure > 0))
        continue; // before it arrives and after it has passed
      const std::array<Vec3, 4> areas = presentAreas(dimension, face.side, state.x, axisymmetric);
      addToCorners(face.side, ownedNodes, external, [&](int k) { return -pressure * areas[k]; });
    }
}

void Conditions::clearConstrained(Real t, const std::vector<Projection>& fromSymmetry,
                                  const NodeVectors& forces) const
{
  for (const Projection& projection : fromSymmetry)
  {
    const Vec3 force = at(forces, projection.node);
    set(forces, projection.node, force - dot(force, projection.normal) * projection.normal);
  }
  for (const PrescribedVelocity& condition : velocities)
    for (int c = 0; c < 3; ++c)
      if (condition.components[c] && condition.when.holds(t))
        for (const int n : condition.nodes)
          forces(n, c) = 0;
}

std::vector<char> Conditions::activeSymmetries(Real t) const
{
  std::vector<char> active;
  for (const SymmetryPlane& plane : symmetries)
    active.push_back(plane.when.holds(t));
  return active;
}

std::vector<Conditions::Projection> Conditions::projections(Real t) const
{
  constexpr Real dependent =
      1e-6; // sine of the angle below which a normal counts as one that is there already
  std::map<int, std::vector<Vec3>> normalsOf;
  for (const SymmetryPlane& plane : symmetries)
    for (const int node : plane.when.holds(t) ? plane.nodes : std::vector<int>())
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

void Conditions::endLoadsOn(const std::vector<GlobalId>& dead)
{
  const auto isDead = [&](const LoadedSide& side)
  { return std::binary_search(dead.begin(), dead.end(), elementOfFace(side.id)); };
  const auto forget = [](auto& sides, const auto& gone)
  { sides.erase(std::remove_if(sides.begin(), sides.end(), gone), sides.end()); };
  for (FacePressure& load : pressures)
    forget(load.sides, isDead);
  for (FaceTraction& load : tractions)
    forget(load.sides, isDead);
  for (AirBlast& blast : airBlasts)
    forget(blast.sides, [&](const BlastSide& face) { return isDead(face.side); });
  for (AbsorbingBoundary& boundary : absorbing)
    forget(boundary.sides, [&](const AbsorbingSide& face) { return isDead(face.side); });
  for (FreeFieldBoundary& boundary : freeFields)
    forget(boundary.sides, [&](const FreeFieldSide& face) { return isDead(face.side); });
}

void Conditions::takeFaceLoads(const Conditions& from)
{
  pressures = from.pressures;
  tractions = from.tractions;
  airBlasts = from.airBlasts;
  absorbing = from.absorbing;
  freeFields = from.freeFields;
}

void Conditions::prescribeVelocities(Real t, const NodeVectors& v) const
{
  prescribeVelocities({t, 0, 0}, v, v, projections(t));
}

void Conditions::prescribeVelocities(const KickTimes& times, const ConstNodeVectors& before,
                                     const NodeVectors& v,
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
      if (!condition.components[c] || !condition.when.holds(times.middle()))
        continue;
      const bool accelerates = condition.of == PrescribedVelocity::Of::Acceleration;
      if (condition.of != PrescribedVelocity::Of::Velocity && !(times.step > 0))
        continue; // at the start: the velocities that are given there
      const OfTimeAndPlace& field = condition.field[c];
      const OfTime& function = condition.velocity[c];
      const Real everywhere = function ? condition.speed(function, times, 0) : 0;
      for (std::size_t i = 0; i < condition.nodes.size(); ++i)
      {
        const int n = condition.nodes[i];
        const Real value =
            field ? condition.speed([&](Real t) { return field(t, condition.places[i]); }, times, 0)
                  : everywhere;
        v(n, c) = accelerates ? before(n, c) + value : value;
      }
    }
}

void Conditions::keepPrescribed(const KickTimes& times, const ConstNodeVectors& from,
                                const NodeVectors& to) const
{
  for (const PrescribedVelocity& condition : velocities)
    for (int c = 0; c < 3; ++c)
      if (condition.components[c] && condition.when.holds(times.middle()))
        for (std::size_t i = 0; i < condition.nodes.size(); ++i)
        {
          const int n = condition.nodes[i];
          to(n, c) = from(n, c);
          if (condition.of == PrescribedVelocity::Of::Acceleration)
            to(n, c) -= 0.5 * times.step * condition.at(c, i, times.t);
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
