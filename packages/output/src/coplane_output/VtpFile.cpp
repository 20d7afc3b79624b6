#include <coplane_output/detail/VtpFile.hpp>

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>

namespace coplane
{
namespace
{
template <class T>
std::string bytesOf(const std::vector<T>& values)
{
  return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

/// A DataArray whose bytes follow their number.
template <class T>
std::string dataArray(const char* type, const std::string& name, int components,
                      const std::vector<T>& values)
{
  const std::vector<std::uint64_t> header{values.size() * sizeof(T)};
  return fmt::format("        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" "
                     "format=\"binary\">{}</DataArray>\n",
                     type, name, components, base64(bytesOf(header) + bytesOf(values)));
}
} // namespace

std::string base64(const std::string& bytes)
{
  // OpenSSL counts in ints; only the last piece is filled up.
  constexpr std::size_t piece = 3 << 20;
  std::string text((bytes.size() + 2) / 3 * 4, '\0');
  for (std::size_t i = 0; i < bytes.size(); i += piece)
    EVP_EncodeBlock(reinterpret_cast<unsigned char*>(&text[i / 3 * 4]),
                    reinterpret_cast<const unsigned char*>(&bytes[i]),
                    int(std::min(piece, bytes.size() - i)));
  return text;
}

VtpPoints::VtpPoints(const std::vector<Real>& coordinates)
    : count_(std::int64_t(coordinates.size() / 3)),
      points_(dataArray("Float64", "Points", 3, coordinates))
{
}

VtpPoints::VtpPoints(const std::vector<Real>& coordinates, const std::vector<std::int64_t>& ends)
    : VtpPoints(coordinates)
{
  ends_ = ends;
}

void VtpPoints::addScalarOfCells(const std::string& name, const std::vector<Real>& values)
{
  cellData_ += dataArray("Float64", name, 1, values);
}

void VtpPoints::addIntegersOfCells(const std::string& name, const std::vector<std::int64_t>& values)
{
  cellData_ += dataArray("Int64", name, 1, values);
}

void VtpPoints::addScalar(const std::string& name, const std::vector<Real>& values)
{
  data_ += dataArray("Float64", name, 1, values);
}

void VtpPoints::addVector(const std::string& name, const std::vector<Real>& values)
{
  data_ += dataArray("Float64", name, 3, values);
}

void VtpPoints::addIntegers(const std::string& name, const std::vector<std::int64_t>& values)
{
  data_ += dataArray("Int64", name, 1, values);
}

void VtpPoints::addNames(const std::string& name, const std::vector<std::string>& texts)
{
  // Characters as numbers, each text ended by a zero.
  std::string numbers;
  for (const std::string& text : texts)
  {
    for (const char c : text)
      numbers += fmt::format("{} ", int(static_cast<unsigned char>(c)));
    numbers += "0 ";
  }
  fields_ += fmt::format("      <Array type=\"String\" Name=\"{}\" NumberOfTuples=\"{}\" "
                         "format=\"ascii\">{}</Array>\n",
                         name, texts.size(), numbers);
}

std::string VtpPoints::text(const std::string& comment) const
{
  std::vector<std::int64_t> connectivity, offsets;
  if (ends_)
    connectivity = *ends_;
  else
    for (std::int64_t i = 0; i < count_; ++i)
      connectivity.push_back(i);
  const std::int64_t ofCell = ends_ ? 2 : 1, cells = std::int64_t(connectivity.size()) / ofCell;
  for (std::int64_t i = 1; i <= cells; ++i)
    offsets.push_back(ofCell * i);
  const std::string cellData =
      cellData_.empty() ? "" : "      <CellData>\n" + cellData_ + "      </CellData>\n";
  return fmt::format(
      "<?xml version=\"1.0\"?>\n{6}\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n  <PolyData>\n    <FieldData>\n{5}    </FieldData>\n"
      "    <Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{7}\" NumberOfLines=\"{8}\" "
      "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n"
      "      <Points>\n{1}      </Points>\n      <{9}>\n{2}{3}      </{9}>\n"
      "      <PointData>\n{4}      </PointData>\n{10}    </Piece>\n  </PolyData>\n</VTKFile>\n",
      count_, points_, dataArray("Int64", "connectivity", 1, connectivity),
      dataArray("Int64", "offsets", 1, offsets), data_, fields_, comment, ends_ ? 0 : cells,
      ends_ ? cells : 0, ends_ ? "Lines" : "Verts", cellData);
}
} // namespace coplane
