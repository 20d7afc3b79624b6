#include <coplane_contact/ContactTables.hpp>
#include <coplane_core/Text.hpp>
#include <coplane_core/Timers.hpp>
#include <coplane_dynamics/Solver.hpp>
#include <coplane_output/TablesObserver.hpp>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace coplane
{
TablesObserver::TablesObserver(const Comm& comm, TablesOptions options)
    : options_(std::move(options)), schedule_(OutputTimes{options_.every, {}})
{
  const auto positionOf = [&](const char* table)
  {
    const auto found = options_.positions.find(table);
    return TextPosition::from(found == options_.positions.end() ? "" : found->second);
  };
  for (const char* table : {"blocks", "pairs", "materials", "lines"})
    lastCycle_ = std::max(lastCycle_, positionOf(table).cycle);
  const auto open = [&](TextTable& lines, const char* table, const std::string& header)
  {
    std::optional<TextPosition> position;
    if (!options_.positions.empty())
      position = positionOf(table);
    if (!lines.open(fileOf(table), header, position))
      lines.add(header + "\n");
  };
  comm.together(
      [&]
      {
        if (!comm.isRoot())
          return;
        if (options_.blocks)
          open(blocks_, "blocks",
               "time[s],cycle,block,kinetic[J],internal[J],plastic[J],"
               "plastic_bending[J],hourglass[J],viscous[J],"
               "eroded[J]");
        const std::string terms = "joint,planes,area[m^2],work[J],stored[J],friction[J],"
                                  "hysteresis[J],fracture[J],damping[J],eroded[J],remainder[J]";
        if (options_.pairs)
          open(pairs_, "pairs", "time[s],cycle,block_a,block_b," + terms);
        if (options_.materials)
          open(materials_, "materials", "time[s],cycle,material_a,material_b," + terms);
        if (options_.lines)
          open(lines_, "lines",
               "time[s],cycle,line,segment,x[m],y[m],z[m],force[N],stress[Pa],strain,"
               "plastic_strain,slip_a[m],slip_b[m],bond_a[N],bond_b[N],broken,sliding[m],dowel[N],"
               "moment_a[N*m],moment_b[N*m]");
      });
}

void TablesObserver::start(const Solver& solver)
{
  if (options_.blocks)
    findShares(solver);
  schedule_.startAt(solver.clock().time);
  if (options_.positions.empty())
    write(solver);
}

void TablesObserver::endOfCycle(const Solver& solver)
{
  if (options_.every <= 0 || schedule_.isDue(solver.clock().time))
    write(solver);
}

void TablesObserver::repartitioned(const Solver& solver)
{
  if (options_.blocks)
    findShares(solver);
}

std::string TablesObserver::fileOf(const char* table) const
{
  return fmt::format("{}_{}.csv", options_.base, table);
}

void TablesObserver::savePosition(std::map<std::string, std::string>& positions) const
{
  const auto save = [&](const TextTable& lines, const char* table)
  {
    if (lines.isOpen()) // on rank 0, which speaks
      positions[table] = lines.position(lastCycle_).text();
  };
  save(blocks_, "blocks");
  save(pairs_, "pairs");
  save(materials_, "materials");
  save(lines_, "lines");
}

void TablesObserver::endOfStage(const Solver& solver)
{
  if (solver.clock().cycle != lastCycle_)
    write(solver);
}

void TablesObserver::finish(const Solver& solver, const Ending&)
{
  if (solver.clock().cycle != lastCycle_)
    write(solver);
}

void TablesObserver::findShares(const Solver& solver)
{
  // Elements stand in the order of the file on every rank, so the sums have the same bits.
  const RankMesh& mesh = solver.mesh();
  shares_.clear();
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
  {
    const RankMesh::Block& block = mesh.blocks[b];
    const int corners = topology(block.type).nodes;
    std::vector<Real> mass(mesh.ownedNodes, 0);
    for (int i = 0; i < int(block.connectivity.size()); ++i)
      if (block.connectivity[i] < mesh.ownedNodes)
        mass[block.connectivity[i]] += solver.blocks()[b].cornerMass(i / corners, i % corners);
    shares_.emplace_back();
    for (int n = 0; n < mesh.ownedNodes; ++n)
      if (mass[n] > 0)
        shares_.back().push_back({n, mass[n]});
  }

  // What each rigid block brings to the mass of each body.
  const RigidBodies& bodies = solver.rigidBodies();
  const std::size_t blocks = shares_.size();
  std::vector<ExactSum> sums(blocks * std::size_t(bodies.count()));
  for (std::size_t b = 0; b < blocks; ++b)
    for (const Share& share : shares_[b])
      if (solver.model().blocks[b].rigid)
        sums[std::size_t(bodies.bodyOf(share.node)) * blocks + b].add(share.mass);
  if (sums.empty())
    return;
  partOfBody_ = ExactSum::overRanks(sums, solver.comm());
  for (int body = 0; body < bodies.count(); ++body)
  {
    Real* const part = &partOfBody_[std::size_t(body) * blocks];
    const Real whole = std::accumulate(part, part + blocks, Real(0));
    for (std::size_t b = 0; b < blocks; ++b)
      part[b] /= whole;
  }
}

std::string TablesObserver::blockLines(const Solver& solver) const
{
  constexpr ElementEnergy kinds[] = {ElementEnergy::Internal, ElementEnergy::PlasticDissipation,
                                     ElementEnergy::PlasticBending, ElementEnergy::Hourglass,
                                     ElementEnergy::Viscous};
  constexpr int terms = 2 + int(std::size(kinds));
  const NodalState& state = solver.state();
  const RigidBodies& bodies = solver.rigidBodies();
  const std::size_t blocks = shares_.size();
  // Last come, for each body, what the masses of deformable elements at its nodes have: that is
  // counted with their blocks.
  std::vector<ExactSum> sums(terms * blocks + std::size_t(bodies.count()));
  for (std::size_t b = 0; b < blocks; ++b)
  {
    for (const Share& share : shares_[b])
    {
      if (solver.model().blocks[b].rigid)
        break; // moves with its bodies
      const Real kinetic =
          0.5 * share.mass * dot(at(state.vPrevious, share.node), at(state.v, share.node));
      sums[terms * b].add(kinetic);
      if (const int body = bodies.bodyOf(share.node); body >= 0)
        sums[terms * blocks + std::size_t(body)].add(kinetic);
    }
    const RankMesh::Block& part = solver.mesh().blocks[b];
    for (int e = 0; e < part.elements(); ++e)
      if (part.owned[e])
        for (std::size_t k = 0; k < std::size(kinds); ++k)
          sums[terms * b + 1 + k].add(solver.blocks()[b].energy(e, kinds[k]));
    sums[terms * b + terms - 1].add(solver.erodedEnergy(int(b)));
  }
  if (sums.empty())
    return "";
  std::vector<Real> totals = ExactSum::overRanks(sums, solver.comm());
  for (int body = 0; body < bodies.count(); ++body)
    for (std::size_t b = 0; b < blocks; ++b)
      totals[terms * b] += partOfBody_[std::size_t(body) * blocks + b] *
                           (bodies.kinetic(body) - totals[terms * blocks + std::size_t(body)]);
  std::string text;
  for (std::size_t b = 0; b < shares_.size(); ++b)
  {
    text += fmt::format("{:.17g},{},{}", solver.clock().time, solver.clock().cycle,
                        csvField(solver.model().blocks[b].name));
    for (int k = 0; k < terms; ++k)
      text += fmt::format(",{:.17g}", totals[terms * b + k]);
    text += "\n";
  }
  return text;
}

namespace
{
std::string lineOf(const Solver& solver, const std::string& sideA, const std::string& sideB,
                   const ContactTableRow& row)
{
  const ContactEnergy& e = row.energy;
  std::string text = fmt::format(
      "{:.17g},{},{},{},{},{}", solver.clock().time, solver.clock().cycle, csvField(sideA),
      csvField(sideB), csvField(solver.contact().rules().joints[row.kind.joint].name), row.planes);
  for (const Real value : {row.area, e.work, e.stored, e.friction, e.hysteresis, e.fracture,
                           e.damping, e.eroded, e.remainder()})
    text += fmt::format(",{:.17g}", value);
  return text + "\n";
}
} // namespace

std::string TablesObserver::pairLines(const Solver& solver) const
{
  std::string text;
  if (solver.hasContact())
    for (const ContactTableRow& row : contactTable(solver.contact(), solver.state().x))
      text += lineOf(solver, solver.model().blocks[row.kind.blocks[0]].name,
                     solver.model().blocks[row.kind.blocks[1]].name, row);
  return text;
}

std::string TablesObserver::materialLines(const Solver& solver) const
{
  std::map<std::tuple<std::string, std::string, int>, ContactTableRow> rows;
  if (solver.hasContact())
    for (const ContactTableRow& row : contactTable(solver.contact(), solver.state().x))
    {
      const auto& blocks = solver.model().blocks;
      const auto sides = std::minmax(blocks[row.kind.blocks[0]].materialName,
                                     blocks[row.kind.blocks[1]].materialName);
      const auto [place, isNew] =
          rows.emplace(std::tuple(sides.first, sides.second, row.kind.joint), row);
      if (isNew)
        continue;
      ContactTableRow& sum = place->second;
      sum.planes += row.planes;
      sum.area += row.area;
      sum.energy.work += row.energy.work;
      sum.energy.stored += row.energy.stored;
      sum.energy.friction += row.energy.friction;
      sum.energy.hysteresis += row.energy.hysteresis;
      sum.energy.fracture += row.energy.fracture;
      sum.energy.damping += row.energy.damping;
      sum.energy.eroded += row.energy.eroded;
    }
  std::string text;
  for (const auto& [key, row] : rows)
    text += lineOf(solver, std::get<0>(key), std::get<1>(key), row);
  return text;
}

/// Of what has been installed; in two dimensions forces are those of one metre.
std::string TablesObserver::segmentLines(const Solver& solver)
{
  std::string text;
  for (const Line& line : solver.lines().lines())
    for (std::size_t s = 0; line.installed() && !line.removed() && s < line.segments().size(); ++s)
    {
      const Line::Segment& segment = line.segments()[s];
      const Line::Point &a = line.points()[s], &b = line.points()[s + 1];
      const Vec3 middle = 0.5 * (line.place(a.index) + line.place(b.index));
      Real sliding = 0, dowels = 0;
      for (const Line::Dowel& dowel : line.dowels())
        if (dowel.segment >= a.index && dowel.segment < b.index)
        {
          sliding = std::max(sliding, norm(dowel.sliding));
          dowels = std::max(dowels, norm(dowel.force));
        }
      text += fmt::format("{:.17g},{},{},{}", solver.clock().time, solver.clock().cycle,
                          csvField(line.name()), a.index + 1);
      for (const Real value :
           {middle.x, middle.y, middle.z, segment.force, segment.force / line.section().area,
            segment.strain, segment.plasticStrain, a.slip, b.slip, a.bondForce, b.bondForce,
            segment.broken, sliding, dowels, norm(a.moment), norm(b.moment)})
        text += fmt::format(",{:.17g}", value);
      text += "\n";
    }
  return text;
}

void TablesObserver::write(const Solver& solver)
{
  TimedRegion region("coplane::output::tables");
  const auto append = [&](TextTable& table, const std::string& lines)
  {
    solver.comm().together(
        [&]
        {
          if (table.isOpen())
            table.add(lines);
        });
  };
  if (options_.blocks)
    append(blocks_, blockLines(solver));
  if (options_.pairs)
    append(pairs_, pairLines(solver));
  if (options_.materials)
    append(materials_, materialLines(solver));
  if (options_.lines)
    append(lines_, segmentLines(solver));
  lastCycle_ = solver.clock().cycle;
}
} // namespace coplane
