#include "TwoCubes.hpp"

#include <coplane_output/HistoryObserver.hpp>
#include <coplane_output/MultiObserver.hpp>
#include <coplane_output/PlanesObserver.hpp>
#include <coplane_output/ProgressObserver.hpp>
#include <coplane_output/ResultsObserver.hpp>
#include <coplane_output/RunRecord.hpp>
#include <coplane_output/TablesObserver.hpp>

#include <exodusII.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>

namespace coplane
{
namespace
{
constexpr int cycles = 20;
constexpr Real endOfRun = 1e3; // of which the model has a stage [s]

/// Runs the two cubes and writes everything to files that start with `base`.
void run(const Comm& comm, const std::string& base)
{
  const Mesh mesh = twoCubes();
  const MeshSlice slice = sliceOf(mesh, comm.rank(), comm.size());
  Solver solver(cubesInContact(mesh, comm), comm);
  const OutputTimes when{1e-3, {}};
  MultiObserver observers;
  observers.add(std::make_unique<ResultsObserver>(
      comm, slice, ResultsOptions{base + ".e", when, false, {"command: test"}}));
  observers.add(
      std::make_unique<PlanesObserver>(comm, PlanesOptions{base, when, "", "", PlanesFormat::Vtp}));
  observers.add(std::make_unique<PlanesObserver>(comm, PlanesOptions{base, when}));
  HistoryOptions history{base + ".csv", 0, {{"top", 0, -1}, {"lower", -1, 0}}, {"rough"}, true};
  observers.add(std::make_unique<HistoryObserver>(comm, history));
  observers.add(std::make_unique<TablesObserver>(comm, TablesOptions{base, 0, true, true, true}));
  auto record =
      std::make_unique<RunRecord>(comm, RunRecordOptions{base + ".run.json", "two cubes", "test",
                                                         "a.yaml", "abc", "a.g", "", endOfRun});
  RunRecord* const ofRun = record.get();
  observers.add(std::move(record));
  observers.add(std::make_unique<ProgressObserver>(ProgressOptions{0, endOfRun}, ofRun));
  solver.prepare();
  observers.start(solver);
  for (int cycle = 0; cycle < cycles; ++cycle)
  {
    solver.advance();
    observers.endOfCycle(solver);
    if (cycle + 1 == cycles && comm.isRoot())
      std::filesystem::copy_file(base + ".run.json", base + ".running.json");
  }
  observers.finish(solver, {});
}

/// Files of a run on all ranks ("all") and of one on rank 0 alone ("one"), made once.
class Files : public ::testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    const Comm world;
    folder_ = std::make_unique<TestFolder>(world);
    run(world, file("all"));
    if (world.isRoot())
      run(Comm(MPI_COMM_SELF), file("one"));
    world.barrier();
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static std::string file(const std::string& name) { return *folder_ / name; }

  void SetUp() override
  {
    if (!Comm().isRoot())
      GTEST_SKIP() << "rank 0 looks at the files";
  }

private:
  static std::unique_ptr<TestFolder> folder_;
};
std::unique_ptr<TestFolder> Files::folder_;

struct CsvFile
{
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> lines;

  explicit CsvFile(const std::string& file)
  {
    std::ifstream stream(file);
    std::string line;
    while (std::getline(stream, line))
    {
      std::vector<std::string> cells;
      std::stringstream text(line);
      for (std::string cell; std::getline(text, cell, ',');)
        cells.push_back(cell);
      if (names.empty())
        names = cells;
      else
        lines.push_back(cells);
    }
  }
  std::string text(int line, const std::string& name) const
  {
    for (std::size_t c = 0; c < names.size(); ++c)
      if (names[c] == name)
        return lines[line][c];
    ADD_FAILURE() << "no column " << name;
    return "0";
  }
  Real number(int line, const std::string& name) const { return std::stod(text(line, name)); }
};

/// All values of all variables of an Exodus file, by kind, variable and step.
class Exodus
{
public:
  explicit Exodus(const std::string& file)
  {
    int memoryWord = 8, fileWord = 0;
    float version = 0;
    id_ = ex_open(file.c_str(), EX_READ, &memoryWord, &fileWord, &version);
  }
  ~Exodus() { ex_close(id_); }
  int steps() const { return int(ex_inquire_int(id_, EX_INQ_TIME)); }
  int variables(ex_entity_type type) const
  {
    int count = 0;
    ex_get_variable_param(id_, type, &count);
    return count;
  }
  std::string name(ex_entity_type type, int variable) const
  {
    char text[256] = {};
    ex_get_variable_name(id_, type, variable + 1, text);
    return text;
  }
  std::vector<Real> values(int step, ex_entity_type type, const std::string& wanted, int entity,
                           int count) const
  {
    std::vector<Real> list(count, -1);
    int v = 0;
    while (v < variables(type) && name(type, v) != wanted)
      ++v;
    EXPECT_GE(ex_get_var(id_, step + 1, type, v + 1, entity, count, list.data()), 0) << wanted;
    return list;
  }
  Real time(int step) const
  {
    Real t = -1;
    ex_get_time(id_, step + 1, &t);
    return t;
  }

private:
  int id_ = -1;
};

bool sameBits(const std::vector<Real>& a, const std::vector<Real>& b)
{
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Real)) == 0;
}
} // namespace

