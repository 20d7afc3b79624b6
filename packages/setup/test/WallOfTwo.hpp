#pragma once

#include <coplane_input/DeckReader.hpp>
#include <coplane_setup/BuildModel.hpp>

#include <gtest/gtest.h>

#include <BoxMesh.hpp>
#include <string>

namespace coplane
{
/// Two squares of 2 x 2 elements of 0.5 m, one on the other, with the node sets `base` and `lid`
/// and the side sets `floor` (y = 0), `bed` (top of the lower one) and `load` (top of the upper
/// one).
inline Mesh wallOfTwo()
{
  Mesh mesh;
  addRectangle(mesh, "lower", {2, 2}, {0, 0, 0}, {1, 1, 0});
  addRectangle(mesh, "upper", {2, 2}, {0, 1, 0}, {1, 1, 0});
  mesh.nodeSets = {{1, "base", {0, 1, 2}}, {2, "lid", {15, 16, 17}}};
  // Elements of a block row by row; side 0 is the lower one, 2 the upper one.
  mesh.sideSets = {
      {1, "floor", {0, 1}, {0, 0}}, {2, "bed", {2, 3}, {2, 2}}, {3, "load", {6, 7}, {2, 2}}};
  return mesh;
}

/// A deck for it, on three lines; a test's own text starts on the fourth.
inline const std::string deckOfTwo = R"(mesh: wall.e
materials: {rock: {model: linear_elastic, density: 2000, youngs_modulus: 1e9, poisson_ratio: 0.25}}
time: {end: 1}
)";
inline const std::string blocksOfTwo =
    "blocks: {lower: {material: rock}, upper: {material: rock}}\n";

/// The model of a deck on all nodes of this mesh, with every second node on the other rank when
/// there are two.
inline Model modelOf(const std::string& text, const Mesh& mesh = wallOfTwo())
{
  const Comm comm;
  const Deck deck = parseDeck(deckOfTwo + text, "wall.yaml");
  return buildModel(deck, sliceOf(mesh, comm),
                    distribute(mesh, scatteredOwners(mesh, comm.size()), comm.rank()), comm);
}

/// Numbers of all ranks together.
template <class Items>
std::int64_t countOnAllRanks(const Items& items)
{
  return Comm().sum(std::int64_t(items.size()));
}
} // namespace coplane
