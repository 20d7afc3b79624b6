#pragma once

#include <coplane_contact/Faces.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_contact/Search.hpp>

#include <cstddef>
#include <utility>
#include <vector>

namespace coplane
{
struct NewPair;

/// What the living planes of all faces have to give at one time, to pairs that take over from them
/// while bodies slide. Pairs ask when they come near, and are told what was true at that time.
class Heritage
{
public:
  /// Where the faces of the last search are at that time.
  struct Place
  {
    Array<Face> faces; ///< local, then ghost
    ConstNodeVectors x;
    std::vector<GlobalId> nodeIds;
    int dimension = 3;
    Real reach = 0; ///< how far faces move until the next time [m]
    bool axisymmetric = false;
  };

  /// @param donors all living planes of the faces, in any order, some of them twice
  Heritage(Place place, std::vector<Donor> donors);

  /// What they pass on to a pair that has not touched yet, in place of what it had from others.
  /// @param sharedBefore area that its faces shared when the pair was last looked at; negative: it
  ///        is new [m^2]
  void passOn(Plane& plane, Real sharedBefore) const;

private:
  void addDonors(int face, const Plane& plane, const Vec3& normal,
                 std::vector<Donor>& donors) const;
  NewPair newPair(const Plane& plane, const Vec3& normal, Real sharedBefore) const;

  const Place place_;
  const std::vector<Donor> donors_;
  std::vector<std::pair<GlobalId, std::size_t>> donorsOfFace_; ///< by id of the face, sorted
};

/// The positions now: those of the run go on.
ConstNodeVectors copyOf(const ConstNodeVectors& x);
} // namespace coplane
