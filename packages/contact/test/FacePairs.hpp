#pragma once

#include <coplane_contact/detail/PotentialKernel.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

// Pairs of faces for the tests of steps A to H. What takes long to compile is in FacePairs.cpp.

namespace coplane::facepairs
{
inline FaceNodes face(const std::vector<Vec3>& x, const Vec3& velocity = {})
{
  FaceNodes nodes;
  nodes.count = int(x.size());
  for (int i = 0; i < nodes.count; ++i)
  {
    nodes.x[i] = x[i];
    nodes.v[i] = velocity;
  }
  return nodes;
}

/// Unit square looking up at z = 0.
inline FaceNodes squareBelow(const Vec3& velocity = {})
{
  return face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, velocity);
}

/// Square looking down, sunk in by `depth`, covering `width` of the lower one.
inline FaceNodes squareAbove(Real depth, const Vec3& velocity = {}, Real width = 1)
{
  return face({{0, 0, -depth}, {0, 1, -depth}, {width, 1, -depth}, {width, 0, -depth}}, velocity);
}

/// Rotation by an angle about an axis.
inline Mat3 rotation(Vec3 axis, Real angle)
{
  axis = normalised(axis);
  const Real c = std::cos(angle), s = std::sin(angle);
  Mat3 r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r(i, j) = (i == j ? c : 0) + (1 - c) * axis[i] * axis[j];
  r(0, 1) -= s * axis.z;
  r(0, 2) += s * axis.y;
  r(1, 0) += s * axis.z;
  r(1, 2) -= s * axis.x;
  r(2, 0) -= s * axis.y;
  r(2, 1) += s * axis.x;
  return r;
}

/// 30, 20 and 50 degrees about x, y and z.
inline Mat3 oblique()
{
  return rotation({0, 0, 1}, 50 * pi / 180) *
         (rotation({0, 1, 0}, 20 * pi / 180) * rotation({1, 0, 0}, 30 * pi / 180));
}

inline FaceNodes moved(FaceNodes face, const Mat3& r, const Vec3& shift = {})
{
  for (int i = 0; i < face.count; ++i)
  {
    face.x[i] = r * face.x[i] + shift;
    face.v[i] = r * face.v[i];
  }
  return face;
}

/// Same face, numbered from another node.
inline FaceNodes startedAt(const FaceNodes& face, int first)
{
  FaceNodes result = face;
  for (int i = 0; i < face.count; ++i)
  {
    result.x[i] = face.x[(i + first) % face.count];
    result.v[i] = face.v[(i + first) % face.count];
  }
  return result;
}

/// A plane with its law, and with the forces on the corners of its two faces that a cycle with
/// this plane alone gives.
struct PairPlane : coplane::Plane
{
  JointLaw law;
  Vec3 cornerForce[2][4] = {};
};

/// A plane that exists already and whose joint is just closed at zero gap.
inline PairPlane touchingPlane(Real stiffness = 1, Real friction = 0)
{
  PairPlane plane;
  plane.state = PlaneState::Open;
  plane.sighting = Sighting::Known;
  plane.law.penalty = false;
  plane.law.initialStiffness = stiffness;
  plane.law.friction = friction;
  plane.fit = plane.law.fittedTo(1, 1, 1, 1);
  return plane;
}

const ContactOptions alongCommonNormal = ContactOptions::with(ContactOptions::Forces::CommonNormal);

/// Steps A to H by the forces of the options.
template <int Dim>
void updatePlane(PairPlane& plane, const FaceNodes& a, const FaceNodes& b, const ContactOptions& o,
                 Real dt);

/// Choices that forces along the common normal have.
inline ContactOptions options(ContactOptions::Area area, ContactOptions::Weights weights)
{
  ContactOptions o = alongCommonNormal;
  o.area = area;
  o.weights = weights;
  return o;
}

constexpr ContactOptions::Weights allWeights[3] = {ContactOptions::Weights::Pressure,
                                                   ContactOptions::Weights::Average,
                                                   ContactOptions::Weights::Centroid};
constexpr ContactOptions::Area allAreas[2] = {ContactOptions::Area::Penetrating,
                                              ContactOptions::Area::Full};

