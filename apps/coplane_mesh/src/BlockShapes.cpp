#include "ShapeModel.hpp"

#include <cmath>

namespace coplane
{
using namespace schema;

namespace
{
struct WallOpeningCard
{
  std::string where;
  std::vector<Real> x;      ///< [m]
  std::vector<int> courses; ///< first and last, from 1
};

struct WallParameters
{
  int dimension = 0;
  Bond bond = Bond::Running;
  std::vector<Real> brick; ///< [m]
  int courses = 0, bricks = 0;
  std::vector<int> divisions;
  std::vector<WallOpeningCard> openings;
};

struct ImbricateParameters
{
  int dimension = 0;
  std::vector<Real> brick; ///< thickness, length [m]
  int layers = 0, bricks = 0;
  std::vector<int> divisions;
};

struct RockParameters
{
  int dimension = 0;
  std::vector<int> blocks;
  std::vector<Real> size; ///< [m]
  std::vector<int> divisions;
};

constexpr const char* halfBricks = "elements along a brick, and a half brick takes half of them";

void checkWallOpening(WallOpeningCard& opening, const CardPlace& place)
{
  if (!(opening.x[1] > opening.x[0]))
    place.problem(
        "x", fmt::format("= [{}, {}]: the lower end comes first.", opening.x[0], opening.x[1]));
  if (opening.courses[1] < opening.courses[0])
    place.problem("courses", fmt::format("= [{}, {}]: the lower course comes first.",
                                         opening.courses[0], opening.courses[1]));
}

void checkWall(const WallParameters& p, const CardPlace& place)
{
  for (const WallOpeningCard& opening : p.openings)
    if (opening.courses[1] > p.courses)
      place.problem("openings", fmt::format("reach up to course {}, and the wall has {}.",
                                            opening.courses[1], p.courses));
  if (p.bond == Bond::Running)
    return demandEven(place, "divisions", p.divisions[0], halfBricks);
  if (p.bond == Bond::Stack)
    return;
  const char* const name = p.bond == Bond::English ? "english" : "flemish";
  if (p.dimension == 2)
    return place.problem("bond", fmt::format("= {} needs three dimensions: headers lie across the "
                                             "wall. In two, use running or stack.",
                                             name));
  if (p.divisions[0] % 4 != 0)
    place.problem("divisions", fmt::format("= {} along x must be a multiple of 4: closers are a "
                                           "quarter of a brick.",
                                           p.divisions[0]));
  if (std::abs(p.brick[2] - p.brick[0] / 2) > 1e-9 * p.brick[0])
    place.problem("brick", fmt::format("is {} m long and {} m wide; {} bond needs half the length "
                                       "as width (with the joints counted in).",
                                       p.brick[0], p.brick[2], name));
  if (p.bond == Bond::English && p.bricks < 2)
    place.problem("length_in_bricks", "= 1: English bond needs 2 or more.");
  if (p.bond == Bond::Flemish && (p.bricks < 4 || p.bricks % 3 != 1))
    place.problem("length_in_bricks",
                  fmt::format("= {}: Flemish bond needs 4, 7, 10, ...: whole pairs of stretcher "
                              "and header, and a stretcher.",
                              p.bricks));
}

void checkImbricate(const ImbricateParameters& p, const CardPlace& place)
{
  demandEven(place, "divisions", p.divisions[1], halfBricks);
}

std::vector<Body> makeLaw(const WallParameters& p)
{
  std::vector<WallOpening> openings;
  for (const WallOpeningCard& card : p.openings)
    openings.push_back({card.x[0], card.x[1], card.courses[0] - 1, card.courses[1] - 1});
  return wallOfBricks(p.dimension, p.bond, toVec3(p.brick), p.courses, p.bricks,
                      toCounts(p.divisions), openings);
}

std::vector<Body> makeLaw(const ImbricateParameters& p)
{
  return imbricate(p.brick[0], p.brick[1], p.layers, p.bricks, toCounts(p.divisions));
}

std::vector<Body> makeLaw(const RockParameters& p)
{
  return jointedRock(p.dimension, toCounts(p.blocks), toVec3(p.size), toCounts(p.divisions));
}
} // namespace

ShapeModel wallModel()
{
  using P = WallParameters;
  return ShapeModelOf<P>("wall", "bricks along x, courses upward in y, thickness in z")
      .has({
          choice("bond", &P::bond,
                 {{"running", Bond::Running},
                  {"stack", Bond::Stack},
                  {"english", Bond::English},
                  {"flemish", Bond::Flemish}})
              .like("english")
              .means("running: even courses (the second, fourth, ...) are shifted by half a brick, "
                     "with half bricks at their ends. stack: courses alike. english: courses of "
                     "stretchers in two leaves and of headers in turn. flemish: stretchers and "
                     "headers in turn in each course. Headers lie across the wall, which is then "
                     "as thick as a brick is long (3D)"),
          numbers("brick", &P::brick)
              .needed()
              .byDimension()
              .in("m")
              .above(0)
              .like("[0.64, 0.32, 0.64]")
              .means("size of a whole brick"),
          count("courses", &P::courses).in("courses").like("20").means("one above the other"),
          count("length_in_bricks", &P::bricks)
              .in("bricks")
              .like("10")
              .means("length of a course in whole bricks"),
          divisions<P>("of a whole brick; even along x, with headers a multiple of 4"),
          list("openings", &P::openings,
               {
                   numbers("x", &WallOpeningCard::x, 2)
                       .needed()
                       .in("m")
                       .like("[1, 2]")
                       .means("from and to, along the wall"),
                   []
                   {
                     Key key = integers("courses", &WallOpeningCard::courses)
                                   .needed()
                                   .in("courses")
                                   .atLeast(1)
                                   .like("[4, 12]")
                                   .means("first and last, counted from 1");
                     key.length = 2;
                     return key;
                   }(),
               })
              .orOneAlone()
              .checkedBy(checkWallOpening)
              .means("holes; bricks at their sides are trimmed. A lintel is a part of its own: "
                     "leave its courses out of the wall above the hole"),
      })
      .demands(checkWall);
}

ShapeModel imbricateModel()
{
  using P = ImbricateParameters;
  return ShapeModelOf<P>("imbricate",
                         "wall in layers through its thickness (x), bricks along y, centred on y = "
                         "0 (2D); layers 1, 3, ... have half bricks at their ends, layers 2, 4, "
                         "... whole ones only")
      .existsIn(2, "wall")
      .has({
          numbers("brick", &P::brick, 2)
              .needed()
              .in("m")
              .above(0)
              .like("[0.0125, 0.05]")
              .means("thickness and length of a whole brick"),
          count("layers", &P::layers).in("layers").like("4").means("through the thickness"),
          count("length_in_bricks", &P::bricks)
              .in("bricks")
              .like("12")
              .means("length of a layer in whole bricks"),
          divisions<P>("of a whole brick along x and y; even along y"),
      })
      .demands(checkImbricate);
}

ShapeModel rockModel()
{
  using P = RockParameters;
  return ShapeModelOf<P>("rock", "joint sets at right angles: equal blocks from the origin")
      .has({
          integers("blocks", &P::blocks)
              .needed()
              .byDimension()
              .in("blocks")
              .atLeast(1)
              .like("[20, 20]")
              .means("along x, y, z"),
          numbers("size", &P::size)
              .needed()
              .byDimension()
              .in("m")
              .above(0)
              .like("[1, 1]")
              .means("lengths of the edges of one block"),
          divisions<P>("of one block"),
      });
}
} // namespace coplane
