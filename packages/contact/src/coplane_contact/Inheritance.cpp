#include <coplane_contact/EdgesOfSurfaces.hpp>
#include <coplane_contact/FacePairKernel.hpp>
#include <coplane_contact/Inheritance.hpp>
#include <coplane_contact/View.hpp>
#include <coplane_geometry/ConvexPolygon.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
bool isDonor(const Plane& plane)
{
  return plane.isBorn() && (plane.area > 0 || (plane.declared && plane.isNew()));
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
  donor.bonded = plane.history.bonded;
  donor.opening = plane.history.opening;
  donor.shearing = plane.history.shearing;
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

/// Calls visit(mine, its) for every face that the pair and the donor have in common, until it
/// returns true; whether it did.
template <class Visit>
bool anyCommonFace(const GlobalId* faceId, const Donor& donor, const Visit& visit)
{
  for (int mine = 0; mine < 2; ++mine)
    for (int its = 0; its < 2; ++its)
      if (donor.faceId[its] == faceId[mine] && visit(mine, its))
        return true;
  return false;
}

/// Whether a donor lies on the surface that the pair slides over.
bool isOnSameSurface(const Donor& donor, const GlobalId* faceId, const PairNodes& nodes)
{
  return anyCommonFace(faceId, donor,
                       [&](int mine, int its) {
                         return donor.flush ||
                                shareNode(donor.nodes[1 - its], nodes[1 - mine].data());
                       });
}

/// Shares of area below this fraction of the smaller face are round-off of edges on each other.
constexpr Real sliver = 1e-6;
/// Of heights, as a fraction of the size of a face.
constexpr Real roundOff = 1e-9;

Real toSegment(const Vec2& p, const Vec2& a, const Vec2& b)
{
  const Vec2 along = b - a, off = p - a;
  const Real square = along.x * along.x + along.y * along.y;
  const Real t = square > 0 ? (off.x * along.x + off.y * along.y) / square : 0;
  const Vec2 apart = off - std::max(0.0, std::min(1.0, t)) * along;
  return std::hypot(apart.x, apart.y);
}

/// Distance of two convex polygons [m].
Real distance(const ConvexPolygon& a, const ConvexPolygon& b)
{
  if (intersection(a, b).size > 0)
    return 0;
  Real least = infinity;
  const auto fromCorners = [&](const ConvexPolygon& from, const ConvexPolygon& to)
  {
    for (int i = 0; i < from.size; ++i)
      for (int j = 0; j < to.size; ++j)
        least =
            std::min(least, toSegment(from.vertex[i], to.vertex[j], to.vertex[(j + 1) % to.size]));
  };
  fromCorners(a, b);
  fromCorners(b, a);
  return least;
}
} // namespace

bool isFlush(const NewPair& pair, const Donor& donor, int dimension)
{
  const auto areaOf = [&](const Vec3* corners, int count)
  { return dimension == 2 ? vectorArea<2>(corners, count) : vectorArea<3>(corners, count); };
  const auto goesOn = [&](int mine, int its)
  {
    const Vec3* const a = pair.corners[1 - mine];
    const Vec3* const b = donor.corners[1 - its];
    const int countA = pair.count[1 - mine], countB = donor.count[1 - its];
    if (countB == 0)
      return false;
    const Vec3 areaA = areaOf(a, countA), areaB = areaOf(b, countB);
    const Vec3 normal = normalised(areaA);
    if (!(dot(normal, normalised(areaB)) > DirectionsOfNodes::one))
      return false;
    const Real smaller = std::min(norm(areaA), norm(areaB));
    const Real near = EdgesOfSurfaces::flush * (dimension == 2 ? smaller : std::sqrt(smaller));
    Real step = infinity;
    for (int k = 0; k < countB; ++k)
      step = std::min(step, std::abs(dot(normal, b[k] - a[0])));
    const View view(normal, a[0], dimension);
    return step <= near && distance(view.shadow(a, countA), view.shadow(b, countB)) <= near;
  };
  return anyCommonFace(pair.faceId, donor, goesOn);
}

bool continues(const NewPair& pair, const Donor& donor, int dimension, Real reach)
{
  const View view(pair.normal, pair.corners[0][0], dimension);
  const ConvexPolygon shadows[2] = {view.shadow(pair.corners[0], pair.count[0]),
                                    view.shadow(pair.corners[1], pair.count[1])};
  const ConvexPolygon carried = intersection(view.shadow(donor.corners[0], donor.count[0]),
                                             view.shadow(donor.corners[1], donor.count[1]));
  if (!anyCommonFace(pair.faceId, donor,
                     [&](int mine, int) { return distance(carried, shadows[1 - mine]) <= reach; }))
    return false;

  const Real smaller = std::min(areaAndCentroid(shadows[0]).area, areaAndCentroid(shadows[1]).area);
  const AreaAndCentroid shared = areaAndCentroid(intersection(shadows[0], shadows[1]));
  if (!((pair.sharedBefore < 0 ? shared.area : pair.sharedBefore) > sliver * smaller))
    return true; // it comes in from the side
  const Real gap = view.height(pair.corners[1], pair.count[1], shared.centroid) -
                   view.height(pair.corners[0], pair.count[0], shared.centroid);
  return gap <= donor.offset + roundOff * std::sqrt(smaller) &&
         isOnSameSurface(donor, pair.faceId, pair.nodes);
}

bool inherit(Plane& plane, const Vec3& normal, const PairNodes& nodes, std::vector<Donor>& donors)
{
  const auto key = [](const Donor& d) { return std::make_pair(d.faceId[0], d.faceId[1]); };
  std::sort(donors.begin(), donors.end(),
            [&](const Donor& a, const Donor& b) { return key(a) < key(b); });
  Real area = 0, bondedArea = 0;
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
    slidesOn = slidesOn || isOnSameSurface(donor, plane.faceId, nodes);
    mean.offset += donor.area * donor.offset;
    mean.maximumClosure += donor.area * donor.maximumClosure;
    mean.closure += donor.area * donor.closure;
    mean.slip += donor.area * donor.slip;
    if (donor.bonded)
    {
      bondedArea += donor.area;
      mean.opening += donor.area * donor.opening;
      mean.shearing += donor.area * donor.shearing;
    }
    mean.shearTraction += donor.area * turnIntoPlane(sign * donor.shearTraction,
                                                     sign * donor.normal, normal, Vec3{}, 0);
  }
  if (!(area > 0))
    return false;
  plane.lineage = slidesOn ? Lineage::SlidesOn : Lineage::Inherited;
  plane.offset = mean.offset / area;
  plane.history.maximumClosure = mean.maximumClosure / area;
  plane.closure = mean.closure / area;
  plane.history.slip = mean.slip / area;
  plane.history.shearTraction = (1 / area) * mean.shearTraction;
  plane.history.bonded = bondedArea > 0.5 * area;
  if (plane.history.bonded)
  {
    plane.history.opening = mean.opening / bondedArea;
    plane.history.shearing = mean.shearing / bondedArea;
  }
  plane.normal = normal;
  return true;
}
} // namespace coplane
