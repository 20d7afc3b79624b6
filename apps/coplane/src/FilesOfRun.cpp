#include "FilesOfRun.hpp"

#include <coplane_core/DraftName.hpp>
#include <coplane_core/FileRoles.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_core/OutputLocks.hpp>
#include <coplane_output/CheckpointObserver.hpp>
#include <coplane_output/Sha256.hpp>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sys/stat.h>

namespace coplane
{
namespace
{
std::string withoutExtension(const std::string& file)
{
  return std::filesystem::path(file).replace_extension().string();
}

/// One for each stem of the outputs: runs of other names may share the folder. Where a name is a
/// link, one beside the file that it leads to, too.
std::set<std::string> lockFiles(const Deck& deck)
{
  std::set<std::string> files, places;
  for (const std::string& output : {deck.history.file, deck.checkpoint.file, deck.output.results})
    if (!output.empty())
      for (const std::string& name : {output, placeOfFile(output)})
        if (const std::string file = withoutExtension(name) + ".lock";
            places.insert(placeOfFile(file)).second)
          files.insert(file);
  return files;
}

void addInputs(FileRoles& roles, const Deck& deck, const std::string& restartedFrom)
{
  roles.reads(deck.file, "the deck");
  std::error_code error;
  if (std::filesystem::exists(deck.mesh, error))
    roles.reads(deck.mesh, "the mesh (mesh)");
  else
  {
    roles.reads(deck.mesh, "the mesh (mesh)"); // beside its parts it would be taken for the mesh
    roles.readsSeries({deck.mesh + ".", ".", ""}, "a part of the mesh (mesh)");
  }
  if (restartedFrom.empty())
    return;
  // The run goes on in its own checkpoints, and never overwrites the one that it came from first.
  for (const char* slot : {".0", ".1"})
    if (std::filesystem::equivalent(restartedFrom, deck.checkpoint.file + slot, error))
      return;
  roles.reads(restartedFrom, "the checkpoint (--restart)");
}

/// Files that a run writes, each with its draft.
class Outputs
{
public:
  explicit Outputs(FileRoles& roles) : roles_(roles) {}

  /// A file that is written beside its name and takes the place of an older one.
  void replaces(const std::string& file, const std::string& what)
  {
    roles_.writes(file, what);
    draft({placeOfFile(file)}, what);
  }
  /// Many of those, with numbers between the pieces of their names.
  void replacesSeries(const std::vector<std::string>& pieces, const std::string& what)
  {
    roles_.writesSeries(pieces, what);
    draft(pieces, what);
  }
  /// A file that grows in its place.
  void grows(const std::string& file, const std::string& what)
  {
    roles_.writesInPlace(file, what);
    draft({placeOfFile(file)}, what);
  }

private:
  void draft(std::vector<std::string> pieces, const std::string& what)
  {
    pieces.back() = draftOf(pieces.back());
    roles_.writesDraft(pieces, what);
  }

