#pragma once

#include <coplane_core/Error.hpp>
#include <coplane_core/Real.hpp>

#include <string>

namespace coplane
{
/// Throws Error(ExitCode::Deck): "material: <what> is <value> <unit>, but must be <accepted>.",
/// unless the value is good.
inline void demand(bool good, const char* what, Real value, const char* unit,
                   const std::string& accepted)
{
  if (!good)
    fail(ExitCode::Deck, "material: {} is {}{}{}, but must be {}.", what, value, *unit ? " " : "",
         unit, accepted);
}
} // namespace coplane
