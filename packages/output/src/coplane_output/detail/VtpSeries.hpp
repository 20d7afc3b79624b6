#pragma once

#include <coplane_output/detail/PlanesSeries.hpp>
#include <coplane_output/detail/VtpSteps.hpp>

namespace coplane
{
/// <base>_planes.pvd and a file <base>_planes_0000.vtp, ... for each step.
class VtpSeries : public PlanesSeries
{
public:
  /// As of VtpSteps.
  VtpSeries(const std::string& base, const std::string& run, bool continues,
            const std::string& steps);

  void begin(const std::vector<std::string>& joints) override { joints_ = joints; }
  void add(Real time, const PlanePoints& points) override;
  void finish() override {}
  std::string position() const override { return steps_.position(); }

private:
  VtpSteps steps_;
  std::vector<std::string> joints_;
};
} // namespace coplane
