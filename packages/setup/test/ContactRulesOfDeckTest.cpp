#include "WallOfTwo.hpp"

#include <set>

namespace coplane
{
namespace
{
/// The rule between the sides of two ids, as contact looks it up.
const ContactRule& ruleBetween(const Model& model, GlobalId a, GlobalId b)
{
  const auto kindOf = [&](GlobalId face)
  {
    for (const auto& [id, group] : model.faceGroups)
      if (id == face)
        return model.contactRules.kindOf[group];
    return model.contactRules.kindOf[elementOfFace(face) <= 4 ? 0 : 1];
  };
  return model.contactRules.table[kindOf(a) * model.contactRules.kinds + kindOf(b)];
}

const std::string joints = R"(
joints:
  mortar: {model: linear, normal_stiffness: 1e10, shear_stiffness: 5e9, friction: 0.7}
  dry: {model: linear, normal_stiffness: 2e10, shear_stiffness: 5e9, friction: 0.5}
)";

TEST(ContactOptionsOfDeck, autoIsThePotentialWhereItCanBe)
{
  using Forces = ContactOptions::Forces;
  const auto options = [](const std::string& contact)
  { return modelOf(blocksOfTwo + "contact: {" + contact + "}\n").contact; };
  const auto expect = [](const ContactOptions& o, Forces forces, Real cosOpposed)
  {
    EXPECT_EQ(o.forces, forces);
    EXPECT_EQ(o.cosOpposed, cosOpposed);
  };
  expect(ContactOptions(), Forces::Potential, 0.004);
  expect(modelOf(blocksOfTwo).contact, Forces::Potential, 0.004);
  expect(options("forces: auto"), Forces::Potential, 0.004);
  expect(options("forces: potential, cos_opposed: 0.2"), Forces::Potential, 0.2);
  for (const char* key :
       {"forces: common_normal", "preset: seed", "area: full", "weights: centroid",
        "closure: incremental", "couple: false", "area_rule: false"})
  {
    SCOPED_TRACE(key);
    expect(options(key), Forces::CommonNormal, 0.1);
  }
  const ContactOptions ring = modelOf("geometry: axisymmetric\n" + blocksOfTwo).contact;
  expect(ring, Forces::Potential, 0.004);
  EXPECT_TRUE(ring.axisymmetric);
}

TEST(ContactRulesOfDeck, sideSetsTellFacesOfABlockApart)
{
  const Model model = modelOf(blocksOfTwo + joints + R"(
contact:
  default_joint: dry
  pairs:
    - {side_sets: [bed, "*"], joint: mortar, declared: true}
    - {blocks: [lower, lower], excluded: true}
)");
  const ContactRules& rules = model.contactRules;
  ASSERT_EQ(rules.joints.size(), 3u); // the built-in one comes first
  EXPECT_EQ(rules.joints[1].name, "mortar");
  const GlobalId bed = faceId(3, 2), sideOfLower = faceId(1, 0), upper = faceId(5, 0);
  EXPECT_EQ(ruleBetween(model, bed, upper).joint, 1);
  EXPECT_TRUE(ruleBetween(model, bed, upper).declared);
  EXPECT_TRUE(ruleBetween(model, upper, bed).declared); // no side comes first
  EXPECT_EQ(ruleBetween(model, sideOfLower, upper).joint, 2);
  EXPECT_FALSE(ruleBetween(model, sideOfLower, upper).declared);
  EXPECT_TRUE(ruleBetween(model, sideOfLower, sideOfLower).excluded);
  ASSERT_EQ(rules.declaredItems.size(), 1u);
  EXPECT_EQ(rules.declaredItems[0].second, "contact.pairs.0 (side sets bed and *)");
}

/// The start knows which declared joints have to find a partner then.
TEST(ContactRulesOfDeck, declaredJointsOfBlocksToComeAreNotAskedFor)
{
  const std::string stages = R"(
stages:
  - {name: first, until: 0.5}
  - {name: second, add: [upper]}
)";
  const auto asked = [&](const std::string& contact)
  {
    std::vector<int> items;
    for (const auto& [item, name] :
         modelOf(blocksOfTwo + joints + contact + stages).contactRules.declaredItems)
      items.push_back(item);
    return items;
  };
  EXPECT_EQ(asked(R"(
contact:
  default_joint: dry
  pairs:
    - {blocks: [lower, upper], joint: mortar, declared: true}
    - {blocks: [lower, lower], joint: mortar, declared: true}
)"),
            std::vector<int>{1});
  EXPECT_EQ(asked(R"(
contact: {default_joint: dry, pairs: [{blocks: ["*", "*"], joint: mortar, declared: true}]}
)"),
            std::vector<int>{0});
}

TEST(ContactRulesOfDeck, areTheSameOnAllRanks)
{
  const Model model = modelOf(blocksOfTwo + joints + R"(
contact: {default_joint: dry, pairs: [{side_sets: [bed, floor], joint: mortar}]}
)");
  const Comm comm;
  std::vector<int> mine = model.contactRules.kindOf;
  mine.push_back(model.contactRules.kinds);
  const std::vector<int> all = comm.allGather(mine);
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_EQ(all[i], mine[i % mine.size()]);
  std::set<GlobalId> named; // faces in groups of their own, over all ranks
  for (const auto& [id, group] : model.faceGroups)
    named.insert(id);
  const std::vector<GlobalId> faces =
      comm.allGather(std::vector<GlobalId>(named.begin(), named.end()));
  EXPECT_EQ(std::set<GlobalId>(faces.begin(), faces.end()),
            (std::set<GlobalId>{faceId(1, 0), faceId(2, 0), faceId(3, 2), faceId(4, 2)}));
}
} // namespace
} // namespace coplane
