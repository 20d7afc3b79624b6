#include <coplane_core/Error.hpp>
#include <coplane_core/FileRoles.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_exodus/NetcdfHeader.hpp>
#include <coplane_exodus/detail/FileProbe.hpp>

#include <cctype>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <set>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace coplane
{
namespace
{
constexpr double longestLook = 60; // s

/// The process, or -1. No fork: MPI does not stand that.
pid_t start(std::vector<std::string>& command)
{
  std::vector<char*> arguments;
  for (std::string& argument : command)
    arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&files, descriptor, "/dev/null", O_RDWR, 0);
  pid_t process = -1;
  if (::posix_spawn(&process, arguments[0], &files, nullptr, arguments.data(), environ) != 0)
    process = -1;
  posix_spawn_file_actions_destroy(&files);
  return process;
}

/// The library does not come back from some damaged HDF5 files, and frees what it has not allocated
/// in others: a program that nobody misses looks into them first.
void demandThatItIsSurvived(const std::string& file)
{
  std::error_code noProc;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", noProc);
  const std::string prober = program.parent_path() / "coplane_mesh";
  switch (noProc ? ProgramEnd::Unknown : runProgram({prober, "probe", file}, longestLook))
  {
  case ProgramEnd::Success:
    return;
  case ProgramEnd::Unknown:
    logWarning("mesh not probed",
               fmt::format("{}: this HDF5 file is read without having been probed: {} could not be "
                           "run, or its exit status was not reported. If this program crashes or "
                           "hangs now, the file is damaged.",
                           file, prober));
    return;
  case ProgramEnd::Failure:
    fail(ExitCode::Mesh,
         "{}: the file is damaged: the HDF5 library fails in it. Write the mesh again.", file);
  case ProgramEnd::TooLong:
    fail(ExitCode::Mesh,
         "{}: looking into the file takes more than a minute. It is damaged, or the disk does not "
         "answer; write the mesh again.",
         file);
  }
}
} // namespace

ProgramEnd runProgram(std::vector<std::string> command, double seconds)
{
  const pid_t process = start(command);
  if (process < 0)
    return ProgramEnd::Unknown;
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  for (bool killed = false;;)
  {
    int status = 0;
    const pid_t ended = ::waitpid(process, &status, killed ? 0 : WNOHANG);
    if (ended < 0 && errno != EINTR)
      return ProgramEnd::Unknown; // whoever started us takes no notice of children
    if (ended == process && killed)
      return ProgramEnd::TooLong;
    if (ended == process && WIFEXITED(status) && WEXITSTATUS(status) == 127)
      return ProgramEnd::Unknown;
    if (ended == process)
      return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? ProgramEnd::Success
                                                           : ProgramEnd::Failure;
    if (!killed && std::chrono::duration<double>(Clock::now() - begin).count() > seconds)
    {
      ::kill(process, SIGKILL);
      killed = true;
    }
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

namespace
{
/// What to do with a file of another kind, by the ending of its name.
std::string wayToExodus(const std::string& file)
{
  const std::filesystem::path path(file);
  std::string ending = path.extension().string();
  for (char& c : ending)
    c = char(std::tolower(static_cast<unsigned char>(c)));
  const std::string mesh = std::filesystem::path(file).replace_extension(".e").string();
  const auto is = [&](const std::set<std::string>& endings) { return endings.count(ending) > 0; };
  if (is({".msh"}))
    return fmt::format("It seems to come from Gmsh: coplane_mesh convert {} --output {}", file,
                       mesh);
  if (is({".inp"}))
    return fmt::format("It seems to come from Abaqus or CalculiX: coplane_mesh convert {} --output "
                       "{}",
                       file, mesh);
  if (is({".yaml", ".yml"}))
    return fmt::format("A recipe becomes a mesh with coplane_mesh make {} --output {}", file, mesh);
  if (is({".geo"}))
    return fmt::format(
        "Mesh it with Gmsh in format 4.1 (gmsh -3 -format msh41), then: coplane_mesh "
        "convert {} --output {}",
        std::filesystem::path(file).replace_extension(".msh").string(), mesh);
  if (is({".stl", ".step", ".stp", ".iges", ".igs", ".obj", ".brep"}))
    return "It describes surfaces, not elements: coplane_mesh blocks cuts and meshes what STL, OBJ "
           "and PLY enclose; or mesh it in Gmsh, for example, and save that as .msh 4.1 for "
           "coplane_mesh convert, or as Exodus II";
  if (is({".k", ".key", ".bdf", ".nas", ".cdb", ".unv", ".med", ".vtk", ".vtu", ".f3grid"}))
    return "Coplane does not read this kind: save the mesh as Exodus II in the program that made "
           "it, "
           "or as .msh 4.1 of Gmsh for coplane_mesh convert";
  return "Write the mesh with coplane_mesh make, or export Exodus II from your mesh generator";
}
} // namespace

void refuseMeshFile(const std::string& file)
{
  fail(ExitCode::Mesh,
       "{}: the file is not an Exodus II file (netCDF classic, 64-bit or netCDF-4), or it is "
       "damaged. {}.",
       file, wayToExodus(file));
}

void demandMeshFile(const std::string& file)
{
  if (const std::string kind = kindOfSpecialFile(file); !kind.empty())
    fail(ExitCode::Mesh, "{}: this is {}; name an Exodus II file.", file, kind);
  std::ifstream in(file, std::ios::binary);
  if (!in)
    fail(ExitCode::Mesh, "{}: the mesh file cannot be opened for reading. Check its permissions.",
         file);
  // The library prints about files of other kinds.
  char magic[4] = {};
  in.read(magic, 4);
  const bool isHdf5 = std::string(magic, 4) == "\x89HDF";
  if ((!isHdf5 && std::string(magic, 3) != "CDF") || !classicHeaderFitsFile(file))
    refuseMeshFile(file);
  if (isHdf5)
    demandThatItIsSurvived(file);
}
} // namespace coplane
