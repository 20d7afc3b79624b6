#pragma once

#include <coplane_contact/Faces.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_contact/Search.hpp>
#include <coplane_core/NodeViews.hpp>
#include <coplane_mesh/NodeLayout.hpp>

#include <vector>

namespace coplane
{
/// Outward unit normals of the surface at all nodes of a layout: means of the faces around a node
/// by their angles, so that they do not depend on how a surface is meshed; zero where a node has no
/// face. `localFaces` are all that have an owned node, sorted by id. Collective.
NodeVectors nodeNormals(const std::vector<Face>& localFaces, const ConstNodeVectors& x,
                        int dimension, const NodeLayout& layout);

/// What lies beyond the edges of faces, as they lie now. Where another body is flush, the surface
/// goes on over the seam, and the sides that lie on each other there are hidden: nothing comes to
/// them but through one of the two bodies.
class EdgesOfSurfaces
{
public:
  /// Lengths up to which bodies are flush: gap, step, and overhang of an edge, as a fraction of the
  /// size of the smaller face.
  static constexpr Real flush = 0.005;

  /// `pairs` are the candidates of this rank, among them all with a local face. Collective.
  EdgesOfSurfaces(const std::vector<Face>& localFaces, const std::vector<CandidatePair>& pairs,
                  const std::vector<Face>& faces, const ConstNodeVectors& x, int dimension,
                  const NodeLayout& layout);

  /// Sets exits, turns and covered of a plane between two faces.
  void look(const Face& a, const Face& b, Plane& plane) const;

private:
  struct Edge;
  Edge edge(const Face& face, int side, int e, const Vec3& normal) const;
  void findFlushNodes(const std::vector<CandidatePair>& pairs, const std::vector<Face>& faces,
                      const NodeLayout& layout);
  bool lieOn(const Face& a, const Face& b, const FacePlane& planeA, const FacePlane& planeB) const;
  /// n.Q.n of the sum Q of the dyads of normals of hidden faces at a node.
  Real hiddenAlong(int node, const Vec3& n) const;

  ConstNodeVectors x_, normals_;
  NodeVectors squares_, products_; ///< Q: xx yy zz, xy yz zx
  int dimension_;
};
} // namespace coplane
