#pragma once

#include <coplane_core/NodeViews.hpp>
#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>
#include <coplane_element/ElementArrays.hpp>
#include <coplane_element/ElementEnergy.hpp>
#include <coplane_element/ElementOptions.hpp>
#include <coplane_material/Material.hpp>
#include <coplane_mesh/ElementTopology.hpp>

#include <string>
#include <utility>
#include <vector>

namespace coplane
{
struct ElementKernelData;

/// All elements of one type and one law on this rank: from positions and velocities to internal
/// forces, a cycle at a time. Time levels (central differences): x and stress at n, v at n + 1/2.
/// What an element gets depends on its own nodes and history only, not on its place in the block,
/// so it has the same bits on every rank that computes it.
class ElementBlock
{
public:
  /// One number per component (row) and element (column). Rows are padded to a multiple of
  /// laneCount; only the first count() columns mean something.
  using Values = ElementTable;
  using ConstValues = ConstElementTable;
  using ConstCornerVectors = Kokkos::View<const Real** [3], Kokkos::LayoutRight, Kokkos::HostSpace>;

  /// @param connectivity local node indices, topology(type).nodes per element
  ElementBlock(ElementType type, const Material& law, const HourglassOptions& hourglass,
               const BulkViscosity& viscosity, const std::vector<int>& connectivity,
               const ElementOptions& options = {});

  /// Takes reference volumes and masses from the nodes' first positions [m] and clears the history.
  /// @param time when the elements come: 0, or when a stage adds them [s]
  void initialise(const ConstNodeVectors& x, Real time = 0);

  /// Gives every element the same stress (tension positive) [Pa]. Call after initialise().
  void setInitialStress(const SymTensor& stress);
  /// The same for one element.
  void setInitialStress(int element, const SymTensor& stress);

  /// For ElementForm::NodalPressure, before update(): increments of volume over the step and
  /// volumes in its middle, whose sums around a node give its dilatation, sum / sum.
  void findVolumeChanges(const ConstNodeVectors& x, const ConstNodeVectors& v, Real dt);
  /// Two rows, see there [m^3]; update() gives a third one, the dilatation that it took [-].
  ConstValues volumeChanges() const { return arrays_.volumeChanges; }

  /// Advances stress, history and energies over dt, and computes the forces, volumes and stable
  /// steps at x^(n+1). With dt = 0 nothing advances: it gives the forces that belong to the present
  /// stress, with the bits they had when that stress was computed (start of a run, restart). Never
  /// throws: see invertedElement().
  /// @param x positions at n + 1 [m]
  /// @param v velocities at n + 1/2 [m/s], by which the nodes came from x(n) to x(n+1)
  /// @param nodalDilatation of the step, per local node; for NodalPressure and dt > 0 only [-]
  void update(const ConstNodeVectors& x, const ConstNodeVectors& v, Real dt,
              const ConstArray<Real>& nodalDilatation = {});

  /// For ElementForm::NodalPressure, after update(): adds the forces of mean tensions, which are
  /// those of nodes: sums around a node of meanTension() over those of volume().
  /// @param nodalTension per local node [Pa]
  void addNodalTension(const ConstNodeVectors& x, const ConstArray<Real>& nodalTension);
  /// Mean stress beyond the initial one, less viscous pressure, times the volume that the nodes
  /// give an element, a row [N m].
  ConstValues meanTension() const { return arrays_.meanTension; }
  /// Work of that in half of the last step, which corner forces do not show before
  /// addNodalTension(); 0 for other forms [J].
  Real workLeftToNodes(int element) const;

  int count() const { return count_; }
  ElementType type() const { return type_; }
  const Material& material() const { return law_; }
  const ElementOptions& options() const { return options_; }
  /// [element][corner] -> local node
  ConstTable<int> connectivity() const { return arrays_.connectivity; }

  /// What an explosive has released in the element, products of eroded elements included; 0 for
  /// other laws [J].
  Real chemicalEnergy(int element) const;

