#pragma once

#include <coplane_geometry/Mirror.hpp>
#include <coplane_joint/JointLaw.hpp>

#include <numeric>
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
/// the same side sets. The first groups are the blocks. There may be tens of thousands of them, but
/// few kinds that rules tell apart.
struct ContactRules
{
  std::vector<JointRecipe> joints;
  /// Items of the list of rules that declare joints closed, and what they are called in messages.
  std::vector<std::pair<int, std::string>> declaredItems;
  int kinds = 0;
  std::vector<int> kindOf;        ///< by group
  std::vector<ContactRule> table; ///< [kind a * kinds + kind b], symmetric
  /// In which bodies go on as their images: nothing comes to faces there. At most eight.
  std::vector<Mirror> mirrors;

  int groups() const { return int(kindOf.size()); }
  /// Rules between every two of so many groups.
  void tellApart(int groups)
  {
    kinds = groups;
    kindOf.resize(std::size_t(groups));
    std::iota(kindOf.begin(), kindOf.end(), 0);
    table.assign(std::size_t(groups) * std::size_t(groups), {});
  }
  const ContactRule& between(int a, int b) const
  {
    return table[std::size_t(kindOf[a]) * std::size_t(kinds) + std::size_t(kindOf[b])];
  }
};
} // namespace coplane
