#pragma once

#include <coplane_mesh/Mesh.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// One of several meshes that become one.
struct MeshToMerge
{
  Mesh mesh;
  std::string source; ///< what messages call it
  std::string prefix; ///< put before the names of its blocks and sets
  bool join = false;  ///< its blocks and sets go into those before them that have their names
};

struct MergedMesh
{
  Mesh mesh;
  std::vector<int> welded;        ///< by mesh: its nodes that have become one with a node before
  std::vector<std::string> notes; ///< what was odd, for the user
};

/// Puts meshes side by side, in their order. Blocks, node sets and side sets keep their order and
/// names; ids of all, of nodes and of elements, count from 1. body_id is numbered anew, by parts
/// that share no node. The title is that of the first.
///
/// @param weld nodes of different meshes that are no farther apart become one, at the place of the
/// first [m]; 0: none do, and bodies that touch are in contact
/// @throws Error(ExitCode::Mesh) for meshes of different dimension, for a name that is there
/// already and is not to be joined, for blocks of one name with elements of different types; with
/// weld for a node that has two nodes of the other mesh near it, for an element that would have one
/// node twice and when nothing is near enough
MergedMesh mergeMeshes(const std::vector<MeshToMerge>& meshes, Real weld = 0);
} // namespace coplane
