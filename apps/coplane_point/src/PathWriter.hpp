#pragma once

#include "JointPoint.hpp"

#include <fstream>
#include <string>

namespace coplane
{
/// CSV file of a path, one line per point, and the extremes of what was written.
class PathWriter
{
public:
  /// Throws Error(ExitCode::Output), as everything here.
  explicit PathWriter(const std::string& file);
  void write(const JointPoint& point);
  void close();

  /// What happened, in a few lines for the screen.
  std::string summary() const;

private:
  std::string file_;
  std::ofstream stream_;
  int lines_ = 0;
  Real mostCompression_ = 0, mostTension_ = 0, mostShear_ = 0, worstBalance_ = 0;
  bool startedBonded_ = false, bonded_ = false;
  Real work_ = 0, stored_ = 0, friction_ = 0, fracture_ = 0, hysteresis_ = 0;
};
} // namespace coplane