TEST_F(Files, resultsHaveTheSameBitsOnAnyNumberOfRanks)
{
  const Mesh mesh = twoCubes();
  const Exodus all(file("all.e")), one(file("one.e"));
  ASSERT_EQ(all.steps(), one.steps());
  ASSERT_GT(all.variables(EX_NODAL), 10);
  ASSERT_GT(all.variables(EX_ELEM_BLOCK), 10);
  ASSERT_EQ(all.variables(EX_SIDE_SET), 7);
  const auto compare = [&](int step, ex_entity_type type, int entity, int count)
  {
    for (int v = 0; v < all.variables(type); ++v)
    {
      const std::string name = all.name(type, v);
      EXPECT_TRUE(sameBits(all.values(step, type, name, entity, count),
                           one.values(step, type, name, entity, count)))
          << name << " in step " << step;
    }
  };
  for (int step = 0; step < all.steps(); ++step)
  {
    EXPECT_EQ(all.time(step), one.time(step));
    compare(step, EX_NODAL, 1, mesh.nodes());
    for (const Mesh::Block& block : mesh.blocks)
      compare(step, EX_ELEM_BLOCK, int(block.id), block.elements());
    for (const Mesh::SideSet& set : mesh.sideSets)
      compare(step, EX_SIDE_SET, int(set.id), int(set.sides.size()));
    const int globals = all.variables(EX_GLOBAL);
    EXPECT_TRUE(sameBits(all.values(step, EX_GLOBAL, "time_step", 1, globals),
                         one.values(step, EX_GLOBAL, "time_step", 1, globals)));
  }
}

TEST_F(Files, planesAreTheSameBytesOnAnyNumberOfRanks)
{
  // The series name their own steps: base names differ, so they are made alike.
  std::string all = contentOf(file("all_planes.pvd"));
  for (std::size_t at; (at = all.find("\"all_")) != std::string::npos;)
    all.replace(at, 5, "\"one_");
  EXPECT_EQ(all, contentOf(file("one_planes.pvd")));
  int steps = 0;
  for (;; ++steps)
  {
    const std::string name = fmt::format("_planes_{:04}.vtp", steps);
    if (!std::filesystem::exists(file("one" + name)))
      break;
    EXPECT_EQ(contentOf(file("all" + name)), contentOf(file("one" + name))) << name;
  }
  EXPECT_EQ(steps, Exodus(file("one.e")).steps());
}

TEST_F(Files, planesInOneFileAreTheSameBytesOnAnyNumberOfRanks)
{
  const std::string all = contentOf(file("all_planes.vtkhdf"));
  EXPECT_FALSE(all.empty());
  EXPECT_TRUE(all == contentOf(file("one_planes.vtkhdf")));
  // Every table of the index names the file.
  std::string index = contentOf(file("all_planes.xmf3"));
  for (std::size_t at; (at = index.find(">all_")) != std::string::npos;)
    index.replace(at, 5, ">one_");
  EXPECT_TRUE(index == contentOf(file("one_planes.xmf3")));
}

TEST_F(Files, historyIsTheSameTextOnAnyNumberOfRanks)
{
  const std::string all = contentOf(file("all.csv"));
  EXPECT_FALSE(all.empty());
  EXPECT_EQ(all, contentOf(file("one.csv")));
}

