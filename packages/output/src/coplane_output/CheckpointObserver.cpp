#include <coplane_checkpoint/CheckpointWriter.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_core/Text.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/Signals.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_output/CheckpointObserver.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <limits>
#include <sys/stat.h>
#include <tuple>
#include <unistd.h>

namespace coplane
{
namespace
{
constexpr double lookEvery = 0.5; ///< for the stop file [s]

std::string slotFile(const std::string& file, int slot)
{
  return fmt::format("{}.{}", file, slot);
}

/// Checkpoints that were put aside, the latest last.
std::vector<std::string> oldCheckpoints(const std::string& file)
{
  const std::filesystem::path path(file);
  const std::string stem = path.filename().string();
  std::vector<std::tuple<std::string, std::int64_t, std::string>> olds; // time, cycle, name
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(
           path.has_parent_path() ? path.parent_path() : std::filesystem::path("."), error))
  {
    const std::string name = entry.path().filename().string();
    CheckpointHead head;
    for (const char* end : {".0.old-", ".1.old-"})
      if (name.rfind(stem + end, 0) == 0 &&
          inspectCheckpoint((path.parent_path() / name).string(), head).empty())
        olds.emplace_back(name.substr(stem.size() + 7, 15), head.cycle,
                          (path.parent_path() / name).string());
  }
  std::sort(olds.begin(), olds.end());
  std::vector<std::string> names;
  for (const auto& [time, cycle, name] : olds)
    names.push_back(name);
  return names;
}

double secondsSince(std::chrono::steady_clock::time_point begin)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}
} // namespace

bool takeStopFile(const std::string& file)
{
  struct stat status
  {
  };
  if (::lstat(file.c_str(), &status) != 0)
    return false;
  // What somebody has written into it is not ours to throw away.
  const bool isEmpty = !S_ISREG(status.st_mode) || status.st_size == 0;
  const std::string aside = isEmpty ? "" : nameAside(file);
  if ((isEmpty ? ::unlink(file.c_str()) : std::rename(file.c_str(), aside.c_str())) != 0)
    logWarning("stop file", fmt::format("{}: the stop file cannot be removed: {}. Remove it before "
                                        "the next run.",
                                        file, std::strerror(errno)));
  else if (!isEmpty)
    logWarningEachTime(
        fmt::format("{}: the stop file is not empty; it is kept under the name {}.", file, aside));
  return true;
}

CheckpointObserver::CheckpointObserver(const Comm& comm, CheckpointOptions options,
                                       const Observer& outputs)
    : comm_(&comm), options_(std::move(options)), outputs_(&outputs), last_(WallClock::now()),
      looked_(last_)
{
  std::int64_t slot = 0;
  if (comm.isRoot())
  {
    // The older one, or one that is no use, goes first; never that of the restart.
    std::int64_t cycles[2];
    for (int s = 0; s < 2; ++s)
    {
      const std::string file = slotFile(options_.file, s);
      slots_.emplace_back(placeOfFile(file), ReplacedFile::Edits::DoNot);
      slots_.back().remember();
      CheckpointHead head;
      cycles[s] = inspectCheckpoint(file, head).empty() ? head.cycle : -1;
      std::error_code error;
      if (std::filesystem::equivalent(file, options_.restartedFrom, error))
        cycles[s] = std::numeric_limits<std::int64_t>::max();
    }
    slot = cycles[1] < cycles[0];
  }
  slot_ = int(comm.max(slot));
}

void CheckpointObserver::start(const Solver& solver)
{
  lastCycle_ = solver.clock().cycle;
  last_ = WallClock::now();
}

void CheckpointObserver::endOfCycle(const Solver& solver)
{
  askByClockAndFile();
  const std::int64_t cycle = solver.clock().cycle;
  if (solver.checkpointRequested() && solver.stopRequested())
  {
    write(solver);
    return;
  }
  if (!solver.checkpointRequested() &&
      !(options_.everyCycles > 0 && cycle % options_.everyCycles == 0))
    return;
  try
  {
    write(solver);
  }
  catch (const Error& error)
  {
    // The run is worth more than this checkpoint; those from before are still there.
    if (error.code() != ExitCode::Output || !error.onAllRanks())
      throw;
    logWarning("a checkpoint was not written", error.what());
  }
}

void CheckpointObserver::finish(const Solver& solver, const Ending& ending)
{
  if (options_.atEnd && ending.how == "completed" && solver.clock().cycle != lastCycle_)
    write(solver);
}

void CheckpointObserver::askByClockAndFile()
{
  // Rank 0's clock; all ranks hear of it at the end of the next cycle.
  if (!comm_->isRoot())
    return;
  if (options_.everySeconds > 0 && secondsSince(last_) >= options_.everySeconds)
  {
    last_ = WallClock::now();
    request({false, true, false});
  }
  if (options_.maxWall && secondsSince(options_.begin) >= *options_.maxWall)
    request({false, true, true});
  if (options_.stopFile.empty() || secondsSince(looked_) < lookEvery)
    return;
  looked_ = WallClock::now();
  if (takeStopFile(options_.stopFile))
    request({false, true, true});
}

