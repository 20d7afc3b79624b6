#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_output/NodalContact.hpp>
#include <coplane_output/ResultsObserver.hpp>

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
ResultsVariables variablesOf(int dimension, const std::vector<std::string>& history)
{
  ResultsVariables names;
  for (const char* stem : {"displacement", "velocity", "contact_force", "contact_traction"})
    for (const std::string& name : vectorNames(stem, dimension))
      names.nodal.push_back(name);
  for (const char* name :
       {"contact_pressure", "contact_closure", "contact_gap", "contact_slip", "contact_state"})
    names.nodal.push_back(name);
  // The six stresses stand together in this order, which the reader takes for a symmetric tensor.
  // Body ids are an attribute of the blocks; the reader shows it, and refuses a variable of the
  // same name.
  names.element = {"stress_xx", "stress_yy", "stress_zz",
                   "stress_xy", "stress_yz", "stress_zx",
                   "von_mises", "pressure",  "equivalent_plastic_strain",
                   "density",   "alive"};
  names.element.insert(names.element.end(), history.begin(), history.end());
  names.global = {
      "time_step",          "kinetic_energy",     "internal_energy", "plastic_work",
      "hourglass_energy",   "viscous_work",       "contact_stored",  "contact_friction",
      "contact_hysteresis", "contact_fracture",   "contact_damping", "contact_remainder",
      "mass_damping_work",  "local_damping_work", "external_work",   "energy_error",
      "eroded_energy",      "contact_eroded",     "eroded_mass",     "kinetic_damping_work"};
  names.side = sideVariableNames();
  return names;
}

std::vector<std::int64_t> firstElements(const Mesh& mesh)
{
  std::vector<std::int64_t> first{0};
  for (const Mesh::Block& block : mesh.blocks)
    first.push_back(first.back() + block.elements());
  return first;
}
} // namespace

ResultsObserver::ResultsObserver(const Comm& comm, const Mesh& mesh, ResultsOptions options)
    : dimension_(mesh.dimension), history_(options.history), firstOfBlock_(firstElements(mesh)),
      schedule_(std::move(options.when)),
      file_(options.file, comm, mesh, variablesOf(mesh.dimension, options.history),
            options.infoLines, options.filePerRank)
{
}

void ResultsObserver::start(const Solver& solver)
{
  // Ids of the redistribution are positions in the file.
  const RankMesh& mesh = solver.mesh();
  std::vector<GlobalId> source(mesh.nodePositions.begin(),
                               mesh.nodePositions.begin() + mesh.ownedNodes);
  std::vector<GlobalId> target;
  const IndexRange nodes = file_.myNodes();
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
        source.push_back(firstOfBlock_[b] + block.positions[e]);
    const IndexRange elements = file_.myElements(int(b));
    for (int i = 0; i < elements.count; ++i)
      target.push_back(firstOfBlock_[b] + elements.first + i);
  }
  elementsToFile_.emplace(solver.comm(), source, target);
  if (file_.sideSets() > 0)
    sides_.emplace(solver, file_);

  schedule_.startAt(solver.clock().time);
  write(solver);
}

void ResultsObserver::endOfCycle(const Solver& solver)
{
  const bool due = schedule_.isDue(solver.clock().time);
  if (due || solver.resultsRequested())
    write(solver);
}

void ResultsObserver::finish(const Solver& solver, const std::string&)
{
  if (solver.clock().cycle != lastCycle_)
    write(solver);
  file_.close();
}

void ResultsObserver::write(const Solver& solver)
{
  TimedRegion region("coplane::output::results");
  const EnergyBalance energy = solver.energy();
  file_.beginStep(solver.clock().time);
  writeNodes(solver);
  writeElements(solver);
  if (sides_)
    sides_->write(solver, file_);
  file_.putGlobals({solver.clock().step,     energy.kinetic,          energy.internal,
                    energy.plastic,          energy.hourglass,        energy.viscous,
                    energy.contact.stored,   energy.contact.friction, energy.contact.hysteresis,
                    energy.contact.fracture, energy.contact.damping,  energy.contact.remainder(),
                    energy.massDamping,      energy.localDamping,     energy.externalWork,
                    energy.error(),          energy.eroded,           energy.contact.eroded,
                    solver.erosion().mass,   energy.kineticDamping});
  file_.endStep();
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
  const int rows = file_.myNodes().count;
  Table<Real> inFile("coplane::output::nodesInFile", rows, columns);
  nodesToFile_->move(mine, inFile);
  std::vector<Real> values(rows);
  for (int column = 0; column < columns; ++column)
  {
    for (int i = 0; i < rows; ++i)
      values[i] = inFile(i, column);
    file_.putNodal(column, values);
  }
}

void ResultsObserver::writeElements(const Solver& solver)
{
  constexpr int fixed = 11;
  const int columns = fixed + int(history_.size());
  const RankMesh& mesh = solver.mesh();
  int owned = 0, rows = 0;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    for (const char mine : mesh.blocks[b].owned)
      owned += mine != 0;
    rows += file_.myElements(int(b)).count;
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
      for (int c = 0; c < 6; ++c)
        mine(row, c) = stress(c, e);
      mine(row, 6) = block.vonMises(e);
      mine(row, 7) = block.pressure(e);
      mine(row, 8) = plasticStrain < 0 ? 0 : block.history()(plasticStrain, e);
      mine(row, 9) = block.density(e);
      mine(row, 10) = block.isAlive(e);
      for (std::size_t k = 0; k < history_.size(); ++k)
        mine(row, fixed + int(k)) = rowOf[k] < 0 ? 0 : block.history()(rowOf[k], e);
      ++row;
    }
  }
  Table<Real> inFile("coplane::output::elementsInFile", rows, columns);
  elementsToFile_->move(mine, inFile);
  int first = 0;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    std::vector<Real> values(file_.myElements(int(b)).count);
    for (int column = 0; column < columns; ++column)
    {
      for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = inFile(first + i, column);
      file_.putElement(column, int(b), values);
    }
    first += int(values.size());
  }
}
} // namespace coplane
