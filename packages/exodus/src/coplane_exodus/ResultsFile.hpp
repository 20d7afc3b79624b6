#pragma once

#include <coplane_core/Comm.hpp>
#include <coplane_exodus/ExodusCalls.hpp>
#include <coplane_exodus/SharedFile.hpp>
#include <coplane_mesh/MeshSlice.hpp>

#include <optional>
#include <string>
#include <vector>

namespace coplane
{
/// What a results file holds besides the mesh.
struct ResultsVariables
{
  std::vector<std::string> nodal;
  std::vector<std::string> element; ///< on every block
  std::vector<std::string> global;
  std::vector<std::string> side; ///< on every side set
};

/// Takes the steps after the first `steps` out of a results file that is not open; a file with
/// fewer steps, or without, stays as it is. Not collective.
void cutResults(const std::string& file, int steps);

/// Name of a rank's file: wall.e.4.0
std::string resultsFileOfRank(const std::string& file, int rank, int ranks);

/// Exodus II results of a parallel run: the mesh (ids, names, sets and body ids of the input) and
/// variables by time step.
///
/// One file shared by all ranks: CDF-5, defined by rank 0 under another name that is
/// renamed, so that a file of its name has a whole header, then written by each rank at its own
/// places (SharedFile). Each rank writes contiguous ranges of the file order: items
/// contiguousRange(n, rank, size) of nodes, of each block's elements and of each side set's sides.
/// Data go to the file at once, and the number of steps in the header is raised last, in endStep: a
/// program killed at any moment leaves a file with all finished steps. Or one file per rank
/// (`base.e.N.r`), which `epu -auto` joins; the calls and the ranges are the same.
///
/// Every rank makes every call. A failed write (full disk, quota) is remembered, decided together
/// in endStep, and thrown there on all ranks as Error(ExitCode::Output) with file, time and reason;
/// finished steps stay readable. Files are opened, written and closed without a collective call of
/// a library, so a rank that fails elsewhere can leave without the others.
class ResultsFile
{
public:
  /// QA records of the mesh are kept and Coplane's is appended. Lines of more than 80 characters
  /// are split. Collective.
  ResultsFile(const std::string& file, const Comm& comm, const MeshSlice& mesh,
              const ResultsVariables& variables, const std::vector<std::string>& infoLines,
              bool filePerRank = false);
  ResultsFile(const ResultsFile&) = delete;
  ResultsFile& operator=(const ResultsFile&) = delete;

  IndexRange myNodes() const { return contiguousRange(nodeCount_, comm_.rank(), comm_.size()); }
  IndexRange myElements(int block) const
  {
    return contiguousRange(blockSizes_[block], comm_.rank(), comm_.size());
  }

  /// Positions in the side set of the sides that this rank writes, ascending: a contiguous range,
  /// or in a file per rank those of this rank's elements.
  const std::vector<int>& mySides(int set) const { return mySides_[set]; }
  int sideSets() const { return int(mySides_.size()); }

  void beginStep(Real time);
  /// Values of this rank's range; variables and blocks are counted from 0 in the order given at
  /// construction.
  void putNodal(int variable, const std::vector<Real>& myRange);
  void putElement(int variable, int block, const std::vector<Real>& myRangeOfThatBlock);
  /// Values of mySides(set), in that order.
  void putSide(int variable, int set, const std::vector<Real>& values);
  /// All global variables, the same on every rank.
  void putGlobals(const std::vector<Real>& values);
  /// Makes the step part of the file. Collective.
  void endStep();
  void close();

  /// Not after close(), nor after a failure.
  bool isOpen() const { return data_.has_value(); }
  int steps() const { return steps_; }
  /// The file that this rank writes.
  const std::string& file() const { return file_; }

private:
  /// Collective.
  void create(const MeshSlice& slice, const ResultsVariables& variables,
              const std::vector<std::string>& infoLines);
  MeshSlice meshOfThisRank(const MeshSlice& slice);
  template <class Action>
  void attempt(const Action& action);
  void put(const std::string& variable, int first, const std::vector<Real>& values);
  void failTogether(const std::string& doing); ///< collective
  void abandon();
  /// Looks at the step that was written last, or is being written. Collective.
  void warnIfCutOff(int step);

  std::string file_;
  Comm comm_;
  bool filePerRank_;
  std::optional<SharedFile> data_;
  int nodeCount_ = 0;
  std::vector<int> blockSizes_;
  std::vector<std::vector<int>> mySides_; ///< by side set: positions in it
  int steps_ = 0;                         ///< finished ones
  Real time_ = 0;                         ///< of the step being written [s]
  std::string failure_;                   ///< first reason on this rank

  /// File per rank: the nodes of this rank's file come from the ranks in whose ranges they lie.
  std::optional<NodesFromHome> nodesOfPart_;
};
} // namespace coplane
