#pragma once

#include <coplane_schema/DeckNode.hpp>
#include <coplane_schema/Schema.hpp>

#include <memory>
#include <string>
#include <vector>

namespace coplane
{
/// Where something goes.
struct PlacementCard
{
  int dimension = 0;               ///< of the recipe
  std::vector<Real> rotate;        ///< [degrees]; empty: not turned
  std::vector<Real> about, offset; ///< [m]; empty: none given
};

/// One entry of `parts`, as written.
struct PartCard : PlacementCard
{
  std::string where;
  std::string model; ///< its shape
  std::shared_ptr<void> parameters;
  std::string block;
  std::string split = "none";
};

/// One entry of `meshes`.
struct MeshCard : PlacementCard
{
  std::string where;
  std::string file, prefix;
  bool join = false;
  Real scale = 1; ///< of its lengths [-]
};

/// Values or ranges that places must meet; empty: any.
struct PlacesCard
{
  std::vector<Real> x, y, z, radius; ///< [m]
  std::vector<Real> angle;           ///< [degrees]
};

/// One entry of `node_sets` or `side_sets`.
struct SetCard
{
  std::string name, where;
  std::vector<std::string> blocks; ///< empty: all
  PlacesCard places, ownPlaces;
  std::vector<Real> normal; ///< empty: any
};

/// What a recipe says.
struct Recipe
{
  std::string title;
  int dimension = 0;
  std::vector<PartCard> parts;
  std::vector<MeshCard> meshes;
  std::vector<SetCard> nodeSets, sideSets;
  DeckNode root; ///< for messages
};

/// Keys of node_sets and side_sets, for every recipe that has them.
std::vector<Key> nodeSetKeys();
std::vector<Key> sideSetKeys();
/// Makes a schema that of the dimension that a file states; without one, all keys stay.
/// @return the dimension, 0 where none is stated
int fitToDimensionOf(const DeckNode& root, Key& schema);

const Key& recipeSchema();
const FileKind& recipeFile();

/// Reads and checks a recipe. Throws Error(ExitCode::Deck) with every problem that was found, one
/// per line.
Recipe parseRecipe(const std::string& text, const std::string& file,
                   const std::vector<std::string>& overrides = {});
} // namespace coplane
