// Planes per second of steps A to H and of the sum of their forces at the nodes, on one rank: two
// flat interfaces of 200 x 200 and 201 x 201 quadrilaterals that lie on each other, 160 000 planes,
// an uneven closure, Coulomb friction and the closure curve, by both forces: names end with that.
//   flat      squares
//   sheared   the same with every node moved in the plane, so that no face is a parallelogram
//   warped    the same with every node moved in all directions, so that no face is plane
// The memory bandwidth of the same machine at the same time is measured beside them.
// Options: those of Google Benchmark, and --threads N. Times are wall times.
#include "Benchmarks.hpp"

#include <coplane_contact/Contact.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_mesh/ElementTopology.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace coplane
{
namespace
{
struct Scene
{
  RankMesh mesh;
  std::vector<Face> faces; ///< sorted by id

  /// n x n quadrilaterals over the unit square; nodes moved by fractions of a side.
  void addInterface(int n, Real z, bool up, Real inPlane, Real across)
  {
    const int first = int(mesh.coordinates.size());
    const Real side = 1.0 / n;
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
      {
        mesh.coordinates.push_back({side * (i + inPlane * std::sin(12.9898 * i + 78.233 * j)),
                                    side * (j + inPlane * std::sin(39.3468 * i + 11.135 * j)),
                                    z + side * across * std::sin(73.156 * i + 52.235 * j)});
        mesh.nodeIds.push_back(GlobalId(mesh.nodeIds.size()));
      }
    const GlobalId firstElement = GlobalId(faces.size());
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
      {
        const int corner = first + j * (n + 1) + i;
        const int nodes[4] = {corner, corner + 1, corner + n + 2, corner + n + 1};
        Face face;
        face.id = faceId(firstElement + j * n + i, 0);
        face.count = 4;
        for (int k = 0; k < 4; ++k)
          face.nodes[k] = nodes[up ? k : 3 - k];
        face.thickness = side;
        face.modulus = 1e10;
        face.local = face.ownedHere = true;
        faces.push_back(face);
      }
  }
};

void update(benchmark::State& state, Backend backend, ContactOptions::Forces forces, Real inPlane,
            Real across)
{
  setBackend(backend);
  const int n = int(state.range(0));
  const Real side = 1.0 / n;
  Scene scene;
  scene.addInterface(n, 0, true, inPlane, across);
  scene.addInterface(n + 1, 0.01 * side, false, inPlane, across);
  scene.mesh.ownedNodes = int(scene.mesh.coordinates.size());
  const Comm comm;
  NodeLayout layout(comm, scene.mesh);
  const int nodes = layout.size();
  NodeVectors x("x", nodes), v("v", nodes), f("f", nodes);
  Array<Real> stiffness("stiffness", nodes);
  for (int node = 0; node < nodes; ++node)
  {
    const Vec3 p = scene.mesh.coordinates[node];
    // Tilted and bent, so that the closure is uneven on every plane.
    set(x, node, p + Vec3{0, 0, node < (n + 1) * (n + 1) ? 0 : 0.002 * side * std::sin(40 * p.x)});
    set(v, node, {0.1 * std::sin(7 * p.y), 0.1 * std::cos(9 * p.x), 0.01 * std::sin(5 * p.x)});
  }
  ContactRules rules;
  JointRecipe joint;
  joint.law.penalty = false;
  joint.law.initialStiffness = 1e11;
  joint.law.curve.inverseMaximumClosure = 1 / (0.05 * side);
  joint.law.friction = 0.6;
  rules.joints = {joint};
  rules.tellApart(1);
  ContactOptions options = ContactOptions::with(forces);
  options.inherit = false;
  const Real skin = 0.1 * side;
  Contact contact(comm, 3, scene.faces, options, rules, skin, side);
  contact.findGhosts(x, layout.ids());
  contact.pairUp(x, layout);
  const Real dt = 1e-9; // the positions stay: only the rates matter for the time
  contact.step6_updateCommonPlanes(x, v, dt, 2 * dt, dt); // apart
  // They meet in one step, with the velocity that takes them there.
  const NodeVectors closing("closing", nodes);
  for (int node = (n + 1) * (n + 1); node < nodes; ++node)
  {
    x(node, 2) -= 0.02 * side;
    closing(node, 2) = -0.02 * side / dt;
  }
  contact.step6_updateCommonPlanes(x, closing, dt, 2 * dt, dt);
  for (auto _ : state)
  {
    contact.step6_updateCommonPlanes(x, v, dt, 2 * dt, dt);
    contact.addForces(f, stiffness);
    benchmark::DoNotOptimize(f.data());
  }
  std::int64_t planes = 0;
  for (std::size_t p = 0; p < contact.planes().size(); ++p)
    planes += contact.planes()[p].area > 0;
  state.counters["slots"] = Real(contact.slots());
  state.counters["planes"] = Real(planes);
  state.counters["planes/s"] =
      benchmark::Counter(Real(planes), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["bytes/plane"] = Real(sizeof(Plane) + 2 * sizeof(std::int32_t));
}

} // namespace
} // namespace coplane

int main(int argc, char** argv)
{
  using namespace coplane;
  return runBenchmarks(argc, argv,
                       [](Backend backend)
                       {
                         for (const bool potential : {true, false})
                         {
                           const auto add = [=](const char* scene, Real inPlane, Real across)
                           {
                             const auto forces = potential ? ContactOptions::Forces::Potential
                                                           : ContactOptions::Forces::CommonNormal;
                             addBenchmark(std::string(scene) +
                                              (potential ? "/potential" : "/common_normal"),
                                          backend,
                                          [=](benchmark::State& state, Backend b)
                                          { update(state, b, forces, inPlane, across); })
                                 ->Arg(200);
                           };
                           add("flat", 0, 0);
                           add("sheared", 0.05, 0);
                           add("warped", 0.05, 0.001);
                         }
                       });
}