/// The options that follow the paper to the letter.
inline ContactOptions asInThePaper()
{
  ContactOptions o = options(ContactOptions::Area::Full, ContactOptions::Weights::Centroid);
  o.closure = ContactOptions::Closure::Incremental;
  return o;
}

/// Two faces that overlap and penetrate somewhere, warped by up to `warp`, in a random attitude:
///
///      2 ___ 1
///       |   |      face 1, looking down: clockwise seen from above
///      3|___|0
///       3 ___ 2
///        |   |     face 0, looking up: counter-clockwise seen from above
///       0|___|1
struct RandomPair
{
  FaceNodes a, b;
};

inline RandomPair randomPair(std::mt19937& random, Real warp, Real speed = 1)
{
  std::uniform_real_distribution<Real> u(-1, 1);
  const auto some = [&] { return u(random); };
  RandomPair pair;
  const Mat3 r = rotation({some(), some(), some()}, pi * some());
  const Vec3 shift{some(), some(), some()};
  for (int f = 0; f < 2; ++f)
  {
    FaceNodes& face = f == 0 ? pair.a : pair.b;
    face.count = some() < 0 ? 3 : 4;
    face.mass = 1.5 + some();
    const Real turn = pi * some();
    const Vec3 center{.3 * some(), .3 * some(), f == 0 ? 0 : -.05 - .05 * some()};
    for (int i = 0; i < face.count; ++i)
    {
      const Real angle = turn + (f == 0 ? 2 : -2) * pi * (i + .2 * some()) / face.count;
      const Real radius = .8 + .2 * some();
      face.x[i] =
          r * (center + Vec3{radius * std::cos(angle), radius * std::sin(angle), warp * some()}) +
          shift;
      face.v[i] = {speed * some(), speed * some(), speed * some()};
    }
  }
  return pair;
}

inline RandomPair randomSegments(std::mt19937& random, Real speed = 1)
{
  std::uniform_real_distribution<Real> u(-1, 1);
  const auto some = [&] { return u(random); };
  RandomPair pair;
  const Mat3 r = rotation({0, 0, 1}, pi * some());
  for (int f = 0; f < 2; ++f)
  {
    FaceNodes& face = f == 0 ? pair.a : pair.b;
    face.count = 2;
    face.mass = 1.5 + some();
    for (int i = 0; i < 2; ++i)
    {
      // Face 0 has its normal (t_y, -t_x) along +y when it runs towards -x.
      const Real side = (i == 0) == (f == 0) ? 1 : -1;
      face.x[i] = r * Vec3{side + .3 * some(), (f == 0 ? .1 : -.1) + .2 * some(), 0};
      face.v[i] = {speed * some(), speed * some(), 0};
    }
  }
  return pair;
}

/// Area of a face, or the largest of the triangles of its corners [m^2].
inline Real areaOrTriangle(const HalfStepFace& face)
{
  Real most = face.area;
  for (int skip = 0; skip < 4 && face.count == 4; ++skip)
  {
    const Vec3 &p = face.x[(skip + 1) % 4], &q = face.x[(skip + 2) % 4],
               &r = face.x[(skip + 3) % 4];
    most = std::max(most, .5 * norm(cross(q - p, r - p)));
  }
  return most;
}

/// Sum of forces and of their moments about the origin.
struct Resultant
{
  Vec3 force{}, moment{};
};

inline Resultant resultant(const FaceNodes& a, const FaceNodes& b, const Vec3 (&forces)[2][4])
{
  Resultant sum;
  const FaceNodes* faces[2] = {&a, &b};
  for (int f = 0; f < 2; ++f)
    for (int i = 0; i < faces[f]->count; ++i)
    {
      sum.force += forces[f][i];
      sum.moment += cross(faces[f]->x[i], forces[f][i]);
    }
  return sum;
}

/// Steps A to D alone.
struct PairContact
{
  HalfStepFace a, b;
  TrialPlane trial;
  Shadow shadowA, shadowB;
  Patch patch;

  RelativeMotion motion() const
  {
    return relativeMotion(a, b, patch, armBetween(trial, shadowA, shadowB, patch));
  }
};

template <int Dim>
PairContact contactOf(const FaceNodes& a, const FaceNodes& b, const ContactOptions& o, Real dt = 0);
} // namespace coplane::facepairs
