#pragma once

#include <coplane_joint/JointLaw.hpp>

#include <string>
#include <utility>
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
  int item = -1; ///< of the list that it comes from; -1: the default
};

/// Rules for faces by their group: faces of one block and, where the deck tells side sets apart, of
/// the same side sets. The first groups are the blocks.
struct ContactRules
{
  std::vector<JointRecipe> joints;
  /// Items of the list of rules that declare joints closed, and what they are called in messages.
  std::vector<std::pair<int, std::string>> declaredItems;
  int groups = 0;
  std::vector<ContactRule> table; ///< [group a * groups + group b], symmetric

  const ContactRule& between(int a, int b) const { return table[a * groups + b]; }
};
} // namespace coplane
