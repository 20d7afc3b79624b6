#include "DeckReference.hpp"

#include "detail/DeckSchema.hpp"

#include <coplane_schema/SchemaReference.hpp>

namespace coplane
{
std::string deckReferenceText(const std::string& topic)
{
  const std::string out =
      "Keys of a Coplane deck (YAML). Numbers are SI. <name> is a name of yours or of "
      "the mesh,\n<index> an item of a list, the first is 0; --set path=value uses "
      "the same paths.\n\n";
  return out + (topic.empty() ? referenceText(deckSchema()) : topicText(deckSchema(), topic));
}

std::string deckReferenceMarkdown()
{
  std::string out = "# Deck reference\n\nMade from the schema "
                    "that checks decks. Numbers are SI. `<name>` is a name of yours or of the "
                    "mesh, `<index>` an item of a list, the first is 0; `--set path=value` uses "
                    "the same paths.\n\n";
  return out + referenceMarkdown(deckSchema());
}

std::string deckJsonSchema()
{
  return jsonSchema(deckSchema(), "Coplane deck");
}
} // namespace coplane
