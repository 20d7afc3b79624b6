#include <coplane_contact/FacePairKernel.hpp>
#include <coplane_contact/Inheritance.hpp>

#include <algorithm>

namespace coplane
{
bool isDonor(const Plane& plane)
{
  return plane.born && (plane.area > 0 || (plane.declared && plane.fresh));
}

Donor donorOf(const Plane& plane)
{
  Donor donor;
  donor.faceId[0] = plane.faceId[0];
  donor.faceId[1] = plane.faceId[1];
  donor.joint = plane.joint;
  donor.normal = plane.normal;
  donor.area = plane.area > 0 ? plane.area : plane.overlap;
  donor.offset = plane.offset;
  donor.maximumClosure = plane.history.maximumClosure;
  donor.closure = plane.closure;
  donor.shearTraction = plane.history.shearTraction;
  donor.slip = plane.history.slip;
  return donor;
}

namespace
{
bool shareNode(const GlobalId* a, const GlobalId* b)
{
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      if (a[i] != 0 && a[i] == b[j])
        return true;
  return false;
}

/// Whether a donor lies on the surface that the plane slides over.
bool isOnSameSurface(const Donor& donor, const Plane& plane, const PairNodes& nodes)
{
  for (int mine = 0; mine < 2; ++mine)
    for (int its = 0; its < 2; ++its)
      if (donor.faceId[its] == plane.faceId[mine] &&
          shareNode(donor.nodes[1 - its], nodes[1 - mine].data()))
        return true;
  return false;
}
} // namespace

bool inherit(Plane& plane, const Vec3& normal, const PairNodes& nodes, std::vector<Donor>& donors)
{
  const auto key = [](const Donor& d) { return std::make_pair(d.faceId[0], d.faceId[1]); };
  std::sort(donors.begin(), donors.end(),
            [&](const Donor& a, const Donor& b) { return key(a) < key(b); });
  Real area = 0;
  bool slidesOn = false;
  Donor mean;
  for (std::size_t i = 0; i < donors.size(); ++i)
  {
    const Donor& donor = donors[i];
    // Ids of faces say which way a normal points and on which face a traction acts: where the
    // common face is the lower one of one plane and the higher one of the other, both are turned
    // round.
    const bool turned = donor.faceId[0] == plane.faceId[1] || donor.faceId[1] == plane.faceId[0];
    const Real sign = turned ? -1 : 1;
    if (donor.joint != plane.joint || !(sign * dot(donor.normal, normal) > 0.9) ||
        (i > 0 && key(donors[i - 1]) == key(donor)))
      continue;
    area += donor.area;
    slidesOn = slidesOn || isOnSameSurface(donor, plane, nodes);
    mean.offset += donor.area * donor.offset;
    mean.maximumClosure += donor.area * donor.maximumClosure;
    mean.closure += donor.area * donor.closure;
    mean.slip += donor.area * donor.slip;
    mean.shearTraction += donor.area * turnIntoPlane(sign * donor.shearTraction,
                                                     sign * donor.normal, normal, Vec3{}, 0);
  }
  if (!(area > 0))
    return false;
  plane.inherited = true;
  plane.slidesOn = slidesOn;
  plane.offset = mean.offset / area;
  plane.history.maximumClosure = mean.maximumClosure / area;
  plane.closure = mean.closure / area;
  plane.history.slip = mean.slip / area;
  plane.history.shearTraction = (1 / area) * mean.shearTraction;
  plane.normal = normal;
  return true;
}
} // namespace coplane
