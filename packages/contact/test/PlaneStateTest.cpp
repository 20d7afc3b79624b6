#include <coplane_contact/PlaneState.hpp>
#include <coplane_contact/detail/Inheritance.hpp>
#include <coplane_contact/detail/PassedOn.hpp>

#include <gtest/gtest.h>

#include <cstring>
#include <set>
#include <utility>

namespace coplane
{
namespace
{
/// Initialises a member of any type, but no array.
struct Anything
{
  template <class T>
  operator T() const;
};
template <class T, std::size_t... I>
auto takes(std::index_sequence<I...>) -> decltype(T{(void(I), Anything{})...}, std::true_type{});
template <class T>
std::false_type takes(...);

/// How many initialisers a struct takes: one for each member, for each element of an array.
template <class T, std::size_t count = 1>
constexpr std::size_t initialisers()
{
  if constexpr (decltype(takes<T>(std::make_index_sequence<count>()))::value)
    return initialisers<T, count + 1>();
  else
    return count - 1;
}

/// Calls f for a member, or for each element of an array.
template <class T, class F>
void forEachWhole(const T& value, const F& f)
{
  if constexpr (std::is_array_v<T>)
    for (const auto& element : value)
      forEachWhole(element, f);
  else
    f(value);
}

std::uint64_t hashOf(const Plane& plane)
{
  StateHash hash;
  addTo(hash, 1, plane);
  return hash.part();
}

std::vector<Real> numbersOf(const Plane& plane)
{
  std::vector<Real> numbers;
  forEachNumber(plane, [&](const auto& number) { numbers.push_back(Real(number)); });
  return numbers;
}

/// A plane whose numbers are n, n + 1, ...; flags are set where they are odd.
Plane countedFrom(int n)
{
  Plane plane;
  forEachNumber(plane,
                [&](auto& number)
                {
                  using T = std::decay_t<decltype(number)>;
                  number = std::is_same_v<T, bool> ? T(n % 2) : T(n);
                  ++n;
                });
  return plane;
}
} // namespace

TEST(PlaneState, everyMemberOfAPlaneIsInTheList)
{
  const Plane plane;
  std::set<const void*> places;
  forEachMember(
      [&](const auto& member)
      { forEachWhole(member.get(plane), [&](const auto& part) { places.insert(&part); }); });
  // The list has the members of `fit` and `history` one by one.
  EXPECT_EQ(places.size(),
            initialisers<Plane>() - 2 + initialisers<JointFit>() + initialisers<JointState>())
      << "a member of Plane, JointFit or JointState is not in planeMembers: add it there";
}

TEST(PlaneState, everyNumberIsInTheHash)
{
  const std::vector<std::string> names = namesOfNumbers();
  const Plane plane = countedFrom(1);
  ASSERT_EQ(numbersOf(plane).size(), names.size());
  std::set<std::uint64_t> hashes{hashOf(plane)};
  for (std::size_t changed = 0; changed < names.size(); ++changed)
  {
    Plane other = plane;
    std::size_t i = 0;
    forEachNumber(other,
                  [&](auto& number)
                  {
                    using T = std::decay_t<decltype(number)>;
                    if (i++ == changed)
                      number = std::is_same_v<T, bool> ? T(number == T(0)) : T(Real(number) + 1);
                  });
    EXPECT_TRUE(hashes.insert(hashOf(other)).second) << names[changed];
  }
  // The key tells planes apart.
  for (int side = 0; side < 2; ++side)
  {
    Plane other = plane;
    other.faceId[side] = 77;
    EXPECT_TRUE(hashes.insert(hashOf(other)).second);
  }
}

TEST(PlaneState, whatIsLeftOutOfCheckpointsAndHashHasAReason)
{
  std::set<std::string> leftOut;
  forEachMember(
      [&](const auto& member)
      {
        if (!member.leftOut)
          return;
        leftOut.insert(member.name);
        EXPECT_GT(std::strlen(member.leftOut), 0u) << member.name;
      });
  EXPECT_EQ(leftOut, (std::set<std::string>{"face_id", "face", "counted_here"}));
}

TEST(PlaneState, namesAndColumnsAreThereOnce)
{
  const std::vector<std::string> names = namesOfNumbers();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  std::set<std::string> columns;
  forEachMember(
      [&](const auto& member)
      {
        if (member.column)
        {
          EXPECT_TRUE(columns.insert(member.column).second) << member.column;
        }
      });
}

TEST(PlaneState, numbersGoThereAndBack)
{
  const Plane plane = countedFrom(1);
  const std::vector<Real> numbers = numbersOf(plane);
  Plane again;
  const Real* next = numbers.data();
  forEachNumber(again, [&](auto& number)
                { number = static_cast<std::decay_t<decltype(number)>>(*next++); });
  EXPECT_EQ(numbersOf(again), numbers);
  EXPECT_EQ(hashOf(again), hashOf(plane));
}

TEST(PlaneState, whatIsPassedOnArrivesAndIsForgotten)
{
  for (const int first : {1, 2}) // flags: as they come, and turned over
  {
    Plane giver = countedFrom(first);
    giver.faceId[0] = 10;
    giver.faceId[1] = 21;
    giver.normal = {0, 0, 1};
    giver.history.shearTraction.z = 0;
    giver.history.bonded = true;
    Plane plane;
    plane.faceId[0] = 10;
    plane.faceId[1] = 22;
    plane.joint = giver.joint;
    std::vector<Donor> donors{donorOf(giver)};
    ASSERT_TRUE(inherit(plane, {0, 0, 1}, {}, donors));
    const auto expectEqual = [](const Plane& a, const Plane& b)
    {
      forEachPassed(
          [&](const auto& member)
          {
            std::vector<Real> expected, found;
            forEachPart(member.get(a), [&](const auto& part) { expected.push_back(Real(part)); });
            forEachPart(member.get(b), [&](const auto& part) { found.push_back(Real(part)); });
            for (std::size_t i = 0; i < expected.size(); ++i)
              EXPECT_NEAR(found[i], expected[i], 1e-13 * (1 + std::abs(expected[i])))
                  << member.name;
          });
    };
    expectEqual(giver, plane);
    EXPECT_TRUE(plane.isInherited());
    forgetPassed(plane);
    expectEqual(Plane{}, plane);
    EXPECT_FALSE(plane.isInherited());
  }
}

namespace
{
/// Which of what is passed on makes a search stale when it changes, where a pair has this law.
std::set<std::string> staleFor(const JointLaw& law, bool incremental)
{
  Plane plane;
  plane.area = 1;
  plane.depthLimit = 1;
  std::set<std::string> names;
  forEachPassed(
      [&](const auto& member)
      {
        Plane other = plane;
        forEachPart(member.get(other),
                    [](auto& part)
                    {
                      using T = std::decay_t<decltype(part)>;
                      part = std::is_same_v<T, bool> ? T(part == T(0)) : T(Real(part) + 0.01);
                    });
        if (PassedOn(other, law, incremental) != PassedOn(plane, law, incremental))
          names.insert(member.name);
      });
  return names;
}

JointLaw lawWithMemory()
{
  JointLaw law;
  law.curve.inverseMaximumClosure = 1;
  law.bond.kind = Bond::Kind::Linear;
  law.dilation = 0.1;
  EXPECT_TRUE(!law.curve.straight() && law.bond.softens() && law.remembersSlip());
  return law;
}
} // namespace

TEST(PlaneState, whatIsPassedOnMakesASearchStaleOrHasAReason)
{
  std::set<std::string> excused, others;
  forEachPassed(
      [&](const auto& member)
      {
        if (std::decay_t<decltype(member)>::stale != Stale::Never)
          others.insert(member.name);
        else if (member.neverStale && *member.neverStale)
          excused.insert(member.name);
      });
  EXPECT_EQ(excused, (std::set<std::string>{"absorbed", "shear"}));
  EXPECT_EQ(staleFor(lawWithMemory(), true), others);
}

TEST(PlaneState, aSearchIsStaleOnlyByWhatTheLawRemembers)
{
  using Names = std::set<std::string>;
  const JointLaw plain;
  EXPECT_EQ(staleFor(plain, false), (Names{"bonded", "offset"}));
  EXPECT_EQ(staleFor(plain, true), (Names{"bonded", "closure", "offset"}));
  JointLaw law;
  law.curve.inverseMaximumClosure = 1;
  EXPECT_EQ(staleFor(law, false), (Names{"bonded", "maximum_closure", "offset"}));
  law = plain;
  law.bond.kind = Bond::Kind::Linear;
  EXPECT_EQ(staleFor(law, false), (Names{"bonded", "offset", "opening", "shearing"}));
  law = plain;
  law.dilation = 0.1;
  EXPECT_EQ(staleFor(law, false), (Names{"bonded", "offset", "slip"}));
  Plane idle;
  Plane closed;
  closed.offset = 1;
  EXPECT_FALSE(PassedOn(idle, plain, true) != PassedOn(closed, plain, true)) << "carry nothing";
}

TEST(PlaneState, depthsThatExplainThoseOfPairsBesideThemAreToldAtOnce)
{
  const JointLaw law;
  const auto passedAt = [&](Real closure, Real area = 1)
  {
    Plane plane;
    plane.area = area;
    plane.depthLimit = 1;
    plane.closure = closure;
    return PassedOn(plane, law, false);
  };
  const Real step = 0.25 * deepestBirth;
  EXPECT_TRUE(passedAt(0.9 * step).isAsDeepAs(passedAt(0))) << "nothing that matters";
  EXPECT_TRUE(passedAt(-3 * step, 0).isAsDeepAs(passedAt(0))) << "open";
  EXPECT_FALSE(passedAt(1.1 * step).isAsDeepAs(passedAt(0.9 * step)));
  EXPECT_FALSE(passedAt(1.1 * step).isAsDeepAs(passedAt(2.1 * step))) << "shallower";
  EXPECT_FALSE(passedAt(1.1 * step).isAsDeepAs(passedAt(1.1 * step, 0))) << "born deep";
}
} // namespace coplane
