#include "TestMeshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

using namespace coplane;
using namespace coplane::testMeshes;

namespace
{
const Material steel = makeJ2Plasticity(200e9, 0.3, 7850, 200e6, 1e9);

/// Some cycles of large motion; the same nodal history whatever the block is made of.
void play(ElementBlock& block, const TestMesh& mesh)
{
  block.initialise(mesh.x);
  NodeVectors x = plus(mesh.x, 0, mesh.x);
  const Real dt = 1e-5;
  for (int cycle = 0; cycle < 5; ++cycle)
  {
    const NodeVectors v =
        field(x,
              [cycle, &mesh](const Vec3& p)
              {
                return Vec3{300 * std::sin(9 * p.y + cycle), -200 * std::cos(7 * p.x),
                            isFlat(mesh.type) ? 0 : 250 * std::sin(5 * p.x * p.y)};
              });
    x = plus(x, dt, v);
    block.update(x, v, dt);
  }
}

void expectSameElement(const ElementBlock& a, int i, const ElementBlock& b, int j)
{
  for (int c = 0; c < int(a.connectivity().extent(1)); ++c)
    for (int k = 0; k < 3; ++k)
      ASSERT_EQ(a.cornerForce()(i, c, k), b.cornerForce()(j, c, k));
  for (int k = 0; k < 6; ++k)
    ASSERT_EQ(a.stress()(k, i), b.stress()(k, j));
  for (int k = 0; k < elementEnergies; ++k)
    ASSERT_EQ(a.energies()(k, i), b.energies()(k, j));
  ASSERT_EQ(a.stableStep()(i), b.stableStep()(j));
  ASSERT_EQ(a.history()(0, i), b.history()(0, j));
}
} // namespace

TEST(SameBits, anElementDoesNotFeelItsPlaceInTheBlock)
{
  for (const ElementType type : allTypes)
  {
    const TestMesh mesh = distorted(type, 5, 0.2);
    ElementBlock whole(type, steel, {0.05, 0.03}, {}, mesh.connectivity);
    play(whole, mesh);
    // every third element only, backwards: other lanes, other neighbours, a padded end
    std::vector<int> order, connectivity;
    for (int e = whole.count() - 1; e >= 0; e -= 3)
      order.push_back(e);
    for (const int e : order)
      for (int c = 0; c < mesh.corners(); ++c)
        connectivity.push_back(mesh.connectivity[e * mesh.corners() + c]);
    ElementBlock part(type, steel, {0.05, 0.03}, {}, connectivity);
    play(part, mesh);
    Real yielded = 0;
    for (int i = 0; i < part.count(); ++i)
    {
      expectSameElement(part, i, whole, order[i]);
      yielded += part.history()(0, i);
    }
    EXPECT_GT(yielded, 0); // the law was at work
  }
}

TEST(SameBits, bothBackEndsAgree)
{
  const Backend before = currentBackend();
  for (const ElementType type : allTypes)
  {
    const TestMesh mesh = distorted(type, 5, 0.2);
    ElementBlock serial(type, steel, {}, {}, mesh.connectivity);
    ElementBlock threads(type, steel, {}, {}, mesh.connectivity);
    setBackend(Backend::Serial);
    play(serial, mesh);
    setBackend(Backend::Threads);
    play(threads, mesh);
    setBackend(before);
    for (int e = 0; e < serial.count(); ++e)
      expectSameElement(serial, e, threads, e);
  }
}

TEST(SameBits, updateOverNoTimeGivesTheSameForcesAgain)
{
  for (const ElementType type : {ElementType::Tet4, ElementType::Hex8})
  {
    const TestMesh mesh = distorted(type, 3, 0.2);
    ElementBlock block(type, steel, {0.05, 0.03}, {}, mesh.connectivity);
    ElementBlock copy(type, steel, {0.05, 0.03}, {}, mesh.connectivity);
    NodeVectors x = plus(mesh.x, 0, mesh.x);
    block.initialise(x);
    const Real dt = 1e-5;
    const NodeVectors v = field(x,
                                [](const Vec3& p) {
                                  return Vec3{-300 * p.x, 200 * std::sin(9 * p.z), 100 * p.y * p.x};
                                });
    x = plus(x, dt, v);
    block.update(x, v, dt);

    // what a restart does: reference state, then all registered state, then forces
    copy.initialise(mesh.x);
    std::vector<ElementBlock::Values> saved;
    block.forEachState([&](const char*, int, const ElementBlock::Values& values)
                       { saved.push_back(values); });
    int table = 0;
    copy.forEachState([&](const char*, int, const ElementBlock::Values& values)
                      { Kokkos::deep_copy(values, saved[table++]); });
    copy.update(x, v, 0);
    for (int e = 0; e < block.count(); ++e)
      expectSameElement(block, e, copy, e);
  }
}
