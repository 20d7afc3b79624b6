#include <coplane_contact/ContactTables.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_output/detail/NodalContact.hpp>

#include <algorithm>

namespace coplane
{
NodalContact nodalContact(const Solver& solver)
{
  const int owned = solver.layout().owned();
  NodalContact nodal;
  nodal.pressure.assign(owned, 0);
  nodal.traction.assign(owned, {});
  nodal.closure.assign(owned, 0);
  nodal.gap.assign(owned, 0);
  nodal.slip.assign(owned, 0);
  nodal.state.assign(owned, 0);
  if (!solver.hasContact())
    return nodal;
  const Contact& contact = solver.contact();
  std::vector<Real> area(owned, 0);   // of the planes around a node [m^2]
  std::vector<Real> closed(owned, 0); // part of it that carries traction
  for (std::size_t p = 0; p < contact.planesNow().size(); ++p)
  {
    // Without overlap the gap belongs to a moment long ago.
    if (const Plane& own = contact.planesNow()[p];
        !own.isBorn() || own.face[0] < 0 || own.face[1] < 0 || !(own.overlap > 0))
      continue;
    const Plane plane = planeNow(contact, contact.planesNow()[p], solver.state().x);
    for (int side = 0; side < 2; ++side)
    {
      const Face& face = contact.faces()[plane.face[side]];
      for (int k = 0; k < face.count; ++k)
      {
        const int node = face.nodes[k];
        if (node >= owned)
          continue;
        const Real gap = plane.gap - plane.offset;
        nodal.gap[node] = nodal.state[node] == 0 ? gap : std::min(nodal.gap[node], gap);
        nodal.slip[node] = std::max(nodal.slip[node], plane.history.slip);
        nodal.state[node] = std::max(nodal.state[node], Real(int(plane.state)));
        nodal.pressure[node] += plane.area * plane.normalTraction;
        area[node] += plane.area;
        if (plane.area > 0) // not what makes up for the last step of a pair that has parted
          nodal.traction[node] += plane.forceOn(side);
        if (plane.state != PlaneState::Open)
        {
          closed[node] += plane.area;
          nodal.closure[node] += plane.area * plane.closure;
        }
      }
    }
  }
  for (int n = 0; n < owned; ++n)
  {
    if (area[n] > 0)
    {
      nodal.pressure[n] /= area[n];
      nodal.traction[n] = (1 / area[n]) * nodal.traction[n];
    }
    if (closed[n] > 0)
      nodal.closure[n] /= closed[n];
  }
  return nodal;
}
} // namespace coplane
