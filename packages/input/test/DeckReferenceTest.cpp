#include <coplane_input/DeckReference.hpp>
#include <coplane_material/MaterialModel.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace coplane
{
namespace
{
nlohmann::json schema()
{
  return nlohmann::json::parse(deckJsonSchema());
}

TEST(DeckReferenceText, showsPathTypeUnitDefaultAndMeaning)
{
  const std::string text = deckReferenceText("");
  EXPECT_NE(text.find("time.step_factor\n"
                      "    a number > 0 and <= 1 [-]; default: 0.8\n"
                      "    time step over the stable step. Example: 0.9\n"),
            std::string::npos)
      << text;
}

TEST(DeckReferenceText, saysForWhichModelAKeyIs)
{
  EXPECT_NE(deckReferenceText("").find("materials.<name>.detonation_speed   (model: jwl)\n"
                                       "    a number > 0 [m/s]; required\n"),
            std::string::npos);
}

TEST(DeckReferenceText, aTopicIsPartOfTheReference)
{
  const std::string all = deckReferenceText(""), contact = deckReferenceText("contact");
  EXPECT_LT(contact.size(), all.size() / 4);
  EXPECT_NE(contact.find("contact.search_every\n"), std::string::npos);
  EXPECT_EQ(contact.find("materials."), std::string::npos);
}

TEST(DeckReferenceMarkdown, hasATableForEachGroup)
{
  const std::string text = deckReferenceMarkdown();
  EXPECT_NE(text.find("## `contact.damping`\n\nViscous damping on the planes.\n\n"
                      "| Key | Accepted | Default | Meaning | Example |\n|---|---|---|---|---|\n"
                      "| `normal` | a number \\>= 0 [-] | 0 | of closure, fraction of critical | "
                      "`0.1` |\n"),
            std::string::npos)
      << text;
}

TEST(DeckJsonSchema, requiresWhatTheReaderRequires)
{
  EXPECT_EQ(schema()["required"], (nlohmann::json{"mesh", "blocks", "time"}));
}

TEST(DeckJsonSchema, refusesUnknownKeys)
{
  EXPECT_EQ(schema()["additionalProperties"], false);
  EXPECT_EQ(schema()["properties"]["materials"]["additionalProperties"]["additionalProperties"],
            false);
}

TEST(DeckJsonSchema, hasTheRangeOfANumber)
{
  const auto density =
      schema()["properties"]["materials"]["additionalProperties"]["properties"]["density"];
  EXPECT_EQ(density["type"], (nlohmann::json{"number", "string"})); // a name of define
  EXPECT_EQ(density["exclusiveMinimum"], 0);
  const auto damping = schema()["properties"]["damping"]["properties"]["local"];
  EXPECT_EQ(damping["minimum"], 0);
  EXPECT_EQ(damping["exclusiveMaximum"], 1);
}

TEST(DeckJsonSchema, givesAModelItsKeysAndTakesThemFromTheOthers)
{
  const auto rules = schema()["properties"]["materials"]["additionalProperties"]["allOf"];
  ASSERT_EQ(rules.size(), materialModels().size());
  const auto ruleOf = [&](const std::string& model)
  {
    for (const auto& rule : rules)
      if (rule["if"]["properties"]["model"]["const"] == model)
        return rule["then"];
    return nlohmann::json();
  };
  const auto needed = [&](const std::string& model)
  { return ruleOf(model)["anyOf"][0]["required"]; };
  EXPECT_EQ(ruleOf("linear_elastic")["properties"]["yield_stress"], false);
  EXPECT_EQ(needed("linear_elastic"), (nlohmann::json{"youngs_modulus", "poisson_ratio"}));
  EXPECT_EQ(needed("ideal_gas"), (nlohmann::json{"heat_ratio", "pressure"}));
}

TEST(DeckJsonSchema, demandsNothingOfACardThatNamesASet)
{
  const auto card = schema()["properties"]["materials"]["additionalProperties"];
  EXPECT_FALSE(card.contains("required"));
  const nlohmann::json accepted{{{"required", {"model", "density"}}}, {{"required", {"set"}}}};
  EXPECT_EQ(card["anyOf"], accepted);
  for (const auto& rule : card["allOf"])
    EXPECT_EQ(rule["then"]["anyOf"][1], accepted[1]);
}
} // namespace
} // namespace coplane
