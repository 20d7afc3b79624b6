#include "TestDecks.hpp"

#include <coplane_input/detail/DeckSchema.hpp>
#include <coplane_joint/JointModel.hpp>
#include <coplane_material/MaterialModel.hpp>
#include <coplane_schema/Schema.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <set>
#include <sstream>

namespace coplane
{
namespace
{
// A deck with one card of each model, so that each key has a place. Cards are named after their
// models.
const std::string deckOfAllModels = R"(mesh: a.e
materials:
  linear_elastic: {model: linear_elastic, density: 1, youngs_modulus: 1, poisson_ratio: 0}
  j2: {model: j2, density: 1, youngs_modulus: 1, poisson_ratio: 0, yield_stress: 1}
  concrete: {model: linear_elastic, density: 1, youngs_modulus: 1, poisson_ratio: 0}
  table: {model: j2, density: 1, youngs_modulus: 1, poisson_ratio: 0, plastic_strains: [0, 0.02, 0.2],
    yield_stresses: [1e8, 2e8, 3e8]}
  porous: {model: j2, density: 1, youngs_modulus: 1, poisson_ratio: 0, yield_stress: 1, eos: p_alpha, sound_speed: 9,
    shock_slope: 1, grueneisen: 1, distension: 2, crush_start: 1e8, crush_end: 1e9}
  drucker_prager: {model: drucker_prager, density: 1, youngs_modulus: 1, poisson_ratio: 0, cohesion: 4e6, friction: 0.5,
    dilation: 0.1}
  mohr_coulomb: {model: mohr_coulomb, density: 1, youngs_modulus: 1, poisson_ratio: 0, cohesion: 4e6, friction: 0.5,
    tensile_strength: 1e6}
  ubiquitous_joints: {model: ubiquitous_joints, density: 1, youngs_modulus: 1, poisson_ratio: 0, cohesion: 4e6,
                      friction: 0.5, joint_normal: [1, 1, 0], joint_cohesion: 2e6, joint_friction: 0.4}
  hoek_brown: {model: hoek_brown, density: 1, youngs_modulus: 1e9, poisson_ratio: 0, intact_strength: 60e6,
               intact_constant: 10, gsi: 60, residual_gsi: 30, shear_energy: 5e3}
  rock: {model: mohr_coulomb, density: 1, youngs_modulus: 1, poisson_ratio: 0, plastic_shears: [0, 0.1],
    cohesions: [3e6, 2e6], frictions: [0.6, 0.3]}
  johnson_cook: {model: johnson_cook, density: 1, youngs_modulus: 1, poisson_ratio: 0, yield_stress: 1, heat_capacity: 1}
  pseudo_cap: {model: pseudo_cap, density: 1, youngs_modulus: 30e9, poisson_ratio: 0.2, compressive_strength: 45e6,
    tensile_strength: 3e6, fracture_energy: 100, porosity: 0.1, grain_modulus: 45e9, crush_pressure: 90e6,
    crush_hardening: 200e6}
  fast: {set: concrete_c40, rate_effects: true, largest_rate: 200, damage_exponent: 2, crack_closure: true}
  hjc: {model: hjc, density: 1, shear_modulus: 15e9, compressive_strength: 50e6, tensile_strength: 5e6, cohesive_factor: 0.8,
    pressure_factor: 1.5, pressure_exponent: 0.6, largest_strength: 6, least_fracture_strain: 0.02, damage_factor: 0.05,
    crush_pressure: 20e6, crush_compression: 0.002, lock_pressure: 900e6, lock_compression: 0.12,
    lock_moduli: [80e9, -170e9, 200e9]}
  jh2: {model: jh2, density: 1, shear_modulus: 90e9, bulk_moduli: [130e9, 10e9, 0], elastic_limit: 2.8e9,
    elastic_limit_pressure: 1.5e9, tensile_strength: 0.1e9, intact_factor: 0.9, intact_exponent: 0.5, damage_factor: 0.01}
  kcc: {model: kcc, density: 1, compressive_strength: 50e6, rate_effects: true, largest_rate: 200}
  fluid: {model: fluid, density: 1, eos: linear, sound_speed: 9}
  ideal_gas: {model: ideal_gas, density: 1, heat_ratio: 1.6, pressure: 2e5}
  jwl: {model: jwl, density: 1640, jwl_a: 375e9, jwl_b: 3.3e9, jwl_r1: 4.16, jwl_r2: 0.96, omega: 0.31,
    detonation_energy: 7.1e9, detonation_speed: 6950, detonation_pressure: 21.2e9, bulk_modulus: 8e9,
    lighting_points: [[1, 0, 0]], lighting_times: [1e-6]}
blocks:
  a: {material: j2, erosion: {variables: {energy: {above: 1}}}, damping: {ratio: 0.05, low: 1, high: 10}}
  b: {material: j2}
  c: {material: j2, rigid: true}
  tool: {material: j2, rigid: true}
  core: {material: j2}
  lining: {material: j2}
joints:
  penalty: {model: penalty, friction: 0.7, dynamic_friction: 0.5, slip_speed: 0.2, dilation: 0.05}
  linear: {model: linear, normal_stiffness: 1}
  table: {model: table, closures: [1, 2], tractions: [1, 3]}
  barton_bandis: {model: barton_bandis, roughness: 8, wall_strength: 100e6, residual_friction: 0.6, peak_slip: 1e-3}
  mortar: {model: mortar, normal_stiffness: 8e10, tensile_strength: 2e5, cohesion: 4e5, tension_energy: 18,
    shear_energy: 125, maximum_closure: 1e-4}
  bilinear: {model: bilinear, normal_stiffness: 8e10, tensile_strength: 2e5, tension_energy: 18, shear_energy: 125}
  closure_curve: {model: closure_curve, initial_stiffness: 1, maximum_closure: 1}
  dry: {}
  crushed: {model: mortar, normal_stiffness: 8e10, tensile_strength: 2e5, cohesion: 4e5, tension_energy: 18,
    shear_energy: 125, compressive_strength: 1e7, compression_energy: 6e3, peak_crushing: 1e-4, residual_compression: 0.2,
    shear_in_crushing: 4}
  glued: {model: linear, normal_stiffness: 1, tensile_strength: 2e5}
  bent: {model: mortar, normal_stiffness: 8e10, tensile_strength: 2e5, cohesion: 4e5, tension_energy: 18,
    shear_energy: 125, stiffness_loss: 1}
contact:
  pairs:
    - {blocks: [a, b]}
    - {materials: [j2, j2]}
    - {side_sets: [a, a]}
    - {joint_set: a}
conditions:
  - {type: symmetry, node_set: a, normal: [1, 0, 0]}
  - {type: velocity, node_set: a, value: [0, 0, 0]}
  - {type: pressure, side_set: a, value: 0}
  - {type: fixed, node_set: a}
  - {type: traction, side_set: a, value: [0, 0, 0]}
  - {type: absorbing, side_set: a}
  - {type: displacement, node_set: a, value: [0, 0, 0]}
  - {type: rigid_motion, block: c, velocity: [0, 0, 0]}
  - {type: air_blast, side_set: a, charge_mass: 1, charge_place: [0, 0, 0]}
  - {type: acceleration, node_set: a, value: [0, 0, 0]}
  - {type: free_field, side_set: a}
initial: [{block: a, stress_gradient: [1, 0, 0, 0, 0, 0]}]
damping: {local: 0.5, until_energy_ratio: 1e-9}
time: {end: 1}
history: {probes: [{name: a, node_set: a}, {name: foot, block: b}, {name: c, point: [0, 0, 0]},
    {name: d, plane: [0, 0, 0]}, {name: e, between: [[0, 0, 0], [1, 0, 0]]}]}
)";
// What needs stages, and what does not go with them.
const std::string deckWithStages =
    deckOfAllModels + "stages: [{name: a, until: 0.25}, {name: b, until: 0.75}]\n";
const std::string deckWithLines =
    deckWithStages.substr(0, deckWithStages.rfind("}]")) + "}, {name: heading}]\n" + R"(lines:
  bolt:
    {points: [[0, 0, 0], [0, 0, 9]], segment_length: 1, area: 1e-3, youngs_modulus: 100e9, copy_step: [1, 0, 0],
     grout: {stiffness: 1e9, friction: 0.1, perimeter: 0.2}, dowel: {stiffness: 1e7}}
)";

