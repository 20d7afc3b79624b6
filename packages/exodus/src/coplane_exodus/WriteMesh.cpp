#include <coplane_core/Error.hpp>
#include <coplane_exodus/ExodusCalls.hpp>
#include <coplane_exodus/MeshDefinition.hpp>
#include <coplane_exodus/WriteMesh.hpp>

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
  // Beside it first: a mesh of this name that is there is lost only when the new one is whole.
  std::error_code error;
  std::filesystem::path target = std::filesystem::canonical(file, error); // of a link
  if (error)
    target = file;
  const std::string draft = target.string() + ".part";
  try
  {
    defineFile(draft, all, {}, creationMode(largestId(all)));
    SharedFile data(draft);
    data.reserveMesh();
    writeMeshRanges(data, all);
    data.sync();
    data.close();
    std::filesystem::rename(draft, target, error);
    if (error)
      throw ExodusFailure(error.message());
  }
  catch (const ExodusFailure& failure)
  {
    std::filesystem::remove(draft, error);
    const auto folder = std::filesystem::absolute(file).parent_path();
    fail(ExitCode::Output,
         "{}: the mesh cannot be written ({}). Check that the folder '{}' exists, can be written "
         "to and is not full.",
         file, failure.what(), folder.string());
  }
}
} // namespace coplane
