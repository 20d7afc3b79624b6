#include <coplane_core/Log.hpp>
#include <coplane_input/MaterialCards.hpp>
#include <coplane_setup/Lookups.hpp>
#include <coplane_setup/SofteningReport.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
void reportSoftening(const Deck& deck, const MeshSlice& mesh, const Solver& solver,
                     const Comm& comm)
{
  for (std::size_t b = 0; b < mesh.mine.blocks.size(); ++b)
  {
    const ElementBlock& block = solver.blocks()[b];
    const std::string& name = mesh.mine.blocks[b].name;
    const MaterialCard& material = materialCardOf(deck, cardOf(deck, mesh.mine.blocks[b]));
    const SofteningLimit limit = softeningLimit(material);
    if (limit.size == infinity)
      continue; // the same on every rank
    const bool flat = topology(block.type()).dimension == 2;
    Real largest = 0;
    for (int e = 0; e < block.count(); ++e)
    {
      const Real volume = block.referenceVolume(e);
      largest = std::max(largest, flat ? std::sqrt(volume) : std::cbrt(volume));
    }
    largest = comm.max(largest);
    if (largest >= limit.size)
      logWarning("softening",
                 fmt::format("block '{}' has elements of up to {:.4g} m, but material '{}' can be "
                             "followed up to E {} / ({})^2 = {:.4g} m: larger elements have to "
                             "spring back when they soften, and take more energy than they should. "
                             "Refine the mesh, or lower {} for large elements.",
                             name, largest, material.name, limit.energy, limit.strength, limit.size,
                             limit.strength));
  }
}

void reportDamping(const Deck& deck)
{
  constexpr Real far = 0.1; // of the ratio
  for (const BlockCard& block : deck.blocks)
  {
    const MaxwellCard& asked = block.damping;
    if (!(asked.ratio > 0) || block.rigid)
      continue;
    const MaxwellFit fit = fitMaxwell(asked.ratio, *asked.low, *asked.high, asked.elements);
    const Real middle = std::sqrt(*asked.low * *asked.high);
    const Real added = fit.elements.added();
    const std::string told = fmt::format(
        "block '{}': {} Maxwell elements give {:.4g} to {:.4g} of critical damping between {:.4g} "
        "and {:.4g} Hz (asked for: {:.4g})",
        block.name, fit.elements.count, fit.least, fit.largest, *asked.low, *asked.high,
        asked.ratio);
    logInfo(
        "{}; {} are {:.4g} times those at rest at {:.4g} Hz, and at most {:.4g} times, by which "
        "the stable step is divided by at most {:.4g}",
        told, asked.volumetric ? "moduli" : "shear moduli", fit.elements.storage(middle), middle,
        1 + added, std::sqrt(1 + added));
    if (std::max(asked.ratio - fit.least, fit.largest - asked.ratio) > far * asked.ratio)
      logWarning("Maxwell damping", told + ": use more elements, or a narrower band.");
  }
}
} // namespace coplane
