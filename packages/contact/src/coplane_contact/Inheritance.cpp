#include <coplane_contact/PairLife.hpp>
#include <coplane_contact/PlaneState.hpp>
#include <coplane_contact/detail/DeclaredJoints.hpp>
#include <coplane_contact/detail/EdgesOfSurfaces.hpp>
#include <coplane_contact/detail/Inheritance.hpp>
#include <coplane_geometry/ConvexPolygon.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
bool rests(const Plane& plane)
{
  return !(plane.area > 0) && !(plane.declared && plane.isNew());
}
} // namespace

bool isDonor(const Plane& plane, const JointLaw& law)
{
  return plane.isBorn() &&
         (!rests(plane) || plane.history.absorbed || law.isCrushed(plane.fit, plane.history));
}

Donor donorOf(const Plane& plane)
{
  Donor donor;
  donor.faceId[0] = plane.faceId[0];
  donor.faceId[1] = plane.faceId[1];
  donor.joint = plane.joint;
  donor.normal = plane.normal;
  donor.rests = rests(plane);
  // The overlap of what carries nothing is not looked at in every cycle: all of that count alike.
  donor.area = plane.area > 0 ? plane.area : donor.rests ? 1 : plane.overlap;
  forEachPassed([&](const auto& member) { member.get(donor) = member.get(plane); });
  return donor;
}

void forgetPassed(Plane& plane)
{
  plane.lineage = Lineage::Own;
  plane.normal = {}; // came with the rest
  forEachPassed([&](const auto& member) { member.get(plane) = {}; });
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

/// Of heights, as a fraction of the size of a face.
constexpr Real roundOff = 1e-9;

Real squareToSegment(const Vec2& p, const Vec2& a, const Vec2& b)
{
  const Vec2 along = b - a, off = p - a;
  const Real square = dot(along, along);
  const Real t = square > 0 ? dot(off, along) / square : 0;
  const Vec2 apart = off - std::max(0.0, std::min(1.0, t)) * along;
  return dot(apart, apart);
}

/// Whether no point of one polygon along an axis is within reach of the other.
template <class Coordinate>
bool isApart(const ConvexPolygon& a, const ConvexPolygon& b, Real reach,
             const Coordinate& coordinate)
{
  Real low[2] = {infinity, infinity}, high[2] = {-infinity, -infinity};
  for (int side = 0; side < 2; ++side)
    for (int i = 0; i < (side == 0 ? a : b).size; ++i)
    {
      const Real at = coordinate((side == 0 ? a : b).vertex[i]);
      low[side] = std::min(low[side], at);
      high[side] = std::max(high[side], at);
    }
  return low[0] - high[1] > reach || low[1] - high[0] > reach;
}

/// Whether two convex polygons are not farther from each other than `reach` [m]. An empty one is
/// far from everything.
bool isWithin(Real reach, const ConvexPolygon& a, const ConvexPolygon& b)
{
  if (isApart(a, b, reach, [](const Vec2& p) { return p.x; }) ||
      isApart(a, b, reach, [](const Vec2& p) { return p.y; }))
    return false;
  if (intersection(a, b).size > 0)
    return true;
  Real least = infinity;
  const auto fromCorners = [&](const ConvexPolygon& from, const ConvexPolygon& to)
  {
    for (int i = 0; i < from.size; ++i)
      for (int j = 0, next = 1; j < to.size; ++j, ++next)
        least = std::min(least, squareToSegment(from.vertex[i], to.vertex[j],
                                                to.vertex[next < to.size ? next : 0]));
  };
  fromCorners(a, b);
  fromCorners(b, a);
  return least <= reach * reach;
}
} // namespace

