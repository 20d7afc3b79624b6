#include <coplane_core/DraftName.hpp>
#include <coplane_core/FileRoles.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_core/Version.hpp>
#include <coplane_exodus/NetcdfHeader.hpp>
#include <coplane_exodus/Provenance.hpp>
#include <coplane_exodus/ResultsFile.hpp>
#include <coplane_exodus/detail/MeshDefinition.hpp>
#include <coplane_exodus/detail/OwnPart.hpp>

#include <exodusII.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>

namespace coplane
{
namespace
{
std::array<std::string, 4> ownQaRecord(const Comm& comm)
{
  const std::time_t now = std::time(nullptr);
  char date[32], hour[32];
  std::strftime(date, sizeof date, "%Y/%m/%d", std::localtime(&now));
  std::strftime(hour, sizeof hour, "%H:%M:%S", std::localtime(&now));
  // Rank 0's clock: all ranks must write the same record.
  return {programOfResults, version().number, comm.broadcast(date), comm.broadcast(hour)};
}

void renameFile(const std::string& from, const std::string& to)
{
  if (std::rename(from.c_str(), to.c_str()) != 0)
    throw ExodusFailure(fmt::format("renaming the draft: {}", std::strerror(errno)));
}

/// A plain open tells a missing folder or permission in the system's words, before any library call
/// that all ranks must make.
void probeWritable(const std::string& file)
{
  const std::string draft = draftOf(placeOfFile(file));
  std::FILE* probe = std::fopen(draft.c_str(), "wb");
  if (!probe)
    fail(ExitCode::Output,
         "{}: the results file cannot be created: {}. Check that the folder '{}' exists and can be "
         "written to.",
         file, std::strerror(errno), folderOf(file));
  std::fclose(probe);
  std::remove(draft.c_str());
}

} // namespace

void cutResults(const std::string& file, int steps)
{
  unsigned char bytes[12] = {};
  std::FILE* header = std::fopen(file.c_str(), "rb");
  if (!header && errno == ENOENT)
    return;
  if (!header)
    failToWrite(file);
  const bool read = std::fread(bytes, 1, sizeof bytes, header) == sizeof bytes;
  std::fclose(header);
  if (!read || std::memcmp(bytes, "CDF\5", 4) != 0)
    return;
  std::uint64_t there = 0;
  for (int i = 0; i < 8; ++i)
    there = there << 8 | bytes[4 + i];
  if (there <= std::uint64_t(steps))
    return;
  breakHardLinks(placeOfFile(file));
  try
  {
    SharedFile data(file);
    data.setSteps(steps);
    data.close();
  }
  catch (const ExodusFailure& failure)
  {
    fail(ExitCode::Output,
         "{}: steps later than the checkpoint cannot be taken out of the results: {}. Check that "
         "the file can be written to, or move it away.",
         file, failure.what());
  }
}

std::string resultsFileOfRank(const std::string& file, int rank, int ranks)
{
  const std::string count = std::to_string(ranks);
  return fmt::format("{}.{}.{:0{}}", file, count, rank, count.size());
}

ResultsFile::ResultsFile(const std::string& file, const Comm& comm, const MeshSlice& mesh,
                         const ResultsVariables& variables,
                         const std::vector<std::string>& infoLines, bool filePerRank)
    : file_(file), comm_(comm), filePerRank_(filePerRank), nodeCount_(mesh.nodes)
{
  quietExodus();
  // Going beyond a file-size limit shall be an error of the call, like a full disk, not the death
  // of the program.
  std::signal(SIGXFSZ, SIG_IGN);
  for (std::size_t b = 0; b < mesh.mine.blocks.size(); ++b)
  {
    blockSizes_.push_back(mesh.elementsOf(int(b)));
  }
  for (std::size_t s = 0; s < mesh.mine.sideSets.size(); ++s)
  {
    const int sides = mesh.sideSetSizes[s];
    const IndexRange mine = mesh.rangeOf(sides);
    std::vector<int> positions(mine.count);
    std::iota(positions.begin(), positions.end(), mine.first);
    mySides_.push_back(std::move(positions));
  }
  if (filePerRank_)
    file_ = resultsFileOfRank(file, comm_.rank(), comm_.size());
  comm_.together(
      [&]
      {
        if (filePerRank_ || comm_.isRoot())
          probeWritable(file_);
      });
  MeshSlice part = filePerRank_ ? meshOfThisRank(mesh) : mesh;
  part.mine.qaRecords.push_back(ownQaRecord(comm_));
  create(part, variables, infoLines);
}

void ResultsFile::create(const MeshSlice& slice, const ResultsVariables& variables,
                         const std::vector<std::string>& infoLines)
{
  const FileExtras extras{variables.nodal, variables.element, variables.global, variables.side,
                          splitInfoLines(infoLines)};
  const GlobalId largest = comm_.max(std::int64_t(largestId(slice)));
  const bool defines = filePerRank_ || comm_.isRoot();
  // Whatever is at this place stays there until all of the header is written; links stay links.
  if (defines)
  {
    const std::string place = placeOfFile(file_), draft = draftOf(place);
    attempt([&] { defineFile(draft, slice, extras, creationMode(largest)); });
    attempt([&] { renameFile(draft, place); });
    if (!failure_.empty())
      std::remove(draft.c_str());
  }
  failTogether("defining the mesh");
  attempt([&] { data_.emplace(file_); });
  if (defines)
    attempt([&] { data_->reserveMesh(); });
  failTogether("opening the file");
  attempt([&] { writeMeshRanges(*data_, slice); });
  failTogether("writing the mesh");
  attempt([&] { data_->sync(); });
  failTogether("writing the mesh");
}

template <class Action>
void ResultsFile::attempt(const Action& action)
{
  if (!failure_.empty())
    return;
  try
  {
    action();
  }
  catch (const ExodusFailure& failure)
  {
    failure_ = failure.what();
  }
}

void ResultsFile::failTogether(const std::string& doing)
{
  const int failed = int(comm_.min(std::int64_t(failure_.empty() ? comm_.size() : comm_.rank())));
  if (failed == comm_.size())
    return;
  const std::string reason = comm_.broadcast(failure_, failed);
  const std::string file = comm_.broadcast(file_, failed);
  abandon();
  failOnAllRanks(
      ExitCode::Output,
      "{}: {} failed on rank {}: {}.{} Make room (disk, quota, file-size limit){}, or write fewer "
      "variables or steps.",
      file, doing, failed, reason,
      steps_ > 0 ? fmt::format(" The file keeps {} finished time steps.", steps_) : "",
      steps_ > 0 ? " and restart" : "");
}

void ResultsFile::abandon()
{
  // The header may count the step whose writing failed in the end.
  try
  {
    if (data_ && (filePerRank_ || comm_.isRoot()))
      data_->setSteps(steps_);
  }
  catch (const ExodusFailure&)
  {
    // The first failure is the one to tell of.
  }
  data_.reset();
}

void ResultsFile::beginStep(Real time)
{
  if (steps_ > 0)
    warnIfCutOff(steps_ - 1);
  time_ = time;
  if (filePerRank_ || comm_.isRoot())
  {
    attempt([&] { data_->reserveStep(steps_); });
    attempt([&] { data_->put("time_whole", 0, std::vector<Real>{time}, steps_); });
  }
  failTogether(fmt::format("writing the step at t = {:.6g} s", time_));
}

void ResultsFile::warnIfCutOff(int step)
{
  const bool isCut = (filePerRank_ || comm_.isRoot()) && data_->isCutOff(step, time_);
  const int rank = int(comm_.min(std::int64_t(isCut ? comm_.rank() : comm_.size())));
  if (rank < comm_.size())
    logWarning("results are cut off",
               fmt::format("{}: somebody cut off the file while the run writes it: values of the "
                           "steps up to t = {:.6g} s are lost.",
                           comm_.broadcast(file_, rank), time_));
}

void ResultsFile::putNodal(int variable, const std::vector<Real>& myRange)
{
  const std::vector<Real> values = filePerRank_ ? nodesOfPart_->values(myRange) : myRange;
  const int first = filePerRank_ ? 0 : myNodes().first;
  put(fmt::format("vals_nod_var{}", variable + 1), first, values);
}

void ResultsFile::putElement(int variable, int block, const std::vector<Real>& myRangeOfThatBlock)
{
  const int first = filePerRank_ ? 0 : myElements(block).first;
  put(fmt::format("vals_elem_var{}eb{}", variable + 1, block + 1), first, myRangeOfThatBlock);
}

void ResultsFile::putSide(int variable, int set, const std::vector<Real>& values)
{
  const std::vector<int>& mine = mySides_[set];
  const int first = filePerRank_ || mine.empty() ? 0 : mine.front();
  put(fmt::format("vals_sset_var{}ss{}", variable + 1, set + 1), first, values);
}

void ResultsFile::putGlobals(const std::vector<Real>& values)
{
  if (filePerRank_ || comm_.isRoot())
    put("vals_glo_var", 0, values);
}

void ResultsFile::put(const std::string& variable, int first, const std::vector<Real>& values)
{
  if (!values.empty())
    attempt([&] { data_->put(variable, std::uint64_t(first), values, steps_); });
}

void ResultsFile::endStep()
{
  const std::string doing = fmt::format("writing the step at t = {:.6g} s", time_);
  attempt([&] { data_->sync(); });
  failTogether(doing);
  if (filePerRank_ || comm_.isRoot())
    attempt([&] { data_->setSteps(steps_ + 1); });
  failTogether(doing);
  warnIfCutOff(steps_);
  ++steps_;
  const bool isGone = (filePerRank_ || comm_.isRoot()) && data_->isGone();
  if (const int rank = int(comm_.min(std::int64_t(isGone ? comm_.rank() : comm_.size())));
      rank < comm_.size())
    logWarning(
        "results are gone",
        fmt::format("{}: somebody removed the file while the run writes it: its {} steps are "
                    "lost when the run ends. To keep those that follow, stop the run with a "
                    "checkpoint and restart it.",
                    comm_.broadcast(file_, rank), steps_));
}

void ResultsFile::close()
{
  if (!data_)
    return;
  attempt([&] { data_->sync(); });
  attempt([&] { data_->close(); });
  failTogether("closing the file");
  data_.reset();
}

MeshSlice ResultsFile::meshOfThisRank(const MeshSlice& slice)
{
  OwnPart own = ownPartOf(slice, comm_);
  nodesOfPart_ = std::move(own.nodes);
  mySides_ = std::move(own.sides);
  return sliceOf(own.mesh);
}
} // namespace coplane
