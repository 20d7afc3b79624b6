#pragma once

#include <coplane_core/PlacesOfFile.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_output/detail/PlanesSeries.hpp>
#include <coplane_output/detail/VtkHdfFile.hpp>

#include <memory>

namespace coplane
{
/// All steps in one file <base>_planes.vtkhdf, and an index <base>_planes.xmf3 by which readers
/// that do not know steps in VTKHDF (ParaView before 5.12) find them.
///
/// Rows of a step go to room that the file has behind those of the steps before; then a few bytes
/// say that there is one more step. Nothing that was finished is written again, so that a kill at
/// any moment leaves it. When the room is used up, the file is written anew with twice as much, and
/// at the end with none, and takes the place of the old one.
class VtkHdfSeries : public PlanesSeries
{
public:
  /// As of VtpSeries.
  VtkHdfSeries(const std::string& base, const std::string& run, bool continues,
               const std::string& steps);

  void begin(const std::vector<std::string>& joints) override;
  void add(Real time, const PlanePoints& points) override;
  void finish() override;
  std::string position() const override;

private:
  struct Step
  {
    Real time; ///< [s]
    std::int64_t rows;
  };
  std::int64_t rows() const;
  std::string writer(const VtkHdfRoom& room) const;
  VtkHdfSkeleton skeleton(const VtkHdfRoom& room) const;
  bool openOwn();
  void makeRoom(const VtkHdfRoom& room, const PlanePoints* last = nullptr);
  void writeRows(PlaceWriter& file, const VtkHdfSkeleton& in, const PlanePoints& points) const;
  void commit();
  void writeIndex();
  [[noreturn]] void fails(int error) const;

  std::string base_, run_;
  std::vector<std::string> joints_;
  std::vector<PlaneColumn> columns_; ///< without values
  std::vector<Step> steps_;
  ReplacedFile data_, index_;
  std::unique_ptr<PlaceWriter> file_; ///< open while the run writes
  VtkHdfRoom room_;
  VtkHdfSkeleton written_; ///< of the file as it is
  std::size_t stepsOfIndex_ = 0;
};
} // namespace coplane