void show(std::string& out, const std::string& value)
{
  out += "'" + value + "' ";
}
void show(std::string& out, Real value)
{
  out += fmt::format("{} ", value);
}
void show(std::string& out, int value)
{
  out += fmt::format("{} ", value);
}
void show(std::string& out, bool value)
{
  out += fmt::format("{} ", value);
}
void show(std::string& out, const std::optional<Real>& v)
{
  out += v ? fmt::format("{} ", *v) : "- ";
}
void show(std::string& out, const Vec3& v)
{
  out += fmt::format("[{} {} {}] ", v.x, v.y, v.z);
}
void show(std::string& out, const std::optional<Vec3>& v)
{
  if (v)
    show(out, *v);
}
void show(std::string& out, const TimeFunction& f)
{
  out += fmt::format("'{}'|{}|{}|{} ", f.expression, f.constant, fmt::join(f.times, " "),
                     fmt::join(f.values, " "));
}
void show(std::string& out, const std::optional<std::array<PlaceFunction, 3>>& v)
{
  out += "field ";
  if (v)
    for (const auto& function : *v)
      show(out, function);
}
template <class T, std::size_t n>
void show(std::string& out, const std::array<T, n>& values)
{
  for (const auto& value : values)
    show(out, value);
}
void show(std::string& out, const std::vector<Real>& values)
{
  for (const Real value : values)
    show(out, value);
}
template <class... T>
void showAll(std::string& out, const T&... values)
{
  (show(out, values), ...);
  out += "\n";
}

