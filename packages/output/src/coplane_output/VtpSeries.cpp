#include <coplane_output/detail/VtpFile.hpp>
#include <coplane_output/detail/VtpSeries.hpp>

namespace coplane
{
namespace
{
std::string textOf(const PlanePoints& planes, const std::vector<std::string>& joints,
                   const std::string& comment)
{
  VtpPoints points(planes.coordinates);
  points.addNames("joint_names", joints);
  for (const PlaneColumn& column : planes.columns)
    if (const auto* integers = std::get_if<std::vector<std::int64_t>>(&column.values))
      points.addIntegers(column.name, *integers);
    else if (const auto& reals = std::get<std::vector<Real>>(column.values); column.components == 3)
      points.addVector(column.name, reals);
    else
      points.addScalar(column.name, reals);
  return points.text(comment);
}
} // namespace

VtpSeries::VtpSeries(const std::string& base, const std::string& run, bool continues,
                     const std::string& steps)
    : steps_(base + "_planes", run, continues, steps)
{
}

void VtpSeries::add(Real time, const PlanePoints& points)
{
  steps_.add(time, textOf(points, joints_, steps_.comment()));
}
} // namespace coplane