void CheckpointObserver::write(const Solver& solver)
{
  TimedRegion region("coplane::output::checkpoint");
  CheckpointWriter out(*comm_);
  solver.save(out);
  std::map<std::string, std::string> positions = options_.positions;
  comm_->together([&] { outputs_->savePosition(positions); });
  // Names of files may have any bytes, and have to come back as they are: JSON keeps them as
  // Latin-1.
  for (auto& [output, position] : positions)
    position = latin1AsUtf8(position);
  out.text("outputs", comm_->broadcast(nlohmann::json(positions).dump()));
  for (const auto& [name, text] : options_.texts)
    out.text(name, text);
  const std::string file = slotFile(options_.file, slot_);
  ReplacedFile* const place = comm_->isRoot() ? &slots_[std::size_t(slot_)] : nullptr;
  out.write(comm_->broadcast(place ? place->file() : file), solver.clock().cycle,
            solver.clock().time, place);
  slot_ = 1 - slot_;
  lastCycle_ = solver.clock().cycle;
  last_ = WallClock::now();
  logInfo("checkpoint {} at cycle {}, t = {:.5e} s", file, solver.clock().cycle,
          solver.clock().time);
}

std::string newestCheckpoint(const std::string& file, const Comm& comm)
{
  std::vector<std::pair<std::int64_t, int>> order; // cycle, slot
  std::string problems;
  for (int s = 0; s < 2; ++s)
  {
    CheckpointHead head;
    const std::string problem = verifyCheckpoint(slotFile(file, s), comm, head);
    if (problem.empty())
      order.emplace_back(head.cycle, s);
    else
      problems += fmt::format("{}{}: {}.", problems.empty() ? "" : " ", slotFile(file, s), problem);
  }
  if (order.empty())
  {
    const std::vector<std::string> olds = oldCheckpoints(file);
    const std::string also =
        olds.empty() ? "" : fmt::format(" Of earlier runs there are {}.", fmt::join(olds, ", "));
    failOnAllRanks(
        ExitCode::Checkpoint,
        "--restart: there is no checkpoint to restart from. {}{} Name one with --restart "
        "FILE, or start without --restart.",
        problems, also);
  }
  if (!problems.empty() && problems.find("No such file") == std::string::npos)
    logWarning("a checkpoint is not used", problems);
  return slotFile(file, std::max_element(order.begin(), order.end())->second);
}

bool isOneOfTwo(const std::string& file, const std::string& checkpoint, const Comm& comm)
{
  std::error_code error;
  std::int64_t isOne = 0;
  if (comm.isRoot())
    for (int s = 0; s < 2; ++s)
      isOne |= std::int64_t(std::filesystem::equivalent(slotFile(file, s), checkpoint, error));
  return comm.max(isOne) > 0;
}

void putAside(const std::string& file, const Comm& comm)
{
  comm.together(
      [&]
      {
        if (!comm.isRoot())
          return;
        std::error_code error;
        bool some = false;
        for (int s = 0; s < 2; ++s)
        {
          const std::string name = slotFile(file, s);
          if (!std::filesystem::exists(std::filesystem::symlink_status(name, error)))
            continue;
          const std::string aside = nameAside(name);
          CheckpointHead head;
          const bool isCheckpoint = inspectCheckpoint(name, head).empty();
          std::filesystem::rename(name, aside, error);
          if (error)
            fail(ExitCode::Output,
                 "{}: this file, of an earlier run or of somebody else, has the name of a "
                 "checkpoint and cannot be put aside as {}: {}. Go on from it with --restart, or "
                 "move it away.",
                 name, aside, error.message());
          if (isCheckpoint)
            logInfo("{}: there was a checkpoint of an earlier run; it is kept under the name {}",
                    name, aside);
          else
            logWarningEachTime(
                fmt::format("{}: there was already a file of this name, which is not a "
                            "checkpoint; it is kept under the name {}.",
                            name, aside));
          some = true;
        }
        const std::vector<std::string> olds = oldCheckpoints(file);
        if (!some || olds.empty())
          return;
        std::uintmax_t bytes = 0;
        std::vector<std::string> inShell;
        for (const std::string& old : olds)
          inShell.push_back(shellWord(old));
        for (const std::string& old : olds)
          if (const auto size = std::filesystem::file_size(old, error); !error)
            bytes += size;
        logInfo("{} checkpoints of earlier runs take {:.1f} MB. To go on from one: --restart {}; "
                "when none is wanted any more: rm {}",
                olds.size(), double(bytes) / 1e6, inShell.back(), fmt::join(inShell, " "));
      });
}

void putOtherAside(const std::string& file, const std::string& restartedFrom, const Comm& comm,
                   const std::function<bool(const CheckpointReader&)>& isOwn)
{
  for (int s = 0; s < 2; ++s)
  {
    const std::string name = slotFile(file, s);
    std::error_code error;
    std::int64_t isOther = 0;
    if (comm.isRoot())
      isOther = wouldBeLost(name) && !std::filesystem::equivalent(name, restartedFrom, error);
    if (comm.max(isOther) == 0)
      continue;
    CheckpointHead head;
    if (verifyCheckpoint(name, comm, head).empty() && isOwn(CheckpointReader(name, comm)))
      continue;
    comm.together(
        [&]
        {
          if (comm.isRoot())
            putForeignFileAside(name);
        });
  }
}

std::map<std::string, std::string> positionsIn(const CheckpointReader& checkpoint)
{
  auto positions =
      nlohmann::json::parse(checkpoint.text("outputs")).get<std::map<std::string, std::string>>();
  for (auto& [output, position] : positions)
    position = utf8AsLatin1(position);
  return positions;
}
} // namespace coplane
