#pragma once

#include <coplane_core/NodeViews.hpp>
#include <coplane_core/Real.hpp>

namespace coplane
{
/// A step by which nodes have come to where they are: of a cycle, or the last one of several in it.
struct Substep
{
  ConstNodeVectors v; ///< velocity in its middle [m/s]
  Real dt = 0;        ///< [s]
};
} // namespace coplane
