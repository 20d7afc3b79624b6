#include <coplane_core/Error.hpp>
#include <coplane_core/FileRoles.hpp>
#include <coplane_core/MissingFile.hpp>
#include <coplane_core/SortOverRanks.hpp>
#include <coplane_exodus/ReadMesh.hpp>
#include <coplane_exodus/detail/FileProbe.hpp>
#include <coplane_exodus/detail/MeshParts.hpp>
#include <coplane_exodus/detail/MeshReader.hpp>

#include <filesystem>

namespace coplane
{
namespace
{
MeshSlice readParts(const std::string& file, const std::vector<std::string>& names,
                    const Comm& comm)
{
  if (names.empty())
    failOnAllRanks(
        ExitCode::Mesh,
        "{}: the mesh file does not exist (looked in '{}').{} Check the name, or write it "
        "with coplane_mesh make.",
        file, folderOf(file), hintOfMissingFile(file));
  std::vector<Mesh> parts;
  std::vector<GlobalId> blocks;
  comm.together(
      [&]
      {
        const IndexRange mine = contiguousRange(int(names.size()), comm.rank(), comm.size());
        for (int p = mine.first; p < mine.first + mine.count; ++p)
        {
          demandMeshFile(names[p]);
          ReadSlice read = readSliceOfFile(names[p], true, 0, 1);
          demandUniqueIds(names[p], read.slice, Comm::alone());
          parts.push_back(std::move(read.slice.mine));
          blocks = std::move(read.blockIds);
        }
      });
  MeshSlice slice = mergedParts(parts, blocks, file, comm);
  if (slice.elements() == 0)
    failOnAllRanks(ExitCode::Mesh, "{}: its {} parts have no elements. Split the mesh again.", file,
                   names.size());
  return slice;
}
} // namespace

MeshSlice readMesh(const std::string& file, const Comm& comm)
{
  MeshSlice slice;
  std::vector<std::string> names;
  std::error_code error;
  const bool exists = comm.min(std::int64_t(std::filesystem::exists(file, error))) == 1;
  comm.together(
      [&]
      {
        if (exists && comm.isRoot())
          demandMeshFile(file);
      });
  comm.together(
      [&]
      {
        if (exists)
          slice = readSliceOfFile(file, false, comm.rank(), comm.size()).slice;
        else
          names = partsOfMesh(file);
      });
  if (!exists)
    return readParts(file, names, comm);
  demandUniqueIds(file, slice, comm);
  return slice;
}

Mesh readMesh(const std::string& file)
{
  return readMesh(file, Comm::alone()).mine;
}
} // namespace coplane
