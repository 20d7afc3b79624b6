#pragma once

#include "Recipe.hpp"

#include <coplane_core/Vec3.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// What is cut into blocks.
struct DomainCard
{
  struct Box
  {
    std::vector<Real> min, max; ///< [m]
  };
  std::string block = "rock";
  Box box;                                ///< empty: not given
  std::vector<std::vector<Real>> polygon; ///< 2D [m]; empty: not given
  std::string file;                       ///< 3D: surfaces of solids; empty: not given
  std::string joint;                      ///< where solids of a file touch; empty: welded
  std::string supports = "supports";      ///< block of the solids of an assembly that stand still
};

/// A hole, or a part of the domain that is kept to be dug out later: a section at a point (2D), or
/// along a path (3D).
struct OpeningCard
{
  std::string name, where;
  Real circle = 0;                        ///< radius [m]; 0: no circle
  std::vector<Real> horseshoe;            ///< width and height [m]; empty: none
  std::vector<std::vector<Real>> polygon; ///< [m]; empty: none
  std::vector<Real> at;                   ///< 2D: the origin of the section [m]
  std::vector<std::vector<Real>> path;    ///< 3D: the ends of a straight line [m]
  Real elementSize = 0;                   ///< at its wall [m]; 0: as elsewhere
  bool keep = false;
};

/// Parallel joints with scatter.
struct JointSetCard
{
  Real angle = 0;                       ///< 2D: of the traces [degrees]
  Real dip = 0, dipDirection = 0;       ///< 3D [degrees]
  Real spacing = 0, spacingScatter = 0; ///< [m], [-]
  Real angleScatter = 0;                ///< 2D: standard deviation [degrees]
  Real fisher = 0;                      ///< 3D: concentration [-]; 0: none
  Real persistence = 1, length = 0;     ///< [-], [m]
  std::vector<Real> through;            ///< a point of one of them [m]; empty: middle
};

/// One plane, or some parallel ones, and which part of them.
struct JointPlaneCard
{
  struct Disc
  {
    std::vector<Real> centre; ///< [m]
    Real radius = 0;          ///< [m]
  };
  std::string where;
  std::vector<Real> point, normal; ///< [m], [-]
  Real spacing = 0;                ///< [m]; 0: one plane
  int count = 1;
  Disc disc;                                       ///< 3D; of radius 0: no limit
  std::vector<std::vector<Real>> segment, polygon; ///< [m]; empty: no limit
};

/// Cells around random points.
struct VoronoiCard
{
  int cells = 0;
  int relaxations = 0;
};

/// One entry of `joints`.
struct JointsCard
{
  std::string name, where;
  JointSetCard set;
  std::vector<JointPlaneCard> planes;
  std::string file;
  VoronoiCard voronoi;
};

enum class BlockElements
{
  Simplices, ///< triangles, tetrahedra
  Cubes      ///< quadrilaterals, hexahedra
};

/// Smaller elements in a part of the domain: in a box, or in the blocks of an element block.
struct ElementSizeCard
{
  std::string where;
  DomainCard::Box box; ///< empty: not given
  std::string block;   ///< empty: not given
  Real size = 0;       ///< [m]
};

struct BlockElementsCard
{
  Real size = 0; ///< [m]
  BlockElements shape = BlockElements::Simplices;
  Real growth = 0.3;     ///< of the size with the distance from openings and regions [-]
  Real most = 5e6;       ///< elements, by an estimate
  Real mostParts = 5000; ///< between joints, and sides of openings, by an estimate
  Real timeLimit = 3600; ///< of each step of cutting and meshing [s]
  std::vector<ElementSizeCard> regions;
};

struct SliverCard
{
  Real volume = -1;    ///< of blocks that are joined to others [m^3, 2D: m^2]; -1: by size
  Real stub = -1;      ///< ends of joints beyond others that are left out [m]; -1: by size
  Real thickness = -1; ///< the same of their volume over their largest face [m]; -1: by size
  Real shape = 0.003;  ///< of elements, the least that is written [-]
};

/// What a recipe of blocks says.
struct BlocksRecipe : Recipe
{
  int seed = 1;
  Vec3 up{0, 0, 1}, north{0, 1, 0};
  DomainCard domain;
  std::vector<OpeningCard> openings;
  std::vector<JointsCard> joints;
  BlockElementsCard elements;
  SliverCard slivers;
};

/// What counts as a sliver, with the defaults that go with the size of elements.
struct SliverLimits
{
  Real volume = 0;    ///< [m^3, 2D: m^2]
  Real thickness = 0; ///< [m]
  Real stub = 0;      ///< [m]
};
SliverLimits limitsOf(const BlocksRecipe& recipe);

/// The least size of elements that the recipe asks for anywhere [m].
Real leastSizeOf(const BlocksRecipe& recipe);

const Key& blocksRecipeSchema();
const FileKind& blocksRecipeFile();

/// Reads and checks a recipe of blocks. Throws Error(ExitCode::Deck) with every problem that was
/// found, one per line.
BlocksRecipe parseBlocksRecipe(const std::string& text, const std::string& file,
                               const std::vector<std::string>& overrides = {});
} // namespace coplane
