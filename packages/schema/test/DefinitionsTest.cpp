#include <coplane_core/Error.hpp>
#include <coplane_schema/SchemaBuilder.hpp>
#include <coplane_schema/SchemaReader.hpp>
#include <coplane_schema/SchemaReference.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace coplane
{
using namespace schema;

namespace
{
struct Plate
{
  Real width = 0;
  std::vector<Real> sizes;
  std::vector<int> counts;
};

struct File
{
  Real speed = 0;
  int steps = 0;
  std::string name;
  std::vector<Real> velocity;
  std::vector<TimeFunction> loads, fields;
  Plate plate;
  std::vector<std::vector<Real>> corners;
};

Key fileSchema()
{
  Key loads =
      bound<std::vector<TimeFunction>>("loads", KeyKind::TimeFunctions, &File::loads, copyTo);
  Key fields =
      bound<std::vector<TimeFunction>>("fields", KeyKind::PlaceFunctions, &File::fields, copyTo);
  return section("", {
                         definitions(),
                         number("speed", &File::speed).in("m/s").above(0).means("s"),
                         integer("steps", &File::steps).in("steps").atLeast(1).means("n"),
                         text("name", &File::name).means("word"),
                         numbers("velocity", &File::velocity).in("m/s").means("v"),
                         loads,
                         fields,
                         group("plate", &File::plate,
                               {
                                   number("width", &Plate::width).in("m").means("w"),
                                   numbers("sizes", &Plate::sizes).byDimension().in("m").means("s"),
                                   integers("counts", &Plate::counts).in("elements").means("n"),
                               })
                             .means("a plate"),
                         points("corners", &File::corners).in("m").means("c"),
                     });
}

struct DefinedCard
{
  File file;
  DeckNode root;
  std::string problems;
};

DefinedCard readDefined(const std::string& text, const std::vector<std::string>& overrides = {})
{
  DefinedCard outcome;
  Problems problems;
  outcome.root = readBySchema(fileSchema(), text, "f.yaml", overrides, &outcome.file, problems);
  outcome.problems = problems.text();
  return outcome;
}

std::string problemsOf(const std::string& text)
{
  return readDefined(text).problems;
}
} // namespace

TEST(Define, aNameStandsForItsNumberEverywhere)
{
  const DefinedCard got = readDefined("define: {v: 70, h: 0.25, n: 3}\n"
                                      "speed: v\n"
                                      "steps: \"4*n\"\n"
                                      "velocity: [v, 0, -v/2]\n"
                                      "plate: {width: 2*h, sizes: [h, 1], counts: [n, 2]}\n"
                                      "corners: [[0, h], [\"3*h\", 1]]\n");
  EXPECT_EQ(got.problems, "");
  EXPECT_EQ(got.file.speed, 70);
  EXPECT_EQ(got.file.steps, 12);
  EXPECT_EQ(got.file.velocity, (std::vector<Real>{70, 0, -35}));
  EXPECT_EQ(got.file.plate.width, 0.5);
  EXPECT_EQ(got.file.plate.sizes, (std::vector<Real>{0.25, 1}));
  EXPECT_EQ(got.file.plate.counts, (std::vector<int>{3, 2}));
  EXPECT_EQ(got.file.corners, (std::vector<std::vector<Real>>{{0, 0.25}, {0.75, 1}}));
}

TEST(Define, expressionsOfNamesBeforeAreNumbers)
{
  const DefinedCard got = readDefined("define:\n  a: 1/4\n  b: 2*a + sqrt(4)\nspeed: b\n");
  EXPECT_EQ(got.problems, "");
  EXPECT_EQ(got.file.speed, 2.5);
  EXPECT_EQ(problemsOf("define: {api: 1, w: 2*_pi*api}\nspeed: w\n"), ""); // no slip of `api`
}

TEST(Define, functionsOfTimeAndPlaceTakeThem)
{
  const DefinedCard got = readDefined("define: {v: -70, w: 2}\n"
                                      "loads: [v, \"2*v\", \"w^2*t + min(v, t)\", \"t\"]\n"
                                      "fields: [\"v*x\"]\n");
  EXPECT_EQ(got.problems, "");
  EXPECT_EQ(got.file.loads[0].constant, -70);
  EXPECT_EQ(got.file.loads[1].constant, -140);
  EXPECT_EQ(got.file.loads[2].expression, "2^2*t + min((-70), t)");
  EXPECT_EQ(got.file.loads[3].expression, "t");
  EXPECT_EQ(got.file.fields[0].expression, "(-70)*x");
}

TEST(Define, digitsOfANumberAreNoNames)
{
  const DefinedCard got = readDefined("define: {e5: 3}\nloads: [\"1e5*t + e5\"]\n");
  EXPECT_EQ(got.problems, "");
  EXPECT_EQ(got.file.loads[0].expression, "1e5*t + 3");
}

TEST(Define, theTreeHasTheNumbersAndNoDefine)
{
  EXPECT_EQ(toYaml(readDefined("define: {v: 70}\nspeed: 2*v\nvelocity: [v, 1]\nname: v\n").root),
            "speed: 140\nvelocity: [70, 1]\nname: v\n");
}

TEST(Define, theCommandLineSetsThem)
{
  const DefinedCard got = readDefined("define: {v: 70}\nspeed: v\n", {"define.v=80"});
  EXPECT_EQ(got.problems, "");
  EXPECT_EQ(got.file.speed, 80);
}

TEST(Define, aWholeNumberMayComeFromRoundedOnes)
{
  EXPECT_EQ(readDefined("define: {l: 0.3, h: 0.1}\nsteps: l/h\n").file.steps,
            3); // 2.9999999999999996
  EXPECT_EQ(problemsOf("define: {l: 0.875, h: 0.25}\nsteps: l/h\n"),
            "f.yaml:2:8: steps = 'l/h' is not a whole number (it is 3.5); accepted: a whole number "
            ">= 1 [steps].");
}

TEST(Define, anUnknownNameIsRefusedWithItsPlaceAndASuggestion)
{
  EXPECT_EQ(
      problemsOf("define: {width: 2, n: 1}\nsteps: n\nspeed: width\nvelocity: [1, widht]\n"),
      "f.yaml:4:15: velocity.1 = 'widht' is not a number (did you mean 'width'?); accepted: a "
      "number [m/s].");
  EXPECT_EQ(problemsOf("speed: fast\n"),
            "f.yaml:1:8: speed = 'fast' is not a number; accepted: a number > 0 [m/s].");
  EXPECT_EQ(problemsOf("speed: 2*3\n"),
            "f.yaml:1:8: speed = '2*3' is not a number: write 6; accepted: a number > 0 [m/s].");
}

TEST(Define, whatANumberDemandsHoldsForExpressions)
{
  EXPECT_EQ(
      problemsOf("define: {v: 70}\nspeed: v - 80\n"),
      "f.yaml:2:8: speed = 'v - 80' is out of range (it is -10); accepted: a number > 0 [m/s].");
  EXPECT_EQ(problemsOf("define: {v: 0}\nspeed: 1/v\n"),
            "f.yaml:2:8: speed = '1/v' is not a number (it is inf); accepted: a number > 0 [m/s].");
  EXPECT_EQ(problemsOf("define: {v: 1}\nspeed: \"70\"\nplate: {width: v}\n"),
            "f.yaml:2:8: speed = \"70\" is text in quotes, not a number; remove the quotes; "
            "accepted: a number > 0 [m/s].");
}

TEST(Define, namesComeBeforeTheirUse)
{
  EXPECT_NE(problemsOf("define:\n  a: 2*b\n  b: 1\nspeed: a + b\n")
                .find("f.yaml:2:6: define.a = '2*b' is not accepted (b stands further down; a name "
                      "has its number before it is used)"),
            std::string::npos);
  EXPECT_NE(problemsOf("define: {a: a + 1}\nspeed: a\n")
                .find("f.yaml:1:13: define.a = 'a + 1' is not accepted (a stands for itself; "),
            std::string::npos);
}

TEST(Define, namesThatExpressionsHaveAreRefused)
{
  for (const char* name : {"t", "x", "y", "z"})
    EXPECT_EQ(problemsOf(fmt::format("define: {{{}: 1}}\n", name)),
              fmt::format("f.yaml:1:10: define.{} is the time or a coordinate in expressions; "
                          "choose another name.",
                          name));
  for (const char* name : {"sin", "_pi"})
    EXPECT_EQ(problemsOf(fmt::format("define: {{{}: 1}}\n", name)),
              fmt::format("f.yaml:1:10: define.{} is a function or a constant of expressions; "
                          "choose another name.",
                          name));
  EXPECT_EQ(problemsOf("define: {a b: 1}\n"),
            "f.yaml:1:10: define.a b is no name for expressions; accepted: letters, digits and _, "
            "a letter first.");
}

TEST(Define, aNameThatNothingUsesIsRefused)
{
  EXPECT_EQ(problemsOf("define: {v: 70, w: 1}\nspeed: v\n"),
            "f.yaml:1:17: define.w is used nowhere; use it in a number or an expression, or remove "
            "it.");
  EXPECT_EQ(problemsOf("define: {v: 70, w: 2*v}\nspeed: w\n"), "");
}

TEST(Define, longWordsAreRefusedLikeShortOnes)
{
  const std::string word(1000000, 'a');
  for (const std::string key : {"speed: ", "steps: ", "loads: [0, 0, ", "define: {a: "})
    for (const std::string first : {"", "define: {v: 1}\n"})
      if (key[0] != 'd' || first.empty())
      {
        const std::string error = problemsOf(first + key + word +
                                             (key[0] == 'l'   ? "]"
                                              : key[0] == 'd' ? "}"
                                                              : ""));
        EXPECT_NE(error.find("accepted:"), std::string::npos) << key << error.substr(0, 200);
      }
}

TEST(Define, thereMayBeManyNames)
{
  std::string text = "define:\n  a0: 1\n";
  for (int i = 1; i < 500; ++i)
    text += fmt::format("  a{}: a{} + 1\n", i, i - 1);
  EXPECT_EQ(problemsOf(text + "speed: a499\nloads: [\"a10*t\", 0, 0]\n"), "");
}

TEST(Define, aFaultIsToldOnce)
{
  const std::string error =
      problemsOf("define: {a: zz, n: 1/a}\nspeed: n\nsteps: n\nloads: [n, 0, 0]");
  EXPECT_NE(error.find("define.a"), std::string::npos) << error;
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 0) << error;
}

