#include "ContactRoles.hpp"

#include "detail/Names.hpp"

namespace coplane
{
namespace
{
bool fits(const std::string& pattern, const std::string& name)
{
  return pattern == "*" || pattern == name;
}
} // namespace

bool coverNames(const std::array<std::string, 2>& patterns, const std::string& a,
                const std::string& b)
{
  return !patterns[0].empty() && ((fits(patterns[0], a) && fits(patterns[1], b)) ||
                                  (fits(patterns[0], b) && fits(patterns[1], a)));
}

namespace
{
bool belongs(const ContactTraits& traits, const std::string& sideSet)
{
  return sideSet == "*" || contains(traits.sideSets, sideSet);
}

bool covers(const ContactPairCard& pair, const ContactTraits& a, const ContactTraits& b)
{
  if (coverNames(pair.blocks, a.block, b.block) ||
      coverNames(pair.materials, a.material, b.material))
    return true;
  if (!pair.jointSet.empty())
    return contains(a.sideSets, pair.jointSet) && contains(b.sideSets, pair.jointSet);
  const auto& sets = pair.sideSets;
  return !sets[0].empty() && ((belongs(a, sets[0]) && belongs(b, sets[1])) ||
                              (belongs(a, sets[1]) && belongs(b, sets[0])));
}
} // namespace

const ContactPairCard* contactPairFor(const ContactCard& contact, const ContactTraits& a,
                                      const ContactTraits& b)
{
  for (const auto& pair : contact.pairs)
    if (covers(pair, a, b))
      return &pair;
  return nullptr;
}

std::vector<bool> contactRoles(const ContactCard& contact, const ContactTraits& face)
{
  std::vector<bool> roles;
  for (const ContactPairCard& pair : contact.pairs)
    for (int side = 0; side < 2; ++side)
    {
      const std::string &block = pair.blocks[side], &material = pair.materials[side],
                        &set = pair.jointSet.empty() ? pair.sideSets[side] : pair.jointSet;
      roles.push_back(!block.empty()      ? fits(block, face.block)
                      : !material.empty() ? fits(material, face.material)
                                          : !set.empty() && belongs(face, set));
    }
  return roles;
}
} // namespace coplane
