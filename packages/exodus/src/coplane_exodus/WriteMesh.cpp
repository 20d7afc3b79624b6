#include <coplane_core/DraftName.hpp>
#include <coplane_core/Error.hpp>
#include <coplane_core/FileRoles.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_exodus/ExodusCalls.hpp>
#include <coplane_exodus/Provenance.hpp>
#include <coplane_exodus/WriteMesh.hpp>
#include <coplane_exodus/detail/MeshDefinition.hpp>

#include <csignal>
#include <filesystem>

namespace coplane
{
namespace
{
constexpr std::size_t longestName = 255; // NC_MAX_NAME, less its end

/// Exodus ends names at a zero, and takes blanks at their end for filling.
template <class Entities>
void demandNames(const Entities& entities, const char* kind, const std::string& file)
{
  for (const auto& entity : entities)
  {
    const std::string& name = entity.name;
    const char* const fault = name.size() > longestName              ? "is longer than 255 bytes"
                              : name.find('\0') != std::string::npos ? "holds a zero byte"
                              : !name.empty() && name.back() == ' '  ? "ends with a blank"
                                                                     : nullptr;
    if (fault)
      fail(ExitCode::Deck,
           "{}: the name '{}' of a {} {}, which Exodus files cannot keep. Accepted: any letters in "
           "UTF-8, up to 255 bytes. Choose another name.",
           file, std::string(name.c_str()).substr(0, longestName), kind, fault);
  }
}
} // namespace

void writeMesh(const Mesh& mesh, const std::string& file)
{
  demandNames(mesh.blocks, "block", file);
  demandNames(mesh.nodeSets, "node set", file);
  demandNames(mesh.sideSets, "side set", file);
  quietExodus();
  // Going beyond a file-size limit shall be an error of the call, like a full disk, not the death
  // of the program.
  std::signal(SIGXFSZ, SIG_IGN);
  const MeshSlice all = sliceOf(mesh);
  // Beside it first: a mesh of this name that is there is lost only when the new one is whole.
  std::error_code error;
  const std::string target = placeOfFile(file), draft = draftOf(target);
  try
  {
    defineFile(draft, all, {}, creationMode(largestId(all)));
    SharedFile data(draft);
    data.reserveMesh();
    writeMeshRanges(data, all);
    data.sync();
    data.close();
    makeWayFor(target, isMeshOfCoplane);
    std::filesystem::rename(draft, target, error);
    if (error)
      throw ExodusFailure(error.message());
  }
  catch (const ExodusFailure& failure)
  {
    std::filesystem::remove(draft, error);
    fail(ExitCode::Output,
         "{}: the mesh cannot be written ({}). Check that the folder '{}' exists, can be written "
         "to and is not full.",
         file, failure.what(), folderOf(file));
  }
  catch (...)
  {
    std::filesystem::remove(draft, error);
    throw;
  }
}
} // namespace coplane
