#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_exodus/NetcdfHeader.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace coplane
{
/// A classic netCDF file that is defined already, into which several ranks write at the same time:
/// each its own values, by plain calls of the system that say whether they succeeded. Nothing here
/// is collective, so a rank that fails leaves nobody waiting (MPI-IO would: an error of one rank
/// keeps the others in the library; it may also lose the error). Throws ExodusFailure.
class SharedFile
{
public:
  explicit SharedFile(const std::string& file);
  ~SharedFile();
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;

  /// Values of a variable from its entry `first` on; of a record variable: in time step `step`,
  /// counted from 0.
  void put(const std::string& variable, std::uint64_t first, const std::vector<Real>& values,
           int step = 0);
  void put(const std::string& variable, std::uint64_t first,
           const std::vector<std::int64_t>& values);
  bool has(const std::string& variable) const { return layout_.variables.count(variable) > 0; }

  /// Claims room on the disk for everything but time steps, or for one time step.
  void reserveMesh() const;
  void reserveStep(int step) const;
  /// Number of time steps in the header. One rank calls it, after the data.
  void setSteps(int steps) const;
  /// Whether no name leads to the file any more: what is written is lost when it is closed.
  bool isGone() const;
  /// Whether somebody has cut off the file: it is shorter than when this was asked last, or its
  /// time step `step` does not begin with `time` (s), which is written first in a step. The second
  /// finds what was cut while later values were written: these make the file long again.
  bool isCutOff(int step, Real time);
  /// Waits until the disk has what this rank wrote.
  void sync() const;
  /// Closes; here some file systems tell of writes that failed.
  void close();

private:
  const ClassicVariable& variable(const std::string& name) const;
  template <class T>
  void putAny(const std::string& name, std::uint64_t first, const std::vector<T>& values, int step);
  void write(const std::string& what, std::uint64_t at, const unsigned char* bytes,
             std::size_t count) const;
  std::uint64_t beginOfStep(int step) const;
  void reserve(std::uint64_t first, std::uint64_t bytes) const;

  ClassicLayout layout_;
  int descriptor_ = -1;
  std::uint64_t bytes_ = 0; // of the file, when isCutOff was asked last
  std::vector<unsigned char> buffer_;
};
} // namespace coplane
