#pragma once

#include <coplane_checkpoint/StateTables.hpp>
#include <coplane_core/Backend.hpp>
#include <coplane_core/Lists.hpp>
#include <coplane_core/NodeViews.hpp>
#include <coplane_dynamics/Clock.hpp>
#include <coplane_dynamics/Model.hpp>
#include <coplane_dynamics/NodalState.hpp>
#include <coplane_dynamics/WorkTimes.hpp>
#include <coplane_element/ElementBlock.hpp>
#include <coplane_mesh/NodeLayout.hpp>
#include <coplane_mesh/RankMesh.hpp>

#include <vector>

namespace coplane
{
/// The element blocks of a rank, and how their forces come to the nodes. Blocks of rigid bodies
/// have mass and nothing else.
class ElementForces
{
public:
  /// No blocks: until the real ones come.
  ElementForces() = default;
  /// Blocks without stress; adds their masses to those of the owned nodes.
  ElementForces(const RankMesh& mesh, const std::vector<BlockSetup>& setups,
                const BulkViscosity& viscosity, NodalState& state);

  void setInitialStress(const Model& model);

  /// Masses of the owned nodes from all elements that have not been taken out, and what mass
  /// scaling has added [kg].
  void sumMasses(NodalState& state) const;
  /// A block as new, free of stress and force, with the nodes at x [m] and its stable steps there.
  /// @param time when it comes [s]
  void initialise(std::size_t block, const ConstNodeVectors& x, Real time);

  const std::vector<ElementBlock>& blocks() const { return blocks_; }
  ElementBlock& block(std::size_t b) { return blocks_[b]; }
  bool isRigid(std::size_t b) const { return rigid_[b] != 0; }

  /// Stress, history, energies and corner forces over dt [s]; ElementBlock::update. Collective when
  /// a block has ElementForm::NodalPressure.
  void update(const NodalState& state, const NodeLayout& layout, Real dt, WorkTimes& work);
  /// After update(), and after elements have died: what elements with ElementForm::NodalPressure
  /// leave to their nodes. Collective when there are any.
  void addNodalTensions(const NodalState& state, const NodeLayout& layout, WorkTimes& work);
  /// Sums of the corner forces at the owned nodes, in the order of element ids [N].
  void gather(const NodeVectors& force) const;

  Real smallestStep() const;            ///< stable, of this rank's elements [s]
  Real leastStepAround(int node) const; ///< of the elements around an owned node [s]
  /// Sum of m / dt^2 over the elements around an owned node that deform: m their mass there, dt
  /// their stable step [kg/s^2].
  Real massOverSquaredSteps(int node) const;
  /// Calls f(block, element) for the elements around an owned node that deform.
  template <class F>
  void forEachAround(int node, F&& f) const
  {
    for (std::size_t b = 0; b < blocks_.size(); ++b)
    {
      if (isRigid(b))
        continue;
      const int corners = topology(blocks_[b].type()).nodes;
      for (const int entry : gathers_[b][node])
        f(b, entry / corners);
    }
  }
  /// The lowest id among those with that step.
  GlobalId limitingElement(const RankMesh& mesh, int node) const;

  /// Throws Error(ExitCode::Computation) that names the first element that has turned inside out,
  /// or has a force that is not finite.
  void throwIfInverted(const Model& model, const Clock& clock) const;

  // Part of a checkpoint; restoring one advances nothing. Collective.
  void save(const RankMesh& mesh, StateTables& out) const;
  void restore(const RankMesh& mesh, const StateSource& in);

private:
  /// By node: element * corners + corner, in the order of element ids, so that sums have the same
  /// order on every rank.
  using Gather = Lists<int>;
  static Gather gatherOf(const RankMesh::Block& part, int ownedNodes);
  template <class Above, class Below>
  const Array<Real>& meanAtNodes(std::size_t block, const NodeLayout& layout, const Above& above,
                                 const Below& below);
  void addNodalTension(std::size_t block, const NodalState& state, const NodeLayout& layout,
                       WorkTimes& work);
  ConstArray<Real> nodalDilatation(std::size_t block, const NodalState& state,
                                   const NodeLayout& layout, Real dt, WorkTimes& work);

  std::vector<ElementBlock> blocks_; ///< in the order of the mesh file
  std::vector<Gather> gathers_;
  std::vector<char> rigid_;
  Array<Real> atNodes_; ///< see meanAtNodes()
};
} // namespace coplane
