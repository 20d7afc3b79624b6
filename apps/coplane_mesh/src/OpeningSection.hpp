#pragma once

#include "BlocksRecipe.hpp"

#include <array>
#include <vector>

namespace coplane
{
/// Perimeter and area of the section of an opening [m, m^2].
std::array<Real, 2> measuresOf(const OpeningCard& card);

/// Width and height of the box around the section [m].
std::array<Real, 2> extentOf(const OpeningCard& card);

/// About how many corners sectionOf() gives.
Real cornersOf(const OpeningCard& card, Real size);

/// The corners of a section, to the right and upward [m]. A circle is a regular polygon of its
/// area, with sides of about `size`; a roof has its corners on the half circle.
std::vector<std::array<Real, 2>> sectionOf(const OpeningCard& card, Real size);
} // namespace coplane
