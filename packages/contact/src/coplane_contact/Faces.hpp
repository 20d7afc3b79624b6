#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>
#include <coplane_joint/JointState.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace coplane
{
/// An exterior face that this rank knows, local or ghost.
struct Face
{
  GlobalId id = 0;
  int count = 0;
  int nodes[4] = {-1, -1, -1, -1}; ///< local nodes, outward normal by the right-hand rule
  int far[4] = {-1, -1, -1, -1};   ///< other nodes of the element behind it; -1: not known here
  int block = 0;                   ///< element block behind it
  int group = 0;                   ///< row of the table of contact rules
  int body = 0;                    ///< number of the body at the start, the same on all ranks
  Real thickness = 0; ///< of the element behind it when the face was born: volume / area [m]
  Real modulus = 0;   ///< P-wave modulus of the undamaged material [Pa]
  /// That moves with it: half of the element behind it [kg]; in bodies of revolution of one metre
  /// of the undeformed hoop.
  Real mass = 0;
  Real pressure = 0;  ///< of conditions on it at t = 0: a declared joint does not carry it [Pa]
  bool local = false; ///< this rank owns at least one node
  bool ownedHere =
      false;          ///< this rank owns the node with the lowest id: it sends the face to others
  bool young = false; ///< was inside the body until now: planes on it inherit nothing
  bool rigid = false; ///< the element behind it is never computed
  bool thin = false;  ///< all nodes of the element behind it are at the surface: so may a back be
  /// By node: bit i says that it is held in mirror i of the contact rules.
  std::uint8_t mirrors[4] = {0, 0, 0, 0};

  /// It lies in a mirror: bodies go on beyond, so it is no surface and nothing comes to it.
  bool isCut() const
  {
    std::uint8_t all = mirrors[0];
    for (int k = 1; k < count; ++k)
      all &= mirrors[k];
    return all != 0;
  }
};

/// What is deep behind one of them may be near its back.
inline bool isShallow(const Face& a, const Face& b)
{
  return a.thin || b.thin;
}

/// A face on its way to another rank.
struct GhostFace
{
  GlobalId id = 0;
  GlobalId nodes[4] = {0, 0, 0, 0}; ///< ids
  GlobalId far[4] = {0, 0, 0, 0};   ///< ids of the other nodes of the element; 0: none
  int count = 0;
  int block = 0;
  int group = 0;
  int body = 0;
  Real thickness = 0;
  Real modulus = 0;
  Real mass = 0;
  Real pressure = 0;
  bool young = false;
  bool rigid = false;
  bool thin = false;
  std::uint8_t mirrors[4] = {0, 0, 0, 0};
};

/// The face with this id among faces, or ghost faces, that are sorted by id; `last`: not there.
template <class Iterator>
Iterator findFace(Iterator first, Iterator last, GlobalId id)
{
  const Iterator found = std::lower_bound(
      first, last, id, [](const auto& face, GlobalId wanted) { return face.id < wanted; });
  return found != last && found->id == id ? found : last;
}
template <class AnyFace>
bool hasFace(const std::vector<AnyFace>& faces, GlobalId id)
{
  return findFace(faces.begin(), faces.end(), id) != faces.end();
}

/// A face as it is sent; `nodeIds` turns local nodes into ids.
inline GhostFace toGhostFace(const Face& face, const std::vector<GlobalId>& nodeIds)
{
  GhostFace ghost;
  ghost.id = face.id;
  ghost.count = face.count;
  ghost.block = face.block;
  ghost.group = face.group;
  ghost.body = face.body;
  ghost.thickness = face.thickness;
  ghost.modulus = face.modulus;
  ghost.mass = face.mass;
  ghost.pressure = face.pressure;
  ghost.young = face.young;
  ghost.rigid = face.rigid;
  ghost.thin = face.thin;
  std::copy_n(face.mirrors, 4, ghost.mirrors);
  for (int k = 0; k < face.count; ++k)
    ghost.nodes[k] = nodeIds[face.nodes[k]];
  for (int k = 0; k < 4; ++k)
    ghost.far[k] = face.far[k] >= 0 ? nodeIds[face.far[k]] : 0;
  return ghost;
}

/// A face that has arrived; `localNode(id)` is the place of a node here.
template <class LocalNode>
Face toFace(const GhostFace& ghost, const LocalNode& localNode)
{
  Face face;
  face.id = ghost.id;
  face.count = ghost.count;
  face.block = ghost.block;
  face.group = ghost.group;
  face.body = ghost.body;
  face.thickness = ghost.thickness;
  face.modulus = ghost.modulus;
  face.mass = ghost.mass;
  face.pressure = ghost.pressure;
  face.young = ghost.young;
  face.rigid = ghost.rigid;
  face.thin = ghost.thin;
  std::copy_n(ghost.mirrors, 4, face.mirrors);
  for (int k = 0; k < ghost.count; ++k)
    face.nodes[k] = localNode(ghost.nodes[k]);
  // A rank that owns a node of a face knows all nodes of the element: those that the elements of a
  // pair have in common are known wherever the pair is.
  for (int k = 0; k < 4; ++k)
    face.far[k] = ghost.far[k] != 0 ? localNode(ghost.far[k]) : -1;
  return face;
}

/// What a new plane can inherit from a living one. Travels with ghost faces, so that every rank
/// that computes a new pair sees the same donors.
struct Donor
{
  GlobalId faceId[2] = {0, 0};
  GlobalId nodes[2][4] = {}; ///< ids of the nodes of its faces; 0: none
  int count[2] = {0, 0};     ///< nodes of its faces; 0: not known
  int body[2] = {0, 0};      ///< of its faces
  Vec3 corners[2][4] = {};   ///< of its faces, now [m]
  int joint = 0;
  bool rests = false; ///< carries nothing now
  // To the pair that looks for donors; not sent.
  bool flush = false;
  bool ofSameBodies = true; ///< the same two
  Vec3 normal{};
  Real area = 0;
  // What is passed on (PlaneState.hpp), as in its plane.
  Real offset = 0;
  Real closure = 0;
  JointState history;
};
} // namespace coplane
