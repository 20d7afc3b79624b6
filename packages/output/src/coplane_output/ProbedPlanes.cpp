#include <coplane_contact/ContactTables.hpp>
#include <coplane_mesh/ElementTopology.hpp>
#include <coplane_output/detail/ProbedPlanes.hpp>

#include <limits>
#include <optional>

namespace coplane
{
namespace
{
/// The nearest of a rank.
struct Candidate
{
  int wanted; ///< its position
  Real distance, damage;
  Plane plane;
};

bool isNearer(const Candidate& a, const Candidate& b)
{
  return a.distance != b.distance ? a.distance < b.distance : keyLess(a.plane, b.plane);
}

PlaneValues valuesOf(const std::optional<Candidate>& found)
{
  const Plane none;
  const Plane& plane = found ? found->plane : none;
  const auto element = [&](int side)
  { return found ? Real(elementOfFace(plane.faceId[side])) : Real(0); };
  return {{"distance[m]", found ? found->distance : std::numeric_limits<Real>::quiet_NaN()},
          {"state", Real(int(plane.state))},
          {"area[m^2]", plane.area},
          {"gap[m]", plane.gap - plane.offset},
          {"closure[m]", plane.closure},
          {"slip[m]", plane.history.slip},
          {"normal_traction[Pa]", plane.normalTraction},
          {"shear_traction[Pa]", norm(plane.history.shearTraction)},
          {"damage", found ? found->damage : 0},
          {"lower_element", element(0)},
          {"higher_element", element(1)}};
}
} // namespace

std::vector<PlaneValues> nearestPlanes(const Solver& solver, const std::vector<WantedPlane>& wanted)
{
  std::vector<std::vector<Candidate>> toRank(std::size_t(solver.comm().size()));
  if (solver.hasContact())
  {
    const Contact& contact = solver.contact();
    const auto& joints = contact.rules().joints;
    std::vector<std::optional<Candidate>> mine(wanted.size());
    for (std::size_t p = 0; p < contact.planesNow().size(); ++p)
    {
      const Plane& plane = contact.planesNow()[p];
      if (!contact.isWrittenHere(plane) || !isPartOfJoint(contact, plane, solver.state().x))
        continue;
      for (std::size_t w = 0; w < wanted.size(); ++w)
      {
        if (!wanted[w].joint.empty() && joints[plane.joint].name != wanted[w].joint)
          continue;
        const Real distance = norm(plane.pointOfContact - wanted[w].place);
        const Candidate candidate{int(w), distance, contact.lawOf(plane).damage(plane.history),
                                  planeNow(contact, plane, solver.state().x)};
        if (!mine[w] || isNearer(candidate, *mine[w]))
          mine[w] = candidate;
      }
    }
    for (const auto& one : mine)
      if (one)
        toRank[0].push_back(*one);
  }
  std::vector<std::optional<Candidate>> nearest(wanted.size());
  for (const Candidate& candidate : solver.comm().exchange(toRank))
    if (auto& best = nearest[std::size_t(candidate.wanted)]; !best || isNearer(candidate, *best))
      best = candidate;
  std::vector<PlaneValues> values;
  for (const auto& one : nearest)
    values.push_back(valuesOf(one));
  return values;
}
} // namespace coplane
