#pragma once

#include <coplane_core/Error.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// What an exit code tells the user.
struct ExitCodeMeaning
{
  ExitCode code;
  const char* whose;    ///< fault: user, machine, program; empty: nobody's
  const char* meaning;  ///< a sentence
  const char* programs; ///< that end with it
};

/// All codes, ascending.
const std::vector<ExitCodeMeaning>& exitCodes();

/// The table of docs/user/exit-codes.md.
std::string exitCodesMarkdown();
} // namespace coplane
