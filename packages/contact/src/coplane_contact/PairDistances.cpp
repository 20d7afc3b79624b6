#include <coplane_contact/PairDistances.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
/// More than rounding to float changes.
constexpr Real up = 1 + 1e-6, down = 1 - 1e-6;
/// Gaps over the size of a face, and cosines, below that are round-off.
constexpr Real unopposedRoundOff = 1e-7;
/// A normal turns evenly on its way, or nearly so.
constexpr Real onTheWay = 1.5;
/// Heights of the mean plane of a warped face change with those of its nodes and, as much again
/// each, with its warp and with its normal.
constexpr Real perNode = 3;

/// The nodes of a face at one time.
struct Corners
{
  int count = 0;
  Vec3 x[4];

  /// Height of the lowest along n [m].
  Real least(const Vec3& n) const
  {
    Real height = infinity;
    for (int k = 0; k < count; ++k)
      height = std::min(height, dot(n, x[k]));
    return height;
  }
  Vec3 edge(int k) const { return x[k + 1 == count ? 0 : k + 1] - x[k]; }
};

/// A face at the search, and at the end of the way that the search foresaw.
struct FaceOnItsWay
{
  Corners first, last;
  FacePlane plane;
  /// By how much the unit normal changes at most for each metre that nodes stray, over perNode
  /// [1/m].
  Real turningPerMetre = 0;

  FaceOnItsWay() = default;
  FaceOnItsWay(const Face& face, const FacePlane& itsPlane, const PairDistances::Seen& seen)
      : plane(itsPlane)
  {
    first.count = last.count = face.count;
    for (int k = 0; k < face.count; ++k)
    {
      first.x[k] = last.x[k] = at(seen.x, face.nodes[k]);
      if (seen.ahead > 0)
        last.x[k] += seen.ahead * at(seen.v, face.nodes[k]);
    }
    const Real now = turningOf(first), then = turningOf(last);
    turningPerMetre = now < infinity && then < infinity ? std::max(now, then) : infinity;
  }

private:
  static Real turningOf(const Corners& face)
  {
    constexpr Real most = 2.6; // 2 to first order, for a face that does not shrink by more
    const Vec3* const x = face.x;
    if (face.count == 2)
      return most / (perNode * norm(x[1] - x[0]));
    const Vec3 a = x[2] - x[0], b = (face.count == 4 ? x[3] : x[0]) - x[1];
    return most * (norm(a) + norm(b)) / (perNode * norm(cross(a, b)));
  }
};

/// What keeps the faces of a pair from each other. Where they act, points of the second lie against
/// the normal of the pair from those of the first. So they do not where all of the second lies
/// beyond all of the first, along any direction that does not lean against the normal: the normal
/// itself, those of the faces, or one in their plane that leans a little towards it, as the normal
/// turns.
class WhatKeepsApart
{
public:
  WhatKeepsApart(const FaceOnItsWay& a, const FaceOnItsWay& b, const PairDistances::Seen& seen)
      : a_(a), b_(b), seen_(seen), turning_(onTheWay * (a.plane.turning + b.plane.turning)),
        turningPerMetre_(std::max(a.turningPerMetre, b.turningPerMetre)),
        size_(norm(a.first.edge(0)))
  {
  }

  /// They do not oppose each other.
  void lookAtNormals()
  {
    if (turningPerMetre_ == infinity) // one has no area
      return;
    const Real unopposed = dot(a_.plane.normal, b_.plane.normal) + seen_.leastOpposed - turning_;
    if (unopposed > unopposedRoundOff)
      keep(unopposed / turningPerMetre_, 0);
  }
  void lookAtDirections()
  {
    const Vec3 apart = a_.plane.normal - b_.plane.normal;
    const Real size = norm(apart);
    if (isEnough() || size < leastApart)
      return;
    normal_ = (1 / size) * apart;
    // The planes of warped faces lie beyond their nodes, along a normal that leans towards theirs
    // by half the length of their difference.
    less_ = seen_.offset + (a_.plane.warp + b_.plane.warp) /
                               (0.5 * size - std::max(a_.plane.turning, b_.plane.turning));
    for (const Vec3& direction : {normal_, a_.plane.normal, -1.0 * b_.plane.normal})
      if (!isEnough())
        look(direction);
    if (!isEnough())
      lookBeside();
  }

  Real gap() const { return gap_; }         ///< at the search; not positive: nothing does [m]
  Real closing() const { return closing_; } ///< its rate, not positive [m/s]

private:
  /// The normal of a pair turns by the turning of its faces over the length of their difference.
  /// That is at least the root of two while they oppose each other: with leastApart at the search
  /// it is ofTurning times theirs at most.
  static constexpr Real leastApart = 1.26, ofTurning = 0.75;
  /// Of the size of a face: where they are farther apart no further directions are tried.
  static constexpr Real enough = 0.002;

