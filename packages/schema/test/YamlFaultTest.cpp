#include <coplane_core/Error.hpp>
#include <coplane_schema/DeckNode.hpp>

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
/// What parsing a text says, without the words after the place and the first `letters` of them.
std::string faultIn(const std::string& text, std::size_t letters = 40)
{
  try
  {
    parseYaml(text, "c.yaml");
  }
  catch (const Error& error)
  {
    return std::string(error.what()).substr(0, letters);
  }
  return "no fault";
}
} // namespace

TEST(YamlFault, bracketsAreNamedWhereTheyOpen)
{
  EXPECT_EQ(faultIn("a: {b: 1\nc: {d: 2}\n"), "c.yaml:1:4: '{' is not closed; put the m");
  EXPECT_EQ(faultIn("a: 1\nb: {c: [1, 2}\n", 60),
            "c.yaml:2:8: '[' is not closed, and '}' comes in line 2; put ");
  EXPECT_EQ(faultIn("a: [1,\n  2\nb: 3\n"), "c.yaml:1:4: '[' is not closed; put the m");
}

TEST(YamlFault, quotesAreNamedWhereTheyOpen)
{
  EXPECT_EQ(faultIn("a: \"b\nc: 1\n"), "c.yaml:1:4: the quote \" is not closed; p");
  EXPECT_EQ(faultIn("a: 'b\nc: 1\n"), "c.yaml:1:4: the quote ' is not closed; p");
  EXPECT_EQ(faultIn("a: \"b\nc: \"d\"\n", 51),
            "c.yaml:1:4: the quote \" is not closed in its line, ");
}

TEST(YamlFault, tabsAndCommentsOfOtherLanguagesAreNamed)
{
  EXPECT_EQ(faultIn("a:\n  b: 1\n\tc: 2\n", 46), "c.yaml:3:1: this line is indented with a tab, ");
  EXPECT_EQ(faultIn("// a\nb: 1\n", 41), "c.yaml:1:1: a line that begins with '//';");
  EXPECT_EQ(faultIn("b: 1\n\n$ a\nc: 2\n"), "c.yaml:3:1: a line that begins with '$';");
}

TEST(YamlFault, whatIsYamlHasNone)
{
  for (const char* text :
       {"a: it's {b\n", "a: \"b [ \\\" {\"\n", "a: 'b''s ['\n", "# it's {\na: 1 # {\n",
        "a: |\n  it's {\n  [\nb: 1\n", "a: [{b: '[', c: \"]\"}, 'd']\n",
        "{\"a\":[1,2],\"b\":'c'}\n", "a: \"one\n  two\"\n", "- 'a'\n- - \"b\"\n", "? 'a'\n: 1\n"})
    EXPECT_EQ(faultIn(text).find("is not closed"), std::string::npos) << text;
}

TEST(YamlFault, filesOfOtherProgramsAreNamed)
{
  EXPECT_EQ(faultIn("CDF\x05 and more"), "c.yaml: this is a mesh or results (Exodu");
  EXPECT_EQ(faultIn("$ by hand\n*KEYWORD\n"), "c.yaml: this is an input file of LS-DYNA");
  EXPECT_EQ(faultIn("** by hand\n*HEADING\n"), "c.yaml: this is an input file of LS-DYNA");
  EXPECT_EQ(faultIn("$MeshFormat\n4.1 0 8\n"), "c.yaml: this is a mesh of Gmsh; accepted");
}
} // namespace coplane
