#pragma once

#include "FacePairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace coplane::facepairs
{
/// A length for each face, as PairPotential::lay() has them.
struct Layers
{
  Real parts[2][3];

  explicit Layers(const LinearOnFace* laid)
  {
    for (int f = 0; f < 2; ++f)
    {
      parts[f][0] = laid[f].atCenter;
      parts[f][1] = laid[f].along[0];
      parts[f][2] = laid[f].along[1];
    }
  }
};

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

/// Largest eigenvalue of the second derivatives of the energy of a plane that carries, by central
/// differences of its forces over h [m], over what the plane adds to the stiffness of its nodes
/// [-]. A step that follows that bound needs it below 1, or some times that with what it leaves.
template <int Dim>
Real stiffnessOverBound(const RandomPair& pair, PairPlane plane, const ContactOptions& options,
                        Real h)
{
  constexpr int perFace = Dim == 2 ? 2 : 4, count = 2 * perFace * Dim;
  plane.area = 1e-9;
  const auto faceOf = [](int k) { return k / (perFace * Dim); };
  const auto nodeOf = [](int k) { return k / Dim % perFace; };
  const auto at = [&](int k, Real by)
  {
    FaceNodes faces[2] = {pair.a, pair.b};
    faces[faceOf(k)].x[nodeOf(k)][k % Dim] += by;
    PairPlane there = plane;
    updatePlane<Dim>(there, faces[0], faces[1], options, 0);
    return there;
  };
  std::vector<std::vector<Real>> matrix(count, std::vector<Real>(count));
  for (int k = 0; k < count; ++k)
  {
    const PairPlane up = at(k, h), down = at(k, -h);
    for (int j = 0; j < count; ++j)
      matrix[k][j] =
          -(up.nodal[faceOf(j)][nodeOf(j)][j % Dim] - down.nodal[faceOf(j)][nodeOf(j)][j % Dim]) /
          (2 * h);
  }
  std::vector<Real> v(count);
  for (int k = 0; k < count; ++k)
    v[k] = std::sin(1 + k * k);
  Real size = 0;
  for (int step = 0; step < 200; ++step)
  {
    std::vector<Real> next(count);
    Real square = 0;
    for (int k = 0; k < count; ++k)
      for (int j = 0; j < count; ++j)
        next[k] += matrix[k][j] * v[j];
    for (const Real x : next)
      square += x * x;
    size = std::sqrt(square);
    for (int k = 0; k < count; ++k)
      v[k] = size > 0 ? next[k] / size : 0;
  }
  const Real bound = at(0, 0).nodeStiffness;
  return bound > 0 ? size / bound : 0;
}
} // namespace coplane::facepairs