  bool isEnough() const { return kept_ > enough * size_; }
  /// All of the second face lies beyond all of the first along a direction by this [m].
  Real gapAlong(const Vec3& direction) const
  {
    return b_.first.least(direction) + a_.first.least(-1.0 * direction);
  }
  Real lastGapAlong(const Vec3& direction) const
  {
    return b_.last.least(direction) + a_.last.least(-1.0 * direction);
  }
  void keep(Real gap, Real closing)
  {
    gap = down * gap - unopposedRoundOff * size_;
    closing = up * std::min(0.0, closing);
    const Real kept = gap + closing * seen_.ahead;
    if (!(gap > 0) || kept <= kept_)
      return;
    gap_ = gap;
    closing_ = closing;
    kept_ = kept;
  }
  void look(const Vec3& direction)
  {
    const Real lean = dot(direction, normal_), turns = lean - ofTurning * turning_;
    if (!(turns > 0))
      return;
    const Real less = std::min(1.0, 2 * lean) * less_, first = gapAlong(direction) - less;
    if (first > 0)
      keep(std::min(first, turns / (ofTurning * turningPerMetre_)),
           seen_.ahead > 0 ? (lastGapAlong(direction) - less - first) / seen_.ahead : 0);
  }
  /// Along the edge beyond which they are farthest apart.
  void lookBeside()
  {
    Real most = 0;
    Vec3 beside{};
    const Vec3 way = b_.plane.center - a_.plane.center;
    const auto see = [&](const Vec3& direction)
    {
      // A gap is shorter than the way from centre to centre.
      const Real ofWay = dot(direction, way), squared = dot(direction, direction);
      if (!(ofWay > 0) || ofWay * ofWay <= most * most * squared)
        return;
      const Real length = std::sqrt(squared), gap = gapAlong(direction) / length;
      if (!(gap > most))
        return;
      most = gap;
      beside = (1 / length) * direction;
    };
    if (a_.first.count == 2)
      for (const Real side : {-1.0, 1.0})
        see({-side * normal_.y, side * normal_.x, 0});
    else
      for (const Corners* face : {&a_.first, &b_.first})
        for (int k = 0; k < face->count; ++k)
          see(cross(face->edge(k), normal_));
    if (!(most > 0))
      return;
    // It leans as far as lets the normal turn for as long as the gap lasts that is left.
    const Real perTurn = 1 / (ofTurning * turningPerMetre_);
    const Real lean = (most + turning_ / turningPerMetre_) / (perTurn - gapAlong(normal_));
    if (lean > 0 && lean < 1)
      look(normalised(beside + lean * normal_));
  }

  const FaceOnItsWay &a_, &b_;
  const PairDistances::Seen& seen_;
  Real turning_, turningPerMetre_, size_;
  Vec3 normal_{};
  Real less_ = 0;
  Real gap_ = -1, closing_ = 0, kept_ = -infinity;
};
} // namespace

void PairDistances::take(const SlotTable& slots, const Array<Face>& faces,
                         const Array<FacePlane>& planes, const Array<std::uint8_t>& mayReach,
                         const Seen& seen)
{
  slots_ = slots;
  faces_ = faces;
  seen_ = seen;
  mayReach_ = mayReach;
  if (seen_.v.extent(0) == 0)
    seen_.ahead = 0;
  const auto uninitialised = [](const char* name, std::size_t size)
  { return Array<float>(Kokkos::ViewAllocateWithoutInitializing(name), size); };
  gap_ = uninitialised("coplane::contact::gap", slots.extent(0));
  closing_ = uninitialised("coplane::contact::closing", slots.extent(0));
  strayed_ = uninitialised("coplane::contact::strayed", faces.extent(0));
  strayedNodes_ = uninitialised("coplane::contact::strayedNodes", seen.x.extent(0));
  const Kokkos::View<FaceOnItsWay*, Kokkos::HostSpace> ways(
      Kokkos::ViewAllocateWithoutInitializing("coplane::contact::ways"), faces.extent(0));
  parallelFor("coplane::contact::ways", int(faces.extent(0)),
              [&](const int f) { new (&ways(f)) FaceOnItsWay(faces(f), planes(f), seen_); });
  parallelFor("coplane::contact::distances", int(slots.extent(0)),
              [&](const int slot)
              {
                gap_(slot) = -1;
                closing_(slot) = 0;
                const SlotFaces& pair = slots(slot);
                if (pair.face[0] < 0)
                  return;
                const FaceOnItsWay &a = ways(pair.face[0]), &b = ways(pair.face[1]);
                if (std::max(a.plane.turning, b.plane.turning) >= CandidateRules::mostTurningAhead)
                  return;
                WhatKeepsApart kept(a, b, seen_);
                kept.lookAtNormals();
                if (mayReach(slot) == 0)
                  kept.lookAtDirections();
                gap_(slot) = float(kept.gap());
                closing_(slot) = float(kept.closing());
              });
}

void PairDistances::forget()
{
  gap_ = {};
}

void PairDistances::follow(const ConstNodeVectors& x, const ConstNodeVectors& v, Real since,
                           Real lookAhead)
{
  if (!known())
    return;
  const Real now = std::min(since, seen_.ahead), later = std::min(since + lookAhead, seen_.ahead);
  later_ = float(up * later);
  const bool foresaw = seen_.ahead > 0;
  parallelFor("coplane::contact::strayedNodes", int(strayedNodes_.extent(0)),
              [&](const int n)
              {
                // Beside the motion that all share.
                const Vec3 way = at(x, n) - at(seen_.x, n) - since * seen_.frame;
                const Vec3 speed = at(v, n) - seen_.frame;
                const Vec3 foreseen = foresaw ? at(seen_.v, n) - seen_.frame : Vec3{};
                const Vec3 off = way - now * foreseen;
                const Vec3 then = way + lookAhead * speed - later * foreseen;
                strayedNodes_(n) =
                    float(perNode * up * std::sqrt(std::max(dot(off, off), dot(then, then))));
              });
  parallelFor("coplane::contact::strayed", int(faces_.extent(0)),
              [&](const int f)
              {
                const Face& face = faces_(f);
                float most = 0;
                for (int k = 0; k < face.count; ++k)
                  most = std::max(most, strayedNodes_(face.nodes[k]));
                strayed_(f) = most;
              });
}
} // namespace coplane
