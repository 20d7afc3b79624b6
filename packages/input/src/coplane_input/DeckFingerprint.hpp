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

/// What differs between two fingerprints, a sentence for each path, at most `most` of them.
std::vector<std::string> deckDifferences(const std::string& before, const std::string& now,
                                         std::size_t most = 10);
} // namespace coplane
