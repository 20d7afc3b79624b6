#include "Report.hpp"

#include <coplane_core/Log.hpp>

#include <array>

namespace coplane
{
void reportModel(const Solver& solver, const Mesh& mesh)
{
  const Comm& comm = solver.comm();
  std::vector<ExactSum> masses(mesh.blocks.size());
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    for (int e = 0; e < solver.blocks()[b].count(); ++e)
      if (solver.mesh().blocks[b].owned[e])
        masses[b].add(solver.blocks()[b].mass(e));
  const std::vector<Real> totals = ExactSum::overRanks(masses, comm);
  logInfo("mesh: {} nodes, {} elements, dimension {}", mesh.nodes(), mesh.elements(), mesh.dimension);
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    logInfo("  block '{}' ({}): {} elements, mass {:.9g} kg", mesh.blocks[b].name, mesh.blocks[b].id,
            mesh.blocks[b].elements(), totals[b]);

  const StepControl control = solver.stepControl();
  logInfo("stable step: {:.6e} s, times the safety factor {} = {:.6e} s; limited by {} at node {}", control.stableStep,
          solver.model().time.stepFactor, solver.clock().nextStep, control.contact ? "contact" : "elements", control.node);

  if (!solver.hasContact())
  {
    logInfo("contact: off");
    return;
  }
  const ContactCensus census = solver.contact().census();
  logInfo("contact: skin {:.4e} m; {} candidate pairs", solver.contact().skin(), census.pairs);
  if (census.pairs == 0)
    return;
  logInfo("  normal stiffness of pairs: {:.4e} to {:.4e} Pa/m", census.leastStiffness, census.largestStiffness);
  logInfo("  declared joints: {} closed, {} without overlap", census.declaredClosed, census.declaredWithoutOverlap);
  if (census.declaredClosed > 0)
    logInfo("    gaps of the mesh that were absorbed: {:.3e} to {:.3e} m", census.leastGap, census.largestGap);
  logInfo("  other pairs: {} apart, {} overlapping", census.apart, census.overlapping);
  if (census.overlapping > 0)
    logInfo("    deepest overlap {:.3e} m: overlaps at the start carry no force", census.deepestOverlap);
}
} // namespace coplane
