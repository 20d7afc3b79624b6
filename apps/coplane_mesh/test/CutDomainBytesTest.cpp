#include "CutDomainBytes.hpp"

#include <coplane_core/Error.hpp>

#include <gtest/gtest.h>

namespace coplane
{
namespace
{
/// A domain of which no member has its default.
CutDomain someDomain()
{
  CutDomain domain;
  domain.mesh.physicalNames = {{{3, 1}, "rock"}, {{2, 2}, ""}};
  domain.mesh.physicalsOfEntity = {{{3, 4}, {1}}, {{2, 5}, {2, 7}}, {{1, 6}, {}}};
  domain.mesh.nodeIds = {1, 2, 30000000000};
  domain.mesh.coordinates = {{0, -0.0, 1e-300}, {0.1, 512340.375, -2}, {1, 2, 3}};
  domain.mesh.elements = {{{3, 4}, 4, 11, {0, 1, 2, 1}}, {{2, 5}, 2, 12, {2, 1, 0}}};
  domain.joints = {"bedding", std::string("with \0 zero", 11), ""};
  domain.measures = {{5, 1, 2, 3, {4, 5, 6}}, {7, 0, 0.5, 0, {}}};
  domain.blockVolumes = {1.5, 1.0 / 3};
  domain.notes = {"odd"};
  domain.joined = 1;
  domain.stubs = 2;
  domain.slivers = 3;
  domain.changes = 4;
  domain.worstBefore = 0.25;
  domain.worst = 0.5;
  domain.worstPlace = {7, 8, 9};
  return domain;
}

void expectSame(const Vec3& a, const Vec3& b)
{
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_EQ(a[axis], b[axis]);
}

TEST(CutDomains, areTheSameOnTheOtherSide)
{
  const CutDomain sent = someDomain(), got = cutDomainOf(bytesOf(sent));
  EXPECT_EQ(got.mesh.physicalNames, sent.mesh.physicalNames);
  EXPECT_EQ(got.mesh.physicalsOfEntity, sent.mesh.physicalsOfEntity);
  EXPECT_EQ(got.mesh.nodeIds, sent.mesh.nodeIds);
  ASSERT_EQ(got.mesh.coordinates.size(), sent.mesh.coordinates.size());
  for (std::size_t n = 0; n < sent.mesh.coordinates.size(); ++n)
    expectSame(got.mesh.coordinates[n], sent.mesh.coordinates[n]);
  ASSERT_EQ(got.mesh.elements.size(), sent.mesh.elements.size());
  for (std::size_t e = 0; e < sent.mesh.elements.size(); ++e)
  {
    const GmshFile::Element &a = got.mesh.elements[e], &b = sent.mesh.elements[e];
    EXPECT_EQ(a.entity, b.entity);
    EXPECT_EQ(a.type, b.type);
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.nodes, b.nodes);
  }
  EXPECT_EQ(got.joints, sent.joints);
  ASSERT_EQ(got.measures.size(), sent.measures.size());
  for (std::size_t j = 0; j < sent.measures.size(); ++j)
  {
    const JointMeasure &a = got.measures[j], &b = sent.measures[j];
    EXPECT_EQ(a.asked, b.asked);
    EXPECT_EQ(a.slivers, b.slivers);
    EXPECT_EQ(a.stubs, b.stubs);
    EXPECT_EQ(a.largest, b.largest);
    expectSame(a.place, b.place);
  }
  EXPECT_EQ(got.blockVolumes, sent.blockVolumes);
  EXPECT_EQ(got.notes, sent.notes);
  EXPECT_EQ(got.joined, sent.joined);
  EXPECT_EQ(got.stubs, sent.stubs);
  EXPECT_EQ(got.slivers, sent.slivers);
  EXPECT_EQ(got.changes, sent.changes);
  EXPECT_EQ(got.worstBefore, sent.worstBefore);
  EXPECT_EQ(got.worst, sent.worst);
  expectSame(got.worstPlace, sent.worstPlace);
  EXPECT_EQ(bytesOf(got), bytesOf(sent));
}

TEST(CutDomains, areRefusedInPieces)
{
  const std::string whole = bytesOf(someDomain());
  const auto codeOf = [](const std::string& bytes)
  {
    try
    {
      cutDomainOf(bytes);
    }
    catch (const Error& error)
    {
      return error.code();
    }
    return ExitCode::Success;
  };
  EXPECT_EQ(codeOf(whole), ExitCode::Success);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_EQ(codeOf(whole.substr(0, size)), ExitCode::Internal) << size;
  EXPECT_EQ(codeOf(whole + '\0'), ExitCode::Internal);
}
} // namespace
} // namespace coplane
