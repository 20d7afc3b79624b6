#include <coplane_contact/Census.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_core/Log.hpp>
#include <coplane_core/Memory.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_core/Version.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_output/RunRecord.hpp>
#include <coplane_output/Sha256.hpp>
#include <coplane_output/detail/Placement.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <optional>

namespace coplane
{
namespace
{
using Json = nlohmann::ordered_json;

/// Local date and time with the offset from UTC (ISO 8601).
std::string dateNow()
{
  const std::time_t now = std::time(nullptr);
  char text[64];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S%z", std::localtime(&now));
  return text;
}

std::string mpiLibrary()
{
  char text[MPI_MAX_LIBRARY_VERSION_STRING] = {};
  int length = 0;
  MPI_Get_library_version(text, &length);
  return text;
}

std::string kokkosVersion()
{
  return fmt::format("{}.{}.{}", KOKKOS_VERSION / 10000, KOKKOS_VERSION / 100 % 100,
                     KOKKOS_VERSION % 100);
}

Json softwareOf()
{
  const Version& v = version();
  return {{"coplane", v.number}, {"revision", v.revision}, {"compiler", v.compiler},
          {"flags", v.flags},    {"trilinos", v.trilinos}, {"kokkos", kokkosVersion()},
          {"mpi", mpiLibrary()}};
}

Json sizesOf(const Solver& solver)
{
  std::int64_t elements = 0;
  for (const RankMesh::Block& block : solver.mesh().blocks)
    for (const char owned : block.owned)
      elements += owned != 0;
  const Comm& comm = solver.comm();
  const ContactCounts counts = solver.hasContact() ? solver.contact().counts() : ContactCounts{};
  std::vector<std::int64_t> sums{solver.layout().owned(), elements};
  comm.sum(sums);
  const ErosionTotals erosion = solver.erosion();
  return {{"dimension", solver.mesh().dimension},
          {"nodes", sums[0]},
          {"elements", sums[1]},
          {"candidate_pairs", counts.slots},
          {"planes", counts.planes},
          {"searches", solver.searches()},
          {"cycles", solver.clock().cycle},
          {"eroded_elements", erosion.elements},
          {"eroded_mass_kg", erosion.mass}};
}

Json facesOf(const GlobalId* ids, std::size_t count)
{
  Json list = Json::array();
  for (std::size_t i = 0; i < count; ++i)
    list.push_back({{"element", elementOfFace(ids[i])}, {"side", sideOfFace(ids[i]) + 1}});
  return list;
}

Json lengthsOf(const CensusLengths& lengths)
{
  Json json{{"count", lengths.count}};
  if (lengths.count == 0)
    return json;
  json["fractions"] = CensusLengths::fractions;
  json["quantiles_m"] = lengths.quantiles;
  json["extreme"] = Json::array();
  for (const CensusLengths::Pair& pair : lengths.extreme)
    json["extreme"].push_back({{"length_m", pair.length}, {"faces", facesOf(pair.faceId, 2)}});
  return json;
}

Json censusOf(const Contact& contact)
{
  const ContactCensus c = census(contact);
  Json json{{"skin_m", contact.skin()}, {"pairs", c.pairs},
            {"open", c.open},           {"stick", c.stick},
            {"slip", c.slip},           {"declared_closed", c.declaredClosed},
            {"bonded", c.bonded},       {"declared_without_overlap", c.declaredWithoutOverlap},
            {"touching", c.touching},   {"overlapping", c.overlapping},
            {"apart", c.apart},         {"declared_uneven", c.uneven}};
  json["change_of_joint_gap_m"] = c.changeOfGap;
  json["joint_gaps"] = lengthsOf(c.joints);
  json["overlaps"] = lengthsOf(c.overlaps);
  json["gaps"] = lengthsOf(c.gaps);
  json["faces_without_partner"] = {
      {"count", c.lonelyFaces},
      {"first", facesOf(c.firstLonelyFaces.data(), c.firstLonelyFaces.size())}};
  json["declared_without_partner"] = c.itemsWithoutPartner;
  if (c.pairs > 0)
    json["normal_stiffness_Pa_per_m"] = {c.leastStiffness, c.largestStiffness};
  return json;
}

Json linesOf(const Solver& solver)
{
  Json list = Json::array();
  for (const Line& line : solver.lines().lines())
  {
    const Line::Extremes& most = line.extremes();
    list.push_back({{"name", line.name()},
                    {"installed", line.installed()},
                    {"points_with_host", line.points().size()},
                    {"dowels", line.dowels().size()},
                    {"greatest_force_N", most.greatestForce},
                    {"time_of_greatest_force_s", most.timeOfGreatestForce},
                    {"least_force_N", most.leastForce},
                    {"greatest_slip_m", most.greatestSlip},
                    {"broken_segments", line.broken()},
                    {"steps_out_of_balance", line.unbalanced()}});
  }
  return list;
}

Json addedMassesOf(const Solver& solver)
{
  Json list = Json::array();
  const std::vector<AddedMass> blocks = solver.addedMasses();
  for (std::size_t b = 0; b < blocks.size(); ++b)
    list.push_back(
        {{"block", solver.model().blocks[b].name},
         {"mass_kg", blocks[b].own},
         {"added_kg", blocks[b].added},
         {"added_momentum_Ns", {blocks[b].momentum.x, blocks[b].momentum.y, blocks[b].momentum.z}},
         {"added_kinetic_J", blocks[b].kinetic}});
  return list;
}

Json energiesOf(const EnergyBalance& e)
{
  return {{"kinetic", e.kinetic},
          {"internal", e.internal},
          {"plastic", e.plastic},
          {"plastic_bending", e.bending},
          {"hourglass", e.hourglass},
          {"viscous", e.viscous},
          {"contact_stored", e.contact.stored},
          {"contact_friction", e.contact.friction},
          {"contact_hysteresis", e.contact.hysteresis},
          {"contact_fracture", e.contact.fracture},
          {"contact_damping", e.contact.damping},
          {"eroded", e.eroded},
          {"contact_eroded", e.contact.eroded},
          {"contact_remainder", e.contact.remainder()},
          {"lines", e.lines.work},
          {"line_stored", e.lines.stored},
          {"line_plastic", e.lines.plastic},
          {"line_bond", e.lines.bond},
          {"line_dowel", e.lines.dowel},
          {"line_rupture", e.lines.rupture},
          {"line_remainder", e.lines.remainder()},
          {"debris_stored", e.debris.stored},
          {"debris_remainder", e.debris.remainder()},
          {"mass_damping", e.massDamping},
          {"local_damping", e.localDamping},
          {"kinetic_damping", e.kineticDamping},
          {"external_work", e.externalWork},
          {"chemical", e.chemical},
          {"initial", e.initial},
          {"error", e.error()},
          {"scale", e.scale()}};
}

/// Seconds of the slowest rank by label; labels are those of rank 0.
Json slowestTimers(const Comm& comm)
{
  std::string labels;
  for (const auto& [label, seconds] : timers())
    labels += label + "\n";
  labels = comm.broadcast(labels);
  std::vector<std::string> names;
  std::vector<Real> values;
  for (std::size_t at = 0; at < labels.size();)
  {
    const std::size_t end = labels.find('\n', at);
    names.push_back(labels.substr(at, end - at));
    const auto found = timers().find(names.back());
    values.push_back(found == timers().end() ? 0 : found->second);
    at = end + 1;
  }
  comm.max(values);
  Json json = Json::object();
  for (std::size_t i = 0; i < names.size(); ++i)
    json[names[i]] = values[i];
  return json;
}

/// The identity of the run whose record a file is; nothing when it is no record.
std::optional<std::string> runOfRecord(const std::string& file)
{
  if (!isPlainFile(file))
    return std::nullopt;
  std::ifstream stream(file);
  const Json json = Json::parse(stream, nullptr, false);
  if (!json.is_object() || !json.contains("software") || !json["software"].contains("coplane"))
    return std::nullopt;
  return json.contains("run") && json["run"].is_string() ? json["run"].get<std::string>() : "";
}

/// Those of an earlier run, which belong to results that are not there any more. What has such a
/// name and is none is put aside.
void removeRecordsOfRestarts(const std::string& file)
{
  std::filesystem::path base(file);
  base.replace_extension(); // wall.run
  std::error_code error;
  for (int part = 2;; ++part)
  {
    const std::string record = fmt::format("{}-s{:04}.json", base.string(), part);
    if (!std::filesystem::exists(std::filesystem::symlink_status(record, error)))
      return;
    makeWayFor(record, [](const std::string& file) { return runOfRecord(file).has_value(); });
    std::filesystem::remove(record, error);
  }
}

/// Text that is not UTF-8 (a deck in another encoding) must not stop a run at its end.
std::string text(const Json& json)
{
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

constexpr std::size_t keptLimits = 50;
} // namespace

RunRecord::RunRecord(const Comm& comm, RunRecordOptions options)
    : options_(std::move(options)), isRoot_(comm.isRoot()), file_(options_.file),
      startDate_(dateNow()), begin_(std::chrono::steady_clock::now())
{
  const std::vector<Placement> ranks = comm.allGather(std::vector<Placement>{myPlacement()});
  Json placement = Json::array();
  for (const Placement& rank : ranks)
    placement.push_back(
        {{"host", rank.host}, {"cores", coreList(rank.cores)}, {"threads", rank.threads}});
  placement_ = placement.dump();
  for (const std::string& problem : placementProblems(ranks))
    logWarning("threads share cores", problem);
  comm.together(
      [&]
      {
        if (!comm.isRoot())
          return;
        deckHash_ = sha256(options_.deckText);
        meshHash_ = sha256OfFile(options_.meshFile);
        const bool isNew = options_.restartedFrom.empty();
        makeWayFor(options_.file,
                   [&](const std::string& file)
                   {
                     const auto run = runOfRecord(file);
                     return run && (isNew || *run == options_.run);
                   });
        file_.remember();
        if (isNew)
          removeRecordsOfRestarts(options_.file);
      });
}

void RunRecord::start(const Solver& solver)
{
  noteLimit(solver.stepControl().text());
  Json json{{"title", options_.title}, {"ending", "running"}};
  json["run"] = options_.run;
  json["software"] = softwareOf();
  if (!options_.restartedFrom.empty())
    json["restarted_from"] = options_.restartedFrom;
  json["command_line"] = options_.commandLine;
  json["backend"] = name(currentBackend());
  json["ranks"] = solver.comm().size();
  json["threads_per_rank"] = threadCount();
  json["placement"] = Json::parse(placement_);
  json["deck"] = {{"file", options_.deckFile}, {"sha256", deckHash_}, {"text", options_.deckText}};
  json["mesh"] = {{"file", options_.meshFile}, {"sha256", meshHash_}};
  json["sizes"] = sizesOf(solver);
  // The census tells of the state before the first step.
  if (solver.hasContact() && options_.restartedFrom.empty())
    json["census"] = censusOf(solver.contact());
  json["started"] = startDate_;
  json["end_s"] = options_.end > 0 ? options_.end : solver.model().time.end;
  atStart_ = text(json);
  solver.comm().together(
      [&]
      {
        if (isRoot_)
          replace(json);
      });
}

void RunRecord::finish(const Solver& solver, const Ending& ending)
{
  const Comm& comm = solver.comm();
  noteLimit(solver.stepControl().text());
  const std::int64_t memory = peakMemory();
  Json json = Json::parse(atStart_);
  json["ending"] = ending.how;
  if (!ending.reason.empty())
    json["reason"] = ending.reason;
  json["sizes"] = sizesOf(solver);
  json["ended"] = dateNow();
  json["exit_code"] = int(ending.code);
  json["wall_seconds"] =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  json["time_s"] = solver.clock().time;
  json["energies_J"] = energiesOf(solver.energy());
  if (!solver.lines().empty())
    json["lines"] = linesOf(solver);
  if (solver.scalesMass())
    json["added_masses"] = addedMassesOf(solver);
  json["state_hash"] = fmt::format("{:016x}", solver.stateHash());
  const Repartitions& rebalances = solver.repartitions();
  json["rebalances"] = {{"count", rebalances.count},
                        {"nodes_moved", rebalances.nodesMoved},
                        {"wall_seconds", rebalances.seconds}};
  json["peak_memory_bytes"] = {{"largest_rank", comm.max(memory)}, {"sum", comm.sum(memory)}};
  json["timers_s"] = slowestTimers(comm);
  comm.together(
      [&]
      {
        if (isRoot_)
          replace(json);
      });
}

void RunRecord::noteLimit(const std::string& limit)
{
  const auto found = std::find_if(limits_.begin(), limits_.end(),
                                  [&](const Limit& known) { return known.by == limit; });
  if (found == limits_.end())
    limits_.push_back({limit, 0});
  else
    std::rotate(found, found + 1, limits_.end());
  ++limits_.back().looks;
  if (limits_.size() > keptLimits)
    limits_.erase(limits_.begin());
}

void RunRecord::renew(double secondsLeft)
{
  if (!isRoot_)
    return;
  try
  {
    Json json = Json::parse(atStart_);
    if (std::isfinite(secondsLeft))
      json["seconds_left"] = secondsLeft;
    replace(json);
  }
  catch (const Error& error)
  {
    if (error.code() != ExitCode::Output)
      throw;
    logWarning("the record was not renewed", error.what());
  }
}

template <class Json>
void RunRecord::replace(Json json)
{
  json["messages"] = logMessages();
  json["warnings"] = logWarningCounts();
  json["step_limits"] = Json::array();
  for (const Limit& limit : limits_)
    json["step_limits"].push_back({{"limited_by", limit.by}, {"looks", limit.looks}});
  file_.replace(text(json) + "\n");
}
} // namespace coplane
