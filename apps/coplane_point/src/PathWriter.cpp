#include "PathWriter.hpp"

#include <coplane_core/Error.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
constexpr const char* header =
    "time[s],gap[m],closure[m],slip_x[m],slip_y[m],normal_traction[Pa],shear_traction_x[Pa],"
    "shear_traction_y[Pa],shear_traction[Pa],slipping,slip_path[m],maximum_closure[m],"
    "offset[m],inelastic_opening[m],inelastic_slip[m],bonded,damage,work[J/m^2],"
    "stored[J/m^2],friction[J/m^2],fracture[J/m^2],hysteresis[J/m^2],balance[J/m^2]\n";
} // namespace

PathWriter::PathWriter(const std::string& file) : file_(file), draft_(placeOfFile(file))
{
  draft_.add(header);
}

void PathWriter::write(const JointPoint& point)
{
  const JointState& state = point.state();
  const Real sigma = point.response().normalTraction, shear = norm(state.shearTraction);
  work_ = point.work();
  stored_ = point.stored();
  friction_ = point.friction();
  fracture_ = point.fracture();
  hysteresis_ = point.hysteresis();
  const Real balance = work_ - stored_ - friction_ - fracture_ - hysteresis_;
  std::string line = fmt::format("{:.17g}", point.time());
  const auto put = [&](Real value) { line += fmt::format(",{:.17g}", value); };
  for (const Real value : {point.gap(), point.closure(), point.slip().x, point.slip().y, sigma,
                           state.shearTraction.x, state.shearTraction.y, shear})
    put(value);
  put(point.response().slipping);
  for (const Real value : {state.slip, state.maximumClosure, point.offset(), state.opening,
                           state.shearing, Real(state.bonded), point.law().damage(state), work_,
                           stored_, friction_, fracture_, hysteresis_, balance})
    put(value);
  draft_.add(line + "\n");
  if (!std::isfinite(sigma + shear + balance))
    fail(ExitCode::Computation,
         "at t = {:.6g} s tractions or energies are not finite: compression {:g} Pa, shear {:g} "
         "Pa, balance {:g} J/m^2. Look at the path and at the stiffnesses.",
         point.time(), sigma, shear, balance);
  if (lines_++ == 0)
    startedBonded_ = state.bonded;
  bonded_ = state.bonded;
  mostCompression_ = std::max(mostCompression_, sigma);
  mostTension_ = std::max(mostTension_, -sigma);
  mostShear_ = std::max(mostShear_, shear);
  worstBalance_ = std::max(worstBalance_, std::abs(balance));
}

void PathWriter::finish()
{
  draft_.close();
  makeWayFor(placeOfFile(file_),
             [](const std::string& there) { return beginsWith(there, header); });
  draft_.finish();
}

std::string PathWriter::summary() const
{
  return fmt::format(
      "  peaks [Pa]: compression {:.6g}, tension {:.6g}, shear {:.6g}{}\n"
      "  energies [J/m^2]: work {:.6g} = stored {:.6g} + friction {:.6g} + fracture {:.6g} + "
      "hysteresis {:.6g}, off by at most {:.2g}\n"
      "  {} points in {}",
      mostCompression_, mostTension_, mostShear_,
      !startedBonded_ ? ""
      : bonded_       ? "; still bonded"
                      : "; the bond is broken",
      work_, stored_, friction_, fracture_, hysteresis_, worstBalance_, lines_, file_);
}
} // namespace coplane
