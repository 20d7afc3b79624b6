#include <coplane_contact/Contact.hpp>
#include <coplane_contact/ContactTables.hpp>
#include <coplane_contact/detail/DeclaredJoints.hpp>
#include <coplane_contact/detail/NodesOfFace.hpp>
#include <coplane_contact/detail/PotentialKernel.hpp>
#include <coplane_geometry/FaceCorners.hpp>

#include <algorithm>
#include <limits>
#include <vector>

namespace coplane
{
namespace
{
Vec3 traction(const SymTensor& s, const Vec3& n)
{
  return {s.xx * n.x + s.xy * n.y + s.zx * n.z, s.xy * n.x + s.yy * n.y + s.yz * n.z,
          s.zx * n.x + s.yz * n.y + s.zz * n.z};
}

/// What two faces share, as the forces see it, and their gap there [m].
struct Overlap
{
  Patch patch;
  Real gap = 0;           ///< its mean
  LinearOnFace uneven[2]; ///< the gap at a place is the mean less these, one for each face
  bool even = true;       ///< but for round-off
};

/// Of two faces in one plane the place between those corners that are nearest to each other.
Vec2 nearestPlace(const Shadow& a, const Shadow& b)
{
  Vec2 place;
  Real least = infinity;
  for (int i = 0; i < a.count; ++i)
    for (int j = 0; j < b.count; ++j)
      if (const Vec2 apart = b.p[j] - a.p[i]; dot(apart, apart) < least)
      {
        least = dot(apart, apart);
        place = 0.5 * (a.p[i] + b.p[j]);
      }
  return place;
}

/// The whole overlap of two faces as the potential sees it; without area, or with little, that of
/// faces beside each other, whose gap is the one where they are nearest to each other.
template <int Dim>
Overlap wholeOverlap(const HalfStepFace& a, const HalfStepFace& b, const ContactOptions& options)
{
  constexpr Real roundOff = 1e-6; // of the size of a face; of coordinates of single precision
  Overlap overlap;
  Patch& patch = overlap.patch;
  PairPotential<Dim, Real> pair(a, b, ContactPotentialScale(options));
  if (!(-dot(a.normal, b.normal) > opposedBesideJoint))
    return overlap;
  pair.meet(0, true, {});
  patch.overlap = pair.overlap * pair.depth;
  pair.oppose(0);
  patch.area = pair.opposedness * pair.moments.area;
  patch.centroid = nearestPlace(pair.shadow[0], pair.shadow[1]);
  overlap.gap = -pair.closureAt(patch.centroid);
  if (patch.area > sliverOfJoint * std::min(a.area, b.area) * pair.depth)
  {
    patch.centroid = (1 / pair.moments.area) * pair.moments.areaMoment;
    overlap.gap = -pair.moments.volume / pair.moments.area;
  }
  for (int f = 0; f < 2; ++f)
    pair.weightsAt(f, patch.centroid, patch.centroidWeights[f]);
  overlap.even = !(pair.unevenGap(patch.centroid, overlap.uneven) >
                   roundOff * faceSize(std::min(a.area, b.area), Dim));
  return overlap;
}

template <int Dim>
Overlap overlapOf(const TrialPlane& trial, const HalfStepFace& a, const HalfStepFace& b,
                  const ContactOptions& options)
{
  if (options.forces == ContactOptions::Forces::Potential)
    return wholeOverlap<Dim>(a, b, options);
  Overlap overlap = wholeOverlap<Dim>(a, b, options); // for what is uneven, which is told
  Patch& patch = overlap.patch;
  patch = stepD_areaOfContact<Dim>(stepC_projectOntoPlane<Dim>(trial, a, 0),
                                   stepC_projectOntoPlane<Dim>(trial, b, 0), 0, AreaInUse::Bonded,
                                   ContactOptions::Weights::Centroid, depthOf(trial, options));
  overlap.gap = dot(trial.normal, weighted(patch.centroidWeights[1], b.x, b.count) -
                                      weighted(patch.centroidWeights[0], a.x, a.count));
  return overlap;
}

SymTensor mean(const SymTensor& a, const SymTensor& b)
{
  return {0.5 * (a.xx + b.xx), 0.5 * (a.yy + b.yy), 0.5 * (a.zz + b.zz),
          0.5 * (a.xy + b.xy), 0.5 * (a.yz + b.yz), 0.5 * (a.zx + b.zx)};
}

/// Closes a plane at its gap, in equilibrium with a stress: closure and shear traction that carry
/// it. The traction on face 1 is minus that of the solid of face 0 across the plane. Returns the
/// compression [Pa].
/// @param pressure that conditions put on both faces, which the plane does not carry [Pa]
/// @param area of its overlap [m^2]
/// @param forces a penalty hardens with the potential
Real closeUnder(const SymTensor& stress, Real pressure, const JointLaw& law, Real area,
                ContactOptions::Forces forces, Plane& plane)
{
  const Vec3 total = traction(stress, plane.normal);
  const Vec3 t = total + pressure * plane.normal; // effective
  const Real compression = -dot(t, plane.normal);
  plane.history.bonded = law.cohesive();
  Real closure = compression > 0        ? law.closureUnder(plane.fit, compression)
                 : plane.history.bonded ? compression / plane.fit.normalStiffness
                                        : 0;
  Real hardened = 1;
  if (law.penalty && forces == ContactOptions::Forces::Potential && !plane.history.bonded)
  {
    closure *= hardenedClosure(closure / plane.depthLimit);
    hardened = HardenedPenalty<Real>(closure / plane.depthLimit).value;
  }
  plane.history.maximumClosure = std::max(closure, 0.0);
  plane.offset += closure;
  plane.closure = closure;
  if (compression > 0 || plane.history.bonded)
  {
    plane.history.shearTraction = Vec3{} - (t + compression * plane.normal);
    plane.area = area;
  }
  // The energy that the initial stress has put into the joint.
  plane.hysteresisWork = plane.area * law.hysteresis(plane.fit, plane.history.maximumClosure);
  plane.stored = plane.area * law.stored(plane.fit, plane.closure, plane.history) +
                 (hardened - 1) * 0.5 * plane.area * plane.fit.normalStiffness * closure * closure;
  plane.work = plane.stored + plane.hysteresisWork;
  return compression;
}

/// What two faces share that lie on each other: the plane of a declared joint.
struct DeclaredPlane
{
  Real area = 0; ///< [m^2], 0 if they do not
  /// With no area, or hardly any: they lie beside each other, as the next faces on both sides of a
  /// joint do, and their gap is uneven. What they come to share is a part of the joint.
  bool beside = false;
  Vec3 normal{};
  Overlap overlap;
  Vec3 pointOfContact{};
};

/// @param covered one of the faces coincides with another one: they lie beside each other at most
template <int Dim>
DeclaredPlane declaredPlane(const FaceNodes& nodesA, const FaceNodes& nodesB, bool covered,
                            const ContactOptions& options)
{
  constexpr Real roundOff = 1e-6; // of a normal
  const HalfStepFace a = stepA_halfStepFace<Dim>(nodesA, 0), b = stepA_halfStepFace<Dim>(nodesB, 0);
  if (covered && norm(a.normal + b.normal) < roundOff)
    return {};
  const TrialPlane trial = stepB_trialPointOfContact<Dim>(a, b);
  if (!trial.opposed)
    return {};
  const Overlap overlap = overlapOf<Dim>(trial, a, b, options);
  const Patch& patch = overlap.patch;
  const Real smaller = std::min(a.area, b.area);
  const Real cosine = dot(a.normal, b.normal), size = faceSize(smaller, Dim);
  const Real depth = depthOf(trial, options).at(patch.centroid.x);
  const Real area = patch.area > options.areaMin * smaller * depth ? patch.area : 0;
  if (area > 0 && !covered && lieOnEachOther(cosine, overlap.gap, size))
    return {area, false, trial.normal, overlap, stepG_placePointOfContact(patch, a, b)};
  if (area > sliverOfJoint * smaller * depth || overlap.even ||
      options.forces != ContactOptions::Forces::Potential ||
      !lieBesideEachOther(cosine, overlap.gap, size))
    return {};
  return {area, true, trial.normal, overlap, 0.5 * (a.center + b.center)};
}

/// Without stress yet.
void declare(const DeclaredPlane& found, Plane& plane)
{
  plane.declared = true;
  plane.state = PlaneState::Open;
  plane.normal = found.normal;
  plane.overlap = found.overlap.patch.overlap;
  plane.pointOfContact = found.pointOfContact;
  plane.gap = found.overlap.gap;
  plane.absorb(plane.gap);
  for (int f = 0; f < 2 && !found.overlap.even; ++f)
    plane.layOn(f, found.overlap.uneven[f]);
}

/// Calls f for the bodies that lie on a face.
template <class Bodies, class F>
void forBodiesOn(const Bodies& bodies, GlobalId face, const F& f)
{
  for (auto one = std::lower_bound(bodies.begin(), bodies.end(), face,
                                   [](const auto&b, GlobalId id) { return b.face < id; });
       one != bodies.end() && one->face == face; ++one)
    f(*one);
}

template <class Bodies>
bool liesOn(const Bodies& bodies, GlobalId face, int body)
{
  bool does = false;
  forBodiesOn(bodies, face, [&](const auto& one) { does = does || one.body == body; });
  return does;
}

/// Whether other bodies lie on both faces, so near and so thin that they lie between: layers that
/// are thin for their faces.
template <class Bodies>
bool haveBodiesBetween(const Bodies& bodies, const Face& a, const Face& b, Real gap)
{
  constexpr Real half = 0.5; // of an element: of a layer as thick as the gap, also if crossed
  const auto isBehindOthers = [&](const Face& face)
  {
    bool is = false;
    forBodiesOn(bodies, face.id,
                [&](const auto& on) {
                  is = is || (on.body != a.body && on.body != b.body &&
                              on.gap + half * on.thickness < gap);
                });
    return is;
  };
  return isBehindOthers(a) && isBehindOthers(b);
}

/// Whether two faces lie on each other corner by corner, as the two sides of a cut do.
bool coincide(const FaceNodes& a, const FaceNodes& b, int dimension)
{
  constexpr Real roundOff = 1e-6; // of the size of a face
  if (a.count != b.count)
    return false;
  FaceCorners corners;
  corners.count = a.count;
  std::copy(a.x, a.x + a.count, corners.x);
  const Vec3 area = corners.area(dimension);
  if (!(dot(area, vectorArea(b.x, b.count, dimension)) < 0))
    return false;
  const Real near = roundOff * faceSize(norm(area), dimension);
  return std::all_of(a.x, a.x + a.count,
                     [&](const Vec3& corner)
                     {
                       return std::any_of(b.x, b.x + b.count,
                                          [&](const Vec3& its)
                                          { return norm(its - corner) <= near; });
                     });
}
} // namespace

std::vector<std::size_t> Contact::declaredSlots() const
{
  std::vector<std::size_t> declared;
  for (std::size_t slot = 0; slot < planes_.count(); ++slot)
  {
    const SlotFaces& pair = planes_.slots().faces(slot);
    if (pair.face[0] >= 0 &&
        rules_.between(faces()[pair.face[0]].group, faces()[pair.face[1]].group).declared)
      declared.push_back(slot);
  }
  return declared;
}

std::vector<Contact::Coinciding>
Contact::coincidingFaces(const ConstNodeVectors& x, const std::vector<std::size_t>& slots) const
{
  std::vector<Coinciding> found;
  std::vector<GlobalId> shared; // faces of pairs that other ranks have, too
  for (const std::size_t slot : slots)
  {
    const SlotFaces& pair = planes_.slots().faces(slot);
    const Face& a = faces()[pair.face[0]];
    const Face& b = faces()[pair.face[1]];
    if (!a.ownedHere || !b.ownedHere)
      shared.insert(shared.end(), {a.id, b.id});
    if (coincide(nodesOf(a, x), nodesOf(b, x), dimension_))
      found.insert(found.end(), {{a.id, b.id}, {b.id, a.id}});
  }
  std::sort(shared.begin(), shared.end());
  std::vector<Coinciding> told;
  for (const Coinciding& one : found)
    if (std::binary_search(shared.begin(), shared.end(), one.face))
      told.push_back(one);
  told = comm_->allGather(told);
  found.insert(found.end(), told.begin(), told.end());
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<Contact::BodyOnFace> Contact::bodiesOn(std::vector<int> asked,
                                                   const std::vector<FacesOnEachOther>& pairs) const
{
  std::vector<GlobalId> here, elsewhere;
  for (const int face : asked)
    (faces()[face].ownedHere ? here : elsewhere).push_back(faces()[face].id);
  const auto sortOut = [](auto& all)
  {
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
  };
  sortOut(elsewhere);
  std::vector<GlobalId> byOthers = comm_->allGather(elsewhere);
  sortOut(byOthers);
  here.insert(here.end(), byOthers.begin(), byOthers.end());
  sortOut(here);
  std::vector<BodyOnFace> found, told;
  for (const FacesOnEachOther& pair : pairs)
    for (int side = 0; side < 2; ++side)
    {
      const Face &face = faces()[pair.face[side]], &other = faces()[pair.face[1 - side]];
      if (!face.ownedHere || !std::binary_search(here.begin(), here.end(), face.id))
        continue;
      found.push_back({face.id, other.body, std::abs(pair.gap), other.thickness});
      if (std::binary_search(byOthers.begin(), byOthers.end(), face.id))
        told.push_back(found.back());
    }
  told = comm_->allGather(told);
  found.insert(found.end(), told.begin(), told.end());
  sortOut(found);
  return found;
}

void Contact::closeJointsOfAdded(const ConstNodeVectors& x, const std::vector<int>& blocks)
{
  closeJoints(x, blocks, [](int, const Vec3&) { return SymTensor{}; });
}

Contact::Overpressed Contact::closeDeclaredJoints(const ConstNodeVectors& x,
                                                  const StressOfBlock& stressOfBlock)
{
  return closeJoints(x, {}, stressOfBlock);
}

Contact::Overpressed Contact::closeJoints(const ConstNodeVectors& x,
                                          const std::vector<int>& addedBlocks,
                                          const StressOfBlock& stressOfBlock)
{
  constexpr Real rounding = 1e-9;
  Overpressed worst;
  const auto strengthOf = [&](int joint)
  { return rules_.joints[std::size_t(joint)].law.curve.crushing.strength; };
  const auto isWorse = [&](const Overpressed& a, const Overpressed& b)
  {
    const Real beyond = a.compression / strengthOf(a.joint),
               other = b.planes > 0 ? b.compression / strengthOf(b.joint) : 0;
    return beyond != other
               ? beyond > other
               : std::pair(a.faceId[0], a.faceId[1]) < std::pair(b.faceId[0], b.faceId[1]);
  };
  const std::vector<std::size_t> slots = declaredSlots();
  // A face that coincides with another one is covered by it: what else is opposed and near, such as
  // the next side of a slender triangle, lies beside it.
  const std::vector<Coinciding> coinciding = coincidingFaces(x, slots);
  const auto isCoveredByOther = [&](GlobalId face, GlobalId other)
  {
    const auto first = std::lower_bound(coinciding.begin(), coinciding.end(),
                                        Coinciding{face, std::numeric_limits<GlobalId>::min()});
    return first != coinciding.end() && first->face == face &&
           !std::binary_search(first, coinciding.end(), Coinciding{face, other});
  };
  const auto close = [&](std::size_t slot, const DeclaredPlane& found)
  {
    const Face& faceA = faces()[planes_.slots().faces(slot).face[0]];
    const Face& faceB = faces()[planes_.slots().faces(slot).face[1]];
    Plane& plane = planes_.wake(slot); // neighbours pass on nothing to what is closed here
    declare(found, plane);
    const Real compression =
        closeUnder(mean(stressOfBlock(faceA.block, plane.pointOfContact),
                        stressOfBlock(faceB.block, plane.pointOfContact)),
                   addedBlocks.empty() ? 0.5 * (faceA.pressure + faceB.pressure) : 0, lawOf(plane),
                   found.area, options_.forces, plane);
    if (!lawOf(plane).curve.crushing.acts() || !plane.countedHere ||
        !(compression > (1 + rounding) * strengthOf(plane.joint)))
      return;
    const Overpressed here{worst.planes + 1,
                           plane.joint,
                           compression,
                           plane.pointOfContact,
                           {plane.faceId[0], plane.faceId[1]}};
    if (isWorse(here, worst))
      worst = here;
    else
      ++worst.planes;
  };
  const auto isAdded = [&](const Face& face)
  { return std::count(addedBlocks.begin(), addedBlocks.end(), face.block) > 0; };
  // Of joints that there were before it is only asked what lies on what.
  const auto isToBeClosed = [&](std::size_t slot, const Face& a, const Face& b)
  {
    if (addedBlocks.empty())
      return true;
    const Plane* const plane = planes_.slots().plane[slot];
    return (isAdded(a) || isAdded(b)) && (plane == nullptr || !plane->isBorn());
  };
  // Whether faces beside each other, or apart, belong to one joint hangs on what lies on them.
  std::vector<std::pair<std::size_t, DeclaredPlane>> doubtful;
  std::vector<FacesOnEachOther> onEachOther;
  for (const std::size_t slot : slots)
  {
    const SlotFaces& pair = planes_.slots().faces(slot);
    const Face& faceA = faces()[pair.face[0]];
    const Face& faceB = faces()[pair.face[1]];
    const bool covered =
        isCoveredByOther(faceA.id, faceB.id) || isCoveredByOther(faceB.id, faceA.id);
    const FaceNodes a = nodesOf(faceA, x), b = nodesOf(faceB, x);
    const DeclaredPlane found = dimension_ == 2 ? declaredPlane<2>(a, b, covered, options_)
                                                : declaredPlane<3>(a, b, covered, options_);
    const bool lie = found.area > 0 && !found.beside;
    if (lie)
      onEachOther.push_back({{pair.face[0], pair.face[1]}, found.overlap.gap});
    if (!isToBeClosed(slot, faceA, faceB))
      continue;
    if (found.beside || (lie && !(std::abs(found.overlap.gap) < rounding * faceA.thickness)))
      doubtful.emplace_back(slot, found);
    else if (lie)
      close(slot, found);
  }
  std::vector<int> asked;
  for (const auto& [slot, found] : doubtful)
    for (const std::int32_t face : planes_.slots().faces(slot).face)
      asked.push_back(face);
  const std::vector<BodyOnFace> bodies = bodiesOn(std::move(asked), onEachOther);
  for (const auto& [slot, found] : doubtful)
  {
    const Face& faceA = faces()[planes_.slots().faces(slot).face[0]];
    const Face& faceB = faces()[planes_.slots().faces(slot).face[1]];
    if (!haveBodiesBetween(bodies, faceA, faceB, found.overlap.gap) &&
        (!found.beside ||
         (liesOn(bodies, faceA.id, faceB.body) && liesOn(bodies, faceB.id, faceA.body))))
      close(slot, found);
  }
  planes_.listWoken();
  planesHaveChanged();
  Overpressed all;
  for (const Overpressed& ofRank : comm_->allGather(std::vector<Overpressed>{worst}))
  {
    const std::int64_t planes = all.planes + ofRank.planes;
    if (ofRank.planes > 0 && isWorse(ofRank, all))
      all = ofRank;
    all.planes = planes;
  }
  return all;
}
} // namespace coplane
