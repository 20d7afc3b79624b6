#pragma once

#include <coplane_core/Error.hpp>
#include <coplane_input/DeckReader.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace coplane
{
/// The least deck: what is required and nothing else. Four lines, so that a test's own text starts
/// on line 5.
inline const std::string leastDeck = R"(mesh: wall.e
materials: {steel: {model: linear_elastic, density: 7850, youngs_modulus: 200e9, poisson_ratio: 0.3}}
blocks: {bar: {material: steel}}
time: {end: 1}
)";

/// The whole text of the error of a deck; "no error" when it is accepted.
inline std::string errorOf(const std::string& text, const std::vector<std::string>& overrides = {})
{
  try
  {
    parseDeck(text, "wall.yaml", overrides);
  }
  catch (const Error& e)
  {
    EXPECT_EQ(e.code(), ExitCode::Deck);
    return e.what();
  }
  return "no error";
}
} // namespace coplane
