#pragma once

#include <coplane_joint/JointLaw.hpp>
#include <coplane_schema/CardModel.hpp>

#include <optional>
#include <vector>

namespace coplane
{
/// A model that cards in `joints` may name, and what other parts ask of it.
struct JointModel : CardModel<JointLaw>
{
  bool needsElements = false; ///< its stiffness comes from the elements behind the faces
};

/// Every model, in the order of the manual. The first is that of cards that name none.
const std::vector<JointModel>& jointModels();

// What users say of joints. Parts that models share:

struct ShearStiffnessParameters
{
  std::optional<Real> shearStiffness; ///< [Pa/m]; default: shearRatio times the normal stiffness
  Real shearRatio = 0.5;              ///< k_s / k_n [-]
};

struct CoulombParameters : ShearStiffnessParameters
{
  Real friction = 0;                   ///< coefficient, at rest [-]
  std::optional<Real> dynamicFriction; ///< of fast slip [-]; default: as at rest
  Real slipSpeed = 0;                  ///< at which most of the difference is gone [m/s]
  Real cohesion = 0;                   ///< [Pa]
  Real dilation = 0;                   ///< tangent of the dilation angle [-]
  std::optional<Real> dilationSlip;    ///< slip after which nothing dilates [m]; default: no limit
};

// The models, in files of their own:

/// Stiffness from the elements behind the faces.
struct PenaltyParameters : CoulombParameters
{
  Real stiffnessFraction = 2; ///< alpha of k_n = alpha / (h1/M1 + h2/M2) [-]

  static JointModel model();
};
JointLaw makeLaw(const PenaltyParameters& parameters);

/// A given stiffness, with a brittle bond on demand.
struct LinearParameters : CoulombParameters
{
  Real normalStiffness = 0; ///< [Pa/m]
  Real tensileStrength = 0; ///< [Pa]; 0: no bond
  bool resistsBending = false;

  static JointModel model();
};
JointLaw makeLaw(const LinearParameters& parameters);

/// A hyperbola of the closure.
struct ClosureCurveParameters : CoulombParameters
{
  Real initialStiffness = 0;        ///< slope at zero closure [Pa/m]
  Real maximumClosure = 0;          ///< asymptote [m]
  std::optional<Real> stiffnessCap; ///< [Pa/m]; default: from the elements

  static JointModel model();
};
JointLaw makeLaw(const ClosureCurveParameters& parameters);

/// A table of the closure.
struct TableParameters : CoulombParameters
{
  std::vector<Real> closures;  ///< after (0, 0), rising [m]
  std::vector<Real> tractions; ///< [Pa]
  std::optional<Real> stiffnessCap;

  static JointModel model();
};
JointLaw makeLaw(const TableParameters& parameters);

/// A rough rock joint of Barton and Bandis.
struct BartonBandisParameters : ShearStiffnessParameters
{
  Real initialStiffness = 0; ///< [Pa/m]; 0: estimated
  Real maximumClosure = 0;   ///< [m]; 0: estimated
  std::optional<Real> stiffnessCap;
  std::optional<Real> dilationSlip;
  Real roughness = 0;               ///< JRC [-]
  Real wallStrength = 0;            ///< JCS [Pa]
  std::optional<Real> rockStrength; ///< sigma_c [Pa]; default JCS
  Real residualFriction = 0;        ///< tan(phi_r) [-]
  Real peakSlip = 0;                ///< [m]

  static JointModel model();
};
JointLaw makeLaw(const BartonBandisParameters& parameters);

/// A bond that softens, with cohesion for its shear strength.
struct BondParameters : CoulombParameters
{
  Real normalStiffness = 0; ///< [Pa/m]
  Real maximumClosure = 0;  ///< of a hyperbola in compression [m]; 0: a straight line
  std::optional<Real> stiffnessCap;
  Real tensileStrength = 0; ///< [Pa]
  Real tensionEnergy = 0;   ///< G_I [J/m^2]
  Real shearEnergy = 0;     ///< G_II [J/m^2]
  bool resistsBending = false;
};
struct MortarParameters : BondParameters ///< exponential softening
{
  Real compressiveStrength = 0;   ///< f_m [Pa]; 0: never crushed
  Real compressionEnergy = 0;     ///< G_fc, after the peak and above the residual [J/m^2]
  Real peakCrushing = 0;          ///< inelastic closure at the peak [m]
  Real residualCompression = 0.1; ///< of the strength that is left in the end [-]
  Real shearInCrushing = 9;       ///< C_ss of sigma^2 + C_ss tau^2 = f_m^2 [-]
  Real stiffnessLoss = 0;         ///< part of inelastic displacements that unloading gives back [-]

  static JointModel model();
};
JointLaw makeLaw(const MortarParameters& parameters);
struct BilinearParameters : BondParameters ///< linear softening
{
  static JointModel model();
};
JointLaw makeLaw(const BilinearParameters& parameters);
} // namespace coplane
