#include "CutApart.hpp"

#include "CutDomainBytes.hpp"

#include <coplane_core/Error.hpp>

#include <fmt/ranges.h>

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
  std::vector<std::string> failures;
  for (const MeshingWay& way : ways)
  {
    const ApartOutcome outcome = runApart(
        [&](Stages& stages) { return bytesOf(cutDomain(recipe, recipeFile, way, stages)); });
    if (outcome.end == ApartOutcome::End::Done)
    {
      CutDomain domain = cutDomainOf(outcome.bytes);
      if (!failures.empty())
        domain.notes.push_back(fmt::format("Gmsh failed to mesh this {}; it was meshed {}",
                                           fmt::join(failures, "; "), way.name));
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
    failures.push_back(fmt::format("{} ({})", way.name, reasonOf(outcome)));
    if (!isOfMeshing(outcome))
      break;
  }
  fail(ExitCode::Mesh,
       "{}: Gmsh cannot cut or mesh this: {}. Nothing was written. Joints, ends of joints or "
       "borders nearly meet somewhere. Another elements.size or seed, larger slivers.thickness, "
       "slivers.stub or slivers.volume, or joints somewhat elsewhere often help.",
       recipeFile, fmt::join(failures, "; "));
}
} // namespace coplane
