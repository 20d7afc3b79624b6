#pragma once

#include <coplane_core/FileLock.hpp>
#include <coplane_core/FileRoles.hpp>

#include <set>
#include <string>
#include <vector>

namespace coplane
{
/// Holds locks with the names of all outputs in them, as long as it lives. Throws
/// Error(ExitCode::Output) when another process writes one of the outputs, under whatever name.
/// @param files names of the locks; those beside what links lead to belong among them
/// @param whose for messages: "wall.yaml"
std::vector<FileLock> lockOutputs(const FileRoles& outputs, const std::set<std::string>& files,
                                  const std::string& whose);

/// Removes drafts of a run that was killed, beside the outputs: the lock that it left names them.
void removeDraftsOfKilled(const FileRoles& outputs, const std::vector<FileLock>& locks);
} // namespace coplane
