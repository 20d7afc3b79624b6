#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/MeshSlice.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <string>
#include <vector>

namespace coplane
{
// What is wrong with a deck once the mesh and the laws are known, a line for each problem.

/// What blocks ask of their material's law that it does not have, or that it is not in two
/// dimensions.
std::vector<std::string> problemsOfLaws(const Deck& deck, int dimension);

/// What a deck asks of rigid blocks that they cannot do. Names have been checked before. The same
/// on all ranks. Collective.
std::vector<std::string> problemsOfRigidBlocks(const Deck& deck, const MeshSlice& mesh,
                                               const Comm& comm);

/// Probes whose points lie beside all bodies: farther from the nearest node than the elements there
/// are long. Points on a line are only warned of, as lines may cross an opening. The same on all
/// ranks. Collective.
/// @param part with every node of this rank
std::vector<std::string> problemsOfProbes(const Deck& deck, const RankMesh& part, const Comm& comm);

/// Warns of initial stress of more than a tenth of the P-wave modulus, somewhere in its block: most
/// often a slip of units. Not in fluids, whose stress at the start is their state. Collective.
/// @param mesh of which names count
/// @param part with every node of this rank
void warnOfInitialStress(const Deck& deck, const Mesh& mesh, const RankMesh& part,
                         const Comm& comm);
} // namespace coplane
