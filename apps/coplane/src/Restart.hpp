#pragma once

#include <coplane_checkpoint/CheckpointReader.hpp>
#include <coplane_core/Comm.hpp>
#include <coplane_input/Deck.hpp>
#include <coplane_mesh/MeshSlice.hpp>

#include <string>
#include <utility>
#include <vector>

namespace coplane
{
/// What a checkpoint says of the run that wrote it, to be compared at a restart: hashes of the
/// parts of the mesh, the deck, and which part of the series of results it was. Collective.
std::vector<std::pair<std::string, std::string>>
fingerprintsOf(const Deck& deck, const MeshSlice& mesh, int part, const Comm& comm);

/// Identity of a run: the same for all parts, ranks and repetitions of what has the same bits, by
/// which a run knows what it may go on with or overwrite. Collective.
std::string identityOf(const Deck& deck, const MeshSlice& mesh, const Comm& comm);

/// The identity that the checkpoint's run had. Collective.
std::string identityIn(const CheckpointReader& checkpoint);

/// Throws Error(ExitCode::Checkpoint) on all ranks, naming what differs, when mesh or deck are not
/// those of the checkpoint; says what of the deck differs that a stage may change. Warns when
/// another version of the program has written it. Collective.
void demandSameRun(const CheckpointReader& checkpoint, const Deck& deck, const MeshSlice& mesh,
                   const Comm& comm);

/// The same as an answer. Collective.
bool isOfRun(const CheckpointReader& checkpoint, const Deck& deck, const MeshSlice& mesh,
             const Comm& comm);

/// Part of the series of results that the checkpoint belongs to. Collective.
int partIn(const CheckpointReader& checkpoint);
} // namespace coplane
