#pragma once

#include <coplane_schema/DeckNode.hpp>
#include <coplane_schema/Schema.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// Parallel planes on which a joint lies, and which part of them.
struct PlanesCard
{
  struct Box
  {
    std::vector<Real> min, max; ///< [m]
  };
  struct Disc
  {
    std::vector<Real> centre; ///< [m]
    Real radius = 0;          ///< [m]
  };

  std::string where;
  std::vector<Real> point, normal;                 ///< [m], [-]
  Real spacing = 0;                                ///< [m]; 0: one plane
  int count = 0;                                   ///< 0: as many as meet the mesh
  Real tolerance = 0;                              ///< [m]; 0: 1e-6 of the mesh size
  Real angle = 1;                                  ///< [degrees]
  Box box;                                         ///< empty: no limit
  Disc disc;                                       ///< of radius 0: no limit
  std::vector<std::vector<Real>> segment, polygon; ///< [m]; empty: no limit
};

/// One entry of `joints`.
struct JointCutCard
{
  std::string name, where;
  std::vector<PlanesCard> planes;
  std::vector<std::vector<std::string>> blocks; ///< pairs, or the word all alone
  std::vector<std::string> sideSets;
  std::vector<std::string> everyFace; ///< blocks, or the word all alone
};

/// What a recipe of joints says.
struct JointRecipe
{
  std::vector<JointCutCard> joints;
  DeckNode root; ///< for messages
};

const Key& jointRecipeSchema();
const FileKind& jointRecipeFile();

/// Reads and checks a recipe of joints for a mesh of this dimension. Throws Error(ExitCode::Deck)
/// with every problem that was found, one per line.
JointRecipe parseJointRecipe(const std::string& text, const std::string& file, int dimension,
                             const std::vector<std::string>& overrides = {});
} // namespace coplane
