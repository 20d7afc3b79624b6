#include <coplane_dynamics/Dashpots.hpp>
#include <coplane_geometry/FaceCorners.hpp>

namespace coplane
{
namespace
{
/// Solution of c v = b for a positive definite matrix, by cofactors.
Vec3 solved(const SymTensor& c, const Vec3& b)
{
  const Vec3 r0{c.xx, c.xy, c.zx}, r1{c.xy, c.yy, c.yz}, r2{c.zx, c.yz, c.zz};
  const Vec3 c0 = cross(r1, r2), c1 = cross(r2, r0), c2 = cross(r0, r1);
  return (1 / dot(r0, c0)) * (b.x * c0 + b.y * c1 + b.z * c2);
}
} // namespace

Dashpots::Dashpots(const Conditions& conditions, int ownedNodes) : positions_(ownedNodes, -1)
{
  for (const AbsorbingBoundary& boundary : conditions.absorbing)
    for (const AbsorbingSide& face : boundary.sides)
      for (int k = 0; k < face.side.count; ++k)
        if (face.side.nodes[k] < ownedNodes)
          positions_[face.side.nodes[k]] = 0;
  for (const FreeFieldBoundary& boundary : conditions.freeFields)
    for (const FreeFieldSide& face : boundary.sides)
      for (int k = 0; k < face.side.count; ++k)
        if (face.side.nodes[k] < ownedNodes)
          positions_[face.side.nodes[k]] = 0;
  for (int n = 0; n < ownedNodes; ++n)
    if (positions_[n] == 0)
    {
      positions_[n] = int(nodes_.size());
      nodes_.push_back(n);
    }
  matrices_.resize(nodes_.size());
  acts_.assign(nodes_.size(), 0);
  initial_.assign(nodes_.size(), Vec3{});
  drive_.assign(nodes_.size(), Vec3{});
  supports_.assign(nodes_.size(), Vec3{});
}

namespace
{
/// Z of a face: z_n along its normal, z_s across it; times an area [Pa s m].
SymTensor impedanceOf(Real normalImpedance, Real shearImpedance, Real area, const Vec3& n)
{
  const Real shear = area * shearImpedance;
  const Real rest = area * (normalImpedance - shearImpedance);
  return {shear + rest * n.x * n.x, shear + rest * n.y * n.y, shear + rest * n.z * n.z,
          rest * n.x * n.y,         rest * n.y * n.z,         rest * n.z * n.x};
}

void add(SymTensor& sum, const SymTensor& c)
{
  sum.xx += c.xx;
  sum.yy += c.yy;
  sum.zz += c.zz;
  sum.xy += c.xy;
  sum.yz += c.yz;
  sum.zx += c.zx;
}
} // namespace

void Dashpots::act(int dimension, const Conditions& conditions, const FreeFields& freeFields,
                   Real t, Real middle, const std::vector<Vec3>& released,
                   const ConstNodeVectors& x, const NodeVectors& external)
{
  const std::vector<Vec3> before = initial_;
  matrices_.assign(nodes_.size(), SymTensor{});
  acts_.assign(nodes_.size(), 0);
  initial_.assign(nodes_.size(), Vec3{});
  for (const AbsorbingBoundary& boundary : conditions.absorbing)
  {
    if (!boundary.when.holds(middle))
      continue;
    const Vec3 incident = boundary.incident(t);
    for (const AbsorbingSide& face : boundary.sides)
    {
      const std::array<Vec3, 4> areas = cornerAreas(dimension, cornersAt(x, face.side).x,
                                                    face.side.count, conditions.axisymmetric);
      const Vec3 n = normalOf(areas);
      const Vec3 along = dot(incident, n) * n;
      const Vec3 wave =
          2.0 * (face.normalImpedance * along + face.shearImpedance * (incident - along));
      for (int k = 0; k < face.side.count; ++k)
      {
        const int node = face.side.nodes[k];
        if (node >= int(positions_.size()))
          continue;
        const Real area = dot(areas[k], n);
        const std::size_t i = std::size_t(positions_[node]);
        add(matrices_[i], impedanceOf(face.normalImpedance, face.shearImpedance, area, n));
        const Vec3 initial = dot(face.stress[k], areas[k]);
        acts_[i] = 1;
        initial_[i] += initial;
        set(external, node, at(external, node) + (initial + area * wave));
      }
    }
  }
  addFreeFields(dimension, conditions, freeFields, middle, x, external);
  for (std::size_t i = 0; i < nodes_.size(); ++i)
  {
    if (!acts_[i])
      continue;
    if (const Vec3& force = released[i]; force.x != 0 || force.y != 0 || force.z != 0)
      supports_[i] += force - (initial_[i] - before[i]);
    set(external, nodes_[i], at(external, nodes_[i]) + supports_[i]);
  }
}

void Dashpots::addFreeFields(int dimension, const Conditions& conditions,
                             const FreeFields& freeFields, Real middle, const ConstNodeVectors& x,
                             const NodeVectors& external)
{
  drive_.assign(nodes_.size(), Vec3{});
  for (std::size_t b = 0; b < conditions.freeFields.size(); ++b)
  {
    if (!conditions.freeFields[b].when.holds(middle))
      continue;
    const FreeFieldColumn& column = freeFields.column(b);
    for (const FreeFieldSide& face : conditions.freeFields[b].sides)
    {
      const std::array<Vec3, 4> areas =
          cornerAreas(dimension, cornersAt(x, face.side).x, face.side.count);
      const Vec3 n = normalOf(areas);
      for (int k = 0; k < face.side.count; ++k)
      {
        const int node = face.side.nodes[k];
        if (node >= int(positions_.size()))
          continue;
        const Real area = dot(areas[k], n);
        const SymTensor c = impedanceOf(face.normalImpedance, face.shearImpedance, area, n);
        const Vec3 beyond = area * column.traction(face.side, k);
        const std::size_t i = std::size_t(positions_[node]);
        add(matrices_[i], c);
        acts_[i] = 1;
        initial_[i] += beyond;
        drive_[i] += dot(c, column.velocity(face.side, k));
        set(external, node, at(external, node) + beyond);
      }
    }
  }
}

void Dashpots::drive(const NodeVectors& external) const
{
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if (const Vec3& force = drive_[i]; force.x != 0 || force.y != 0 || force.z != 0)
      set(external, nodes_[i], at(external, nodes_[i]) + force);
}

void Dashpots::kick(Real dt, Real massDamping, const ConstArray<Real>& mass,
                    const std::function<Vec3(int)>& force, const ConstNodeVectors& vOld,
                    const NodeVectors& v) const
{
  for (std::size_t i = 0; i < nodes_.size(); ++i)
  {
    const int n = nodes_[i];
    if (!(mass(n) > 0))
      continue; // all of its elements have left
    const Real half = 0.5 * dt;
    const Vec3 old = at(vOld, n);
    const SymTensor& c = matrices_[i];
    const Real kept = mass(n) * (1 - half * massDamping);
    const Real diagonal = mass(n) * (1 + half * massDamping);
    const SymTensor a{diagonal + half * c.xx,
                      diagonal + half * c.yy,
                      diagonal + half * c.zz,
                      half * c.xy,
                      half * c.yz,
                      half * c.zx};
    set(v, n, solved(a, kept * old - half * dot(c, old) + dt * force(n)));
  }
}

void Dashpots::book(const ConstNodeVectors& vOld, const ConstNodeVectors& v,
                    const NodeVectors& external) const
{
  for (const int n : nodes_)
    set(external, n, at(external, n) - 0.5 * drag(n, at(vOld, n) + at(v, n)));
}

namespace
{
constexpr const char* supportsTable = "nodes/former_supports";
const std::vector<std::string> supportsColumns{"support_x", "support_y", "support_z",
                                               "initial_x", "initial_y", "initial_z"};
} // namespace

void Dashpots::save(const std::vector<GlobalId>& ids, StateTables& out) const
{
  KeyedRows rows;
  rows.columns = supportsColumns;
  for (std::size_t i = 0; i < nodes_.size(); ++i)
  {
    Real* row = rows.add({ids[std::size_t(nodes_[i])]});
    for (int c = 0; c < 3; ++c)
    {
      row[c] = supports_[i][c];
      row[3 + c] = initial_[i][c];
    }
  }
  out.rows(supportsTable, rows);
}

void Dashpots::restore(const std::vector<GlobalId>& ids, const StateSource& in)
{
  if (!in.has(supportsTable))
    return; // of a checkpoint that is older than supports that last
  std::vector<GlobalId> mine;
  for (const int node : nodes_)
    mine.push_back(ids[std::size_t(node)]);
  // Sides that a stage makes absorbing had no such force before.
  const KeyedRows rows =
      in.rowsOf(supportsTable, supportsColumns, mine, StateSource::Missing::Zero);
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    for (int c = 0; c < 3; ++c)
    {
      supports_[i][c] = rows.row(i)[c];
      initial_[i][c] = rows.row(i)[3 + c];
    }
}

Vec3 Dashpots::drag(int node, const Vec3& v) const
{
  return positions_[node] < 0 ? Vec3{} : dot(matrices_[positions_[node]], v);
}
} // namespace coplane
