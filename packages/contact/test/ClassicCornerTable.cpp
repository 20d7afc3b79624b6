#include "CornerBlocks.hpp"

#include <cstdio>

// Forces of corners that are pushed into a face, by both methods, as a table on the standard
// output; docs/theory/pictures/draw-classic.py draws it. Unit stiffness, edges of unit length.

using namespace coplane;
using namespace coplane::facepairs;

namespace
{
constexpr Real depth = .01;

template <int Dim>
void row(const char* kind, Real angle, const ConvexBlock& slab, const ConvexBlock& corner)
{
  ClassicOptions classicOptions;
  const ClassicPlane section = classicCommonPlane<Dim>(slab, corner, classicOptions);
  classicOptions.area = ClassicOptions::Area::Shadow;
  const ClassicPlane shadow = classicCommonPlane<Dim>(slab, corner, classicOptions);
  const Vec3 up = section.normal;
  const Push penetrating = simplePush<Dim>(slab, section.face[0], corner, 0, alongCommonNormal);
  const Push full =
      simplePush<Dim>(slab, section.face[0], corner, 0, asInThePaper(), (-depth) * up);
  const Real classic[2] = {dot(classicPush(section).force, up), dot(classicPush(shadow).force, up)};
  const Real simple[2] = {dot(penetrating.force, up), dot(full.force, up)};
  std::printf("%s,%.17g,%d,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", kind, angle, penetrating.planes,
              classic[0], simple[0], simple[0] / classic[0], classic[1], simple[1],
              simple[1] / classic[1]);
}
} // namespace

int main()
{
  std::printf("kind,angle,planes,classic_section,simple_penetrating,ratio_penetrating,"
              "classic_shadow,simple_full,ratio_full\n");
  for (int angle = 30; angle <= 180; angle += 2)
    row<2>("corner2d", angle, slabBlock2D(), cornerBlock2D(.5 * angle * pi / 180, depth, 1));
  for (int angle = 30; angle <= 180; angle += 10)
    row<3>("corner3d", angle, slabBlock3D(), cornerBlock3D(.5 * angle * pi / 180, depth));
  const Real cube = std::asin(1 / std::sqrt(3.0));
  row<3>("cube", 2 * cube * 180 / pi, slabBlock3D(), cornerBlock3D(cube, depth));
  return 0;
}
