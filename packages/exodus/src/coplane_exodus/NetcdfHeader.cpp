#include <coplane_exodus/ExodusCalls.hpp>
#include <coplane_exodus/NetcdfHeader.hpp>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>
#include <vector>

namespace coplane
{
namespace
{
/// Something in the header that cannot be.
struct Misfit
{
};

/// The header as the netCDF classic format specification has it, big-endian numbers one after
/// another.
class ClassicHeader
{
public:
  explicit ClassicHeader(const std::string& file)
      : in_(file, std::ios::binary), size_(std::filesystem::file_size(file))
  {
  }

  bool isClassic()
  {
    char magic[4] = {};
    in_.read(magic, 4);
    version_ = magic[3];
    return in_ && magic[0] == 'C' && magic[1] == 'D' && magic[2] == 'F' &&
           (version_ == 1 || version_ == 2 || version_ == 5);
  }

  /// Checks on the way that nothing is larger than the file.
  ClassicLayout layout()
  {
    ClassicLayout layout;
    number(wide()); // records
    for (std::uint64_t left = list(10); left > 0; --left)
    {
      name();
      lengths_.push_back(number(wide()));
      require(lengths_.back() <= size_);
    }
    skipAttributes();
    for (std::uint64_t left = list(11); left > 0; --left)
    {
      const auto [name, variable] = nextVariable();
      layout.variables[name] = variable;
      const std::uint64_t bytes =
          (std::uint64_t(variable.bytes) * variable.entries + 3) / 4 * 4; // padded
      if (variable.isRecord)
        layout.recordBytes += bytes;
      else
        layout.firstRecord = std::max(layout.firstRecord, variable.begin + bytes);
    }
    return layout;
  }

private:
  static void require(bool holds)
  {
    if (!holds)
      throw Misfit{};
  }
  int wide() const { return version_ == 5 ? 8 : 4; } ///< bytes of a count

  std::uint64_t number(int bytes)
  {
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i)
      value = value << 8 | std::uint64_t(in_.get() & 0xff);
    require(bool(in_));
    return value;
  }
  void skip(std::uint64_t bytes)
  {
    require(bytes <= size_);
    in_.seekg(std::streamoff((bytes + 3) / 4 * 4), std::ios::cur);
    require(std::uint64_t(in_.tellg()) <= size_);
  }
  std::string name()
  {
    const std::uint64_t length = number(wide());
    require(length <= size_);
    std::string text(length, '\0');
    in_.read(text.data(), std::streamsize(length));
    in_.ignore(std::streamsize((4 - length % 4) % 4)); // padded
    require(bool(in_));
    return text;
  }

  /// Entries of a list with this tag; 0 when it is absent.
  std::uint64_t list(std::uint64_t expected)
  {
    const std::uint64_t tag = number(4), count = number(wide());
    require(tag == expected || (tag == 0 && count == 0));
    require(count <= size_);
    return count;
  }

  int type()
  {
    const std::uint64_t type = number(4);
    require(type >= 1 && type <= 11);
    return int(type);
  }
  static int bytesOf(int type)
  {
    constexpr int bytes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    return bytes[type];
  }

  void skipAttributes()
  {
    for (std::uint64_t left = list(12); left > 0; --left)
    {
      name();
      const int bytes = bytesOf(type());
      const std::uint64_t count = number(wide());
      require(count <= size_);
      skip(std::uint64_t(bytes) * count);
    }
  }

  std::pair<std::string, ClassicVariable> nextVariable()
  {
    const std::string called = name();
    ClassicVariable variable;
    const std::uint64_t axes = number(wide());
    require(axes <= lengths_.size());
    variable.entries = 1;
    for (std::uint64_t axis = 0; axis < axes; ++axis)
    {
      const std::uint64_t dimension = number(wide());
      require(dimension < lengths_.size());
      const std::uint64_t length = lengths_[dimension];
      if (length == 0) // the axis of records
      {
        variable.isRecord = true;
        continue;
      }
      require(variable.entries <= size_ / length || variable.isRecord);
      require(variable.entries <= std::numeric_limits<std::uint64_t>::max() / length / 8);
      variable.entries *= length;
    }
    skipAttributes();
    variable.type = type();
    variable.bytes = bytesOf(variable.type);
    number(wide()); // bytes again, which large variables do not give
    variable.begin = number(version_ == 1 ? 4 : 8);
    require(variable.begin <= size_ || variable.isRecord); // there may be no time step yet
    if (!variable.isRecord)
      require(std::uint64_t(variable.bytes) * variable.entries <= size_ - variable.begin);
    return {called, variable};
  }

  std::ifstream in_;
  std::uint64_t size_;
  int version_ = 0;
  std::vector<std::uint64_t> lengths_; ///< of the dimensions
};
} // namespace

bool classicHeaderFitsFile(const std::string& file)
{
  ClassicHeader header(file);
  if (!header.isClassic())
    return true;
  try
  {
    header.layout();
  }
  catch (const Misfit&)
  {
    return false;
  }
  return true;
}

ClassicLayout readClassicLayout(const std::string& file)
{
  ClassicHeader header(file);
  if (!header.isClassic())
    throw ExodusFailure("the new file has no header of netCDF");
  try
  {
    return header.layout();
  }
  catch (const Misfit&)
  {
    throw ExodusFailure("the header of the new file cannot be read back");
  }
}
} // namespace coplane
