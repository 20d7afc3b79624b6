#include "ShapeModel.hpp"

namespace coplane
{
using namespace schema;

namespace
{
struct WallParameters
{
  int dimension = 0;
  std::vector<Real> brick; ///< [m]
  int courses = 0, bricks = 0;
  std::vector<int> divisions;
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

void checkWall(const WallParameters& p, const CardPlace& place)
{
  demandEven(place, "divisions", p.divisions[0], halfBricks);
}

void checkImbricate(const ImbricateParameters& p, const CardPlace& place)
{
  demandEven(place, "divisions", p.divisions[1], halfBricks);
}

std::vector<Body> makeLaw(const WallParameters& p)
{
  return runningBond(p.dimension, toVec3(p.brick), p.courses, p.bricks, toCounts(p.divisions));
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
  return ShapeModelOf<P>("wall",
                         "running bond: bricks along x, courses upward in y, thickness in z; odd "
                         "courses (the second, fourth, ...) are shifted by half a brick, with half "
                         "bricks at their ends")
      .has({
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
          divisions<P>("of a whole brick; even along x"),
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
