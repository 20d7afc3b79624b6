#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_core/FileLock.hpp>
#include <coplane_input/Deck.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// Names that follow from those of the deck.
std::string recordFile(const Deck& deck, int part);
std::string planesBase(const Deck& deck);
std::string fragmentsFile(const Deck& deck);
std::string tablesBase(const Deck& deck);
std::string stopFile(const Deck& deck);
/// One that was there before the start; what is put there from then on ends the run. Collective.
void removeOldStopFile(const Deck& deck, const Comm& comm);

/// Ranks on machines of their own may find different files under one name. Throws Error on all
/// ranks, ExitCode::Usage or Mesh, when they work in different folders or see different meshes.
/// Where they do not all see one file (inode and time), each reads the mesh once to compare it;
/// parts of a split mesh are not compared. Collective.
void demandSameFiles(const Deck& deck, const Comm& comm);

/// Throws Error(ExitCode::Deck) on all ranks when an output of the run is an input of it, another
/// output, or not a plain file. Before anything is written. Collective.
/// @param restartedFrom checkpoint that is read; empty: none, or the newest of the run
void demandDistinctFiles(const Deck& deck, const std::string& restartedFrom, const Comm& comm);

/// Throws Error(ExitCode::Output) on all ranks when an output cannot be written, before what an
/// earlier run left is touched. Collective.
void demandWritableFiles(const Deck& deck, const Comm& comm);

/// Makes sure that no other run writes files of the same names. Throws Error(ExitCode::Output) on
/// all ranks when one does. Rank 0 holds the locks for as long as the result lives. Collective.
/// Drafts that a killed run has left, by the word of its lock, are removed.
std::vector<FileLock> lockOutputs(const Deck& deck, const Comm& comm);
} // namespace coplane
