#pragma once

#include <coplane_contact/Faces.hpp>
#include <coplane_contact/Plane.hpp>

#include <array>
#include <vector>

// What a plane hands on to the pairs of faces that take over from it while bodies slide.

namespace coplane
{
/// Planes that carry something, and joints that have just been closed.
bool isDonor(const Plane& plane);

/// What a plane has to give; without the nodes of its faces.
Donor donorOf(const Plane& plane);

/// The nodes of a new plane's faces, in its order; 0: none.
using PairNodes = std::array<std::array<GlobalId, 4>, 2>;

/// Gives a new plane the means of its donors, weighted by their areas and summed in the order of
/// their keys. Returns whether there were any that fit: of the same joint, with nearly the same
/// normal. A donor that has one face in common with the plane, and whose other face shares a node
/// with the plane's other one, shows that the plane only slides on over the same surface.
bool inherit(Plane& plane, const Vec3& normal, const PairNodes& nodes, std::vector<Donor>& donors);
} // namespace coplane
