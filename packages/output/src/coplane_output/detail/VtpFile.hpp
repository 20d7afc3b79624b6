#pragma once

#include <coplane_core/Real.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace coplane
{
/// Text of a VTK XML PolyData file (.vtp) of points with named data: version 1.0, 64-bit headers,
/// arrays in base64. Every point is also a vertex cell, so that viewers show it at once.
class VtpPoints
{
public:
  explicit VtpPoints(const std::vector<Real>& coordinates);
  /// Straight cells between two points each, a b a b ..., in place of vertices.
  VtpPoints(const std::vector<Real>& coordinates, const std::vector<std::int64_t>& ends);

  void addScalar(const std::string& name, const std::vector<Real>& values);
  void addVector(const std::string& name, const std::vector<Real>& values); ///< x y z x y z ...
  void addIntegers(const std::string& name, const std::vector<std::int64_t>& values);

  // Of cells.
  void addScalarOfCells(const std::string& name, const std::vector<Real>& values);
  void addIntegersOfCells(const std::string& name, const std::vector<std::int64_t>& values);

  /// Names that belong to the whole file (field data), such as those of numbers in an array.
  void addNames(const std::string& name, const std::vector<std::string>& texts);

  std::string text(const std::string& comment) const; ///< XML; the comment in the second line

private:
  std::int64_t count_;
  std::string points_, data_, cellData_, fields_;
  std::optional<std::vector<std::int64_t>> ends_; ///< none: vertices
};

/// Bytes as base64 (RFC 4648).
std::string base64(const std::string& bytes);
} // namespace coplane
