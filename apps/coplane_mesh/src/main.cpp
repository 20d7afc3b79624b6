#include "AbaqusFile.hpp"
#include "ConvertGmsh.hpp"
#include "Cuts.hpp"
#include "ExampleFile.hpp"
#include "JointRecipe.hpp"
#include "MakeMesh.hpp"
#include "MergeMeshes.hpp"
#include "MeshCommand.hpp"
#include "Recipe.hpp"
#include "RecipeReference.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/Memory.hpp>
#include <coplane_core/Program.hpp>
#include <coplane_core/Version.hpp>
#include <coplane_exodus/ReadMesh.hpp>

#include <CLI/CLI.hpp>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>
#include <functional>
#include <unistd.h>

namespace coplane
{
namespace
{
/// `coplane_mesh blocks` is a program of its own, so that the others need not load Gmsh.
[[noreturn]] void startBlocks(char** argv)
{
  std::error_code unknown;
  const auto own = std::filesystem::read_symlink("/proc/self/exe", unknown);
  std::string program = own.parent_path() / "coplane_mesh_blocks";
  argv[1] = program.data();
  ::execv(program.c_str(), argv + 1);
  fail(ExitCode::Usage,
       "{} cannot be started: {}. It is built and installed beside coplane_mesh where Gmsh, "
       "Voro++ and Assimp are (Debian: libgmsh-dev, voro++-dev, libassimp-dev).",
       program, std::strerror(errno));
}

/// A recipe of blocks, which `make` takes as well.
bool isOfBlocks(const std::string& recipe)
{
  const DeckNode root = parseYaml(readTextFile(recipe, recipeFile()), recipe, recipeFile());
  return root.find("domain") && !root.find("parts");
}

void make(const std::string& recipe, const std::vector<std::string>& overrides,
          const std::string& output, char** argv)
{
  if (isOfBlocks(recipe))
    startBlocks(argv);
  std::vector<std::pair<std::string, std::string>> inputs{{recipe, "the recipe"}};
  for (const std::string& file : meshFilesOf(recipe, overrides))
    inputs.push_back({file, "a mesh of the recipe"});
  demandDistinct(inputs, output);
  reportAndWrite(makeMesh(recipe, overrides), recipe, output);
}

void split(const std::string& file, const std::string& recipe,
           const std::vector<std::string>& overrides, const std::string& output)
{
  demandDistinct({{file, "the mesh"}, {recipe, "the recipe of joints"}}, output);
  const Mesh mesh = readMesh(file);
  const std::vector<MeshFace> faces = facesOf(mesh);
  const CutSelection selection =
      selectCuts(readTextFile(recipe, jointRecipeFile()), recipe, mesh, faces, overrides);
  SplitMesh result = splitMesh(mesh, faces, selection.cuts);
  for (std::size_t c = 0; c < result.cuts.size(); ++c)
  {
    const int closed = result.cuts[c].closed;
    if (result.cuts[c].opened == 0)
      fail(
          ExitCode::Deck,
          "{}: joints.{} opens nothing: all nodes of its {} faces lie on its rim, where both sides "
          "hang together. Make it longer, or the mesh finer.",
          recipe, result.cuts[c].name, closed);
    print(selection.notes[c] +
          (closed > 0
               ? fmt::format("; {} of them stay closed: all their nodes are on the rim", closed)
               : ""));
  }
  print(fmt::format("{} nodes copied; {} bodies became {}", result.copies, result.bodiesBefore,
                    result.bodies));
  result.mesh.qaRecords.push_back(qaRecord());
  reportAndWrite(result.mesh, file, output);
}

/// @param prefixes one a file, or none; weld: nodes no farther apart become one [m], 0: none do
void merge(const std::vector<std::string>& files, const std::vector<std::string>& prefixes,
           bool join, Real weld, const std::string& output)
{
  if (!prefixes.empty() && prefixes.size() != files.size())
    fail(ExitCode::Usage,
         "--prefix stands {} times for {} meshes. Accepted: once for each, in their order; \"\" "
         "leaves names as they are.",
         prefixes.size(), files.size());
  std::vector<std::pair<std::string, std::string>> inputs;
  std::vector<MeshToMerge> meshes;
  for (const std::string& file : files)
    inputs.push_back({file, "a mesh to merge"});
  demandDistinct(inputs, output);
  for (std::size_t f = 0; f < files.size(); ++f)
    meshes.push_back(
        {readMesh(files[f]), files[f], prefixes.empty() ? std::string() : prefixes[f], join});
  MergedMesh merged = mergeMeshes(meshes, weld);
  for (std::size_t f = 0; f < files.size(); ++f)
    print(fmt::format("{}: {} nodes, {} elements{}", files[f], meshes[f].mesh.nodes(),
                      meshes[f].mesh.elements(),
                      weld > 0 && f > 0 ? fmt::format("; {} nodes welded", merged.welded[f]) : ""));
  for (const std::string& note : merged.notes)
    print("note: " + note);
  merged.mesh.title = std::filesystem::path(output).filename().string();
  merged.mesh.qaRecords.push_back(qaRecord());
  reportAndWrite(merged.mesh, output, output);
}

bool isOfAbaqus(const std::string& file)
{
  const std::string ending = std::filesystem::path(file).extension();
  return ending == ".inp" || ending == ".INP";
}

void convert(const std::string& file, const std::string& output)
{
  demandDistinct({{file, "the file to convert"}}, output);
  AbaqusFile read;
  if (isOfAbaqus(file))
    read = readAbaqusFile(file);
  else
    read.mesh = readGmshFile(file);
  ConvertedMesh converted = convertGmsh(read.mesh, file);
  converted.notes.insert(converted.notes.begin(), read.notes.begin(), read.notes.end());
  for (const std::string& note : converted.notes)
    print("note: " + note);
  converted.mesh.title = std::filesystem::path(file).filename().string();
  converted.mesh.qaRecords.push_back(qaRecord());
  reportAndWrite(converted.mesh, file, output);
}

void check(const std::string& file)
{
  const Mesh mesh = readMesh(file);
  print(fmt::format("{}: {}", file, mesh.title));
  reportOn(mesh, file);
}

void showExample(const std::string& file)
{
  std::fputs(exampleAsJson(readTextFile(file, exampleFile()), file).c_str(), stdout);
}

/// What stands on the command line.
struct Arguments
{
  std::string recipe, output, file;
  std::vector<std::string> overrides, files, prefixes;
  bool join = false;
  Real weld = 0; ///< [m]
};

struct Command
{
  CLI::App* line;
  std::function<void()> run;
};

void takeOverrides(CLI::App* line, Arguments& given, const char* example)
{
  line->add_option(
          "--set", given.overrides,
          fmt::format("Overrides a value of the recipe: --set {} (may be repeated)", example))
      ->allow_extra_args(false);
}

void takeOutput(CLI::App* line, Arguments& given)
{
  const auto isName = [](const std::string& name)
  { return std::string(name.empty() ? "the name is empty; accepted: the name of a file" : ""); };
  line->add_option("-o,--output", given.output, "Exodus II file to write")
      ->required()
      ->check(isName);
}

std::vector<Command> commandsOf(CLI::App& app, Arguments& given, char** argv)
{
  CLI::App* making = app.add_subcommand("make", "Write the mesh that a recipe describes");
  making->add_option("recipe", given.recipe, "recipe, a YAML file")->required();
  takeOverrides(making, given, "define.h=0.1");
  takeOutput(making, given);
  CLI::App* checking = app.add_subcommand(
      "check", "Report sizes and faults of a mesh; exit code 4 when it cannot be used");
  checking->add_option("mesh", given.file, "Exodus II file")->required();
  CLI::App* probing = app.add_subcommand(
      "probe", "Open a mesh and look into it; the programs do it before they read HDF5");
  probing->add_option("mesh", given.file, "Exodus II file")->required();
  CLI::App* splitting =
      app.add_subcommand("split", "Open joints in a conforming mesh by copying nodes");
  splitting->add_option("mesh", given.file, "Exodus II file")->required();
  splitting->add_option("recipe", given.recipe, "recipe of joints, a YAML file")->required();
  takeOverrides(splitting, given, "joints.fault.planes.tolerance=0.01");
  takeOutput(splitting, given);
  CLI::App* merging = app.add_subcommand("merge", "Put several meshes into one file");
  merging->add_option("meshes", given.files, "Exodus II files, two or more")
      ->required()
      ->expected(2, CLI::detail::expected_max_vector_size);
  merging
      ->add_option("--prefix", given.prefixes,
                   "Put before the names of blocks and sets; once for each mesh, in their order")
      ->allow_extra_args(false);
  merging->add_flag("--join", given.join,
                    "Blocks and sets of one name become one; otherwise such names are refused");
  merging
      ->add_option("--weld", given.weld,
                   "Nodes of different meshes become one when they are no farther apart [m]; "
                   "otherwise none do, and bodies that touch are in contact")
      ->check(
          [](const std::string& text)
          {
            const Real length = std::strtod(text.c_str(), nullptr);
            return std::string(length > 0 && std::isfinite(length)
                                   ? ""
                                   : "'" + text + "'; accepted: a length above 0, in metres");
          });
  takeOutput(merging, given);
  app.add_subcommand("blocks", "Cut a domain into blocks by joints, with openings, and mesh it");
  CLI::App* converting =
      app.add_subcommand("convert", "Write a mesh of Gmsh, Abaqus or CalculiX as Exodus II");
  converting
      ->add_option("mesh", given.file, "file of Gmsh, format 4.1, or of Abaqus or CalculiX, .inp")
      ->required();
  takeOutput(converting, given);
  CLI::App* showing = app.add_subcommand(
      "example", "Check an example.yaml of exodus_inputs and print what it says as JSON");
  showing->add_option("file", given.file, "example.yaml")->required();
  return {
      {making, [&, argv] { make(given.recipe, given.overrides, given.output, argv); }},
      {checking, [&] { check(given.file); }},
      {probing, [&] { probeMeshFile(given.file); }},
      {splitting, [&] { split(given.file, given.recipe, given.overrides, given.output); }},
      {merging, [&] { merge(given.files, given.prefixes, given.join, given.weld, given.output); }},
      {converting, [&] { convert(given.file, given.output); }},
      {showing, [&] { showExample(given.file); }}};
}

int run(int argc, char** argv)
{
  CLI::App app{"Writes Exodus II meshes from recipes, opens joints, merges, converts and checks "
               "meshes."};
  app.set_version_flag("--version",
                       fmt::format("coplane_mesh {} ({})", version().number, version().revision));
  const std::vector<Reference>& references = recipeReferences();
  std::deque<std::string> topics(references.size());
  std::vector<const CLI::Option*> asked;
  for (std::size_t r = 0; r < references.size(); ++r)
    asked.push_back(
        references[r].hasTopics
            ? app.add_option(references[r].option, topics[r],
                             references[r].meaning + "; of one TOPIC: a section, key, shape")
                  ->type_name("[TOPIC]")
                  ->expected(0, 1)
            : app.add_flag(references[r].option, references[r].meaning));
  Arguments given;
  const std::vector<Command> commands = commandsOf(app, given, argv);
  app.require_subcommand(0, 1);
  app.failure_message(
      [](const CLI::App*, const CLI::Error& error)
      {
        return fmt::format(
            "error: {}\nAccepted: coplane_mesh make RECIPE --output MESH, or another "
            "command: coplane_mesh --help\n",
            error.what());
      });
  try
  {
    app.parse(argc, argv);
  }
  catch (const CLI::ParseError& error)
  {
    return app.exit(error) == 0 ? int(ExitCode::Success) : int(ExitCode::Usage);
  }
  for (std::size_t r = 0; r < references.size(); ++r)
    if (*asked[r])
    {
      std::fputs(references[r].text(topics[r]).c_str(), stdout);
      return int(ExitCode::Success);
    }
  for (const Command& command : commands)
    if (command.line->parsed())
    {
      command.run();
      return int(ExitCode::Success);
    }
  std::fputs(app.help().c_str(), stderr);
  return int(ExitCode::Usage);
}
} // namespace
} // namespace coplane

int main(int argc, char** argv)
{
  coplane::beginProgram();
  coplane::limitMemoryToMachine();
  return coplane::exitCodeOf(
      [&]
      {
        if (argc > 1 && std::string(argv[1]) == "blocks")
          coplane::startBlocks(argv);
        coplane::demandOpenFiles();
        return coplane::run(argc, argv);
      });
}