  FileRoles& roles_;
};

void addHistory(Outputs& outputs, const Deck& deck)
{
  const std::string record = "the record of the run", tables = "a table (history.tables)";
  outputs.grows(deck.history.file, "the history (history.file)");
  outputs.replaces(recordFile(deck, 1), record);
  const std::string base = withoutExtension(deck.history.file);
  outputs.replacesSeries({base + ".run-s", ".json"}, record);
  for (const std::string& table : deck.history.tables)
    outputs.grows(fmt::format("{}_{}.csv", base, table), tables + " " + table);
}

void addResults(Outputs& outputs, const Deck& deck)
{
  const std::string results = "the results (output.results)", planes = "the planes (output.planes)";
  const std::string& file = deck.output.results;
  // Parts of a file per rank, which an earlier run may have left, are removed in any case.
  outputs.replacesSeries({file + "-s", ".", ".", ""}, results);
  if (deck.output.filePerRank)
    outputs.replacesSeries({file + ".", ".", ""}, results);
  else
  {
    outputs.grows(file, results); // at a restart: steps later than the checkpoint go
    outputs.replacesSeries({file + "-s", ""}, results);
  }
  if (deck.output.fragments)
    outputs.grows(fragmentsFile(deck), "the fragments (output.fragments)");
  if (deck.output.lines)
  {
    const std::string lines = "the lines (output.lines)", ofLines = planesBase(deck) + "_lines";
    outputs.replaces(ofLines + ".pvd", lines);
    outputs.replacesSeries({ofLines + "_", ".vtp"}, lines);
  }
  if (!deck.output.planes || !deck.contact.enabled)
    return;
  const std::string series = planesBase(deck) + "_planes";
  if (deck.output.planesFormat == "vtkhdf")
    for (const char* extension : {".vtkhdf", ".xmf3"})
      outputs.replaces(series + extension, planes);
  else
  {
    outputs.replaces(series + ".pvd", planes);
    outputs.replacesSeries({series + "_", ".vtp"}, planes);
  }
}

void addOutputs(FileRoles& roles, const Deck& deck)
{
  Outputs outputs(roles);
  addHistory(outputs, deck);
  if (!deck.output.results.empty())
    addResults(outputs, deck);
  for (const char* slot : {".0", ".1"})
    outputs.replaces(deck.checkpoint.file + slot, "the checkpoint (checkpoint.file)");
  for (const std::string& file : lockFiles(deck))
    roles.writes(file, "the lock of the run");
  roles.writes(stopFile(deck), "the stop file, which is removed (checkpoint.file)");
}

/// Rank 0 alone looks at files; what it finds wrong is an error of all ranks. Collective.
template <class Action>
void onRoot(const Comm& comm, const Action& action)
{
  comm.together(
      [&]
      {
        if (comm.isRoot())
          action();
      });
}
} // namespace

std::string recordFile(const Deck& deck, int part)
{
  const std::string base = withoutExtension(deck.history.file);
  return part == 1 ? base + ".run.json" : fmt::format("{}.run-s{:04}.json", base, part);
}

std::string planesBase(const Deck& deck)
{
  return withoutExtension(deck.output.results);
}

std::string fragmentsFile(const Deck& deck)
{
  return planesBase(deck) + "_fragments.csv";
}

std::string tablesBase(const Deck& deck)
{
  return withoutExtension(deck.history.file);
}

std::string stopFile(const Deck& deck)
{
  return withoutExtension(deck.checkpoint.file) + ".stop";
}

void demandSameFiles(const Deck& deck, const Comm& comm)
{
  std::error_code error;
  struct stat file
  {
  };
  // One folder may have several names on several machines.
  const std::string here = std::filesystem::current_path(error).string();
  const std::string inode = std::to_string(::stat(".", &file) == 0 ? file.st_ino : 0);
  const std::string first = comm.broadcast(here), firstInode = comm.broadcast(inode);
  const bool other = here != first && inode != firstInode;
  if (comm.max(std::int64_t(other && !here.empty() && !first.empty())) > 0)
    comm.demandSame("the working folder", here, ExitCode::Usage);
  const auto bytes = std::filesystem::file_size(deck.mesh, error);
  comm.demandSame("the mesh " + deck.mesh, error ? "not there" : fmt::format("{} bytes", bytes),
                  ExitCode::Mesh);
  const std::string identity =
      ::stat(deck.mesh.c_str(), &file) == 0
          ? fmt::format("{} {} {}", file.st_ino, file.st_mtim.tv_sec, file.st_mtim.tv_nsec)
          : "";
  if (comm.max(std::int64_t(identity != comm.broadcast(identity))) > 0)
    comm.demandSame("the mesh " + deck.mesh, "SHA-256 " + sha256OfFile(deck.mesh), ExitCode::Mesh);
}

std::vector<FileLock> lockOutputs(const Deck& deck, const Comm& comm)
{
  std::vector<FileLock> locks;
  onRoot(comm,
         [&]
         {
           FileRoles roles;
           addOutputs(roles, deck);
           locks = lockOutputs(roles, lockFiles(deck), deck.file);
           removeDraftsOfKilled(roles, locks);
         });
  return locks;
}

void removeOldStopFile(const Deck& deck, const Comm& comm)
{
  onRoot(comm,
         [&]
         {
           std::error_code error;
           const bool wasThere = takeStopFile(stopFile(deck));
           if (std::filesystem::exists(std::filesystem::symlink_status(stopFile(deck), error)))
             fail(ExitCode::Output,
                  "{}: the stop file of an earlier run cannot be removed, and would end this one. "
                  "Remove it, or give the checkpoints another name (checkpoint.file).",
                  stopFile(deck));
           if (wasThere)
             logInfo(
                 "{} was there before the start: it does not end this run, and is out of the way",
                 stopFile(deck));
         });
}

void demandWritableFiles(const Deck& deck, const Comm& comm)
{
  onRoot(comm,
         [&]
         {
           FileRoles roles;
           addOutputs(roles, deck);
           const std::vector<std::string> hindrances = roles.hindrances();
           if (!hindrances.empty())
             fail(ExitCode::Output, "{}", fmt::join(hindrances, "\n"));
         });
}

void demandDistinctFiles(const Deck& deck, const std::string& restartedFrom, const Comm& comm)
{
  onRoot(comm,
         [&]
         {
           FileRoles roles;
           addInputs(roles, deck, restartedFrom);
           addOutputs(roles, deck);
           const std::vector<std::string> problems = roles.problems();
           if (!problems.empty())
             fail(ExitCode::Deck, "{}: {}", deck.file, fmt::join(problems, "\n"));
         });
}
} // namespace coplane
