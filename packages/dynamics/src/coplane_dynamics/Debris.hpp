#pragma once

#include <coplane_checkpoint/StateTables.hpp>
#include <coplane_core/Comm.hpp>
#include <coplane_core/ExactSum.hpp>
#include <coplane_core/StateHash.hpp>
#include <coplane_dynamics/DebrisEnergy.hpp>
#include <coplane_dynamics/ElementForces.hpp>
#include <coplane_dynamics/Mirrors.hpp>
#include <coplane_dynamics/NodalState.hpp>
#include <coplane_mesh/NodeLayout.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <array>
#include <tuple>
#include <utility>
#include <vector>

namespace coplane
{
/// Nodes that have lost all their elements go on as mass points that faces stop. A point in a
/// living element that has a node at the surface stores k d^2/2, with its distance d from the
/// nearest point of the exterior faces of that body on which no other body lies, nor its own mirror
/// image; d counts from what it was when the point was freed in there, or came in there from the
/// inside of the body, as long as it has not come out. Force and counterforce are minus the
/// gradient of that, on one line, so both momenta stay. Beyond a plane of symmetry, or the axis of
/// a body of revolution, where a point is a ring, it is its image on this side.
///
/// Every rank has all points with the same bits: the owner of a node tells where it is, the owners
/// of faces tell which is the nearest, and every rank adds to the nodes that it owns, point after
/// point.
class Debris
{
public:
  /// @param ofRevolution bodies are turned about x = 0
  Debris(const Comm& comm, bool ofRevolution) : comm_(&comm), ofRevolution_(ofRevolution) {}

  /// An owned node that has become a point.
  struct FreeNode
  {
    GlobalId id = 0;
    Real mass = 0; ///< [kg]
    /// What there is of the point, with its images: a half in a plane of symmetry, a quarter where
    /// two meet at right angles [-].
    Real share = 1;
  };

  /// After elements have died or come: which nodes are points now, and which faces stop them.
  /// Collective.
  /// @param bodyOfNode number of the body of each node of this rank's elements
  void renew(const std::vector<FreeNode>& mine, std::vector<ExteriorFace> exterior,
             const Mirrors& mirrors, const std::vector<int>& bodyOfNode, const RankMesh& mesh,
             const ElementForces& elements, const NodeLayout& layout);

  /// Forces at n + 1 and what they add to the stiffness of the owned nodes; books the work of the
  /// step with the mean of the forces at its ends. Collective.
  /// @param dt the step from n to n + 1 [s]
  void addForces(const RankMesh& mesh, const ElementForces& elements, NodalState& state, Real dt);

  /// What points feel beyond planes of symmetry, faces do on this side: the difference comes from
  /// outside, and is in the books as such.
  /// @param dt of the kick [s]
  void bookImages(NodalState& state, Real dt) const;

  std::int64_t count() const { return std::int64_t(points_.size()); }
  std::int64_t touching() const { return touching_; } ///< points that faces push now
  DebrisEnergy energy() const;                        ///< the same bits on all ranks; collective

  // Part of a checkpoint, after renew(). Collective.
  void save(StateTables& out) const;
  void restore(const StateSource& in, const RankMesh& mesh, const ElementForces& elements,
               const NodalState& state);
  void addTo(StateHash& hash, std::uint64_t field) const;

private:
  struct Point
  {
    GlobalId id = 0;
    Real mass = 0;          ///< at the last renew(): mass scaling may have raised it since [kg]
    Real share = 1;         ///< of FreeNode
    int node = -1;          ///< local number where it is owned
    Real offset = infinity; ///< distance from the surface at which its force begins [m]
    bool inside = false;    ///< came over the surface, or from within, and has not come out
    bool between = false;   ///< came in over a face on which another body lies
    Real distance = 0;      ///< from the surface, while inside [m]
    Real speed = 0;         ///< against it [m/s]
    Image image;            ///< where it was looked at last

