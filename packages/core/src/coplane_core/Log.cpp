#include <coplane_core/Log.hpp>

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <deque>
#include <memory>

namespace coplane
{
namespace
{
struct Channels
{
  std::shared_ptr<spdlog::logger> out, err;
  std::map<std::string, long> warnings;
  std::deque<std::string> messages;

  Channels()
  {
    out = std::make_shared<spdlog::logger>("coplane",
                                           std::make_shared<spdlog::sinks::stdout_sink_mt>());
    err = std::make_shared<spdlog::logger>("coplane",
                                           std::make_shared<spdlog::sinks::stderr_sink_mt>());
    out->set_pattern("%v");
    err->set_pattern("%v");
    out->flush_on(spdlog::level::info);
  }
};

Channels& channels()
{
  static Channels instance;
  return instance;
}
constexpr long shownWarnings = 3;
constexpr std::size_t keptMessages = 40;

void say(spdlog::level::level_enum level, const std::string& message)
{
  std::deque<std::string>& messages = channels().messages;
  messages.push_back(message);
  if (messages.size() > keptMessages)
    messages.pop_front();
  channels().err->log(level, "{}", message);
}

void warn(const std::string& text)
{
  say(spdlog::level::warn, "WARNING: " + text);
}
} // namespace

void logSetup(bool isRoot, bool quiet)
{
  channels().out->set_level(isRoot && !quiet ? spdlog::level::info : spdlog::level::off);
  channels().err->set_level(isRoot ? spdlog::level::info : spdlog::level::off);
}

void logInfo(const std::string& text)
{
  channels().out->info(text);
}

void logWarning(const std::string& kind, const std::string& text)
{
  const long count = ++channels().warnings[kind];
  if (count <= shownWarnings)
    warn(text);
  if (count == shownWarnings)
    warn(fmt::format("further warnings of this kind ({}) are counted, not shown", kind));
}

void logWarningEachTime(const std::string& text)
{
  warn(text);
}

void logError(const std::string& text)
{
  say(spdlog::level::err, "ERROR: " + text);
}

void logSummary()
{
  for (const auto& [kind, count] : channels().warnings)
    if (count > shownWarnings)
      channels().err->warn("WARNING: {} occurred {} times", kind, count);
}

std::vector<std::string> logMessages()
{
  return {channels().messages.begin(), channels().messages.end()};
}

std::map<std::string, long> logWarningCounts()
{
  return channels().warnings;
}
} // namespace coplane
