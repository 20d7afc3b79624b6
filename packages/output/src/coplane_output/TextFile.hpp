#pragma once

#include <cstdint>
#include <fstream>
#include <string>

namespace coplane
{
/// Replaces a file as a whole: written beside it and renamed, so that whoever reads it sees the old
/// or the new text and a killed program leaves no half. Throws Error(ExitCode::Output) with file
/// and reason; call it on one rank, within Comm::together.
void replaceFile(const std::string& file, const std::string& text);

/// A free name for a file that is put aside: with the time of its last change.
std::string nameAside(const std::string& file);

/// Renames a file that may be of somebody else, as no output of a run is what it holds, and warns
/// of it. Throws Error(ExitCode::Output) when that fails; on one rank, within Comm::together.
void putForeignFileAside(const std::string& file);

/// Where a table of text ended when a checkpoint was written.
struct TextPosition
{
  std::string file;
  std::uint64_t bytes = 0;
  std::int64_t cycle = -1; ///< of the last line

  std::string text() const; ///< one line
  /// Empty text: a file that does not exist yet.
  static TextPosition from(const std::string& text);
};

/// A table of text that grows by lines and can be cut back to where it ended at a checkpoint. On
/// one rank, within Comm::together. Errors are Error(ExitCode::Output).
class TextTable
{
public:
  /// Opens it for more lines and cuts off those after the position. Returns whether it has been
  /// continued; otherwise (another name, nothing to continue) it is new and empty, and a warning
  /// says so where lines are missing. A restart under another name puts a file aside that has it,
  /// as it may be of somebody else.
  bool open(const std::string& file, const TextPosition& position);
  bool isOpen() const { return stream_.is_open(); }
  /// Writes whole lines to the end of what is there.
  void add(const std::string& lines);
  /// Where it ends, after a cycle. Throws when the file is gone; warns when somebody cut it off.
  TextPosition position(std::int64_t cycle) const;

private:
  std::string file_;
  std::ofstream stream_;
  std::uint64_t bytes_ = 0; ///< that it has to have
};

/// Throws Error(ExitCode::Output): the file, what the system says (errno) and what to check.
[[noreturn]] void failToWrite(const std::string& file);
} // namespace coplane
