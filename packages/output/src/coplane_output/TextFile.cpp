#include <coplane_core/Error.hpp>
#include <coplane_core/FileRoles.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_output/TextFile.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <sstream>
#include <sys/stat.h>
#include <vector>

namespace coplane
{
namespace
{
/// When a file was written, as 20261122-064405 (UTC).
std::string timeOf(const std::string& file)
{
  struct stat status
  {
  };
  std::tm utc{};
  if (::stat(file.c_str(), &status) != 0 || !::gmtime_r(&status.st_mtime, &utc))
    return "unknown";
  char text[32];
  std::strftime(text, sizeof text, "%Y%m%d-%H%M%S", &utc);
  return text;
}

/// The name, or the name with a number where that is taken.
std::string freeName(const std::string& name)
{
  std::error_code error;
  std::string free = name;
  for (int n = 2; std::filesystem::exists(std::filesystem::symlink_status(free, error)); ++n)
    free = fmt::format("{}-{}", name, n);
  return free;
}
/// FNV-1a of some bytes that follow others.
std::uint64_t hashOf(const char* bytes, std::size_t count, std::uint64_t hash)
{
  for (std::size_t i = 0; i < count; ++i)
    hash = (hash ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3;
  return hash;
}

/// Of the first bytes of a file; 0 when it has fewer.
std::uint64_t hashOfFile(const std::string& file, std::uint64_t bytes)
{
  std::ifstream stream(file, std::ios::binary);
  std::vector<char> buffer(1 << 16);
  std::uint64_t hash = hashOfNothing;
  while (bytes > 0)
  {
    const auto next = std::min<std::uint64_t>(bytes, buffer.size());
    if (!stream.read(buffer.data(), std::streamsize(next)))
      return 0;
    hash = hashOf(buffer.data(), std::size_t(next), hash);
    bytes -= next;
  }
  return hash;
}
} // namespace

std::string nameAside(const std::string& file)
{
  return freeName(fmt::format("{}.old-{}", file, timeOf(file)));
}

void putForeignFileAside(const std::string& file)
{
  const std::string aside = nameAside(file);
  std::error_code error;
  std::filesystem::rename(file, aside, error);
  errno = error.value();
  if (error)
    failToWrite(file);
  logWarning(
      "a file is put aside",
      fmt::format("{}: there was a file of this name that does not hold what this run wrote; "
                  "it is called {} now.",
                  file, aside));
}

void failToWrite(const std::string& file)
{
  const std::string reason = errno != 0 ? std::strerror(errno) : "unknown reason";
  fail(ExitCode::Output,
       "{}: the file cannot be written: {}. Check that the folder '{}' exists and can be written "
       "to, and that there is room (disk, quota, file-size limit).",
       file, reason, folderOf(file));
}

std::string TextPosition::text() const
{
  return fmt::format("{} {} {} {}", cycle, bytes, contents, file);
}

TextPosition TextPosition::from(const std::string& text)
{
  TextPosition position;
  std::istringstream stream(text);
  stream >> position.cycle >> position.bytes >> position.contents;
  stream.ignore(1);
  std::getline(stream, position.file);
  return position;
}

bool TextTable::open(const std::string& file, const std::optional<TextPosition>& position)
{
  file_ = file;
  bytes_ = 0;
  contents_ = hashOfNothing;
  bool goesOn = false;
  if (position)
  {
    std::error_code ignored;
    goesOn = position->file == file && std::filesystem::exists(file, ignored) &&
             hashOfFile(file, position->bytes) == position->contents;
    if (goesOn)
    {
      std::error_code error;
      std::filesystem::resize_file(file, position->bytes, error);
      errno = error.value();
      if (error)
        failToWrite(file);
      bytes_ = position->bytes;
      contents_ = position->contents;
    }
    else
    {
      if (position->bytes > 0 && position->file == file)
        logWarning(
            "a table cannot be continued",
            fmt::format("{}: lines that were written before the checkpoint are not there, or "
                        "have been changed; the file begins anew with the restart.",
                        file));
      std::error_code error;
      if (std::filesystem::is_regular_file(file, error) &&
          std::filesystem::file_size(file, error) > 0)
        putForeignFileAside(placeOfFile(file)); // links stay links
    }
  }
  errno = 0;
  if (!goesOn && !std::ofstream(file, std::ios::trunc))
    failToWrite(file);
  // Always at the end of what is there: a file that somebody cuts off gets no hole.
  stream_.open(file, std::ios::app);
  if (!stream_)
    failToWrite(file);
  return bytes_ > 0;
}

void TextTable::add(const std::string& lines)
{
  errno = 0;
  stream_ << lines << std::flush;
  if (!stream_)
    failToWrite(file_);
  bytes_ += lines.size();
  contents_ = hashOf(lines.data(), lines.size(), contents_);
}

TextPosition TextTable::position(std::int64_t cycle) const
{
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file_, error);
  if (error)
    fail(ExitCode::Output,
         "{}: lines of this run are not there any more: {}. A restart could not go on with them. "
         "What is written to a file that was removed or moved away is lost.",
         file_, error.message());
  if (bytes < bytes_)
    logWarning("lines of a table are lost",
               fmt::format("{}: {} bytes of {} are there: somebody has cut off lines of this run; "
                           "it goes on at the end of what is there.",
                           file_, bytes, bytes_));
  return {file_, bytes, cycle, contents_};
}

void replaceFile(const std::string& file, const std::string& text)
{
  const std::string draft = file + ".part";
  std::remove(draft.c_str()); // a link would be followed
  errno = 0;
  std::FILE* stream = std::fopen(draft.c_str(), "wb");
  if (!stream)
    failToWrite(file);
  const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  const int reason = errno;
  if (std::fclose(stream) != 0 || !written || std::rename(draft.c_str(), file.c_str()) != 0)
  {
    if (!written)
      errno = reason;
    const int keep = errno;
    std::remove(draft.c_str());
    errno = keep;
    failToWrite(file);
  }
}
} // namespace coplane
