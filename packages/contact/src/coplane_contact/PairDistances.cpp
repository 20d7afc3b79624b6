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
  int count;
  Vec3 x[4];

  Corners(const Face& face, const ConstNodeVectors& at0, const ConstNodeVectors& v, Real time)
      : count(face.count)
  {
    for (int k = 0; k < count; ++k)
    {
      x[k] = at(at0, face.nodes[k]);
      if (time > 0)
        x[k] += time * at(v, face.nodes[k]);
    }
  }
  /// By how much the unit normal changes at most for each metre that nodes stray, over perNode
  /// [1/m].
  Real turningPerMetre() const
  {
    constexpr Real most = 2.6; // 2 to first order, for a face that does not shrink on its way
    if (count == 2)
      return most / (perNode * norm(x[1] - x[0]));
    const Vec3 a = x[2] - x[0], b = (count == 4 ? x[3] : x[0]) - x[1];
    return most * (norm(a) + norm(b)) / (perNode * norm(cross(a, b)));
  }
  Real least(const Vec3& n) const
  {
    Real height = infinity;
    for (int k = 0; k < count; ++k)
      height = std::min(height, dot(n, x[k]));
    return height;
  }
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
  const Real ahead = seen_.ahead;
  parallelFor("coplane::contact::distances", int(slots.extent(0)),
              [&](const int slot)
              {
                gap_(slot) = -1;
                closing_(slot) = 0;
                const SlotFaces& pair = slots(slot);
                if (pair.face[0] < 0)
                  return;
                const Face &a = faces(pair.face[0]), &b = faces(pair.face[1]);
                const FacePlane &planeA = planes(pair.face[0]), &planeB = planes(pair.face[1]);
                const Corners firstA(a, seen_.x, seen_.v, 0), firstB(b, seen_.x, seen_.v, 0);
                const Real turning = std::max(planeA.turning, planeB.turning);
                if (turning >= CandidateRules::mostTurningAhead)
                  return;
                const Real unopposed = dot(planeA.normal, planeB.normal) + seen_.leastOpposed -
                                       onTheWay * (planeA.turning + planeB.turning);
                if (unopposed > unopposedRoundOff)
                {
                  gap_(slot) = float(down * unopposed /
                                     std::max(firstA.turningPerMetre(), firstB.turningPerMetre()));
                  return;
                }
                if (mayReach(slot) != 0)
                  return;
                const Vec3 apart = planeA.normal - planeB.normal, n = normalised(apart);
                const Corners lastA(a, seen_.x, seen_.v, ahead), lastB(b, seen_.x, seen_.v, ahead);
                // The planes of warped faces lie beyond their nodes, along a normal that leans
                // towards theirs by half the length of their difference.
                const Real less =
                    seen_.offset + (planeA.warp + planeB.warp) / (0.5 * norm(apart) - turning);
                const Real first = firstB.least(n) + firstA.least(-1.0 * n) - less;
                const Real last = lastB.least(n) + lastA.least(-1.0 * n) - less;
                const Real gap = down * first - unopposedRoundOff * norm(firstA.x[1] - firstA.x[0]);
                if (!(gap > 0))
                  return;
                gap_(slot) = float(gap);
                closing_(slot) = ahead > 0 ? float(up * std::min(0.0, (last - first) / ahead)) : 0;
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
