#pragma once

#include <coplane_core/Error.hpp>

#include <fmt/core.h>

namespace coplane
{
/// Follows a path of a card; what goes wrong on it is told with the place of the card in its deck.
/// @param group key of the deck that holds such cards
template <class Card, class Follow>
void withPlaceOf(const Card& card, const char* group, const Follow& follow)
{
  try
  {
    follow();
  }
  catch (const Error& error)
  {
    throw Error(error.code(),
                fmt::format("{}: {}.{}: {}", card.where, group, card.name, error.what()));
  }
}
} // namespace coplane
