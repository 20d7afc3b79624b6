#include <coplane_core/Version.hpp>
#include <coplane_exodus/MeshDefinition.hpp>
#include <coplane_exodus/OwnPart.hpp>
#include <coplane_exodus/ResultsFile.hpp>

#include <exodusII.h>
#include <netcdf.h>
#include <netcdf_par.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <filesystem>
#include <numeric>
#include <unistd.h>

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
  return {"coplane", version().number, comm.broadcast(date), comm.broadcast(hour)};
}

/// A plain open tells a missing folder or permission in the system's words, before any library call
/// that all ranks must make.
void probeWritable(const std::string& file)
{
  std::FILE* probe = std::fopen(file.c_str(), "wb");
  if (!probe)
    fail(ExitCode::Output,
         "{}: the results file cannot be created: {}. Check that the folder '{}' exists and can be "
         "written to.",
         file, std::strerror(errno), std::filesystem::absolute(file).parent_path().string());
  std::fclose(probe);
}

/// Claims room on the disk for `bytes` of the file from `first` on. MPI-IO may lose the error of a
/// write (Open MPI 4.1 prints "File too large" and reports success), so a full disk must be found
/// before writing.
void reserve(const std::string& file, std::uint64_t first, std::uint64_t bytes)
{
  const int descriptor = ::open(file.c_str(), O_RDWR);
  if (descriptor < 0)
    throw ExodusFailure(std::strerror(errno));
  const int error = ::posix_fallocate(descriptor, off_t(first), off_t(bytes));
  ::close(descriptor);
  // A file system that cannot reserve answers EINVAL or EOPNOTSUPP; there the write itself has to
  // tell.
  if (error != 0 && error != EINVAL && error != EOPNOTSUPP)
    throw ExodusFailure(fmt::format("reserving {} bytes: {}", bytes, std::strerror(error)));
}

/// Sets the number of steps in the header of a CDF-5 file: 8 bytes, big-endian, after the 4 of the
/// magic number.
void setStepCount(const std::string& file, int steps)
{
  std::FILE* header = std::fopen(file.c_str(), "r+b");
  if (!header)
    return;
  unsigned char bytes[8];
  for (int i = 0; i < 8; ++i)
    bytes[i] = static_cast<unsigned char>(std::uint64_t(steps) >> (8 * (7 - i)));
  std::fseek(header, 4, SEEK_SET);
  std::fwrite(bytes, 1, sizeof bytes, header);
  std::fclose(header);
}
} // namespace

void cutResults(const std::string& file, int steps)
{
  unsigned char bytes[12] = {};
  std::FILE* header = std::fopen(file.c_str(), "rb");
  if (!header)
    return;
  const bool read = std::fread(bytes, 1, sizeof bytes, header) == sizeof bytes;
  std::fclose(header);
  if (!read || std::memcmp(bytes, "CDF\5", 4) != 0)
    return;
  std::uint64_t there = 0;
  for (int i = 0; i < 8; ++i)
    there = there << 8 | bytes[4 + i];
  if (there > std::uint64_t(steps))
    setStepCount(file, steps);
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
    blockIds_.push_back(mesh.mine.blocks[b].id);
  }
  stepBytes_ = sizeof(Real) *
               (1 + variables.global.size() + variables.nodal.size() * std::uint64_t(mesh.nodes) +
                variables.element.size() * std::uint64_t(mesh.elements()));
  for (std::size_t s = 0; s < mesh.mine.sideSets.size(); ++s)
  {
    const int sides = mesh.sideSetSizes[s];
    stepBytes_ += sizeof(Real) * variables.side.size() * std::uint64_t(sides);
    sideSetIds_.push_back(mesh.mine.sideSets[s].id);
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
  int memoryWord = 8, fileWord = 8;
  if (filePerRank_ || comm_.isRoot())
    attempt(
        [&]
        {
          exoid_ = ex_create(file_.c_str(), creationMode(largest), &memoryWord, &fileWord);
          checkExodus(exoid_, "creating the file");
          defineMesh(exoid_, slice, extras);
        });
  failTogether("defining the mesh");
  if (filePerRank_)
    attempt([&] { writeMeshRanges(exoid_, slice); });
  else
  {
    // Rank 0 defines the file, then all open it. (ex_create_par of Exodus 8.12 passes a flag that
    // netCDF 4.9 refuses for CDF-5.)
    if (comm_.isRoot())
    {
      const int closing = exoid_;
      exoid_ = -1;
      attempt(
          [&]
          {
            checkExodus(ex_close(closing), "creating the file");
            // Closing has extended the file to the end of what is not a time step.
            meshBytes_ = std::filesystem::file_size(file_);
            reserve(file_, 0, meshBytes_);
          });
    }
    failTogether("defining the mesh");
    attempt(
        [&]
        {
          float version = 0;
          exoid_ = ex_open_par(file_.c_str(), EX_WRITE | EX_ALL_INT64_API, &memoryWord, &fileWord,
                               &version, comm_.mpi(), MPI_INFO_NULL);
          checkExodus(exoid_, "opening the file on all ranks");
          // Data are written independently by every rank: PnetCDF then raises the number of steps
          // in the header only in the collective ex_update, after all data, and an error on one
          // rank leaves nobody waiting.
          if (nc_var_par_access(exoid_, 0, NC_INDEPENDENT) != NC_NOERR)
            throw ExodusFailure("opening the file on all ranks: independent access was refused");
        });
    failTogether("opening the file");
    attempt([&] { writeMeshRanges(exoid_, slice); });
  }
  failTogether("writing the mesh");
  attempt([&] { checkExodus(ex_update(exoid_), "writing the mesh"); });
  failTogether("writing the mesh");
}

