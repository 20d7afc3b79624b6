#include <coplane_core/DraftName.hpp>
#include <coplane_core/Error.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_core/TextFile.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <filesystem>
#include <sstream>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>
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
  if (::lstat(file.c_str(), &status) != 0 || !::gmtime_r(&status.st_mtime, &utc))
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

bool endsWithLine(const std::string& file)
{
  std::ifstream stream(file, std::ios::binary);
  char last = 0;
  return stream.seekg(-1, std::ios::end) && stream.get(last) && last == '\n';
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

void putForeignFileAside(const std::string& file, const std::string& now)
{
  const std::string& name = now.empty() ? file : now;
  const std::string aside = freeName(fmt::format("{}.old-{}", file, timeOf(name)));
  std::error_code error;
  std::filesystem::rename(name, aside, error);
  if (error == std::errc::no_such_file_or_directory && !isThere(name))
    return; // gone meanwhile
  if (error)
    fail(ExitCode::Output,
         "{}: there is already a file of this name, which this run did not write, and it cannot be "
         "renamed to {}: {}. Move it away, or give the output another name.",
         file, aside, error.message());
  logWarningEachTime(fmt::format(
      "{}: there was already a file of this name, which this run did not write or does not "
      "recognise; it is kept under the name {}.",
      file, aside));
}

ReplacedFile::Look ReplacedFile::lookAt(const std::string& file) const
{
  struct stat status
  {
  };
  return ::lstat(file.c_str(), &status) == 0 ? lookOf(status) : Look{};
}

ReplacedFile::Look ReplacedFile::lookOf(const struct ::stat& status) const
{
  const bool timed = edits_ == Edits::Matter;
  return {std::int64_t(status.st_dev), std::int64_t(status.st_ino), std::int64_t(status.st_size),
          timed ? std::int64_t(status.st_mtim.tv_sec) : 0,
          timed ? std::int64_t(status.st_mtim.tv_nsec) : 0};
}

void ReplacedFile::remember()
{
  left_ = lookAt(file_);
}

void ReplacedFile::remember(int descriptor)
{
  struct stat status
  {
  };
  left_ = ::fstat(descriptor, &status) == 0 ? lookOf(status) : Look{};
}

int ReplacedFile::take(const std::string& draft)
{
  const Look mine = lookAt(draft);
  const auto isLeft = [this](const std::string& name) { return lookAt(name) == left_; };
  const auto rename = [&](unsigned how)
  { return ::renameat2(AT_FDCWD, draft.c_str(), AT_FDCWD, file_.c_str(), how) == 0 ? 0 : errno; };
  int error = EEXIST;
  for (int tries = 0; tries < 100 && (error == EEXIST || error == ENOENT); ++tries)
  {
    makeWayNowFor(file_, isLeft);
    error = rename(RENAME_NOREPLACE);
    if (error != EEXIST)
      continue;
    // Both change names at once, so that nobody can come between looking at what is there and
    // replacing it. If somebody came before, both change back.
    error = rename(RENAME_EXCHANGE);
    if (error == 0 && !isLeft(draft))
      error = rename(RENAME_EXCHANGE) == 0 ? EEXIST : errno;
    else if (error == 0)
      std::remove(draft.c_str());
  }
  if (error == EINVAL || error == ENOSYS || error == EOPNOTSUPP) // a file system without that
    error = std::rename(draft.c_str(), file_.c_str()) == 0 ? 0 : errno;
  if (error == 0)
    left_ = mine;
  return error;
}

bool isSameName(const std::string& a, const std::string& b)
{
  return a == b || (!a.empty() && !b.empty() && placeOfFile(a) == placeOfFile(b));
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

bool TextTable::open(const std::string& file, const std::string& header,
                     const std::optional<TextPosition>& position)
{
  file_ = file;
  header_ = header;
  firstLine_.clear();
  bytes_ = 0;
  contents_ = hashOfNothing;
  bool goesOn = false;
  if (position)
  {
    std::error_code ignored;
    goesOn = isSameName(position->file, file) && std::filesystem::exists(file, ignored) &&
             hashOfFile(file, position->bytes) == position->contents;
    // Before its first line a table has nothing to be known by.
    if (goesOn && position->bytes == 0)
      goesOn = !wouldBeLost(placeOfFile(file)) || beginsWith(file, header);
    if (goesOn)
    {
      breakHardLinks(placeOfFile(file));
      std::error_code error;
      std::filesystem::resize_file(file, position->bytes, error);
      errno = error.value();
      if (error)
        failToWrite(file);
      bytes_ = position->bytes;
      contents_ = position->contents;
      if (bytes_ > 0 && std::getline(std::ifstream(file), firstLine_))
        firstLine_ += '\n';
    }
    else
    {
      if (position->bytes > 0 && isSameName(position->file, file))
        logWarningEachTime(
            fmt::format("{}: lines that were written before the checkpoint are not there, or "
                        "have been changed; the file begins anew with the restart.",
                        file));
    }
  }
  if (!goesOn)
  {
    const std::string place = placeOfFile(file); // links stay links
    makeWayFor(place,
               [&](const std::string& there) { return !position && beginsWith(there, header); });
    std::remove(place.c_str()); // hard links of it stay what they are
  }
  errno = 0;
  if (!goesOn && !std::ofstream(file, std::ios::trunc))
    failToWrite(file);
  openAtEnd();
  return bytes_ > 0;
}

void TextTable::openAtEnd()
{
  // Always at the end of what is there: a file that somebody cuts off gets no hole.
  stream_.open(file_, std::ios::app);
  struct stat status
  {
  };
  if (!stream_ || ::stat(file_.c_str(), &status) != 0)
    failToWrite(file_);
  opened_ = {status.st_dev, status.st_ino};
}

bool TextTable::isInPlace() const
{
  struct stat status
  {
  };
  if (::stat(file_.c_str(), &status) == 0)
    return opened_ == std::pair<std::uint64_t, std::uint64_t>(status.st_dev, status.st_ino);
  // A whole folder may be away for a moment: the file that is open goes on.
  std::error_code error;
  return errno != ENOENT || !std::filesystem::is_directory(folderOf(file_), error);
}

void TextTable::openAgain()
{
  stream_.close();
  const auto isOwn = [&](const std::string& there) { return beginsWith(there, header_); };
  // A link that was not there before leads to what is not this run's.
  std::error_code none;
  if (std::filesystem::is_symlink(file_, none))
    makeWayNowFor(file_, isOwn);
  const std::string place = placeOfFile(file_);
  makeWayNowFor(place, isOwn);
  breakHardLinks(place);
  openAtEnd();
  std::error_code error;
  const auto there = std::filesystem::file_size(file_, error);
  logWarningEachTime(
      there > 0 ? fmt::format("{}: somebody has replaced the file while the run writes it, as "
                              "editors do: the run goes on at the end of what is there now.",
                              file_)
                : fmt::format("{}: somebody has removed or moved the file while the run writes it: "
                              "the run goes on in a new one.",
                              file_));
  if (there == 0)
    stream_ << firstLine_ << std::flush;
  else if (!endsWithLine(file_))
    stream_ << "\n" << std::flush;
  bytes_ = error ? 0 : std::filesystem::file_size(file_, error);
  contents_ = hashOfFile(file_, bytes_);
}

void TextTable::add(const std::string& lines)
{
  if (!isInPlace())
    openAgain();
  if (firstLine_.empty())
    firstLine_ = lines.substr(0, lines.find('\n') + 1);
  errno = failure_;
  if (stream_)
  {
    errno = 0;
    stream_ << lines << std::flush;
    failure_ = errno;
  }
  if (!stream_)
    failToWrite(file_);
  bytes_ += lines.size();
  contents_ = hashOf(lines.data(), lines.size(), contents_);
}

TextPosition TextTable::position(std::int64_t cycle) const
{
  if (!isInPlace())
  {
    logWarningEachTime(fmt::format("{}: somebody has removed, moved or replaced the file: a "
                                   "restart from this checkpoint begins it anew.",
                                   file_));
    return {file_, bytes_, cycle, contents_};
  }
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file_, error);
  if (!error && bytes < bytes_)
    logWarning("lines of a table are lost",
               fmt::format("{}: the file is shorter than what this run wrote ({} of {} bytes): "
                           "somebody has cut it off. The run goes on at its end.",
                           file_, bytes, bytes_));
  // A checkpoint must not know lines that a loss of power takes.
  if (const int descriptor = ::open(file_.c_str(), O_RDONLY | O_CLOEXEC); descriptor >= 0)
  {
    ::fsync(descriptor);
    ::close(descriptor);
  }
  return {file_, error ? bytes_ : bytes, cycle, contents_};
}

bool isPlainFile(const std::string& file)
{
  std::error_code error;
  return std::filesystem::is_regular_file(std::filesystem::symlink_status(file, error));
}

bool isThere(const std::string& file)
{
  std::error_code error;
  return std::filesystem::exists(std::filesystem::symlink_status(file, error));
}

bool wouldBeLost(const std::string& file)
{
  std::error_code error;
  if (!isPlainFile(file))
    return isThere(file);
  return std::filesystem::file_size(file, error) > 0 && !error;
}

void breakHardLinks(const std::string& file)
{
  std::error_code error;
  if (!isPlainFile(file) || std::filesystem::hard_link_count(file, error) < 2 || error)
    return;
  const std::string draft = draftOf(file);
  std::filesystem::copy_file(file, draft, error);
  if (!error)
    std::filesystem::rename(draft, file, error);
  if (!error)
    return;
  errno = error.value();
  std::error_code ignored;
  std::filesystem::remove(draft, ignored);
  errno = error.value();
  failToWrite(file);
}

bool beginsWith(const std::string& file, const std::string& text)
{
  if (!isPlainFile(placeOfFile(file)))
    return false; // opening a pipe would wait
  std::string there(text.size(), '\0');
  std::ifstream stream(file, std::ios::binary);
  return stream.read(there.data(), std::streamsize(there.size())) && there == text;
}

TextDraft::TextDraft(const std::string& file) : file_(file), draft_(draftOf(file))
{
  errno = 0;
  stream_ = std::fopen(draft_.c_str(), "wb");
  if (!stream_)
    failToWrite(file_);
}

TextDraft::~TextDraft()
{
  if (stream_)
    std::fclose(stream_);
  std::remove(draft_.c_str()); // not there any more when it has its name
}

void TextDraft::giveUp()
{
  const int reason = errno;
  if (stream_)
    std::fclose(stream_);
  stream_ = nullptr;
  std::remove(draft_.c_str());
  errno = reason;
  failToWrite(file_);
}

void TextDraft::add(const std::string& text)
{
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stream_) != text.size())
    giveUp();
}

void TextDraft::close()
{
  errno = 0;
  // EINVAL: a file system without disk.
  if (std::fflush(stream_) != 0 || (::fsync(::fileno(stream_)) != 0 && errno != EINVAL) ||
      std::fclose(std::exchange(stream_, nullptr)) != 0)
    giveUp();
}

void TextDraft::finish()
{
  if (stream_)
    close();
  errno = 0;
  if (std::rename(draft_.c_str(), file_.c_str()) != 0)
    giveUp();
}

void replaceFile(const std::string& file, const std::string& text)
{
  TextDraft draft(file);
  draft.add(text);
  draft.finish();
}

void ReplacedFile::replace(const std::string& text)
{
  TextDraft draft(file_);
  draft.add(text);
  draft.close();
  if (const int error = take(draftOf(file_)); error != 0)
  {
    errno = error;
    failToWrite(file_);
  }
}
} // namespace coplane