/// All fields of a deck that keys fill. A key whose field is not here fails the test below.
std::string show(const Deck& d)
{
  std::string out;
  showAll(out, d.title, d.mesh, d.gravity, d.viscosityLinear, d.viscosityQuadratic, d.massDamping,
          d.localDamping, d.kineticDamping, d.dampingFrom, d.dampingUntil, d.dampingEnergyRatio,
          d.dampingForceRatio, d.partitionMethod, d.partitionBalance, d.rebalance, d.rebalanceEvery,
          d.rebalanceAbove, d.geometry, d.time.endAtRest, d.checkpoint.file,
          d.checkpoint.everyCycles, d.checkpoint.everySeconds, d.checkpoint.atEnd);
  for (const auto& m : d.materials)
  {
    showAll(out, m.name, m.set, m.model);
    for (const Key& key : findModel(materialModels(), m.model)->keys)
      showAll(out, key.show(m.parameters.get()));
  }
  for (const auto& b : d.blocks)
  {
    showAll(out, b.name, b.material, b.element, b.objectiveRate, b.hourglassStiffness,
            b.hourglassViscosity, b.rigid);
    const auto& e = b.erosion;
    showAll(out, e.damage, e.plasticStrain, e.volumeRatio, e.stableStep);
    const auto& d = b.damping;
    showAll(out, d.ratio, d.low, d.high, d.elements, d.volumetric);
    for (const auto& v : e.variables)
      showAll(out, v.name, v.above, v.below);
  }
  for (const auto& j : d.joints)
  {
    showAll(out, j.name, j.model);
    for (const Key& key : findModel(jointModels(), j.model)->keys)
      showAll(out, key.show(j.parameters.get()));
  }
  const auto& c = d.contact;
  showAll(out, c.enabled, c.preset, c.forces, c.impulses, c.area, c.weights, c.closure, c.couple,
          c.areaRule, c.inherit, c.shareNode, c.initialOverlap, c.lostContact, c.debris,
          c.cosOpposed, c.depthMax, c.areaMin, c.skin, c.searchEvery, c.dampNormal, c.dampShear,
          c.defaultJoint);
  for (const auto& p : c.pairs)
    showAll(out, p.blocks, p.materials, p.sideSets, p.jointSet, p.joint, p.declared, p.excluded);
  for (const auto& k : d.conditions)
    showAll(out, k.type, k.set, k.components, k.velocity, k.displacement, k.acceleration, k.normal,
            k.pressure, k.traction, k.incident, k.translation, k.spin, k.burst, k.chargeMass,
            k.chargePlace, k.detonationTime, k.from, k.until);
  for (const auto& i : d.initial)
    showAll(out, i.block, i.velocity, i.angularVelocity, i.center, i.velocityField, i.stress,
            i.stressGradient, i.stressAxis, i.stressPoint);
  showAll(out, d.time.end, d.time.stepFactor, d.time.maximumStep, d.time.fixedStep,
          d.time.scaledStep, d.time.scalingLimit, d.time.scalingWithWaves, d.time.subcyclingLevels,
          d.time.energyTolerance, d.time.contactGainTolerance);
  showAll(out, d.output.results, d.output.every, d.output.planes, d.output.planesFormat,
          d.output.filePerRank, d.output.lines, d.output.fragments, d.output.fragmentDamage);
  for (const Real t : d.output.times)
    showAll(out, t);
  showAll(out, fmt::format("{}", fmt::join(d.output.variables, " ")));
  showAll(out, d.history.file, d.history.every);
  for (const auto& name : d.history.joints)
    showAll(out, name);
  for (const auto& name : d.history.tables)
    showAll(out, name);
  for (const auto& name : d.history.rigid)
    showAll(out, name);
  for (const auto& p : d.history.probes)
  {
    for (const auto& point : p.between)
      showAll(out, point);
    showAll(out, p.name, p.nodeSet, p.block, p.reaction, p.relativeTo, p.point, p.plane, p.joint,
            p.count, fmt::format("{}", fmt::join(p.variables, " ")));
  }
  for (const auto& s : d.stages)
    showAll(out, s.name, s.until, s.atRest, fmt::format("{}", fmt::join(s.remove, " ")),
            fmt::format("{}", fmt::join(s.add, " ")), s.zeroDisplacements);
  for (const auto& l : d.lines)
  {
    for (const auto& point : l.points)
      showAll(out, point);
    showAll(out, l.name, l.attach, l.segmentLength, l.area, l.youngsModulus, l.yieldStress,
            l.hardeningModulus, l.rateExponent, l.referenceRate, l.ruptureStrain, l.compression,
            l.diameter, l.mirrored, l.groutStiffness, l.groutStrength, l.groutFriction,
            l.groutPerimeter, l.plate, l.freeLength, l.dowelStiffness, l.dowelStrength,
            l.pretension, l.pretensionTime, l.spacing, l.copies, l.copyStep, l.from, l.until,
            l.stage);
  }
  return out;
}

