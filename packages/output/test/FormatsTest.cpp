#include <coplane_output/Sha256.hpp>
#include <coplane_output/detail/Placement.hpp>
#include <coplane_output/detail/VtpFile.hpp>

#include <gtest/gtest.h>

#include <cstring>

namespace coplane
{
namespace
{
Placement placementOn(const char* host, const std::vector<int>& cores, int threads)
{
  Placement placement;
  std::strcpy(placement.host, host);
  CPU_ZERO(&placement.cores);
  for (const int core : cores)
    CPU_SET(core, &placement.cores);
  placement.threads = threads;
  return placement;
}
} // namespace

TEST(Base64, givesTheVectorsOfRfc4648)
{
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
  // In pieces, each a multiple of three bytes.
  std::string groups;
  for (int i = 0; i < 2 << 20; ++i)
    groups += "ZmZm";
  EXPECT_EQ(base64(std::string(6 << 20, 'f') + "o"), groups + "bw==");
}

TEST(Sha256, givesTheVectorsOfFips180)
{
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  // 56 bytes: the length does not fit into the first block any more.
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(VtpPoints, nameTheirNumberInThePieceAndInEveryArray)
{
  VtpPoints points({0, 0, 0, 1, 2, 3});
  points.addScalar("area", {0.5, 0.25});
  const std::string text = points.text("<!-- of a test -->");
  EXPECT_NE(text.find("NumberOfPoints=\"2\" NumberOfVerts=\"2\""), std::string::npos);
  // 16 bytes follow: 0x10 and seven zeros, then 0.5 = 0x3fe0000000000000 and 0.25 =
  // 0x3fd0000000000000, little-endian.
  EXPECT_NE(text.find("Name=\"area\" NumberOfComponents=\"1\" "
                      "format=\"binary\">EAAAAAAAAAAAAAAAAADgPwAAAAAAANA/<"),
            std::string::npos)
      << text;
}

TEST(VtpPoints, haveSegmentsInPlaceOfVertices)
{
  VtpPoints points({0, 0, 0, 1, 0, 0, 2, 0, 0}, {0, 1, 1, 2});
  points.addScalarOfCells("force", {0.5, 0.25});
  const std::string text = points.text("<!-- of a test -->");
  EXPECT_NE(text.find("NumberOfPoints=\"3\" NumberOfVerts=\"0\" NumberOfLines=\"2\""),
            std::string::npos)
      << text;
  EXPECT_EQ(text.find("<Verts>"), std::string::npos);
  // Ends of cells: 16 bytes, then 2 and 4.
  EXPECT_NE(text.find("Name=\"offsets\" NumberOfComponents=\"1\" "
                      "format=\"binary\">EAAAAAAAAAACAAAAAAAAAAQAAAAAAAAA<"),
            std::string::npos)
      << text;
  const std::size_t cells = text.find("<CellData>"), end = text.find("</CellData>");
  const std::size_t force = text.find("Name=\"force\"");
  EXPECT_TRUE(cells < force && force < end) << text;
}

TEST(VtpPoints, keepNamesAsNumbersOfTheirCharacters)
{
  // ASCII: r 114, o 111, c 99, k 107; every name ends with a zero.
  VtpPoints points({0, 0, 0});
  points.addNames("joint_names", {"rock", "o"});
  EXPECT_NE(points.text("<!-- of a test -->")
                .find("<Array type=\"String\" Name=\"joint_names\" NumberOfTuples=\"2\" "
                      "format=\"ascii\">114 111 99 107 0 111 0 </Array>"),
            std::string::npos)
      << points.text("<!-- of a test -->");
}

TEST(CoreList, writesRanges)
{
  EXPECT_EQ(coreList(placementOn("a", {0, 1, 2, 3, 8}, 1).cores), "0-3,8");
  EXPECT_EQ(coreList(placementOn("a", {5}, 1).cores), "5");
}

TEST(PlacementProblems, areSilentWhenEveryThreadHasACore)
{
  EXPECT_TRUE(placementProblems({placementOn("a", {0, 1}, 2), placementOn("a", {2, 3}, 2),
                                 placementOn("b", {0, 1}, 2)})
                  .empty());
}

TEST(PlacementProblems, nameTheHostWhereRanksShareCores)
{
  // Both ranks may use both cores: four threads on two cores.
  const auto problems =
      placementProblems({placementOn("a", {0, 1}, 2), placementOn("a", {0, 1}, 2)});
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].find("host a: 2 ranks with 4 threads in all share cores 0-1"),
            std::string::npos)
      << problems[0];
}

TEST(PlacementProblems, seeARankThatIsBoundToOneCore)
{
  // Enough cores on the host, but mpirun has bound each rank of two threads to a single one.
  EXPECT_EQ(placementProblems({placementOn("a", {0}, 2), placementOn("a", {1, 2, 3}, 2)}).size(),
            1u);
}

TEST(MyPlacement, hasAtLeastOneCore)
{
  const Placement mine = myPlacement();
  EXPECT_GE(CPU_COUNT(&mine.cores), 1);
  EXPECT_NE(mine.host[0], '\0');
}
} // namespace coplane
