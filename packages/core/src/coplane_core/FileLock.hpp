#pragma once

#include <string>

namespace coplane
{
/// A file that this process alone holds for as long as it lives: the lock goes with its owner,
/// however that ends, and what a killed one leaves behind holds nobody up. The file names its
/// owner.
class FileLock
{
public:
  /// Throws Error(ExitCode::Output) with host, process and time of the owner when another process
  /// has it, also half a second later, and when the file is no lock. On a file system without locks
  /// it is taken as free; isHeld() then is false.
  /// @param what for the message: "the outputs of wall.yaml"
  /// @param told for others to read while the lock is held; a line with the owner goes before it
  FileLock(const std::string& file, const std::string& what, const std::string& told = "");
  /// What an owner that was killed on this machine had left in the file; empty: nothing.
  const std::string& textFound() const { return textFound_; }
  /// Removes the file.
  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&&) = delete;
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  bool isHeld() const { return descriptor_ >= 0; }
  /// What somebody wrote who holds this lock now; empty: nobody does.
  static std::string textOfHolder(const std::string& file);

private:
  std::string file_, textFound_;
  int descriptor_ = -1;
};
} // namespace coplane
