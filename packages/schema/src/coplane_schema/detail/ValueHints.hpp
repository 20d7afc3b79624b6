#pragma once

#include <string>

namespace coplane
{
/// How a text that is no number would be written as one, with a blank or colon before it: units,
/// percent, a decimal comma, thousands apart, Fortran's d, arithmetic. Empty: nothing comes to
/// mind.
/// @param unit of the key
std::string hintOfNumber(const std::string& text, const std::string& unit);

/// What expressions call that which others call pi, time or **; empty or " (...)".
std::string hintOfExpression(const std::string& text);
} // namespace coplane
