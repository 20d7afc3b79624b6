#pragma once

#include "JointPoint.hpp"
#include "PointDeck.hpp"

#include <functional>

namespace coplane
{
/// Leads a joint along the path of a card; `record` sees the point at the start and after every
/// step.
void followPath(const JointPathCard& card, JointPoint point,
                const std::function<void(const JointPoint&)>& record);

/// The point of a card before its path starts.
JointPoint pointOf(const PointDeck& deck, const JointPathCard& card);
} // namespace coplane
