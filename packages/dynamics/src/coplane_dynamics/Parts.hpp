#pragma once

#include <coplane_contact/Contact.hpp>
#include <coplane_core/Comm.hpp>
#include <coplane_dynamics/Clock.hpp>
#include <coplane_dynamics/Debris.hpp>
#include <coplane_dynamics/ElementForces.hpp>
#include <coplane_dynamics/Erosion.hpp>
#include <coplane_dynamics/Lines.hpp>
#include <coplane_dynamics/Model.hpp>
#include <coplane_dynamics/NodalMotion.hpp>
#include <coplane_dynamics/NodalState.hpp>
#include <coplane_mesh/NodeLayout.hpp>

namespace coplane
{
/// What a run consists of, on this rank, to be looked at: for those who sum, judge and report.
struct Parts
{
  const Comm& comm;
  const Model& model;
  const NodeLayout& layout;
  const NodalState& state;
  const ElementForces& elements;
  const Erosion& erosion;
  const NodalMotion& motion;
  const Contact* contact; ///< nullptr: none
  const Lines& lines;
  const Debris* debris; ///< nullptr: nodes without elements fly through everything
  const Clock& clock;

  const RankMesh& mesh() const { return model.mesh; }
  const std::vector<ElementBlock>& blocks() const { return elements.blocks(); }
  const RigidBodies& bodies() const { return motion.bodies(); }
};
} // namespace coplane
