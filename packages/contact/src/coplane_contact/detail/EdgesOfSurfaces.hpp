#pragma once

#include <coplane_contact/Faces.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_contact/Search.hpp>
#include <coplane_contact/detail/DirectionsOfNodes.hpp>
#include <coplane_contact/detail/NormalsOfNodes.hpp>
#include <coplane_geometry/Mirror.hpp>

#include <cstdint>
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

  /// `pairs` are the candidates of this rank, among them all with a local face; of the faces, all
  /// that have an owned node come first, sorted by id. `planes` are those of the faces. All of this
  /// has to live on. In `mirrors` surfaces go on as their images. Collective.
  EdgesOfSurfaces(const std::vector<CandidatePair>& pairs, const Array<Face>& faces,
                  std::size_t localFaces, const Array<FacePlane>& planes, const ConstNodeVectors& x,
                  int dimension, const std::vector<Mirror>& mirrors, const NodeLayout& layout);

  /// Sets exits, turns, covered and seams of the plane of a pair.
  void look(std::size_t pair, Plane& plane) const;

private:
  struct Edge
  {
    Vec3 outward; ///< in the face, away from it over the edge
    int nodes[2]; ///< in two dimensions twice the same
    bool turns;   ///< outwards
    Vec3 beyond;  ///< normal of the surface beyond an edge at which it turns
  };
  struct Beyond;
  bool isWayOut(const Beyond& a, const Beyond& b, const Vec3& normalA, const Vec3& normalB) const;
  Edge lookBeyond(const Face& face, int e, const Vec3& normal,
                  const std::vector<Mirror>& mirrors) const;
  void findEdges(const std::vector<Mirror>& mirrors);
  /// Edge e of the outline of face 0 or 1 of a pair.
  const Edge& edge(int face, int side, int e) const;
  void findHidden(const NodeLayout& layout);
  /// The body that hides the face with this normal up to its edge, beyond which lies one with the
  /// other normal; -1: none, or several.
  /// @param ends where hidden faces end: flush_, or goingOn_
  int hides(const int (&nodes)[2], const Vec3& normal, const Vec3& beyond,
            const DirectionsOfNodes& ends) const;
  /// Size of the smaller one of two faces that lie on each other [m]; 0 if they do not.
  Real lieOn(int a, int b) const;

  const std::vector<CandidatePair>& pairs_;
  Array<Face> faces_;
  Array<FacePlane> planes_;
  ConstNodeVectors x_;
  int dimension_;
  std::vector<std::int32_t> firstEdge_; ///< by face; -1: in no pair
  std::vector<Edge> edges_;
  std::vector<Real> lieOn_;   ///< by pair
  NormalsOfNodes normals_;    ///< of the faces around a node
  DirectionsOfNodes hidden_;  ///< normals of hidden faces that end at a node, and who lies on them
  DirectionsOfNodes flush_;   ///< out over the edges at which they end
  DirectionsOfNodes goingOn_; ///< out over those where both bodies turn the same way: one surface
};
} // namespace coplane
