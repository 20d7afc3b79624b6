#include "detail/DeckSchema.hpp"

#include "ContactSchema.hpp"
#include "MaterialCards.hpp"
#include "detail/OutputSchema.hpp"

#include <coplane_input/Deck.hpp>
#include <coplane_schema/SchemaBuilder.hpp>

#include <algorithm>

namespace coplane
{
using namespace schema;

namespace
{
Key erosion()
{
  return group("erosion", &BlockCard::erosion,
               {
                   number("damage", &ErosionCard::damage)
                       .in("-")
                       .atLeast(0)
                       .below(1)
                       .defaultIs("damage is not asked for")
                       .like("0.99")
                       .means("only elements whose damage is above this die; the law has to have a "
                              "variable `damage`"),
                   number("plastic_strain", &ErosionCard::plasticStrain)
                       .in("-")
                       .above(0)
                       .defaultIs("no limit")
                       .like("1.5")
                       .means("limit of the equivalent plastic strain"),
                   numbers("volume_ratio", &ErosionCard::volumeRatio, 2)
                       .in("-")
                       .atLeast(0)
                       .defaultIs("no limit")
                       .like("[0.05, 4]")
                       .means("least and largest volume over the first one; a least one catches "
                              "elements that turn inside out"),
                   number("stable_step", &ErosionCard::stableStep)
                       .in("s")
                       .above(0)
                       .defaultIs("no limit")
                       .like("1e-9")
                       .means("least stable step of the element"),
                   named("variables", &ErosionCard::variables,
                         {
                             number("above", &ErosionVariableCard::above)
                                 .in("of the variable")
                                 .defaultIs("no limit")
                                 .like("0.5")
                                 .means("the limit is exceeded above this"),
                             number("below", &ErosionVariableCard::below)
                                 .in("of the variable")
                                 .defaultIs("no limit")
                                 .like("-0.1")
                                 .means("the limit is exceeded below this"),
                         })
                       .means("limits of the law's variables, by their names"),
               })
      .means("when elements of the block die: when damage is high enough, if that is asked for, "
             "and one of the limits, if there are any, is exceeded; without keys none dies");
}

Key blockDamping()
{
  return group("damping", &BlockCard::damping,
               {
                   number("ratio", &MaxwellCard::ratio)
                       .in("-")
                       .atLeast(0)
                       .below(0.2)
                       .like("0.02")
                       .means("ratio of critical damping between the two frequencies"),
                   number("low", &MaxwellCard::low)
                       .in("Hz")
                       .above(0)
                       .defaultIs("none")
                       .like("0.5")
                       .means("the lowest frequency"),
                   number("high", &MaxwellCard::high)
                       .in("Hz")
                       .above(0)
                       .defaultIs("none")
                       .like("20")
                       .means("the highest frequency"),
                   integer("elements", &MaxwellCard::elements)
                       .in("-")
                       .atLeast(1)
                       .atMost(4)
                       .like("2")
                       .means("Maxwell elements by which it is fitted; each stores six numbers "
                              "of an element"),
                   flag("volumetric", &MaxwellCard::volumetric)
                       .like("true")
                       .means("dilatation is damped, too, not the deviator of strain alone"),
               })
      .means(
          "Maxwell elements beside the law, which take a constant fraction of the energy in each "
          "cycle of strain and leave the step nearly as it is");
}

Key blocks()
{
  return named("blocks", &Deck::blocks,
               {
                   text("material", &BlockCard::material)
                       .needed()
                       .like("concrete")
                       .means("name of a card in materials, or of a set of the library"),
                   text("element", &BlockCard::element)
                       .oneOf({"one_point", "assumed_strain", "full_integration",
                               "full_integration_plain", "nodal_pressure"})
                       .like("assumed_strain")
                       .means("one_point: any shape; assumed_strain (bending), full_integration "
                              "(B-bar), full_integration_plain (locks, for comparison): "
                              "quadrilaterals and hexahedra; nodal_pressure: triangles and "
                              "tetrahedra that flow or are nearly incompressible"),
                   text("objective_rate", &BlockCard::objectiveRate)
                       .oneOf({"hughes_winget", "jaumann", "green_naghdi"})
                       .like("green_naghdi")
                       .means("how stress turns with the material"),
                   section("hourglass",
                           {
                               number("stiffness", &BlockCard::hourglassStiffness)
                                   .in("-")
                                   .usually(usual::fraction)
                                   .atLeast(0)
                                   .like("0.1")
                                   .means("stiffness against hourglass modes, relative to the "
                                          "P-wave modulus; "
                                          "the resistance yields with the material"),
                               number("viscosity", &BlockCard::hourglassViscosity)
                                   .in("-")
                                   .usually(usual::fraction)
                                   .atLeast(0)
                                   .like("0.02")
                                   .means("viscous resistance to hourglass modes"),
                           })
                       .onlyFor({"one_point"})
                       .means("control of the zero-energy modes of one-point elements"),
                   erosion(),
                   blockDamping(),
                   flag("rigid", &BlockCard::rigid)
                       .like("true")
                       .means("each connected part of the block moves as a rigid body; of its "
                              "material the density counts, and the moduli in contact"),
               })
      .needed()
      .decidedBy("element")
      .means("element blocks of the mesh, by the names that the mesh gives them; all "
             "blocks need a card");
}

Key conditions()
{
  const auto takeComponents = [](std::array<bool, 3>& field, const std::vector<std::string>& words)
  {
    const auto has = [&](const char* word)
    { return std::find(words.begin(), words.end(), word) != words.end(); };
    field = {has("x"), has("y"), has("z")};
  };
  const auto takeOne = [](TimeFunction& field, const std::vector<TimeFunction>& v)
  { field = v[0]; };
  const auto takeThree = [](std::array<TimeFunction, 3>& field, const std::vector<TimeFunction>& v)
  {
    field = {v[0], v[1], v[2]};
  };
  const auto vectorOfTime =
      [&](const std::string& name, std::array<TimeFunction, 3> ConditionCard::*member)
  {
    Key key = bound<std::vector<TimeFunction>>(name, KeyKind::TimeFunctions, member, takeThree);
    key.length = 3;
    return KeyBuilder(key);
  };
  const auto freeVectorOfTime =
      [](const std::string& name, std::optional<std::array<TimeFunction, 3>> ConditionCard::*member)
  {
    Key key = bound<std::vector<TimeFunction>>(
        name, KeyKind::TimeFunctions, member,
        [](std::optional<std::array<TimeFunction, 3>>& field, const std::vector<TimeFunction>& v) {
          field = {v[0], v[1], v[2]};
        });
    key.length = 3;
    return KeyBuilder(key);
  };
  const std::vector<std::string> withTimes{"fixed",     "velocity",  "displacement", "acceleration",
                                           "symmetry",  "pressure",  "traction",     "air_blast",
                                           "absorbing", "free_field"};
  return list(
             "conditions", &Deck::conditions,
             {
                 text("type", &ConditionCard::type)
                     .needed()
                     .oneOf({"fixed", "velocity", "displacement", "acceleration", "symmetry",
                             "pressure", "traction", "air_blast", "absorbing", "free_field",
                             "rigid_motion"})
                     .wordsElsewhere({{"encastre", "fixed"},
                                      {"pinned", "fixed"},
                                      {"clamped", "fixed"},
                                      {"spc", "fixed"},
                                      {"roller", "symmetry"},
                                      {"quiet", "absorbing"},
                                      {"viscous", "absorbing"},
                                      {"nonreflecting", "absorbing"},
                                      {"non_reflecting", "absorbing"},
                                      {"freefield", "free_field"},
                                      {"free-field", "free_field"}})
                     .like("fixed")
                     .means("fixed: no motion; velocity, displacement, acceleration: prescribed "
                            "motion; "
                            "symmetry: no motion "
                            "along the normal; pressure: follows the moving faces; traction: in "
                            "fixed axes; air_blast: pressure of the blast wave of a charge; "
                            "absorbing: waves leave through the faces; free_field: level ground "
                            "goes on beyond the vertical side and moves with its own base; "
                            "rigid_motion: "
                            "prescribed velocity and spin of the bodies of a rigid block"),
                 text("node_set", &ConditionCard::set)
                     .onlyFor({"fixed", "velocity", "displacement", "acceleration", "symmetry"})
                     .needed()
                     .means("node set of the mesh")
                     .like("base"),
                 text("side_set", &ConditionCard::set)
                     .onlyFor({"pressure", "traction", "air_blast", "absorbing", "free_field"})
                     .needed()
                     .means("side set of the mesh")
                     .like("top"),
                 text("block", &ConditionCard::set)
                     .onlyFor({"rigid_motion"})
                     .needed()
                     .means("rigid element block; each connected part of it is a body")
                     .like("tool"),
                 number("from", &ConditionCard::from)
                     .onlyFor(withTimes)
                     .in("s")
                     .atLeast(0)
                     .like("0.5")
                     .means("the condition acts for from <= t < until"),
                 number("until", &ConditionCard::until)
                     .onlyFor(withTimes)
                     .in("s")
                     .above(0)
                     .defaultIs("the end")
                     .like("1.5")
                     .means("time from which on it acts no more; nodes go on with the velocity "
                            "that they have"),
                 bound<std::vector<std::string>>("components", KeyKind::Texts,
                                                 &ConditionCard::components, takeComponents)
                     .onlyFor({"fixed", "velocity", "displacement", "acceleration", "rigid_motion"})
                     .oneOf({"x", "y", "z"})
                     .like("[x]")
                     .defaultIs("[x, y, z]")
                     .means("axes along which the condition acts"),
                 vectorOfTime("value", &ConditionCard::displacement)
                     .onlyFor({"displacement"})
                     .needed()
                     .ofPlaceToo()
                     .in("m")
                     .like("[{times: [0, 0.1], values: [0, 0.01]}, 0, 0]")
                     .means("displacement in x, y, z, of which its value at `from` is taken off; 0 "
                            "for components that are left free; x, y, z: place at t = 0"),
                 vectorOfTime("value", &ConditionCard::velocity)
                     .onlyFor({"velocity"})
                     .needed()
                     .ofPlaceToo()
                     .in("m/s")
                     .usually(usual::speed)
                     .like("[\"0.1*t\", 0, 0]")
                     .means("velocity in x, y, z; 0 for components that are left free; x, y, z: "
                            "place at t = 0"),
                 vectorOfTime("value", &ConditionCard::acceleration)
                     .onlyFor({"acceleration"})
                     .needed()
                     .ofPlaceToo()
                     .in("m/s^2")
                     .like("[{times: [0, 0.1, 0.2], values: [0, 3, 0], scale: 0.5}, 0, 0]")
                     .means("acceleration in x, y, z, which changes the velocity that the nodes "
                            "have; 0 for components that are left free; x, y, z: place at t = 0"),
                 freeVectorOfTime("velocity", &ConditionCard::translation)
                     .onlyFor({"rigid_motion"})
                     .in("m/s")
                     .defaultIs("free")
                     .like("[0, 0, \"-0.1*t\"]")
                     .means("velocity of the centre of each body, along the axes of components"),
                 freeVectorOfTime("angular_velocity", &ConditionCard::spin)
                     .onlyFor({"rigid_motion"})
                     .in("rad/s")
                     .defaultIs("free")
                     .like("[0, 0, {times: [0, 0.1], values: [0, 5]}]")
                     .means("spin of each body about its centre; in two dimensions about z"),
                 vectorOfTime("value", &ConditionCard::traction)
                     .onlyFor({"traction"})
                     .needed()
                     .ofPlaceToo()
                     .in("Pa")
                     .usually(usual::stress)
                     .like("[0, \"-1e5*min(t/0.01, 1)\", 0]")
                     .means("force per present area, in fixed axes; x, y, z: middle of the face at "
                            "t = 0"),
                 text("burst", &ConditionCard::burst)
                     .onlyFor({"air_blast"})
                     .oneOf({"surface", "air"})
                     .like("air")
                     .means("surface: a hemisphere on the ground, which reflects; air: a sphere "
                            "far from it"),
                 number("charge_mass", &ConditionCard::chargeMass)
                     .onlyFor({"air_blast"})
                     .needed()
                     .in("kg")
                     .above(0)
                     .like("100")
                     .means("mass of the charge, or that of the equivalent of TNT"),
                 vector("charge_place", &ConditionCard::chargePlace)
                     .onlyFor({"air_blast"})
                     .needed()
                     .in("m")
                     .like("[-10, 0, 0]")
                     .means("centre of the charge; on the ground where the burst is one of the "
                            "surface"),
                 number("detonation_time", &ConditionCard::detonationTime)
                     .onlyFor({"air_blast"})
                     .in("s")
                     .like("-0.01")
                     .means("when it detonates; before 0: the wave is on its way at the start"),
                 vectorOfTime("incident", &ConditionCard::incident)
                     .onlyFor({"absorbing"})
                     .in("m/s")
                     .defaultIs("[0, 0, 0]")
                     .like("[\"0.1*sin(2*_pi*200*t)\", 0, 0]")
                     .means("particle velocity of the wave that enters through the faces"),
                 bound<std::vector<TimeFunction>>("value", KeyKind::TimeFunction,
                                                  &ConditionCard::pressure, takeOne)
                     .onlyFor({"pressure"})
                     .needed()
                     .ofPlaceToo()
                     .in("Pa")
                     .usually(usual::stress)
                     .like("\"1e5*min(t/0.01, 1)\"")
                     .means(
                         "pressure; positive pushes into the body; x, y, z: middle of the face at "
                         "t = 0"),
                 vector("normal", &ConditionCard::normal)
                     .onlyFor({"symmetry"})
                     .needed()
                     .in("-")
                     .notAllZero()
                     .like("[0, 0, 1]")
                     .means("normal of the plane, of any length"),
             })
      .decidedBy("type")
      .elsewhere({"boundary", "boundaries", "bc", "bcs", "boundary_conditions", "loads"})
      .means("boundary conditions; t is the time [s], _pi is 3.14159...");
}

Key lines()
{
  const std::vector<std::string> divided{"grout", "perfect"};
  return named(
             "lines", &Deck::lines,
             {
                 points("points", &LineCard::points)
                     .needed()
                     .atLeastItems(2)
                     .like("[[0, 0, 0], [0, 0, 3]]")
                     .means(
                         "ends, or corners of a path [m], in the mesh as it is at t = 0; all of it "
                         "lies in elements"),
                 text("attach", &LineCard::attach)
                     .oneOf({"grout", "ends", "perfect"})
                     .like("ends")
                     .means("grout: along the line, with slip (bolts, cables); ends: both ends are "
                            "tied, and it is free between them (anchors, tie rods); perfect: "
                            "along the line, without slip (reinforcement)"),
                 number("segment_length", &LineCard::segmentLength)
                     .onlyFor(divided)
                     .needed()
                     .in("m")
                     .above(0)
                     .like("0.1")
                     .means("the line is divided into equal segments that are not longer; about "
                            "the size of the elements"),
                 number("area", &LineCard::area)
                     .needed()
                     .in("m^2")
                     .above(0)
                     .like("4.9e-4")
                     .means("cross section of the bar"),
                 number("youngs_modulus", &LineCard::youngsModulus)
                     .needed()
                     .in("Pa")
                     .usually(usual::modulus)
                     .above(0)
                     .like("200e9")
                     .means("of the bar"),
                 number("yield_stress", &LineCard::yieldStress)
                     .in("Pa")
                     .usually(usual::stress)
                     .above(0)
                     .defaultIs("no limit")
                     .like("500e6")
                     .means("from which on the bar is plastic"),
                 number("hardening_modulus", &LineCard::hardeningModulus)
                     .in("Pa")
                     .atLeast(0)
                     .like("1e9")
                     .means("change of the yield stress over plastic strain"),
                 number("rate_exponent", &LineCard::rateExponent)
                     .in("-")
                     .atLeast(0)
                     .atMost(1)
                     .like("0.024")
                     .means("where it flows fast the yield stress is (plastic strain rate / "
                            "reference_rate)^rate_exponent times as large, or the hardened one "
                            "where that is larger; 0: as slowly"),
                 number("reference_rate", &LineCard::referenceRate)
                     .in("1/s")
                     .above(0)
                     .like("1e-3")
                     .means("plastic strain rate up to which it does not matter, of the test that "
                            "gave the yield stress"),
                 number("rupture_strain", &LineCard::ruptureStrain)
                     .in("-")
                     .above(0)
                     .defaultIs("no limit")
                     .like("0.05")
                     .means("strain of a segment, in tension, at which it tears"),
                 flag("compression", &LineCard::compression)
                     .like("false")
                     .means("false: it goes slack instead of being pressed, as a cable"),
                 number("diameter", &LineCard::diameter)
                     .onlyFor(divided)
                     .in("m")
                     .above(0)
                     .defaultIs("no bending")
                     .like("0.012")
                     .means("of the round bar, or of each of those that make up `area`: it resists "
                            "bending, elastic and plastic"),
                 text("mirrored", &LineCard::mirrored)
                     .oneOf({"none", "start", "end", "both"})
                     .onlyFor(divided)
                     .like("start")
                     .means("ends that lie on a plane of symmetry, beyond which the line goes on: "
                            "no slip there, and its direction is held"),
                 section("grout",
                         {
                             number("stiffness", &LineCard::groutStiffness)
                                 .needed()
                                 .in("N/m^2")
                                 .above(0)
                                 .like("2e9")
                                 .means("force against slip, over slip and length"),
                             number("strength", &LineCard::groutStrength)
                                 .in("N/m")
                                 .atLeast(0)
                                 .defaultIs("no limit")
                                 .like("4e5")
                                 .means("largest force over length, without pressure"),
                             number("friction", &LineCard::groutFriction)
                                 .in("-")
                                 .atLeast(0)
                                 .like("0.6")
                                 .means("coefficient by which the pressure of the host across the "
                                        "line adds to the strength"),
                             number("perimeter", &LineCard::groutPerimeter)
                                 .in("m")
                                 .atLeast(0)
                                 .like("0.1")
                                 .means("around the grout, on which that pressure acts"),
                         })
                     .onlyFor({"grout"})
                     .needed()
                     .means("bond between bar and host"),
                 flag("plate", &LineCard::plate)
                     .onlyFor({"grout"})
                     .like("true")
                     .means("the first point is tied as well"),
                 number("free_length", &LineCard::freeLength)
                     .onlyFor({"grout"})
                     .in("m")
                     .atLeast(0)
                     .like("4")
                     .means("length without grout, from the first point on, which is tied then"),
                 section("dowel",
                         {
                             number("stiffness", &LineCard::dowelStiffness)
                                 .needed()
                                 .in("N/m")
                                 .above(0)
                                 .like("1e8")
                                 .means("force against sliding, over sliding"),
                             number("strength", &LineCard::dowelStrength)
                                 .in("N")
                                 .above(0)
                                 .defaultIs("no limit")
                                 .like("1e5")
                                 .means("largest force against sliding"),
                         })
                     .onlyFor(divided)
                     .means("what the bar gives across itself wherever it crosses from one body to "
                            "another; without it only the pull of its turned bar resists"),
                 number("pretension", &LineCard::pretension)
                     .in("N")
                     .atLeast(0)
                     .like("1e5")
                     .means("force that the bar would have between fixed ends"),
                 number("pretension_time", &LineCard::pretensionTime)
                     .in("s")
                     .atLeast(0)
                     .like("0.01")
                     .means("over which pretension grows from the installation on"),
                 number("spacing", &LineCard::spacing)
                     .in("m")
                     .above(0)
                     .like("1.5")
                     .means("in two dimensions: distance to the next line out of the plane"),
                 KeyBuilder(bound<int>("copies", KeyKind::Integer, &LineCard::copies, copyTo))
                     .in("-")
                     .atLeast(1)
                     .defaultIs("1")
                     .like("5")
                     .means("how many of them stand in a row; <name>_1, <name>_2, ..."),
                 vector("copy_step", &LineCard::copyStep)
                     .in("m")
                     .like("[1.5, 0, 0]")
                     .means("from one of the row to the next"),
                 number("from", &LineCard::from)
                     .in("s")
                     .atLeast(0)
                     .like("0.5")
                     .means("time at which it is installed, free of stress where its hosts are"),
                 number("until", &LineCard::until)
                     .in("s")
                     .above(0)
                     .like("1.5")
                     .means("time at which it is taken out again; its force is gone from then on"),
                 text("stage", &LineCard::stage)
                     .defaultIs("the first")
                     .like("heading")
                     .means("stage, by its name, in which it is installed"),
             })
      .decidedBy("attach")
      .elsewhere({"bolts", "cables", "rebar", "trusses", "anchors", "embedded", "reinforcement"})
      .means("bolts, cables, tie rods and bars that cross elements and joints");
}

Key initial()
{
  Key velocityField =
      bound<std::vector<TimeFunction>>(
          "velocity_field", KeyKind::PlaceFunctions, &InitialCard::velocityField,
          [](std::optional<std::array<PlaceFunction, 3>>& field, const std::vector<TimeFunction>& v)
          {
            field = {v[0], v[1], v[2]};
          })
          .in("m/s")
          .defaultIs("[0, 0, 0]")
          .like("[\"0.1*exp(-(x/0.2)^2)\", 0, 0]")
          .means("velocity that is added, as it varies with the place x, y, z [m] at t = 0");
  velocityField.length = 3;
  return list("initial", &Deck::initial,
              {
                  text("block", &InitialCard::block)
                      .needed()
                      .like("bar")
                      .means("element block of the mesh"),
                  vector("velocity", &InitialCard::velocity)
                      .in("m/s")
                      .usually(usual::speed)
                      .elsewhere({"v0", "vel"})
                      .like("[0, -35, 60.6]")
                      .means("velocity of the point `center` of the block, a rigid body at t = 0"),
                  vector("angular_velocity", &InitialCard::angularVelocity)
                      .in("rad/s")
                      .like("[0, 0, 2]")
                      .means("spin of the block about `center`"),
                  vector("center", &InitialCard::center)
                      .in("m")
                      .like("[1, 0, 0]")
                      .means("point about which angular_velocity turns"),
                  velocityField,
                  numbers("stress", &InitialCard::stress, 6)
                      .in("Pa")
                      .usually(usual::stress)
                      .like("[-1e6, 0, 0, 0, 0, 0]")
                      .means("xx, yy, zz, xy, yz, zx; tension is positive"),
                  numbers("stress_gradient", &InitialCard::stressGradient, 6)
                      .in("Pa/m")
                      .like("[5e3, 2e4, 5e3, 0, 0, 0]")
                      .means("change of the stress per metre along stress_axis; under gravity "
                             "along -y, yy has density times 9.81 along y"),
                  vector("stress_axis", &InitialCard::stressAxis)
                      .in("-")
                      .notAllZero()
                      .like("[0, 0, 1]")
                      .means("direction along which the stress varies, of any length"),
                  vector("stress_point", &InitialCard::stressPoint)
                      .in("m")
                      .like("[0, 10, 0]")
                      .means("point at which the stress is `stress`"),
              })
      .means("state of blocks at t = 0; at rest and free of stress where nothing is said");
}

Key timeGroup()
{
  return group("time", &Deck::time,
               {
                   number("end", &TimeCard::end)
                       .needed()
                       .in("s")
                       .elsewhere({"endtim", "endtime", "t_end", "tend", "termination", "duration",
                                   "total", "period"})
                       .above(0)
                       .like("0.041")
                       .means("time at which the run ends"),
                   flag("end_at_rest", &TimeCard::endAtRest)
                       .elsewhere({"until_rest", "steady_state"})
                       .like("true")
                       .means("the run ends as soon as damping ends by one of its ratios, "
                              "damping.until_energy_ratio or damping.until_force_ratio, with loads "
                              "that change no more before `end`; at `end` if that does not "
                              "happen"),
                   number("step_factor", &TimeCard::stepFactor)
                       .in("-")
                       .elsewhere({"tssfac", "cfl", "courant", "safety", "scale"})
                       .above(0)
                       .atMost(1)
                       .like("0.9")
                       .means("time step over the stable step"),
                   number("maximum_step", &TimeCard::maximumStep)
                       .in("s")
                       .elsewhere({"dtmax", "max_step"})
                       .above(0)
                       .defaultIs("no limit")
                       .like("1e-5")
                       .means("largest time step"),
                   number("fixed_step", &TimeCard::fixedStep)
                       .in("s")
                       .elsewhere({"dt", "step", "time_step", "timestep"})
                       .above(0)
                       .defaultIs("the step follows the stable step")
                       .like("1e-6")
                       .means("time step of all cycles"),
                   section("mass_scaling",
                           {
                               number("step", &TimeCard::scaledStep)
                                   .needed()
                                   .in("s")
                                   .elsewhere({"dt2ms", "dt2msf"})
                                   .above(0)
                                   .like("2e-6")
                                   .means("time step that elements, contact and lines allow after "
                                          "masses of nodes have been raised"),
                               number("limit", &TimeCard::scalingLimit)
                                   .in("-")
                                   .above(0)
                                   .like("0.02")
                                   .means("the run stops when the mass that is added to a block "
                                          "is above this part of its own"),
                               flag("with_waves", &TimeCard::scalingWithWaves)
                                   .like("true")
                                   .means("also with absorbing and free-field sides and "
                                          "accelerations of the ground, where added mass slows "
                                          "waves down and sends them back"),
                           })
                       .means("nodal masses are raised where the stable step is smaller than a "
                              "given one: for slow motions only"),
                   section("subcycling",
                           {
                               integer("levels", &TimeCard::subcyclingLevels)
                                   .needed()
                                   .in("-")
                                   .atLeast(1)
                                   .atMost(6)
                                   .like("4")
                                   .means("a cycle has at most 2^(levels - 1) of the smallest "
                                          "steps; 1: no subcycling"),
                           })
                       .means("elements and contact that allow small steps only make several in "
                              "a cycle: for a few small or crushed elements among many"),
                   number("energy_tolerance", &TimeCard::energyTolerance)
                       .in("-")
                       .above(0)
                       .like("0.05")
                       .means("the run stops when the energy balance is off by this fraction of "
                              "the energy in play"),
                   number("contact_gain_tolerance", &TimeCard::contactGainTolerance)
                       .in("-")
                       .above(0)
                       .like("0.05")
                       .means("the run stops when contact has gained this fraction of the energy "
                              "in play out of nothing (the contact remainder, with its sign "
                              "turned)"),
               })
      .needed()
      .atMostOneOf({"maximum_step", "fixed_step"})
      .means("time and its steps");
}

Key stages()
{
  return list(
             "stages", &Deck::stages,
             {
                 text("name", &StageCard::name)
                     .needed()
                     .like("heading")
                     .means("in messages; each once"),
                 number("until", &StageCard::until)
                     .in("s")
                     .above(0)
                     .defaultIs("of the last stage: time.end")
                     .like("0.5")
                     .means("time at which the stage ends"),
                 flag("at_rest", &StageCard::atRest)
                     .like("true")
                     .means("it ends before as soon as damping ends by one of its ratios, "
                            "damping.until_energy_ratio or damping.until_force_ratio, with loads "
                            "that change no more before `until`"),
                 texts("remove", &StageCard::remove)
                     .like("[core]")
                     .means("element blocks that leave at its beginning, with their mass; the "
                            "faces behind them are free and in contact from then on"),
                 texts("add", &StageCard::add)
                     .like("[lining]")
                     .means("element blocks that are not there before, and come in free of stress "
                            "with their nodes where these are then"),
                 changes("set")
                     .like("{joints.dry.friction: 0.4}")
                     .means(
                         "values of the deck that change, by paths of its keys, for this stage and "
                         "those after it; null takes a key or a condition out, and the number "
                         "after the last condition adds one"),
                 flag("zero_displacements", &StageCard::zeroDisplacements)
                     .like("true")
                     .means("displacements that are written count from its beginning"),
             })
      .elsewhere({"steps", "phases"})
      .means("parts of the run, one after the other; the first is the deck as it stands. Results "
             "are written at the end of each");
}

Key gravity()
{
  Key key = bound<std::vector<TimeFunction>>(
                "gravity", KeyKind::TimeFunctions, &Deck::gravity,
                [](std::array<TimeFunction, 3>& field, const std::vector<TimeFunction>& v) {
                  field = {v[0], v[1], v[2]};
                })
                .in("m/s^2")
                .usually(usual::acceleration)
                .elsewhere({"g", "body_force", "load_body"})
                .defaultIs("[0, 0, 0]")
                .like("[0, \"-9.81*min(t/0.5, 1)\", 0]")
                .means("acceleration of everything");
  key.length = 3;
  return key;
}

Key damping()
{
  const auto takeOne = [](TimeFunction& field, const std::vector<TimeFunction>& v)
  { field = v[0]; };
  return section("damping",
                 {
                     bound<std::vector<TimeFunction>>("mass", KeyKind::TimeFunction,
                                                      &Deck::massDamping, takeOne)
                         .in("1/s")
                         .atLeast(0)
                         .defaultIs("0")
                         .like("\"t > 0.5 ? 10 : 0\"")
                         .means("alpha of the force -alpha m v on every node"),
                     number("local", &Deck::localDamping)
                         .in("-")
                         .atLeast(0)
                         .below(1)
                         .like("0.7")
                         .means("alpha of the force -alpha |f| sign(v) on each component, f the "
                                "force that is out of balance"),
                     flag("kinetic", &Deck::kineticDamping)
                         .like("true")
                         .means("all motion that is not prescribed stops wherever the kinetic "
                                "energy has passed a peak"),
                     number("from", &Deck::dampingFrom)
                         .in("s")
                         .atLeast(0)
                         .like("0.5")
                         .means("time before which all dampings are off"),
                     number("until", &Deck::dampingUntil)
                         .in("s")
                         .above(0)
                         .defaultIs("the end")
                         .like("1.5")
                         .means("time after which all dampings are off"),
                     number("until_energy_ratio", &Deck::dampingEnergyRatio)
                         .in("-")
                         .above(0)
                         .defaultIs("no limit")
                         .like("1e-6")
                         .means("all dampings end for good when the kinetic energy falls below "
                                "this fraction of the internal one (elements and contact)"),
                     number("until_force_ratio", &Deck::dampingForceRatio)
                         .in("-")
                         .above(0)
                         .defaultIs("no limit")
                         .like("1e-4")
                         .means("the same when the forces that are out of balance fall below this "
                                "fraction of loads and reactions; with both ratios, when both "
                                "have"),
                 })
      .means("damping of all motion, to find states of rest (dynamic relaxation)");
}

Key makeSchema()
{
  return section(
             "",
             {
                 definitions(),
                 text("title", &Deck::title).means("for the records").like("Bar through a wall"),
                 text("mesh", &Deck::mesh)
                     .needed()
                     .like("bricks.e")
                     .means("Exodus file, relative to the folder of the deck"),
                 text("geometry", &Deck::geometry)
                     .oneOf({"plane_strain", "axisymmetric"})
                     .like("axisymmetric")
                     .means("what a mesh in two dimensions is a section of; axisymmetric: x is the "
                            "distance from the axis, y runs along it"),
                 materialKeys(),
                 blocks(),
                 jointKeys(),
                 contactKeys(),
                 conditions(),
                 lines(),
                 initial(),
                 gravity(),
                 damping(),
                 section("viscosity",
                         {
                             number("linear", &Deck::viscosityLinear)
                                 .in("-")
                                 .usually(usual::fraction)
                                 .atLeast(0)
                                 .like("0.1")
                                 .means("bulk viscosity b1, in compression"),
                             number("quadratic", &Deck::viscosityQuadratic)
                                 .in("-")
                                 .atLeast(0)
                                 .like("1.2")
                                 .means("bulk viscosity b2, in compression"),
                         })
                     .means("bulk viscosity, which spreads shocks over a few elements"),
                 timeGroup(),
                 stages(),
                 outputKeys(),
                 historyKeys(),
                 checkpointKeys(),
                 partitionKeys(),
             })
      .absent("units", "A deck names no units: any consistent set will do, and messages, usual "
                       "ranges and the library of materials are in SI (m, kg, s, N, Pa).")
      .absent("dimension", "The mesh says whether it is in two or three dimensions.")
      .absent("include", "A deck is one file. For variants of it there is --set KEY=VALUE.");
}
} // namespace

const Key& deckSchema()
{
  static const Key schema = makeSchema();
  return schema;
}
} // namespace coplane
