#include <coplane_contact/Contact.hpp>
#include <coplane_contact/FacePairKernel.hpp>
#include <coplane_core/Timers.hpp>

#include <algorithm>
#include <unordered_map>

namespace coplane
{
namespace
{
std::pair<GlobalId, GlobalId> keyOf(const Plane& plane)
{
  return {plane.faceId[0], plane.faceId[1]};
}

Vec3 traction(const SymTensor& s, const Vec3& n)
{
  return {s.xx * n.x + s.xy * n.y + s.zx * n.z, s.xy * n.x + s.yy * n.y + s.yz * n.z,
          s.zx * n.x + s.yz * n.y + s.zz * n.z};
}
} // namespace

Contact::Contact(const Comm& comm, int dimension, std::vector<Face> localFaces,
                 ContactOptions options, ContactRules rules, Real skin, Real smallestFace)
    : comm_(&comm), dimension_(dimension), localFaces_(std::move(localFaces)), faces_(localFaces_),
      options_(options), rules_(std::move(rules)), skin_(skin), smallestFace_(smallestFace)
{
}

Real Contact::smallestFaceSize(const std::vector<Face>& faces, const ConstNodeVectors& x,
                               int dimension, const Comm& comm)
{
  Real smallest = infinity;
  for (const Face& face : faces)
  {
    Vec3 corners[4];
    for (int k = 0; k < face.count; ++k)
      corners[k] = at(x, face.nodes[k]);
    const Real area = norm(dimension == 2 ? vectorArea<2>(corners, face.count)
                                          : vectorArea<3>(corners, face.count));
    smallest = std::min(smallest, dimension == 2 ? area : std::sqrt(area));
  }
  return comm.min(smallest);
}

FaceNodes Contact::nodesOf(const Face& face, const ConstNodeVectors& x) const
{
  FaceNodes nodes;
  nodes.count = face.count;
  for (int k = 0; k < face.count; ++k)
    nodes.x[k] = at(x, face.nodes[k]);
  return nodes;
}

std::vector<Donor> Contact::livingPlanes() const
{
  std::vector<Donor> donors;
  for (std::size_t p = 0; p < planes_.extent(0); ++p)
  {
    const Plane& plane = planes_(p);
    if (!plane.born || !(plane.area > 0))
      continue;
    Donor donor;
    donor.faceId[0] = plane.faceId[0];
    donor.faceId[1] = plane.faceId[1];
    donor.joint = plane.joint;
    donor.normal = plane.normal;
    donor.area = plane.area;
    donor.offset = plane.offset;
    donor.maximumClosure = plane.history.maximumClosure;
    donor.closure = plane.closure;
    donor.shearTraction = plane.history.shearTraction;
    donor.slip = plane.history.slip;
    donors.push_back(donor);
  }
  return donors;
}

std::vector<GlobalId> Contact::findGhosts(const ConstNodeVectors& x,
                                          const std::vector<GlobalId>& nodeIds)
{
  {
    TimedRegion region("coplane::contact::step1_globalSpaceLimits");
    Real depth = 0;
    for (std::size_t p = 0; p < planes_.extent(0); ++p)
      if (planes_(p).area > 0)
        depth = std::max(depth, -planes_(p).gap);
    reach_ = skin_ + comm_->max(depth);
    bins_ = step1_globalSpaceLimits(localFaces_, x, reach_, *comm_);
  }
  ghosts_ = {};
  std::vector<GlobalId> nodes;
  if (comm_->size() == 1)
    return nodes;
  SortedFaces sorted;
  {
    TimedRegion region("coplane::contact::step2_sortIntoBins");
    sorted = step2_sortIntoBins(bins_, localFaces_, x, reach_);
  }
  std::vector<InteractingRank> ranks;
  {
    TimedRegion region("coplane::contact::step3_interactingRanks");
    ranks = step3_interactingRanks(sorted, *comm_);
  }
  {
    TimedRegion region("coplane::contact::step4_copyGhostFaces");
    ghosts_ = step4_copyGhostFaces(ranks, sorted, localFaces_, nodeIds, livingPlanes(), *comm_);
  }
  for (const GhostFace& face : ghosts_.faces)
    nodes.insert(nodes.end(), face.nodes, face.nodes + face.count);
  return nodes;
}

void Contact::inherit(Plane& plane, const Vec3& normal,
                      const std::map<GlobalId, std::vector<const Donor*>>& donorsOfFace) const
{
  std::vector<const Donor*> donors;
  for (const GlobalId id : plane.faceId)
  {
    const auto found = donorsOfFace.find(id);
    if (found != donorsOfFace.end())
      for (const Donor* donor : found->second)
        if (donor->joint == plane.joint && dot(donor->normal, normal) > 0.9)
          donors.push_back(donor);
  }
  std::sort(donors.begin(), donors.end(),
            [](const Donor* a, const Donor* b)
            {
              return std::make_pair(a->faceId[0], a->faceId[1]) <
                     std::make_pair(b->faceId[0], b->faceId[1]);
            });
  donors.erase(std::unique(donors.begin(), donors.end(),
                           [](const Donor* a, const Donor* b) {
                             return a->faceId[0] == b->faceId[0] && a->faceId[1] == b->faceId[1];
                           }),
               donors.end());
  Real area = 0;
  Donor mean;
  for (const Donor* donor : donors)
  {
    area += donor->area;
    mean.offset += donor->area * donor->offset;
    mean.maximumClosure += donor->area * donor->maximumClosure;
    mean.closure += donor->area * donor->closure;
    mean.slip += donor->area * donor->slip;
    mean.shearTraction +=
        donor->area * turnIntoPlane(donor->shearTraction, donor->normal, normal, Vec3{}, 0);
  }
  if (!(area > 0))
    return;
  plane.inherited = true;
  plane.offset = mean.offset / area;
  plane.history.maximumClosure = mean.maximumClosure / area;
  plane.closure = mean.closure / area;
  plane.history.slip = mean.slip / area;
  plane.history.shearTraction = (1 / area) * mean.shearTraction;
  plane.normal = normal;
}

void Contact::pairUp(const ConstNodeVectors& x, const NodeLayout& layout)
{
  TimedRegion region("coplane::contact::step5_candidatePairs");
  const std::vector<Donor> living = livingPlanes();
  faces_ = localFaces_;
  for (const GhostFace& ghost : ghosts_.faces)
    faces_.push_back(toFace(ghost, [&](GlobalId id) { return layout.localNode(id); }));

  const auto findPlane = [&](GlobalId lower, GlobalId higher)
  {
    const Plane* begin = planes_.data();
    const Plane* end = begin + planes_.extent(0);
    const auto wanted = std::make_pair(lower, higher);
    const Plane* found = std::lower_bound(
        begin, end, wanted, [](const Plane& p, const auto& key) { return keyOf(p) < key; });
    return found != end && keyOf(*found) == wanted ? found : nullptr;
  };

  CandidateRules candidates;
  candidates.skin = skin_;
  candidates.reach = reach_;
  candidates.cosOpposed = options_.cosOpposed;
  candidates.depthMax = options_.depthMax;
  candidates.excluded = [&](int a, int b) { return rules_.between(a, b).excluded; };
  if (searches_ > 0)
    candidates.inContact = [&](GlobalId a, GlobalId b)
    {
      const Plane* plane = findPlane(std::min(a, b), std::max(a, b));
      return plane && plane->area > 0;
    };
  const std::vector<CandidatePair> pairs =
      step5_candidatePairs(bins_, faces_, x, dimension_, candidates);

  // Donors of each face: living planes of this rank and those that came with ghost faces, from
  // before this search.
  std::map<GlobalId, std::vector<const Donor*>> donorsOfFace;
  if (options_.inherit)
    for (const std::vector<Donor>* donors :
         {&living, static_cast<const std::vector<Donor>*>(&ghosts_.donors)})
      for (const Donor& donor : *donors)
        for (const GlobalId id : donor.faceId)
          donorsOfFace[id].push_back(&donor);

  std::vector<Plane> next;
  next.reserve(pairs.size());
  std::vector<char> kept(planes_.extent(0), 0);
  for (const CandidatePair& pair : pairs)
  {
    const Face& a = faces_[pair.lower];
    const Face& b = faces_[pair.higher];
    Plane plane;
    const Plane* existing = findPlane(a.id, b.id);
    if (existing)
    {
      kept[existing - planes_.data()] = 1;
      plane = *existing;
    }
    plane.face[0] = pair.lower;
    plane.face[1] = pair.higher;
    plane.missedSearches = 0;
    if (!existing)
    {
      const ContactRule& rule = rules_.between(a.group, b.group);
      plane.faceId[0] = a.id;
      plane.faceId[1] = b.id;
      plane.joint = rule.joint;
      plane.countedHere = a.ownedHere;
      plane.law =
          rules_.joints[rule.joint].fittedTo(a.thickness, a.modulus, b.thickness, b.modulus);
      plane.depthLimit = options_.depthMax * std::min(a.thickness, b.thickness);
    }
    if (!plane.born && options_.inherit)
    {
      // Slots that have not touched yet look for donors again at every search.
      plane.offset = 0;
      plane.closure = 0;
      plane.inherited = false;
      plane.history = {};
      const FaceNodes nodesA = nodesOf(a, x), nodesB = nodesOf(b, x);
      const TrialPlane trial = dimension_ == 2
                                   ? stepB_trialPointOfContact<2>(stepA_halfStepFace<2>(nodesA, 0),
                                                                  stepA_halfStepFace<2>(nodesB, 0))
                                   : stepB_trialPointOfContact<3>(stepA_halfStepFace<3>(nodesA, 0),
                                                                  stepA_halfStepFace<3>(nodesB, 0));
      inherit(plane, trial.normal, donorsOfFace);
    }
    next.push_back(plane);
  }

  // Planes that are no candidates now: kept dormant for two searches, joints for ever; their energy
  // is booked at their end.
  const std::size_t active = next.size();
  for (std::size_t p = 0; p < planes_.extent(0); ++p)
  {
    if (kept[p] || !planes_(p).born)
      continue;
    Plane plane = planes_(p);
    plane.face[0] = plane.face[1] = -1;
    plane.missedSearches = std::uint8_t(std::min(255, plane.missedSearches + 1));
    if (plane.declared || plane.missedSearches < 2)
    {
      plane.area = plane.overlap = plane.normalTraction = plane.stored = 0;
      plane.force = {};
      plane.history.shearTraction = {};
      plane.state = PlaneState::Open;
      for (int f = 0; f < 2; ++f)
        for (int k = 0; k < 4; ++k)
        {
          plane.cornerForce[f][k] = {};
          plane.cornerStiffness[f][k] = 0;
        }
      next.push_back(plane);
    }
    else if (plane.countedHere)
    {
      endedWork_.add(plane.work);
      endedFriction_.add(plane.frictionWork);
      endedHysteresis_.add(plane.hysteresisWork);
      endedDamping_.add(plane.dampingWork);
    }
  }
  std::inplace_merge(next.begin(), next.begin() + active, next.end(), keyLess);

  planes_ = Kokkos::View<Plane*, Kokkos::HostSpace>(
      Kokkos::ViewAllocateWithoutInitializing("coplane::contact::planes"), next.size());
  std::copy(next.begin(), next.end(), planes_.data());
  faceTable_ = Array<Face>(Kokkos::ViewAllocateWithoutInitializing("coplane::contact::faces"),
                           faces_.size());
  std::copy(faces_.begin(), faces_.end(), faceTable_.data());
  buildGather(layout.owned());
  ++searches_;
  searchedSinceUpdate_ = true;
}

void Contact::buildGather(int ownedNodes)
{
  std::vector<std::int64_t> start(ownedNodes + 1, 0);
  const auto forEachEntry = [&](const auto& visit)
  {
    for (std::size_t p = 0; p < planes_.extent(0); ++p)
      for (int f = 0; f < 2; ++f)
      {
        if (planes_(p).face[f] < 0)
          continue;
        const Face& face = faces_[planes_(p).face[f]];
        for (int k = 0; k < face.count; ++k)
          if (face.nodes[k] < ownedNodes)
            visit(face.nodes[k], std::int64_t(p) * 8 + f * 4 + k);
      }
  };
  forEachEntry([&](int node, std::int64_t) { ++start[node + 1]; });
  for (int n = 0; n < ownedNodes; ++n)
    start[n + 1] += start[n];
  cornerLoads_ =
      CornerLoads(Kokkos::ViewAllocateWithoutInitializing("coplane::contact::cornerLoads"),
                  8 * planes_.extent(0));
  loaded_ = Array<bool>("coplane::contact::loaded", planes_.extent(0));
  gatherStart_ = Array<std::int64_t>("coplane::contact::gatherStart", ownedNodes + 1);
  gatherEntry_ = Array<std::int64_t>("coplane::contact::gatherEntry", start.back());
  std::copy(start.begin(), start.end(), gatherStart_.data());
  // Planes are visited in the order of their keys, so each node's list is in that order on every
  // rank.
  forEachEntry([&](int node, std::int64_t entry) { gatherEntry_(start[node]++) = entry; });
}

void Contact::closeDeclaredJoints(const ConstNodeVectors& x,
                                  const std::vector<SymTensor>& stressOfBlock)
{
  ContactOptions whole = options_;
  whole.area = ContactOptions::Area::Full;
  whole.weights = ContactOptions::Weights::Centroid;
  const auto patchOf = [&](const TrialPlane& trial, const HalfStepFace& a, const HalfStepFace& b)
  {
    // With an offset beyond every gap the whole overlap counts as closed.
    const Real beyond = 10 * (skin_ + norm(b.center - a.center)) + std::sqrt(a.area + b.area);
    return dimension_ == 2
               ? stepD_areaOfContact<2>(stepC_projectOntoPlane<2>(trial, a),
                                        stepC_projectOntoPlane<2>(trial, b), beyond, whole)
               : stepD_areaOfContact<3>(stepC_projectOntoPlane<3>(trial, a),
                                        stepC_projectOntoPlane<3>(trial, b), beyond, whole);
  };
  for (std::size_t p = 0; p < planes_.extent(0); ++p)
  {
    Plane& plane = planes_(p);
    if (plane.face[0] < 0)
      continue;
    const Face& faceA = faces_[plane.face[0]];
    const Face& faceB = faces_[plane.face[1]];
    if (!rules_.between(faceA.group, faceB.group).declared)
      continue;
    const FaceNodes nodesA = nodesOf(faceA, x), nodesB = nodesOf(faceB, x);
    const HalfStepFace a =
        dimension_ == 2 ? stepA_halfStepFace<2>(nodesA, 0) : stepA_halfStepFace<3>(nodesA, 0);
    const HalfStepFace b =
        dimension_ == 2 ? stepA_halfStepFace<2>(nodesB, 0) : stepA_halfStepFace<3>(nodesB, 0);
    const TrialPlane trial =
        dimension_ == 2 ? stepB_trialPointOfContact<2>(a, b) : stepB_trialPointOfContact<3>(a, b);
    if (!trial.opposed)
      continue;
    const Patch patch = patchOf(trial, a, b);
    if (!(patch.area > options_.areaMin * std::min(a.area, b.area)))
      continue;
    plane.declared = true;
    plane.born = true;
    plane.state = PlaneState::Open;
    plane.normal = trial.normal;
    plane.overlap = patch.overlap;
    plane.pointOfContact = stepG_placePointOfContact(patch, a, b);
    plane.gap = dot(trial.normal, weighted(patch.centroidWeights[1], b.x, b.count) -
                                      weighted(patch.centroidWeights[0], a.x, a.count));
    // The joint is in equilibrium with the initial stress: closure and shear traction that carry
    // it. The traction on face 1 is minus that of the solid of face 0 across the plane.
    SymTensor stress = stressOfBlock[faceA.block];
    const SymTensor& other = stressOfBlock[faceB.block];
    stress = {0.5 * (stress.xx + other.xx), 0.5 * (stress.yy + other.yy),
              0.5 * (stress.zz + other.zz), 0.5 * (stress.xy + other.xy),
              0.5 * (stress.yz + other.yz), 0.5 * (stress.zx + other.zx)};
    const Vec3 t = traction(stress, trial.normal);
    const Real compression = -dot(t, trial.normal);
    const Real closure = plane.law.closureUnder(compression);
    plane.history.maximumClosure = closure;
    plane.offset = plane.gap + closure;
    plane.closure = closure;
    if (compression > 0)
      plane.history.shearTraction = Vec3{} - (t + compression * trial.normal);
    plane.area = compression > 0 ? patch.area : 0;
    // The energy that the initial stress has put into the joint.
    plane.hysteresisWork = plane.area * plane.law.hysteresisWork(closure);
    plane.stored =
        plane.area * 0.5 * compression * compression / plane.law.loadingStiffness(closure);
    if (plane.law.shearStiffness > 0)
      plane.stored += plane.area * 0.5 *
                      dot(plane.history.shearTraction, plane.history.shearTraction) /
                      plane.law.shearStiffness;
    plane.work = plane.stored + plane.hysteresisWork;
  }
}

void Contact::step6_updateCommonPlanes(const ConstNodeVectors& x, const ConstNodeVectors& v,
                                       const ConstArray<Real>& mass, Real dt)
{
  TimedRegion region("coplane::contact::step6_updateCommonPlanes");
  const auto planes = planes_;
  const auto faces = faceTable_;
  const auto loads = cornerLoads_;
  const auto loaded = loaded_;
  const ContactOptions options = options_;
  const int dimension = dimension_;
  parallelFor(
      "coplane::contact::step6_updateCommonPlanes", int(planes.extent(0)),
      KOKKOS_LAMBDA(const int p) {
        Plane& plane = planes(p);
        loaded(p) = false;
        if (plane.face[0] < 0)
          return;
        FaceNodes nodes[2];
        for (int f = 0; f < 2; ++f)
        {
          const Face& face = faces(plane.face[f]);
          nodes[f].count = face.count;
          for (int k = 0; k < face.count; ++k)
          {
            nodes[f].x[k] = at(x, face.nodes[k]);
            nodes[f].v[k] = at(v, face.nodes[k]);
            nodes[f].mass[k] = mass(face.nodes[k]);
          }
        }
        if (dimension == 2)
          updatePlane<2>(plane, nodes[0], nodes[1], options, dt);
        else
          updatePlane<3>(plane, nodes[0], nodes[1], options, dt);
        // Forces once more in a compact table, for the sums at the nodes.
        bool any = false;
        for (int c = 0; c < 8; ++c)
        {
          const Vec3& force = plane.cornerForce[c / 4][c % 4];
          const Real stiffness = plane.cornerStiffness[c / 4][c % 4];
          any = any || stiffness > 0 || dot(force, force) > 0;
          loads(8 * p + c, 0) = force.x;
          loads(8 * p + c, 1) = force.y;
          loads(8 * p + c, 2) = force.z;
          loads(8 * p + c, 3) = stiffness;
        }
        loaded(p) = any;
      });
  if (searchedSinceUpdate_ && searches_ > 1)
    for (std::size_t p = 0; p < planes_.extent(0); ++p)
      if (planes_(p).foundLate && planes_(p).countedHere && planes_(p).face[0] >= 0)
        missed_ += wasMissed(planes_(p), x);
  searchedSinceUpdate_ = false;
}

bool Contact::wasMissed(const Plane& plane, const ConstNodeVectors& x) const
{
  // Between two searches nodes move by at most half a skin relative to each other, so a face turns
  // by at most skin / size. A pair whose normals were not opposed enough, or that was too deep, at
  // the last search became a candidate by turning or rising: the search has not missed it.
  const Face& faceA = faces_[plane.face[0]];
  const Face& faceB = faces_[plane.face[1]];
  const FacePlane a = facePlane(faceA, x, dimension_);
  const FacePlane b = facePlane(faceB, x, dimension_);
  const Real turn = 2 * skin_ / smallestFace_;
  const Real gap = dot(plane.normal, b.center - a.center);
  const Real deepest = options_.depthMax * std::min(faceA.thickness, faceB.thickness);
  return dot(a.normal, b.normal) < -options_.cosOpposed - turn && gap > skin_ - deepest;
}

void Contact::addForces(const NodeVectors& f, const Array<Real>& stiffness) const
{
  const auto loads = cornerLoads_;
  const auto loaded = loaded_;
  const auto start = gatherStart_;
  const auto entries = gatherEntry_;
  parallelFor(
      "coplane::contact::addForces", int(start.extent(0)) - 1, KOKKOS_LAMBDA(const int node) {
        Vec3 force = at(f, node);
        Real sum = 0;
        for (std::int64_t i = start(node); i < start(node + 1); ++i)
        {
          const std::int64_t entry = entries(i);
          if (!loaded(entry / 8))
            continue;
          force += {loads(entry, 0), loads(entry, 1), loads(entry, 2)};
          sum += loads(entry, 3);
        }
        set(f, node, force);
        stiffness(node) = sum;
      });
}

ContactEnergy Contact::energy() const
{
  std::vector<ExactSum> sums(5);
  sums[0] = endedWork_;
  sums[2] = endedFriction_;
  sums[3] = endedHysteresis_;
  sums[4] = endedDamping_;
  for (std::size_t p = 0; p < planes_.extent(0); ++p)
  {
    const Plane& plane = planes_(p);
    if (!plane.countedHere || !plane.born)
      continue;
    sums[0].add(plane.work);
    sums[1].add(plane.stored);
    sums[2].add(plane.frictionWork);
    sums[3].add(plane.hysteresisWork);
    sums[4].add(plane.dampingWork);
  }
  const std::vector<Real> totals = ExactSum::overRanks(sums, *comm_);
  ContactEnergy energy;
  energy.work = totals[0];
  energy.stored = totals[1];
  energy.friction = totals[2];
  energy.hysteresis = totals[3];
  energy.damping = totals[4];
  return energy;
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
    n[1] += plane.born;
    n[2] += plane.state == PlaneState::Open;
    n[3] += plane.state == PlaneState::Stick;
    n[4] += plane.state == PlaneState::Slip;
    n[5] += plane.tooDeep;
    n[6] += plane.released;
  }
  n[7] = missed_;
  comm_->sum(n);
  return {n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7]};
}

