#pragma once

#include <set>
#include <string>
#include <vector>

namespace coplane
{
/// What a path leads to when that is neither a plain file nor nothing: "a folder", "a pipe", ...
/// Empty otherwise.
std::string kindOfSpecialFile(const std::string& file);

/// Absolute name of the folder that a file is in; "." where that cannot be told, as when the
/// working folder has gone. Throws nothing.
std::string folderOf(const std::string& file);

/// Where a file is or would be: symbolic links are followed, also one to something that is missing.
std::string placeOfFile(const std::string& file);

/// The files that a program reads and those that it writes: the one place that knows whether they
/// are distinct. Two names mean the same file when they lead to one place (relative parts, symbolic
/// links, also of folders, also to something that is not there yet) or to one inode (hard links).
class FileRoles
{
public:
  /// @param what how messages call it, with the key or option that names it: "the mesh (mesh)"
  void reads(const std::string& file, const std::string& what);
  /// Names with numbers, as with writesSeries.
  void readsSeries(const std::vector<std::string>& pieces, const std::string& what);
  void writes(const std::string& file, const std::string& what);
  /// The same of a file that is opened where it is; others are renamed over or removed, which takes
  /// no more than its folder.
  void writesInPlace(const std::string& file, const std::string& what);
  /// Files whose names have numbers between these pieces: {"wall.e-s", ""} is wall.e-s0002, ...
  void writesSeries(const std::vector<std::string>& pieces, const std::string& what);

  /// A sentence for each output that is an input, another output, or something that is not a plain
  /// file, and for the first whose name holds control characters. Empty: all may be written. Looks
  /// at the file system, changes nothing.
  std::vector<std::string> problems() const;
  /// A sentence for each output that cannot be written, by permissions of its folder or, in place,
  /// its own, or because it is on a file system that is read only. Opens what is written in place,
  /// and changes nothing: to be asked before the first output of an earlier run is replaced.
  std::vector<std::string> hindrances() const;

  /// What an output is called until it is whole: names as with writesSeries.
  void writesDraft(const std::vector<std::string>& pieces, const std::string& what);
  /// Takes over the files of others.
  void add(const FileRoles& others);
  /// Drafts of these names that are there, in other folders than the roles say: a lock may come
  /// from a copy of a folder, in which somebody else goes on.
  std::vector<std::string> draftsIn(const std::set<std::string>& folders) const;
  /// Folders of the outputs.
  std::set<std::string> folders() const;
  /// The outputs as lines of text, for other processes; read by outputsIn, which leaves out what it
  /// does not understand.
  std::string outputsText() const;
  static FileRoles outputsIn(const std::string& text);
  /// A sentence for each output that is one of the others' too.
  std::vector<std::string> problemsWith(const FileRoles& others) const;

private:
  struct Role
  {
    std::vector<std::string> pieces; ///< one: a single file
    std::string what;
    bool isOutput;
    bool inPlace = false, isDraft = false;
  };
  std::vector<Role> roles_;
};
} // namespace coplane
