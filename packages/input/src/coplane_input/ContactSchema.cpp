#include "ContactSchema.hpp"

#include <coplane_input/Deck.hpp>
#include <coplane_schema/SchemaBuilder.hpp>

namespace coplane
{
using namespace schema;

namespace
{
Key contactPairs()
{
  const auto takeTwo = [](std::array<std::string, 2>& field, const std::vector<std::string>& v) {
    field = {v[0], v[1]};
  };
  const auto two = [&](const char* name, std::array<std::string, 2> ContactPairCard::*member,
                       const char* example, const char* meaning)
  {
    Key key = bound<std::vector<std::string>>(name, KeyKind::Texts, member, takeTwo)
                  .like(example)
                  .means(meaning);
    key.length = 2;
    return key;
  };
  return list("pairs", &ContactCard::pairs,
              {
                  two("blocks", &ContactPairCard::blocks, "[bricks, \"*\"]",
                      "between faces of two blocks, or of one; \"*\" is any block"),
                  two("materials", &ContactPairCard::materials, "[concrete, \"*\"]",
                      "between faces of two materials, or of one; \"*\" is any material"),
                  two("side_sets", &ContactPairCard::sideSets, "[nose, front]",
                      "between faces of two side sets of the mesh; \"*\" is any face"),
                  text("joint_set", &ContactPairCard::jointSet)
                      .like("bedding")
                      .means("between faces of one side set that holds both faces of every joint, "
                             "as coplane_mesh split writes it"),
                  text("joint", &ContactPairCard::joint)
                      .like("dry")
                      .defaultIs("contact.default_joint")
                      .means("name of a card in joints"),
                  flag("declared", &ContactPairCard::declared)
                      .like("true")
                      .means("closed and free of stress at t = 0 as built: initial gaps and "
                             "overlaps are absorbed where faces lie on each other"),
                  flag("excluded", &ContactPairCard::excluded)
                      .like("true")
                      .means("no contact between these faces"),
              })
      .atMostOneOf({"blocks", "materials", "side_sets", "joint_set"})
      .means("what acts between two faces; the first item that fits them counts; each item names "
             "blocks, materials, side_sets or a joint_set");
}
} // namespace

std::vector<Key> jointCardKeys()
{
  const std::vector<std::string> coulomb = {"penalty", "linear", "closure_curve",
                                            "table",   "mortar", "bilinear"};
  return {
      text("model", &JointCard::model)
          .oneOf({"penalty", "linear", "closure_curve", "table", "barton_bandis", "mortar",
                  "bilinear"})
          .like("linear")
          .means("law of the plane: stiffness from the elements behind the faces; a given "
                 "stiffness; a hyperbola of the closure; a table of it; a rough rock joint; a bond "
                 "with exponential or with linear softening"),
      number("stiffness_fraction", &JointCard::stiffnessFraction)
          .onlyFor({"penalty"})
          .in("-")
          .above(0)
          .like("0.7")
          .means("normal stiffness over 1 / (h1/M1 + h2/M2), with thickness h and "
                 "wave modulus M of the two elements"),
      number("normal_stiffness", &JointCard::normalStiffness)
          .onlyFor({"linear", "mortar", "bilinear"})
          .needed()
          .in("Pa/m")
          .above(0)
          .means("traction per closure, and per opening of a bond")
          .like("2e10"),
      number("initial_stiffness", &JointCard::initialStiffness)
          .onlyFor({"closure_curve"})
          .needed()
          .in("Pa/m")
          .above(0)
          .like("2e10")
          .means("slope of the closure curve at zero closure"),
      number("maximum_closure", &JointCard::maximumClosure)
          .onlyFor({"closure_curve"})
          .needed()
          .in("m")
          .above(0)
          .means("asymptote of the hyperbola")
          .like("5e-4"),
      number("initial_stiffness", &JointCard::initialStiffness)
          .onlyFor({"barton_bandis"})
          .in("Pa/m")
          .above(0)
          .like("2e10")
          .defaultIs("Bandis' estimate from roughness, wall_strength and rock_strength")
          .means("slope of the closure curve at zero closure"),
      number("maximum_closure", &JointCard::maximumClosure)
          .onlyFor({"barton_bandis"})
          .in("m")
          .above(0)
          .like("5e-4")
          .defaultIs("Bandis' estimate from roughness, wall_strength and rock_strength")
          .means("asymptote of the hyperbola"),
      number("maximum_closure", &JointCard::maximumClosure)
          .onlyFor({"mortar", "bilinear"})
          .in("m")
          .above(0)
          .like("5e-4")
          .defaultIs("none, a straight line")
          .means("asymptote of a hyperbola in compression, which starts with normal_stiffness"),
      numbers("closures", &JointCard::closures)
          .onlyFor({"table"})
          .needed()
          .in("m")
          .above(0)
          .like("[1e-4, 2e-4]")
          .means(
              "points of the closure curve after (0, 0), rising, at most 16; straight beyond the "
              "last"),
      numbers("tractions", &JointCard::tractions)
          .onlyFor({"table"})
          .needed()
          .in("Pa")
          .above(0)
          .like("[1e6, 4e6]")
          .means("tractions at `closures`; no segment may be less steep than the one before"),
      number("stiffness_cap", &JointCard::stiffnessCap)
          .onlyFor({"closure_curve", "table", "barton_bandis", "mortar", "bilinear"})
          .in("Pa/m")
          .above(0)
          .defaultIs("0.5 M/h of the softer element")
          .like("3e11")
          .means("largest slope of the closure curve; at least its slope at zero closure"),
      number("shear_stiffness", &JointCard::shearStiffness)
          .in("Pa/m")
          .atLeast(0)
          .defaultIs("shear_ratio times the normal stiffness")
          .like("5e9")
          .means("shear traction per slip"),
      number("shear_ratio", &JointCard::shearRatio)
          .in("-")
          .atLeast(0)
          .like("0.4")
          .means("shear stiffness over normal stiffness at zero closure"),
      number("friction", &JointCard::friction)
          .onlyFor(coulomb)
          .in("-")
          .atLeast(0)
          .like("0.6")
          .means("tangent of the friction angle, at rest"),
      number("dynamic_friction", &JointCard::dynamicFriction)
          .onlyFor(coulomb)
          .in("-")
          .atLeast(0)
          .like("0.4")
          .defaultIs("friction")
          .means("friction of fast slip mu_d: mu_d + (friction - mu_d) exp(-speed / slip_speed)"),
      number("slip_speed", &JointCard::slipSpeed)
          .onlyFor(coulomb)
          .in("m/s")
          .above(0)
          .like("0.1")
          .defaultIs("none; dynamic_friction needs it")
          .means("speed of the faces' sliding over which friction falls"),
      number("cohesion", &JointCard::cohesion)
          .onlyFor({"penalty", "linear", "closure_curve", "table"})
          .in("Pa")
          .atLeast(0)
          .like("1e5")
          .means("shear strength without normal traction, of a joint that is closed or bonded"),
      number("cohesion", &JointCard::cohesion)
          .onlyFor({"mortar", "bilinear"})
          .in("Pa")
          .atLeast(0)
          .like("3e5")
          .means("shear strength of the bond without normal traction; softens"),
      number("dilation", &JointCard::dilation)
          .onlyFor(coulomb)
          .in("-")
          .atLeast(0)
          .like("0.1")
          .means("opening per slip: tangent of the dilation angle; at most the friction"),
      number("dilation_slip", &JointCard::dilationSlip)
          .in("m")
          .atLeast(0)
          .like("1e-3")
          .defaultIs("no limit")
          .means("length of the slip path after which the joint dilates no more"),
      number("tensile_strength", &JointCard::tensileStrength)
          .onlyFor({"linear"})
          .in("Pa")
          .atLeast(0)
          .like("2e5")
          .means(
              "of a declared joint, until it breaks at once: in tension, or when it slips; 0: no "
              "bond"),
      number("tensile_strength", &JointCard::tensileStrength)
          .onlyFor({"mortar", "bilinear"})
          .needed()
          .in("Pa")
          .above(0)
          .like("0.3e6")
          .means("of a declared joint; softens"),
      number("tension_energy", &JointCard::tensionEnergy)
          .onlyFor({"mortar", "bilinear"})
          .needed()
          .in("J/m^2")
          .above(0)
          .like("20")
          .means("fracture energy G_I: area under the curve of traction over opening"),
      number("shear_energy", &JointCard::shearEnergy)
          .onlyFor({"mortar", "bilinear"})
          .needed()
          .in("J/m^2")
          .above(0)
          .like("130")
          .means("fracture energy G_II: area under the cohesive part of traction over slip"),
      number("roughness", &JointCard::roughness)
          .onlyFor({"barton_bandis"})
          .needed()
          .in("-")
          .above(0)
          .atMost(20)
          .like("10")
          .means("joint roughness coefficient JRC"),
      number("wall_strength", &JointCard::wallStrength)
          .onlyFor({"barton_bandis"})
          .needed()
          .in("Pa")
          .above(0)
          .like("80e6")
          .means("joint wall compressive strength JCS"),
      number("rock_strength", &JointCard::rockStrength)
          .onlyFor({"barton_bandis"})
          .in("Pa")
          .above(0)
          .like("120e6")
          .defaultIs("wall_strength")
          .means("uniaxial compressive strength of the rock, for Bandis' estimate of the closure "
                 "curve"),
      number("residual_friction", &JointCard::residualFriction)
          .onlyFor({"barton_bandis"})
          .needed()
          .in("-")
          .above(0)
          .below(2.7)
          .like("0.577")
          .means("tangent of the residual friction angle"),
      number("peak_slip", &JointCard::peakSlip)
          .onlyFor({"barton_bandis"})
          .needed()
          .in("m")
          .above(0)
          .like("5e-3")
          .means("slip at which the roughness is mobilised; about a hundredth of a block's length"),
  };
}

Key jointKeys()
{
  return named("joints", &Deck::joints, jointCardKeys())
      .decidedBy("model")
      .atMostOneOf({"shear_stiffness", "shear_ratio"})
      .means("laws of the contact planes, by a name of your choice");
}

Key contactKeys()
{
  // The preset comes first here, so that it is stored before keys that overrule it, wherever they
  // stand in the deck.
  const std::function<void(ContactCard&)> applyPreset = [](ContactCard& card)
  {
    if (card.preset != "seed")
      return;
    card.area = "full";
    card.weights = "centroid";
    card.closure = "incremental";
  };
  const auto takeInterval = [](int& field, int value) { field = value; };
  const Key searchEvery =
      bound<int>("search_every", KeyKind::Integer, &ContactCard::searchEvery, takeInterval)
          .atLeast(1)
          .oneOf({"once", "auto"}) // 0 and -1
          .in("cycles")
          .like("2")
          .defaultIs(fmt::format("{}", ContactCard{}.searchEvery))
          .means("largest number of cycles between searches; auto: only when faces have moved so "
                 "far that a contact might be missed; once: the same with a larger skin, for "
                 "contacts that stay what they are");
  return group(
             "contact", &Deck::contact,
             {
                 text("preset", &ContactCard::preset)
                     .oneOf({"default", "seed"})
                     .like("seed")
                     .andThen(applyPreset)
                     .means("seed sets area: full, weights: centroid, closure: incremental, as in "
                            "the paper of 2006; these keys overrule it where they are given"),
                 flag("enabled", &ContactCard::enabled).means("contact at all").like("false"),
                 text("method", &ContactCard::method)
                     .oneOf({"simple_common_plane", "common_plane"})
                     .like("common_plane")
                     .means("a plane for each pair of faces, or Cundall's for each pair of "
                            "elements, for comparison"),
                 text("plane_search", &ContactCard::planeSearch)
                     .oneOf({"candidates", "rotations"})
                     .like("rotations")
                     .means("how method common_plane finds the normal: among those of faces, edges "
                            "and vertices (Nezami), or by turns (Cundall)"),
                 text("default_joint", &ContactCard::defaultJoint)
                     .like("dry")
                     .defaultIs("penalty without friction")
                     .means("card in joints for all blocks that no item of pairs names"),
                 contactPairs(),
                 searchEvery,
                 number("skin", &ContactCard::skin)
                     .in("m")
                     .above(0)
                     .like("0.02")
                     .defaultIs("0.1 (search_every once: 0.5) of the smallest face size")
                     .means("distance within which a search takes pairs of faces"),
                 text("forces", &ContactCard::forces)
                     .oneOf({"auto", "potential", "common_normal"})
                     .like("common_normal")
                     .means("forces of a pair of faces: minus the gradient of one energy, or along "
                            "the normal of the common plane as in the paper of 2006; auto: "
                            "potential, but common_normal with preset seed, method common_plane, "
                            "axisymmetric geometry, or where area, weights, closure, couple or "
                            "area_rule are not the defaults"),
                 text("area", &ContactCard::area)
                     .oneOf({"penetrating", "full"})
                     .like("full")
                     .means("area of a plane: where the faces overlap, or all of the shadows"),
                 text("weights", &ContactCard::weights)
                     .oneOf({"pressure", "average", "centroid"})
                     .like("average")
                     .means("how a plane's force is shared among the nodes of its faces"),
                 text("closure", &ContactCard::closure)
                     .oneOf({"total", "incremental"})
                     .like("incremental")
                     .means("closure from positions, or summed up from velocities"),
                 flag("couple", &ContactCard::couple)
                     .like("false")
                     .means("balance the moment of a plane's two forces exactly"),
                 flag("area_rule", &ContactCard::areaRule)
                     .like("false")
                     .means("shear traction is diluted when the area grows"),
                 flag("inherit", &ContactCard::inherit)
                     .like("false")
                     .means("a new plane takes over the history of its neighbours"),
                 text("share_node", &ContactCard::shareNode)
                     .oneOf({"skip", "allow"})
                     .like("allow")
                     .means("whether faces of elements that share a node may touch; both faces at "
                            "the tip of a "
                            "declared joint do in any case"),
                 text("initial_overlap", &ContactCard::initialOverlap)
                     .oneOf({"error", "allow"})
                     .like("allow")
                     .means("bodies that lie in each other at the start, by more than a thousandth "
                            "of an element and not in a declared joint: an error, or left as they "
                            "are, without force until they press deeper"),
                 number("cos_opposed", &ContactCard::cosOpposed)
                     .in("-")
                     .atLeast(0)
                     .below(1)
                     .defaultIs("0.004; 0.1 with forces along the common normal")
                     .like("0.2")
                     .means("faces are paired when n1.n2 < -cos_opposed"),
                 number("depth_max", &ContactCard::depthMax)
                     .in("-")
                     .above(0)
                     .atMost(1)
                     .like("0.5")
                     .means("largest overlap over the thinner element's thickness"),
                 number("area_min", &ContactCard::areaMin)
                     .in("-")
                     .atLeast(0)
                     .below(1)
                     .like("1e-6")
                     .means("least area of a plane over that of its smaller face"),
                 section("damping",
                         {
                             number("normal", &ContactCard::dampNormal)
                                 .in("-")
                                 .atLeast(0)
                                 .like("0.1")
                                 .means("of closure, fraction of critical"),
                             number("shear", &ContactCard::dampShear)
                                 .in("-")
                                 .atLeast(0)
                                 .like("0.1")
                                 .means("of slip, fraction of critical"),
                         })
                     .means("viscous damping on the planes"),
             })
      .means("contact between all exterior faces, by Simple Common Planes");
}
} // namespace coplane
