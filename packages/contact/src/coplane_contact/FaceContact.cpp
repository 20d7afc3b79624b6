#include <coplane_contact/ContactTables.hpp>
#include <coplane_contact/FaceContact.hpp>
#include <coplane_geometry/FaceCorners.hpp>

#include <algorithm>

namespace coplane
{
std::vector<FaceContact> faceContact(const Contact& contact, const ConstNodeVectors& x)
{
  const std::vector<Face>& faces = contact.faces();
  const std::size_t local =
      std::find_if(faces.begin(), faces.end(), [](const Face& f) { return !f.local; }) -
      faces.begin();
  std::vector<FaceContact> list(local);
  std::vector<Real> area(local, 0); // of contact [m^2]
  for (std::size_t p = 0; p < contact.planesNow().size(); ++p)
  {
    if (const Plane& own = contact.planesNow()[p];
        !own.isBorn() || own.face[0] < 0 || !(own.overlap > 0))
      continue;
    const Plane plane = planeNow(contact, contact.planesNow()[p], x);
    for (int side = 0; side < 2; ++side)
    {
      const std::size_t f = std::size_t(plane.face[side]);
      if (f >= local)
        continue;
      FaceContact& face = list[f];
      const Real gap = plane.gap - plane.offset;
      face.gap = face.state == PlaneState::Slot ? gap : std::min(face.gap, gap);
      face.slip = std::max(face.slip, plane.history.slip);
      face.state = std::max(face.state, plane.state);
      if (plane.state == PlaneState::Open)
        continue;
      area[f] += plane.area;
      face.normalTraction += plane.area * plane.normalTraction;
      face.shearTraction += ((side == 0 ? -1 : 1) * plane.area) * plane.history.shearTraction;
      face.closure += plane.area * plane.closure;
    }
  }
  for (std::size_t f = 0; f < local; ++f)
  {
    if (!(area[f] > 0))
      continue;
    const FaceCorners corners = cornersAt(x, faces[f]);
    Real whole = norm(corners.area(contact.dimension()));
    if (contact.options().axisymmetric)
      whole *= pi * (corners.x[0].x + corners.x[1].x);
    list[f].areaFraction = area[f] / whole;
    list[f].normalTraction /= area[f];
    list[f].shearTraction = (1 / area[f]) * list[f].shearTraction;
    list[f].closure /= area[f];
  }
  return list;
}
} // namespace coplane
