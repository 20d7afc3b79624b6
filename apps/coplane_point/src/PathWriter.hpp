#pragma once

#include "JointPoint.hpp"

#include <coplane_core/TextFile.hpp>

#include <string>

namespace coplane
{
/// CSV file of a path, one line per point, and the extremes of what was written. It takes its name
/// when it is whole; a file of that name that is no path of a joint is put aside.
class PathWriter
{
public:
  /// Throws Error(ExitCode::Output), as everything here.
  explicit PathWriter(const std::string& file);
  void write(const JointPoint& point);
  void finish();

  /// What happened, in a few lines for the screen.
  std::string summary() const;

private:
  std::string file_;
  TextDraft draft_;
  int lines_ = 0;
  Real mostCompression_ = 0, mostTension_ = 0, mostShear_ = 0, worstBalance_ = 0;
  bool startedBonded_ = false, bonded_ = false;
  Real work_ = 0, stored_ = 0, friction_ = 0, fracture_ = 0, hysteresis_ = 0;
};
} // namespace coplane
