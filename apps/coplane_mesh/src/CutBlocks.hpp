#pragma once

#include "BlocksRecipe.hpp"
#include "GmshFile.hpp"
#include "LeftOut.hpp"
#include "RunApart.hpp"

#include <string>
#include <vector>

namespace coplane
{
/// A conforming mesh of a domain that joints cut: physical groups of the highest dimension are its
/// element blocks, those below the faces of the joints inside.
struct CutDomain
{
  GmshFile mesh;
  std::vector<std::string>
      joints; ///< their names, by the order of the recipe; then that between solids
  std::vector<JointMeasure> measures; ///< by joint
  std::vector<Real> blockVolumes;     ///< [m^3; 2D: m^2]
  std::vector<std::string> notes;     ///< what was odd, for the user
  int joined = 0;                     ///< slivers that became part of a neighbour
  int stubs = 0;                      ///< ends of joints that were left out
  int slivers = 0;                    ///< those that have stayed, without a joint to be left out
  int changes = 0;                    ///< by which flat elements were mended
  Real worstBefore = 1, worst = 1;    ///< the least worth of an element before and after mending
  Vec3 worstPlace{};                  ///< the middle of that one [m]
};

/// How Gmsh meshes; where one way fails another one often works.
struct MeshingWay
{
  std::string name = "as always";
  int seed = 1;          ///< of what Gmsh does at random
  int faceAlgorithm = 6; ///< Gmsh's number: 6 frontal, 5 Delaunay
  Real sizeFactor = 1;   ///< on all sizes of elements [-]
};

/// The stage in which another way may help.
inline const std::string meshingStage = "Gmsh made the mesh";

/// Cuts and meshes with Gmsh. Throws Error(ExitCode::Deck) for what the recipe says wrong,
/// Error(ExitCode::Mesh) for a mesh that is no good, Error(ExitCode::Computation) with Gmsh's words
/// where Gmsh gives up.
CutDomain cutDomain(const BlocksRecipe& recipe, const std::string& recipeFile,
                    const MeshingWay& way, Stages& stages);
} // namespace coplane
