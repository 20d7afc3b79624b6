#include <coplane_core/Error.hpp>
#include <coplane_schema/SchemaBuilder.hpp>
#include <coplane_schema/SchemaReference.hpp>

#include <gtest/gtest.h>

#include <map>

namespace coplane
{
using namespace schema;

namespace
{
struct Law
{
  std::string name, where, model;
  Real friction = 0, modulus = 0;
};

struct DocumentedCard
{
  std::vector<Law> joints;
  Law contact;
  Real friction = 0;
};

Key documentedSchema()
{
  std::vector<Key> law{text("model", &Law::model).oneOf({"smooth", "rough"}).defaultIs("smooth"),
                       number("modulus", &Law::modulus).in("Pa")};
  Key friction = number("friction", &Law::friction).in("-").means("of the joint");
  friction.models = {"rough"};
  law.push_back(friction);
  return section("",
                 {
                     named("joints", &DocumentedCard::joints, law).means("laws of joints"),
                     group("contact", &DocumentedCard::contact, law).means("of all faces"),
                     number("modulus", &DocumentedCard::friction).in("Pa").means("of everything"),
                 });
}

/// Paths that a topic shows.
std::vector<std::string> pathsOf(const std::string& topic)
{
  std::vector<std::string> paths;
  const std::string text = topicText(documentedSchema(), topic);
  for (std::size_t begin = 0, end = 0; begin < text.size(); begin = end + 1)
  {
    end = text.find('\n', begin);
    if (end > begin && text[begin] != ' ')
      paths.push_back(text.substr(begin, text.find_first_of(" \n", begin) - begin));
  }
  return paths;
}

using Paths = std::vector<std::string>;
} // namespace

TEST(Topics, aSectionIsShownWithItsKeys)
{
  EXPECT_EQ(pathsOf("contact"),
            (Paths{"contact", "contact.model", "contact.modulus", "contact.friction"}));
  EXPECT_EQ(pathsOf("modulus"), Paths{"modulus"});
}

TEST(Topics, aKeyIsShownWhereverItStands)
{
  EXPECT_EQ(pathsOf("friction"), (Paths{"joints.<name>.friction", "contact.friction"}));
}

TEST(Topics, pathsMayNameWhatTheUserNamed)
{
  for (const char* path : {"joints.friction", "joints.<name>.friction", "joints.mortar.friction"})
    EXPECT_EQ(pathsOf(path), Paths{"joints.<name>.friction"}) << path;
  EXPECT_EQ(pathsOf("joints.<name>").size(), 4u);
  EXPECT_EQ(pathsOf("contact.modulus"), Paths{"contact.modulus"});
}

TEST(Topics, aModelIsShownWithItsOwnKeys)
{
  EXPECT_EQ(pathsOf("rough"), (Paths{"joints.<name>.model", "joints.<name>.friction",
                                     "contact.model", "contact.friction"}));
  EXPECT_EQ(pathsOf("smooth"), (Paths{"joints.<name>.model", "contact.model"}));
}

TEST(Topics, whatIsNotKnownHasASuggestion)
{
  for (const auto& [topic, words] : std::map<std::string, std::string>{
           {"fricton", "Did you mean 'friction'?"},
           {"joints.fricton", "Did you mean 'friction'?"},
           {"mortar.friction", "Sections: joints, contact, modulus."},
           {"ruogh", "Did you mean 'rough'?"}})
    try
    {
      topicText(documentedSchema(), topic);
      ADD_FAILURE() << topic;
    }
    catch (const Error& error)
    {
      EXPECT_EQ(error.code(), ExitCode::Usage);
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
}
} // namespace coplane
