#pragma once

#include <coplane_contact/Faces.hpp>
#include <coplane_contact/HalfStepFace.hpp>
#include <coplane_core/NodeViews.hpp>

namespace coplane
{
/// What step A needs of a face that is at rest at x.
inline FaceNodes nodesOf(const Face& face, const ConstNodeVectors& x)
{
  FaceNodes nodes;
  nodes.count = face.count;
  for (int k = 0; k < face.count; ++k)
    nodes.x[k] = at(x, face.nodes[k]);
  return nodes;
}
} // namespace coplane
