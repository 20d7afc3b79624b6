#include "TestMeshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

using namespace coplane;
using namespace coplane::testMeshes;

namespace
{
const Material yieldingSteel = makeJ2Plasticity(makeLinearElastic(200e9, 0.3, 7850), 200e6, 1e9);

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
    advance(block, x, v, dt);
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
  std::vector<Real> rows;
  a.forEachState(
      [&](const char*, int components, const ElementBlock::Values& values)
      {
        for (int k = 0; k < components; ++k)
          rows.push_back(values(k, i));
      });
  std::size_t row = 0;
  b.forEachState(
      [&](const char* name, int components, const ElementBlock::Values& values)
      {
        for (int k = 0; k < components; ++k)
          ASSERT_EQ(values(k, j), rows.at(row++)) << name << " " << k;
      });
}
} // namespace

TEST(SameBits, anElementDoesNotFeelItsPlaceInTheBlock)
{
  for (const Formulation& f : allOf(allFormulations(), revolvedFormulations()))
  {
    SCOPED_TRACE(nameOf(f));
    const TestMesh mesh = meshOf(f, 5, 0.2);
    ElementBlock whole(f.type, yieldingSteel, {0.05, 0.03}, {}, mesh.connectivity, f.options);
    // every third element only, backwards: other lanes, other neighbours, a padded end. Nodal
    // pressure sums in the order of the elements, so there all of them, one lane further.
    const bool nodal = f.options.form == ElementForm::NodalPressure;
    std::vector<int> order, connectivity;
    for (int e = whole.count() - 1; e >= 0 && !nodal; e -= 3)
      order.push_back(e);
    for (int e = 0; e < whole.count() && nodal; ++e)
      order.push_back(e);
    if (nodal) // a stranger in front
      connectivity = {mesh.nodes(), mesh.nodes() + 1, mesh.nodes() + 2};
    if (nodal && f.type == ElementType::Tet4)
      connectivity.push_back(mesh.nodes() + 3);
    for (const int e : order)
      for (int c = 0; c < mesh.corners(); ++c)
        connectivity.push_back(mesh.connectivity[e * mesh.corners() + c]);
    TestMesh more = mesh;
    more.x = NodeVectors("x", mesh.nodes() + 4);
    for (int n = 0; n < mesh.nodes(); ++n)
      set(more.x, n, at(mesh.x, n));
    set(more.x, mesh.nodes() + 1, {1, 0, 0});
    set(more.x, mesh.nodes() + 2, {0, 1, 0});
    set(more.x, mesh.nodes() + 3, {0, 0, 1});
    play(whole, more);
    ElementBlock part(f.type, yieldingSteel, {0.05, 0.03}, {}, connectivity, f.options);
    play(part, more);
    Real yielded = 0;
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      expectSameElement(part, int(i) + nodal, whole, order[i]);
      yielded += whole.history()(0, order[i]);
    }
    EXPECT_GT(yielded, 0); // the law was at work
  }
}

TEST(SameBits, bothBackEndsAgree)
{
  const Backend before = currentBackend();
  for (const Formulation& f : allOf(allFormulations(), revolvedFormulations()))
  {
    SCOPED_TRACE(nameOf(f));
    const TestMesh mesh = meshOf(f, 5, 0.2);
    ElementBlock serial(f.type, yieldingSteel, {}, {}, mesh.connectivity, f.options);
    ElementBlock threads(f.type, yieldingSteel, {}, {}, mesh.connectivity, f.options);
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
  for (const Formulation& f : allOf(allFormulations(), revolvedFormulations()))
  {
    SCOPED_TRACE(nameOf(f));
    const TestMesh mesh = meshOf(f, 3, 0.2);
    ElementBlock block(f.type, yieldingSteel, {0.05, 0.03}, {}, mesh.connectivity, f.options);
    ElementBlock copy(f.type, yieldingSteel, {0.05, 0.03}, {}, mesh.connectivity, f.options);
    NodeVectors x = plus(mesh.x, 0, mesh.x);
    block.initialise(x);
    const Real dt = 1e-5;
    const bool flat = isFlat(f.type);
    const NodeVectors v =
        field(x,
              [flat](const Vec3& p) {
                return Vec3{-300 * p.x, 200 * std::sin(9 * p.z + p.x), flat ? 0 : 100 * p.y * p.x};
              });
    x = plus(x, dt, v);
    advance(block, x, v, dt);

    // what a restart does: reference state, then all registered state, then forces
    copy.initialise(mesh.x);
    std::vector<ElementBlock::Values> saved;
    block.forEachState([&](const char*, int, const ElementBlock::Values& values)
                       { saved.push_back(values); });
    int table = 0;
    copy.forEachState(
        [&](const char*, int rows, const ElementBlock::Values& values)
        {
          for (int row = 0; row < rows; ++row)
            for (std::size_t e = 0; e < values.extent(1); ++e)
              values(row, e) = saved[table](row, e);
          ++table;
        });
    advance(copy, x, v, 0);
    for (int e = 0; e < block.count(); ++e)
      expectSameElement(block, e, copy, e);
  }
}