bool isFlush(const NewPair& pair, const Donor& donor, int dimension)
{
  const auto goesOn = [&](int mine, int its)
  {
    const Vec3* const a = pair.corners[1 - mine];
    const Vec3* const b = donor.corners[1 - its];
    const int countA = pair.count[1 - mine], countB = donor.count[1 - its];
    if (countB == 0)
      return false;
    const Vec3 areaA = vectorArea(a, countA, dimension), areaB = vectorArea(b, countB, dimension);
    const Vec3 normal = normalised(areaA);
    if (!(dot(normal, normalised(areaB)) > DirectionsOfNodes::one))
      return false;
    const Real smaller = std::min(norm(areaA), norm(areaB));
    const Real near = EdgesOfSurfaces::flush * faceSize(smaller, dimension);
    Real step = infinity;
    for (int k = 0; k < countB; ++k)
      step = std::min(step, std::abs(dot(normal, b[k] - a[0])));
    const View view(normal, a[0], dimension);
    return step <= near && isWithin(near, view.shadow(a, countA), view.shadow(b, countB));
  };
  return anyCommonFace(pair.faceId, donor, goesOn);
}

Continuation::Continuation(const NewPair& pair, int dimension, Real reach)
    : pair_(pair), view_(pair.normal, pair.corners[0][0], dimension), reach_(reach)
{
  for (int side = 0; side < 2; ++side)
    shadows_[side] = view_.shadow(pair.corners[side], pair.count[side]);
  const Real smaller =
      std::min(areaAndCentroid(shadows_[0]).area, areaAndCentroid(shadows_[1]).area);
  size_ = faceSize(smaller, dimension);
  const AreaAndCentroid shared = areaAndCentroid(intersection(shadows_[0], shadows_[1]));
  fromTheSide_ =
      !((pair.sharedBefore < 0 ? shared.area : pair.sharedBefore) > sliverOfFace * smaller);
  if (fromTheSide_)
    return;
  gap_ = view_.height(pair.corners[1], pair.count[1], shared.centroid) -
         view_.height(pair.corners[0], pair.count[0], shared.centroid);
  roundOff_ = roundOff * size_;
}

bool Continuation::isNear(const Donor& donor) const
{
  const ConvexPolygon carried = intersection(view_.shadow(donor.corners[0], donor.count[0]),
                                             view_.shadow(donor.corners[1], donor.count[1]));
  const bool absorbed = donor.history.absorbed;
  if (donor.rests && !absorbed)
  {
    const Vec2 middle = areaAndCentroid(carried).centroid;
    const Real apart = view_.height(donor.corners[1], donor.count[1], middle) -
                       view_.height(donor.corners[0], donor.count[0], middle);
    if (carried.size == 0 || !(turned(donor.faceId, pair_.faceId) * apart < donor.offset))
      return false;
  }
  const Real reach = absorbed ? std::max(reach_, widestJoint * size_) : reach_;
  return anyCommonFace(pair_.faceId, donor,
                       [&](int mine, int) { return isWithin(reach, carried, shadows_[1 - mine]); });
}

bool Continuation::isLevel(const Donor& donor, Real step) const
{
  return anyCommonFace(
      pair_.faceId, donor,
      [&](int mine, int its)
      {
        const int m = 1 - mine, d = 1 - its;
        const Vec2 between =
            0.5 * (areaAndCentroid(shadows_[m]).centroid +
                   areaAndCentroid(view_.shadow(donor.corners[d], donor.count[d])).centroid);
        return std::abs(view_.height(pair_.corners[m], pair_.count[m], between) -
                        view_.height(donor.corners[d], donor.count[d], between)) <= step;
      });
}

bool Continuation::goesOn(const Donor& donor) const
{
  const bool sameSurface = isOnSameSurface(donor, pair_.faceId, pair_.nodes);
  const bool absorbed = donor.history.absorbed;
  if (absorbed && !donor.ofSameBodies && !sameSurface &&
      !isLevel(donor, std::max(EdgesOfSurfaces::flush * size_, 0.5 * std::abs(donor.offset))))
    return false;
  // A bond holds together what has been bonded: not what is apart.
  const Real above =
      absorbed && donor.ofSameBodies && !donor.history.bonded ? widestJoint * size_ : roundOff_;
  return fromTheSide_ || (gap_ <= std::max(donor.offset, 0.0) + above && sameSurface);
}

