#pragma once

#include <coplane_contact/ContactRules.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_dynamics/Conditions.hpp>
#include <coplane_element/ElementBlock.hpp>
#include <coplane_material/Material.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <optional>
#include <string>
#include <vector>

namespace coplane
{
/// What an element block is made of and how it starts.
struct BlockSetup
{
  std::string name; ///< for messages
  Material material;
  HourglassOptions hourglass;
  Vec3 velocity{}, angularVelocity{}, center{}; ///< rigid motion at the start
  SymTensor stress{};                           ///< at the start, tension positive [Pa]
};

struct TimeOptions
{
  Real end = 0; ///< [s]
  Real stepFactor = 0.8;
  std::optional<Real> maximumStep, fixedStep; ///< [s]
  Real energyTolerance = 0.1;                 ///< fraction of the energy in play
};

/// Everything the solver needs to know, on this rank.
struct Model
{
  RankMesh mesh;
  std::vector<BlockSetup> blocks; ///< one per block of the mesh file
  BulkViscosity viscosity;
  bool contactEnabled = true;
  ContactOptions contact;
  ContactRules contactRules;
  /// Contact groups of faces that are not in the group of their block, by face id, sorted.
  std::vector<std::pair<GlobalId, int>> faceGroups;
  std::optional<Real> skin; ///< [m]
  int searchEvery = 4;      ///< cycles; 0: once
  Conditions conditions;
  TimeOptions time;
};
} // namespace coplane
