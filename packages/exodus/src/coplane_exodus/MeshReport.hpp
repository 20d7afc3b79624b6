#pragma once

#include <coplane_mesh/MeshSlice.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace coplane
{
/// Findings of one kind: how many there are, and the first few in the order of the file.
template <class T>
struct Findings
{
  static constexpr std::size_t kept = 5;
  std::int64_t count = 0;
  std::vector<T> first;

  bool empty() const { return count == 0; }
};

/// Sizes of a mesh and everything about it that a computation would stumble over.
struct MeshReport
{
  struct BadElement
  {
    GlobalId element = 0;
    std::string block;
    Real volume = 0; ///< [m^3]; in two dimensions [m^2] times one metre
  };
  struct NodePair
  {
    GlobalId first = 0, second = 0;
  };
  struct ElementPair
  {
    GlobalId first = 0, second = 0;
    Vec3 place{}; ///< [m]
  };
  struct SharedFace
  {
    GlobalId elements[2] = {0, 0}; ///< the first two of those that have it
    int count = 0;
    Vec3 place{}; ///< [m]
  };
  struct BlockSummary
  {
    GlobalId id = 0;
    std::string name;
    std::string type;
    int elements = 0;
    std::int64_t bodies = 0; ///< parts that share no node with each other
    Real volume = 0;         ///< [m^3], or [m^2] times one metre
    Real worstQuality = 1;   ///< least elementQuality [-]
    GlobalId worstElement = 0;
    Vec3 worstPlace{}; ///< its centre [m]
  };
  /// A side set in which faces lie on each other pairwise.
  struct Joint
  {
    GlobalId id = 0;
    std::string name;
    std::int64_t pairs = 0;
    Findings<std::pair<GlobalId, int>> alone; ///< elements and sides (from 1) without partner
  };

  int dimension = 3;
  int nodes = 0;
  int elements = 0;
  std::int64_t bodies = 0;                ///< parts that share no node with each other
  Vec3 lowest{}, highest{};               ///< bounding box [m]
  Real shortestEdge = 0, longestEdge = 0; ///< [m]
  Vec3 shortestPlace{};                   ///< the middle of a shortest edge [m]
  std::vector<BlockSummary> blocks;
  Findings<BadElement> inverted;      ///< volume zero or negative
  Findings<BadElement> repeatedNodes; ///< a node occurs twice in the element
  Findings<GlobalId> unusedNodes;     ///< of no element
  Findings<BadElement> folded;        ///< volume positive, but a corner turned inside out
  Findings<NodePair> coincident;      ///< two nodes of one body at one place, not of joints
  Findings<ElementPair> twice;        ///< two elements with their centres at one place
  Findings<SharedFace> overused;      ///< faces (2D: edges) of more than two elements
  std::vector<Joint> joints;          ///< side sets that hold both sides of a joint

  /// Largest coordinate as a multiple of the shortest edge up to which the sixteen digits of a
  /// coordinate leave enough for the shape of an element [-]: 4 of them.
  static constexpr Real farthest = 1e12;
  bool tooFar() const;

  /// No computation can start with inverted elements, repeated nodes or coordinates that are too
  /// far; the other findings are for the eye.
  bool usable() const { return inverted.empty() && repeatedNodes.empty() && !tooFar(); }
};

/// Of a mesh of which every rank has a slice; the same on all ranks, and for any number of them.
/// Collective.
/// @param home the part that this rank has at home: partAtHome()
MeshReport reportMesh(const MeshSlice& slice, const RankMesh& home, const Comm& comm);
MeshReport reportMesh(const Mesh& mesh);

/// One sentence per kind of finding, with ids (the first few of many) and advice; empty for a
/// faultless mesh.
std::vector<std::string> meshProblems(const MeshReport& report);
std::vector<std::string> meshProblems(const Mesh& mesh);

/// Shape of an element: the least over its corners of the volume of the edges there over the
/// product of their lengths, divided by that of the ideal shape (equilateral or cube) [-]. 1 is
/// ideal, 0 flat, negative folded.
Real elementQuality(ElementType type, const std::array<Vec3, 8>& corners);

/// Area of a triangle or quadrilateral times one metre, or volume of a tetrahedron or a trilinear
/// hexahedron (Flanagan & Belytschko 1981) [m^3]; negative when the element is inside out.
/// `corners` holds topology(type).nodes positions.
Real elementVolume(ElementType type, const std::array<Vec3, 8>& corners);
} // namespace coplane
