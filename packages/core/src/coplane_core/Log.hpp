#pragma once

#include <fmt/format.h>

#include <map>
#include <string>
#include <vector>

namespace coplane
{
/// Lines for the user, written by rank 0 only. Warnings are deduplicated: the first three of a kind
/// are shown, the rest counted and summed up by logSummary().
void logSetup(bool isRoot, bool quiet);
void logInfo(const std::string& text);
/// `kind` is a short fixed text by which warnings are counted.
void logWarning(const std::string& kind, const std::string& text);
/// Of something that is done to a user's file: each is shown.
void logWarningEachTime(const std::string& text);
void logError(const std::string& text);
void logSummary();
/// Warnings and errors of this rank as they were shown, also with `quiet`: the last 40, oldest
/// first.
std::vector<std::string> logMessages();
/// Number of warnings by kind, shown or not.
std::map<std::string, long> logWarningCounts();

template <class First, class... Args>
void logInfo(fmt::format_string<First, Args...> text, First&& first, Args&&... args)
{
  logInfo(fmt::format(text, std::forward<First>(first), std::forward<Args>(args)...));
}
} // namespace coplane
