#pragma once

#include <coplane_mesh/Mesh.hpp>

#include <array>
#include <vector>

namespace coplane
{
/// Where an element of a mesh (counted over all blocks) is.
struct ElementPlace
{
  int block = 0, index = 0; ///< index within the block
};
std::vector<ElementPlace> placesOfElements(const Mesh& mesh);

/// A face of one element (exterior) or of two (interior).
struct MeshFace
{
  int count = 0;                            ///< elements that have it, 1 or 2
  std::array<int, 2> elements{-1, -1};      ///< indices in the mesh, ascending
  std::array<int, 2> sides{-1, -1};         ///< counted from 0
  std::array<int, 4> nodes{-1, -1, -1, -1}; ///< normal out of elements[0]; -1 beyond the last
};

/// All faces, sorted by their first element and its side. A face of three elements is an
/// Error(ExitCode::Mesh).
std::vector<MeshFace> facesOf(const Mesh& mesh);

/// Mean of the nodes [m].
Vec3 centreOf(const Mesh& mesh, const MeshFace& face);

/// Unit normal out of the first element: of the diagonals in three dimensions, to the right of the
/// edge in two.
Vec3 normalOf(const Mesh& mesh, const MeshFace& face);

/// Area of the plane that normalOf() is normal to; length in two dimensions [m^2, m].
Real areaOf(const Mesh& mesh, const MeshFace& face);

/// Diagonal of the bounding box [m].
Real sizeOf(const Mesh& mesh);

/// For every element of the mesh the number, from 1, of its body: the elements that hang together
/// by nodes. Bodies are counted in the order of their first elements.
std::vector<int> bodiesOfElements(const Mesh& mesh);
} // namespace coplane
