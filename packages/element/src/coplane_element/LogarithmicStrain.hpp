#pragma once

#include <coplane_core/Vec3.hpp>
#include <coplane_mesh/ElementTopology.hpp>

namespace coplane
{
/// Strain of an element at its middle: ln V, where F = V R is the gradient of its map from the
/// reference places to the present ones (the logarithmic, or Hencky, strain on spatial axes). It
/// does not see rotations, its trace is ln det F there, and where strains are small it is the
/// engineering one with half of the shear angles. An output only: laws go by rates. It is as exact
/// as the places are: round-off of them over the size of the element.
/// @param reference, present corners, as many as topology(type).nodes, in its order [m]
/// @param revolved bodies of revolution about the y axis: zz is the hoop strain; else, in two
///        dimensions, zero
/// @return xx, yy, zz, xy, yz, zx, of the tensor, longer positive [-]; not a number where the
///         reference has no volume, or nothing is left of the present one
SymTensor logarithmicStrain(ElementType type, const Vec3* reference, const Vec3* present,
                            bool revolved);
} // namespace coplane