struct Leaf
{
  std::string path; // in deckOfAllModels
  Key key;
};

/// The card of deckOfAllModels that has room for a key: of its model where it has one.
std::string cardFor(const Key& group, const Key& key)
{
  if (group.kind == KeyKind::Group)
    return "";
  if (group.name == "blocks")
    return key.name == "rigid" ? ".b" : ".a";
  if (group.name == "variables")
    return ".energy";
  if (group.name == "materials")
    return key.models.empty() ? ".concrete" : "." + key.models[0];
  if (group.name == "joints")
    return key.models.empty() ? ".penalty" : "." + key.models[0];
  if (group.name == "conditions")
    return key.appliesTo("pressure")       ? ".2"
           : key.appliesTo("traction")     ? ".4"
           : key.appliesTo("absorbing")    ? ".5"
           : key.appliesTo("fixed")        ? ".3"
           : key.appliesTo("velocity")     ? ".1"
           : key.appliesTo("displacement") ? ".6"
           : key.appliesTo("rigid_motion") ? ".7"
           : key.appliesTo("air_blast")    ? ".8"
           : key.appliesTo("acceleration") ? ".9"
           : key.appliesTo("free_field")   ? ".10"
                                           : ".0";
  if (group.name == "probes")
    return key.name == "block" || key.name == "variables" ? ".1"
           : key.name == "point"                          ? ".2"
           : key.name == "plane" || key.name == "joint"   ? ".3"
           : key.name == "between" || key.name == "count" ? ".4"
                                                          : ".0";
  if (group.name == "lines")
    return ".bolt";
  return group.name == "stages" ? ".1" : ".0";
}

/// All keys with values but those that decide about others, of which each value is in
/// deckOfAllModels, and `define` and changes, which act through others.
void collect(const Key& group, const std::string& path, std::vector<Leaf>& leaves)
{
  for (const auto& key : group.keys)
  {
    const std::string here = path + (path.empty() ? "" : cardFor(group, key) + ".") + key.name;
    if (key.isGroup())
      collect(key, here, leaves);
    else if (key.name != group.discriminator && key.kind != KeyKind::Definitions &&
             key.kind != KeyKind::Changes)
      leaves.push_back({here, key});
  }
}

