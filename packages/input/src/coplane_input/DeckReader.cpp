#include "DeckReader.hpp"

#include "DeckChecks.hpp"
#include "MaterialCards.hpp"
#include "detail/DeckSchema.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_schema/SchemaReader.hpp>

#include <filesystem>

namespace coplane
{
std::string readDeckFile(const std::string& file)
{
  return readTextFile(file);
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
  bool defines = false;
  const auto prepare = [&](DeckNode& root)
  {
    defines = root.find("define") != nullptr;
    insertMaterialSets(root);
  };
  const DeckNode root = readBySchema(deckSchema(), text, file, overrides, &deck, problems, prepare);
  // Where values do not stand as written, the text of the run has them as they were read.
  deck.text = overrides.empty() && !defines ? text : toYaml(root);
  if (const DeckNode* mesh = root.find("mesh"))
    deck.meshWhere = mesh->where;
  if (const DeckNode* blocks = root.find("blocks"))
    deck.blocksWhere = blocks->where;
  checkDeck(deck, root, problems);
  if (!problems.empty())
    throw Error(ExitCode::Deck, problems.text());
  deck.warnings = problems.warnings();
  deck.mesh = (path.parent_path() / deck.mesh).lexically_normal().string();
  return deck;
}

Deck readDeck(const std::string& file, const std::vector<std::string>& overrides)
{
  return parseDeck(readDeckFile(file), file, overrides);
}
} // namespace coplane
