#pragma once

#include <string>

namespace coplane
{
/// SHA-256 (FIPS 180-4) in hexadecimal, what sha256sum prints.
std::string sha256(const std::string& bytes);

/// The same of a file's content; empty when it cannot be read.
std::string sha256OfFile(const std::string& file);
} // namespace coplane