TEST_F(Files, tablesAreTheSameTextOnAnyNumberOfRanks)
{
  for (const char* table : {"_blocks.csv", "_pairs.csv", "_materials.csv"})
  {
    const std::string all = contentOf(file(std::string("all") + table));
    EXPECT_FALSE(all.empty());
    EXPECT_EQ(all, contentOf(file(std::string("one") + table))) << table;
  }
}

TEST_F(Files, tablesAddUpToTheHistory)
{
  const CsvFile history(file("all.csv"));
  const CsvFile blocks(file("all_blocks.csv")), pairs(file("all_pairs.csv")),
      materials(file("all_materials.csv"));
  ASSERT_EQ(blocks.lines.size(), 2 * history.lines.size());
  std::map<int, Real> kinetic, internal, friction, stored;
  for (int line = 0; line < int(blocks.lines.size()); ++line)
  {
    kinetic[int(blocks.number(line, "cycle"))] += blocks.number(line, "kinetic[J]");
    internal[int(blocks.number(line, "cycle"))] += blocks.number(line, "internal[J]");
  }
  // Both cubes are of one material: one line, with what all pairs of blocks have together.
  std::map<int, Real> frictionOfMaterial;
  for (int line = 0; line < int(materials.lines.size()); ++line)
  {
    EXPECT_EQ(materials.text(line, "material_a"), "stone");
    EXPECT_EQ(frictionOfMaterial.count(int(materials.number(line, "cycle"))), 0u);
    frictionOfMaterial[int(materials.number(line, "cycle"))] =
        materials.number(line, "friction[J]");
  }
  for (int line = 0; line < int(pairs.lines.size()); ++line)
  {
    friction[int(pairs.number(line, "cycle"))] += pairs.number(line, "friction[J]");
    stored[int(pairs.number(line, "cycle"))] += pairs.number(line, "stored[J]");
  }
  for (int cycle = 0; cycle <= cycles; ++cycle)
  {
    // The blocks share no node and the tables' sums are exact: a few roundings of 625 J.
    const Real roundings = 4 * epsilon * 625;
    EXPECT_NEAR(kinetic[cycle], history.number(cycle, "kinetic[J]"), roundings);
    EXPECT_NEAR(internal[cycle], history.number(cycle, "internal[J]"), roundings);
    EXPECT_NEAR(friction[cycle], history.number(cycle, "contact_friction[J]"), roundings);
    EXPECT_NEAR(frictionOfMaterial[cycle], friction[cycle], roundings);
    EXPECT_NEAR(stored[cycle], history.number(cycle, "contact_stored[J]"), roundings);
  }
  EXPECT_GT(history.number(cycles, "contact_friction[J]"), 0);
}

TEST_F(Files, jointColumnsHoldTheWholeContactWhenThereIsOneJoint)
{
  const CsvFile table(file("all.csv"));
  Real mostForce = 0;
  for (int line = 0; line <= cycles; ++line)
  {
    const auto value = [&](const char* name) { return table.number(line, name); };
    EXPECT_EQ(value("rough_friction[J]"), value("contact_friction[J]"));
    EXPECT_EQ(value("rough_stored[J]"), value("contact_stored[J]"));
    const Real area = value("rough_open_area[m^2]") + value("rough_stick_area[m^2]") +
                      value("rough_slip_area[m^2]");
    // Planes exist from the first touch on. The cubes share (1 - 0.125) (1 - 0.0625) m^2, and the
    // upper one has moved by less than 5 mm.
    if (value("planes") > 0)
    {
      EXPECT_NEAR(area, 0.875 * 0.9375, 0.01);
    }
    if (value("rough_slip_area[m^2]") + value("rough_stick_area[m^2]") > 0)
    {
      EXPECT_GT(value("rough_mean_closure[m]"), 0);
      EXPECT_GT(value("rough_normal_force[N]"), 0);
    }
    mostForce = std::max(mostForce, value("rough_normal_force[N]"));
  }
  EXPECT_GT(mostForce, 0);
}

