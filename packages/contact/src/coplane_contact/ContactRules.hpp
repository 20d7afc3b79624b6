#pragma once

#include <coplane_joint/JointLaw.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// A joint card: its name and its law.
struct JointRecipe
{
  std::string name;
  JointLaw law;
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