TEST(DeckKeys, eachKeyActsOnTheDeck)
{
  std::vector<Leaf> leaves;
  collect(deckSchema(), "", leaves);
  EXPECT_GT(leaves.size(), 60u); // the walk does find the schema
  // Bodies of revolution are not rigid.
  std::istringstream lines(deckOfAllModels);
  std::string withoutRigid;
  for (std::string line; std::getline(lines, line);)
    if (line.find("rigid") == std::string::npos)
      withoutRigid += line + "\n";
  std::string withScaling = deckOfAllModels;
  const std::string timeCard = "time: {end: 1}";
  withScaling.replace(withScaling.find(timeCard), timeCard.size(),
                      "time: {end: 1, mass_scaling: {step: 1e-6}}");
  for (const char* type : {"absorbing, side_set: a", "free_field, side_set: a",
                           "acceleration, node_set: a, value: [0, 0, 0]"})
  {
    const std::string wave = fmt::format("  - {{type: {}}}\n", type);
    withScaling.replace(withScaling.find(wave), wave.size(), "");
  }
  std::string withoutRest = deckOfAllModels; // where nothing is damped to rest
  const std::string damping = "\ndamping: {";
  const std::size_t begin = withoutRest.find(damping);
  withoutRest.replace(begin, withoutRest.find('\n', begin + 1) - begin, "");
  std::string withoutPlanes = deckOfAllModels; // a probe of planes demands that there are some
  const std::string planeProbe = "{name: d, plane: [0, 0, 0]}, ";
  withoutPlanes.replace(withoutPlanes.find(planeProbe), planeProbe.size(), "");
  const std::string withFragments = deckOfAllModels + std::string("output: {fragments: true}\n");
  for (const auto& [path, key] : leaves)
  {
    // Items of contact.pairs name faces in one way only, and some keys of materials need others.
    std::string place = path;
    const std::pair<const char*, const char*> others[] = {
        {"materials.concrete.set", "materials.pseudo_cap.set"},
        {"materials.mohr_coulomb.plastic_shears", "materials.rock.plastic_shears"},
        {"materials.mohr_coulomb.cohesions", "materials.rock.cohesions"},
        {"materials.mohr_coulomb.frictions", "materials.rock.frictions"},
        {"materials.pseudo_cap.largest_rate", "materials.fast.largest_rate"},
        {"materials.j2.plastic_strains", "materials.table.plastic_strains"},
        {"materials.j2.yield_stresses", "materials.table.yield_stresses"},
        {"materials.j2.sound_speed", "materials.porous.sound_speed"},
        {"materials.j2.shock_slope", "materials.porous.shock_slope"},
        {"materials.j2.grueneisen", "materials.porous.grueneisen"},
        {"materials.j2.distension", "materials.porous.distension"},
        {"materials.j2.crush_start", "materials.porous.crush_start"},
        {"materials.j2.crush_end", "materials.porous.crush_end"},
        {"joints.mortar.compressive_strength", "joints.crushed.compressive_strength"},
        {"joints.mortar.compression_energy", "joints.crushed.compression_energy"},
        {"joints.mortar.peak_crushing", "joints.crushed.peak_crushing"},
        {"joints.mortar.residual_compression", "joints.crushed.residual_compression"},
        {"joints.mortar.shear_in_crushing", "joints.crushed.shear_in_crushing"},
        {"joints.linear.resists_bending", "joints.glued.resists_bending"},
        {"joints.mortar.resists_bending", "joints.bent.resists_bending"},
        {"contact.pairs.0.materials", "contact.pairs.1.materials"},
        {"contact.pairs.0.side_sets", "contact.pairs.2.side_sets"},
        {"contact.pairs.0.joint_set", "contact.pairs.3.joint_set"}};
    for (const auto& [from, to] : others)
      if (path == from)
        place = to;
    const std::string assignment = place + "=" + key.example;
    const std::string& deck = path == "geometry"                        ? withoutRigid
                              : path == "contact.enabled"               ? withoutPlanes
                              : path == "output.fragment_damage"        ? withFragments
                              : path.rfind("time.mass_scaling", 0) == 0 ? withScaling
                              : path.rfind("time.subcycling", 0) == 0   ? withoutRest
                              : path.rfind("stages", 0) == 0            ? deckWithStages
                              : path.rfind("lines", 0) == 0 || path == "output.lines"
                                  ? deckWithLines
                                  : deckOfAllModels;
    try
    {
      EXPECT_NE(show(parseDeck(deck, "x.yaml")), show(parseDeck(deck, "x.yaml", {assignment})))
          << assignment;
    }
    catch (const Error& e)
    {
      ADD_FAILURE() << assignment << " is refused: " << e.what();
    }
  }
}

