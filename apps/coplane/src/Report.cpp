#include "Report.hpp"

#include "BondSoftness.hpp"
#include "CensusReport.hpp"

#include <coplane_core/Log.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/ModelExtent.hpp>

#include <cmath>

namespace coplane
{
namespace
{
/// The first step and what limits it. Collective.
void reportStep(const Solver& solver, const Deck& deck)
{
  const StepControl control = solver.stepControl();
  const TimeOptions& time = solver.model().time;
  const Real step = solver.clock().nextStep, rest = deck.time.end - solver.clock().time;
  const char* const key = time.massScaling && step == time.massScaling->step ? "mass_scaling.step"
                          : time.fixedStep && step == *time.fixedStep        ? "fixed_step"
                          : time.maximumStep && step == *time.maximumStep    ? "maximum_step"
                                                                             : nullptr;
  if (!(control.stableStep < infinity))
    logInfo("first step: {:.6e} s{}; its stability is limited by {}", step,
            key ? fmt::format(", time.{}", key) : "", control.text());
  else if (key)
    logInfo("stable step: {:.6e} s, limited by {}; first step {:.6e} s, time.{}",
            control.stableStep, control.text(), step, key);
  else
    logInfo("stable step: {:.6e} s, times the safety factor {} = {:.6e} s; limited by {}",
            control.stableStep, time.stepFactor, step, control.text());
  if (rest > step)
    logInfo("  {:.3g} cycles of this step to time.end = {:g} s", std::ceil(rest / step),
            deck.time.end);
  constexpr Real manyCycles = 1e8;
  const std::string where = fmt::format("{}: time.end = {:g} s", deck.file, deck.time.end);
  if (rest > manyCycles * step)
    logWarning("a long run",
               fmt::format("{} is {:.2g} steps of {:.3g} s away: this will take very long. Seconds "
                           "are meant: 1 ms is 1e-3.",
                           where, rest / step, step));
  if (solver.clock().cycle == 0 && deck.time.end < step)
    logWarning("a short run",
               fmt::format("{} is less than the first step, {:.3g} s: there is one cycle. Seconds "
                           "are meant.",
                           where, step));
}
} // namespace

namespace
{
/// What mass scaling has added. Collective.
void reportAddedMass(const Solver& solver)
{
  if (!solver.scalesMass())
    return;
  logInfo("mass scaling for steps of {:g} s:", solver.model().time.massScaling->step);
  const std::vector<AddedMass> blocks = solver.addedMasses();
  for (std::size_t b = 0; b < blocks.size(); ++b)
    if (const AddedMass& block = blocks[b]; !solver.model().blocks[b].rigid)
      logInfo("  block '{}': {:.4g} kg added, {:.3g} % of its mass; of what is added momentum "
              "{:.3e} N s, kinetic energy {:.3e} J",
              solver.model().blocks[b].name, block.added, 100 * block.ratio(), norm(block.momentum),
              block.kinetic);
}
} // namespace

namespace
{
/// Places are numbers: those far from the origin have few digits left for how the model moves.
/// Collective.
void reportPlace(const Solver& solver)
{
  const ModelExtent extent = extentOf(solver.mesh(), solver.comm());
  if (extent.hasFewDigits())
    logWarning("a model far from the origin",
               fmt::format("the model is {:.3g} m large and lies {:.3g} m from the origin, where "
                           "places are known to {:.1g} m. Motions are summed up exactly, but "
                           "closures of contacts are no better known than that. Move the mesh: "
                           "name it in a recipe with offset (coplane_mesh make; "
                           "docs/user/meshes.md).",
                           extent.size, extent.farthest, extent.digits()));
}
} // namespace

void reportModel(const Solver& solver, const MeshSlice& mesh, const Deck& deck)
{
  const Comm& comm = solver.comm();
  std::vector<ExactSum> masses(solver.blocks().size());
  for (std::size_t b = 0; b < masses.size(); ++b)
    for (int e = 0; e < solver.blocks()[b].count(); ++e)
      if (solver.mesh().blocks[b].owned[e])
        masses[b].add(solver.blocks()[b].mass(e));
  const std::vector<Real> totals = ExactSum::overRanks(masses, comm);
  logInfo("mesh: {} nodes, {} elements, dimension {}", mesh.nodes, mesh.elements(),
          mesh.mine.dimension);
  for (std::size_t b = 0; b < masses.size(); ++b)
    logInfo("  block '{}' ({}): {} elements, mass {:.9g} kg", mesh.mine.blocks[b].name,
            mesh.mine.blocks[b].id, mesh.elementsOf(int(b)), totals[b]);

  reportPlace(solver);
  reportStep(solver, deck);
  reportAddedMass(solver);
  if (!solver.hasContact())
  {
    logInfo("contact: off");
    return;
  }
  reportCensus(solver.contact());
  reportMirrors(solver.mirrors());
  reportBondSoftness(solver);
  if (solver.clock().cycle == 0)
    reportInitialOverlaps(solver, deck.mesh, deck.contact.initialOverlap == "allow");
}

void reportEnd(const Solver& solver)
{
  const EnergyBalance energy = solver.energy();
  const Momenta momenta = solver.momenta();
  logInfo("energies [J]: kinetic {:.6e}, internal {:.6e} (plastic {:.3e}, of it bending {:.3e}), "
          "hourglass {:.3e}, viscous {:.3e}",
          energy.kinetic, energy.internal, energy.plastic, energy.bending, energy.hourglass,
          energy.viscous);
  if (energy.chemical > 0)
    logInfo("  released by explosives {:.6e}, part of internal", energy.chemical);
  logInfo("  contact: stored {:.3e}, friction {:.3e}, hysteresis {:.3e}, fracture {:.3e}, damping "
          "{:.3e}, remainder "
          "{:.3e}",
          energy.contact.stored, energy.contact.friction, energy.contact.hysteresis,
          energy.contact.fracture, energy.contact.damping, energy.contact.remainder());
  logInfo("  external work {:.3e}, mass damping {:.3e}, local damping {:.3e}, kinetic damping "
          "{:.3e}; balance off by {:.3e} of {:.3e} in play",
          energy.externalWork, energy.massDamping, energy.localDamping, energy.kineticDamping,
          energy.error(), energy.scale());
  if (const ErosionTotals erosion = solver.erosion(); erosion.elements > 0)
    logInfo("  eroded: {} elements, {:.6g} kg, with {:.3e} J, and {:.3e} J of their planes",
            erosion.elements, erosion.mass, energy.eroded, energy.contact.eroded);
  if (const Debris* debris = solver.debris(); debris && debris->count() > 0)
    logInfo("  debris: {} points, {} of them in contact; stored {:.3e} J, remainder {:.3e} J",
            debris->count(), debris->touching(), energy.debris.stored, energy.debris.remainder());
  logInfo("momentum [N s]: ({:.6e}, {:.6e}, {:.6e}), off by {:.3e} of {:.3e}", momenta.linear.x,
          momenta.linear.y, momenta.linear.z, norm(momenta.linearError()), momenta.magnitude);
  reportAddedMass(solver);
  if (solver.hasContact())
  {
    const ContactCounts counts = solver.contact().counts();
    logInfo("planes: {} ({} open, {} stick, {} slip) in {} slots; {} deeper than the limit; {} "
            "released; {} "
            "contacts missed; {} searches",
            counts.planes, counts.open, counts.stick, counts.slip, counts.slots, counts.tooDeep,
            counts.released, counts.missed, solver.searches());
  }
  if (const Repartitions& done = solver.repartitions(); done.count > 0)
    logInfo("rebalanced {} times in {:.3g} s; {} times a node changed its rank", done.count,
            done.seconds, done.nodesMoved);
  logInfo("seconds on rank 0:");
  for (const auto& [label, seconds] : timers())
    logInfo("  {:<46} {:9.3f}", label, seconds);
  logInfo("cycles {}, time {:.9e} s", solver.clock().cycle, solver.clock().time);
  logInfo("state hash {:016x}", solver.stateHash());
}
} // namespace coplane
