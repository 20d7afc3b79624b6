#include <coplane_element/LogarithmicStrain.hpp>
#include <coplane_output/HistoryObserver.hpp>
#include <coplane_output/detail/NodalContact.hpp>
#include <coplane_output/detail/ProbedElements.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace coplane
{
namespace
{
const std::vector<std::string> stresses{"stress_xx", "stress_yy", "stress_zz",
                                        "stress_xy", "stress_yz", "stress_zx"};
const std::vector<std::string> strains{"strain_xx", "strain_yy", "strain_zz",
                                       "strain_xy", "strain_yz", "strain_zx"};

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

SymTensor strainOf(const Solver& solver, int b, int element)
{
  const ElementBlock& block = solver.blocks()[std::size_t(b)];
  if (!block.isAlive(element))
    return {};
  std::array<Vec3, 8> reference, present;
  for (int k = 0; k < topology(block.type()).nodes; ++k)
  {
    const int node = block.connectivity()(element, k);
    reference[std::size_t(k)] = solver.strainReference(b, node);
    present[std::size_t(k)] = at(solver.state().x, node);
  }
  return logarithmicStrain(block.type(), reference.data(), present.data(),
                           block.options().geometry == Geometry::Axisymmetric);
}

std::optional<Real> elementVariable(const Solver& solver, int b, int element,
                                    const std::string& name)
{
  const ElementBlock& block = solver.blocks()[std::size_t(b)];
  const auto strain = std::find(strains.begin(), strains.end(), name);
  if (strain != strains.end())
  {
    const SymTensor all = strainOf(solver, b, element);
    return std::array{
        all.xx, all.yy, all.zz, all.xy, all.yz, all.zx}[std::size_t(strain - strains.begin())];
  }
  const auto stress = std::find(stresses.begin(), stresses.end(), name);
  if (stress != stresses.end())
    return block.stress(stress - stresses.begin(), element);
  if (name == "von_mises")
    return block.vonMises(element);
  if (name == "pressure")
    return block.pressure(element);
  if (name == "density")
    return block.density(element);
  const int row = block.historyRow(name);
  if (row < 0)
    return std::nullopt;
  return block.history(row, element);
}

std::vector<std::string> byComponent(const std::vector<std::string>& variables)
{
  std::vector<std::string> names;
  for (const std::string& name : variables)
    if (name == "stress")
      names.insert(names.end(), stresses.begin(), stresses.end());
    else if (name == "strain")
      names.insert(names.end(), strains.begin(), strains.end());
    else
      names.push_back(name);
  return names;
}

std::string unitOfVariable(const std::string& name)
{
  if (name == "density")
    return "[kg/m^3]";
  if (name == "contact_pressure")
    return "[Pa]";
  if (name.rfind("velocity", 0) == 0)
    return "[m/s]";
  if (name.rfind("displacement", 0) == 0 || name.rfind("contact_", 0) == 0)
    return "[m]";
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

namespace
{
/// Least and largest over items of all ranks, [2 i] and [2 i + 1] of variable i. Collective.
/// @param valueOf, idOf, placeOf of items, those from 0 to `items` for which isMine
template <class IsMine, class ValueOf, class IdOf, class PlaceOf>
std::vector<Extreme> extremesOver(const Comm& comm, int items, std::size_t variables,
                                  const IsMine& isMine, const ValueOf& valueOf, const IdOf& idOf,
                                  const PlaceOf& placeOf)
{
  const std::size_t count = 2 * variables;
  // Largest of minus the value and of the value, and the lowest id with it.
  std::vector<Real> most(count, -infinity), ids(count, -infinity), places(3 * count, -infinity);
  std::vector<int> found(count, -1);
  const auto signedValue = [&](std::size_t i, int item)
  {
    const Real value = valueOf(i / 2, item);
    return i % 2 == 0 ? -value : value;
  };
  for (std::size_t i = 0; i < count; ++i)
    for (int item = 0; item < items; ++item)
      if (isMine(item))
        most[i] = std::max(most[i], signedValue(i, item));
  comm.max(most);
  for (std::size_t i = 0; i < count; ++i)
    for (int item = 0; item < items; ++item)
      if (isMine(item) && signedValue(i, item) == most[i] && -Real(idOf(item)) > ids[i])
      {
        ids[i] = -Real(idOf(item));
        found[i] = item;
      }
  const std::vector<Real> mine = ids;
  comm.max(ids);
  for (std::size_t i = 0; i < count; ++i)
    if (found[i] >= 0 && mine[i] == ids[i])
    {
      const Vec3 place = placeOf(found[i]);
      for (std::size_t c = 0; c < 3; ++c)
        places[3 * i + c] = place[int(c)];
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
} // namespace

std::vector<Extreme> extremesOf(const Solver& solver, int b,
                                const std::vector<std::string>& variables)
{
  const RankMesh::Block& part = solver.mesh().blocks[std::size_t(b)];
  const ElementBlock& block = solver.blocks()[std::size_t(b)];
  return extremesOver(
      solver.comm(), part.elements(), variables.size(),
      [&](int e) { return part.owned[std::size_t(e)] && block.isAlive(e); },
      [&](std::size_t variable, int e)
      { return elementVariable(solver, b, e, variables[variable]).value_or(0); },
      [&](int e) { return part.elementIds[std::size_t(e)]; },
      [&](int e)
      { return middleOf(part, e, [&](int node) { return at(solver.state().x, node); }); });
}

namespace
{
const std::vector<std::string> motions{"displacement",   "displacement_x", "displacement_y",
                                       "displacement_z", "velocity",       "velocity_x",
                                       "velocity_y",     "velocity_z"};
const std::vector<std::string> ofContact{"contact_pressure", "contact_closure", "contact_gap",
                                         "contact_slip"};

bool isIn(const std::vector<std::string>& names, const std::string& name)
{
  return std::find(names.begin(), names.end(), name) != names.end();
}
} // namespace

const std::vector<std::string>& nodalVariables()
{
  static const std::vector<std::string> all = []
  {
    std::vector<std::string> names = motions;
    names.insert(names.end(), ofContact.begin(), ofContact.end());
    return names;
  }();
  return all;
}

std::vector<Extreme> nodalExtremesOf(const Solver& solver, int nodeSet,
                                     const std::vector<std::string>& variables)
{
  const std::vector<int>& nodes = solver.mesh().nodeSets[std::size_t(nodeSet)]; // owned ones
  const NodalState& state = solver.state();
  NodalContact contact;
  if (std::any_of(variables.begin(), variables.end(),
                  [](const std::string& name) { return isIn(ofContact, name); }))
    contact = nodalContact(solver);
  const auto valueOf = [&](std::size_t variable, int item)
  {
    const std::string& name = variables[variable];
    const int n = nodes[std::size_t(item)];
    if (name == "contact_pressure")
      return contact.pressure[std::size_t(n)];
    if (name == "contact_closure")
      return contact.closure[std::size_t(n)];
    if (name == "contact_gap")
      return contact.gap[std::size_t(n)];
    if (name == "contact_slip")
      return contact.slip[std::size_t(n)];
    Vec3 vector{};
    for (int c = 0; c < 3; ++c)
      vector[c] = name[0] == 'd' ? state.x(n, c) - state.reference(n, c)
                                 : 0.5 * (state.vPrevious(n, c) + state.v(n, c));
    const char end = name.back();
    return name[name.size() - 2] == '_' ? vector[end - 'x'] : norm(vector);
  };
  const std::vector<GlobalId>& ids = solver.layout().ids();
  return extremesOver(
      solver.comm(), int(nodes.size()), variables.size(), [](int) { return true; }, valueOf,
      [&](int item) { return ids[std::size_t(nodes[std::size_t(item)])]; },
      [&](int item) { return at(state.x, nodes[std::size_t(item)]); });
}
} // namespace coplane
