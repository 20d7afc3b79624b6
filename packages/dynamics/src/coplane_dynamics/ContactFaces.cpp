#include <coplane_contact/FacePairSteps.hpp>
#include <coplane_dynamics/detail/ContactFaces.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
std::vector<Face> contactFaces(const RankMesh& mesh, const std::vector<ElementBlock>& blocks,
                               const std::vector<std::pair<GlobalId, int>>& faceGroups,
                               const std::vector<int>& bodyOfNode,
                               const std::vector<ExteriorFace>& exterior, const ConstNodeVectors& x,
                               const std::vector<Face>* known)
{
  std::vector<Face> faces;
  std::size_t old = 0;
  for (const ExteriorFace& side : exterior)
  {
    while (known && old < known->size() && (*known)[old].id < side.id)
      ++old;
    if (known && old < known->size() && (*known)[old].id == side.id)
    {
      faces.push_back((*known)[old]);
      continue;
    }
    Face face;
    face.id = side.id;
    face.count = side.nodeCount;
    face.block = side.block;
    const auto special =
        std::lower_bound(faceGroups.begin(), faceGroups.end(), std::make_pair(side.id, 0));
    face.group =
        special != faceGroups.end() && special->first == side.id ? special->second : side.block;
    face.body = bodyOfNode[side.nodes[0]];
    face.local = true;
    face.ownedHere = side.ownedHere;
    face.young = known != nullptr;
    Vec3 corners[4];
    for (int k = 0; k < face.count; ++k)
    {
      face.nodes[k] = side.nodes[k];
      corners[k] = at(x, face.nodes[k]);
    }
    const Real area = norm(mesh.dimension == 2 ? vectorArea<2>(corners, face.count)
                                               : vectorArea<3>(corners, face.count));
    const RankMesh::Block& part = mesh.blocks[side.block];
    const int nodesOfElement = topology(part.type).nodes;
    int others = 0;
    for (int k = 0; k < nodesOfElement; ++k)
    {
      const int node = part.connectivity[side.element * nodesOfElement + k];
      if (std::find(face.nodes, face.nodes + face.count, node) == face.nodes + face.count)
        face.far[others++] = node;
    }
    const ElementBlock& block = blocks[side.block];
    Real volume = block.volume()(side.element);
    if (block.options().geometry == Geometry::Axisymmetric)
    {
      // Of one metre along the hoop.
      const Real length = block.referenceLength()(side.element);
      volume *= length * length / block.referenceVolume()(side.element);
    }
    const Real thickness = volume / area;
    // An element that has been crushed may have a side without area: then its size counts.
    const Real size =
        mesh.dimension == 2 ? std::sqrt(std::abs(volume)) : std::cbrt(std::abs(volume));
    face.thickness = thickness > 0 && thickness < 1e3 * size ? thickness : size;
    face.modulus = pWaveModulus(block.material());
    faces.push_back(face);
  }
  return faces;
}
} // namespace coplane
