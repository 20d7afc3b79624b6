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
      const Real volume = block.referenceVolume()(e);
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
} // namespace coplane
