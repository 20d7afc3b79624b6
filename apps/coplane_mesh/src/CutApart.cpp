#include "CutApart.hpp"

#include "CutDomainBytes.hpp"

#include <coplane_core/Error.hpp>

#include <fmt/ranges.h>

#include <csignal>

namespace coplane
{
namespace
{
bool gaveUp(const ApartOutcome& outcome)
{
  return outcome.end == ApartOutcome::End::Failed && outcome.code == ExitCode::Computation;
}

/// Whether another way of meshing may help.
bool isOfMeshing(const ApartOutcome& outcome)
{
  return (gaveUp(outcome) || outcome.end == ApartOutcome::End::Died) &&
         outcome.stage == meshingStage;
}

std::string reasonOf(const ApartOutcome& outcome)
{
  if (gaveUp(outcome))
    return outcome.bytes;
  return fmt::format("crashed while {}: {}", outcome.stage,
                     outcome.signal > 0 ? nameOfSignal(outcome.signal) : "no signal");
}

/// Ways that failed, those with the same reason together.
class Failures
{
public:
  void add(const std::string& way, const std::string& reason)
  {
    if (ways_.empty() || reasons_.back() != reason)
    {
      reasons_.push_back(reason);
      ways_.emplace_back();
    }
    ways_.back().push_back(way);
  }
  bool empty() const { return ways_.empty(); }
  std::string text() const
  {
    std::vector<std::string> all;
    for (std::size_t k = 0; k < ways_.size(); ++k)
      all.push_back(fmt::format("{} ({})", fmt::join(ways_[k], ", "), reasons_[k]));
    return fmt::format("{}", fmt::join(all, "; "));
  }

private:
  std::vector<std::vector<std::string>> ways_;
  std::vector<std::string> reasons_;
};
} // namespace

CutDomain cutDomainApart(const BlocksRecipe& recipe, const std::string& recipeFile)
{
  const MeshingWay ways[] = {
      {},
      {"with other random numbers", 7},
      {"with others again", 13},
      {"with faces by Delaunay's criterion", 7, 5},
      {"with elements smaller by 7 %", 7, 6, 0.93},
      {"with faces by Delaunay's criterion and elements smaller by 15 %", 7, 5, 0.85}};
  Failures failures;
  for (const MeshingWay& way : ways)
  {
    const ApartOutcome outcome = runApart(
        [&](Stages& stages) { return bytesOf(cutDomain(recipe, recipeFile, way, stages)); });
    if (outcome.end == ApartOutcome::End::Done)
    {
      CutDomain domain = cutDomainOf(outcome.bytes);
      if (!failures.empty())
        domain.notes.push_back(fmt::format("Gmsh failed to mesh this {}; it was meshed {}",
                                           failures.text(), way.name));
      return domain;
    }
    if (outcome.end == ApartOutcome::End::Failed && !gaveUp(outcome))
      throw Error(outcome.code, outcome.bytes);
    if (outcome.end == ApartOutcome::End::Late)
      fail(ExitCode::Mesh,
           "{}: ended while {}, which took longer than elements.time_limit = {:.6g} s: Gmsh may "
           "hang, or has too much to do. Nothing was written. Fewer joints, larger elements or a "
           "larger elements.time_limit help; if it hangs, another elements.size or seed.",
           recipeFile, outcome.stage, recipe.elements.timeLimit);
    if (outcome.signal == SIGKILL)
      fail(ExitCode::Machine,
           "{}: the process was killed while {}: most often the machine has too little memory. "
           "Nothing was written. Make elements larger, or joints fewer.",
           recipeFile, outcome.stage);
    failures.add(way.name, reasonOf(outcome));
    if (!isOfMeshing(outcome))
      break;
  }
  fail(ExitCode::Mesh,
       "{}: Gmsh cannot cut or mesh this: {}. Nothing was written. Joints, ends of joints or "
       "borders nearly meet somewhere. Another elements.size or seed, larger slivers.thickness, "
       "slivers.stub or slivers.volume, or joints somewhat elsewhere often help.",
       recipeFile, failures.text());
}
} // namespace coplane
