#include "BondSoftness.hpp"

#include <coplane_core/Log.hpp>
#include <coplane_core/OrderStatistics.hpp>

#include <fmt/format.h>

namespace coplane
{
namespace
{
struct Softness
{
  std::vector<Real> across, along; ///< stiffness with bonds over that without, of this rank's bonds
};

/// A bond and, on both sides of it, the material up to the middles of the elements, in series.
void add(const Solver& solver, const Plane& plane, Softness& softness)
{
  Real across = 0, along = 0; // compliances of the material [m/Pa]
  for (int side = 0; side < 2; ++side)
  {
    const auto& block = solver.model().blocks[plane.block[side]];
    if (block.rigid)
      return;
    const LinearElastic& elastic = elasticity(block.material);
    const Real K = elastic.bulkModulus, G = elastic.shearModulus;
    if (!(G > 0))
      return;
    const Real half = 0.5 * solver.contact().faces()[plane.face[side]].thickness;
    across += half * (3 * K + G) / (9 * K * G);
    along += half / G;
  }
  softness.across.push_back(1 / (1 + 1 / (plane.fit.normalStiffness * across)));
  if (plane.fit.shearStiffness > 0)
    softness.along.push_back(1 / (1 + 1 / (plane.fit.shearStiffness * along)));
}

std::string spread(std::vector<Real> mine, const Comm& comm)
{
  const std::vector<Real> q = orderStatistics(std::move(mine), {0, 0.5, 1}, comm);
  return q.empty() ? "-" : fmt::format("{:.4g} to {:.4g}, median {:.4g}", q[0], q[2], q[1]);
}
} // namespace

void reportBondSoftness(const Solver& solver)
{
  const Contact& contact = solver.contact();
  std::vector<Softness> ofJoint(contact.rules().joints.size());
  for (std::size_t p = 0; p < contact.planes().size(); ++p)
  {
    const Plane& plane = contact.planes()[p];
    if (plane.countedHere && plane.face[0] >= 0 && plane.history.bonded)
      add(solver, plane, ofJoint[plane.joint]);
  }
  for (std::size_t j = 0; j < ofJoint.size(); ++j)
    if (contact.comm().sum(std::int64_t(ofJoint[j].across.size())) > 0)
      logInfo("  bonds of joint '{}' and the elements at them, in series, over the elements alone: "
              "stiffness across {}; in shear {}",
              contact.rules().joints[j].name, spread(std::move(ofJoint[j].across), contact.comm()),
              spread(std::move(ofJoint[j].along), contact.comm()));
}
} // namespace coplane
