#include "LeftOut.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/PlaceText.hpp>

#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace coplane
{
void JointMeasure::leaveOut(Real measure, const Vec3& middle)
{
  if (measure > largest)
  {
    largest = measure;
    place = middle;
  }
}

std::vector<std::string> notesOfLeftOut(const std::vector<JointMeasure>& measures,
                                        const std::vector<CutReport>& cuts, int dimension,
                                        Real resolution)
{
  constexpr Real tolerance = 1e-3; // of a joint
  const char* unit = dimension == 2 ? "m" : "m^2";
  std::vector<std::string> notes, cures;
  const auto help = [&](const char* cure)
  {
    if (std::find(cures.begin(), cures.end(), cure) == cures.end())
      cures.push_back(cure);
  };
  for (std::size_t j = 0; j < cuts.size(); ++j)
  {
    JointMeasure measure = measures.at(j);
    const Real least = tolerance * measure.asked, lost = measure.asked - cuts[j].area;
    if (!(lost > least))
      continue;
    measure.leaveOut(cuts[j].largestClosed, cuts[j].closedPlace);
    std::vector<std::pair<Real, std::string>> parts;
    const auto tell = [&](Real part, const char* reason, const char* cure)
    {
      if (!(part > 0.1 * least))
        return;
      parts.push_back({part, reason});
      help(cure);
    };
    tell(measure.slivers, "where slivers were joined to neighbours",
         "slivers.volume, slivers.thickness");
    tell(measure.stubs, "as short ends", "slivers.stub");
    tell(lost - measure.slivers - measure.stubs, "closed on rims or by mending", "elements.size");
    std::vector<std::string> reasons;
    for (const auto& [part, reason] : parts)
      reasons.push_back(parts.size() > 1 ? fmt::format("{:.4g} {} {}", part, unit, reason)
                                         : reason);
    notes.push_back(fmt::format(
        "joint '{}': {:.4g} of {:.6g} {} are not open ({}), the largest piece, of {:.4g} {}, at {} "
        "m",
        cuts[j].name, lost, measure.asked, unit, fmt::join(reasons, ", "), measure.largest, unit,
        placeText(measure.place, resolution)));
  }
  if (!notes.empty())
    notes.push_back(fmt::format(
        "where joints are not open both sides hang together: rock bridges, which carry without "
        "limit, so that a factor of safety comes out too large. Smaller {} keep them open",
        fmt::join(cures, ", ")));
  return notes;
}
} // namespace coplane
