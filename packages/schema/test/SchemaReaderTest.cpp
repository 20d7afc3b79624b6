#include <coplane_core/Error.hpp>
#include <coplane_core/Suggestion.hpp>
#include <coplane_schema/SchemaBuilder.hpp>
#include <coplane_schema/SchemaReader.hpp>

#include <gtest/gtest.h>

namespace coplane
{
using namespace schema;

namespace
{
struct Line
{
  std::vector<Real> ends;
  std::vector<int> divisions;
};

struct Item
{
  std::string where;
  Real size = 0;
};

struct Card
{
  std::vector<Real> range, normal;
  std::vector<std::string> names;
  std::vector<std::vector<Real>> corners;
  std::vector<std::vector<std::string>> pairs;
  std::vector<Item> items;
  Line line;
  Real depth = 0;
};

void checkLine(Line& line, const CardPlace& place)
{
  if (line.divisions.size() + 1 != line.ends.size())
    place.problem("divisions", "do not fit.");
}

Key cardSchema()
{
  Key pairs = bound<std::vector<std::vector<std::string>>>("pairs", KeyKind::TextLists,
                                                           &Card::pairs, copyTo)
                  .oneOf({"all"});
  pairs.itemLength = 2;
  return section("",
                 {
                     numbers("range", &Card::range, 2).orOneAlone().in("m"),
                     numbers("normal", &Card::normal).byDimension().notAllZero().in("-"),
                     texts("names", &Card::names).orOneAlone().atLeastItems(1),
                     points("corners", &Card::corners).atLeastItems(2).in("m"),
                     pairs,
                     Key(list("items", &Card::items, {number("size", &Item::size).in("m").needed()})
                             .orOneAlone()),
                     Key(group("line", &Card::line,
                               {
                                   numbers("ends", &Line::ends).atLeastItems(2).in("m").needed(),
                                   integers("divisions", &Line::divisions).in("elements"),
                               })
                             .shortFor("ends")
                             .checkedBy(checkLine)),
                     number("depth", &Card::depth).in("m").needed().onlyInDimension(3),
                 });
}

struct Outcome
{
  Card card;
  std::string problems;
};

Outcome read(const std::string& text, int dimension = 2)
{
  Key schema = cardSchema();
  if (dimension)
    fitToDimension(schema, dimension);
  Outcome outcome;
  Problems problems;
  readBySchema(schema, text, "c.yaml", {}, &outcome.card, problems);
  outcome.problems = problems.text();
  return outcome;
}
} // namespace

TEST(SchemaReader, oneItemMayStandWithoutItsList)
{
  const Outcome got = read("{range: 3, names: a, items: {size: 2}}");
  EXPECT_EQ(got.problems, "");
  EXPECT_EQ(got.card.range, (std::vector<Real>{3}));
  EXPECT_EQ(got.card.names, (std::vector<std::string>{"a"}));
  ASSERT_EQ(got.card.items.size(), 1u);
  EXPECT_EQ(got.card.items[0].size, 2);
  EXPECT_EQ(read("{names: []}").problems,
            "c.yaml:1:9: names = a list of 0; accepted: a list of names or one alone.");
  EXPECT_EQ(read("{items: 3}").problems, "c.yaml:1:9: items = '3'; accepted: a list of items with "
                                         "keys and values, or one item alone.");
}

TEST(SchemaReader, longTextIsShortenedInMessages)
{
  const std::string beginning(200, 'w');
  EXPECT_EQ(read("{range: " + std::string(300, 'w') + "}").problems,
            "c.yaml:1:9: range = '" + beginning +
                "... (300 letters)' is not a number; accepted: a list of 2 numbers [m] or one "
                "alone.");
  EXPECT_EQ(read("{" + std::string(300, 'w') + ": 1}").problems,
            "c.yaml:1:2: " + beginning +
                "... (300 letters) is not known. Accepted here: range, normal, names, corners, "
                "pairs, items, line, depth.");
  std::string umlauts, ofFirst;
  for (int i = 0; i < 201; ++i)
  {
    umlauts += "\u00fc";
    if (i < 200)
      ofFirst += "\u00fc";
  }
  EXPECT_EQ(shortened(umlauts), ofFirst + "... (201 letters)");
  EXPECT_EQ(shortened(ofFirst), ofFirst);
}

TEST(SchemaReader, aLongListOfNamesIsShortenedInMessages)
{
  const std::vector<std::string> names(23, "n");
  std::string first = "n";
  for (int i = 1; i < 20; ++i)
    first += ", n";
  EXPECT_EQ(listOf(names), first + ", ... (3 more)");
}

TEST(SchemaReader, listsHaveANumberForEachAxis)
{
  const std::string two = "{normal: [0, 1], corners: [[0, 1], [2, 3]]}";
  EXPECT_EQ(read(two).card.corners, (std::vector<std::vector<Real>>{{0, 1}, {2, 3}}));
  EXPECT_EQ(read(two, 2).problems, "");
  EXPECT_EQ(read(two, 3).problems,
            "c.yaml:1:1: depth is missing; accepted: a number [m]: .\n"
            "c.yaml:1:10: normal = a list of 2; accepted: a list of 3 numbers, not all zero [-].\n"
            "c.yaml:1:28: corners.0 = a list of 2; accepted: a list of 3 numbers [m].\n"
            "c.yaml:1:36: corners.1 = a list of 2; accepted: a list of 3 numbers [m].");
  EXPECT_EQ(read("{normal: [0, 1, 2, 3], depth: 1}", 0).problems,
            "c.yaml:1:10: normal = a list of 4; accepted: a list of 2 or 3 numbers, not all zero "
            "[-].");
}

TEST(SchemaReader, keysOfTheOtherDimensionAreRefused)
{
  EXPECT_EQ(read("{depth: 1}").problems,
            "c.yaml:1:9: depth is for three dimensions only; remove it.");
}

TEST(SchemaReader, aWordMayStandForAListOfPairs)
{
  EXPECT_EQ(read("{pairs: all}").card.pairs, (std::vector<std::vector<std::string>>{{"all"}}));
  EXPECT_EQ(read("{pairs: [[a, b], [c, all]]}").card.pairs,
            (std::vector<std::vector<std::string>>{{"a", "b"}, {"c", "all"}}));
  EXPECT_EQ(read("{pairs: [[a]]}").problems,
            "c.yaml:1:10: pairs.0 = a list of 1; accepted: a list of 2 names.");
}

TEST(SchemaReader, aGroupIsCheckedWhenAllOfItCouldBeRead)
{
  EXPECT_EQ(read("{line: {ends: [0, 1], divisions: [4]}}").problems, "");
  EXPECT_EQ(read("{line: {ends: [0, 1], divisions: [4, 4]}}").problems,
            "c.yaml:1:34: line.divisions do not fit.");
  EXPECT_EQ(read("{line: {ends: [0, 1], divisions: [4, x]}}").problems,
            "c.yaml:1:38: line.divisions.1 = 'x' is not a whole number; accepted: a whole number "
            "[elements].");
}

TEST(SchemaReader, aValueInPlaceOfAGroupIsThatOfOneKey)
{
  const Outcome got = read("{line: [0, 1, 3]}");
  EXPECT_EQ(got.card.line.ends, (std::vector<Real>{0, 1, 3}));
  EXPECT_EQ(got.problems, "c.yaml:1:8: line.divisions do not fit.");
  EXPECT_EQ(read("{line: [0]}").problems,
            "c.yaml:1:8: line = a list of 1; accepted: a list of at least 2 numbers [m].");
}
namespace
{
struct Solid
{
  std::string kind;
  Real density = 0, modulus = 0;
  Vec3 pull;
};

Problems problemsOfSolid(const std::string& text)
{
  const Key schema =
      section("", {
                      schema::text("kind", &Solid::kind)
                          .oneOf({"rock", "soil"})
                          .wordsElsewhere({{"stone", "rock"}}),
                      number("density", &Solid::density)
                          .in("kg/m^3")
                          .needed()
                          .usually({20, 3e4, "Not in g/cm^3."})
                          .elsewhere({"rho"}),
                      number("modulus", &Solid::modulus).in("Pa"),
                      vector("pull", &Solid::pull).in("m/s^2").usually({0, 100, "Not in mm/s^2."}),
                  });
  Problems problems;
  Solid solid;
  readBySchema(schema, text, "c.yaml", {}, &solid, problems);
  return problems;
}

std::string warningsOf(const std::string& text)
{
  const Problems problems = problemsOfSolid(text);
  EXPECT_EQ(problems.text(), "");
  return fmt::format("{}", fmt::join(problems.warnings(), "|"));
}

/// The problem of a number, from what is wrong with it on.
std::string hintOf(const std::string& number)
{
  const std::string text = problemsOfSolid("{density: 1e3, modulus: " + number + "}").text();
  const std::size_t at = text.find("is not a number");
  return at == std::string::npos ? text : text.substr(at, text.find(";") - at);
}
} // namespace

TEST(SchemaReader, unusualValuesAreWarningsWithTheLikelyMistake)
{
  EXPECT_EQ(warningsOf("{density: 2650, pull: [0, -100, 0]}"), "");
  EXPECT_EQ(warningsOf("{density: 2.65}"), "c.yaml:1:11: density = 2.65 kg/m^3 is unusually small; "
                                           "usual: from 20 on. Not in g/cm^3.");
  EXPECT_EQ(warningsOf("{pull: [0, -9810, 0], density: 1e5}"),
            "c.yaml:1:8: pull = -9810 m/s^2 is unusually large; usual: up to 100. Not in mm/s^2.|"
            "c.yaml:1:32: density = 100000 kg/m^3 is unusually large; usual: up to 30000. Not in "
            "g/cm^3.");
}

TEST(SchemaReader, wordsOfOtherProgramsAreTranslated)
{
  EXPECT_EQ(problemsOfSolid("{density: 1e3, Rho: 3}").text(),
            "c.yaml:1:16: Rho is not known. It is called 'density' here. Accepted here: kind, "
            "density, modulus, pull.");
  EXPECT_EQ(problemsOfSolid("{density: 1e3, kind: stone}").text(),
            "c.yaml:1:22: kind = 'stone' is not known. It is called 'rock' here. Accepted: one of "
            "rock, soil.");
}

TEST(SchemaReader, numbersWrittenOtherwiseAreRewrittenInTheMessage)
{
  const std::string is = "is not a number";
  EXPECT_EQ(hintOf("60 GPa"), is + ": values have no units, write 60000000000");
  EXPECT_EQ(hintOf("-2.5kPa"), is + ": values have no units, write -2500");
  EXPECT_EQ(hintOf("60 psi"), is + ": values have no units, write the number in Pa alone");
  EXPECT_EQ(hintOf("25 %"), is + ": write 0.25");
  EXPECT_EQ(hintOf("60d9"), is + ": write 60e9");
  EXPECT_EQ(hintOf("2 650"), is + ": write 2650");
  EXPECT_EQ(hintOf("\"0,5\""), is + ": numbers have a decimal point, write 0.5");
  EXPECT_EQ(hintOf("60*10^9"), is + ": write 60000000000");
  EXPECT_EQ(hintOf("much"), is);
  EXPECT_EQ(hintOf("1/0"), is);
}

TEST(SchemaReader, aFileOfAnotherKindIsRefusedAsAWhole)
{
  try
  {
    problemsOfSolid("{parts: [], dimension: 2}");
    FAIL() << "accepted";
  }
  catch (const Error& error)
  {
    EXPECT_STREQ(error.what(),
                 "c.yaml: this is a recipe of a mesh, for coplane_mesh make, with the "
                 "key 'parts'; accepted for the deck: keys that --help-deck lists.");
  }
  EXPECT_NE(problemsOfSolid("{parts: [], density: 1e3}").text(), "") << "a key in a wrong place";
}
} // namespace coplane
