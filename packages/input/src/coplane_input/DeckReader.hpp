#pragma once

#include <coplane_input/Deck.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// Reads and checks a deck. `overrides` are the values of --set, such as "time.end=0.1"; items of
/// lists are named by their index, the first is 0: "conditions.0.value=[1, 0, 0]". Throws
/// Error(ExitCode::Deck) with every problem that was found, one per line.
Deck readDeck(const std::string& file, const std::vector<std::string>& overrides = {});

/// The text of a deck file, for one rank to read and to send to the others. Throws
/// Error(ExitCode::Deck).
std::string readDeckFile(const std::string& file);

/// The deck as it is in each stage, with the changes of the stages before it; time.end and
/// time.end_at_rest are those of the stage. One deck without stages. Throws as readDeck does.
std::vector<Deck> readStages(const std::string& file,
                             const std::vector<std::string>& overrides = {});

/// The same for text at hand.
std::vector<Deck> parseStages(const std::string& text, const std::string& file,
                              const std::vector<std::string>& overrides = {});

/// As readDeck, for text at hand; `file` gives the name in messages, the folder of the mesh and the
/// default names of outputs.
Deck parseDeck(const std::string& text, const std::string& file,
               const std::vector<std::string>& overrides = {});
} // namespace coplane