TEST_F(Files, sidesTellTheForceOfTheContact)
{
  const Mesh mesh = twoCubes();
  const Exodus results(file("all.e"));
  const int during = 1;
  const int sides = 8;
  const auto of = [&](const char* name)
  { return results.values(during, EX_SIDE_SET, name, 7, sides); };
  const auto state = of("side_state"), fraction = of("side_area_fraction");
  const auto normal = of("side_normal_traction"), shear = of("side_shear_traction");
  const auto force = results.values(during, EX_NODAL, "contact_force_z", 1, mesh.nodes());
  Real upward = 0;
  for (int n = 27; n < 54; ++n) // the upper cube
    upward += force[n];
  Real onUpper = 0, onLower = 0;
  for (int i = 0; i < sides; ++i)
  {
    EXPECT_GE(state[i], 2);
    EXPECT_GT(fraction[i], 0);
    EXPECT_LT(fraction[i], 1.001); // the area of contact is that of the projection
    EXPECT_LE(shear[i], 0.25 * normal[i] * (1 + 1e-12));                // friction
    (i % 2 == 0 ? onUpper : onLower) += normal[i] * fraction[i] * 0.25; // faces of 0.5 x 0.5 m
  }
  // Faces are stretched and tilted by less than a per cent: strains of v / c = 1e-3.
  EXPECT_GT(upward, 0);
  EXPECT_NEAR(onUpper, upward, 0.01 * upward);
  EXPECT_NEAR(onLower, upward, 0.01 * upward);
  EXPECT_EQ(results.values(during, EX_SIDE_SET, "side_state", 8, 1)[0], 0); // not a face
}

TEST_F(Files, historyHasOneLinePerCycleAndOneForTheStart)
{
  const CsvFile table(file("all.csv"));
  ASSERT_EQ(table.lines.size(), std::size_t(cycles + 1));
  for (int line = 0; line <= cycles; ++line)
  {
    EXPECT_EQ(table.number(line, "cycle"), line);
    EXPECT_EQ(table.lines[line].size(), table.names.size());
  }
}

TEST_F(Files, energyErrorInTheHistoryIsWhatItsTermsLack)
{
  const CsvFile table(file("all.csv"));
  for (int line = 0; line <= cycles; ++line)
  {
    const auto value = [&](const char* name) { return table.number(line, name); };
    const Real contact = value("contact_stored[J]") + value("contact_friction[J]") +
                         value("contact_hysteresis[J]") + value("contact_fracture[J]") +
                         value("contact_damping[J]") + value("contact_eroded[J]") +
                         value("contact_remainder[J]");
    const Real total = value("kinetic[J]") + value("internal[J]") + value("hourglass[J]") +
                       value("viscous[J]") + value("eroded[J]") + contact +
                       value("mass_damping[J]") + value("local_damping[J]") +
                       value("kinetic_damping[J]");
    const Real error =
        total - value("external_work[J]") - value("chemical[J]") - value("initial[J]");
    // A dozen sums of terms up to the initial energy, 625 J.
    EXPECT_NEAR(error, value("error[J]"), 12 * epsilon * value("initial[J]"));
  }
}

TEST_F(Files, historyKnowsTheMomentumOfTheFallingCube)
{
  // 1 m^3 of 1000 kg/m^3 at (0.5, 0, -1) m/s and nothing outside: constant to round-off of about
  // 100 nodes and 20 cycles.
  const CsvFile table(file("all.csv"));
  for (int line = 0; line <= cycles; ++line)
  {
    EXPECT_NEAR(table.number(line, "momentum_x[N*s]"), 500, 1e-10);
    EXPECT_NEAR(table.number(line, "momentum_y[N*s]"), 0, 1e-10);
    EXPECT_NEAR(table.number(line, "momentum_z[N*s]"), -1000, 1e-10);
  }
}

TEST_F(Files, probesGiveMeanMotion)
{
  // At the start the nodes of the set 'top' have the upper cube's velocity, and the block 'lower'
  // is at rest. By symmetry of momentum its velocity afterwards is what the upper one has lost, for
  // equal masses; here only that it has begun to sink.
  const CsvFile table(file("all.csv"));
  EXPECT_DOUBLE_EQ(table.number(0, "top_velocity_x[m/s]"), 0.5);
  EXPECT_DOUBLE_EQ(table.number(0, "top_velocity_z[m/s]"), -1);
  EXPECT_EQ(table.number(0, "top_displacement_z[m]"), 0);
  EXPECT_EQ(table.number(0, "lower_velocity_z[m/s]"), 0);
  EXPECT_LT(table.number(cycles, "lower_velocity_z[m/s]"), -1e-3);
}

