#pragma once

#include <coplane_contact/DirectionsOfNodes.hpp>
#include <coplane_contact/Faces.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_contact/Search.hpp>

#include <vector>

namespace coplane
{
/// What lies beyond the edges of faces, as they lie now. Where another body is flush, the surface
/// goes on over the seam, and the sides that lie on each other there are hidden: nothing comes to
/// them but through one of the two bodies.
class EdgesOfSurfaces
{
public:
  /// Lengths up to which bodies are flush: gap, step, and overhang of an edge, as a fraction of the
  /// size of the smaller face.
  static constexpr Real flush = 0.005;

  /// `pairs` are the candidates of this rank, among them all with a local face; `localFaces` are
  /// all that have an owned node, sorted by id. Collective.
  EdgesOfSurfaces(const std::vector<Face>& localFaces, const std::vector<CandidatePair>& pairs,
                  const std::vector<Face>& faces, const ConstNodeVectors& x, int dimension,
                  const NodeLayout& layout);

  /// Sets exits, turns and covered of a plane between two faces.
  void look(const Face& a, const Face& b, Plane& plane) const;

private:
  struct Edge;
  Edge edge(const Face& face, int side, int e, const Vec3& normal) const;
  void findHidden(const std::vector<CandidatePair>& pairs, const std::vector<Face>& faces,
                  const NodeLayout& layout);
  /// The body that hides the face with this normal up to its edge, beyond which lies one with the
  /// other normal; -1: none, or several.
  int hides(const int (&nodes)[2], const Vec3& normal, const Vec3& beyond) const;
  /// Size of the smaller one of two faces that lie on each other [m]; 0 if they do not.
  Real lieOn(const Face& a, const Face& b, const FacePlane& planeA, const FacePlane& planeB) const;

  ConstNodeVectors x_;
  int dimension_;
  DirectionsOfNodes normals_; ///< of the surfaces around a node
  DirectionsOfNodes hidden_;  ///< normals of hidden faces that end at a node, and who lies on them
  DirectionsOfNodes flush_;   ///< out over the edges at which they end
};
} // namespace coplane
