#pragma once

#include <coplane_core/Vec3.hpp>

#include <map>
#include <string>
#include <vector>

namespace coplane
{
/// One fracture of a file: numbers by the names of the columns, or a polygon.
struct Fracture
{
  int line = 0; ///< of the file, from 1
  std::map<std::string, Real> values;
  std::vector<Vec3> corners; ///< in a plane [m]; empty: the numbers say all
};

/// Reads a table of fractures (traces in two dimensions, discs in three), or polygons.dat of
/// dfnWorks. Throws Error(ExitCode::Deck) with file and line, what was found and what is accepted.
std::vector<Fracture> readFractures(const std::string& file, int dimension);
} // namespace coplane
