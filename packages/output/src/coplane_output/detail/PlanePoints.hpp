#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_dynamics/Solver.hpp>

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace coplane
{
/// A variable of the planes: a value, or the components of a vector one after the other, for each.
struct PlaneColumn
{
  std::string name;
  int components; ///< 1 or 3
  std::variant<std::vector<Real>, std::vector<std::int64_t>> values;
};

/// The planes of one moment as points with data, sorted by key.
struct PlanePoints
{
  std::vector<Real> coordinates; ///< x y z x y z ... [m]
  std::vector<PlaneColumn> columns;

  std::int64_t count() const { return std::int64_t(coordinates.size() / 3); }
};

/// The planes of all ranks that exist and whose faces overlap, on rank 0. Collective.
PlanePoints planePointsOf(const Solver& solver);
/// The variables alone.
PlanePoints planePointsOfNone();

/// Names that the variable `joint` counts, from 0.
std::vector<std::string> jointNames(const Solver& solver);
} // namespace coplane
