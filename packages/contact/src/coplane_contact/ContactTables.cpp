#include <coplane_contact/ContactTables.hpp>
#include <coplane_contact/detail/DeclaredJoints.hpp>
#include <coplane_geometry/FaceCorners.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
/// A face where its nodes are now.
struct Extent
{
  Vec3 normal; ///< of length 1, or 0 where it has no area
  Real area;   ///< [m^2]
};

Extent extentOf(const Contact& contact, int face, const ConstNodeVectors& x)
{
  const FaceCorners corners = cornersAt(x, contact.faces()[face]);
  const Vec3 area = corners.area(contact.dimension());
  const Real around = contact.options().axisymmetric ? 2 * pi * corners.center().x : 1;
  return {normalised(area), norm(area) * around};
}

/// Area of the faces of a plane when they met over that now, as the forces have it [-].
/// @param extent by face
template <class ExtentOf>
Real materialArea(const Plane& plane, const ExtentOf& extent)
{
  if (plane.face[0] < 0 || !(plane.birthArea[0] > 0))
    return 1;
  Real sum = 0;
  for (int side = 0; side < 2; ++side)
    sum += plane.birthArea[side] / extent(plane.face[side]).area;
  return sum > 0 && sum < infinity ? 0.5 * sum : 1;
}

/// @param extent by face
template <class ExtentOf>
bool facesOpposeEachOther(const Plane& plane, const ExtentOf& extent)
{
  return plane.face[0] >= 0 &&
         dot(extent(plane.face[0]).normal, extent(plane.face[1]).normal) < -opposedAcrossJoint;
}

/// @param extent by face
template <class ExtentOf>
bool facesLieOverEachOther(const Plane& plane, const ExtentOf& extent)
{
  return plane.overlap > 0 && facesOpposeEachOther(plane, extent) &&
         plane.overlap >
             sliverOfJoint * std::min(extent(plane.face[0]).area, extent(plane.face[1]).area);
}
} // namespace

bool isPartOfJoint(const Contact& contact, const Plane& plane, const ConstNodeVectors& x)
{
  return facesLieOverEachOther(plane, [&](int face) { return extentOf(contact, face, x); });
}

Plane planeNow(const Contact& contact, const Plane& plane, const ConstNodeVectors& x)
{
  Plane now = plane;
  if (!(plane.area > 0))
    return now;
  const Real part = materialArea(plane, [&](int face) { return extentOf(contact, face, x); });
  now.area /= part;
  now.normalTraction *= part;
  now.history.shearTraction = part * plane.history.shearTraction;
  return now;
}

