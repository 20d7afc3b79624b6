#include <coplane_dynamics/Model.hpp>

namespace coplane
{
SymTensor BlockSetup::stressAt(const Vec3& x) const
{
  const Real d = dot(stressGradient.axis, x - stressGradient.point);
  const SymTensor& g = stressGradient.perMetre;
  return {stress.xx + d * g.xx, stress.yy + d * g.yy, stress.zz + d * g.zz,
          stress.xy + d * g.xy, stress.yz + d * g.yz, stress.zx + d * g.zx};
}

SymTensor BlockSetup::stressOfElement(const RankMesh& mesh, int block, int element) const
{
  const RankMesh::Block& part = mesh.blocks[block];
  const int corners = topology(part.type).nodes;
  Vec3 sum{};
  for (int k = 0; k < corners; ++k)
    sum += mesh.coordinates[part.connectivity[element * corners + k]];
  return stressAt((1.0 / corners) * sum);
}

std::array<SymTensor, 4> BlockSetup::stressOfSide(const RankMesh& mesh,
                                                  const RankMesh::Side& side) const
{
  const RankMesh::Block& part = mesh.blocks[side.block];
  const ElementTopology& shape = topology(part.type);
  const bool simplex = shape.nodes == shape.dimension + 1;
  const auto corner = [&](int k)
  {
    return mesh
        .coordinates[part.connectivity[side.element * shape.nodes + shape.sideNodes[side.side][k]]];
  };
  Vec3 sum{};
  for (int k = 0; k < shape.nodesPerSide; ++k)
    sum += corner(k);
  std::array<SymTensor, 4> stress{};
  for (int k = 0; k < shape.nodesPerSide; ++k)
    stress[k] = stressAt(simplex ? (1.0 / shape.nodes) * (sum + corner(k))
                                 : (1.0 / shape.nodesPerSide) * sum);
  return stress;
}

Vec3 BlockSetup::velocityAt(const Vec3& x) const
{
  const Vec3 rigid = velocity + cross(angularVelocity, x - center);
  return velocityField ? rigid + velocityField(x) : rigid;
}
} // namespace coplane
