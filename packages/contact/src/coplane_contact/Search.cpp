#include <coplane_contact/FacePairSteps.hpp>
#include <coplane_contact/Search.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_mesh/ElementTopology.hpp>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace coplane
{
void Box::include(const Vec3& p)
{
  for (int c = 0; c < 3; ++c)
  {
    low[c] = std::min(low[c], p[c]);
    high[c] = std::max(high[c], p[c]);
  }
}

void Box::grow(Real by)
{
  low -= {by, by, by};
  high += {by, by, by};
}

bool Box::overlaps(const Box& other) const
{
  for (int c = 0; c < 3; ++c)
    if (low[c] > other.high[c] || other.low[c] > high[c])
      return false;
  return true;
}

Bins::Index Bins::indexOf(const Vec3& p) const
{
  Index index;
  for (int c = 0; c < 3; ++c)
    index[c] = std::int32_t(std::clamp(std::floor((p[c] - limits.low[c]) / edge), -1.0e6, 1.0e6));
  return index;
}

std::uint64_t Bins::key(const Index& index)
{
  std::uint64_t k = 0;
  for (int c = 0; c < 3; ++c)
    k = (k << 21) | std::uint64_t(index[c] + (1 << 20));
  return k;
}

namespace
{
Box boxOf(const Face& face, const ConstNodeVectors& x)
{
  Box box;
  for (int k = 0; k < face.count; ++k)
    box.include(at(x, face.nodes[k]));
  return box;
}

Real longestSide(const Box& box)
{
  return std::max({box.high.x - box.low.x, box.high.y - box.low.y, box.high.z - box.low.z});
}

template <class Visit>
void forEachBin(const std::array<Bins::Index, 2>& range, const Visit& visit)
{
  Bins::Index i;
  for (i[0] = range[0][0]; i[0] <= range[1][0]; ++i[0])
    for (i[1] = range[0][1]; i[1] <= range[1][1]; ++i[1])
      for (i[2] = range[0][2]; i[2] <= range[1][2]; ++i[2])
        visit(i);
}
} // namespace

Bins step1_globalSpaceLimits(const std::vector<Face>& faces, const ConstNodeVectors& x, Real reach,
                             const Comm& comm)
{
  // Histogram of face sizes in steps of 2^(1/4): integer counts have the same sum on any number of
  // ranks.
  constexpr int classes = 512;
  std::vector<std::int64_t> histogram(classes, 0);
  const auto classOf = [](Real size)
  {
    return std::clamp(int(std::floor(4 * std::log2(std::max(size, 1e-30)))) + classes / 2, 0,
                      classes - 1);
  };
  Box all;
  for (const Face& face : faces)
  {
    const Box box = boxOf(face, x);
    all.include(box.low);
    all.include(box.high);
    if (face.ownedHere)
      ++histogram[classOf(longestSide(box))];
  }
  std::vector<Real> extremes{-all.low.x, -all.low.y, -all.low.z,
                             all.high.x, all.high.y, all.high.z};
  comm.max(extremes);
  comm.sum(histogram);

  Bins bins;
  bins.limits.low = {-extremes[0], -extremes[1], -extremes[2]};
  bins.limits.high = {extremes[3], extremes[4], extremes[5]};
  std::int64_t total = 0, count = 0;
  for (const std::int64_t n : histogram)
    total += n;
  int percentile = 0;
  while (percentile + 1 < classes && (count += histogram[percentile]) * 10 < total * 9)
    ++percentile;
  bins.edge = std::exp2((percentile + 1 - classes / 2) / 4.0) * 1.5 + reach;
  // At most 2^20 bins along an axis, for the keys.
  bins.edge = std::max(bins.edge, (longestSide(bins.limits) + 4 * reach) / (1 << 19));
  if (!(bins.edge > 0) || !(bins.edge < infinity))
    bins.edge = 1;
  return bins;
}

SortedFaces step2_sortIntoBins(const Bins& bins, const std::vector<Face>& faces,
                               const ConstNodeVectors& x, Real reach)
{
  SortedFaces sorted;
  sorted.bins = bins;
  sorted.boxes.reserve(faces.size());
  sorted.ranges.reserve(faces.size());
  for (int f = 0; f < int(faces.size()); ++f)
  {
    Box box = boxOf(faces[f], x);
    box.grow(0.5 * reach);
    sorted.boxes.push_back(box);
    sorted.ranges.push_back({bins.indexOf(box.low), bins.indexOf(box.high)});
    forEachBin(sorted.ranges.back(),
               [&](const Bins::Index& i) { sorted.entries.emplace_back(Bins::key(i), f); });
  }
  std::sort(sorted.entries.begin(), sorted.entries.end());
  return sorted;
}

std::vector<InteractingRank> step3_interactingRanks(const SortedFaces& sorted, const Comm& comm)
{
  Box mine;
  for (const Box& box : sorted.boxes)
  {
    mine.include(box.low);
    mine.include(box.high);
  }
  const std::vector<Box> boxes = comm.allGather(std::vector<Box>{mine});
  std::vector<std::uint64_t> occupied;
  for (const auto& entry : sorted.entries)
    if (occupied.empty() || occupied.back() != entry.first)
      occupied.push_back(entry.first);

  std::vector<std::vector<std::uint64_t>> send(comm.size());
  for (int r = 0; r < comm.size(); ++r)
    if (r != comm.rank() && mine.overlaps(boxes[r]))
      send[r] = occupied;
  std::vector<int> counts;
  const std::vector<std::uint64_t> received = comm.exchange(send, &counts);

  std::vector<InteractingRank> ranks;
  auto begin = received.begin();
  for (int r = 0; r < comm.size(); ++r)
  {
    InteractingRank other;
    other.rank = r;
    std::set_intersection(begin, begin + counts[r], occupied.begin(), occupied.end(),
                          std::back_inserter(other.commonBins));
    begin += counts[r];
    if (!other.commonBins.empty())
      ranks.push_back(std::move(other));
  }
  return ranks;
}

Ghosts step4_copyGhostFaces(const std::vector<InteractingRank>& ranks, const SortedFaces& sorted,
                            const std::vector<Face>& localFaces,
                            const std::vector<GlobalId>& nodeIds,
                            const std::vector<Donor>& livingPlanes, const Comm& comm)
{
  std::unordered_map<GlobalId, std::vector<int>> planesOfFace;
  for (int p = 0; p < int(livingPlanes.size()); ++p)
    for (const GlobalId id : livingPlanes[p].faceId)
      planesOfFace[id].push_back(p);

  std::vector<std::vector<GhostFace>> facesTo(comm.size());
  std::vector<std::vector<Donor>> donorsTo(comm.size());
  for (const InteractingRank& other : ranks)
  {
    std::vector<int> selected;
    auto bin = other.commonBins.begin();
    for (const auto& [key, f] : sorted.entries)
    {
      while (bin != other.commonBins.end() && *bin < key)
        ++bin;
      if (bin == other.commonBins.end())
        break;
      if (*bin == key && localFaces[f].ownedHere)
        selected.push_back(f);
    }
    std::sort(selected.begin(), selected.end());
    selected.erase(std::unique(selected.begin(), selected.end()), selected.end());
    for (const int f : selected)
    {
      const Face& face = localFaces[f];
      GhostFace ghost;
      ghost.id = face.id;
      ghost.count = face.count;
      ghost.block = face.block;
      ghost.thickness = face.thickness;
      ghost.modulus = face.modulus;
      for (int k = 0; k < face.count; ++k)
        ghost.nodes[k] = nodeIds[face.nodes[k]];
      facesTo[other.rank].push_back(ghost);
      const auto found = planesOfFace.find(face.id);
      if (found != planesOfFace.end())
        for (const int p : found->second)
          donorsTo[other.rank].push_back(livingPlanes[p]);
    }
  }

  Ghosts ghosts;
  for (const GhostFace& face : comm.exchange(facesTo))
  {
    const auto known = std::lower_bound(localFaces.begin(), localFaces.end(), face.id,
                                        [](const Face& f, GlobalId id) { return f.id < id; });
    if (known == localFaces.end() || known->id != face.id)
      ghosts.faces.push_back(face);
  }
  std::sort(ghosts.faces.begin(), ghosts.faces.end(),
            [](const GhostFace& a, const GhostFace& b) { return a.id < b.id; });
  ghosts.donors = comm.exchange(donorsTo);
  const auto key = [](const Donor& d) { return std::make_pair(d.faceId[0], d.faceId[1]); };
  std::sort(ghosts.donors.begin(), ghosts.donors.end(),
            [&](const Donor& a, const Donor& b) { return key(a) < key(b); });
  ghosts.donors.erase(std::unique(ghosts.donors.begin(), ghosts.donors.end(),
                                  [&](const Donor& a, const Donor& b) { return key(a) == key(b); }),
                      ghosts.donors.end());
  return ghosts;
}

FacePlane facePlane(const Face& face, const ConstNodeVectors& x, int dimension)
{
  FaceNodes nodes;
  nodes.count = face.count;
  for (int k = 0; k < face.count; ++k)
    nodes.x[k] = at(x, face.nodes[k]);
  const HalfStepFace now =
      dimension == 2 ? stepA_halfStepFace<2>(nodes, 0) : stepA_halfStepFace<3>(nodes, 0);
  return {now.center, now.normal};
}

Verdict judgePair(const Face& a, const Face& b, const Box& boxA, const Box& boxB,
                  const FacePlane& planeA, const FacePlane& planeB, const ConstNodeVectors& x,
                  const CandidateRules& rules)
{
  if (!a.local && !b.local)
    return Verdict::BothGhost;
  const Real cosine = dot(planeA.normal, planeB.normal);
  if (!(cosine < 0))
    return Verdict::NotOpposed;
  if (!boxA.overlaps(boxB))
    return Verdict::TooFarApart;
  if (elementOfFace(a.id) == elementOfFace(b.id))
    return Verdict::SameElement;
  // Faces of one body that share a node are neighbours on its surface.
  for (int i = 0; i < a.count; ++i)
    for (int j = 0; j < b.count; ++j)
      if (a.nodes[i] == b.nodes[j])
        return Verdict::SharedNode;
  if (rules.excluded && rules.excluded(a.block, b.block))
    return Verdict::Excluded;
  Verdict verdict = Verdict::Candidate;
  if (!(cosine < -rules.cosOpposed))
    verdict = Verdict::NotOpposed;
  else
  {
    const Vec3 n = normalised(planeA.normal - planeB.normal);
    const auto halfExtent = [&](const Face& face, const Vec3& center)
    {
      Real extent = 0;
      for (int k = 0; k < face.count; ++k)
        extent = std::max(extent, std::abs(dot(n, at(x, face.nodes[k]) - center)));
      return extent;
    };
    const Real gap = dot(n, planeB.center - planeA.center);
    const Real extents = halfExtent(a, planeA.center) + halfExtent(b, planeB.center);
    if (gap > rules.skin + extents ||
        gap < -rules.depthMax * std::min(a.thickness, b.thickness) - extents)
      verdict = Verdict::TooFarApart;
  }
  // Planes that carry traction stay candidates while their faces oppose each other at all.
  if (verdict != Verdict::Candidate && rules.inContact && rules.inContact(a.id, b.id))
    verdict = Verdict::Candidate;
  return verdict;
}

std::vector<CandidatePair> step5_candidatePairs(const Bins& bins, const std::vector<Face>& faces,
                                                const ConstNodeVectors& x, int dimension,
                                                const CandidateRules& rules)
{
  const SortedFaces sorted = step2_sortIntoBins(bins, faces, x, std::max(rules.skin, rules.reach));
  std::vector<FacePlane> facePlanes;
  facePlanes.reserve(faces.size());
  for (const Face& face : faces)
    facePlanes.push_back(facePlane(face, x, dimension));
  // Bins in a fixed number of shares; every share collects its own pairs, and the order comes from
  // sorting by key.
  constexpr int shares = 64;
  const std::size_t entries = sorted.entries.size();
  const auto borderOfShare = [&](int share)
  {
    std::size_t border = entries * share / shares;
    while (border > 0 && border < entries &&
           sorted.entries[border].first == sorted.entries[border - 1].first)
      ++border;
    return border;
  };
  std::vector<std::vector<CandidatePair>> found(shares);
  const auto pairsOfShare = [&](const int share)
  {
    const std::size_t last = borderOfShare(share + 1);
    for (std::size_t begin = borderOfShare(share); begin < last;)
    {
      const std::uint64_t key = sorted.entries[begin].first;
      std::size_t end = begin;
      while (end < last && sorted.entries[end].first == key)
        ++end;
      for (std::size_t i = begin; i < end; ++i)
        for (std::size_t j = i + 1; j < end; ++j)
        {
          int p = sorted.entries[i].second, q = sorted.entries[j].second;
          if (!(dot(facePlanes[p].normal, facePlanes[q].normal) < 0))
            continue;
          // Two faces may share several bins; the pair is treated in the lowest one.
          Bins::Index lowest;
          for (int c = 0; c < 3; ++c)
            lowest[c] = std::max(sorted.ranges[p][0][c], sorted.ranges[q][0][c]);
          if (Bins::key(lowest) != key)
            continue;
          if (faces[p].id > faces[q].id)
            std::swap(p, q);
          if (judgePair(faces[p], faces[q], sorted.boxes[p], sorted.boxes[q], facePlanes[p],
                        facePlanes[q], x, rules) == Verdict::Candidate)
            found[share].push_back({p, q});
        }
      begin = end;
    }
  };
  parallelFor("coplane::contact::step5_candidatePairs", shares, pairsOfShare);
  std::vector<CandidatePair> pairs;
  for (const auto& some : found)
    pairs.insert(pairs.end(), some.begin(), some.end());
  std::sort(pairs.begin(), pairs.end(),
            [&](const CandidatePair& a, const CandidatePair& b)
            {
              return std::make_pair(faces[a.lower].id, faces[a.higher].id) <
                     std::make_pair(faces[b.lower].id, faces[b.higher].id);
            });
  return pairs;
}
} // namespace coplane