ResultsFile::~ResultsFile()
{
  if (exoid_ >= 0)
    ex_close(exoid_);
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
      "{}: {} failed on rank {}: {}. The file keeps {} finished time steps. Make room (disk, "
      "quota, file-size limit) and restart, "
      "or write fewer variables or steps.",
      file, doing, failed, reason, steps_);
}

void ResultsFile::abandon()
{
  if (exoid_ >= 0)
    ex_close(exoid_);
  exoid_ = -1;
  // Closing may have counted the unfinished step.
  if (steps_ > 0 && (filePerRank_ || comm_.isRoot()))
    setStepCount(file_, steps_);
  comm_.barrier();
}

void ResultsFile::beginStep(Real time)
{
  time_ = time;
  if (!filePerRank_)
  {
    if (comm_.isRoot())
      attempt([&] { reserve(file_, meshBytes_ + std::uint64_t(steps_) * stepBytes_, stepBytes_); });
    failTogether(fmt::format("writing the step at t = {:.6g} s", time_));
  }
  if (filePerRank_ || comm_.isRoot())
    attempt([&] { checkExodus(ex_put_time(exoid_, steps_ + 1, &time), "time"); });
}

void ResultsFile::putNodal(int variable, const std::vector<Real>& myRange)
{
  const std::vector<Real> values = filePerRank_ ? nodesOfPart_->values(myRange) : myRange;
  const int first = filePerRank_ ? 0 : myNodes().first;
  if (!values.empty())
    attempt(
        [&]
        {
          checkExodus(ex_put_partial_var(exoid_, steps_ + 1, EX_NODAL, variable + 1, 1, first + 1,
                                         int64_t(values.size()), values.data()),
                      "nodal variable");
        });
}

void ResultsFile::putElement(int variable, int block, const std::vector<Real>& myRangeOfThatBlock)
{
  const int first = filePerRank_ ? 0 : myElements(block).first;
  if (!myRangeOfThatBlock.empty())
    attempt(
        [&]
        {
          checkExodus(ex_put_partial_var(
                          exoid_, steps_ + 1, EX_ELEM_BLOCK, variable + 1, blockIds_[block],
                          first + 1, int64_t(myRangeOfThatBlock.size()), myRangeOfThatBlock.data()),
                      "element variable");
        });
}

void ResultsFile::putSide(int variable, int set, const std::vector<Real>& values)
{
  const std::vector<int>& mine = mySides_[set];
  const int first = filePerRank_ || mine.empty() ? 0 : mine.front();
  if (!mine.empty())
    attempt(
        [&]
        {
          checkExodus(ex_put_partial_var(exoid_, steps_ + 1, EX_SIDE_SET, variable + 1,
                                         sideSetIds_[set], first + 1, int64_t(values.size()),
                                         values.data()),
                      "side set variable");
        });
}

void ResultsFile::putGlobals(const std::vector<Real>& values)
{
  if (!values.empty() && (filePerRank_ || comm_.isRoot()))
    attempt(
        [&]
        {
          checkExodus(ex_put_var(exoid_, steps_ + 1, EX_GLOBAL, 1, 0, int64_t(values.size()),
                                 values.data()),
                      "global variables");
        });
}

void ResultsFile::endStep()
{
  const std::string doing = fmt::format("writing the step at t = {:.6g} s", time_);
  failTogether(doing);
  attempt([&] { checkExodus(ex_update(exoid_), "time step"); });
  failTogether(doing);
  ++steps_;
}

void ResultsFile::close()
{
  if (exoid_ < 0)
    return;
  const int closing = exoid_;
  exoid_ = -1;
  attempt([&] { checkExodus(ex_close(closing), "closing"); });
  failTogether("closing the file");
}

MeshSlice ResultsFile::meshOfThisRank(const MeshSlice& slice)
{
  OwnPart own = ownPartOf(slice, comm_);
  nodesOfPart_ = std::move(own.nodes);
  mySides_ = std::move(own.sides);
  return sliceOf(own.mesh);
}
} // namespace coplane
