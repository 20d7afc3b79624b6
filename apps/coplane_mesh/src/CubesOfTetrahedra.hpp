#pragma once

#include "GmshFile.hpp"

namespace coplane
{
/// Cuts every tetrahedron of a mesh into four hexahedra, every triangle into three quadrilaterals,
/// at the middles of edges, faces and elements, which become nodes after all others.
void cutIntoCubes(GmshFile& mesh);
} // namespace coplane
