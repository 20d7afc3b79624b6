#pragma once

#include "FacePairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace coplane::facepairs
{
/// Forces at the corners of a pair sum to nothing, and so do their moments.
inline void expectBalanced(const RandomPair& pair, const Vec3 (&forces)[2][4])
{
  Vec3 force, moment;
  Real size = 0;
  const FaceNodes* faces[2] = {&pair.a, &pair.b};
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < faces[f]->count; ++i)
    {
      force += forces[f][i];
      moment += cross(faces[f]->x[i], forces[f][i]);
      size = std::max(size, norm(forces[f][i]));
    }
  EXPECT_LE(norm(force), 1e-12 * size);
  EXPECT_LE(norm(moment), 1e-11 * size);
}
} // namespace coplane::facepairs
