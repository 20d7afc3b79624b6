#pragma once

#include "CutBlocks.hpp"

#include <string>

namespace coplane
{
/// All that a cut domain holds, for another process on the same machine.
std::string bytesOf(const CutDomain& domain);

/// Throws Error(ExitCode::Internal) for bytes that bytesOf has not made.
CutDomain cutDomainOf(const std::string& bytes);
} // namespace coplane
