#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/TextFile.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace coplane
{
/// Files of a series, on rank 0: <base>.pvd and <base>_0000.vtp, ... for each step. The .pvd names
/// all steps with their times; it is replaced as a whole after each.
class VtpSteps
{
public:
  /// @param base such as wall_planes
  /// @param run identity, by which a restart knows whether a series is its own
  /// @param steps position() of the run that is continued, if it wrote this series
  VtpSteps(const std::string& base, const std::string& run, bool continues,
           const std::string& steps);

  /// Has to stand in the second line of every step.
  std::string comment() const;
  void add(Real time, const std::string& text);
  std::string position() const; ///< lines of text

private:
  std::string fileOf(const std::string& step) const; ///< with its folder
  void clearTheWay();
  void writeSeries();

  std::string base_, run_;
  bool continues_;
  std::optional<ReplacedFile> series_;
  int firstNumber_ = 0;                             ///< of the files of the steps
  std::vector<std::pair<Real, std::string>> steps_; ///< time [s] and file name without folder
};
} // namespace coplane
