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

/// What acts between two faces.
struct ContactRule
{
  int joint = 0;         ///< index into ContactRules::joints
  bool declared = false; ///< closed at the start: gaps and overlaps of the mesh are absorbed
  bool excluded = false;
};

/// Rules for faces by their group: faces of one block and, where the deck tells side sets apart, of
/// the same side sets. The first groups are the blocks.
struct ContactRules
{
  std::vector<JointRecipe> joints;
  int groups = 0;
  std::vector<ContactRule> table; ///< [group a * groups + group b], symmetric

  const ContactRule& between(int a, int b) const { return table[a * groups + b]; }
};
} // namespace coplane
