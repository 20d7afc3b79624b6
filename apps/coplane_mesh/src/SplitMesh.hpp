#pragma once

#include "MeshFaces.hpp"

#include <string>
#include <vector>

namespace coplane
{
/// Interior faces that a joint shall open, as positions in facesOf(mesh), ascending.
struct Cut
{
  std::string name; ///< of the side set that is written
  std::vector<int> faces;
};

/// What a cut has done.
struct CutReport
{
  std::string name;
  int opened = 0;         ///< faces that became two
  Real area = 0;          ///< of those [m^2; 2D: m]
  int closed = 0;         ///< faces that stay one: all their nodes are on the rim of the joint
  Real largestClosed = 0; ///< area of the largest of those [m^2; 2D: m]
  Vec3 closedPlace{};     ///< its middle [m]
};

struct SplitMesh
{
  Mesh mesh;
  std::vector<CutReport> cuts;
  int copies = 0;           ///< nodes added
  std::vector<Vec3> hinges; ///< places of nodes without a cut that were opened [m]
  int bodiesBefore = 0;     ///< parts that share no node
  int bodies = 0;           ///< the same after
};

/// Away from cuts nodes stay, or hinges are opened, too: nodes by which alone, or with an edge,
/// parts hang together.
enum class Hinges
{
  Stay,
  Open
};

/// Opens the cuts: the elements around a node fall into groups that hang together through faces
/// that are not cut, and every group but the first (the one with the first element) gets a copy of
/// the node. So a tip stays one node, a joint gives two, a crossing of two joints four.
///
/// Node ids and element ids stay; copies get ids after the largest and the last places. A copy
/// belongs to a node set of its original when its group has another node of the set that is not on
/// the cut faces at the node; where no group has one, all copies belong. Side sets stay as they
/// are; each cut adds one with both faces of all it opened. body_id is numbered anew. A face in
/// several cuts belongs to the first.
SplitMesh splitMesh(const Mesh& mesh, const std::vector<MeshFace>& faces,
                    const std::vector<Cut>& cuts, Hinges hinges = Hinges::Stay);
} // namespace coplane
