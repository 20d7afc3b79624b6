#include "ExampleFile.hpp"

#include <coplane_core/Error.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace coplane
{
namespace
{
std::string exampleErrorOf(const std::string& text)
{
  try
  {
    exampleAsJson(text, "example.yaml");
  }
  catch (const Error& error)
  {
    EXPECT_EQ(error.code(), ExitCode::Deck);
    return error.what();
  }
  return "no error";
}
} // namespace

TEST(ExampleFile, valuesKeepTheirKinds)
{
  const auto json = nlohmann::ordered_json::parse(exampleAsJson(
      "title: a wall\n"
      "sizes:\n"
      "  S: {}\n"
      "  M: {ranks: 4, set: {time.end: 5e-3, a.0: [1, -2, true, \"5\", null], b: \"t < 1\"}}\n",
      "example.yaml"));
  EXPECT_EQ(json.dump(),
            "{\"title\":\"a wall\",\"sizes\":{\"S\":{},\"M\":{\"ranks\":4,\"set\":{\"time.end\":"
            "0.005,\"a.0\":[1,-2,true,\"5\",null],\"b\":\"t < 1\"}}}}");
}

TEST(ExampleFile, textStaysText)
{
  const auto json = nlohmann::ordered_json::parse(exampleAsJson("title: 2020\ndefault: 2\n"
                                                                "sizes:\n"
                                                                "  2: {set: {a: .inf, b: nan}}\n"
                                                                "  3:\n",
                                                                "example.yaml"));
  EXPECT_EQ(json.dump(), "{\"title\":\"2020\",\"default\":\"2\",\"sizes\":{\"2\":{\"set\":"
                         "{\"a\":\".inf\",\"b\":\"nan\"}},\"3\":{}}}");
}

TEST(ExampleFile, keysGivenTwiceInChangesAreRefused)
{
  EXPECT_NE(
      exampleErrorOf("title: t\nsizes: {S: {set: {a: {b: 1, b: 2}}}}").find("sizes.S.set.a.b"),
      std::string::npos)
      << exampleErrorOf("title: t\nsizes: {S: {set: {a: {b: 1, b: 2}}}}");
}

TEST(ExampleFile, allProblemsAreToldAtOnce)
{
  EXPECT_EQ(exampleErrorOf("title: a wall\n"
                           "defualt: S\n"
                           "sizes: {S: {rank: 2}, M: {ranks: 0}}\n"
                           "variants: {a: {set: [1]}}\n"),
            "example.yaml:2:1: defualt is not known. Did you mean 'default'? Accepted here: title, "
            "recipe, joints, deck, ranks, default, sizes, variants, pictures, check, summary.\n"
            "example.yaml:3:13: sizes.S.rank is not known. Did you mean 'ranks'? Accepted here: "
            "title, recipe, joints, deck, ranks, mesh, set.\n"
            "example.yaml:3:34: sizes.M.ranks = '0' is out of range; accepted: a whole number >= 1 "
            "[ranks].\n"
            "example.yaml:4:21: variants.a.set = a list of 1; accepted: paths of keys, each with a "
            "value.");
}

TEST(ExampleFile, theDefaultIsOneOfTheSizes)
{
  EXPECT_EQ(exampleErrorOf("{title: a, default: coarze, sizes: {coarse: {}}}"),
            "example.yaml:1:21: default = 'coarze' is none of the sizes. Did you mean 'coarse'? "
            "There are: coarse.");
}
} // namespace coplane