    /// In no element from which it can leave: it has come out, or is in a hair between bodies if it
    /// was too deep for that.
    /// @param way that it can have come [m]
    void goOnWithoutFace(Real way)
    {
      if (inside && distance > way)
        distance -= way;
      else
      {
        offset = 0;
        inside = between = false;
      }
    }
  };
  /// A living element with a node at the surface.
  struct NearSurface
  {
    int block = 0, element = 0, body = 0;
  };
  /// A point that lies in an element.
  struct Inside
  {
    int point = 0, body = 0;
  };
  /// Out of its body for a point: to the nearest place of a face.
  struct WayOut
  {
    int point = 0, body = 0, count = 0;
    GlobalId face = 0;
    Real distance = 0, stiffness = 0; ///< [m], [N/m]
    Real speed = 0;                   ///< of the point against the face [m/s]
    Vec3 outward{};                   ///< from the point to the face, of length 1
    std::array<Vec3, 5> beyond{};  ///< a little beyond the face, beside the place and all over [m]
    std::array<Real, 4> weights{}; ///< shape functions of the face's nodes

    bool operator<(const WayOut& other) const
    {
      return std::tie(point, distance, face) < std::tie(other.point, other.distance, other.face);
    }
  };
  struct WaysOut
  {
    std::vector<WayOut> nearest; ///< one, or several that are as near
    int point() const { return nearest.front().point; }
    std::vector<WayOut> open; ///< the nearest of those that lead out, likewise; or none
  };
  using NodeForces = std::vector<std::pair<int, Vec3>>;

  // Collective.
  std::vector<Vec3> ofPoints(const NodeVectors& field) const;
  std::vector<Vec3> placesOfPoints(const NodalState& state);
  std::vector<Inside> findInside(const std::vector<Vec3>& x, const RankMesh& mesh,
                                 const NodalState& state) const;
  std::vector<WayOut> facesBeside(const std::vector<Inside>& inside, const std::vector<Vec3>& x,
                                  const RankMesh& mesh, const ElementForces& elements,
                                  const NodalState& state) const;
  std::vector<char> areCovered(const std::vector<WayOut>& ways, const RankMesh& mesh,
                               const NodalState& state) const;
  std::vector<WaysOut> findWaysOut(const std::vector<Inside>& inside, const std::vector<Vec3>& x,
                                   const RankMesh& mesh, const ElementForces& elements,
                                   const NodalState& state) const;
  /// @param dt in which points came to where they are [s]
  void findForces(const RankMesh& mesh, const ElementForces& elements, const NodalState& state,
                  Real dt);

  /// A way out pushes a point by its share of the force, and the face back.
  /// @param place where it is looked at [m]
  void push(const Point& point, const Vec3& place, const WayOut& by, Real depth, Real share,
            const RankMesh& mesh, const NodalState& state);
  void bookHalfStep(const NodalState& state, Real dt);
  Real longestElement(const RankMesh& mesh, const NodalState& state) const;

  const Comm* comm_;
  bool ofRevolution_;
  std::vector<Mirror> mirrors_;
  std::vector<Point> points_;       ///< sorted by id, the same on all ranks
  std::vector<ExteriorFace> faces_; ///< local ones that lead somewhere
  std::vector<int> bodies_;         ///< of these
  std::vector<NearSurface> near_;   ///< local ones
  /// Most that the contact of a point can have: stiffness [N/m], and that over its mass [1/s^2].
  Real stiffest_ = 0, stiffestPerMass_ = 0;
  NodeForces forces_; ///< on owned nodes, of the last evaluation
  /// On an owned node that has crossed a mirror, what its image does not feel of that.
  struct FromOutside
  {
    int node = 0;
    Vec3 force{}, moment{}; ///< [N], about the origin [N m]
  };
  std::vector<FromOutside> fromOutside_;
  std::vector<std::pair<int, Real>> stiffness_;
  Real stored_ = 0; ///< [J]
  std::int64_t touching_ = 0;
  ExactSum work_; ///< of this rank's nodes, taken from them [J]
};
} // namespace coplane
