#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

namespace coplane
{
/// Replaces a file as a whole: written beside it and renamed, so that whoever reads it sees the old
/// or the new text and a killed program leaves no half. Throws Error(ExitCode::Output) with file
/// and reason; call it on one rank, within Comm::together.
void replaceFile(const std::string& file, const std::string& text);

/// A free name for a file that is put aside: with the time of its last change.
std::string nameAside(const std::string& file);

/// Renames a file that may be of somebody else, as it does not hold what this run wrote, and warns
/// of it. Throws Error(ExitCode::Output) when that fails; on one rank, within Comm::together.
void putForeignFileAside(const std::string& file);

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

/// A table of text that grows by lines and can be cut back to where it ended at a checkpoint. On
/// one rank, within Comm::together. Errors are Error(ExitCode::Output).
class TextTable
{
public:
  /// Opens a new table, or that of the run that goes on: then lines after the position are cut off,
  /// if those before it are the bytes that were written. If not, or if the run did not write to
  /// this file, what is there is put aside, and a warning says so. Returns whether the table goes
  /// on; otherwise it is empty.
  /// @param position of a restart: where the table ended, or TextPosition{} if it was not written
  bool open(const std::string& file, const std::optional<TextPosition>& position);
  bool isOpen() const { return stream_.is_open(); }
  /// Writes whole lines to the end of what is there.
  void add(const std::string& lines);
  /// Where it ends, after a cycle. Throws when the file is gone; warns when somebody cut it off.
  TextPosition position(std::int64_t cycle) const;

private:
  std::string file_;
  std::ofstream stream_;
  std::uint64_t bytes_ = 0;                ///< that it has to have
  std::uint64_t contents_ = hashOfNothing; ///< of these bytes
};

/// Throws Error(ExitCode::Output): the file, what the system says (errno) and what to check.
[[noreturn]] void failToWrite(const std::string& file);
} // namespace coplane
