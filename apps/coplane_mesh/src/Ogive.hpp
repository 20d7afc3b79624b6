#pragma once

#include "Shapes.hpp"

namespace coplane
{
/// Bar of circular section with an ogive nose: tip at the origin, axis y, body towards +y. The
/// outline of the nose is an arc of radius `caliber` * width that runs into the shank without a
/// kink, so the nose is width sqrt(caliber - 1/4) long. In two dimensions the half section x >= 0,
/// for a body of revolution; in three the quarter x >= 0, z >= 0.
///
/// A triangle (tetrahedron) of the nose's base and its tip is cut into 3 quadrilaterals (4
/// hexahedra) that meet inside: no element has an angle near 180 degrees, none is thin at the tip.
/// `across` elements lie on the width (even, >= 4), `nose` on the axis of the nose
/// (> across / 4), `along` on the shank. `length` counts the nose.
Body ogiveNosed(int dimension, Real width, Real caliber, Real length, int across, int nose,
                int along);
/// [m]
Real ogiveLength(Real width, Real caliber);
} // namespace coplane
