#include <coplane_dynamics/detail/ContactFaces.hpp>
#include <coplane_geometry/FaceCorners.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
namespace
{
/// A thickness of more than this times the size of the element is that of one with a side crushed
/// to nothing [-].
constexpr Real thickestOfSize = 1e3;

int groupOf(const ExteriorFace& side, const std::vector<std::pair<GlobalId, int>>& faceGroups)
{
  const auto special =
      std::lower_bound(faceGroups.begin(), faceGroups.end(), std::make_pair(side.id, 0));
  return special != faceGroups.end() && special->first == side.id ? special->second : side.block;
}

/// The nodes of the element behind a face that are not on it.
void putFarNodes(const RankMesh::Block& part, int element, Face& face)
{
  const int nodesOfElement = topology(part.type).nodes;
  int others = 0;
  for (int k = 0; k < nodesOfElement; ++k)
  {
    const int node = part.connectivity[element * nodesOfElement + k];
    if (std::find(face.nodes, face.nodes + face.count, node) == face.nodes + face.count)
      face.far[others++] = node;
  }
}

/// Of volumes and masses of elements: the part that one undeformed metre along the hoop has; in
/// other geometries all of them.
Real perHoop(const ElementBlock& block, int element)
{
  if (block.options().geometry != Geometry::Axisymmetric)
    return 1;
  const Real length = block.referenceLength()(element);
  return length * length / block.referenceVolume(element);
}

/// Volume of the element behind a face over the area of the face [m]; of an element that has been
/// crushed, and may have a side without area, its size.
Real thicknessBehind(const ElementBlock& block, int element, Real area, int dimension)
{
  const Real volume = block.volume(element) * perHoop(block, element);
  const Real thickness = volume / area;
  const Real size = dimension == 2 ? std::sqrt(std::abs(volume)) : std::cbrt(std::abs(volume));
  return thickness > 0 && thickness < thickestOfSize * size ? thickness : size;
}
} // namespace

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
    const ElementBlock& block = blocks[side.block];
    Face face;
    face.id = side.id;
    face.count = side.nodeCount;
    std::copy_n(side.nodes.begin(), face.count, face.nodes);
    face.block = side.block;
    face.group = groupOf(side, faceGroups);
    face.body = bodyOfNode[side.nodes[0]];
    face.local = true;
    face.ownedHere = side.ownedHere;
    face.young = known != nullptr;
    putFarNodes(mesh.blocks[side.block], side.element, face);
    const Real area = norm(cornersAt(x, face).area(mesh.dimension));
    face.thickness = thicknessBehind(block, side.element, area, mesh.dimension);
    face.modulus = pWaveModulus(block.material());
    face.mass = 0.5 * block.mass(side.element) * perHoop(block, side.element);
    faces.push_back(face);
  }
  return faces;
}

void markThinFaces(std::vector<Face>& faces, const NodeLayout& layout)
{
  const Array<Real> atSurface("coplane::dynamics::atSurface", std::size_t(layout.size()));
  for (const Face& face : faces)
    for (int k = 0; k < face.count && !face.isCut(); ++k)
      atSurface(face.nodes[k]) = 1; // where it is owned, by all faces that it has
  layout.refresh(atSurface);
  for (Face& face : faces)
    face.thin = !face.isCut() &&
                std::none_of(face.far, face.far + 4,
                             [&](int node) { return node >= 0 && !(atSurface(node) > 0); });
}
} // namespace coplane
