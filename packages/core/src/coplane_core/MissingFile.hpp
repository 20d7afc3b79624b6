#pragma once

#include <string>

namespace coplane
{
/// What may be wrong with the name of a file that is not there, as a sentence with a blank before
/// it: a file of the same folder with a similar name, signs that only a shell replaces, backslashes
/// between folders. Empty: nothing comes to mind. Throws nothing.
std::string hintOfMissingFile(const std::string& file);
} // namespace coplane
