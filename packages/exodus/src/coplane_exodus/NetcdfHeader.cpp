#include <coplane_exodus/NetcdfHeader.hpp>

#include <cstdint>
#include <filesystem>
#include <fstream>
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

  void check()
  {
    number(wide()); // records
    for (std::uint64_t left = list(10); left > 0; --left)
    {
      skipName();
      lengths_.push_back(number(wide()));
      require(lengths_.back() <= size_);
    }
    skipAttributes();
    for (std::uint64_t left = list(11); left > 0; --left)
      checkVariable();
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
  void skipName() { skip(number(wide())); }

  /// Entries of a list with this tag; 0 when it is absent.
  std::uint64_t list(std::uint64_t expected)
  {
    const std::uint64_t tag = number(4), count = number(wide());
    require(tag == expected || (tag == 0 && count == 0));
    require(count <= size_);
    return count;
  }

  std::uint64_t bytesOfType()
  {
    static const std::uint64_t bytes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    const std::uint64_t type = number(4);
    require(type >= 1 && type <= 11);
    return bytes[type];
  }

  void skipAttributes()
  {
    for (std::uint64_t left = list(12); left > 0; --left)
    {
      skipName();
      const std::uint64_t bytes = bytesOfType(), count = number(wide());
      require(count <= size_);
      skip(bytes * count);
    }
  }

  void checkVariable()
  {
    skipName();
    const std::uint64_t axes = number(wide());
    require(axes <= lengths_.size());
    std::uint64_t entries = 1;
    for (std::uint64_t axis = 0; axis < axes; ++axis)
    {
      const std::uint64_t dimension = number(wide());
      require(dimension < lengths_.size());
      const std::uint64_t length = lengths_[dimension];
      require(length == 0 || entries <= size_ / length);
      entries *= length; // 0 along the axis of records
    }
    skipAttributes();
    const std::uint64_t bytes = bytesOfType() * entries;
    number(wide()); // bytes again, which large variables do not give
    const std::uint64_t begin = number(version_ == 1 ? 4 : 8);
    require(begin <= size_ && bytes <= size_ - begin);
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
    header.check();
  }
  catch (const Misfit&)
  {
    return false;
  }
  return true;
}
} // namespace coplane
