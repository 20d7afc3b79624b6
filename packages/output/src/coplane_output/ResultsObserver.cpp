#include <coplane_core/Log.hpp>
#include <coplane_core/TextFile.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_exodus/Provenance.hpp>
#include <coplane_output/Fragments.hpp>
#include <coplane_output/ResultsObserver.hpp>
#include <coplane_output/detail/NodalContact.hpp>
#include <coplane_output/detail/ProbedElements.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <sstream>

namespace coplane
{
namespace
{
std::vector<std::string> vectorNames(const std::string& stem, int dimension)
{
  std::vector<std::string> names{stem + "_x", stem + "_y"};
  if (dimension == 3)
    names.push_back(stem + "_z");
  return names;
}

/// Displacement comes first: the IOSS reader moves the mesh by the first nodal vector that starts
/// with "dis".
ResultsVariables variablesOf(int dimension, const std::vector<std::string>& history, bool fragments)
{
  ResultsVariables names;
  for (const char* stem : {"displacement", "velocity", "contact_force", "contact_traction"})
    for (const std::string& name : vectorNames(stem, dimension))
      names.nodal.push_back(name);
  for (const char* name :
       {"contact_pressure", "contact_closure", "contact_gap", "contact_slip", "contact_state"})
    names.nodal.push_back(name);
  // Six stresses, and six strains, stand together in this order, which the reader takes for a
  // symmetric tensor.
  // Body ids are an attribute of the blocks; the reader shows it, and refuses a variable of the
  // same name.
  names.element = {"stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_yz",
                   "stress_zx", "strain_xx", "strain_yy", "strain_zz", "strain_xy",
                   "strain_yz", "strain_zx", "von_mises", "pressure",  "equivalent_plastic_strain",
                   "density",   "alive"};
  names.element.insert(names.element.end(), history.begin(), history.end());
  if (fragments)
    names.element.push_back("fragment");
  names.global = {
      "time_step",          "kinetic_energy",     "internal_energy", "plastic_work",
      "hourglass_energy",   "viscous_work",       "contact_stored",  "contact_friction",
      "contact_hysteresis", "contact_fracture",   "contact_damping", "contact_remainder",
      "mass_damping_work",  "local_damping_work", "external_work",   "energy_error",
      "eroded_energy",      "contact_eroded",     "eroded_mass",     "kinetic_damping_work",
      "plastic_bending",    "chemical_energy"};
  names.side = sideVariableNames();
  return names;
}

/// displacement of displacement_x, stress of stress_xx; empty for what is no such part.
std::string wholeOf(const std::string& name)
{
  for (const char* stem :
       {"displacement", "velocity", "contact_force", "contact_traction", "stress", "strain"})
    if (name.rfind(stem + std::string("_"), 0) == 0)
      return stem;
  return "";
}

/// Places of the variables that are written, in the order of all.
std::vector<int> placesOf(const std::vector<std::string>& all,
                          const std::vector<std::string>& chosen)
{
  const auto isChosen = [&](const std::string& name)
  { return std::find(chosen.begin(), chosen.end(), name) != chosen.end(); };
  std::vector<int> places;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (const std::string whole = wholeOf(all[i]); chosen.empty() || whole == "displacement" ||
                                                   all[i] == "alive" || isChosen(all[i]) ||
                                                   (!whole.empty() && isChosen(whole)))
      places.push_back(int(i));
  return places;
}

std::vector<std::string> taken(const std::vector<std::string>& all, const std::vector<int>& places)
{
  std::vector<std::string> names;
  for (const int place : places)
    names.push_back(all[std::size_t(place)]);
  return names;
}
} // namespace

std::vector<std::string> resultsChoices(int dimension, const std::vector<std::string>& history,
                                        bool fragments)
{
  const ResultsVariables all = variablesOf(dimension, history, fragments);
  std::vector<std::string> names;
  const auto add = [&](const std::string& name)
  {
    if (std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  };
  for (const auto* list : {&all.nodal, &all.element})
    for (const std::string& name : *list)
    {
      if (const std::string whole = wholeOf(name); !whole.empty())
        add(whole);
      add(name);
    }
  return names;
}

std::int64_t bytesOfResultsStep(const MeshSlice& mesh, const std::vector<std::string>& history,
                                bool fragments, const std::vector<std::string>& chosen)
{
  ResultsVariables names = variablesOf(mesh.mine.dimension, history, fragments);
  names.nodal = taken(names.nodal, placesOf(names.nodal, chosen));
  names.element = taken(names.element, placesOf(names.element, chosen));
  std::int64_t sides = 0;
  for (const int size : mesh.sideSetSizes)
    sides += size;
  return std::int64_t(sizeof(Real)) *
         (std::int64_t(names.nodal.size()) * mesh.nodes +
          std::int64_t(names.element.size()) * mesh.elements() +
          std::int64_t(names.side.size()) * sides + std::int64_t(names.global.size()));
}

std::string resultsPart(const std::string& file, int part)
{
  return part == 1 ? file : fmt::format("{}-s{:04}", file, part);
}

namespace
{
/// Where a series ended when a checkpoint was written.
struct ResultsPosition
{
  std::int64_t cycle = -1; ///< of the last step
  int part = 1, steps = 0;
  int ranks = 0; ///< that have a file each; 0: a shared file
  std::string file;

  std::string text() const
  {
    return fmt::format("{} {} {} {} {}", cycle, part, steps, ranks, file);
  }
  static ResultsPosition from(const std::string& text)
  {
    ResultsPosition position;
    std::istringstream stream(text);
    stream >> position.cycle >> position.part >> position.steps >> position.ranks;
    stream.ignore(1);
    std::getline(stream, position.file);
    return position;
  }
};

/// What is there of a series of results.
struct PartThere
{
  std::filesystem::path file;
  int number;
  bool ofOneRank; ///< a file per rank
};

std::vector<PartThere> partsThere(const std::string& file)
{
  const std::filesystem::path path(file);
  const std::string stem = path.filename().string();
  static const std::regex end(R"((?:-s([0-9]{4,9}))?(\.[0-9]+\.[0-9]+)?)"); // and no other name
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  std::error_code error;
  std::vector<PartThere> parts;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
  {
    const std::string name = entry.path().filename().string();
    std::smatch match;
    if (name.rfind(stem, 0) != 0)
      continue;
    const std::string rest = name.substr(stem.size());
    if (std::regex_match(rest, match, end))
      parts.push_back({entry.path(), match[1].matched ? std::atoi(match[1].str().c_str()) : 1,
                       match[2].matched});
  }
  return parts;
}

/// Makes room for a new run, which replaces the series of an earlier one: its first part will be
/// overwritten, later ones are removed, as ParaView would read them as well. What has such a name
/// and holds no results is put aside.
void removeSeries(const std::string& file, int ranksWithFiles)
{
  const auto isOwn = [](const std::string& part)
  { return isPlainFile(part) && runOfResults(part).has_value(); };
  if (ranksWithFiles == 0)
    makeWayFor(placeOfFile(file), isOwn); // written through a link
  for (int r = 0; r < ranksWithFiles; ++r)
    makeWayFor(placeOfFile(resultsFileOfRank(file, r, ranksWithFiles)), isOwn);
  int removed = 0;
  std::error_code error;
  for (const PartThere& part : partsThere(file))
    if (part.number >= 2)
    {
      makeWayFor(part.file, isOwn);
      removed += int(std::filesystem::remove(part.file, error));
    }
  if (removed > 0)
    logInfo("removed {} parts of the series {}-s... from an earlier run", removed, file);
}

/// Makes room for a restart: parts from number `first` on were left by this run when it went on
/// from an earlier checkpoint, and are removed; what is not of this run is put aside.
/// @param filePerRank this run has, or had, files like wall.e.4.0; others of such names are inputs,
///        or somebody's
void keepOwnParts(const std::string& file, const std::string& run, int first, bool filePerRank)
{
  int removed = 0;
  std::error_code error;
  for (const PartThere& part : partsThere(file))
  {
    if (part.ofOneRank && part.number == 1 && !filePerRank)
      continue;
    // The link to a part that is kept stays.
    const bool isOwn = !wouldBeLost(part.file) || runOfResults(part.file) == run;
    if (isOwn && part.number >= first && isPlainFile(part.file))
      removed += int(std::filesystem::remove(part.file, error));
    else if (!isOwn || part.number >= first)
      putForeignFileAside(part.file);
  }
  if (removed > 0)
    logInfo("removed {} parts of the series {}-s..., which are later than the checkpoint", removed,
            file);
}
} // namespace

ResultsObserver::ResultsObserver(const Comm& comm, const MeshSlice& mesh, ResultsOptions options)
    : comm_(&comm), mesh_(&mesh), options_(std::move(options)), dimension_(mesh.mine.dimension),
      history_(options_.history), schedule_(options_.when)
{
  // Parts of restarts that were left behind. The checkpoint may be of a part that had no step yet:
  // what that part wrote afterwards has to go, too.
  const ResultsPosition position = ResultsPosition::from(options_.position);
  const ResultsVariables all = variablesOf(dimension_, history_, options_.bodies != nullptr);
  nodal_ = placesOf(all.nodal, options_.variables);
  element_ = placesOf(all.element, options_.variables);
  options_.infoLines.insert(options_.infoLines.begin(), infoLineOf(options_.run));
  comm.together(
      [&]
      {
        if (!comm.isRoot())
          return;
        if (options_.part == 1)
          removeSeries(options_.file, options_.filePerRank ? comm.size() : 0);
        else
          keepOwnParts(options_.file, options_.run,
                       isSameName(position.file, options_.file) ? position.part + 1 : options_.part,
                       options_.filePerRank || position.ranks > 0);
      });
  if (options_.part == 1)
    open();
  else
    continueSeries();
}

void ResultsObserver::open()
{
  ResultsVariables names = variablesOf(dimension_, history_, options_.bodies != nullptr);
  names.nodal = taken(names.nodal, nodal_);
  names.element = taken(names.element, element_);
  file_.emplace(resultsPart(options_.file, options_.part), *comm_, *mesh_, names,
                options_.infoLines, options_.filePerRank);
}

void ResultsObserver::continueSeries()
{
  const ResultsPosition position = ResultsPosition::from(options_.position);
  lastCycle_ = position.cycle;
  comm_->together(
      [&]
      {
        if (!comm_->isRoot() || !isSameName(position.file, options_.file) || position.steps == 0)
          return;
        const std::string part = resultsPart(options_.file, position.part);
        for (int r = 0; r < std::max(1, position.ranks); ++r)
          cutResults(position.ranks == 0 ? part : resultsFileOfRank(part, r, position.ranks),
                     position.steps);
      });
}

void ResultsObserver::start(const Solver& solver)
{
  schedule_.startAt(solver.clock().time);
  if (options_.part == 1)
    write(solver);
}

void ResultsObserver::savePosition(std::map<std::string, std::string>& positions) const
{
  ResultsPosition position = ResultsPosition::from(options_.position);
  if (steps() > 0)
    position = {lastCycle_, options_.part, steps(), options_.filePerRank ? comm_->size() : 0,
                options_.file};
  positions["results"] = position.text();
}

void ResultsObserver::prepare(const Solver& solver)
{
  // Ids of the redistribution are positions in the file.
  const RankMesh& mesh = solver.mesh();
  std::vector<GlobalId> source(mesh.nodePositions.begin(),
                               mesh.nodePositions.begin() + mesh.ownedNodes);
  std::vector<GlobalId> target;
  const IndexRange nodes = file_->myNodes();
  for (int i = 0; i < nodes.count; ++i)
    target.push_back(nodes.first + i);
  nodesToFile_.emplace(solver.comm(), source, target);

  source.clear();
  target.clear();
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    const RankMesh::Block& block = mesh.blocks[b];
    for (int e = 0; e < block.elements(); ++e)
      if (block.owned[e])
        source.push_back(mesh_->firstElements[b] + block.positions[e]);
    const IndexRange elements = file_->myElements(int(b));
    for (int i = 0; i < elements.count; ++i)
      target.push_back(mesh_->firstElements[b] + elements.first + i);
  }
  elementsToFile_.emplace(solver.comm(), source, target);
  if (file_->sideSets() > 0)
    sides_.emplace(solver, *file_);
}

void ResultsObserver::endOfCycle(const Solver& solver)
{
  const bool due = schedule_.isDue(solver.clock().time);
  if (due || solver.resultsRequested())
    write(solver);
}

void ResultsObserver::repartitioned(const Solver&)
{
  nodesToFile_.reset(); // write() finds all of them anew
  elementsToFile_.reset();
  sides_.reset();
}

void ResultsObserver::endOfStage(const Solver& solver)
{
  if (solver.clock().cycle != lastCycle_)
    write(solver);
}

void ResultsObserver::finish(const Solver& solver, const Ending&)
{
  if (file_ && !file_->isOpen())
    return; // it is what failed
  if (solver.clock().cycle != lastCycle_)
    write(solver);
  if (file_)
    file_->close();
}

void ResultsObserver::write(const Solver& solver)
{
  TimedRegion region("coplane::output::results");
  if (!file_)
    open();
  if (!nodesToFile_)
    prepare(solver);
  const EnergyBalance energy = solver.energy();
  file_->beginStep(solver.clock().time);
  writeNodes(solver);
  writeElements(solver);
  if (sides_)
    sides_->write(solver, *file_);
  file_->putGlobals({solver.clock().step,     energy.kinetic,          energy.internal,
                     energy.plastic,          energy.hourglass,        energy.viscous,
                     energy.contact.stored,   energy.contact.friction, energy.contact.hysteresis,
                     energy.contact.fracture, energy.contact.damping,  energy.contact.remainder(),
                     energy.massDamping,      energy.localDamping,     energy.externalWork,
                     energy.error(),          energy.eroded,           energy.contact.eroded,
                     solver.erosion().mass,   energy.kineticDamping,   energy.bending,
                     energy.chemical});
  file_->endStep();
  lastCycle_ = solver.clock().cycle;
}

void ResultsObserver::writeNodes(const Solver& solver)
{
  const NodalState& state = solver.state();
  const NodalContact contact = nodalContact(solver);
  const int owned = solver.layout().owned();
  const int columns = 4 * dimension_ + 5;
  Table<Real> mine("coplane::output::nodes", owned, columns);
  for (int n = 0; n < owned; ++n)
  {
    int column = 0;
    for (int c = 0; c < dimension_; ++c)
      mine(n, column++) = state.x(n, c) - state.reference(n, c);
    for (int c = 0; c < dimension_; ++c) // at n, where the positions are
      mine(n, column++) = 0.5 * (state.vPrevious(n, c) + state.v(n, c));
    for (int c = 0; c < dimension_; ++c)
      mine(n, column++) = state.contactForce(n, c);
    for (int c = 0; c < dimension_; ++c)
      mine(n, column++) = contact.traction[n][c];
    mine(n, column++) = contact.pressure[n];
    mine(n, column++) = contact.closure[n];
    mine(n, column++) = contact.gap[n];
    mine(n, column++) = contact.slip[n];
    mine(n, column++) = contact.state[n];
  }
  const int rows = file_->myNodes().count;
  Table<Real> inFile("coplane::output::nodesInFile", rows, columns);
  nodesToFile_->move(mine, inFile);
  std::vector<Real> values(rows);
  for (std::size_t variable = 0; variable < nodal_.size(); ++variable)
  {
    for (int i = 0; i < rows; ++i)
      values[i] = inFile(i, nodal_[variable]);
    file_->putNodal(int(variable), values);
  }
}

void ResultsObserver::writeElements(const Solver& solver)
{
  constexpr int fixed = 17, firstStrain = 6, lastStrain = 11;
  const bool strained =
      std::any_of(element_.begin(), element_.end(),
                  [](int column) { return column >= firstStrain && column <= lastStrain; });
  const ConnectedBodies* const bodies = options_.bodies ? &options_.bodies->at(solver) : nullptr;
  const int columns = fixed + int(history_.size()) + int(bodies != nullptr);
  const RankMesh& mesh = solver.mesh();
  int owned = 0, rows = 0;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    for (const char mine : mesh.blocks[b].owned)
      owned += mine != 0;
    rows += file_->myElements(int(b)).count;
  }
  Table<Real> mine("coplane::output::elements", owned, columns);
  int row = 0;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    const RankMesh::Block& part = mesh.blocks[b];
    const ElementBlock& block = solver.blocks()[b];
    const auto stress = block.stress();
    const int plasticStrain = block.historyRow("equivalent_plastic_strain");
    std::vector<int> rowOf;
    for (const std::string& name : history_)
      rowOf.push_back(block.historyRow(name));
    for (int e = 0; e < part.elements(); ++e)
    {
      if (!part.owned[e])
        continue;
      const SymTensor strain = strained ? strainOf(solver, int(b), e) : SymTensor();
      int column = 0;
      for (int c = 0; c < 6; ++c)
        mine(row, column++) = stress(c, e);
      for (const Real value : {strain.xx, strain.yy, strain.zz, strain.xy, strain.yz, strain.zx})
        mine(row, column++) = value;
      mine(row, column++) = block.vonMises(e);
      mine(row, column++) = block.pressure(e);
      mine(row, column++) = plasticStrain < 0 ? 0 : block.history(plasticStrain, e);
      mine(row, column++) = block.density(e);
      mine(row, column++) = block.isAlive(e);
      for (std::size_t k = 0; k < history_.size(); ++k)
        mine(row, fixed + int(k)) = rowOf[k] < 0 ? 0 : block.history(rowOf[k], e);
      if (bodies)
        mine(row, columns - 1) = Real(bodies->ofElement[b][e]);
      ++row;
    }
  }
  Table<Real> inFile("coplane::output::elementsInFile", rows, columns);
  elementsToFile_->move(mine, inFile);
  int first = 0;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    std::vector<Real> values(file_->myElements(int(b)).count);
    for (std::size_t variable = 0; variable < element_.size(); ++variable)
    {
      for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = inFile(first + i, element_[variable]);
      file_->putElement(int(variable), int(b), values);
    }
    first += int(values.size());
  }
}
} // namespace coplane
