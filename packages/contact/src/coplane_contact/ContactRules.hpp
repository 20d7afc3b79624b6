#pragma once

#include <coplane_joint/HyperbolicCoulombJoint.hpp>

#include <optional>
#include <string>
#include <vector>

namespace coplane
{
/// A joint law before it is fitted to a pair of faces.
struct JointRecipe
{
  std::string name;
  /// Penalty contact takes its normal stiffness from the elements behind the faces: fraction /
  /// (h0/M0 + h1/M1), which is `fraction` times the stiffness of the two elements in series.
  bool penalty = true;
  Real stiffnessFraction = 0.5;
  Real initialStiffness = 0;      ///< [Pa/m], unless penalty
  Real inverseMaximumClosure = 0; ///< [1/m]
  std::optional<Real>
      stiffnessCap; ///< [Pa/m]; default for curved laws: 0.5 M/h of the softer element
  std::optional<Real> shearStiffness; ///< [Pa/m]; default shearRatio times the initial stiffness
  Real shearRatio = 0.5;
  Real friction = 0;
  Real cohesion = 0; ///< [Pa]

  /// h: thickness of the elements behind the faces at birth [m]; M: their undamaged P-wave modulus
  /// [Pa].
  HyperbolicCoulombJoint fittedTo(Real h0, Real M0, Real h1, Real M1) const;
};

/// Which law acts between two blocks of the mesh.
struct ContactRule
{
  int joint = 0;         ///< index into ContactRules::joints
  bool declared = false; ///< closed at the start: gaps and overlaps of the mesh are absorbed
  bool excluded = false;
};

struct ContactRules
{
  std::vector<JointRecipe> joints;
  int blocks = 0;
  std::vector<ContactRule> table; ///< [block a * blocks + block b], symmetric

  const ContactRule& between(int a, int b) const { return table[a * blocks + b]; }
};
} // namespace coplane
