#pragma once

#include <coplane_input/Deck.hpp>
#include <coplane_material/MaterialModel.hpp>
#include <coplane_schema/DeckNode.hpp>
#include <coplane_schema/Schema.hpp>

namespace coplane
{
/// Keys of a card in `materials`; their target is a MaterialCard.
std::vector<Key> materialCardKeys();

/// The part `materials` of the deck's schema; its target is the Deck.
Key materialKeys();

/// Named sets of parameters, documented in docs/user/materials.md.
std::vector<std::string> materialSetNames();

/// Fills cards that name a set with the keys of the set that they do not give themselves, and makes
/// cards for sets that blocks name directly.
void insertMaterialSets(DeckNode& root);

/// The law of a card. Throws Error(ExitCode::Deck) with what is wrong.
Material materialOf(const MaterialCard& card);

/// What the laws demand of their cards.
void checkMaterials(const std::vector<MaterialCard>& materials, const DeckNode& root,
                    Problems& problems);

/// What is wrong with a card in a mesh of two dimensions; empty: nothing.
std::string problemInTheFlat(const MaterialCard& card, bool revolved);

/// The largest element that can follow the softening of a material.
SofteningLimit softeningLimit(const MaterialCard& card);
} // namespace coplane
