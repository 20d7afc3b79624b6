#pragma once

#include "GmshFile.hpp"

namespace coplane
{
/// Area or volume of all triangles and quadrilaterals, or tetrahedra, together [m^2, m^3],
/// whichever way round. Not a number when more than two tetrahedra share a face.
Real measureOfElements(const GmshFile& mesh, int dimension);
} // namespace coplane
