#include <coplane_core/FileRoles.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <map>
#include <set>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace coplane
{
namespace
{
namespace fs = std::filesystem;
using Inode = std::pair<dev_t, ino_t>;

constexpr int longestChainOfLinks = 40;
constexpr const char* draft = "a draft"; // in the text of locks

/// Where a file is or would be: symbolic links are followed, also one to something that is missing.
fs::path placeOf(const fs::path& name)
{
  std::error_code error;
  fs::path place = fs::absolute(name, error);
  for (int links = 0; links < longestChainOfLinks && fs::is_symlink(place, error); ++links)
  {
    const fs::path target = fs::read_symlink(place, error);
    place = target.is_absolute() ? target : place.parent_path() / target;
  }
  const fs::path folder = fs::weakly_canonical(place.parent_path(), error);
  return (error ? place.parent_path().lexically_normal() : folder) / place.filename();
}

bool inodeOf(const fs::path& file, Inode& inode)
{
  struct stat status
  {
  };
  if (::stat(file.c_str(), &status) != 0)
    return false;
  inode = {status.st_dev, status.st_ino};
  return true;
}

/// What a name leads to, held: as long as this lives, no other file is given its inode.
class Held
{
public:
  explicit Held(const fs::path& file) : descriptor_(::open(file.c_str(), O_PATH | O_CLOEXEC)) {}
  ~Held()
  {
    if (descriptor_ >= 0)
      ::close(descriptor_);
  }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;

  bool isSameAs(const Held& other) const
  {
    struct stat mine
    {
    };
    struct stat its
    {
    };
    return ::fstat(descriptor_, &mine) == 0 && ::fstat(other.descriptor_, &its) == 0 &&
           mine.st_dev == its.st_dev && mine.st_ino == its.st_ino;
  }

private:
  int descriptor_;
};

/// Whether two names lead to one file, beside runs that replace their files too: there the inode of
/// a file that has just gone may become that of the next one made, and a file may be renamed.
bool leadToOneFile(const fs::path& a, const fs::path& b)
{
  const Held before(a), other(b), after(a);
  return before.isSameAs(other) && after.isSameAs(other);
}

/// Whether a name is of the series: numbers stand between the pieces.
bool matches(const std::string& name, const std::vector<std::string>& pieces)
{
  std::size_t at = 0;
  for (std::size_t p = 0; p < pieces.size(); ++p)
  {
    if (p > 0)
    {
      const std::size_t first = at;
      while (at < name.size() && std::isdigit(static_cast<unsigned char>(name[at])))
        ++at;
      if (at == first)
        return false;
    }
    if (name.compare(at, pieces[p].size(), pieces[p]) != 0)
      return false;
    at += pieces[p].size();
  }
  return at == name.size();
}

/// One output or input as the file system sees it.
struct Seen
{
  fs::path folder;
  std::vector<std::string> pieces;  ///< of the name without folder
  std::map<Inode, fs::path> inodes; ///< of what is there, with its name

  bool isSeries() const { return pieces.size() > 1; }
  std::vector<std::string> examples() const
  {
    if (!isSeries())
      return pieces;
    std::vector<std::string> names;
    for (const char* number : {"1", "0001"})
    {
      names.push_back(pieces[0]);
      for (std::size_t p = 1; p < pieces.size(); ++p)
        names.back() += number + pieces[p];
    }
    return names;
  }
};

Seen look(const std::vector<std::string>& pieces)
{
  Seen seen;
  seen.pieces = pieces;
  Inode inode;
  if (!seen.isSeries())
  {
    const fs::path place = placeOf(pieces[0]);
    seen.folder = place.parent_path();
    seen.pieces[0] = place.filename().string();
    if (inodeOf(place, inode))
      seen.inodes.emplace(inode, place);
    return seen;
  }
  const fs::path first = pieces[0];
  seen.pieces[0] = first.filename().string();
  seen.folder = placeOf(first).parent_path();
  std::error_code error;
  for (fs::directory_iterator entry(seen.folder, error), end; !error && entry != end;
       entry.increment(error))
    if (matches(entry->path().filename().string(), seen.pieces) && inodeOf(entry->path(), inode))
      seen.inodes.emplace(inode, entry->path());
  return seen;
}

bool meet(const Seen& a, const Seen& b)
{
  for (const auto& [inode, name] : a.inodes)
    if (const auto same = b.inodes.find(inode);
        same != b.inodes.end() && leadToOneFile(name, same->second))
      return true;
  if (a.folder != b.folder)
    return false;
  for (const std::string& name : a.examples())
    if (matches(name, b.pieces))
      return true;
  for (const std::string& name : b.examples())
    if (matches(name, a.pieces))
      return true;
  return false;
}

std::string nameOf(const std::vector<std::string>& pieces)
{
  return fmt::format("{}", fmt::join(pieces, "<number>"));
}

/// Bytes that a name may get at its end: ".old-20261122-064405-12", ".part-1f2e3d4c".
constexpr std::size_t mostBytesAtEnd = 23, mostBytesOfName = 255;

/// By how many bytes the name of an output is longer than file systems take, with its numbers and
/// what is added to it when it is put aside.
std::size_t bytesTooMany(const std::vector<std::string>& pieces)
{
  constexpr std::size_t digits = 4;
  std::size_t bytes = fs::path(pieces[0]).filename().string().size() + mostBytesAtEnd;
  for (std::size_t p = 1; p < pieces.size(); ++p)
    bytes += digits + pieces[p].size();
  return bytes > mostBytesOfName ? bytes - mostBytesOfName : 0;
}

bool isControlCharacter(unsigned char c)
{
  return c < 0x20 || c == 0x7f;
}

bool hasControlCharacter(const std::string& name)
{
  return std::any_of(name.begin(), name.end(), isControlCharacter);
}

std::string printable(std::string name)
{
  std::replace_if(name.begin(), name.end(), isControlCharacter, '?');
  return name;
}
} // namespace

std::string kindOfSpecialFile(const std::string& file)
{
  std::error_code error;
  switch (fs::status(file, error).type())
  {
  case fs::file_type::directory:
    return "a folder";
  case fs::file_type::character:
  case fs::file_type::block:
    return "a device";
  case fs::file_type::fifo:
    return "a pipe";
  case fs::file_type::socket:
    return "a socket";
  default:
    return "";
  }
}

std::string placeOfFile(const std::string& file)
{
  return placeOf(file).string();
}

std::string folderOf(const std::string& file)
{
  std::error_code error;
  const fs::path path = fs::absolute(file, error);
  return error ? "." : path.parent_path().string();
}

void FileRoles::reads(const std::string& file, const std::string& what)
{
  roles_.push_back({{file}, what, false});
}

void FileRoles::readsSeries(const std::vector<std::string>& pieces, const std::string& what)
{
  roles_.push_back({pieces, what, false});
}

void FileRoles::writes(const std::string& file, const std::string& what)
{
  roles_.push_back({{file}, what, true});
}

void FileRoles::writesInPlace(const std::string& file, const std::string& what)
{
  roles_.push_back({{file}, what, true, true});
}

void FileRoles::writesSeries(const std::vector<std::string>& pieces, const std::string& what)
{
  roles_.push_back({pieces, what, true});
}

std::vector<std::string> FileRoles::problems() const
{
  std::vector<std::string> problems;
  std::set<std::string> said; // the two sides of a sentence, each pair once
  std::vector<Seen> seen;
  for (const Role& role : roles_)
    seen.push_back(look(role.pieces));
  for (std::size_t i = 0; i < roles_.size(); ++i)
  {
    const Role& output = roles_[i];
    if (!output.isOutput)
      continue;
    if (hasControlCharacter(nameOf(output.pieces)))
    {
      if (said.insert("control").second)
        problems.push_back(
            fmt::format("{} '{}': names of outputs may not hold line breaks, tabs or "
                        "other control characters. Give it another name.",
                        output.what, printable(nameOf(output.pieces))));
      continue;
    }
    if (const std::size_t bytes = output.isDraft ? 0 : bytesTooMany(output.pieces); bytes > 0)
    {
      if (said.insert("long").second)
        problems.push_back(fmt::format(
            "{} '{}': the name is too long: it can have {} bytes in all, {} of them for "
            "what may be put aside. Make it shorter by {} bytes.",
            output.what, nameOf(output.pieces), mostBytesOfName, mostBytesAtEnd, bytes));
      continue;
    }
    if (output.pieces.size() == 1)
      if (const std::string kind = kindOfSpecialFile(output.pieces[0]); !kind.empty())
        problems.push_back(fmt::format(
            "{}: {} cannot be written there, because this is {}; accepted: a plain file, "
            "or a name that is not there yet.",
            output.pieces[0], output.what, kind));
    for (std::size_t k = 0; k < roles_.size(); ++k)
    {
      const Role& other = roles_[k];
      if (k == i || (other.isOutput && k < i) || !meet(seen[i], seen[k]))
        continue;
      if (!said.insert(output.what + "\n" + other.what).second)
        continue;
      problems.push_back(fmt::format(
          "{} '{}' would {} {} '{}': both names lead to the same file. Nothing was written. "
          "Give one of them another name.",
          output.what, nameOf(output.pieces), other.isOutput ? "be written over" : "overwrite",
          other.what, nameOf(other.pieces)));
    }
  }
  return problems;
}

namespace
{
/// errno of opening a file to write, which changes nothing; 0: it can be opened. EPERM: it is
/// immutable, and cannot be renamed over either.
int errorOfOpening(const fs::path& file)
{
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0)
    return errno;
  ::close(descriptor);
  return 0;
}

/// errno of renaming over a file, or removing it, as far as that can be told; 0: it can be.
int errorOfReplacing(const fs::path& file)
{
  struct stat mine
  {
  };
  struct stat folder
  {
  };
  if (::lstat(file.c_str(), &mine) == 0 && ::stat(file.parent_path().c_str(), &folder) == 0 &&
      (folder.st_mode & S_ISVTX) && ::geteuid() != 0 && mine.st_uid != ::geteuid() &&
      folder.st_uid != ::geteuid())
    return EPERM; // as in /tmp: of another user
  std::error_code ignored;
  return fs::is_regular_file(file, ignored) && errorOfOpening(file) == EPERM ? EPERM : 0;
}

std::string cannotBeReplaced(const fs::path& file, const std::string& what, int error)
{
  return fmt::format("{}: {} cannot replace this file: {}. Nothing was written. Move the file "
                     "away, make it writable, or give another name.",
                     file.string(), what, std::strerror(error));
}
} // namespace

