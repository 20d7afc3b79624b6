#include <coplane_contact/Contact.hpp>
#include <coplane_contact/detail/FacePairLanes.hpp>
#include <coplane_contact/detail/NodesOfFace.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_geometry/FaceCorners.hpp>

#include <algorithm>
#include <limits>

namespace coplane
{
namespace
{
/// What step A needs of the first face, or of as many as T has lanes.
template <class T>
void gatherNodes(const Face* faces, const ConstNodeVectors& x, const ConstNodeVectors& v,
                 const ConstArray<Real>& mass, FaceNodesOf<T>& nodes)
{
  nodes.count = faces[0].count;
  for (int k = 0; k < nodes.count; ++k)
  {
    const auto each = [&](const auto& get)
    { return branchFree::gathered<T>([&](int i) { return get(faces[i].nodes[k]); }); };
    const auto vector = [&](const ConstNodeVectors& field) -> Vec3Of<T>
    {
      return {each([&](int node) { return field(node, 0); }),
              each([&](int node) { return field(node, 1); }),
              each([&](int node) { return field(node, 2); })};
    };
    nodes.x[k] = vector(x);
    nodes.v[k] = vector(v);
    nodes.mass[k] = each([&](int node) { return mass(node); });
  }
}

/// With the potential, pairs are candidates up to this depth, as a fraction of the thinner element.
constexpr Real deepestOfPotential = 0.9;
/// By which faces are taken to turn until the next search, at most [rad]: with large skins 2 skin /
/// size bounds nothing.
constexpr Real mostTurning = 0.2;

/// Planes keep the numbers of joint cards and blocks in 16 bits.
void demandFewKinds(const Comm& comm, const std::vector<Face>& faces, const ContactRules& rules)
{
  constexpr std::int64_t most = std::numeric_limits<std::uint16_t>::max();
  std::int64_t blocks = 0;
  for (const Face& face : faces)
    blocks = std::max(blocks, std::int64_t(face.block) + 1);
  blocks = comm.max(blocks);
  const auto demand = [&](std::int64_t count, const char* what, const char* instead)
  {
    if (count > most)
      failOnAllRanks(ExitCode::Deck, "contact of {} {}: at most {} are possible. {}", count, what,
                     most, instead);
  };
  demand(blocks, "element blocks",
         "Put bodies of one material into one block of the mesh: contact tells bodies apart by "
         "their faces, not by their blocks.");
  demand(std::int64_t(rules.joints.size()), "joint laws", "Remove cards that are equal to others.");
}
} // namespace

Contact::Contact(const Comm& comm, int dimension, std::vector<Face> localFaces,
                 ContactOptions options, ContactRules rules, Real skin, Real smallestFace)
    : comm_(&comm), dimension_(dimension), localFaces_(std::move(localFaces)), faces_(localFaces_),
      options_(options), rules_(std::move(rules)), skin_(skin), smallestFace_(smallestFace),
      laws_("coplane::contact::laws", rules_.joints.size())
{
  demandFewKinds(comm, localFaces_, rules_);
  setSkin(skin_);
  candidates_.cosOpposed = options_.cosOpposed;
  // With the potential the force has no end.
  candidates_.depthMax =
      potential() ? std::max(deepestOfPotential, options_.depthMax) : options_.depthMax;
  candidates_.sharedNodes = options_.sharedNodes;
  for (std::size_t j = 0; j < rules_.joints.size(); ++j)
    laws_(j) = rules_.joints[j].law;
}

void Contact::setSkin(Real skin)
{
  candidates_.skin = candidates_.reach = skin;
  // Nodes move by at most half a skin against each other until the next search, so each face turns
  // by at most a skin over its size. What begins to oppose meanwhile should be known.
  candidates_.turning = potential() ? std::min(mostTurning, 2 * skin / smallestFace_) : 0;
}

Real Contact::smallestFaceSize(const std::vector<Face>& faces, const ConstNodeVectors& x,
                               int dimension, const Comm& comm)
{
  Real smallest = infinity;
  for (const Face& face : faces)
  {
    const Real area = norm(cornersAt(x, face).area(dimension));
    smallest = std::min(smallest, faceSize(area, dimension));
  }
  return comm.min(smallest);
}

void Contact::endPlanesOf(const std::vector<GlobalId>& deadElements, const ConstNodeVectors& x,
                          const ConstNodeVectors& v, Real dt)
{
  const auto isDead = [&](GlobalId face)
  { return std::binary_search(deadElements.begin(), deadElements.end(), elementOfFace(face)); };
  const auto halfStep = [&](int face)
  {
    FaceNodes nodes = nodesOf(faces_[face], x);
    for (int k = 0; k < nodes.count; ++k)
    {
      nodes.v[k] = at(v, faces_[face].nodes[k]);
      nodes.mass[k] = 1; // masses matter for damping only
    }
    return stepA_halfStepFace(nodes, dt, dimension_);
  };
  std::vector<std::size_t> kept;
  for (std::size_t p = 0; p < planes_.extent(0); ++p)
  {
    Plane& plane = planes_(p);
    if (!isDead(plane.faceId[0]) && !isDead(plane.faceId[1]))
    {
      kept.push_back(p);
      continue;
    }
    if (!plane.isBorn() || !plane.countedHere)
      continue;
    // What the last force still does in this step belongs to what is lost.
    Real eroded = plane.stored - plane.work;
    if (plane.area > 0)
      bookOldForce(plane, halfStep(plane.face[0]), halfStep(plane.face[1]), dt);
    eroded += plane.work;
    ended_.add(plane, eroded);
  }
  const Kokkos::View<Plane*, Kokkos::HostSpace> next(
      Kokkos::ViewAllocateWithoutInitializing("coplane::contact::planes"), kept.size());
  const Array<Activity> activity("coplane::contact::activity", kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i)
  {
    new (&next(i)) Plane(planes_(kept[i]));
    activity(i) = activity_(kept[i]);
  }
  planes_ = next;
  activity_ = activity;
  todo_ = {}; // the search that has to follow tells the pairs anew
}

void Contact::replaceLocalFaces(std::vector<Face> localFaces)
{
  localFaces_ = std::move(localFaces);
  forceSums_.forgetFaces(); // listed anew with the search that has to follow
}

void Contact::buildLists(int ownedNodes)
{
  halfStepFaces_ = decltype(halfStepFaces_)(
      Kokkos::ViewAllocateWithoutInitializing("coplane::contact::halfStepFaces"), faces_.size());
  paired_ = Array<bool>("coplane::contact::paired", faces_.size());
  slotFaces_ = decltype(slotFaces_)("coplane::contact::slotFaces", planes_.extent(0));
  activity_ = Array<Activity>(Kokkos::ViewAllocateWithoutInitializing("coplane::contact::activity"),
                              planes_.extent(0));
  parallelFor("coplane::contact::slotFaces", int(planes_.extent(0)),
              [&](const int p)
              {
                activity_(p) = activityOf(planes_(p));
                for (int side = 0; side < 2; ++side)
                  slotFaces_(p).face[side] = planes_(p).face[side];
              });
  for (std::size_t p = 0; p < planes_.extent(0); ++p)
    for (const int face : slotFaces_(p).face)
      if (face >= 0)
        paired_(face) = true;
  forceSums_.listPlanes(slotFaces_, localFaces_.size());
  forceSums_.listFaces(localFaces_, ownedNodes);
}

Real Contact::thinnestElement() const
{
  Real least = infinity;
  for (const Face& face : localFaces_)
    least = std::min(least, face.thickness);
  return least;
}

namespace
{
using HalfStepFaces = Kokkos::View<HalfStepFace*, Kokkos::HostSpace>;

/// Step A for one face.
template <int Dim>
KOKKOS_INLINE_FUNCTION void putFace(const FaceNodes& nodes, ContactOptions::Forces forces, Real dt,
                                    HalfStepFace& face)
{
  new (&face) HalfStepFace(forces == ContactOptions::Forces::Potential
                               ? stepA_faceAtEnd<Dim>(nodes)
                               : stepA_halfStepFace<Dim>(nodes, dt));
}

/// Step A for the faces that have a slot; in three dimensions several side by side where they have
/// the same number of nodes.
void stepA(const Array<Face>& faces, const Array<bool>& paired, int dimension,
           const ConstNodeVectors& x, const ConstNodeVectors& v, const ConstArray<Real>& mass,
           ContactOptions::Forces forces, Real dt, const HalfStepFaces& halfStep)
{
  const auto halfStepOf = KOKKOS_LAMBDA(const int f)
  {
    if (!paired(f))
      return;
    FaceNodes nodes;
    gatherNodes(&faces(f), x, v, mass, nodes);
    if (dimension == 2)
      putFace<2>(nodes, forces, dt, halfStep(f));
    else
      putFace<3>(nodes, forces, dt, halfStep(f));
  };
  const int faceCount = int(faces.extent(0));
  parallelFor(
      "coplane::contact::stepA_halfStepFace", (faceCount + laneCount - 1) / laneCount,
      KOKKOS_LAMBDA(const int batch) {
        const int first = batch * laneCount;
        const int last = first + laneCount < faceCount ? first + laneCount : faceCount;
        bool alike = dimension == 3 && last - first == laneCount;
        for (int f = first; f < last; ++f)
          alike = alike && paired(f) && faces(f).count == faces(first).count;
        if (!alike)
        {
          for (int f = first; f < last; ++f)
            halfStepOf(f);
          return;
        }
        FaceNodesOf<Lanes> nodes;
        gatherNodes(&faces(first), x, v, mass, nodes);
        stepA_faces(nodes, forces, dt, &halfStep(first));
      });
}

/// Steps B to H for all slots; in three dimensions several side by side.
void stepsBtoH(const PairTables& pairs, int planeCount, const HalfStepFaces& halfStep,
               int dimension, const ContactOptions& options, Real dt)
{
  if (dimension == 2)
  {
    const Real opposed = leastOpposed(options);
    parallelFor(
        "coplane::contact::stepsBtoH", planeCount, KOKKOS_LAMBDA(const int p) {
          const SlotFaces& faces = pairs.slots[p];
          if (faces.face[0] < 0)
            return;
          Plane& plane = pairs.planes[p];
          const HalfStepFace& a = halfStep(faces.face[0]);
          const HalfStepFace& b = halfStep(faces.face[1]);
          if ((pairs.isAsleep(p) || !(plane.area > 0)) && !mayMeet<2>(a, b, opposed))
          {
            pairs.passBy(p, a, b, dt);
            return;
          }
          pairs.prepare(p);
          const auto before = pairs.passedBy(p);
          updateByForces<2>(plane, a, b, pairs.laws[plane.joint], options, dt);
          pairs.book(p, before);
        });
    return;
  }
  constexpr int stretch = 512; // long enough that few lanes stay empty at its end
  parallelFor(
      "coplane::contact::stepsBtoH", (planeCount + stretch - 1) / stretch,
      KOKKOS_LAMBDA(const int s) {
        const int first = s * stretch;
        const int last = first + stretch < planeCount ? first + stretch : planeCount;
        PairLanes(pairs, halfStep.data(), options, dt).update(first, last);
      });
}
} // namespace

void Contact::step6_updateCommonPlanes(const ConstNodeVectors& x, const ConstNodeVectors& v,
                                       const ConstArray<Real>& mass, Real dt, Real lookAhead)
{
  TimedRegion region("coplane::contact::step6_updateCommonPlanes");
  stepA(faceTable_, paired_, dimension_, x, v, mass, options_.forces, dt, halfStepFaces_);
  ContactOptions options = options_;
  options.lookAhead = lookAhead;
  const PairTables pairs{planes_.data(),
                         slotFaces_.data(),
                         activity_.data(),
                         todo_.data(),
                         preparation_.get(),
                         laws_.data(),
                         options_.closure == ContactOptions::Closure::Incremental,
                         &passedOnHasChanged_};
  stepsBtoH(pairs, int(planes_.extent(0)), halfStepFaces_, dimension_, options, dt);
  if (searchedSinceUpdate_ && searches_ > 1)
    for (std::size_t p = 0; p < planes_.extent(0); ++p)
      if (planes_(p).sighting == Sighting::FoundLate && planes_(p).countedHere &&
          planes_(p).face[0] >= 0)
        missed_ += wasMissed(planes_(p), x);
  searchedSinceUpdate_ = false;
}

bool Contact::wasMissed(const Plane& plane, const ConstNodeVectors& x) const
{
  // Between two searches nodes move by at most half a skin relative to each other, so a face turns
  // by at most skin / size.
  const Face& faceA = faces_[plane.face[0]];
  const Face& faceB = faces_[plane.face[1]];
  return !faceA.young && !faceB.young &&
         hadToBeFound(faceA, faceB, facePlane(faceA, x, dimension_),
                      facePlane(faceB, x, dimension_), candidateRules(), skin_,
                      2 * skin_ / smallestFace_);
}

ContactEnergy Contact::energy() const
{
  PlaneEnergySums mine;
  for (const auto& [kind, sums] : ended_.byKind())
    mine.add(sums);
  for (std::size_t p = 0; p < planes_.extent(0); ++p)
    if (planes_(p).countedHere && planes_(p).isBorn())
      mine.add(planes_(p), planes_(p).stored);
  std::vector<ExactSum> sums(mine.sums.begin(), mine.sums.end());
  return PlaneEnergySums::energyOf(ExactSum::overRanks(sums, *comm_).data());
}

ContactCounts Contact::counts() const
{
  std::vector<std::int64_t> n(8, 0);
  for (std::size_t p = 0; p < planes_.extent(0); ++p)
  {
    const Plane& plane = planes_(p);
    if (!plane.countedHere)
      continue;
    ++n[0];
    n[1] += plane.isBorn();
    n[2] += plane.state == PlaneState::Open;
    n[3] += plane.state == PlaneState::Stick;
    n[4] += plane.state == PlaneState::Slip;
    n[5] += plane.tooDeep;
    n[6] += plane.refusal == Refusal::Deep;
  }
  n[7] = missed_;
  comm_->sum(n);
  return {n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7]};
}
} // namespace coplane
