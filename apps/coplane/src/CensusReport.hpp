#pragma once

#include <coplane_contact/Contact.hpp>

namespace coplane
{
/// Prints the census of contact before the first step. Collective.
void reportCensus(const Contact& contact);
} // namespace coplane