TEST(DeckKeys, modelsAndTypesActOnTheDeck)
{
  const Deck deck = parseDeck(deckOfAllModels, "x.yaml");
  EXPECT_EQ(deck.materials[0].model, "linear_elastic");
  EXPECT_EQ(deck.materials[1].model, "j2");
  EXPECT_EQ(deck.joints[0].model, "penalty");
  EXPECT_EQ(deck.joints[1].model, "linear");
  EXPECT_EQ(deck.joints[2].model, "table");
  EXPECT_EQ(deck.joints[3].model, "barton_bandis");
  EXPECT_EQ(deck.joints[4].model, "mortar");
  EXPECT_EQ(deck.joints[5].model, "bilinear");
  EXPECT_EQ(deck.joints[6].model, "closure_curve");
  EXPECT_EQ(deck.conditions[0].type, "symmetry");
  EXPECT_EQ(deck.conditions[1].type, "velocity");
  EXPECT_EQ(deck.conditions[2].type, "pressure");
  EXPECT_EQ(deck.conditions[3].type, "fixed");
  EXPECT_EQ(deck.conditions[4].type, "traction");
  EXPECT_EQ(deck.conditions[5].type, "absorbing");
  EXPECT_EQ(deck.conditions[6].type, "displacement");
  EXPECT_EQ(deck.conditions[7].type, "rigid_motion");
  EXPECT_EQ(deck.conditions[10].type, "free_field");
}

void eachKey(const Key& group, const std::function<void(const Key& group, const Key& key)>& action)
{
  for (const auto& key : group.keys)
  {
    action(group, key);
    eachKey(key, action);
  }
}

TEST(DeckKeys, eachKeyIsDocumented)
{
  eachKey(deckSchema(),
          [](const Key&, const Key& key)
          {
            EXPECT_FALSE(key.meaning.empty()) << key.name;
            EXPECT_TRUE(key.isGroup() || !key.example.empty()) << key.name;
            const bool number = key.kind == KeyKind::Number || key.kind == KeyKind::Integer ||
                                key.kind == KeyKind::Numbers || key.kind == KeyKind::TimeFunction ||
                                key.kind == KeyKind::TimeFunctions ||
                                key.kind == KeyKind::PlaceFunctions;
            EXPECT_EQ(number, !key.unit.empty()) << key.name << " [" << key.unit << "]";
          });
}

/// Names that other programs have for models lead to one model, and hide none of ours.
template <class Model>
void expectClearHabits(const std::vector<Model>& models)
{
  std::set<std::string> seen;
  for (const Model& model : models)
    for (const std::string& habit : model.habits)
    {
      EXPECT_EQ(findModel(models, habit), nullptr) << habit;
      EXPECT_TRUE(seen.insert(habit).second) << habit;
    }
}

TEST(DeckKeys, namesOfModelsInOtherProgramsAreClear)
{
  expectClearHabits(materialModels());
  expectClearHabits(jointModels());
}

TEST(DeckKeys, modelsOfAKeyAreChoicesOfItsGroup)
{
  eachKey(deckSchema(),
          [](const Key& group, const Key& key)
          {
            for (const auto& model : key.models)
            {
              bool known = false;
              for (const auto& other : group.keys)
                if (other.name == group.discriminator)
                  for (const auto& word : other.choices)
                    known = known || word == model;
              EXPECT_TRUE(known) << group.name << "." << key.name << ": " << model;
            }
          });
}
} // namespace
} // namespace coplane
