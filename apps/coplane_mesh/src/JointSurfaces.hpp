#pragma once

#include "BlocksRecipe.hpp"

#include <random>
#include <string>
#include <vector>

namespace coplane
{
/// One plane piece of a joint: a polygon in three dimensions, two ends in two.
struct JointSurface
{
  int joint = 0;             ///< position in the recipe
  std::vector<Vec3> corners; ///< [m]
  std::string source;        ///< what the user calls it; empty: one of a set
};

/// The pieces of all joints but Voronoi cells, in the order of the recipe. Planes without ends
/// reach beyond the box [low, high]. What is random depends on the seed and on the position of the
/// joint among the others, and on nothing else. Files stand beside `recipeFile`; what they say
/// wrong is a problem at the joint.
std::vector<JointSurface> jointSurfaces(const BlocksRecipe& recipe, const std::string& recipeFile,
                                        const Vec3& low, const Vec3& high, Problems& problems);

/// Unit normal, pointing upward, of a plane that descends at `dip` below the horizontal towards the
/// azimuth `dipDirection`, clockwise from north seen from above [degrees].
Vec3 normalOfDip(Real dip, Real dipDirection, const Vec3& up, const Vec3& north);

/// Random numbers with the same values on every machine.
class Draws
{
public:
  Draws(int seed, int stream);
  Real uniform(); ///< in [0, 1)
  Real normal();  ///< mean 0, standard deviation 1

private:
  std::mt19937_64 engine_;
};
} // namespace coplane
