#include "MeshCommand.hpp"

#include <coplane_core/DraftName.hpp>
#include <coplane_core/Error.hpp>
#include <coplane_core/FileRoles.hpp>
#include <coplane_core/OutputLocks.hpp>
#include <coplane_core/PlaceText.hpp>
#include <coplane_exodus/WriteMesh.hpp>

#include <cstdio>
#include <filesystem>

namespace coplane
{
namespace
{
std::string pairsOf(const MeshReport& report, GlobalId sideSet)
{
  for (const MeshReport::Joint& joint : report.joints)
    if (joint.id == sideSet)
      return fmt::format(", a joint of {} pairs", joint.pairs);
  return {};
}

void printReport(const Mesh& mesh, const MeshReport& report)
{
  const char* measure = report.dimension == 2 ? "area" : "volume";
  const char* unit = report.dimension == 2 ? "m^2" : "m^3";
  print(fmt::format("{} dimensions, {} nodes, {} elements, {} bodies", report.dimension,
                    report.nodes, report.elements, report.bodies));
  for (const auto& block : report.blocks)
    print(fmt::format(
        "  block {} '{}': {} {}, {} bodies, {} {:.6g} {}, worst shape {:.3g} (element {})",
        block.id, block.name, block.elements, block.type, block.bodies, measure, block.volume, unit,
        block.worstQuality, block.worstElement));
  for (const auto& set : mesh.nodeSets)
    print(fmt::format("  node set {} '{}': {} nodes", set.id, set.name, set.nodes.size()));
  for (const auto& set : mesh.sideSets)
    print(fmt::format("  side set {} '{}': {} faces{}", set.id, set.name, set.elements.size(),
                      pairsOf(report, set.id)));
  const char axes[] = "xyz";
  for (int axis = 0; axis < report.dimension; ++axis)
  {
    const Real resolution = 1e-6 * (report.highest[axis] - report.lowest[axis]);
    print(fmt::format("  {} from {} to {} m", axes[axis],
                      coordinateText(report.lowest[axis], resolution),
                      coordinateText(report.highest[axis], resolution)));
  }
  print(fmt::format("  edges from {:.6g} to {:.6g} m", report.shortestEdge, report.longestEdge));
}

/// Prints what was found; throws when no computation can use the mesh.
void judge(const MeshReport& report, const std::string& file)
{
  const std::vector<std::string> problems = meshProblems(report);
  for (const std::string& problem : problems)
    print((report.usable() ? "note: " : "problem: ") + problem);
  if (problems.empty())
    print("no problems found");
  if (!report.usable())
    fail(ExitCode::Mesh, "{}: the mesh cannot be used: {}", file, problems.front());
}

void writeAlone(const Mesh& mesh, const std::string& output)
{
  const std::string lock = placeOfFile(output) + ".lock";
  FileRoles roles;
  roles.writes(output, "the new mesh (-o)");
  roles.writes(lock, "the lock of the new mesh (-o)");
  roles.writesDraft({draftOf(placeOfFile(output))}, "the new mesh (-o)");
  const auto locks = lockOutputs(roles, {lock}, output);
  removeDraftsOfKilled(roles, locks);
  writeMesh(mesh, output);
}
} // namespace

void print(const std::string& text)
{
  std::fputs((text + "\n").c_str(), stdout);
}

void demandDistinct(const std::vector<std::pair<std::string, std::string>>& inputs,
                    const std::string& output)
{
  FileRoles roles;
  for (const auto& [file, what] : inputs)
  {
    roles.reads(file, what);
    if (std::error_code error; !std::filesystem::exists(file, error))
      roles.readsSeries({file + ".", ".", ""}, "a part of " + what);
  }
  roles.writes(output, "the new mesh (-o)");
  roles.writes(placeOfFile(output) + ".lock", "the lock of the new mesh (-o)");
  if (const std::vector<std::string> problems = roles.problems(); !problems.empty())
    fail(ExitCode::Usage, "{}", fmt::join(problems, "\n"));
}

void reportOn(const Mesh& mesh, const std::string& source)
{
  const MeshReport report = reportMesh(mesh);
  printReport(mesh, report);
  judge(report, source);
}

void reportAndWrite(const Mesh& mesh, const std::string& source, const std::string& output)
{
  reportOn(mesh, source);
  writeAlone(mesh, output);
  print("wrote " + output);
}
} // namespace coplane
