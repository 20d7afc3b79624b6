#include <coplane_core/Error.hpp>
#include <coplane_core/FileLock.hpp>
#include <coplane_core/FileRoles.hpp>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace coplane
{
namespace
{
constexpr const char* beginning = "process ";

std::string thisHost()
{
  char host[256] = "unknown host";
  ::gethostname(host, sizeof host - 1);
  return host;
}

std::string me()
{
  char date[64];
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  std::strftime(date, sizeof date, "%Y-%m-%d %H:%M:%S UTC", &utc);
  return fmt::format("{}{} on {}, since {}\n", beginning, ::getpid(), thisHost(), date);
}

constexpr std::size_t longestText = 1 << 20;

std::string textIn(int descriptor)
{
  std::string text(longestText, '\0');
  const ssize_t length = ::pread(descriptor, text.data(), text.size(), 0);
  text.resize(length > 0 ? std::size_t(length) : 0);
  return text;
}

std::string ownerIn(int descriptor)
{
  const std::string text = textIn(descriptor);
  return text.empty() ? "an unknown process" : text.substr(0, text.find('\n'));
}

/// Whether a text is what a lock says: "process 123 on ...".
bool isOfLock(const std::string& text)
{
  const std::size_t first = std::strlen(beginning);
  const std::size_t end = text.find_first_not_of("0123456789", first);
  return text.rfind(beginning, 0) == 0 && end > first && end != std::string::npos &&
         text.compare(end, 4, " on ") == 0;
}

/// What a killed owner left, unless it was on another machine: on some file systems that one may
/// live and hold its lock there.
std::string leftIn(int descriptor)
{
  const std::string text = textIn(descriptor);
  const bool isOfThisHost =
      text.substr(0, text.find('\n')).find(fmt::format(" on {},", thisHost())) != std::string::npos;
  return isOfThisHost ? text : "";
}

/// Whether the path still leads to the file that is open: its owner may just have removed it.
bool isStillThere(const std::string& file, int descriptor)
{
  struct stat open
  {
  };
  struct stat there
  {
  };
  return ::fstat(descriptor, &open) == 0 && ::stat(file.c_str(), &there) == 0 &&
         open.st_dev == there.st_dev && open.st_ino == there.st_ino;
}
struct LockFile
{
  int descriptor = -1;
  bool isOfOtherUser = false; ///< open for reading only
};

LockFile openLock(const std::string& file, const std::string& what)
{
  LockFile lock;
  lock.descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (lock.descriptor < 0 && errno == EACCES)
  {
    lock.descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    lock.isOfOtherUser = lock.descriptor >= 0;
    errno = EACCES;
  }
  if (lock.descriptor >= 0)
    return lock;
  if (errno == ELOOP)
    fail(ExitCode::Output,
         "{}: this is the name of the lock file of {}, but a link has that name. Nothing was "
         "written. Move the link away, or give the outputs other names.",
         file, what);
  const std::string reason = std::strerror(errno);
  fail(ExitCode::Output,
       "{}: the lock file of {} cannot be created or opened: {}. Check that the folder '{}' exists "
       "and can be written to, and that the file does not belong to another user.",
       file, what, reason, folderOf(file));
}

enum class Turn
{
  Mine,
  Again,  ///< the file is closed: open it once more
  NoLocks ///< there are none on this file system; the file is closed
};

/// Takes the lock. @param tries how often somebody else had it
Turn take(const LockFile& lock, const std::string& file, const std::string& what, int& tries)
{
  const bool isTaken = ::flock(lock.descriptor, LOCK_EX | LOCK_NB) == 0;
  const int reason = errno;
  if (isTaken && isStillThere(file, lock.descriptor))
    return Turn::Mine;
  const std::string owner = isTaken ? "" : ownerIn(lock.descriptor);
  ::close(lock.descriptor);
  if (isTaken || reason == EINTR)
    return Turn::Again;
  if (reason == EWOULDBLOCK && ++tries < 20) // somebody may just look whether it is held
  {
    ::usleep(25000);
    return Turn::Again;
  }
  if (reason == EWOULDBLOCK)
    fail(ExitCode::Output,
         "{}: another run writes {}: {}. Wait for it or end it, or give this run another folder, "
         "or its outputs other names. Nothing was written.",
         file, what, owner);
  if (lock.isOfOtherUser)
    fail(ExitCode::Output,
         "{}: the lock file of {} belongs to another user, and it is not known whether a program "
         "holds it: {}. Ask its owner to remove it, or give the outputs other names.",
         file, what, std::strerror(reason));
  struct stat made
  {
  };
  if (::stat(file.c_str(), &made) == 0 && made.st_size == 0)
    ::unlink(file.c_str());
  return Turn::NoLocks;
}

/// Throws when the file that is locked holds something else. Returns whether it is a copy by links
/// of what a killed run left, or what another user's killed run left.
bool isLeft(const LockFile& lock, const std::string& file, const std::string& what)
{
  struct stat there
  {
  };
  const bool isKnown = ::fstat(lock.descriptor, &there) == 0;
  if (isKnown && there.st_size > 0 && !isOfLock(textIn(lock.descriptor)))
  {
    ::close(lock.descriptor);
    fail(ExitCode::Output,
         "{}: this is the name of the lock file of {}, but the file with that name is not a lock. "
         "Nothing was written. Move it away, or give the outputs other names.",
         file, what);
  }
  return (isKnown && there.st_nlink > 1) || lock.isOfOtherUser;
}

/// Removes what a killed run left, and closes it.
void removeLeft(const LockFile& lock, const std::string& file)
{
  const bool isRemoved = ::unlink(file.c_str()) == 0;
  const std::string reason = std::strerror(errno);
  ::close(lock.descriptor);
  if (!isRemoved)
    fail(ExitCode::Output,
         "{}: this lock was left by a run that has ended, and cannot be removed: {}. Ask the "
         "owner of the file to remove it, or give the outputs other names.",
         file, reason);
}
} // namespace

FileLock::FileLock(const std::string& file, const std::string& what, const std::string& told)
    : file_(file)
{
  for (int tries = 0;;)
  {
    const LockFile lock = openLock(file, what);
    const Turn turn = take(lock, file, what, tries);
    if (turn == Turn::Again)
      continue;
    if (turn == Turn::NoLocks)
      return;
    if (isLeft(lock, file, what))
    {
      textFound_ = leftIn(lock.descriptor); // names drafts that were left
      removeLeft(lock, file);
      continue;
    }
    descriptor_ = lock.descriptor;
    textFound_ += leftIn(descriptor_);
    const std::string text = me() + told;
    // Not being able to say who holds it does not make the lock less of one. Other machines see
    // the text only when it is on the disk.
    if (::ftruncate(descriptor_, 0) == 0 && ::pwrite(descriptor_, text.data(), text.size(), 0) > 0)
      ::fsync(descriptor_);
    return;
  }
}

std::string FileLock::textOfHolder(const std::string& file)
{
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0)
    return "";
  std::string text = textIn(descriptor);
  if (!isOfLock(text) || ::flock(descriptor, LOCK_SH | LOCK_NB) == 0 || errno != EWOULDBLOCK)
    text.clear();
  ::close(descriptor);
  return text;
}

FileLock::~FileLock()
{
  if (descriptor_ < 0)
    return;
  // While it is held nobody can have taken it; but somebody may have removed it and made another.
  if (isStillThere(file_, descriptor_))
    ::unlink(file_.c_str());
  ::close(descriptor_);
}

FileLock::FileLock(FileLock&& other) noexcept
    : file_(std::move(other.file_)), textFound_(std::move(other.textFound_)),
      descriptor_(std::exchange(other.descriptor_, -1))
{
}
} // namespace coplane
