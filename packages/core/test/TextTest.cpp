#include <coplane_core/PlaceText.hpp>
#include <coplane_core/Text.hpp>

#include <gtest/gtest.h>

#include <vector>

namespace coplane
{
namespace
{
TEST(Text, FieldsOfCsvAreQuotedWhereTheyHaveTo)
{
  EXPECT_EQ(csvField("bar"), "bar");
  EXPECT_EQ(csvField(""), "");
  EXPECT_EQ(csvField("a b;c'"), "a b;c'");
  EXPECT_EQ(csvField("a,b"), "\"a,b\"");
  EXPECT_EQ(csvField("5\" pipe"), "\"5\"\" pipe\"");
  EXPECT_EQ(csvField("two\nlines"), "\"two\nlines\"");
}

TEST(Text, PlacesHaveTheDigitsThatTellThemApart)
{
  EXPECT_EQ(placeText({7.62512, 5.5, -0.00012345}, 0.01), "(7.625, 5.5, -0.0001234)");
  EXPECT_EQ(placeText({512340.376, 4005123.128, 0}, 0.05), "(512340.38, 4005123.13, 0)");
  EXPECT_EQ(coordinateText(512340.376, 100), "512340");
  EXPECT_EQ(coordinateText(1e8 + 0.125, 0), "100000000");
}

TEST(Text, XmlIsEscaped)
{
  EXPECT_EQ(xmlText("a<b>&\"c\"\n"), "a&lt;b&gt;&amp;&quot;c&quot;&#10;");
  EXPECT_EQ(xmlText("\x01"), "\xef\xbf\xbd");
  EXPECT_EQ(xmlText("M\xc3\xb6rtel"), "M\xc3\xb6rtel");
  EXPECT_EQ(xmlText("M\xf6rtel"), "M\xc3\xb6rtel"); // Latin-1
}

TEST(Text, Utf8IsKnownFromOtherBytes)
{
  for (const std::string& good : std::vector<std::string>{"", "plain", "\xc3\xa9", "\xe2\x82\xac",
                                                          "\xf0\x9f\xa7\xb1", "\xed\x9f\xbf"})
    EXPECT_TRUE(isUtf8(good)) << good;
  for (const std::string& bad :
       std::vector<std::string>{"\xe9", "\xc3", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80",
                                "\xf4\x90\x80\x80", "\xf0\x80\x80\xaf", "\xff", "\x80"})
    EXPECT_FALSE(isUtf8(bad));
  EXPECT_EQ(asUtf8("\xe9t\xe9"), "\xc3\xa9t\xc3\xa9");
  EXPECT_EQ(asUtf8("\xc3\xa9"), "\xc3\xa9");
  std::string all;
  for (int byte = 0; byte < 256; ++byte)
    all += static_cast<char>(byte);
  EXPECT_TRUE(isUtf8(latin1AsUtf8(all)));
  EXPECT_EQ(utf8AsLatin1(latin1AsUtf8(all)), all);
}
} // namespace
} // namespace coplane
