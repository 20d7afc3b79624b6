#include <coplane_contact/PlaneTable.hpp>
#include <coplane_contact/detail/FacePairLanes.hpp>

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
using Key = std::pair<GlobalId, GlobalId>;

/// Faces 8, 16, 24 and so on.
Array<Face> faces(int count)
{
  const Array<Face> table("faces", std::size_t(count));
  for (int f = 0; f < count; ++f)
  {
    table(f).id = 8 * (f + 1);
    table(f).thickness = table(f).modulus = 1;
    table(f).ownedHere = true;
  }
  return table;
}

ContactRules oneJoint()
{
  ContactRules rules;
  rules.joints.resize(1);
  rules.tellApart(1);
  rules.table.assign(1, {});
  return rules;
}

/// Slots of face 0 with each of the others; the plane of the first is there, and dormant.
PlaneTable::Slots slotsWithADormantPlane(const Array<Face>& faces)
{
  const std::size_t count = faces.extent(0) - 1;
  PlaneTable::Slots slots(count, 1);
  slots.plane[0] = new (&slots.stored(0)) Plane;
  slots.plane[0]->faceId[0] = faces(0).id;
  slots.plane[0]->faceId[1] = faces(1).id;
  slots.plane[0]->face[0] = slots.plane[0]->face[1] = -1;
  for (std::size_t slot = 1; slot < count; ++slot)
  {
    slots.faces(slot).face[0] = 0;
    slots.faces(slot).face[1] = int(slot) + 1;
  }
  return slots;
}

TEST(PlaneTable, keysStayInOrderWhenADormantPlaneEnds)
{
  // A plane whose faces were no candidates ends with an element. Nothing tells its key then, and
  // the search that follows goes through the slots in the order of keys.
  const ContactRules rules = oneJoint();
  PlaneTable table(rules, 0.5);
  const Array<Face> known = faces(4);
  table.take(slotsWithADormantPlane(known), known, {});
  EXPECT_EQ(table.keyOf(0), Key(8, 16));
  ASSERT_EQ(table.planes().size(), 1U);

  table.drop({0});
  EXPECT_EQ(table.planes().size(), 0U);
  EXPECT_LT(table.keyOf(0), Key(0, 0));
  EXPECT_EQ(table.keyOf(1), Key(8, 24));
  EXPECT_EQ(table.keyOf(2), Key(8, 32));
}

TEST(PlaneTable, slotsGetTheirPlanesWhenTheyWake)
{
  const ContactRules rules = oneJoint();
  PlaneTable table(rules, 0.5);
  const Array<Face> known = faces(400);
  table.take(slotsWithADormantPlane(known), known, {});
  const auto last = table.count() - 1;
  std::vector<Plane*> woken;
  for (std::size_t slot = last; slot > 0; --slot)
    woken.push_back(&table.wake(slot));
  table.listWoken();
  ASSERT_EQ(table.planes().size(), table.count());
  for (std::size_t p = 1; p < table.count(); ++p)
  {
    EXPECT_EQ(table.planes().slotOf(p), p); // in the order of slots, whichever woke first
    EXPECT_EQ(&table.planes()[p], woken[last - p]);
    EXPECT_EQ(table.planes()[p].faceId[1], known(int(p) + 1).id);
  }
}
TEST(PlaneTable, gainIsThatOfThePlanesThatThereAre)
{
  const ContactRules rules = oneJoint();
  PlaneTable table(rules, 0.5);
  const Array<Face> known = faces(700);
  table.take(slotsWithADormantPlane(known), known, {});
  const auto evaluate = [&](std::size_t slot)
  { table.forKernels(false).setActivity(int(slot), Activity::Loaded); };
  const auto bear = [&](std::size_t slot, Real gain)
  {
    Plane& plane = table.wake(slot);
    plane.state = PlaneState::Open;
    plane.countedHere = true;
    plane.frictionWork = 3;
    plane.work = 3 - gain;
    evaluate(slot);
  };
  bear(5, 1);
  bear(600, 20);
  EXPECT_EQ(table.gain(), 21);
  bear(300, 400); // made since
  EXPECT_EQ(table.gain(), 421);
  Plane& fifth = *table.slots().plane[5];
  fifth.work -= 8000;
  evaluate(5);
  EXPECT_EQ(table.gain(), 8421);
  fifth.countedHere = false;
  evaluate(5);
  EXPECT_EQ(table.gain(), 420);
  table.listWoken();
  table.drop({600});
  EXPECT_EQ(table.gain(), 400);
  table.take(slotsWithADormantPlane(known), known, {});
  EXPECT_EQ(table.gain(), 0);
}
} // namespace
} // namespace coplane
