#pragma once

#include <coplane_input/Deck.hpp>

#include <array>
#include <string>
#include <vector>

namespace coplane
{
/// What contact.pairs can tell of a face.
struct ContactTraits
{
  std::string block, material;
  std::vector<std::string> sideSets; ///< that hold the face
};

/// Whether two names fit two patterns in either order; "*" fits every name, and empty patterns
/// none.
bool coverNames(const std::array<std::string, 2>& patterns, const std::string& a,
                const std::string& b);

/// The item of contact.pairs that acts between two faces: the first that fits in either order;
/// nullptr: contact.default_joint.
const ContactPairCard* contactPairFor(const ContactCard& contact, const ContactTraits& a,
                                      const ContactTraits& b);

/// Which sides of which items a face fits, two for each item. Faces with equal roles have the same
/// items with every other face, and with each other.
std::vector<bool> contactRoles(const ContactCard& contact, const ContactTraits& face);
} // namespace coplane
