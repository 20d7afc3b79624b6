// Element-cycles per second:
//   <shape>/<form>/<law>   the update of one block alone: a square or a cube of distorted elements
//   laws/<shape>/<law>     the update of one block of each law over 50 steps of compression with
//                          shear far beyond the elastic range; `dissipated` is the part of the
//                          internal energy that is lost at the end of them
//   whole_cycle            hexahedra with J2 plasticity, hourglass stiffness and bulk viscosity as
//   the
//                          solver computes them: drift, elements, sums at the nodes, kick, ledger
// The J2 law has no branches: yielding costs nothing extra. The memory bandwidth of the same
// machine at the same time is measured beside them. Options: those of Google Benchmark, and
// --threads N.
#include "Benchmarks.hpp"

#include <coplane_dynamics/Solver.hpp>

#include <Laws.hpp>
#include <cmath>
#include <vector>

namespace coplane
{
namespace
{
struct Scene
{
  ElementType type;
  NodeVectors x, v;
  std::vector<int> connectivity;
};

/// n cells along each edge, 10 mm wide, all nodes moved; a cell is one quadrilateral or hexahedron,
/// two triangles or six tetrahedra.
Scene sceneOf(ElementType type, int n)
{
  const bool flat = topology(type).dimension == 2;
  const int m = n + 1, up = m * m, nodes = flat ? m * m : m * m * m;
  const Real h = 0.01;
  Scene scene{type, NodeVectors("x", nodes), NodeVectors("v", nodes), {}};
  for (int node = 0; node < nodes; ++node)
  {
    const int i = node % m, j = node / m % m, k = node / up;
    const Real x[3] = {i + 0.1 * std::sin(Real(7 * i + 3 * j + 5 * k)) + (flat ? m : 0),
                       j + 0.1 * std::sin(Real(2 * i + 9 * j + 4 * k)),
                       k + 0.1 * std::sin(Real(8 * i + 6 * j + 3 * k))};
    const Real v[3] = {std::sin(0.7 * i + 0.2 * k), std::cos(0.4 * j - 0.3 * i),
                       -std::sin(0.5 * k + 0.1 * j)};
    for (int c = 0; c < (flat ? 2 : 3); ++c)
    {
      scene.x(node, c) = h * x[c];
      scene.v(node, c) = 100 * v[c];
    }
  }
  const auto add = [&](std::initializer_list<int> corners)
  { scene.connectivity.insert(scene.connectivity.end(), corners); };
  for (int k = 0; k < (flat ? 1 : n); ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
      {
        const int o = k * up + j * m + i, far = m + 1;
        switch (type)
        {
        case ElementType::Tri3:
          add({o, o + 1, o + far});
          add({o, o + far, o + m});
          break;
        case ElementType::Quad4:
          add({o, o + 1, o + far, o + m});
          break;
        case ElementType::Tet4: // paths along the edges from one end of a diagonal to the other
          for (const auto& [a, b] : {std::pair{1, far}, {m, m + up}, {up, up + 1}})
            add({o, o + a, o + b, o + far + up});
          for (const auto& [a, b] : {std::pair{m, far}, {up, m + up}, {1, up + 1}})
            add({o, o + b, o + a, o + far + up});
          break;
        case ElementType::Hex8:
          add({o, o + 1, o + far, o + m, o + up, o + 1 + up, o + far + up, o + m + up});
          break;
        }
      }
  return scene;
}

void report(benchmark::State& state, int elements)
{
  state.counters["elements/s"] =
      benchmark::Counter(Real(elements), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["threads"] = threadCount();
}

void elementUpdate(benchmark::State& state, Backend backend, ElementType type,
                   const ElementOptions& options, const Material& law)
{
  setBackend(backend);
  const Scene scene = sceneOf(type, int(state.range(0)));
  ElementBlock block(type, law, {}, {}, scene.connectivity, options);
  block.initialise(scene.x);
  const bool nodal = options.form == ElementForm::NodalPressure;
  const Array<Real> dilatation("dilatation", nodal ? scene.x.extent(0) : 0);
  Real dt = 1e-8; // the positions stay: only the rates matter for the time
  for (auto _ : state)
  {
    if (nodal)
      block.findVolumeChanges(scene.x, scene.v, dt);
    block.update(scene.x, scene.v, dt, dilatation);
    if (nodal)
      block.addNodalTension(scene.x, dilatation);
    benchmark::DoNotOptimize(dt);
  }
  report(state, block.count());
}

/// Strains a block to law.strain in `steps` steps, again and again from the start.
void lawPath(benchmark::State& state, Backend backend, ElementType type,
             const testing::NamedLaw& law)
{
  setBackend(backend);
  const int steps = 50;
  const Scene scene = sceneOf(type, int(state.range(0)));
  const int nodes = int(scene.x.extent(0));
  const Real dt = 1e-6, rate = law.strain / (steps * dt);
  const NodeVectors x("x", nodes);
  for (int n = 0; n < nodes; ++n)
  {
    const Vec3 p = at(scene.x, n);
    set(scene.v, n, rate * Vec3{0.3 * p.x + 0.6 * p.y, -p.y + 0.2 * p.z, 0.3 * p.x + 0.2 * p.z});
    if (topology(type).dimension == 2)
      scene.v(n, 2) = 0;
  }
  ElementBlock block(type, law.law, {}, {}, scene.connectivity);
  int step = steps;
  for (auto _ : state)
  {
    state.PauseTiming();
    if (step == steps)
    {
      Kokkos::deep_copy(x, scene.x);
      block.initialise(x);
      step = 0;
    }
    for (int n = 0; n < nodes; ++n)
      set(x, n, at(x, n) + dt * at(scene.v, n));
    ++step;
    state.ResumeTiming();
    block.update(x, scene.v, dt);
  }
  Real internal = 0, lost = 0;
  for (int e = 0; e < block.count(); ++e)
  {
    internal += block.energy(e, ElementEnergy::Internal);
    lost += block.energy(e, ElementEnergy::PlasticDissipation);
  }
  state.counters["dissipated"] = lost / internal;
  report(state, block.count());
}

void wholeCycle(benchmark::State& state, Backend backend)
{
  setBackend(backend);
  const Scene scene = sceneOf(ElementType::Hex8, int(state.range(0)));
  Model model;
  const int nodes = int(scene.x.extent(0)), elements = int(scene.connectivity.size()) / 8;
  model.mesh.ownedNodes = nodes;
  for (int n = 0; n < nodes; ++n)
  {
    model.mesh.nodeIds.push_back(n + 1);
    model.mesh.nodePositions.push_back(n);
    model.mesh.coordinates.push_back(at(scene.x, n));
  }
  RankMesh::Block block;
  block.type = ElementType::Hex8;
  block.connectivity = scene.connectivity;
  for (int e = 0; e < elements; ++e)
  {
    block.elementIds.push_back(e + 1);
    block.positions.push_back(e);
    block.bodyIds.push_back(1);
    block.owned.push_back(1);
  }
  model.mesh.blocks = {block};
  BlockSetup setup;
  setup.name = "cube";
  setup.material = makeJ2Plasticity(makeLinearElastic(200e9, 0.3, 7850), 400e6, 100e6);
  setup.velocityField = [](const Vec3& x) {
    return Vec3{10 * std::sin(30 * x.y), 10 * std::cos(20 * x.z), -10 * std::sin(25 * x.x)};
  };
  model.blocks = {setup};
  model.contactEnabled = false;
  const Comm comm;
  Solver solver(std::move(model), comm);
  solver.prepare();
  for (auto _ : state)
    solver.advance();
  report(state, elements);
}
} // namespace
} // namespace coplane

int main(int argc, char** argv)
{
  using namespace coplane;
  return runBenchmarks(
      argc, argv,
      [](Backend backend)
      {
        using F = ElementForm;
        const auto addForm = [&](ElementType type, const ElementOptions& options, const char* label)
        {
          const int n = topology(type).dimension == 2 ? 300 : type == ElementType::Tet4 ? 26 : 48;
          for (const bool plastic : {false, true})
          {
            const Material law =
                plastic
                    ? Material(makeJ2Plasticity(makeLinearElastic(200e9, 0.3, 7850), 400e6, 100e6))
                    : Material(makeLinearElastic(200e9, 0.3, 7850));
            addBenchmark(std::string(label) + (plastic ? "/j2" : "/elastic"), backend,
                         [=](benchmark::State& state, Backend b)
                         { elementUpdate(state, b, type, options, law); })
                ->Arg(n);
          }
        };
        const ElementOptions revolved{F::OnePoint, ObjectiveRate::HughesWinget,
                                      Geometry::Axisymmetric};
        addForm(ElementType::Hex8, {F::OnePoint}, "hex8/one_point");
        addForm(ElementType::Hex8, {F::AssumedStrain}, "hex8/assumed_strain");
        addForm(ElementType::Hex8, {F::FullIntegration}, "hex8/full_integration");
        addForm(ElementType::Hex8, {F::OnePoint, ObjectiveRate::GreenNaghdi}, "hex8/green_naghdi");
        addForm(ElementType::Tet4, {F::OnePoint}, "tet4/one_point");
        addForm(ElementType::Tet4, {F::NodalPressure}, "tet4/nodal_pressure");
        addForm(ElementType::Quad4, {F::OnePoint}, "quad4/one_point");
        addForm(ElementType::Quad4, {F::AssumedStrain}, "quad4/assumed_strain");
        addForm(ElementType::Quad4, {F::FullIntegration}, "quad4/full_integration");
        addForm(ElementType::Quad4, revolved, "quad4/axisymmetric");
        addForm(ElementType::Tri3, {F::OnePoint}, "tri3/one_point");
        addForm(ElementType::Tri3, {F::NodalPressure}, "tri3/nodal_pressure");
        addForm(ElementType::Tri3, revolved, "tri3/axisymmetric");
        std::vector<testing::NamedLaw> laws = testing::allLaws();
        const EquationOfState eos = testing::steelShock();
        laws.push_back({"fluid", Fluid{{7850, eos.stiffness, 0}, eos}, 0.05});
        const auto addLaws = [&](ElementType type, const char* label, int n)
        {
          for (const testing::NamedLaw& law : laws)
            addBenchmark("laws/" + std::string(label) + "/" + law.name, backend,
                         [=](benchmark::State& state, Backend b) { lawPath(state, b, type, law); })
                ->Arg(n)
                ->Iterations(50);
        };
        addLaws(ElementType::Hex8, "hex8", 32);
        addLaws(ElementType::Quad4, "quad4", 180);
        addLaws(ElementType::Tet4, "tet4", 17);
        addBenchmark("whole_cycle", backend, wholeCycle)->Arg(48);
      });
}
