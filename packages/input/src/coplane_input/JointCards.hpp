#pragma once

#include <coplane_input/Deck.hpp>
#include <coplane_joint/JointLaw.hpp>
#include <coplane_schema/DeckNode.hpp>

namespace coplane
{
/// The law of a card that has passed the checks.
JointLaw jointLawOf(const JointCard& card);

/// Whether the law's stiffness comes from the elements behind the faces.
bool needsElements(const JointCard& card);

/// What one key of a card in `joints` demands of another.
void checkJoints(const std::vector<JointCard>& joints, const DeckNode& root, Problems& problems);
} // namespace coplane
