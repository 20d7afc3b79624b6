#pragma once

#include "GmshFile.hpp"

#include <array>

namespace coplane
{
/// Cuts every tetrahedron of a mesh into four hexahedra, every triangle into three quadrilaterals
/// and every line in two, at the middles of edges, faces and elements, which become nodes after all
/// others.
void cutIntoCubes(GmshFile& mesh);

/// How well a hexahedron serves an explicit computation, as worthOf says of a tetrahedron: the
/// lesser of its shape, which is that of `coplane_mesh check`, and of its height over that of the
/// cubes of a regular tetrahedron with edges of twice the size. The height is the volume over the
/// largest face, which the time step of one-point elements goes with. @param size [m]
Real worthOf(const std::array<Vec3, 8>& corners, Real size);
} // namespace coplane
