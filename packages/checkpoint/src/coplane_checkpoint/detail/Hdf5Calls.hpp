#pragma once

#include <coplane_checkpoint/Hdf5Guard.hpp>
#include <coplane_core/Real.hpp>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace coplane::hdf5
{
/// Part of a two-dimensional data set: all columns of some rows.
struct Part
{
  std::int64_t rows, columns; ///< of the whole
  std::int64_t first, count;  ///< rows of this rank
};

/// A file that this rank has open by itself: no call is collective, so a rank on which one fails
/// leaves nobody waiting in the library.
class File
{
public:
  enum class Mode
  {
    Create, ///< with room for the head
    Read
  };
  File(const std::string& file, Mode mode);
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  /// Closes; throws where that fails.
  void close();

  void write(const std::string& name, const std::vector<Real>& values);
  void writeText(const std::string& name, const std::string& text);
  /// Makes a table of 8-byte values that are written later, row after row, by whoever has them.
  /// Returns where in the file it begins.
  std::uint64_t makeTable(const std::string& name, std::int64_t rows, std::int64_t columns,
                          bool ofIds);

  bool has(const std::string& name) const;
  /// Rows and columns of the whole.
  Part shape(const std::string& name) const;
  void read(const std::string& name, const Part& part, std::vector<Real>& values) const;
  void read(const std::string& name, const Part& part, std::vector<GlobalId>& values) const;
  std::string readText(const std::string& name) const;

private:
  void makeGroups(const std::string& name);
  std::int64_t makeSet(const std::string& name, std::int64_t rows, std::int64_t columns,
                       std::int64_t type);
  void writeAll(const std::string& name, std::size_t count, std::int64_t type, const void* values);
  void readAny(const std::string& name, const Part& part, std::int64_t type, void* values) const;

  std::int64_t id_ = -1;
  std::set<std::string> groups_; ///< that have been made
};
} // namespace coplane::hdf5