std::vector<std::string> FileRoles::hindrances() const
{
  std::vector<std::string> hindrances;
  std::set<fs::path> folders;
  for (const Role& role : roles_)
  {
    if (!role.isOutput)
      continue;
    const fs::path place = placeOf(role.pieces[0]), folder = place.parent_path();
    if (folders.insert(folder).second && ::access(folder.c_str(), W_OK | X_OK) != 0)
      hindrances.push_back(fmt::format(
          "{}: {} cannot be written: {}. Nothing was written. Check that the folder '{}' exists "
          "and can be written to, or give another name.",
          nameOf(role.pieces), role.what, std::strerror(errno), folder.string()));
    if (!role.inPlace)
    {
      for (const auto& [inode, file] : look(role.pieces).inodes)
        if (const int error = errorOfReplacing(file); error != 0)
          hindrances.push_back(cannotBeReplaced(file, role.what, error));
      continue;
    }
    const int opening = errorOfOpening(place);
    const int error = opening != 0 && opening != ENOENT ? opening : errorOfReplacing(place);
    if (error != 0)
      hindrances.push_back(cannotBeReplaced(place, role.what, error));
  }
  return hindrances;
}

void FileRoles::writesDraft(const std::vector<std::string>& pieces, const std::string& what)
{
  roles_.push_back({pieces, what, true, false, true});
}

