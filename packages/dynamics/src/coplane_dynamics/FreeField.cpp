#include <coplane_core/Log.hpp>
#include <coplane_dynamics/FreeField.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace coplane
{
namespace
{
/// A force out of balance at the start above this part of the forces at the levels is told of.
constexpr Real outOfBalance = 0.05;
constexpr Real roundOff = 1e-12;

/// Corners of quadrilaterals (the first four, without the third number) and hexahedra.
constexpr int cornerSigns[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                   {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

bool isBox(ElementType type)
{
  return type == ElementType::Quad4 || type == ElementType::Hex8;
}

/// The corner across from one of a side.
int acrossFrom(int corner, const std::array<int, 4>& side, int dimension)
{
  const int count = dimension == 2 ? 2 : 4;
  int axis = 0;
  for (int a = 0; a < dimension; ++a)
  {
    bool same = true;
    for (int k = 1; k < count; ++k)
      same &= cornerSigns[side[std::size_t(k)]][a] == cornerSigns[side[0]][a];
    if (same)
      axis = a;
  }
  for (int c = 0; c < (dimension == 2 ? 4 : 8); ++c)
  {
    bool is = true;
    for (int a = 0; a < dimension; ++a)
      is &= cornerSigns[c][a] == (a == axis ? -1 : 1) * cornerSigns[corner][a];
    if (is)
      return c;
  }
  return -1;
}

bool begins(const std::string& text, const char* with)
{
  return text.rfind(with, 0) == 0;
}
} // namespace

FreeFieldColumn::FreeFieldColumn(std::size_t boundary, const Model& model, const Comm& comm)
    : name_(model.conditions.freeFields[boundary].name),
      where_(model.conditions.freeFields[boundary].where), boundary_(boundary),
      when_(model.conditions.freeFields[boundary].when), dimension_(model.mesh.dimension),
      layers_(freeFieldLayers(model.conditions.freeFields[boundary], model, comm))
{
  const std::size_t count = layers_.heights.size();
  holds_.resize(count);
  mass_.assign(count, 0);
  for (auto* vectors : {&displacement_, &velocity_, &previous_, &force_, &support_, &reaction_})
    vectors->assign(count, Vec3{});
  traction_.resize(layers_.layers.size());
  findConditions(model, comm);
  makeElements(model);
}

/// A level moves as all nodes of the side do at its height. Collective.
void FreeFieldColumn::findConditions(const Model& model, const Comm& comm)
{
  const Conditions& conditions = model.conditions;
  std::map<int, std::size_t> levelOfNode; // owned
  std::vector<char> foot(std::size_t(model.mesh.nodes()), 0);
  for (const FreeFieldSide& face : conditions.freeFields[boundary_].sides)
    for (int k = 0; k < face.side.count; ++k)
    {
      const int node = face.side.nodes[std::size_t(k)];
      const auto level = std::size_t(layers_.levels.at(face.side.id)[std::size_t(k)]);
      foot[std::size_t(node)] |= level == 0;
      if (node < model.mesh.ownedNodes)
        levelOfNode[node] = level;
    }
  const std::size_t kinds = conditions.velocities.size() + conditions.symmetries.size();
  std::vector<std::int64_t> counts(kinds * holds_.size(), 0);
  const auto count = [&](std::size_t kind, std::vector<int> nodes)
  {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (const int node : nodes)
      if (const auto found = levelOfNode.find(node); found != levelOfNode.end())
        ++counts[kind * holds_.size() + found->second];
  };
  for (std::size_t i = 0; i < conditions.velocities.size(); ++i)
    count(i, conditions.velocities[i].nodes);
  for (std::size_t i = 0; i < conditions.symmetries.size(); ++i)
    count(conditions.velocities.size() + i, conditions.symmetries[i].nodes);
  comm.sum(counts);
  for (std::size_t kind = 0; kind < kinds; ++kind)
    for (std::size_t level = 0; level < holds_.size(); ++level)
      if (counts[kind * holds_.size() + level] == layers_.nodesOfLevel[level])
      {
        if (kind < conditions.velocities.size())
          holds_[level].velocities.push_back(kind);
        else
          holds_[level].symmetries.push_back(kind - conditions.velocities.size());
      }

  std::vector<std::int64_t> below(conditions.absorbing.size(), 0);
  for (std::size_t i = 0; i < below.size(); ++i)
    for (const AbsorbingSide& face : conditions.absorbing[i].sides)
    {
      Vec3 corners[4];
      bool touches = false;
      for (int k = 0; k < face.side.count; ++k)
      {
        corners[k] = model.mesh.coordinates[std::size_t(face.side.nodes[std::size_t(k)])];
        touches |= foot[std::size_t(face.side.nodes[std::size_t(k)])] != 0;
      }
      const auto areas = cornerAreas(dimension_, corners, face.side.count);
      const Vec3 area = areas[0] + areas[1] + areas[2] + areas[3];
      if (touches && dot(area, layers_.up) < -0.9 * norm(area))
        ++below[i];
    }
  comm.sum(below);
  for (std::size_t i = 0; i < below.size(); ++i)
    if (below[i] > 0)
      basesBelow_.push_back(i);
}

/// As the element behind the side, but a rectangle or a box: its corners have the same order, so
/// that all that such an element knows can be taken over.
FreeFieldColumn::LayerElement FreeFieldColumn::elementOf(const FreeFieldLayer& layer, int index,
                                                         ElementType type) const
{
  const FreeFieldFaceRecord& face = layer.face;
  LayerElement element;
  element.area = layer.depth * layer.breadth;
  element.corners.resize(cornersPerElement());
  const Real low = dot(face.corners[0], layers_.along);
  Real first = low;
  for (int k = 0; k < face.count; ++k)
    first = std::min(first, dot(face.corners[k], layers_.along));
  const auto corner = [&](bool outer, int end, int along) -> Corner
  {
    return {outer, end,
            (layers_.offset - (outer ? 0 : layer.depth)) * layers_.normal +
                layers_.heights[std::size_t(index + end)] * layers_.up +
                (first + along * layer.breadth) * layers_.along};
  };
  if (!isBox(type))
  {
    // Right-handed: along the normal, along the side, up.
    const bool turned = dimension_ == 2 && cross(layers_.normal, layers_.up).z < 0;
    for (std::size_t c = 0; c < element.corners.size(); ++c)
      if (dimension_ == 3)
        element.corners[c] =
            corner(cornerSigns[c][0] > 0, cornerSigns[c][2] > 0, cornerSigns[c][1] > 0);
      else
        element.corners[turned ? (4 - c) % 4 : c] =
            corner(cornerSigns[c][0] > 0, cornerSigns[c][1] > 0, 0);
    return element;
  }
  const ElementTopology& shape = topology(type);
  const std::array<int, 4>& side = shape.sideNodes[std::size_t(sideOfFace(face.id))];
  for (int k = 0; k < face.count; ++k)
  {
    const int end =
        layers_.levelAt(dot(face.corners[k], layers_.up)) - index; // 0 or 1: the layer's own
    int along = 0;
    for (int other = 0; other < face.count && dimension_ == 3; ++other)
      along |= layers_.levelAt(dot(face.corners[other], layers_.up)) == index + end &&
               dot(face.corners[other], layers_.along) < dot(face.corners[k], layers_.along);
    const int outer = side[std::size_t(k)], inner = acrossFrom(outer, side, dimension_);
    element.corners[std::size_t(outer)] = corner(true, end, along);
    element.corners[std::size_t(inner)] = corner(false, end, along);
  }
  return element;
}

void FreeFieldColumn::makeElements(const Model& model)
{
  std::map<int, std::vector<int>> connectivityOf; // by block of the mesh
  const std::size_t corners = cornersPerElement();
  for (std::size_t l = 0; l < layers_.layers.size(); ++l)
  {
    const int block = layers_.layers[l].face.block;
    std::vector<int>& connectivity = connectivityOf[block];
    elements_.push_back(
        elementOf(layers_.layers[l], int(l), model.mesh.blocks[std::size_t(block)].type));
    elements_.back().element = int(connectivity.size() / corners);
    for (std::size_t c = 0; c < corners; ++c)
      connectivity.push_back(int(l * corners + c));
  }
  x_ = NodeVectors("coplane::dynamics::placesOfColumn", elements_.size() * corners);
  v_ = NodeVectors("coplane::dynamics::velocitiesOfColumn", elements_.size() * corners);
  placeCorners();
  std::map<int, int> position;
  for (const auto& [b, connectivity] : connectivityOf)
  {
    const BlockSetup& setup = model.blocks[std::size_t(b)];
    position[b] = int(blocks_.size());
    ElementOptions options = setup.element;
    if (!isBox(model.mesh.blocks[std::size_t(b)].type))
      options.form = ElementForm::OnePoint;
    blocks_.emplace_back(dimension_ == 2 ? ElementType::Quad4 : ElementType::Hex8, setup.material,
                         setup.hourglass, model.viscosity, connectivity, options);
    blocks_.back().initialise(x_);
  }
  for (std::size_t l = 0; l < elements_.size(); ++l)
  {
    LayerElement& element = elements_[l];
    element.block = position[layers_.layers[l].face.block];
    for (std::size_t c = 0; c < corners; ++c)
      mass_[l + std::size_t(element.corners[c].end)] +=
          blocks_[std::size_t(element.block)].cornerMass(element.element, int(c)) / element.area;
  }
}

void FreeFieldColumn::placeCorners()
{
  for (std::size_t l = 0; l < elements_.size(); ++l)
    for (std::size_t c = 0; c < elements_[l].corners.size(); ++c)
    {
      const Corner& corner = elements_[l].corners[c];
      const std::size_t level = l + std::size_t(corner.end);
      const int node = int(l * elements_[l].corners.size() + c);
      set(x_, node, corner.place + displacement_[level]);
      set(v_, node, velocity_[level]);
    }
}

/// Of elements on levels, and of the ground beyond on the side: half the difference of the forces
/// of an element on its corners within and on the side, which are those of its own mean stress
/// against the inertia that both share.
void FreeFieldColumn::sumForces()
{
  std::fill(force_.begin(), force_.end(), Vec3{});
  for (std::size_t l = 0; l < elements_.size(); ++l)
  {
    const LayerElement& element = elements_[l];
    const auto cornerForce = blocks_[std::size_t(element.block)].cornerForce();
    Vec3 outer[2] = {{}, {}}, inner[2] = {{}, {}};
    for (std::size_t c = 0; c < element.corners.size(); ++c)
    {
      const Vec3 f{cornerForce(element.element, c, 0), cornerForce(element.element, c, 1),
                   cornerForce(element.element, c, 2)};
      (element.corners[c].outer ? outer : inner)[element.corners[c].end] += f;
    }
    // The face of the side leans as the layer does.
    Vec3 rise = (layers_.heights[l + 1] - layers_.heights[l]) * layers_.up +
                (displacement_[l + 1] - displacement_[l]);
    rise -= dot(rise, layers_.along) * layers_.along;
    const Real face = 0.5 * norm(rise) * layers_.layers[l].breadth;
    for (std::size_t end = 0; end < 2; ++end)
    {
      force_[l + end] += (1 / element.area) * (outer[end] + inner[end]);
      traction_[l][end] = (0.5 / face) * (inner[end] - outer[end]);
    }
  }
}

// --- start

/// Collective.
void FreeFieldColumn::takeMotion(const Conditions& conditions, const RankMesh& mesh,
                                 const NodalState& state, const Comm& comm)
{
  struct Motion
  {
    std::int64_t level;
    Vec3 displacement, velocity;
  };
  std::map<std::size_t, Motion> mine;
  for (const FreeFieldSide& face : conditions.freeFields[boundary_].sides)
    for (int k = 0; k < face.side.count; ++k)
    {
      const int node = face.side.nodes[std::size_t(k)];
      const auto level = std::size_t(layers_.levels.at(face.side.id)[std::size_t(k)]);
      if (node < mesh.ownedNodes && mesh.nodeIds[std::size_t(node)] == layers_.nodeOfLevel[level])
        mine[level] = {std::int64_t(level), at(state.x, node) - mesh.coordinates[std::size_t(node)],
                       at(state.v, node)};
    }
  std::vector<Motion> motions;
  for (const auto& [level, motion] : mine)
    motions.push_back(motion);
  std::vector<char> known(levels(), 0);
  for (const Motion& motion : comm.allGather(motions))
  {
    const auto level = std::size_t(motion.level);
    known[level] = 1;
    displacement_[level] = motion.displacement;
    velocity_[level] = previous_[level] = motion.velocity;
  }
  for (std::size_t level = 0; level < levels(); ++level)
    if (!known[level])
      failOnAllRanks(ExitCode::Deck,
                     "{}: free-field side set '{}': the elements at the height {:.6g} m have gone; "
                     "accepted: a side of elements that are there when it begins to act.",
                     where_, name_, layers_.heights[level]);
}

/// Collective.
void FreeFieldColumn::takeElements(const Conditions& conditions, const RankMesh& mesh,
                                   const ElementForces& elements, const Comm& comm)
{
  std::vector<Real> mine; // layer, then its row
  for (const FreeFieldSide& face : conditions.freeFields[boundary_].sides)
    for (std::size_t l = 0; l < elements_.size(); ++l)
      if (layers_.layers[l].face.id == face.side.id && isOfThisRank(face.side, mesh))
      {
        const ElementBlock& block = elements.blocks()[std::size_t(face.block)];
        mine.push_back(Real(l));
        const std::size_t first = mine.size();
        mine.resize(first + block.stateColumns().size());
        block.saveState(face.element, mine.data() + first);
      }
  const std::vector<Real> all = comm.allGather(mine);
  std::vector<char> known(elements_.size(), 0);
  for (std::size_t next = 0; next < all.size();)
  {
    const auto l = std::size_t(all[next++]);
    const auto meshBlock = std::size_t(layers_.layers[l].face.block);
    const LayerElement& element = elements_[l];
    ElementBlock& block = blocks_[std::size_t(element.block)];
    const std::vector<std::string> columns = elements.blocks()[meshBlock].stateColumns(),
                                   own = block.stateColumns();
    std::vector<Real> row(own.size());
    block.saveState(element.element, row.data());
    for (std::size_t c = 0; c < columns.size(); ++c)
    {
      // Of triangles and tetrahedra what any element knows.
      const auto found = std::find(own.begin(), own.end(), columns[c]);
      const bool takes = isBox(mesh.blocks[meshBlock].type) || begins(columns[c], "stress.") ||
                         begins(columns[c], "history.") || begins(columns[c], "tangent.");
      if (takes && found != own.end())
        row[std::size_t(found - own.begin())] = all[next + c];
    }
    next += columns.size();
    block.restoreState(element.element, row.data());
    known[l] = block.isAlive(element.element);
  }
  for (std::size_t l = 0; l < known.size(); ++l)
    if (!known[l])
      failOnAllRanks(ExitCode::Deck,
                     "{}: free-field side set '{}': element {} has gone; accepted: a side of "
                     "elements that are there when it begins to act.",
                     where_, name_, elementOfFace(layers_.layers[l].face.id));
}

void FreeFieldColumn::start(Real t, const Conditions& conditions, const RankMesh& mesh,
                            const NodalState& state, const ElementForces& elements,
                            const Comm& comm)
{
  takeMotion(conditions, mesh, state, comm);
  takeElements(conditions, mesh, elements, comm);
  placeCorners();
  for (ElementBlock& block : blocks_)
    block.update(x_, v_, 0);
  sumForces();
  const Vec3 gravity = conditions.gravity(t);
  for (std::size_t level = 0; level < levels(); ++level)
  {
    support_[level] = -(force_[level] + mass_[level] * gravity);
    reaction_[level] = {};
  }
  started_ = true;
  tellStart(t, conditions);
}

void FreeFieldColumn::tellStart(Real t, const Conditions& conditions) const
{
  Real lacks = 0, forces = 0;
  for (std::size_t level = 1; level < levels(); ++level) // the foot has a base
  {
    lacks += norm(support_[level]);
    forces += norm(force_[level]) + mass_[level] * norm(conditions.gravity(t));
  }
  const Real part = forces > 0 ? 2 * lacks / forces : 0;
  logInfo("free field beside side set '{}' from t = {:.6g} s on: {} layers, {:.6g} m; out of "
          "balance by {:.2g} % of its forces",
          name_, t, layers_.layers.size(), layers_.heights.back() - layers_.heights.front(),
          100 * part);
  if (part > outOfBalance)
    logWarning(
        "free field out of balance",
        fmt::format("{}: free-field side set '{}': at t = {:.6g} s the column of its layers "
                    "is out of balance by {:.2g} % of its forces, which it keeps as constant "
                    "forces. Let the model come to rest before, or take sides that are "
                    "farther from what disturbs the level ground.",
                    where_, name_, t, 100 * part));
}

// --- cycle

void FreeFieldColumn::advance(Real dt)
{
  if (!started_)
    return;
  for (std::size_t level = 0; level < levels(); ++level)
    displacement_[level] += dt * velocity_[level];
  placeCorners();
  for (ElementBlock& block : blocks_)
    block.update(x_, v_, dt);
  sumForces();
}

FreeFieldColumn::Base FreeFieldColumn::baseAt(const Conditions& conditions, Real t,
                                              Real middle) const
{
  Base base;
  const FreeFieldFaceRecord& foot = layers_.layers[0].face;
  for (const std::size_t i : basesBelow_)
  {
    const AbsorbingBoundary& boundary = conditions.absorbing[i];
    if (!boundary.when.holds(middle))
      continue;
    base.acts = true;
    base.normal += foot.normalImpedance;
    base.shear += foot.shearImpedance;
    const Vec3 incident = boundary.incident(t);
    const Vec3 along = dot(incident, layers_.up) * layers_.up;
    base.wave += 2.0 * (foot.normalImpedance * along + foot.shearImpedance * (incident - along));
  }
  return base;
}

Vec3 FreeFieldColumn::dragOf(const Base& base, const Vec3& v) const
{
  const Vec3 along = dot(v, layers_.up) * layers_.up;
  return base.normal * along + base.shear * (v - along);
}

/// Takes out what the conditions on velocities take up.
void FreeFieldColumn::clearHeld(std::size_t level, const Conditions& conditions, Real middle,
                                Vec3& force) const
{
  for (const std::size_t i : holds_[level].symmetries)
    if (const SymmetryPlane& plane = conditions.symmetries[i]; plane.when.holds(middle))
      force -= dot(force, plane.normal) * plane.normal;
  for (const std::size_t i : holds_[level].velocities)
    for (int c = 0; c < 3; ++c)
      if (conditions.velocities[i].components[std::size_t(c)] &&
          conditions.velocities[i].when.holds(middle))
        force[c] = 0;
}

/// As Conditions::prescribeVelocities.
Vec3 FreeFieldColumn::prescribed(std::size_t level, const Conditions& conditions,
                                 const KickTimes& times, const Vec3& before, Vec3 v) const
{
  for (const std::size_t i : holds_[level].symmetries)
    if (const SymmetryPlane& plane = conditions.symmetries[i]; plane.when.holds(times.middle()))
      v -= dot(v, plane.normal) * plane.normal;
  for (const std::size_t i : holds_[level].velocities)
  {
    const PrescribedVelocity& condition = conditions.velocities[i];
    if (!condition.when.holds(times.middle()) ||
        (condition.of != PrescribedVelocity::Of::Velocity && !(times.step > 0)))
      continue;
    for (int c = 0; c < 3; ++c)
    {
      if (!condition.components[std::size_t(c)])
        continue;
      const OfTimeAndPlace& field = condition.field[std::size_t(c)];
      const OfTime& function = condition.velocity[std::size_t(c)];
      const Vec3& place = layers_.placeOfLevel[level];
      const Real value = field ? condition.speed([&](Real t) { return field(t, place); }, times, 0)
                         : function ? condition.speed(function, times, 0)
                                    : 0;
      v[c] = condition.of == PrescribedVelocity::Of::Acceleration ? before[c] + value : value;
    }
  }
  return v;
}

/// As NodalMotion::kick: dashpots and mass damping take the mean of both half steps.
void FreeFieldColumn::kick(const KickTimes& times, const Conditions& conditions, Real massDamping,
                           Real localDamping)
{
  const Real middle = times.middle();
  if (!started_)
    return;
  if (!conditions.freeFields[boundary_].when.holds(middle))
  {
    started_ = false; // it has come to its end
    return;
  }
  const Real dt = times.kick, half = 0.5 * dt;
  const Vec3 gravity = conditions.gravity(times.t);
  const Base foot = baseAt(conditions, times.t, middle);
  for (std::size_t level = 0; level < levels(); ++level)
  {
    const Base base = level == 0 ? foot : Base();
    if (base.acts)
    {
      // What held the foot until now: its reaction goes on, as at absorbing sides.
      Vec3 released = reaction_[level];
      clearHeld(level, conditions, middle, released);
      if (norm(released) > roundOff * norm(reaction_[level]))
        support_[level] += released;
    }
    const Vec3 old = velocity_[level];
    Vec3 force = force_[level] + mass_[level] * gravity + support_[level] + base.wave;
    if (localDamping > 0)
    {
      Vec3 free = force;
      clearHeld(level, conditions, middle, free);
      for (int c = 0; c < 3; ++c)
        force[c] -= old[c] > 0   ? localDamping * std::abs(free[c])
                    : old[c] < 0 ? -localDamping * std::abs(free[c])
                                 : 0;
    }
    const Real kept = mass_[level] * (1 - half * massDamping);
    const Real diagonal = mass_[level] * (1 + half * massDamping);
    const Vec3 right = kept * old - half * dragOf(base, old) + dt * force;
    const Vec3 along = dot(right, layers_.up) * layers_.up;
    const Vec3 free = (1 / (diagonal + half * base.normal)) * along +
                      (1 / (diagonal + half * base.shear)) * (right - along);
    const Vec3 v = prescribed(level, conditions, times, old, free);
    reaction_[level] = (diagonal / dt) * (v - free) + 0.5 * dragOf(base, v - free);
    previous_[level] = old;
    velocity_[level] = v;
  }
}

void FreeFieldColumn::stop(const KickTimes& times, const Conditions& conditions)
{
  if (!started_)
    return;
  for (std::size_t level = 0; level < levels(); ++level)
  {
    Vec3 kept{};
    for (const std::size_t i : holds_[level].velocities)
    {
      const PrescribedVelocity& condition = conditions.velocities[i];
      for (int c = 0; c < 3; ++c)
        if (condition.components[std::size_t(c)] && condition.when.holds(times.middle()))
        {
          const OfTimeAndPlace& field = condition.field[std::size_t(c)];
          const OfTime& function = condition.velocity[std::size_t(c)];
          kept[c] = velocity_[level][c];
          if (condition.of == PrescribedVelocity::Of::Acceleration)
            kept[c] -= 0.5 * times.step *
                       (field      ? field(times.t, layers_.placeOfLevel[level])
                        : function ? function(times.t)
                                   : 0);
        }
    }
    velocity_[level] = kept;
  }
}

Real FreeFieldColumn::stableStep() const
{
  Real least = infinity;
  for (const ElementBlock& block : blocks_)
    if (started_)
      least = std::min(least, block.smallestStableStep());
  return least;
}

/// The layer of a face, and whether a corner is at its foot (0) or its top (1).
std::pair<std::size_t, std::size_t> FreeFieldColumn::layerOf(const LoadedSide& side,
                                                             int corner) const
{
  const std::array<int, 4>& levels = layers_.levels.at(side.id);
  const int low = *std::min_element(levels.begin(), levels.begin() + side.count);
  return {std::size_t(low), std::size_t(levels[std::size_t(corner)] - low)};
}

Vec3 FreeFieldColumn::velocity(const LoadedSide& side, int corner) const
{
  const auto [layer, end] = layerOf(side, corner);
  return 0.5 * (previous_[layer + end] + velocity_[layer + end]);
}

Vec3 FreeFieldColumn::traction(const LoadedSide& side, int corner) const
{
  const auto [layer, end] = layerOf(side, corner);
  return traction_[layer][end];
}
} // namespace coplane
