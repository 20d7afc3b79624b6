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
  for (int n = 0; n < ownedNodes; ++n)
    if (positions_[n] == 0)
    {
      positions_[n] = int(nodes_.size());
      nodes_.push_back(n);
    }
  matrices_.resize(nodes_.size());
}

void Dashpots::find(int dimension, const Conditions& conditions, const ConstNodeVectors& x)
{
  matrices_.assign(nodes_.size(), SymTensor{});
  for (const AbsorbingBoundary& boundary : conditions.absorbing)
    for (const AbsorbingSide& face : boundary.sides)
    {
      const std::array<Vec3, 4> areas = cornerAreas(dimension, cornersAt(x, face.side).x,
                                                    face.side.count, conditions.axisymmetric);
      const Vec3 n = normalised(areas[0] + areas[1] + areas[2] + areas[3]);
      for (int k = 0; k < face.side.count; ++k)
      {
        const int node = face.side.nodes[k];
        if (node >= int(positions_.size()))
          continue;
        const Real area = dot(areas[k], n);
        const Real shear = area * face.shearImpedance;
        const Real rest = area * (face.normalImpedance - face.shearImpedance);
        SymTensor& c = matrices_[positions_[node]];
        c.xx += shear + rest * n.x * n.x;
        c.yy += shear + rest * n.y * n.y;
        c.zz += shear + rest * n.z * n.z;
        c.xy += rest * n.x * n.y;
        c.yz += rest * n.y * n.z;
        c.zx += rest * n.z * n.x;
      }
    }
}

void Dashpots::kick(Real dt, Real massDamping, const ConstArray<Real>& mass,
                    const std::function<Vec3(int)>& force, const ConstNodeVectors& vOld,
                    const NodeVectors& v) const
{
  for (std::size_t i = 0; i < nodes_.size(); ++i)
  {
    const int n = nodes_[i];
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

Vec3 Dashpots::drag(int node, const Vec3& v) const
{
  return positions_[node] < 0 ? Vec3{} : dot(matrices_[positions_[node]], v);
}
} // namespace coplane
