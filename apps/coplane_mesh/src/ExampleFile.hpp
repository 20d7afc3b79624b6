#pragma once

#include <coplane_schema/DeckNode.hpp>
#include <coplane_schema/Schema.hpp>

#include <string>

namespace coplane
{
/// Of `example.yaml` files, which exodus_inputs/run.py runs: names of files, sizes and variants.
const Key& exampleSchema();

/// Reads and checks such a file and returns what it says as JSON. Throws Error(ExitCode::Deck) with
/// every problem that was found, one per line.
std::string exampleAsJson(const std::string& text, const std::string& file);

const FileKind& exampleFile();
} // namespace coplane