void FileRoles::add(const FileRoles& others)
{
  roles_.insert(roles_.end(), others.roles_.begin(), others.roles_.end());
}

std::vector<std::string> FileRoles::draftsIn(const std::set<std::string>& folders) const
{
  std::vector<std::vector<std::string>> drafts; // names in pieces, without folder
  for (const Role& role : roles_)
    if (role.isDraft)
    {
      drafts.push_back(role.pieces);
      drafts.back()[0] = fs::path(role.pieces[0]).filename().string();
    }
  std::vector<std::string> there;
  std::error_code error;
  for (const std::string& folder : folders)
    for (fs::directory_iterator entry(folder, error), none; !error && entry != none;
         entry.increment(error))
    {
      const std::string name = entry->path().filename().string();
      if (std::any_of(drafts.begin(), drafts.end(),
                      [&](const std::vector<std::string>& pieces)
                      { return matches(name, pieces); }))
        there.push_back(entry->path().string());
    }
  return there;
}

std::set<std::string> FileRoles::folders() const
{
  std::set<std::string> folders;
  for (const Role& role : roles_)
    if (role.isOutput)
      folders.insert(placeOf(role.pieces[0]).parent_path().string());
  return folders;
}

std::string FileRoles::outputsText() const
{
  std::string text;
  for (const Role& role : roles_)
  {
    if (!role.isOutput)
      continue;
    std::vector<std::string> fields{role.isDraft ? draft : role.what};
    fields.insert(fields.end(), role.pieces.begin(), role.pieces.end());
    fields[1] = role.pieces.size() == 1
                    ? placeOf(role.pieces[0]).string()
                    : (placeOf(role.pieces[0]).parent_path() / fs::path(role.pieces[0]).filename())
                          .string();
    for (std::string& field : fields)
      for (std::size_t at = 0; (at = field.find_first_of("\\\t\n", at)) != std::string::npos;
           at += 2)
        field.replace(at, 1, field[at] == '\t' ? "\\t" : field[at] == '\n' ? "\\n" : "\\\\");
    text += fmt::format("{}\n", fmt::join(fields, "\t"));
  }
  return text;
}