TEST_F(Files, resultsHoldStartDueTimesAndEnd)
{
  const CsvFile history(file("all.csv"));
  const Exodus results(file("all.e"));
  // Expected: the start, for every multiple of 1 ms the first cycle at or after it, the end.
  std::vector<Real> expected{0};
  int multiples = 0;
  for (int line = 1; line <= cycles; ++line)
  {
    const Real time = history.number(line, "time[s]");
    const int passed = int(time / 1e-3);
    if (passed > multiples || line == cycles)
      expected.push_back(time);
    multiples = passed;
  }
  ASSERT_GT(expected.size(), 3u);
  ASSERT_EQ(results.steps(), int(expected.size()));
  for (int step = 0; step < results.steps(); ++step)
    EXPECT_EQ(results.time(step), expected[step]);
}

TEST_F(Files, contactForcesInTheResultsBalanceAndPressTheCubesApart)
{
  const Mesh mesh = twoCubes();
  const Exodus results(file("all.e"));
  const int during = 1; // after 1 ms; waves cross a cube in about that time, and then it rebounds
  const auto force = results.values(during, EX_NODAL, "contact_force_z", 1, mesh.nodes());
  const auto pressure = results.values(during, EX_NODAL, "contact_pressure", 1, mesh.nodes());
  const auto state = results.values(during, EX_NODAL, "contact_state", 1, mesh.nodes());
  Real upward = 0, sum = 0;
  for (int n = 0; n < mesh.nodes(); ++n)
  {
    sum += force[n];
    if (mesh.coordinates[n].z == 1 && n >= 27) // of the upper cube, which has nodes 27 and more
    {
      upward += force[n];
      EXPECT_GT(pressure[n], 0);
      EXPECT_GE(state[n], 2); // stick or slip
    }
    if (mesh.coordinates[n].z == 2)
    {
      EXPECT_EQ(state[n], 0);
    }
  }
  EXPECT_GT(upward, 0);
  EXPECT_NEAR(sum, 0, 1e-12 * upward); // action equals reaction, 54 terms
}

TEST_F(Files, runRecordTellsHowTheRunEnded)
{
  const auto json = nlohmann::json::parse(contentOf(file("all.run.json")));
  EXPECT_EQ(json["ending"], "completed");
  EXPECT_EQ(json["exit_code"], 0);
  EXPECT_EQ(json["end_s"].get<Real>(), endOfRun);
  EXPECT_EQ(json["ranks"], Comm().size());
  EXPECT_EQ(json["placement"].size(), std::size_t(Comm().size()));
  EXPECT_EQ(json["sizes"]["nodes"], 54);
  EXPECT_EQ(json["sizes"]["elements"], 16);
  EXPECT_EQ(json["sizes"]["cycles"], cycles);
  EXPECT_EQ(json["deck"]["sha256"],
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"); // FIPS 180: "abc"
  const auto one = nlohmann::json::parse(contentOf(file("one.run.json")));
  EXPECT_EQ(json["state_hash"], one["state_hash"]);
  EXPECT_EQ(json["energies_J"], one["energies_J"]);
  EXPECT_EQ(json["census"], one["census"]);
  // 4 faces below; the cubes are shifted, so that every one of 4 above meets 1, 2 or 4 of them: 3 x
  // 3 pairs share area, and they touch without a gap.
  EXPECT_EQ(json["census"]["touching"], 9);
  EXPECT_EQ(json["census"]["overlapping"], 0);
  EXPECT_EQ(json["census"]["gaps"]["count"], 0);
}

TEST_F(Files, runRecordIsRenewedWhileTheRunGoesOn)
{
  const auto json = nlohmann::json::parse(contentOf(file("all.running.json")));
  EXPECT_EQ(json["ending"], "running");
  EXPECT_FALSE(json.contains("exit_code"));
  EXPECT_GT(json["seconds_left"].get<Real>(), 0);
  EXPECT_TRUE(json["messages"].is_array());
  EXPECT_TRUE(json["warnings"].is_object());
  std::int64_t looks = 0;
  for (const auto& limit : json["step_limits"])
  {
    EXPECT_NE(limit["limited_by"].get<std::string>().find("node"), std::string::npos) << limit;
    looks += limit["looks"].get<std::int64_t>();
  }
  EXPECT_EQ(looks, 1 + cycles); // at the start and with each line
  EXPECT_EQ(json["census"], nlohmann::json::parse(contentOf(file("all.run.json")))["census"]);
}
} // namespace coplane
