#pragma once

#include <coplane_material/Material.hpp>

#include <array>

namespace coplane
{
/// What is asked of the point in one step, for xx, yy, zz, xy, yz, zx: either an increment of
/// strain (tensor shear components) or the stress at the end of the step [Pa].
struct ProbeStep
{
  std::array<bool, 6> stressGiven{};
  std::array<Real, 6> value{};
  Real dt = 1; ///< [s]
};

/// One material point that is led along a path, with its volume and energy: what an element does
/// for a law, without the element.
class MaterialProbe
{
public:
  /// @param size of the element that the point stands for [m]
  /// @param start stress before the path [Pa]
  MaterialProbe(const Material& material, Real size, const SymTensor& start = {});

  /// Advances by l = L dt at the half step; strain and rotation follow from it.
  void advance(const Mat3& displacementGradient, Real dt);

  /// Advances so that every component is what `step` asks for. The strains that are not given are
  /// found by Newton's method, in smaller parts of the step where it does not reach them in one.
  /// Throws Error(ExitCode::Computation) when there are none.
  void advance(const ProbeStep& step);

  const Material& material() const { return material_; }
  const SymTensor& stress() const { return stress_; }
  const SymTensor& strain() const { return strain_; } ///< sum of the increments [-]
  Real pressure() const;
  Real vonMises() const;
  Real volumeRatio() const { return volumeRatio_; }
  Real energy() const { return energy_; }           ///< per reference volume [J/m^3]
  Real dissipation() const { return dissipation_; } ///< part of it that is lost [J/m^3]
  Real stiffening() const { return stiffening_; }
  Real time() const { return time_; }
  Real history(const std::string& name) const; ///< throws Error(ExitCode::Internal)
  const std::array<Real, maximumHistory>& history() const { return history_; }

private:
  struct Search;

  /// @return 0, or by how much the stresses asked for are missed [Pa]; nothing has changed then
  Real tryStep(const ProbeStep& step);

  Material material_;
  std::vector<std::string> names_;
  Real size_;
  SymTensor stress_, strain_;
  std::array<Real, maximumHistory> history_{};
  Real volumeRatio_ = 1, energy_ = 0, dissipation_ = 0, stiffening_ = 1, time_ = 0;
  std::array<Real, 6> lastIncrement_{}; // first guess of the next step
};
} // namespace coplane
