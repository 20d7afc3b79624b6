#pragma once

#include <coplane_schema/Schema.hpp>

#include <string>

namespace coplane
{
/// Every key with what it accepts, its default and its meaning, without an introduction.
std::string referenceText(const Key& schema);

/// The same of one topic: a section, a key wherever it stands (`friction`), its path
/// (`joints.friction`), a model or a choice with the keys that are its own (`mohr_coulomb`). Throws
/// Error(ExitCode::Usage) with suggestions when nothing has this name.
std::string topicText(const Key& schema, const std::string& topic);

/// The same of everything as tables of Markdown.
std::string referenceMarkdown(const Key& schema);

/// A JSON Schema (draft 7), with which editors complete and check files while they are written.
/// What one key demands of another (names that must exist, limits between values) is checked by the
/// programs only.
std::string jsonSchema(const Key& schema, const std::string& title);
} // namespace coplane