  /// Force of the element on its nodes [N]: a node's internal force is the sum over its corners
  /// (minus B sigma).
  ConstCornerVectors cornerForce() const { return arrays_.cornerForce; }
  Real mass(int element) const { return arrays_.mass(element); } ///< [kg]
  /// Lumped [kg]: equal parts, but for bodies of revolution and full integration integrals of the
  /// shape functions.
  Real cornerMass(int element, int corner) const
  {
    return arrays_.cornerMass.extent(0) > 0 ? arrays_.cornerMass(corner, element)
                                            : arrays_.mass(element) / topology(type_).nodes;
  }
  ConstArray<Real> stableStep() const { return arrays_.stableStep; } ///< [s]; 0 when inverted
  Real stableStep(int element) const { return arrays_.stableStep(element); }
  ConstArray<Real> volume() const
  {
    return arrays_.volume;
  } ///< [m^3]; area times unit thickness in plane strain
  Real volume(int element) const { return arrays_.volume(element); }
  ConstArray<Real> referenceVolume() const { return arrays_.referenceVolume; }
  Real referenceVolume(int element) const { return arrays_.referenceVolume(element); }
  /// V^(1/3), in two dimensions the root of the area [m].
  ConstArray<Real> referenceLength() const { return arrays_.referenceLength; }
  /// xx, yy, zz, xy, yz, zx; tension positive, without bulk viscosity; the mean over the points; zz
  /// is the hoop stress of bodies of revolution [Pa]
  ConstValues stress() const { return arrays_.stress; }
  Real stress(int component, int element) const { return arrays_.stress(component, element); }
  Real pressure(int element) const; ///< -tr(stress)/3 [Pa]
  Real vonMises(int element) const; ///< sqrt(3/2 s:s) [Pa]
  Real density(int element) const
  {
    return arrays_.mass(element) / arrays_.volume(element);
  } ///< now [kg/m^3]
  /// The law's variables, a row each, means over the points; names in the order of the rows.
  ConstValues history() const { return arrays_.history; }
  Real history(int row, int element) const { return arrays_.history(row, element); }
  const std::vector<std::string>& historyVariables() const { return historyNames_; }
  int historyRow(const std::string& name) const; ///< -1 when the law has no such variable
  /// q of the last update, not negative [Pa].
  Real viscousPressure(int element) const { return arrays_.compression(1, element); }
  ConstValues energies() const { return arrays_.energies; }
  Real energy(int element, ElementEnergy kind) const
  {
    return arrays_.energies(int(kind), element);
  }

  /// Takes an element out: no force and no stable step from now on, energies and stress zero; its
  /// history and its volume stay as they are. Its mass stays in mass() and cornerMass(): the nodes
  /// keep it.
  void erode(int element);
  /// The same for an element that leaves with its mass, or is not there yet.
  void takeOut(int element);
  bool isAlive(int element) const { return alive_(0, element) > 0; }
  bool isTakenOut(int element) const { return alive_(0, element) < 0; }

  /// Some elements of this block as a block of their own, with the same bits: for those that
  /// advance by steps of their own. Not for NodalPressure, whose elements need all others.
  /// @param elements places in this block; the i-th becomes number i
  ElementBlock part(const std::vector<int>& elements) const;
  /// What elements of this block are now, into the part that was made of them, and back.
  void give(const std::vector<int>& elements, ElementBlock& part) const;
  void take(const std::vector<int>& elements, const ElementBlock& part);

  // For checkpoints, element by element: everything that the next cycle or an output reads and that
  // initialise() does not give. restoreState() follows initialise(), once for every element.
  std::vector<std::string> stateColumns() const;
  void saveState(int element, Real* row) const;
  void restoreState(int element, const Real* row);

  /// The least stable step of the block [s]; infinity when it has no elements, 0 when one has
  /// turned inside out.
  Real smallestStableStep() const;
  /// The lowest index of an element with a volume that is not positive or a force that is not
  /// finite; -1 when there is none.
  int invertedElement() const;

  /// Calls f(name, components, values) for all that a restart needs beside the nodes and
  /// initialise(): values are a Values table with one row per component.
  template <class F>
  void forEachState(F&& f) const
  {
    f("stress", int(arrays_.stress.extent(0)), arrays_.stress);
    f("history", int(arrays_.history.extent(0)), arrays_.history);
    f("tangent", int(arrays_.tangent.extent(0)), arrays_.tangent);
    f("hourglass_force", int(arrays_.hourglassForce.extent(0)), arrays_.hourglassForce);
    f("hourglass_viscous_force", int(arrays_.hourglassViscousForce.extent(0)),
      arrays_.hourglassViscousForce);
    f("compression_rate", int(arrays_.compression.extent(0)), arrays_.compression);
    f("element_energy", int(arrays_.energies.extent(0)), arrays_.energies);
    for (const auto& [name, values] : {std::pair{"deformation", arrays_.deformation},
                                       {"volume_ratio", arrays_.volumeRatio},
                                       {"own_tension", arrays_.ownTension},
                                       {"point_stress", arrays_.pointStress},
                                       {"point_history", arrays_.pointHistory},
                                       {"point_energy", arrays_.pointEnergy}})
      if (values.extent(0) > 0)
        f(name, int(values.extent(0)), values);
    f("alive", int(alive_.extent(0)), alive_);
  }

private:
  template <ElementType type>
  Real measure(int element, const ConstNodeVectors& x);
  ElementKernelData kernelData(const ConstNodeVectors& x, const ConstNodeVectors& v, Real dt) const;
  /// What an eroded element keeps. Kernels go over all elements of a block, dead ones too, and
  /// update() then puts back what they wrote.
  struct Eroded
  {
    int element;
    Real volume;             ///< [m^3]
    std::vector<Real> state; ///< in the order of forEachState
  };
  void restore(const Eroded& eroded);
  void end(int element, Real mark);

  ElementType type_;
  Material law_;
  HourglassOptions hourglass_;
  BulkViscosity viscosity_;
  int count_ = 0;
  ElementOptions options_;
  std::vector<std::string> historyNames_;
  ElementArrays arrays_;
  Values alive_;              // 1 alive, 0 eroded, -1 taken out
  std::vector<Vec3> centres_; // of the elements when they came, means of their nodes [m]
  Real came_ = 0;             // when that was [s]
  std::vector<Eroded> eroded_;
};
} // namespace coplane
