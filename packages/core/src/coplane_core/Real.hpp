#pragma once

#include <cstdint>
#include <limits>

namespace coplane
{
/// The one floating-point type of the state. SI units everywhere.
using Real = double;

/// Ids of nodes and elements as the mesh file has them: positive, unique, independent of the
/// partition.
using GlobalId = std::int64_t;

constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
constexpr Real infinity = std::numeric_limits<Real>::infinity();
constexpr Real pi = 3.141592653589793238462643383279502884;
} // namespace coplane
