#pragma once

#include <coplane_contact/ContactRules.hpp>
#include <coplane_contact/Plane.hpp>
#include <coplane_dynamics/Conditions.hpp>
#include <coplane_dynamics/ErosionRule.hpp>
#include <coplane_dynamics/Line.hpp>
#include <coplane_element/ElementBlock.hpp>
#include <coplane_material/Material.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace coplane
{
/// How the initial stress of a block varies along one direction, as under gravity.
struct StressGradient
{
  SymTensor perMetre{}; ///< change along the axis [Pa/m]
  Vec3 point{};         ///< where there is none yet [m]
  Vec3 axis{};          ///< unit vector
};

/// What an element block is made of and how it starts.
struct BlockSetup
{
  std::string name;         ///< for messages
  std::string materialName; ///< for tables; materials with one name are one
  Material material;
  HourglassOptions hourglass;
  ElementOptions element;
  ErosionCriteria erosion;
  bool rigid = false;
  Vec3 velocity{}, angularVelocity{}, center{};   ///< rigid motion at the start
  std::function<Vec3(const Vec3&)> velocityField; ///< added to it [m/s]; empty: none
  SymTensor stress{};                             ///< at the start, tension positive [Pa]
  StressGradient stressGradient;

  /// Velocity of a node at the start [m/s].
  Vec3 velocityAt(const Vec3& x) const;
  /// stress + axis . (x - point) gradient [Pa].
  SymTensor stressAt(const Vec3& x) const;
  /// Stress of an element: that of the mean of its corners.
  SymTensor stressOfElement(const RankMesh& mesh, int block, int element) const;
  /// Stress with which each corner of a side is in balance with the stresses of the elements and
  /// with what makes the stress vary, gravity for instance: that of the middle of the side; beside
  /// triangles and tetrahedra, that of the middle weighted with the corner's shape function.
  std::array<SymTensor, 4> stressOfSide(const RankMesh& mesh, const RankMesh::Side& side) const;
};

/// Nodal masses are raised until elements, planes and lines allow a given step.
struct MassScalingOptions
{
  Real step = 0;    ///< [s]
  Real limit = 0.1; ///< largest added mass of a block over its own [-]
};

struct TimeOptions
{
  Real end = 0; ///< [s]
  Real stepFactor = 0.8;
  std::optional<Real> maximumStep, fixedStep; ///< [s]
  std::optional<MassScalingOptions> massScaling;
  int subcyclingLevels = 1;        ///< a cycle has at most 2^(levels - 1) steps (Subcycling.hpp)
  Real energyTolerance = 0.1;      ///< fraction of the energy in play
  Real contactGainTolerance = 0.5; ///< the same, of what contact may gain
  bool endAtRest = false;          ///< the end has come when relaxation has found the state of rest
};

/// Everything the solver needs to know, on this rank.
struct Model
{
  RankMesh mesh;
  std::vector<BlockSetup> blocks; ///< one per block of the mesh file
  /// Rigid body of each node of `mesh`, from rigidBodiesOf(); -1: none. Empty without rigid blocks.
  std::vector<int> rigidBodyOfNode;
  BulkViscosity viscosity;
  bool contactEnabled = true;
  bool stopWhereContactIsLost = true; ///< when bodies go through each other
  ContactOptions contact;
  ContactRules contactRules;
  bool axisymmetric() const { return conditions.axisymmetric; }
  /// Contact groups of faces that are not in the group of their block, by face id, sorted.
  std::vector<std::pair<GlobalId, int>> faceGroups;
  std::optional<Real> skin; ///< [m]
  int searchEvery = -1;     ///< cycles; 0: once, -1: auto
  Conditions conditions;
  bool debris = false;          ///< nodes that erosion leaves are stopped by faces (Debris.hpp)
  std::vector<LineSetup> lines; ///< the same on all ranks
  TimeOptions time;
  // Stages.
  bool inStages = false;         ///< the run has several
  bool blocksComeOrGo = false;   ///< in some stage
  std::vector<int> absentBlocks; ///< at the start: those that come in a later stage
};
} // namespace coplane