std::vector<JointSummary> jointSummaries(const Contact& contact, const ConstNodeVectors& x)
{
  enum Sum
  {
    Open,
    Stick,
    Slip,
    Closure,
    Force,
    Energies,
    PerJoint = Energies + PlaneEnergySums::Terms
  };
  struct Sums
  {
    ExactSums sums; ///< PerJoint of each joint
    std::vector<Real> largestSlip;

    void add(const Sums& other)
    {
      sums.add(other.sums);
      for (std::size_t j = 0; j < largestSlip.size(); ++j)
        largestSlip[j] = std::max(largestSlip[j], other.largestSlip[j]);
    }
  };
  const std::size_t joints = contact.rules().joints.size();
  const Sums none{{std::vector<ExactSum>(PerJoint * joints)}, std::vector<Real>(joints, 0)};
  const Array<Extent> extents(Kokkos::ViewAllocateWithoutInitializing("coplane::contact::extents"),
                              contact.faces().size());
  parallelFor("coplane::contact::extents", int(extents.size()),
              [&](const int face) { extents(face) = extentOf(contact, face, x); });
  const Contact::Shown shown =
      contact.planesNow([&](const Plane& plane) { return facesOpposeEachOther(plane, extents); });
  const PlaneList& planes = shown.list;
  const auto take = [&](Sums& all, std::size_t p)
  {
    planes.prefetchAfter(p);
    const Plane& plane = planes[p];
    if (!plane.countedHere || !plane.isBorn())
      return;
    ExactSum* mine = &all.sums[PerJoint * plane.joint];
    mine[Force].add(plane.area * plane.normalTraction);
    if (!facesLieOverEachOther(plane, extents))
      return;
    mine[Open].add(plane.overlap);
    if (plane.state != PlaneState::Open)
    {
      const Real area = plane.area / materialArea(plane, extents);
      mine[Open].add(-area);
      mine[plane.state == PlaneState::Slip ? Slip : Stick].add(area);
      mine[Closure].add(area * plane.closure);
    }
    all.largestSlip[plane.joint] = std::max(all.largestSlip[plane.joint], plane.history.slip);
  };
  Sums all = sumInParts("coplane::contact::jointSummaries", planes.size(), none, take);
  const auto addEnergies = [&](std::size_t joint, const PlaneEnergySums& energies)
  {
    for (int term = 0; term < PlaneEnergySums::Terms; ++term)
      all.sums[PerJoint * joint + Energies + std::size_t(term)].add(
          energies.sums[std::size_t(term)]);
  };
  for (const auto& [kind, ended] : contact.ended().byKind())
    addEnergies(std::size_t(kind.joint), ended);
  for (std::size_t j = 0; j < joints; ++j)
    addEnergies(j, contact.tally().energies[j]);
  const std::vector<Real> totals = ExactSum::overRanks(all.sums.each, contact.comm());
  contact.comm().max(all.largestSlip);

  std::vector<JointSummary> summaries(joints);
  for (std::size_t j = 0; j < joints; ++j)
  {
    const Real* total = &totals[PerJoint * j];
    JointSummary& summary = summaries[j];
    summary.openArea = total[Open];
    summary.stickArea = total[Stick];
    summary.slipArea = total[Slip];
    const Real closed = summary.stickArea + summary.slipArea;
    summary.meanClosure = closed > 0 ? total[Closure] / closed : 0;
    summary.largestSlip = all.largestSlip[j];
    summary.normalForce = total[Force];
    summary.energy = PlaneEnergySums::energyOf(total + Energies);
  }
  return summaries;
}

std::vector<ContactTableRow> contactTable(const Contact& contact, const ConstNodeVectors& x)
{
  struct Row
  {
    PlaneEnergySums energies;
    ExactSum area;
    std::int64_t planes = 0;
  };
  std::map<PlaneKind, Row> mine;
  for (const auto& [kind, ended] : contact.ended().byKind())
    mine[kind].energies.add(ended);
  for (std::size_t p = 0; p < contact.planes().size(); ++p)
  {
    const Plane& plane = contact.planes()[p];
    if (!plane.countedHere || !plane.isBorn())
      continue;
    Row& row = mine[PlaneKind(plane)];
    row.energies.add(plane, plane.stored);
    if (plane.area > 0)
      row.area.add(plane.area /
                   materialArea(plane, [&](int face) { return extentOf(contact, face, x); }));
    ++row.planes;
  }
  // The kinds of all ranks.
  std::vector<PlaneKind> kinds;
  for (const auto& [kind, row] : mine)
    kinds.push_back(kind);
  kinds = contact.comm().allGather(kinds);
  std::sort(kinds.begin(), kinds.end());
  kinds.erase(std::unique(kinds.begin(), kinds.end()), kinds.end());

  constexpr std::size_t perKind = PlaneEnergySums::Terms + 1;
  std::vector<ExactSum> sums;
  std::vector<std::int64_t> planes;
  for (const PlaneKind& kind : kinds)
  {
    const auto found = mine.find(kind);
    const Row row = found == mine.end() ? Row{} : found->second;
    sums.insert(sums.end(), row.energies.sums.begin(), row.energies.sums.end());
    sums.push_back(row.area);
    planes.push_back(row.planes);
  }
  std::vector<ContactTableRow> rows;
  if (kinds.empty())
    return rows;
  const std::vector<Real> totals = ExactSum::overRanks(sums, contact.comm());
  contact.comm().sum(planes);
  for (std::size_t k = 0; k < kinds.size(); ++k)
    rows.push_back({kinds[k], planes[k], totals[perKind * k + PlaneEnergySums::Terms],
                    PlaneEnergySums::energyOf(&totals[perKind * k])});
  return rows;
}
} // namespace coplane
