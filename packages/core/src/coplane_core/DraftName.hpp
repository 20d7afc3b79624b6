#pragma once

#include <string>

namespace coplane
{
/// Eight characters that no other run has, and no file of a user: rank 0's, once all ranks have
/// taken it over.
const std::string& draftToken();
void setDraftToken(const std::string& token);

/// What an output is called until it is whole: `file`.part-1f2e3d4c. So a draft never meets a file
/// that was there before; the lock of a killed run names the token, hence the drafts it has left.
std::string draftOf(const std::string& file);
} // namespace coplane
