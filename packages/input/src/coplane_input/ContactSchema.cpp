#include "ContactSchema.hpp"

#include "SchemaBuilder.hpp"

namespace coplane
{
using namespace schema;

namespace
{
Key contactPairs()
{
  const auto takeBlocks = [](std::array<std::string, 2>& field, const std::vector<std::string>& v) {
    field = {v[0], v[1]};
  };
  Key pairOfBlocks = bound<std::vector<std::string>>("blocks", KeyKind::Texts,
                                                     &ContactPairCard::blocks, takeBlocks)
                         .needed()
                         .like("[bricks, \"*\"]")
                         .means("two blocks, or one twice; \"*\" is any block");
  pairOfBlocks.length = 2;
  return list("pairs", &ContactCard::pairs,
              {
                  pairOfBlocks,
                  text("joint", &ContactPairCard::joint)
                      .like("dry")
                      .defaultIs("contact.default_joint")
                      .means("name of a card in joints"),
                  flag("declared", &ContactPairCard::declared)
                      .like("true")
                      .means("closed and free of stress at t = 0 as built: initial gaps and "
                             "overlaps are absorbed"),
                  flag("excluded", &ContactPairCard::excluded)
                      .like("true")
                      .means("no contact between these blocks"),
              })
      .means("what acts between two blocks; the first item that fits a pair of blocks counts");
}
} // namespace

Key jointKeys()
{
  return named("joints", &Deck::joints,
               {
                   text("model", &JointCard::model)
                       .oneOf({"penalty", "linear", "closure_curve"})
                       .like("linear")
                       .means("law of the plane: stiffness from the elements behind the faces, a "
                              "given stiffness, or a hyperbola of the closure"),
                   number("stiffness_fraction", &JointCard::stiffnessFraction)
                       .onlyFor({"penalty"})
                       .in("-")
                       .above(0)
                       .like("0.7")
                       .means("normal stiffness over 1 / (h1/M1 + h2/M2), with thickness h and "
                              "wave modulus M of the two elements"),
                   number("normal_stiffness", &JointCard::normalStiffness)
                       .onlyFor({"linear"})
                       .needed()
                       .in("Pa/m")
                       .above(0)
                       .means("traction per closure")
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
                   number("stiffness_cap", &JointCard::stiffnessCap)
                       .onlyFor({"closure_curve"})
                       .in("Pa/m")
                       .above(0)
                       .defaultIs("0.5 M/h of the softer element")
                       .like("3e11")
                       .means("largest slope of the closure curve; at least initial_stiffness"),
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
                       .means("shear stiffness over normal stiffness"),
                   number("friction", &JointCard::friction)
                       .in("-")
                       .atLeast(0)
                       .like("0.6")
                       .means("tangent of the friction angle"),
                   number("cohesion", &JointCard::cohesion)
                       .in("Pa")
                       .atLeast(0)
                       .like("1e5")
                       .means("shear strength without normal traction"),
               })
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
          .oneOf({"once"})
          .in("cycles")
          .like("2")
          .defaultIs(fmt::format("{}", ContactCard{}.searchEvery))
          .means("largest number of cycles between searches; once: at the start, and again only if "
                 "faces move so far that a contact might be missed");
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
                 number("cos_opposed", &ContactCard::cosOpposed)
                     .in("-")
                     .atLeast(0)
                     .below(1)
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
      .means("Simple Common Plane contact between all exterior faces");
}
} // namespace coplane
