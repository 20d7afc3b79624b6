#pragma once

#include <coplane_output/detail/PlanePoints.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// Files of planes over time, on rank 0 within Comm::together. Errors are Error(ExitCode::Output).
/// A run that is killed at any moment leaves all steps that were finished.
class PlanesSeries
{
public:
  virtual ~PlanesSeries() = default;
  /// Before the first step: with the joints of the run. A restart cuts off here, or before, what is
  /// later than the checkpoint.
  virtual void begin(const std::vector<std::string>& joints) = 0;
  virtual void add(Real time, const PlanePoints& points) = 0;
  virtual void finish() = 0; ///< after the last step
  /// Of the steps so far, for the run that goes on: lines of text.
  virtual std::string position() const = 0;
};
} // namespace coplane
