#include "DeckReader.hpp"

#include "DeckChecks.hpp"
#include "DeckSchema.hpp"
#include "MaterialCards.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/FileRoles.hpp>
#include <coplane_schema/SchemaReader.hpp>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace coplane
{
std::string readDeckFile(const std::string& file)
{
  if (const std::string kind = kindOfSpecialFile(file); !kind.empty())
    fail(ExitCode::Deck, "{}: this is {}; accepted: a deck, which is a YAML file.", file, kind);
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (!stream || !(text << stream.rdbuf() || stream.peek() == EOF))
    fail(ExitCode::Deck, "{}: the deck cannot be read ({}). Check the path and its permissions.",
         file, std::generic_category().message(errno));
  return text.str();
}

Deck parseDeck(const std::string& text, const std::string& file,
               const std::vector<std::string>& overrides)
{
  Problems problems;
  const std::filesystem::path path(file);
  Deck deck;
  deck.file = file;
  deck.output.results = path.stem().string() + ".e";
  deck.history.file = path.stem().string() + ".csv";
  deck.checkpoint.file = path.stem().string() + ".chk";
  const DeckNode root =
      readBySchema(deckSchema(), text, file, overrides, &deck, problems, insertMaterialSets);
  deck.text = overrides.empty() ? text : toYaml(root); // the same deck with or without its sets
  if (const DeckNode* mesh = root.find("mesh"))
    deck.meshWhere = mesh->where;
  if (const DeckNode* blocks = root.find("blocks"))
    deck.blocksWhere = blocks->where;
  checkDeck(deck, root, problems);
  if (!problems.empty())
    throw Error(ExitCode::Deck, problems.text());
  deck.mesh = (path.parent_path() / deck.mesh).lexically_normal().string();
  return deck;
}

Deck readDeck(const std::string& file, const std::vector<std::string>& overrides)
{
  return parseDeck(readDeckFile(file), file, overrides);
}
} // namespace coplane
