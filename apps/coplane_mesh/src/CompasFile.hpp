#pragma once

#include "Polyhedron.hpp"

#include <string>
#include <vector>

namespace coplane
{
/// The blocks of an assembly that the COMPAS framework has written as JSON, in the order of the
/// file. Three layouts are known, from compas_assembly and compas_dem:
///
///   {"assembly": {"vertex" or "node": {key: {"is_support": ...}}},
///    "blocks": {key: {"vertex": {k: {"x", "y", "z"}}, "face": {k: [keys of vertices]}}}}
///   {"dtype": ".../Assembly", "data": {"graph": {"data": {"node": {key:
///     {"block": {"dtype": ".../Block", "data": {"vertex", "face"}}, "is_support": ...}}}}}}
///   {"dtype": ".../BlockModel", "data": {"elements": {guid:
///     {"dtype": ".../Block", "data": {"geometry": {"data": {"vertex", "face"}}, "is_support": ...,
///      "transformation": null or {"data": {"matrix": 4 x 4}}}}}}}
///
/// Coordinates that are missing are those of `default_vertex_attributes` (or `dva`). Interfaces and
/// results are left out. If a face is not plane, all faces of its block are cut into triangles from
/// the corner that comes first in space, as the neighbour's are.
/// @throws Error(ExitCode::Mesh) for what cannot be read, and for surfaces that are not closed
std::vector<Polyhedron> readCompasBlocks(const std::string& file);
} // namespace coplane
