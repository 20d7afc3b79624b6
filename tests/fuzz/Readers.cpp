#include "Readers.hpp"

#include <coplane_core/Error.hpp>
#include <coplane_exodus/ReadMesh.hpp>
#include <coplane_exodus/WriteMesh.hpp>
#include <coplane_input/DeckReader.hpp>

#include <exodusII.h>

#include <ConvertGmsh.hpp>
#include <GmshFile.hpp>
#include <MakeMesh.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace coplane
{
std::string textOfFile(const std::string& path)
{
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
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
} // namespace

const std::vector<Reader>& readers()
{
  const auto readExodus = [](const std::string& path) { readMesh(path); };
  static const std::vector<Reader> all{
      {"deck", ".yaml", textOfFile, [](const std::string& path) { readDeck(path); }},
      {"gmsh", ".msh", textOfFile,
       [](const std::string& path) { convertGmsh(readGmshFile(path), path); }},
      {"exodus", ".e", [](const std::string& path) { return textOfFile(exodusFile(path)); },
       readExodus, false, 1000},
      {"exodus_hdf5", ".e",
       [](const std::string& path) { return textOfFile(exodusFileInHdf5(path)); }, readExodus,
       true}};
  return all;
}
} // namespace coplane
