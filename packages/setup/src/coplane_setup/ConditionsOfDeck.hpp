#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_dynamics/Conditions.hpp>
#include <coplane_dynamics/Model.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/Mesh.hpp>
#include <coplane_mesh/MeshSlice.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <vector>

namespace coplane
{
/// What acts on this rank's part of the mesh, beside contact. Names have been checked before.
/// @param blocks as they start, for absorbing sides
Conditions conditionsOf(const Deck& deck, const Mesh& mesh, const RankMesh& part,
                        const std::vector<BlockSetup>& blocks);

/// Nodes beside the axis x = 0 of a body of revolution by round-off are on it: meshers write it as
/// R cos(pi / 2). Collective.
void bringToAxis(MeshSlice& mesh, const Comm& comm);

/// Makes the conditions those of a body of revolution: x is the radius, and nodes on the axis stay
/// there. Fails on all ranks when the mesh is not the section of one. Collective.
void revolve(const RankMesh& part, const Deck& deck, const Comm& comm, Conditions& conditions);

/// Charges that are too near to their faces or too far from them, or off the axis of a body of
/// revolution; the same on all ranks. Names may be unknown. Collective.
/// @param part with every node of this rank
std::vector<std::string> problemsOfAirBlasts(const Deck& deck, const Mesh& mesh,
                                             const RankMesh& part, const Comm& comm);

/// Faces on which two absorbing or free-field conditions would act at once; the same on all ranks.
/// Names may be unknown. Collective.
/// @param part with every node of this rank
std::vector<std::string> problemsOfDashpots(const Deck& deck, const Mesh& mesh,
                                            const RankMesh& part, const Comm& comm);

/// Probes whose reactions cannot be told: no condition holds a node of the set, or rigid bodies do,
/// which move as a whole; the same on all ranks. Names may be unknown. Collective.
/// @param part with every node of this rank
std::vector<std::string> problemsOfReactions(const Deck& deck, const Mesh& mesh,
                                             const RankMesh& part, const Comm& comm);

/// Warns of conditions that prescribe one component of one node differently: of prescribed motions
/// the later one acts, and any of them instead of a symmetry.
/// Collective.
/// @param part with every node of this rank
void warnOfDoubleConditions(const Deck& deck, const Mesh& mesh, const RankMesh& part,
                            const Comm& comm);
} // namespace coplane
