#pragma once

#include <string>
#include <vector>

namespace coplane
{
/// What of a deck may not change between a run and its restart, a line "path = value" for each
/// value, sorted. Numbers are written in one way. Left out is what changes neither the state nor
/// the columns of the history: title, path of the mesh (the mesh itself is compared), end time,
/// energy tolerance, partition, and most of output, history and checkpoint.
std::string deckFingerprint(const std::string& deckText, const std::string& file);

/// What differs between two fingerprints, a sentence for each path: what a stage may change, and so
/// a restart, and what nothing may.
struct DeckChanges
{
  std::vector<std::string> allowed, refused;
};
/// @param stage the present one: those before it are done, of itself only its end may change
DeckChanges deckChanges(const std::string& before, const std::string& now, int stage = 0);

/// Whether a stage may change keys of this path at all, whatever the law.
bool isOfStages(const std::string& path);

/// For messages, a sentence.
std::string whatStagesMayChange();
} // namespace coplane