namespace
{
/// What donors pass on to a plane with this normal, summed up.
class Inheritance
{
public:
  Inheritance(const Plane& plane, const Vec3& normal) : plane_(plane), normal_(normal) {}

  void add(const Donor& donor)
  {
    area_ += donor.area;
    if (passesBond(donor))
      bondedArea_ += donor.area;
    forEachPassed([&](const auto& member) { add(member, donor); });
  }
  bool isSome() const { return area_ > 0; }
  void giveTo(Plane& plane) const
  {
    forEachPassed([&](const auto& member) { give(member, member.get(plane)); });
  }

private:
  static bool passesBond(const Donor& donor) { return donor.history.bonded && donor.ofSameBodies; }
  bool isBonded() const { return bondedArea_ > 0.5 * area_; }

  template <class Member>
  void add(const Member& member, const Donor& donor)
  {
    const auto& value = member.get(donor);
    auto& sum = member.get(sum_);
    if constexpr (Member::passing == Passing::Turned)
    {
      const Real sign = turned(donor.faceId, plane_.faceId);
      sum += donor.area * turnIntoPlane(sign * value, sign * donor.normal, normal_, Vec3{}, 0);
    }
    else if constexpr (Member::passing == Passing::Any)
      sum = sum || value;
    else if constexpr (Member::passing != Passing::Majority)
      if (Member::passing == Passing::Mean || passesBond(donor))
        sum += donor.area * value;
  }
  template <class Member, class T>
  void give(const Member& member, T& value) const
  {
    if constexpr (Member::passing == Passing::Mean)
      value = member.get(sum_) / area_;
    else if constexpr (Member::passing == Passing::MeanOfBonds)
      value = isBonded() ? member.get(sum_) / bondedArea_ : value;
    else if constexpr (Member::passing == Passing::Turned)
      value = (1 / area_) * member.get(sum_);
    else if constexpr (Member::passing == Passing::Any)
      value = member.get(sum_);
    else
      value = isBonded();
  }

  const Plane& plane_;
  const Vec3 normal_;
  Real area_ = 0, bondedArea_ = 0;
  Donor sum_;
};
} // namespace

bool inherit(Plane& plane, const Vec3& normal, const PairNodes& nodes, std::vector<Donor>& donors)
{
  const auto key = [](const Donor& d) { return std::make_pair(d.faceId[0], d.faceId[1]); };
  std::sort(donors.begin(), donors.end(),
            [&](const Donor& a, const Donor& b) { return key(a) < key(b); });
  donors.erase(std::unique(donors.begin(), donors.end(),
                           [&](const Donor& a, const Donor& b) { return key(a) == key(b); }),
               donors.end());
  const auto gives = [&](const Donor& donor) { return fits(donor, plane, normal); };
  const bool sameBodies =
      std::any_of(donors.begin(), donors.end(),
                  [&](const Donor& donor) { return gives(donor) && donor.ofSameBodies; });
  const auto isAsked = [&](const Donor& donor)
  { return gives(donor) && (donor.ofSameBodies || !sameBodies); };
  const bool carried =
      std::any_of(donors.begin(), donors.end(),
                  [&](const Donor& donor) { return isAsked(donor) && !donor.rests; });
  bool slidesOn = false;
  Inheritance all(plane, normal);
  for (const Donor& donor : donors)
  {
    if (!isAsked(donor) || (carried && donor.rests))
      continue;
    slidesOn = slidesOn || isOnSameSurface(donor, plane.faceId, nodes);
    all.add(donor);
  }
  if (!all.isSome())
    return false;
  plane.lineage = slidesOn ? Lineage::SlidesOn : Lineage::Inherited;
  all.giveTo(plane);
  plane.normal = normal;
  return true;
}
} // namespace coplane
