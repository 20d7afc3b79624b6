#pragma once

#include <coplane_schema/Schema.hpp>

#include <string>

namespace coplane
{
/// "materials.<name>": where a key stands. @param path of its group
std::string pathOf(const std::string& path, const Key& key);

/// "model: j2; 3D", or an empty string for a key that is always there.
std::string conditionText(const Key& group, const Key& key);

/// Which keys of a group exclude each other, and what may be left out.
std::string alternativesText(const Key& group);

std::string necessity(const Key& key);

/// Appends a key, and all keys in it, as plain text. @param path of its group
void writeText(const Key& group, const Key& key, const std::string& path, std::string& out);
} // namespace coplane
