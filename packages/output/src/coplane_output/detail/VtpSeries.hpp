#pragma once

#include <coplane_core/TextFile.hpp>
#include <coplane_output/detail/PlanesSeries.hpp>

#include <optional>
#include <utility>

namespace coplane
{
/// <base>_planes.pvd and a file <base>_planes_0000.vtp, ... for each step. The .pvd names all steps
/// with their times; it is replaced as a whole after each.
class VtpSeries : public PlanesSeries
{
public:
  /// @param run identity, by which a restart knows whether a series is its own
  /// @param steps position() of the run that is continued, if it wrote this series
  VtpSeries(const std::string& base, const std::string& run, bool continues,
            const std::string& steps);

  void begin(const std::vector<std::string>& joints) override { joints_ = joints; }
  void add(Real time, const PlanePoints& points) override;
  void finish() override {}
  std::string position() const override;

private:
  std::string fileOf(const std::string& step) const; ///< with its folder
  void clearTheWay();
  void writeSeries();

  std::string base_, run_;
  bool continues_;
  std::vector<std::string> joints_;
  std::optional<ReplacedFile> series_;
  int firstNumber_ = 0;                             ///< of the files of the steps
  std::vector<std::pair<Real, std::string>> steps_; ///< time [s] and file name without folder
};
} // namespace coplane
