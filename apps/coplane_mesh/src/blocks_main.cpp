#include "ConvertGmsh.hpp"
#include "CutApart.hpp"
#include "MakeMesh.hpp"
#include "MeshCommand.hpp"
#include "MeshFaces.hpp"
#include "Selection.hpp"
#include "SplitMesh.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_core/Memory.hpp>
#include <coplane_core/PlaceText.hpp>
#include <coplane_core/Program.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>

namespace coplane
{
namespace
{
bool isJoint(const std::string& name, const CutDomain& domain)
{
  return std::find(domain.joints.begin(), domain.joints.end(), name) != domain.joints.end();
}

/// The faces of each joint, in the order of the recipe.
std::vector<Cut> cutsOf(const Mesh& mesh, const std::vector<MeshFace>& faces,
                        const CutDomain& domain)
{
  std::map<std::pair<int, int>, int> faceOfSide;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (int k = 0; k < faces[f].count; ++k)
      faceOfSide[{faces[f].elements[k], faces[f].sides[k]}] = int(f);
  std::vector<Cut> cuts;
  for (const std::string& joint : domain.joints)
  {
    Cut cut{joint, {}};
    for (const Mesh::SideSet& set : mesh.sideSets)
      if (set.name == joint)
        for (std::size_t s = 0; s < set.elements.size(); ++s)
          cut.faces.push_back(faceOfSide.at({set.elements[s], set.sides[s]}));
    std::sort(cut.faces.begin(), cut.faces.end());
    cut.faces.erase(std::unique(cut.faces.begin(), cut.faces.end()), cut.faces.end());
    cuts.push_back(cut);
  }
  return cuts;
}

template <class Set>
void eraseJoints(std::vector<Set>& sets, const CutDomain& domain)
{
  sets.erase(std::remove_if(sets.begin(), sets.end(),
                            [&](const Set& set) { return isJoint(set.name, domain); }),
             sets.end());
}

/// The conforming mesh with its joints opened.
SplitMesh openJoints(const CutDomain& domain, const std::string& recipe)
{
  Mesh mesh = convertGmsh(domain.mesh, recipe).mesh;
  const std::vector<MeshFace> faces = facesOf(mesh);
  const std::vector<Cut> cuts = cutsOf(mesh, faces, domain);
  eraseJoints(mesh.sideSets, domain);
  eraseJoints(mesh.nodeSets, domain);
  SplitMesh result = splitMesh(mesh, faces, cuts, Hinges::Open);
  for (const CutReport& cut : result.cuts)
    if (cut.opened == 0)
      fail(ExitCode::Deck,
           "{}: joints.{} opens nothing: all nodes of its {} faces lie on its rim, where both "
           "sides hang together. Make it longer, or elements smaller.",
           recipe, cut.name, cut.closed);
  return result;
}

void printBlocks(const CutDomain& domain, const BlocksRecipe& recipe, const SplitMesh& result)
{
  const bool flat = recipe.dimension == 2;
  const char *volume = flat ? "m^2" : "m^3", *area = flat ? "m" : "m^2";
  const auto& volumes = domain.blockVolumes;
  const Real total = std::accumulate(volumes.begin(), volumes.end(), 0.0);
  print(fmt::format("{} parts between joints, of {:.4g} to {:.4g} {}, {:.4g} on average; {} bodies "
                    "that share no node",
                    volumes.size(), *std::min_element(volumes.begin(), volumes.end()),
                    *std::max_element(volumes.begin(), volumes.end()), volume,
                    total / Real(volumes.size()), result.bodies));
  if (domain.joined > 0)
    print(
        fmt::format("{} slivers joined to neighbours (`slivers` says what is one)", domain.joined));
  if (domain.stubs > 0)
    print(fmt::format("{} short ends of joints left out (`slivers.stub`)", domain.stubs));
  if (domain.slivers > 0)
    print(
        fmt::format("note: {} slivers stay: no joint between them and a neighbour can be left out",
                    domain.slivers));
  if (domain.changes > 0)
    print(fmt::format("{} changes mended flat elements: the worst is worth {:.3g}, was {:.3g}",
                      domain.changes, domain.worst, domain.worstBefore));
  for (const std::string& note : domain.notes)
    print("note: " + note);
  if (!result.hinges.empty())
    print(fmt::format(
        "note: parts hung together by a node or an edge only, which would be a hinge: "
        "{} nodes were doubled, the first at {} m. An opening, a joint or a border "
        "ends askew there; move it if the parts are to hold together",
        result.hinges.size(), placeText(result.hinges.front(), recipe.elements.size / 10)));
  for (const std::string& note :
       notesOfLeftOut(domain.measures, result.cuts, recipe.dimension, recipe.elements.size / 10))
    print("note: " + note);
  for (std::size_t j = 0; j < result.cuts.size(); ++j)
  {
    const CutReport& joint = result.cuts[j];
    print(fmt::format("joint '{}': {:.6g} {} of {:.6g} {} asked for, mean spacing {:.4g} m; {} "
                      "faces opened{}",
                      joint.name, joint.area, area, domain.measures[j].asked, area,
                      total / joint.area, joint.opened,
                      joint.closed > 0
                          ? fmt::format(", {} closed: all their nodes are on the rim", joint.closed)
                          : ""));
  }
}

void makeBlocks(const std::string& file, const std::vector<std::string>& overrides,
                const std::string& output)
{
  demandDistinct({{file, "the recipe"}}, output);
  const BlocksRecipe recipe =
      parseBlocksRecipe(readTextFile(file, blocksRecipeFile()), file, overrides);
  const CutDomain domain = cutDomainApart(recipe, file);
  SplitMesh result = openJoints(domain, file);
  printBlocks(domain, recipe, result);
  Mesh& mesh = result.mesh;
  mesh.title =
      recipe.title.empty() ? std::filesystem::path(file).filename().string() : recipe.title;
  mesh.qaRecords.push_back(qaRecord());
  Problems problems;
  addSets(mesh, mesh.coordinates, recipe, problems);
  if (!problems.empty())
    throw Error(ExitCode::Deck, problems.text());
  reportAndWrite(mesh, file, output);
}

int run(int argc, char** argv)
{
  CLI::App app{"Cuts a domain into blocks by joints, with openings, and writes the mesh of the "
               "blocks. Geometry and meshing are Gmsh's.",
               "coplane_mesh blocks"};
  std::string recipe, output;
  std::vector<std::string> overrides;
  app.add_option("recipe", recipe, "recipe of blocks, a YAML file")->required();
  app.add_option("--set", overrides,
                 "Overrides a value of the recipe: --set elements.size=0.2 (may be repeated)")
      ->allow_extra_args(false);
  app.add_option("-o,--output", output, "Exodus II file to write")->required();
  app.failure_message(
      [](const CLI::App*, const CLI::Error& error)
      {
        return fmt::format("error: {}\nAccepted: coplane_mesh blocks RECIPE --output MESH; "
                           "coplane_mesh --help-blocks lists the keys of the recipe\n",
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
  if (output.empty())
    fail(ExitCode::Usage, "--output: the name is empty; accepted: the name of a file");
  makeBlocks(recipe, overrides, output);
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
