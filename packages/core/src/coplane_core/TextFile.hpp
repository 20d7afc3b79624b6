#pragma once

#include <coplane_core/FileRoles.hpp>

#include <array>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <sys/stat.h>
#include <utility>

namespace coplane
{
/// Replaces a file as a whole: written beside it and renamed, so that whoever reads it sees the old
/// or the new text and a killed program leaves no half. Throws Error(ExitCode::Output) with file
/// and reason; call it on one rank, within Comm::together.
void replaceFile(const std::string& file, const std::string& text);

/// Whether something of this name is there, but for a plain file that is empty.
bool wouldBeLost(const std::string& file);
bool isPlainFile(const std::string& file); ///< and no link to one
bool isThere(const std::string& file);     ///< anything, also a link to nothing

/// A free name for a file that is put aside: with the time of its last change.
std::string nameAside(const std::string& file);

/// Renames a file that may be of somebody else, as it does not hold what is written under its name,
/// and warns of it. Throws Error(ExitCode::Output) when that fails; on one rank, within
/// Comm::together.
/// @param now what it is called at the moment; empty: `file`
void putForeignFileAside(const std::string& file, const std::string& now = "");

/// The same unless nothing is lost with the file: nothing of the name is there, or a plain file
/// that is empty or `isOwn(file)`, written as what takes its place now. Links are no plain files;
/// outputs that are written through them pass placeOfFile(file).
template <class IsOwn>
void makeWayFor(const std::string& file, const IsOwn& isOwn)
{
  if (wouldBeLost(file) && !isOwn(file))
    putForeignFileAside(file);
}

/// The same while a run writes: somebody may only have begun to write into a file that is empty.
template <class IsOwn>
void makeWayNowFor(const std::string& file, const IsOwn& isOwn)
{
  if (isThere(file) && !isOwn(file))
    putForeignFileAside(file);
}

/// A name whose file a program replaces again and again: between two times somebody may give the
/// name to a file of theirs, or change what is in it. On one rank, within Comm::together.
class ReplacedFile
{
public:
  /// Whether a file with another time of its last change is another one: not where only its name
  /// can mean that somebody has changed it.
  enum class Edits
  {
    Matter,
    DoNot
  };
  /// @param file the place where it is
  explicit ReplacedFile(std::string file, Edits edits = Edits::Matter)
      : file_(std::move(file)), edits_(edits)
  {
  }
  const std::string& file() const { return file_; }
  /// What has the name now is what this program left there, or found and may replace.
  void remember();
  /// What this program has open, and has just written, is what it left: whatever has the name now.
  void remember(int descriptor);
  bool isAsLeft() const { return lookAt(file_) == left_; }
  /// The draft, which is whole, takes its place. What has the name and is not as it was left is put
  /// aside, as by putForeignFileAside, also when it came there this very moment. Returns errno, 0:
  /// it is done.
  int take(const std::string& draft);
  /// The same with a new text. Throws as replaceFile().
  void replace(const std::string& text);

private:
  using Look = std::array<std::int64_t, 5>; ///< device, inode, bytes, time of the last change
  Look lookAt(const std::string& file) const;
  Look lookOf(const struct ::stat& status) const;

  std::string file_;
  Edits edits_;
  Look left_{}; ///< zeros: nothing is there
};

/// Whether two names lead to one place, as "./run.e" and "run.e".
bool isSameName(const std::string& a, const std::string& b);

/// Whether a file begins with this text: its header, by which tables are known.
bool beginsWith(const std::string& file, const std::string& text);

/// A file under the name of its draft until it is whole. Errors as of replaceFile. Where the file
/// is a link, it is the link that is replaced: pass placeOfFile(file) otherwise.
class TextDraft
{
public:
  explicit TextDraft(const std::string& file);
  ~TextDraft(); ///< removes what was not finished
  TextDraft(const TextDraft&) = delete;
  TextDraft& operator=(const TextDraft&) = delete;

  void add(const std::string& text);
  void close(); ///< now it is whole
  /// The draft takes the place of the file.
  void finish();

private:
  [[noreturn]] void giveUp();

  std::string file_, draft_;
  std::FILE* stream_;
};

constexpr std::uint64_t hashOfNothing = 0xcbf29ce484222325;

/// Where a table of text ended when a checkpoint was written.
struct TextPosition
{
  std::string file;
  std::uint64_t bytes = 0;
  std::int64_t cycle = -1;    ///< of the last line
  std::uint64_t contents = 0; ///< hash of these bytes

  std::string text() const; ///< one line
  /// Empty text: a file that does not exist yet.
  static TextPosition from(const std::string& text);
};

/// Hard links of a file are the user's: copies that shall not change with it. Gives the name a file
/// of its own.
void breakHardLinks(const std::string& file);

/// A table of text that grows by lines and can be cut back to where it ended at a checkpoint. On
/// one rank, within Comm::together. Errors are Error(ExitCode::Output).
class TextTable
{
public:
  /// Opens a new table, or that of the run that goes on: then lines after the position are cut off,
  /// if those before it are the bytes that were written. If not, or if the run did not write to
  /// this file, what is there is put aside, and a warning says so. Returns whether the table goes
  /// on; otherwise it is empty.
  /// @param header what such a table begins with; a new one takes the place of no other file
  /// @param position of a restart: where the table ended, or TextPosition{} if it was not written
  bool open(const std::string& file, const std::string& header,
            const std::optional<TextPosition>& position);
  bool isOpen() const { return stream_.is_open(); }
  /// Writes whole lines to the end of what is there. Where somebody has removed the file, or put
  /// another in its place (editors do), it goes on in the one that has the name now, or in a new
  /// one, with a warning.
  void add(const std::string& lines);
  /// Where it ends, after a cycle; brings it to the disk. Warns when somebody cut it off, or took
  /// it away.
  TextPosition position(std::int64_t cycle) const;

private:
  bool isInPlace() const; ///< the name still leads to the file that is open
  void openAgain();
  void openAtEnd();

  std::string file_;
  std::string header_;    ///< what it begins with
  std::string firstLine_; ///< whole
  std::ofstream stream_;
  int failure_ = 0;                                ///< errno of a write that failed
  std::pair<std::uint64_t, std::uint64_t> opened_; ///< device and inode
  std::uint64_t bytes_ = 0;                        ///< that it has to have
  std::uint64_t contents_ = hashOfNothing;         ///< of these bytes
};

/// Throws Error(ExitCode::Output): the file, what the system says (errno) and what to check.
[[noreturn]] void failToWrite(const std::string& file);
} // namespace coplane
