#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// What a command line that cannot be understood was most likely meant to be, as a line with its
/// end; or empty.
std::string usageHint(const std::vector<std::string>& arguments, const CLI::App& app);
} // namespace coplane
