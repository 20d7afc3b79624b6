#pragma once

#include <coplane_core/Vec3.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// What is wrong with the corners of a polygon in a plane, as the end of a sentence that begins
/// with it: a corner twice running, no area, sides that cross. Empty: nothing. Gmsh makes nonsense
/// of such polygons, without a word.
std::string problemOfPolygon(const std::vector<Vec3>& corners);
} // namespace coplane
