#pragma once

#include "SplitMesh.hpp"

#include <string>
#include <vector>

namespace coplane
{
/// What of a joint is in the domain, outside of openings that are cut out, and what of that was
/// left out before the mesh was split [m^2; 2D: m].
struct JointMeasure
{
  Real asked = 0;
  Real slivers = 0; ///< left out where slivers were joined to neighbours
  Real stubs = 0;   ///< left out as short ends
  Real largest = 0; ///< piece that was left out, or closed by mending
  Vec3 place{};     ///< its middle [m]

  /// A piece that is not in the mesh.
  void leaveOut(Real measure, const Vec3& middle);
};

/// For each joint of which more than 1e-3 is not open in the mesh: how much, why and where; then,
/// if there are any, what it means and what helps. @param measures by joint, as cuts; resolution:
/// of places [m]
std::vector<std::string> notesOfLeftOut(const std::vector<JointMeasure>& measures,
                                        const std::vector<CutReport>& cuts, int dimension,
                                        Real resolution);
} // namespace coplane
