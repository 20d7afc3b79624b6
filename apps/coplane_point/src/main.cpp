#include "ErrorsOfPaths.hpp"
#include "JointPaths.hpp"
#include "PathWriter.hpp"
#include "PointDeck.hpp"

#include <coplane_core/DraftName.hpp>
#include <coplane_core/Error.hpp>
#include <coplane_core/FileRoles.hpp>
#include <coplane_core/Memory.hpp>
#include <coplane_core/OutputLocks.hpp>
#include <coplane_core/Program.hpp>
#include <coplane_core/Version.hpp>
#include <coplane_input/MaterialCards.hpp>
#include <coplane_schema/SchemaReference.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <set>

namespace coplane
{
namespace
{
void print(const std::string& text)
{
  std::fputs((text + "\n").c_str(), stdout);
}

void runPath(const PointDeck& deck, const JointPathCard& card)
{
  PathWriter writer(card.output);
  withPlaceOf(card, "joint_paths",
              [&] {
                followPath(card, pointOf(deck, card),
                           [&](const JointPoint& point) { writer.write(point); });
              });
  writer.finish();
  print(fmt::format("{}: {} of joint '{}'", card.name, card.type, card.joint));
  print(writer.summary());
}

/// One beside each output; beside what links lead to.
std::set<std::string> lockFilesOf(const PointDeck& deck)
{
  std::set<std::string> files;
  for (const JointPathCard& card : deck.jointPaths)
    files.insert(placeOfFile(card.output) + ".lock");
  for (const MaterialPathCard& card : deck.materialPaths)
    files.insert(placeOfFile(card.output) + ".lock");
  return files;
}

FileRoles outputsOf(const PointDeck& deck)
{
  FileRoles roles;
  for (const std::string& file : lockFilesOf(deck))
    roles.writes(file, "the lock of an output");
  const auto writes = [&](const std::string& file, const std::string& what)
  {
    roles.writes(file, what);
    roles.writesDraft({draftOf(placeOfFile(file))}, what);
  };
  for (const JointPathCard& card : deck.jointPaths)
    writes(card.output, fmt::format("the output of joint_paths.{}", card.name));
  for (const MaterialPathCard& card : deck.materialPaths)
    writes(card.output, fmt::format("the output of material_paths.{}", card.name));
  return roles;
}

void demandDistinctFiles(const PointDeck& deck)
{
  FileRoles roles = outputsOf(deck);
  roles.reads(deck.file, "the deck");
  for (const JointPathCard& card : deck.jointPaths)
    if (!card.file.empty())
      roles.reads(card.file, fmt::format("the path (joint_paths.{}.file)", card.name));
  if (const std::vector<std::string> problems = roles.problems(); !problems.empty())
    fail(ExitCode::Deck, "{}: {}", deck.file, fmt::join(problems, "\n"));
}

std::string reference(bool markdown, const std::string& topic)
{
  return markdown
             ? "# Decks of coplane_point\n\nMade from the schema that checks decks. Numbers are "
               "SI. `<name>` is a name of yours; `--set path=value` uses the same paths.\n\n" +
                   referenceMarkdown(pointSchema())
             : "Keys of a deck of coplane_point (YAML). Numbers are SI. <name> is a name of "
               "yours; --set path=value\nuses the same paths.\n\n" +
                   (topic.empty() ? referenceText(pointSchema()) : topicText(pointSchema(), topic));
}

struct CommandLine
{
  std::string file, topic;
  std::vector<std::string> overrides;
  bool check = false, help = false, markdown = false, schema = false;

  bool asksForHelp() const { return help || markdown || schema; }
};

/// Exit code when the program should end now, -1 to go on.
int parse(int argc, char** argv, CommandLine& line)
{
  CLI::App app{"Leads laws along prescribed paths at one point and writes CSV files.\n"
               "Example: coplane_point exodus_inputs/joint_paths/mortar.yaml\n"};
  app.set_version_flag("--version",
                       fmt::format("coplane_point {} ({})", version().number, version().revision));
  app.add_option("deck", line.file, "The deck (YAML); --help-deck lists its keys");
  app.add_option("--set", line.overrides,
                 "Overrides a deck value: --set joint_paths.test.steps=1000 (may be repeated)")
      ->allow_extra_args(false);
  app.add_flag("--check", line.check, "Check the deck and stop");
  CLI::Option* help =
      app.add_option("--help-deck", line.topic,
                     "Print every key of a deck and stop; of one TOPIC: a section, key or model")
          ->type_name("[TOPIC]")
          ->expected(0, 1);
  app.add_flag("--help-deck-markdown", line.markdown, "The same as Markdown");
  app.add_flag("--schema", line.schema, "Print the JSON Schema of decks and stop");
  try
  {
    app.parse(argc, argv);
    line.help = help->count() > 0;
    if (!line.asksForHelp() && line.file.empty())
      throw CLI::RequiredError("deck");
  }
  catch (const CLI::ParseError& error)
  {
    return app.exit(error) == 0 ? int(ExitCode::Success) : int(ExitCode::Usage);
  }
  return -1;
}

void runPaths(const PointDeck& deck)
{
  const FileRoles outputs = outputsOf(deck);
  const auto locks = lockOutputs(outputs, lockFilesOf(deck), deck.file);
  removeDraftsOfKilled(outputs, locks);
  for (const JointPathCard& card : deck.jointPaths)
    runPath(deck, card);
  for (const MaterialPathCard& card : deck.materialPaths)
  {
    const auto material =
        std::find_if(deck.materials.begin(), deck.materials.end(),
                     [&](const MaterialCard& one) { return one.name == card.material; });
    print(runMaterialPath(card, materialOf(*material)));
  }
}

int run(int argc, char** argv)
{
  CommandLine line;
  if (const int code = parse(argc, argv, line); code >= 0)
    return code;
  if (line.asksForHelp())
  {
    std::fputs((line.schema ? jsonSchema(pointSchema(), "Coplane point deck")
                            : reference(line.markdown, line.topic))
                   .c_str(),
               stdout);
    return int(ExitCode::Success);
  }
  const PointDeck deck = readPointDeck(line.file, line.overrides);
  for (const std::string& warning : deck.warnings)
    std::fputs(("warning: " + warning + "\n").c_str(), stderr);
  demandDistinctFiles(deck);
  if (line.check)
    print("check: the deck is fine; nothing was run");
  else
    runPaths(deck);
  return int(ExitCode::Success);
}
} // namespace
} // namespace coplane

int main(int argc, char** argv)
{
  coplane::beginProgram();
  coplane::limitMemoryToMachine();
  return coplane::exitCodeOf([&] { return coplane::run(argc, argv); });
}