TEST(Define, namesThatAreReadAsNumbersAreRefused)
{
  for (const std::string name : {"inf", "nan", "infinity"})
    EXPECT_NE(problemsOf("define: {" + name + ": 1}\nspeed: " + name).find("is read as a number"),
              std::string::npos)
        << name;
}

TEST(Define, zeroMayComeFromRoundedNumbers)
{
  EXPECT_NE(problemsOf("define: {h: 0.1}\nsteps: 0.3-h*3").find("is out of range (it is 0)"),
            std::string::npos)
      << problemsOf("define: {h: 0.1}\nsteps: 0.3-h*3");
}

TEST(Define, aListIsNoMap)
{
  EXPECT_NE(problemsOf("define: [1]\n").find("f.yaml:1:9: define is no map"), std::string::npos);
  EXPECT_NE(
      problemsOf("define: {v: [1]}\nspeed: v\n")
          .find("define.v has no number; accepted: a number or an expression of names before it."),
      std::string::npos);
  EXPECT_NE(problemsOf("define: {v: 1, v: 2}\nspeed: v\n").find("define.v is given twice"),
            std::string::npos);
}

TEST(Define, editorsAcceptWordsForNumbers)
{
  const auto json = nlohmann::json::parse(jsonSchema(fileSchema(), "file"));
  EXPECT_EQ(json["properties"]["speed"]["type"], (nlohmann::json{"number", "string"}));
  EXPECT_EQ(json["properties"]["define"]["additionalProperties"]["type"],
            (nlohmann::json{"number", "string"}));
}
} // namespace coplane
