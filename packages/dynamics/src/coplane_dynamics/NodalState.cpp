#include <coplane_dynamics/NodalState.hpp>

namespace coplane
{
NodalState::NodalState(const RankMesh& mesh)
    : x("x", mesh.nodes()), xRest("xRest", mesh.ownedNodes), v("v", mesh.nodes()),
      mass("mass", mesh.ownedNodes), reference("reference", mesh.nodes()),
      vPrevious("vPrevious", mesh.ownedNodes), force("force", mesh.ownedNodes),
      contactForce("contactForce", mesh.ownedNodes), external("external", mesh.ownedNodes),
      damping("damping", mesh.ownedNodes), localDamping("localDamping", mesh.ownedNodes),
      impulse("impulse", mesh.ownedNodes), angularImpulse("angularImpulse", mesh.ownedNodes),
      atSearch("atSearch", mesh.ownedNodes), velocityAtSearch("velocityAtSearch", mesh.ownedNodes),
      atPassing("atPassing", mesh.ownedNodes), externalWork("externalWork", mesh.ownedNodes),
      dampingWork("dampingWork", mesh.ownedNodes),
      localDampingWork("localDampingWork", mesh.ownedNodes),
      totalWork("totalWork", mesh.ownedNodes),
      contactStiffness("contactStiffness", mesh.ownedNodes),
      addedMass("addedMass", mesh.ownedNodes), substeps("substeps", mesh.nodes()),
      steadyMean("steadyMean", mesh.ownedNodes), steadyForce("steadyForce", mesh.ownedNodes),
      underWay("underWay", mesh.ownedNodes), takenOff("takenOff", mesh.ownedNodes),
      swing("swing", mesh.ownedNodes)
{
  Kokkos::deep_copy(substeps, 1.0);
  for (int n = 0; n < mesh.nodes(); ++n)
  {
    set(x, n, mesh.coordinates[n]);
    set(reference, n, mesh.coordinates[n]);
  }
}

void NodalState::resize(const NodeLayout& layout)
{
  Kokkos::resize(x, layout.size());
  Kokkos::resize(v, layout.size());
  Kokkos::resize(substeps, layout.size());
}
} // namespace coplane
