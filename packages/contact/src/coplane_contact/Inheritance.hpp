#pragma once

#include <coplane_contact/Faces.hpp>
#include <coplane_contact/Plane.hpp>

#include <vector>

// What a plane hands on to the pairs of faces that take over from it while bodies slide.

namespace coplane
{
/// Planes that carry something, and joints that have just been closed.
bool isDonor(const Plane& plane);

/// What a plane has to give.
Donor donorOf(const Plane& plane);

/// Gives a new plane the means of its donors, weighted by their areas and summed in the order of
/// their keys. Returns whether there were any that fit: of the same joint, with nearly the same
/// normal.
bool inherit(Plane& plane, const Vec3& normal, std::vector<Donor>& donors);
} // namespace coplane