FileRoles FileRoles::outputsIn(const std::string& text)
{
  FileRoles roles;
  std::vector<std::string> fields(1);
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n')
    {
      if (fields.size() > 1)
        roles.roles_.push_back(
            {{fields.begin() + 1, fields.end()}, fields[0], true, false, fields[0] == draft});
      fields.assign(1, "");
    }
    else if (text[i] == '\t')
      fields.emplace_back();
    else if (text[i] == '\\' && i + 1 < text.size())
    {
      ++i;
      fields.back() += text[i] == 't' ? '\t' : text[i] == 'n' ? '\n' : text[i];
    }
    else
      fields.back() += text[i];
  return roles;
}

std::vector<std::string> FileRoles::problemsWith(const FileRoles& others) const
{
  const auto lookAll = [](const std::vector<Role>& roles)
  {
    std::vector<Seen> seen;
    for (const Role& role : roles)
      seen.push_back(role.isOutput ? look(role.pieces) : Seen());
    return seen;
  };
  std::vector<std::string> problems;
  if (others.roles_.empty())
    return problems;
  const std::vector<Seen> here = lookAll(roles_), there = lookAll(others.roles_);
  std::set<std::string> said;
  for (std::size_t i = 0; i < roles_.size(); ++i)
    for (std::size_t k = 0; k < others.roles_.size(); ++k)
    {
      const Role &mine = roles_[i], &its = others.roles_[k];
      if (mine.isOutput && its.isOutput && meet(here[i], there[k]) && said.insert(mine.what).second)
        problems.push_back(fmt::format("{} '{}' is what the other run writes as {} '{}'.",
                                       mine.what, nameOf(mine.pieces), its.what,
                                       nameOf(its.pieces)));
    }
  return problems;
}
} // namespace coplane
