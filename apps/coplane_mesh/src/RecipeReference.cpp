#include "RecipeReference.hpp"

#include "BlocksRecipe.hpp"
#include "ExampleFile.hpp"
#include "JointRecipe.hpp"
#include "Recipe.hpp"

#include <coplane_schema/SchemaReference.hpp>

namespace coplane
{
namespace
{
const std::string units =
    "Lengths are in metres, up to 1e12, angles in degrees; (2D), (3D): only there.";

std::string markdown()
{
  return "# Reference of recipes\n\nMade from the schemas that check recipes. " + units +
         " `<name>` is a name of yours, `<index>` an item of a list, the first is 0; `--set "
         "path=value` uses the same paths. [meshes.md](meshes.md) explains them.\n\n" +
         referenceMarkdown(recipeSchema()) +
         "\n# Recipes of joints\n\nFor `coplane_mesh split`.\n\n" +
         referenceMarkdown(jointRecipeSchema()) +
         "\n# Recipes of blocks\n\nFor `coplane_mesh blocks`.\n\n" +
         referenceMarkdown(blocksRecipeSchema()) +
         "\n# Examples\n\nFor `example.yaml` files, which "
         "[exodus_inputs/run.py](../../exodus_inputs/README.md) runs.\n\n" +
         referenceMarkdown(exampleSchema());
}

std::string plain(const std::string& what, const Key& schema, const std::string& topic)
{
  return "Keys of " + what + " (YAML). " + units +
         "\n<name> is a name of yours, <index> an item of a list, the first is 0; --set path=value "
         "uses\nthe same paths.\n\n" +
         (topic.empty() ? referenceText(schema) : topicText(schema, topic));
}
} // namespace

const std::vector<Reference>& recipeReferences()
{
  static const std::vector<Reference> references{
      {"--help-recipe", "Print every key of a recipe and stop",
       [](const std::string& topic) { return plain("a recipe", recipeSchema(), topic); }, true},
      {"--help-split", "Print every key of a recipe of joints and stop",
       [](const std::string& topic)
       { return plain("a recipe of joints", jointRecipeSchema(), topic); },
       true},
      {"--help-blocks", "Print every key of a recipe of blocks and stop",
       [](const std::string& topic)
       { return plain("a recipe of blocks", blocksRecipeSchema(), topic); },
       true},
      {"--help-example", "Print every key of an example.yaml and stop",
       [](const std::string& topic) { return plain("an example.yaml", exampleSchema(), topic); },
       true},
      {"--help-recipe-markdown", "All of these as Markdown",
       [](const std::string&) { return markdown(); }},
      {"--recipe-schema", "Print the JSON Schema of recipes and stop",
       [](const std::string&) { return jsonSchema(recipeSchema(), "Coplane mesh recipe"); }},
      {"--split-schema", "Print the JSON Schema of recipes of joints and stop",
       [](const std::string&) { return jsonSchema(jointRecipeSchema(), "Coplane joint recipe"); }},
      {"--blocks-schema", "Print the JSON Schema of recipes of blocks and stop",
       [](const std::string&) { return jsonSchema(blocksRecipeSchema(), "Coplane block recipe"); }},
      {"--example-schema", "Print the JSON Schema of example.yaml files and stop",
       [](const std::string&) { return jsonSchema(exampleSchema(), "Coplane example"); }}};
  return references;
}
} // namespace coplane
