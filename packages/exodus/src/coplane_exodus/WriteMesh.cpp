#include <coplane_core/Error.hpp>
#include <coplane_exodus/ExodusCalls.hpp>
#include <coplane_exodus/MeshDefinition.hpp>
#include <coplane_exodus/WriteMesh.hpp>

#include <exodusII.h>

#include <csignal>
#include <filesystem>

namespace coplane
{
void writeMesh(const Mesh& mesh, const std::string& file)
{
  quietExodus();
  // Going beyond a file-size limit shall be an error of the call, like a full disk, not the death
  // of the program.
  std::signal(SIGXFSZ, SIG_IGN);
  const MeshSlice all = sliceOf(mesh);
  int exoid = -1;
  try
  {
    int memoryWord = 8, fileWord = 8;
    exoid = ex_create(file.c_str(), creationMode(largestId(all)), &memoryWord, &fileWord);
    checkExodus(exoid, "creating the file");
    defineMesh(exoid, all, {});
    writeMeshRanges(exoid, all);
    const int closing = exoid;
    exoid = -1;
    checkExodus(ex_close(closing), "closing the file");
  }
  catch (const ExodusFailure& failure)
  {
    if (exoid >= 0)
      ex_close(exoid);
    const auto folder = std::filesystem::absolute(file).parent_path();
    fail(ExitCode::Output,
         "{}: the mesh cannot be written ({}). Check that the folder '{}' exists, can be written "
         "to and is not full.",
         file, failure.what(), folder.string());
  }
}
} // namespace coplane
