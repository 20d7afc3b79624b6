#include "Readers.hpp"

#include <coplane_checkpoint/CheckpointFile.hpp>
#include <coplane_checkpoint/CheckpointWriter.hpp>
#include <coplane_core/Error.hpp>
#include <coplane_exodus/ReadMesh.hpp>
#include <coplane_exodus/WriteMesh.hpp>
#include <coplane_input/DeckReader.hpp>

#include <exodusII.h>

#include <ConvertGmsh.hpp>
#include <GmshFile.hpp>
#include <MakeMesh.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace coplane
{
std::string textOfFile(const std::string& path)
{
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string>& goodFiles()
{
  static std::vector<std::string> contents;
  return contents;
}

namespace
{
/// The mesh of a recipe as an Exodus file.
std::string exodusFile(const std::string& recipe)
{
  const std::string file =
      std::filesystem::path(recipe).parent_path().filename().string() + "_good.e";
  writeMesh(makeMesh(recipe), file);
  return file;
}

/// The same in HDF5 instead of classic netCDF.
std::string exodusFileInHdf5(const std::string& recipe)
{
  const std::string from = exodusFile(recipe), to = from + "4";
  int memoryWord = 8, fileWord = 8;
  float version = 0;
  const int in = ex_open(from.c_str(), EX_READ, &memoryWord, &fileWord, &version);
  const int out = ex_create(to.c_str(), EX_CLOBBER | EX_NETCDF4, &memoryWord, &fileWord);
  if (in < 0 || out < 0 || ex_copy(in, out) < 0)
    fail(ExitCode::Internal, "{} cannot be copied to {}", from, to);
  ex_close(in);
  ex_close(out);
  return to;
}
/// MPI from the first use to the end of the process.
const Comm& comm()
{
  static const bool started = MPI_Init(nullptr, nullptr) == MPI_SUCCESS;
  static const Comm world(started ? MPI_COMM_WORLD : MPI_COMM_NULL);
  return world;
}

/// A small checkpoint. A child writes it: this process is forked once more, which MPI does not
/// like.
std::string checkpointFile(const std::string& name)
{
  if (const pid_t child = fork(); child == 0)
  {
    CheckpointWriter out(comm());
    KeyedRows rows;
    rows.columns = {"x", "y"};
    for (int i = 0; i < 40; ++i)
      rows.add({3 * i})[0] = 1.0 / (i + 1);
    out.rows("nodes", rows);
    out.numbers("clock", {1, 0.25});
    out.text("deck", "time.end = 1\n");
    out.write(name, 17, 0.25);
    MPI_Finalize();
    _exit(0);
  }
  else
    waitpid(child, nullptr, 0);
  return textOfFile(name);
}

void readCheckpoint(const std::string& file)
{
  CheckpointHead head;
  const std::string problem = verifyCheckpoint(file, comm(), head);
  if (!problem.empty())
    fail(ExitCode::Checkpoint, "{}: {}", file, problem);
  const std::string content = textOfFile(file);
  const auto& good = goodFiles();
  if (!good.empty() && std::find(good.begin(), good.end(), content) == good.end())
    throw std::runtime_error("a spoilt checkpoint is taken for a whole one");
}

/// Counts that make a mesh of millions of nodes are no fault, but take minutes: such recipes are
/// left out here.
bool asksForMuch(const std::string& recipe)
{
  std::vector<double> counts;
  for (std::size_t at = 0; (at = recipe.find_first_of("0123456789", at)) != std::string::npos;)
  {
    const std::size_t end = std::min(recipe.find_first_not_of("0123456789", at), recipe.size());
    counts.push_back(std::strtod(recipe.substr(at, end - at).c_str(), nullptr));
    at = end;
  }
  std::sort(counts.rbegin(), counts.rend());
  double product = 1;
  for (std::size_t i = 0; i < std::min<std::size_t>(6, counts.size()); ++i)
    product *= std::max(1.0, counts[i]);
  return product > 1e6 && !(product > 1e60);
}

void readRecipe(const std::string& file)
{
  if (!asksForMuch(textOfFile(file)))
    makeMesh(file);
}
} // namespace

const std::vector<Reader>& readers()
{
  const auto readExodus = [](const std::string& path) { readMesh(path); };
  static const std::vector<Reader> all{
      {"deck", ".yaml", textOfFile, [](const std::string& path) { readDeck(path); }},
      {"recipe", ".yaml", textOfFile, readRecipe},
      {"gmsh", ".msh", textOfFile,
       [](const std::string& path) { convertGmsh(readGmshFile(path), path); }},
      {"exodus", ".e", [](const std::string& path) { return textOfFile(exodusFile(path)); },
       readExodus, false, 1000},
      {"exodus_hdf5", ".e",
       [](const std::string& path) { return textOfFile(exodusFileInHdf5(path)); }, readExodus,
       true},
      {"checkpoint", ".chk", checkpointFile, readCheckpoint}};
  return all;
}
} // namespace coplane
