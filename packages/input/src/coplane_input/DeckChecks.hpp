#pragma once

#include <coplane_input/Deck.hpp>
#include <coplane_schema/DeckNode.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// Checks that take more than one key: names that must exist in the deck, values that must fit each
/// other.
void checkDeck(const Deck& deck, const DeckNode& root, Problems& problems);

/// Blocks that a stage adds before any removes them.
std::vector<std::string> absentAtStart(const Deck& deck);

/// Compares the deck's names with those of the mesh and returns one message for each problem, with
/// its place and a suggestion; empty when all fits. Every block of the mesh needs a card.
std::vector<std::string> checkNamesAgainstMesh(const Deck& deck,
                                               const std::vector<std::string>& blockNames,
                                               const std::vector<std::string>& nodeSetNames,
                                               const std::vector<std::string>& sideSetNames);

/// Values out of the plane of a two-dimensional mesh, which would have no effect: one message each.
std::vector<std::string> problemsOfDimension(const Deck& deck, int dimension);

/// What contact.pairs can tell of a face.
struct ContactTraits
{
  std::string block, material;
  std::vector<std::string> sideSets; ///< that hold the face
};

/// What keeps a deck from forces that come from a potential: the key and its value, or nothing.
std::string commonNormalBecauseOf(const Deck& deck);

/// The item of contact.pairs that acts between two faces: the first that fits in either order;
/// nullptr: contact.default_joint.
const ContactPairCard* contactPairFor(const ContactCard& contact, const ContactTraits& a,
                                      const ContactTraits& b);

/// Which sides of which items a face fits, two for each item. Faces with equal roles have the same
/// items with every other face, and with each other.
std::vector<bool> contactRoles(const ContactCard& contact, const ContactTraits& face);
} // namespace coplane
