#include <coplane_contact/Search.hpp>
#include <coplane_contact/detail/RadixSort.hpp>

#include <algorithm>
#include <unordered_map>

namespace coplane
{
namespace
{
Box boxOf(const Face& face, const ConstNodeVectors& x)
{
  Box box;
  for (int k = 0; k < face.count; ++k)
    box.include(at(x, face.nodes[k]));
  return box;
}

/// How far a face may move in the time that a search looks ahead [m].
Real farthest(const Box& box, const Face& face)
{
  return 4 * (box.longestSide() + face.thickness);
}

/// Keys of bins in few bits: each index counts from the least one here. The order stays.
class ShortKeys
{
public:
  ShortKeys(const Bins& bins, const Box& all)
  {
    const int levels = int(bins.levels.size());
    bits_ = bitsFor(levels - 1);
    for (int c = 0; c < 3; ++c)
    {
      std::int32_t least = bins.indexOf(all.low, 0)[c], largest = least;
      for (int level = 0; level < levels; ++level)
      {
        least = std::min(least, bins.indexOf(all.low, level)[c]);
        largest = std::max(largest, bins.indexOf(all.high, level)[c]);
      }
      // Where indices pass a multiple of 2^19, keys start again from zero.
      const bool oneTurn = (least & ~Bins::keyMask) == (largest & ~Bins::keyMask);
      least_[c] = oneTurn ? least & Bins::keyMask : 0;
      width_[c] = bitsFor(oneTurn ? largest - least : Bins::keyMask);
      bits_ += width_[c];
    }
  }
  int bits() const { return bits_; }
  std::uint64_t operator()(const BinEntry& entry) const
  {
    std::uint64_t code = entry.key >> 57;
    for (int c = 0; c < 3; ++c)
      code = code << width_[c] |
             (((entry.key >> (38 - 19 * c)) & std::uint64_t(Bins::keyMask)) - least_[c]);
    return code;
  }

private:
  int bits_ = 0;
  int width_[3];
  std::uint64_t least_[3];
};
} // namespace

Real CandidateRules::jointGapOf(const Face& face, const ConstNodeVectors& x) const
{
  if (!(jointGap > 0))
    return 0;
  const Box box = boxOf(face, x);
  return jointGap * norm(box.high - box.low);
}

Box contactBox(const Face& face, const FacePlane& plane, const ConstNodeVectors& x,
               const CandidateRules& rules)
{
  Box box = boxOf(face, x);
  if (rules.motion.ahead > 0)
  {
    const Real longest = farthest(box, face);
    for (int k = 0; k < face.count; ++k)
      box.include(at(x, face.nodes[k]) + rules.way(face.nodes[k], longest));
  }
  const Vec3 inside = -rules.depthInto(face, plane) * plane.normal;
  for (int c = 0; c < 3; ++c)
    (inside[c] < 0 ? box.low : box.high)[c] += inside[c];
  box.grow(0.5 * (rules.reach + rules.jointGapOf(face, x)) + rules.beyondNodes(plane));
  return box;
}

Vec3 commonVelocity(const std::vector<Face>& faces, const ConstNodeVectors& v, const Comm& comm)
{
  std::vector<Real> extremes(6, -infinity); // -least, largest
  for (const Face& face : faces)
    for (int k = 0; k < face.count; ++k)
      for (int c = 0; c < 3; ++c)
      {
        extremes[c] = std::max(extremes[c], -v(face.nodes[k], c));
        extremes[3 + c] = std::max(extremes[3 + c], v(face.nodes[k], c));
      }
  comm.max(extremes);
  Vec3 frame{};
  for (int c = 0; c < 3; ++c)
    if (std::abs(extremes[c]) < infinity && std::abs(extremes[3 + c]) < infinity)
      frame[c] = 0.5 * extremes[3 + c] - 0.5 * extremes[c];
  return frame;
}

Bins step1_globalSpaceLimits(const std::vector<Face>& faces, const ConstNodeVectors& x,
                             const CandidateRules& rules, const Comm& comm)
{
  const int chunks = threadCount();
  std::vector<Box> boxes(chunks);
  std::vector<SizeHistogram> histograms(chunks);
  forEachChunk("coplane::contact::step1_globalSpaceLimits", faces.size(), chunks,
               [&](int chunk, std::size_t begin, std::size_t end)
               {
                 Box all;
                 SizeHistogram& histogram = histograms[chunk];
                 for (std::size_t f = begin; f < end; ++f)
                 {
                   const Box box = boxOf(faces[f], x);
                   all.include(box);
                   if (faces[f].ownedHere)
                     histogram.add(box.longestSide() + rules.depthInto(faces[f], {}));
                 }
                 boxes[chunk] = all;
               });
  for (int chunk = 1; chunk < chunks; ++chunk)
  {
    boxes[0].include(boxes[chunk]);
    histograms[0].add(histograms[chunk]);
  }
  const Box& all = boxes[0];
  std::vector<Real> extremes{-all.low.x, -all.low.y, -all.low.z,
                             all.high.x, all.high.y, all.high.z};
  comm.max(extremes);
  comm.sum(histograms[0].counts);

  Bins bins;
  bins.limits.low = {-extremes[0], -extremes[1], -extremes[2]};
  bins.limits.high = {extremes[3], extremes[4], extremes[5]};
  bins.levels = histograms[0].levels(rules.reach, bins.limits.longestSide());
  return bins;
}

SortedFaces step2_sortIntoBins(const Bins& bins, const std::vector<Face>& faces,
                               const ConstNodeVectors& x, int dimension,
                               const CandidateRules& rules)
{
  SortedFaces sorted;
  sorted.bins = bins;
  sorted.boxes.resize(faces.size());
  sorted.planes = facePlanes(faces.data(), faces.size(), x, dimension, rules);
  std::vector<std::uint8_t> levelOf(faces.size());
  const int levels = int(bins.levels.size());
  const int chunks = faces.size() < 1024 ? 1 : threadCount();
  std::vector<Box> all(chunks);
  std::vector<std::size_t> firstEntry(chunks + 1, 0);
  forEachChunk("coplane::contact::step2_countBins", faces.size(), chunks,
               [&](int chunk, std::size_t begin, std::size_t end)
               {
                 std::size_t count = 0;
                 Box together;
                 for (std::size_t f = begin; f < end; ++f)
                 {
                   if (faces[f].isCut())
                   {
                     levelOf[f] = std::uint8_t(levels);
                     continue;
                   }
                   levelOf[f] = std::uint8_t(bins.levelOf(boxOf(faces[f], x).longestSide() +
                                                          rules.depthInto(faces[f], {})));
                   const Box box = contactBox(faces[f], sorted.planes(f), x, rules);
                   sorted.boxes[f] = box;
                   together.include(box);
                   for (int level = levelOf[f]; level < levels; ++level)
                     count += countBins(bins, level, box);
                 }
                 all[chunk] = together;
                 firstEntry[chunk + 1] = count;
               });
  for (int chunk = 0; chunk < chunks; ++chunk)
  {
    firstEntry[chunk + 1] += firstEntry[chunk];
    all[0].include(all[chunk]);
  }
  sorted.entries.resize(firstEntry[chunks]);
  forEachChunk(
      "coplane::contact::step2_sortIntoBins", faces.size(), chunks,
      [&](int chunk, std::size_t begin, std::size_t end)
      {
        BinEntry* entry = sorted.entries.data() + firstEntry[chunk];
        for (std::size_t f = begin; f < end; ++f)
          for (int level = levelOf[f]; level < levels; ++level)
            forEachBin(
                bins, level, sorted.boxes[f],
                [&](const Bins::Index& bin, std::uint8_t corner) {
                  *entry++ = {Bins::key(level, bin), std::int32_t(f), corner, level == levelOf[f]};
                });
      });
  if (!sorted.entries.empty())
  {
    const ShortKeys keys(bins, all[0]);
    radixSort(sorted.entries, keys.bits(), keys);
  }
  return sorted;
}

std::vector<InteractingRank> step3_interactingRanks(const SortedFaces& sorted, const Comm& comm)
{
  Box mine;
  for (const Box& box : sorted.boxes)
    mine.include(box);
  const std::vector<Box> boxes = comm.allGather(std::vector<Box>{mine});

  // A message holds twice the key of each bin, plus one where a face is resident. Bins without a
  // resident on either side have no pair: those faces meet in bins of a finer level.
  std::vector<std::vector<std::uint64_t>> send(comm.size());
  for (int r = 0; r < comm.size(); ++r)
    if (r != comm.rank() && mine.overlaps(boxes[r]))
      for (const BinEntry& entry : sorted.entries)
        if (sorted.boxes[entry.face].overlaps(boxes[r]))
        {
          if (send[r].empty() || send[r].back() >> 1 != entry.key)
            send[r].push_back(entry.key << 1);
          send[r].back() |= std::uint64_t(entry.resident);
        }
  std::vector<int> counts;
  const std::vector<std::uint64_t> received = comm.exchange(send, &counts);

  std::vector<InteractingRank> ranks;
  auto theirs = received.begin();
  for (int r = 0; r < comm.size(); ++r)
  {
    InteractingRank other;
    other.rank = r;
    other.box = boxes[r];
    const auto end = theirs + counts[r];
    for (const std::uint64_t bin : send[r])
    {
      while (theirs != end && *theirs >> 1 < bin >> 1)
        ++theirs;
      if (theirs != end && *theirs >> 1 == bin >> 1 && ((*theirs | bin) & 1))
        other.commonBins.push_back(bin >> 1);
    }
    theirs = end;
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
  if (!ranks.empty())
    for (int p = 0; p < int(livingPlanes.size()); ++p)
      for (const GlobalId id : livingPlanes[p].faceId)
        planesOfFace[id].push_back(p);

  std::vector<std::vector<GhostFace>> facesTo(comm.size());
  std::vector<std::vector<Donor>> donorsTo(comm.size());
  std::vector<char> chosen(localFaces.size(), 0);
  std::vector<int> selected;
  for (const InteractingRank& other : ranks)
  {
    auto bin = other.commonBins.begin();
    for (const BinEntry& entry : sorted.entries)
    {
      while (bin != other.commonBins.end() && *bin < entry.key)
        ++bin;
      if (bin == other.commonBins.end())
        break;
      if (*bin == entry.key && localFaces[entry.face].ownedHere && !chosen[entry.face] &&
          sorted.boxes[entry.face].overlaps(other.box))
      {
        chosen[entry.face] = 1;
        selected.push_back(entry.face);
      }
    }
    for (const int f : selected)
    {
      chosen[f] = 0;
      facesTo[other.rank].push_back(toGhostFace(localFaces[f], nodeIds));
      const auto found = planesOfFace.find(localFaces[f].id);
      if (found != planesOfFace.end())
        for (const int p : found->second)
          donorsTo[other.rank].push_back(livingPlanes[p]);
    }
    selected.clear();
  }

  Ghosts ghosts;
  for (const GhostFace& face : comm.exchange(facesTo))
    if (!hasFace(localFaces, face.id))
      ghosts.faces.push_back(face);
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
} // namespace coplane
