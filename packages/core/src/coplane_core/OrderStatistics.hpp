#pragma once

#include <coplane_core/Comm.hpp>

#include <vector>

namespace coplane
{
/// Order statistics of the values of all ranks, exact, without bringing the values together: for
/// each fraction p in [0, 1] the smallest value that at least p of all values do not exceed (0: the
/// least, 0.5: the median, 1: the largest). None when no rank has a value. The same on every rank.
/// Collective.
std::vector<Real> orderStatistics(std::vector<Real> mine, const std::vector<Real>& fractions,
                                  const Comm& comm);
} // namespace coplane
