#pragma once

#include <coplane_contact/Faces.hpp>
#include <coplane_contact/Search.hpp>
#include <coplane_core/NodeViews.hpp>
#include <coplane_mesh/NodeLayout.hpp>

#include <cstdint>
#include <vector>

namespace coplane
{
/// Outward unit normals of the surface at all nodes of a layout: means of the faces around a node
/// by their angles, so that they do not depend on how a surface is meshed; zero where a node has no
/// face. `localFaces` are all that have an owned node, sorted by id. Collective.
NodeVectors nodeNormals(const std::vector<Face>& localFaces, const ConstNodeVectors& x,
                        int dimension, const NodeLayout& layout);

/// The edges over which the bodies of a pair can part sideways, as Plane::exits: beyond such an
/// edge the surface turns away from the other face, so that a way along the plane leads out.
std::uint8_t waysOut(const Face& a, const Face& b, const FacePlane& planeA, const FacePlane& planeB,
                     const ConstNodeVectors& x, const ConstNodeVectors& normals, int dimension);
} // namespace coplane