ContactCensus Contact::census() const
{
  ContactCensus census;
  std::vector<std::int64_t> n(5, 0);
  std::vector<Real> extremes(
      5,
      -infinity); // -least gap, largest gap, deepest overlap, -least stiffness, largest stiffness
  for (std::size_t p = 0; p < planes_.extent(0); ++p)
  {
    const Plane& plane = planes_(p);
    if (!plane.countedHere || plane.face[0] < 0)
      continue;
    ++n[0];
    extremes[3] = std::max(extremes[3], -plane.law.initialStiffness);
    extremes[4] = std::max(extremes[4], plane.law.initialStiffness);
    const bool joint =
        rules_.between(faces_[plane.face[0]].group, faces_[plane.face[1]].group).declared;
    if (plane.declared)
    {
      ++n[1];
      extremes[0] = std::max(extremes[0], -plane.gap);
      extremes[1] = std::max(extremes[1], plane.gap);
    }
    else if (joint)
      ++n[2];
    else if (plane.foundLate)
    {
      ++n[3];
      extremes[2] = std::max(extremes[2], -plane.gap);
    }
    else
      ++n[4];
  }
  comm_->sum(n);
  comm_->max(extremes);
  census.pairs = n[0];
  census.declaredClosed = n[1];
  census.declaredWithoutOverlap = n[2];
  census.overlapping = n[3];
  census.apart = n[4];
  census.leastGap = -extremes[0];
  census.largestGap = extremes[1];
  census.deepestOverlap = std::max(0.0, extremes[2]);
  census.leastStiffness = -extremes[3];
  census.largestStiffness = std::max(0.0, extremes[4]);
  return census;
}
} // namespace coplane
