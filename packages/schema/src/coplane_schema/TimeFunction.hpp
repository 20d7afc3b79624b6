#pragma once

#include <coplane_core/Real.hpp>

#include <string>
#include <vector>

namespace coplane
{
/// A number, a muParser expression of t [s] (conditions that vary in time), or a table over t; of
/// x, y, z [m] where a PlaceFunction is meant (states that vary in space).
struct TimeFunction
{
  std::string expression; ///< empty: constant or table
  Real constant = 0;
  std::vector<Real> times;  ///< of a table, rising [s]; straight lines between, constant outside
  std::vector<Real> values; ///< of a table
  bool ofPlace = false;     ///< the expression has x, y or z beside t
  std::string where;
};

using PlaceFunction = TimeFunction;
} // namespace coplane
