#include "DeckReader.hpp"

#include "DeckChecks.hpp"
#include "DeckFingerprint.hpp"
#include "MaterialCards.hpp"
#include "detail/DeckSchema.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_schema/SchemaReader.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace coplane
{
std::string readDeckFile(const std::string& file)
{
  return readTextFile(file);
}

namespace
{
/// The changes of the stages from the second to this one.
void applyStages(DeckNode& root, int last, Problems& problems)
{
  const DeckNode* const stages = root.find("stages");
  if (last == 0 || !stages)
    return;
  const std::vector<DeckNode> items = stages->items;
  const auto apply = [&](int i, const DeckNode& path, const DeckNode& value)
  {
    if (isOfStages(path.text))
      applyChange(root, path, value, problems);
    else
      problems.add(path, fmt::format("stages.{}.set: a stage cannot change {}. {}", i, path.text,
                                     whatStagesMayChange()));
  };
  for (int i = 1; i <= last; ++i)
    if (const DeckNode* set = items[std::size_t(i)].find("set"))
      for (const auto& [path, value] : set->entries)
        apply(i, path, value);
  // What stages have taken out keeps its number up to here.
  if (DeckNode* const conditions = root.find("conditions"))
    conditions->items.erase(std::remove_if(conditions->items.begin(), conditions->items.end(),
                                           [](const DeckNode& item)
                                           { return item.kind == DeckNode::Kind::Nothing; }),
                            conditions->items.end());
}

/// @param stage whose deck is wanted; the first is 0
Deck parse(const std::string& text, const std::string& file,
           const std::vector<std::string>& overrides, int stage)
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
    applyStages(root, stage, problems);
  };
  FileKind kind;
  kind.idleNames = stage > 0;
  const DeckNode root =
      readBySchema(deckSchema(), text, file, overrides, &deck, problems, prepare, kind);
  // Where values do not stand as written, the text of the run has them as they were read.
  deck.text = overrides.empty() && !defines && stage == 0 ? text : toYaml(root);
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

/// What a stage may not change, or asks for in vain.
void checkStage(const std::vector<Deck>& decks, std::size_t i, Problems& problems)
{
  const Deck& deck = decks[i];
  const StageCard& card = deck.stages[i];
  DeckNode place;
  place.where = card.where;
  place.order = long(i);
  const std::string path = fmt::format("stages.{}", i);
  if (card.atRest && !deck.dampingEnergyRatio && !deck.dampingForceRatio)
    problems.add(place,
                 fmt::format("{}.at_rest has no effect without damping.until_energy_ratio or "
                             "damping.until_force_ratio, which say what rest is; give one "
                             "of them.",
                             path));
  if (i == 0)
    return;
  const DeckChanges changes = deckChanges(deckFingerprint(decks[i - 1].text, deck.file),
                                          deckFingerprint(deck.text, deck.file));
  for (const std::string& refused : changes.refused)
    problems.add(place, fmt::format("{}.set: {}; a stage cannot change this. {}", path, refused,
                                    whatStagesMayChange()));
}
} // namespace

Deck parseDeck(const std::string& text, const std::string& file,
               const std::vector<std::string>& overrides)
{
  return parse(text, file, overrides, 0);
}

std::vector<Deck> parseStages(const std::string& text, const std::string& file,
                              const std::vector<std::string>& overrides)
{
  std::vector<Deck> decks{parse(text, file, overrides, 0)};
  const std::vector<StageCard> stages = decks[0].stages;
  for (std::size_t i = 1; i < stages.size(); ++i)
    decks.push_back(parse(text, file, overrides, int(i)));
  Problems problems;
  for (std::size_t i = 0; i < stages.size(); ++i)
    checkStage(decks, i, problems);
  if (!problems.empty())
    throw Error(ExitCode::Deck, problems.text());
  for (std::size_t i = 0; i < stages.size(); ++i)
  {
    decks[i].time.end = stages[i].until.value_or(decks[i].time.end);
    decks[i].time.endAtRest = stages[i].atRest;
  }
  return decks;
}

std::vector<Deck> readStages(const std::string& file, const std::vector<std::string>& overrides)
{
  return parseStages(readDeckFile(file), file, overrides);
}

Deck readDeck(const std::string& file, const std::vector<std::string>& overrides)
{
  return parseDeck(readDeckFile(file), file, overrides);
}
} // namespace coplane
