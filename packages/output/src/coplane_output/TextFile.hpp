#pragma once

#include <string>

namespace coplane
{
/// Replaces a file as a whole: written beside it and renamed, so that whoever reads it sees the old
/// or the new text and a killed program leaves no half. Throws Error(ExitCode::Output) with file
/// and reason; call it on one rank, within Comm::together.
void replaceFile(const std::string& file, const std::string& text);

/// Throws Error(ExitCode::Output): the file, what the system says (errno) and what to check.
[[noreturn]] void failToWrite(const std::string& file);
} // namespace coplane
