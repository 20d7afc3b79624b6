#include <coplane_output/detail/ProbedElements.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace coplane
{
namespace
{
const std::vector<std::string> stresses{"stress_xx", "stress_yy", "stress_zz",
                                        "stress_xy", "stress_yz", "stress_zx"};

/// Mean of the corners.
template <class PlaceOf>
Vec3 middleOf(const RankMesh::Block& part, int element, const PlaceOf& placeOf)
{
  const int corners = topology(part.type).nodes;
  Vec3 middle{};
  for (int k = 0; k < corners; ++k)
    middle += (1.0 / corners) * placeOf(part.connectivity[std::size_t(element * corners + k)]);
  return middle;
}

/// Whether this rank has what is nearest; of equals the lowest id. Collective.
bool isNearest(const Comm& comm, Real distance, GlobalId id)
{
  const bool mayBe = distance == comm.min(distance) && distance < infinity;
  return mayBe & (comm.min(mayBe ? std::int64_t(id) : std::numeric_limits<std::int64_t>::max()) ==
                  std::int64_t(id));
}
} // namespace

std::optional<Real> elementVariable(const ElementBlock& block, int element, const std::string& name)
{
  const auto stress = std::find(stresses.begin(), stresses.end(), name);
  if (stress != stresses.end())
    return block.stress()(stress - stresses.begin(), element);
  if (name == "von_mises")
    return block.vonMises(element);
  if (name == "pressure")
    return block.pressure(element);
  if (name == "density")
    return block.density(element);
  const int row = block.historyRow(name);
  if (row < 0)
    return std::nullopt;
  return block.history()(row, element);
}

std::string unitOfVariable(const std::string& name)
{
  if (name == "density")
    return "[kg/m^3]";
  const bool isStress = name == "von_mises" || name == "pressure" ||
                        std::find(stresses.begin(), stresses.end(), name) != stresses.end();
  return isStress ? "[Pa]" : "";
}

int nearestNode(const Solver& solver, const Vec3& point)
{
  const RankMesh& mesh = solver.mesh();
  const std::vector<GlobalId>& ids = solver.layout().ids();
  Real least = infinity;
  int nearest = -1;
  for (int n = 0; n < mesh.ownedNodes; ++n)
  {
    const Real distance = norm(mesh.coordinates[std::size_t(n)] - point);
    if (distance < least || (distance == least && ids[std::size_t(n)] < ids[std::size_t(nearest)]))
    {
      least = distance;
      nearest = n;
    }
  }
  const GlobalId id = nearest < 0 ? 0 : ids[std::size_t(nearest)];
  return isNearest(solver.comm(), least, id) ? nearest : -1;
}

ProbedElement nearestElement(const Solver& solver, const Vec3& point)
{
  const RankMesh& mesh = solver.mesh();
  const auto atStart = [&](int node) { return mesh.coordinates[std::size_t(node)]; };
  Real least = infinity;
  GlobalId lowest = 0;
  ProbedElement nearest;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    for (int e = 0; e < mesh.blocks[b].elements(); ++e)
    {
      if (!mesh.blocks[b].owned[std::size_t(e)])
        continue;
      const GlobalId id = mesh.blocks[b].elementIds[std::size_t(e)];
      const Real distance = norm(middleOf(mesh.blocks[b], e, atStart) - point);
      if (distance < least || (distance == least && id < lowest))
      {
        least = distance;
        lowest = id;
        nearest = {int(b), e};
      }
    }
  return isNearest(solver.comm(), least, lowest) ? nearest : ProbedElement{};
}

std::vector<Extreme> extremesOf(const Solver& solver, int b,
                                const std::vector<std::string>& variables)
{
  const Comm& comm = solver.comm();
  const RankMesh::Block& part = solver.mesh().blocks[std::size_t(b)];
  const ElementBlock& block = solver.blocks()[std::size_t(b)];
  const std::size_t count = 2 * variables.size();
  // Largest of minus the value and of the value, and the lowest id with it.
  std::vector<Real> most(count, -infinity), ids(count, -infinity), places(3 * count, -infinity);
  std::vector<int> elements(count, -1);
  const auto signedValue = [&](std::size_t i, int e)
  {
    const Real value = elementVariable(block, e, variables[i / 2]).value_or(0);
    return i % 2 == 0 ? -value : value;
  };
  const auto isMine = [&](int e) { return part.owned[std::size_t(e)] && block.isAlive(e); };
  for (std::size_t i = 0; i < count; ++i)
    for (int e = 0; e < part.elements(); ++e)
      if (isMine(e))
        most[i] = std::max(most[i], signedValue(i, e));
  comm.max(most);
  for (std::size_t i = 0; i < count; ++i)
    for (int e = 0; e < part.elements(); ++e)
      if (isMine(e) && signedValue(i, e) == most[i] &&
          -Real(part.elementIds[std::size_t(e)]) > ids[i])
      {
        ids[i] = -Real(part.elementIds[std::size_t(e)]);
        elements[i] = e;
      }
  const std::vector<Real> mine = ids;
  comm.max(ids);
  for (std::size_t i = 0; i < count; ++i)
    if (elements[i] >= 0 && mine[i] == ids[i])
    {
      const Vec3 middle =
          middleOf(part, elements[i], [&](int node) { return at(solver.state().x, node); });
      for (std::size_t c = 0; c < 3; ++c)
        places[3 * i + c] = middle[int(c)];
    }
  comm.max(places);
  std::vector<Extreme> extremes(count);
  for (std::size_t i = 0; i < count; ++i)
    if (most[i] > -infinity)
      extremes[i] = {i % 2 == 0 ? -most[i] : most[i],
                     GlobalId(-ids[i]),
                     {places[3 * i], places[3 * i + 1], places[3 * i + 2]}};
    else
      extremes[i].value = std::numeric_limits<Real>::quiet_NaN();
  return extremes;
}
} // namespace coplane
