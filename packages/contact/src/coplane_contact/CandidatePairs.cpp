#include <coplane_contact/Search.hpp>
#include <coplane_contact/detail/RadixSort.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_mesh/ElementTopology.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace coplane
{
namespace
{
/// Whether the elements behind two faces have a node in common.
bool shareNode(const Face& a, const Face& b)
{
  int ofA[8], ofB[8];
  for (int k = 0; k < 4; ++k)
  {
    ofA[k] = a.nodes[k];
    ofA[4 + k] = a.far[k];
    ofB[k] = b.nodes[k];
    ofB[4 + k] = b.far[k];
  }
  // Without branches, so that eight are compared at once.
  int same[8] = {};
  for (int j = 0; j < 8; ++j)
    for (int i = 0; i < 8; ++i)
      same[i] |= -int((ofA[i] == ofB[j]) & (ofA[i] >= 0));
  int any = 0;
  for (int i = 0; i < 8; ++i)
    any |= same[i];
  return any != 0;
}

/// Whether every node that the elements behind two faces have in common is a node of both faces.
bool shareNoOtherNode(const Face& a, const Face& b)
{
  const auto node = [](const Face& face, int k) { return k < 4 ? face.nodes[k] : face.far[k - 4]; };
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      if (node(a, i) >= 0 && node(a, i) == node(b, j) && (i >= 4 || j >= 4))
        return false;
  return true;
}

/// How far a pair must be within the bounds of candidates.
struct Margin
{
  Real moved = 0;  ///< [m]
  Real turned = 0; ///< [rad]
};

/// Faces of elements that share a node are neighbours on the surface of one body, or its front and
/// its back where it is thin, and no pair: neighbours on a surface that is crushed until it folds
/// oppose each other, deep in one another. But at the tip of a joint that ends inside a body both
/// faces have the tip's nodes, which are all that their elements have in common: they lie on each
/// other.
bool mayShareNode(const Face& a, const Face& b, const FacePlane& planeA, const FacePlane& planeB,
                  const CandidateRules& rules, const Margin& margin = {})
{
  constexpr Real cosFolded = 0.9;
  if (rules.sharedNodes)
    return true;
  if (!rules.declared || !rules.declared(a.group, b.group) || !shareNoOtherNode(a, b))
    return false;
  const Real near = rules.depthMax * std::min(a.thickness, b.thickness) - margin.moved;
  const Real most =
      margin.turned > 0 ? std::cos(std::max(0.0, std::acos(cosFolded) - margin.turned)) : cosFolded;
  return dot(planeA.normal, planeB.normal) < -most && norm(planeB.center - planeA.center) < near;
}
} // namespace

namespace
{
/// How far nodes of two faces come towards each other along the normal before the next search [m].
Real approach(const Face& a, const Face& b, const Vec3& normal, const CandidateRules& rules)
{
  if (!(rules.motion.ahead > 0))
    return 0;
  const auto most = [&](const Face& face, Real sign)
  {
    Real way = -infinity;
    for (int k = 0; k < face.count; ++k)
      way = std::max(way, sign * dot(normal, rules.way(face.nodes[k], infinity)));
    return way;
  };
  return std::max(0.0, most(a, 1) + most(b, -1));
}
} // namespace

Verdict judgePair(const Face& a, const Face& b, const Box& boxA, const Box& boxB,
                  const FacePlane& planeA, const FacePlane& planeB, const ConstNodeVectors& x,
                  const CandidateRules& rules)
{
  if (!a.local && !b.local)
    return Verdict::BothGhost;
  if (!(dot(planeA.normal, planeB.normal) < rules.mostCosine(planeA, planeB)))
    return Verdict::NotOpposed;
  if (!boxA.overlaps(boxB))
    return Verdict::TooFarApart;
  if (elementOfFace(a.id) == elementOfFace(b.id))
    return Verdict::SameElement;
  if (shareNode(a, b) && !mayShareNode(a, b, planeA, planeB, rules))
    return Verdict::SharedNode;
  if (rules.excluded && rules.excluded(a.group, b.group))
    return Verdict::Excluded;
  const Vec3 n = normalised(planeA.normal - planeB.normal);
  const auto halfExtent = [&](const Face& face, const Vec3& center)
  {
    Real extent = 0;
    for (int k = 0; k < face.count; ++k)
      extent = std::max(extent, std::abs(dot(n, at(x, face.nodes[k]) - center)));
    return extent;
  };
  const Real gap = dot(n, planeB.center - planeA.center);
  const Real extents = halfExtent(a, planeA.center) + rules.beyondNodes(planeA) +
                       halfExtent(b, planeB.center) + rules.beyondNodes(planeB);
  const bool isJoint = rules.jointGap > 0 && rules.declared && rules.declared(a.group, b.group);
  const Real ofJoint = isJoint ? std::min(rules.jointGapOf(a, x), rules.jointGapOf(b, x)) : 0;
  if (gap > std::max(rules.skin + rules.offset, ofJoint) + extents + approach(a, b, n, rules) ||
      gap < -rules.depthMax * std::min(a.thickness, b.thickness) - extents)
    return Verdict::TooFarApart;
  return Verdict::Candidate;
}

bool hadToBeFound(const Face& a, const Face& b, const FacePlane& planeA, const FacePlane& planeB,
                  const CandidateRules& rules, Real moved, Real turned)
{
  const Vec3 n = normalised(planeA.normal - planeB.normal), apart = planeB.center - planeA.center;
  const Real gap = dot(n, apart);
  const Real deepest = rules.depthMax * std::min(a.thickness, b.thickness);
  // The normal of the pair turns with its faces: by that the gap of faces beside each other changes
  // at their centres.
  const Real risen = moved + turned * norm(apart - gap * n);
  return dot(planeA.normal, planeB.normal) < -rules.cosOpposed - turned && gap > risen - deepest &&
         (!shareNode(a, b) || mayShareNode(a, b, planeA, planeB, rules, {moved, turned}));
}

namespace
{
/// Finds candidates in single bins.
struct BinSearch
{
  const std::vector<Face>& faces;
  const std::vector<Box>& boxes;
  const ConstArray<FacePlane>& planes;
  const ConstNodeVectors& x;
  const CandidateRules& rules;

  /// A face while its bin is treated: the tests that refuse most pairs run on these.
  struct BinFace
  {
    Box box;
    Vec3 normal;
    Real turning;
    std::int32_t face;
    std::uint8_t corner;
  };

  /// What judgePair says of two faces whose boxes overlap and whose normals oppose each other. Most
  /// pairs that are left here are near: then nodes need not be looked up.
  bool isCandidate(int p, int q) const
  {
    const Face& a = faces[p];
    const Face& b = faces[q];
    if ((!a.local && !b.local) || elementOfFace(a.id) == elementOfFace(b.id))
      return false;
    if (shareNode(a, b) && !mayShareNode(a, b, planes(p), planes(q), rules))
      return false;
    if (dot(planes(p).normal, planes(q).normal) < rules.mostCosine(planes(p), planes(q)))
    {
      const Vec3 n = normalised(planes(p).normal - planes(q).normal);
      const Real gap = dot(n, planes(q).center - planes(p).center);
      if (gap <= rules.skin && gap >= -rules.depthMax * std::min(a.thickness, b.thickness))
        return !(rules.excluded && rules.excluded(a.group, b.group));
    }
    return judgePair(a, b, boxes[p], boxes[q], planes(p), planes(q), x, rules) ==
           Verdict::Candidate;
  }

  /// Calls found(p, q) for the candidates of one bin, each pair once. A pair that shares several
  /// bins is treated in the lowest one: along each axis that is the first bin of one of both.
  /// `inBin` is memory to use.
  template <class Found>
  void operator()(const BinEntry* begin, const BinEntry* end, std::vector<BinFace>& inBin,
                  const Found& found) const
  {
    inBin.clear();
    const auto take = [&](bool resident)
    {
      for (const BinEntry* e = begin; e != end; ++e)
        if (e->resident == resident)
          inBin.push_back({boxes[e->face], planes(e->face).normal, planes(e->face).turning, e->face,
                           e->corner});
      return inBin.size();
    };
    const std::size_t residents = take(true);
    if (residents == 0)
      return;
    const Real most = rules.mostCosine({}, {});
    const std::size_t all = residents == std::size_t(end - begin) ? residents : take(false);
    for (std::size_t i = 0; i < residents; ++i)
      for (std::size_t j = i + 1; j < all; ++j)
      {
        const BinFace& p = inBin[i];
        const BinFace& q = inBin[j];
        if (!(((p.corner | q.corner) == 7) & p.box.overlaps(q.box) &
              (dot(p.normal, q.normal) < most + p.turning + q.turning)))
          continue;
        if (faces[p.face].id < faces[q.face].id ? isCandidate(p.face, q.face)
                                                : isCandidate(q.face, p.face))
          found(p.face, q.face);
      }
  }
};

/// Places of faces in the order of their ids. Local and ghost faces are in order already, each by
/// themselves.
std::vector<std::int32_t> orderById(const std::vector<Face>& faces)
{
  std::vector<std::int32_t> order(faces.size());
  std::iota(order.begin(), order.end(), 0);
  const auto less = [&](std::int32_t a, std::int32_t b) { return faces[a].id < faces[b].id; };
  const auto middle = std::is_sorted_until(order.begin(), order.end(), less);
  if (!std::is_sorted(middle, order.end(), less))
    std::sort(middle, order.end(), less);
  std::inplace_merge(order.begin(), middle, order.end(), less);
  return order;
}

/// Bins are dealt out in so many shares, for any number of threads.
constexpr int shares = 64;

/// The first entry of a share; entries of one bin stay together.
std::size_t beginOfShare(const std::vector<BinEntry>& entries, int share)
{
  std::size_t border = entries.size() * share / shares;
  while (border > 0 && border < entries.size() && entries[border].key == entries[border - 1].key)
    ++border;
  return border;
}

/// Calls found(face, face) for every pair in the bins of a share.
template <class Found>
void forEachPairOf(const BinEntry* begin, const BinEntry* last, const BinSearch& search,
                   const Found& found)
{
  std::vector<BinSearch::BinFace> inBin;
  while (begin < last)
  {
    const BinEntry* end = begin;
    while (end < last && end->key == begin->key)
      ++end;
    search(begin, end, inBin, found);
    begin = end;
  }
}

/// The pairs of all shares, one share after another.
std::vector<CandidatePair> together(const std::vector<std::vector<CandidatePair>>& ofShares)
{
  std::size_t count = 0;
  for (const auto& some : ofShares)
    count += some.size();
  std::vector<CandidatePair> pairs;
  pairs.reserve(count);
  for (const auto& some : ofShares)
    pairs.insert(pairs.end(), some.begin(), some.end());
  return pairs;
}
} // namespace

std::vector<CandidatePair> step5_candidatePairs(const SortedFaces& sorted,
                                                const std::vector<Face>& faces,
                                                const ConstNodeVectors& x,
                                                const CandidateRules& rules)
{
  const std::vector<std::int32_t> order = orderById(faces);
  std::vector<std::int32_t> rankOf(faces.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    rankOf[order[i]] = std::int32_t(i);

  // Every share collects its own pairs, as places in the order of ids. Sorting by these brings the
  // pairs of all shares into one order.
  const std::vector<BinEntry>& entries = sorted.entries;
  const BinSearch search{faces, sorted.boxes, sorted.planes, x, rules};
  std::vector<std::vector<CandidatePair>> found(shares);
  const auto pairsOfShare = [&](const int share)
  {
    const std::size_t first = beginOfShare(entries, share),
                      beyond = beginOfShare(entries, share + 1);
    std::vector<CandidatePair> mine;
    mine.reserve(2 * (beyond - first));
    forEachPairOf(entries.data() + first, entries.data() + beyond, search,
                  [&](int p, int q)
                  {
                    const int a = rankOf[p], b = rankOf[q];
                    mine.push_back({std::min(a, b), std::max(a, b)});
                  });
    found[share] = std::move(mine);
  };
  parallelForUneven("coplane::contact::step5_candidatePairs", shares, pairsOfShare);

  std::vector<CandidatePair> pairs = together(found);
  const int bits = bitsFor(faces.size());
  radixSort(pairs, 2 * bits,
            [bits](const CandidatePair& pair)
            { return std::uint64_t(pair.lower) << bits | std::uint64_t(pair.higher); });
  parallelFor("coplane::contact::step5_pairs", int(pairs.size()),
              [&](const int p) {
                pairs[p] = {order[pairs[p].lower], order[pairs[p].higher]};
              });
  return pairs;
}
} // namespace coplane
