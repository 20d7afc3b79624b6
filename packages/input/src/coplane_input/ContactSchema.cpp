#include "ContactSchema.hpp"

#include <coplane_input/Deck.hpp>
#include <coplane_joint/JointModel.hpp>
#include <coplane_schema/SchemaBuilder.hpp>

#include <fmt/format.h>

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
  return keysOfModels<JointCard>(jointModels(), "law of the plane", "linear");
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
          .defaultIs("auto")
          .means("largest number of cycles between searches; auto: when faces have strayed so far "
                 "from what the last search foresaw that a contact might be missed; once: the same "
                 "with a larger skin, and pairs take over from others at searches only, for "
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
                     .means(
                         "forces of a pair of faces: minus the gradient of one energy, or along "
                         "the normal of the common plane as in the paper of 2006; auto: "
                         "potential, but common_normal with preset seed, or where area, weights, "
                         "closure, couple or area_rule are not the defaults"),
                 text("impulses", &ContactCard::impulses)
                     .oneOf({"leapfrog", "path"})
                     .like("path")
                     .means("of forces from the potential in a step: the mean of those at both "
                            "ends, or, where faces meet, part or pass an edge in between, what "
                            "changes the energy along the path as they move"),
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
                 text("lost_contact", &ContactCard::lostContact)
                     .oneOf({"stop", "warn"})
                     .like("warn")
                     .means(
                         "when bodies go through each other: end the run with code 6, or warn and "
                         "go on"),
                 text("debris", &ContactCard::debris)
                     .oneOf({"none", "points"})
                     .like("points")
                     .means("nodes whose elements have all eroded: fly on through everything, or "
                            "as mass points that faces stop, without friction"),
                 number("cos_opposed", &ContactCard::cosOpposed)
                     .in("-")
                     .atLeast(0)
                     .below(1)
                     .defaultIs(fmt::format("{}; {} with forces along the common normal",
                                            ContactCard::cosOpposedOfPotential,
                                            ContactCard::cosOpposedOfCommonNormal))
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
                                 .usually(usual::contactDamping)
                                 .atLeast(0)
                                 .like("0.1")
                                 .means("of closure, fraction of critical"),
                             number("shear", &ContactCard::dampShear)
                                 .in("-")
                                 .usually(usual::contactDamping)
                                 .atLeast(0)
                                 .like("0.1")
                                 .means("of slip, fraction of critical"),
                         })
                     .means("viscous damping on the planes"),
             })
      .removed("method",
               "There is one kind of contact left, a Simple Common Plane for each pair of "
               "faces. Cundall's plane between elements (common_plane) was there for "
               "comparison only; docs/theory/scp.md compares the two. Remove the key; "
               "forces: common_normal is the contact nearest to Cundall's.")
      .removed("plane_search", "It said how common_plane found Cundall's plane between elements, "
                               "which whole runs no longer have. Remove the key.")
      .means("contact between all exterior faces, by Simple Common Planes");
}
} // namespace coplane
