#include <coplane_contact/WaysOut.hpp>

#include <algorithm>
#include <cmath>

namespace coplane
{
NodeVectors nodeNormals(const std::vector<Face>& localFaces, const ConstNodeVectors& x,
                        int dimension, const NodeLayout& layout)
{
  NodeVectors normals("coplane::contact::nodeNormals", layout.size());
  for (const Face& face : localFaces)
  {
    const FacePlane plane = facePlane(face, x, dimension);
    for (int k = 0; k < face.count; ++k)
    {
      const int node = face.nodes[k];
      if (node >= layout.owned())
        continue;
      Real angle = 1;
      if (dimension == 3)
      {
        const Vec3 here = at(x, node);
        const Vec3 before = at(x, face.nodes[k == 0 ? face.count - 1 : k - 1]) - here;
        const Vec3 after = at(x, face.nodes[k + 1 == face.count ? 0 : k + 1]) - here;
        angle = std::atan2(norm(cross(after, before)), dot(after, before));
      }
      set(normals, node, at(normals, node) + angle * plane.normal);
    }
  }
  layout.refresh(normals, normals);
  return normals;
}

namespace
{
/// Surfaces that turn by less than this over an edge go on [-]: tangent of half of 20 degrees.
constexpr Real goesOn = 0.17632698;
/// Beyond an edge a surface still faces the other one if its normal has more than this against it.
constexpr Real stillOpposed = 0.1;

/// Whether the surface turns away from `other` over an edge of a face with normal n; outward: in
/// the face, away from it over the edge. The nodes' normals halve the angle at an edge.
bool turnsAway(const Vec3& n, const Vec3& outward, const Vec3& other, const Vec3* nodeNormals,
               int count)
{
  Real half = infinity; // tangent of half of the angle
  for (int i = 0; i < count; ++i)
  {
    const Real up = dot(nodeNormals[i], n), out = dot(nodeNormals[i], outward);
    half = std::min(half, up > 0 ? out / up : out > 0 ? infinity : 0);
  }
  if (!(half > goesOn))
    return false;
  const Real square = half * half;
  const Real cosine = std::isinf(half) ? -1 : (1 - square) / (1 + square);
  const Real sine = std::isinf(half) ? 0 : 2 * half / (1 + square);
  return cosine * dot(n, other) + sine * dot(outward, other) > -stillOpposed;
}
} // namespace

std::uint8_t waysOut(const Face& a, const Face& b, const FacePlane& planeA, const FacePlane& planeB,
                     const ConstNodeVectors& x, const ConstNodeVectors& normals, int dimension)
{
  std::uint8_t exits = 0;
  for (int f = 0; f < 2; ++f)
  {
    const Face& face = f == 0 ? a : b;
    const Vec3& n = f == 0 ? planeA.normal : planeB.normal;
    const Vec3& other = f == 0 ? planeB.normal : planeA.normal;
    for (int e = 0; e < face.count; ++e)
    {
      Vec3 outward, ofNodes[2];
      if (dimension == 2) // the "edge" is node e
      {
        ofNodes[0] = at(normals, face.nodes[e]);
        outward = normalised(at(x, face.nodes[e]) - at(x, face.nodes[1 - e]));
      }
      else
      {
        // Edge e of the outline: that of the higher face runs the other way.
        const int next = e + 1 == face.count ? 0 : e + 1;
        const int i0 = f == 0 ? e : face.count - 1 - next, i1 = f == 0 ? next : face.count - 1 - e;
        const Vec3 along = at(x, face.nodes[i1]) - at(x, face.nodes[i0]);
        ofNodes[0] = at(normals, face.nodes[i0]);
        ofNodes[1] = at(normals, face.nodes[i1]);
        outward = normalised(cross(along, n));
      }
      if (turnsAway(n, outward, other, ofNodes, dimension == 2 ? 1 : 2))
        exits = std::uint8_t(exits | 1 << (4 * f + e));
    }
  }
  return exits;
}
} // namespace coplane
