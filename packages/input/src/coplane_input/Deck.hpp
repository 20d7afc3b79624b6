#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/Vec3.hpp>
#include <coplane_schema/TimeFunction.hpp>

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace coplane
{
// The deck as checked, typed values. Names are those of the YAML keys; defaults here are the
// defaults of the schema. Units: SI. `where` is the place of a card for later messages:
// "wall.yaml:12:5", or "--set a.b=value" when it came from there.

struct MaterialCard
{
  std::string name, where;
  std::string set;                  ///< of the library, from which keys that are not given come
  std::string model;                ///< one of materialModels()
  std::shared_ptr<void> parameters; ///< of the model; copies of a card share them
};

/// A limit on a variable of the law, by its name.
struct ErosionVariableCard
{
  std::string name, where;
  std::optional<Real> above, below;
};

/// When an element dies: when its damage is above `damage`, if given, and one of the others, if
/// any, is exceeded.
struct ErosionCard
{
  std::optional<Real> damage;        ///< [-]
  std::optional<Real> plasticStrain; ///< [-]
  std::vector<Real> volumeRatio;     ///< least, largest [-]; empty: no limit
  std::optional<Real> stableStep;    ///< [s]
  std::vector<ErosionVariableCard> variables;

  bool any() const
  {
    return damage || plasticStrain || !volumeRatio.empty() || stableStep || !variables.empty();
  }
};

/// Maxwell elements beside the law of a block.
struct MaxwellCard
{
  Real ratio = 0;                ///< of critical damping [-]; 0: none
  std::optional<Real> low, high; ///< the band of frequencies [Hz]
  int elements = 3;
  bool volumetric = false;
};

struct BlockCard
{
  std::string name, where; ///< element block of the mesh
  std::string material;
  std::string element = "one_point";           ///< one_point | assumed_strain | full_integration |
                                               ///< full_integration_plain | nodal_pressure
  std::string objectiveRate = "hughes_winget"; ///< hughes_winget | jaumann | green_naghdi
  Real hourglassStiffness = 0.05;              ///< [-]
  Real hourglassViscosity = 0;                 ///< [-]
  ErosionCard erosion;
  MaxwellCard damping;
  bool rigid = false;
};

struct JointCard
{
  JointCard(); ///< of the first model

  std::string name, where;
  std::string model;                ///< one of jointModels()
  std::shared_ptr<void> parameters; ///< of the model; copies of a card share them
};

/// Which joint law acts between faces of two blocks, of two materials or of two side sets, or
/// within a side set that holds both faces of every joint (by name; "*" means any). One of the four
/// is given.
struct ContactPairCard
{
  std::string where;
  std::array<std::string, 2> blocks, materials, sideSets;
  std::string jointSet;
  std::string joint;
  bool declared =
      false; ///< closed at t = 0: initial gaps and overlaps are absorbed, stress-free as built
  bool excluded = false; ///< no contact between these blocks
};

struct ContactCard
{
  bool enabled = true;
  std::string preset = "default";    ///< default | seed
  std::string forces = "auto";       ///< auto | potential | common_normal
  std::string impulses = "leapfrog"; ///< leapfrog | path
  std::string area = "penetrating";  ///< penetrating | full
  std::string weights = "pressure";  ///< pressure | average | centroid
  std::string closure = "total";     ///< total | incremental
  bool couple = true;
  bool areaRule = true;
  bool inherit = true;
  std::string shareNode = "skip";       ///< skip | allow
  std::string initialOverlap = "error"; ///< error | allow
  std::string lostContact = "stop";     ///< stop | warn
  std::string debris = "none";          ///< none | points
  /// Defaults of cosOpposed [-]. With the potential needles and crossing edges of 10 degrees come
  /// into contact; along a common normal forces would jump as pairs of such faces come and go.
  static constexpr Real cosOpposedOfPotential = 0.004, cosOpposedOfCommonNormal = 0.1;
  std::optional<Real> cosOpposed; ///< [-]
  Real depthMax = 0.6;
  Real areaMin = 1e-8;
  std::optional<Real> skin; ///< [m]; default 0.1 (once: 0.5) of the smallest face size
  int searchEvery = -1;     ///< cycles; 0 means once, -1 auto
  Real dampNormal = 0;      ///< fraction of critical [-]
  Real dampShear = 0;
  std::string defaultJoint; ///< empty: built-in penalty law without friction
  std::vector<ContactPairCard> pairs;
};

struct ConditionCard
{
  std::string where;
  std::string type; ///< fixed | velocity | displacement | acceleration | symmetry | pressure |
                    ///< traction | air_blast | absorbing | free_field | rigid_motion
  /// Node set (fixed, velocity, displacement, acceleration, symmetry), element block (rigid_motion)
  /// or side set (the others).
  std::string set;
  Real from = 0;                                    ///< acts for from <= t < until [s]
  std::optional<Real> until;                        ///< [s]; not given: to the end
  std::array<bool, 3> components{true, true, true}; ///< fixed, velocity, rigid_motion
  std::array<TimeFunction, 3> velocity;             ///< velocity [m/s]
  std::array<TimeFunction, 3> displacement;         ///< displacement [m]
  std::array<TimeFunction, 3> acceleration;         ///< acceleration [m/s^2]
  Vec3 normal{0, 0, 0};                             ///< symmetry
  TimeFunction pressure;                ///< pressure, follower, positive pushes into the body [Pa]
  std::array<TimeFunction, 3> traction; ///< traction, in fixed axes [Pa]
  std::array<TimeFunction, 3> incident; ///< absorbing, velocity of the wave that enters [m/s]
  std::string burst = "surface";        ///< air_blast: surface | air
  Real chargeMass = 0;                  ///< air_blast, equivalent of TNT [kg]
  Vec3 chargePlace{0, 0, 0};            ///< air_blast [m]
  Real detonationTime = 0;              ///< air_blast [s]
  /// rigid_motion: of each body's centre [m/s], and its spin [rad/s]; free where not given
  std::optional<std::array<TimeFunction, 3>> translation, spin;

  /// What type velocity, displacement or acceleration prescribes.
  const std::array<TimeFunction, 3>& motion() const
  {
    return type == "displacement" ? displacement : type == "acceleration" ? acceleration : velocity;
  }
  bool onSides() const
  {
    return type == "pressure" || type == "traction" || type == "air_blast" || type == "absorbing" ||
           type == "free_field";
  }
};

/// A bolt, cable, tie rod or bar of reinforcement that crosses elements and joints.
struct LineCard
{
  std::string name, where;
  std::vector<std::vector<Real>> points; ///< in the mesh at t = 0 [m]
  std::string attach = "grout";          ///< grout | ends | perfect
  Real segmentLength = 0;                ///< at most; grout, perfect [m]
  Real area = 0;                         ///< [m^2]
  Real youngsModulus = 0;                ///< [Pa]
  std::optional<Real> yieldStress;       ///< [Pa]
  Real hardeningModulus = 0;             ///< [Pa]
  Real rateExponent = 0;                 ///< of the yield stress [-]
  Real referenceRate = 1e-4;             ///< up to which the rate does not matter [1/s]
  std::optional<Real> ruptureStrain;     ///< [-]
  bool compression = true;
  std::optional<Real> diameter;       ///< of bars that bend [m]
  std::string mirrored = "none";      ///< none | start | end | both: ends on planes of symmetry
  Real groutStiffness = 0;            ///< force over slip and length [N/m^2]
  std::optional<Real> groutStrength;  ///< [N/m]
  Real groutFriction = 0;             ///< [-]
  Real groutPerimeter = 0;            ///< [m]
  bool plate = false;                 ///< grout: no slip at the first point
  Real freeLength = 0;                ///< grout: without grout from the first point on [m]
  std::optional<Real> dowelStiffness; ///< [N/m]
  std::optional<Real> dowelStrength;  ///< [N]
  Real pretension = 0;                ///< [N]
  Real pretensionTime = 0;            ///< over which it grows [s]
  Real spacing = 1;                   ///< out of the plane, in two dimensions [m]
  int copies = 1;                     ///< a row of them
  Vec3 copyStep{0, 0, 0};             ///< from one to the next [m]
  Real from = 0;                      ///< [s]
  std::string stage;                  ///< from whose beginning on; empty: the first
  std::optional<Real> until;          ///< [s]; not given: stays to the end
};

struct InitialCard
{
  std::string where;
  std::string block;
  Vec3 velocity{0, 0, 0};        ///< of the block as a rigid body [m/s]
  Vec3 angularVelocity{0, 0, 0}; ///< [rad/s]
  Vec3 center{0, 0, 0};          ///< a point that moves with `velocity` [m]
  std::optional<std::array<PlaceFunction, 3>> velocityField; ///< added [m/s]
  std::array<Real, 6> stress{0, 0, 0, 0, 0, 0}; ///< xx yy zz xy yz zx, tension positive [Pa]
  std::array<Real, 6> stressGradient{0, 0, 0,
                                     0, 0, 0}; ///< change per metre along stressAxis [Pa/m]
  Vec3 stressAxis{0, 1, 0};
  Vec3 stressPoint{0, 0, 0}; ///< where `stress` is [m]
};

/// A part of the run; the deck is that of the first.
struct StageCard
{
  std::string name, where;
  std::optional<Real> until; ///< latest end [s]; not given, of the last one: the end of the run
  bool atRest = false;       ///< ends as soon as damping does, by a ratio of the section damping
  std::vector<std::string> remove, add; ///< blocks, at the beginning
  bool zeroDisplacements = false;
};

struct TimeCard
{
  Real end = 0;                    ///< [s]
  Real stepFactor = 0.8;           ///< fraction of the stable step [-]
  std::optional<Real> maximumStep; ///< [s]
  std::optional<Real> fixedStep;   ///< [s]; refused above the stable step only by a warning
  std::optional<Real> scaledStep;  ///< that masses are raised for; not given: they are not [s]
  Real scalingLimit = 0.1;         ///< largest added mass of a block over its own [-]
  bool scalingWithWaves = false;   ///< also with absorbing sides and ground motions
  int subcyclingLevels = 1;        ///< a cycle has at most 2^(levels - 1) steps; 1: one
  bool endAtRest = false; ///< the run ends when damping does, by a ratio of the section damping
  Real energyTolerance =
      0.1; ///< stop when the balance is off by this fraction of the energy in play [-]
  Real contactGainTolerance =
      0.5; ///< stop when contact has made this fraction of the energy in play [-]
};

struct OutputCard
{
  std::string results; ///< Exodus file; default <deck>.e in the working folder; empty: switched off
                       ///< (deck: none)
  Real every = 0;      ///< [s]; 0: only `times` (and first and last state)
  std::vector<Real> times;             ///< [s]
  std::vector<std::string> variables;  ///< of nodes and elements; empty: all
  bool planes = true;                  ///< contact planes beside the results
  std::string planesFormat = "vtkhdf"; ///< vtkhdf: one file | vtp: .pvd and .vtp for each step
  bool filePerRank = false;
  bool lines = false;         ///< bolts, cables and bars beside the results
  bool fragments = false;     ///< connected bodies beside the results and in them
  Real fragmentDamage = 0.99; ///< from which an element connects nothing [-]
};

struct ProbeCard
{
  std::string name, where;
  std::string nodeSet;                    ///< mean motion of a node set ...
  std::string block;                      ///< ... or mass-weighted mean motion of a block
  std::optional<Vec3> point;              ///< ... or of the nearest node [m]
  std::optional<Vec3> plane;              ///< ... or what the nearest contact plane has [m]
  std::string joint;                      ///< of that plane; empty: any
  std::vector<std::vector<Real>> between; ///< ... or of the nodes nearest to points on a line [m]
  int count = 2;                          ///< of these points, with both ends
  /// Of the element nearest to the point, or least and largest of the block or node set.
  std::vector<std::string> variables;
  bool reaction = false;  ///< of a node set: the sum of the reactions on its nodes, too
  std::string relativeTo; ///< the probe from whose motion this one's is counted; empty: none
};

struct HistoryCard
{
  std::string file; ///< CSV; default <deck>.csv
  Real every = 0;   ///< [s]; 0: every cycle
  std::vector<ProbeCard> probes;
  std::vector<std::string> joints; ///< names of joint cards; "*": all
  std::vector<std::string> tables; ///< blocks | pairs | materials | lines
  std::vector<std::string> rigid;  ///< names of rigid blocks; "*": all
};

struct CheckpointCard
{
  std::string file;      ///< <file>.0 and <file>.1; default <deck>.chk
  int everyCycles = 0;   ///< 0: never
  Real everySeconds = 0; ///< of wall-clock time [s]; 0: never
  bool atEnd = false;
};

struct Deck
{
  std::string file;                  ///< as given on the command line
  std::string text;                  ///< the whole deck after --set, for the info records
  std::vector<std::string> warnings; ///< about values that are accepted, but most likely not meant
  std::string title;
  std::string mesh,
      meshWhere; ///< path, relative paths are relative to the deck's folder (resolved)
  std::string geometry = "plane_strain"; ///< of two dimensions: plane_strain | axisymmetric
  std::vector<MaterialCard> materials;
  std::vector<BlockCard> blocks;
  std::string blocksWhere;
  std::vector<JointCard> joints;
  ContactCard contact;
  std::vector<ConditionCard> conditions;
  std::vector<InitialCard> initial;
  std::vector<LineCard> lines;
  std::array<TimeFunction, 3> gravity;    ///< [m/s^2]
  Real viscosityLinear = 0.06;            ///< bulk viscosity b1 [-]
  Real viscosityQuadratic = 1.5;          ///< b2 [-]
  TimeFunction massDamping;               ///< force -alpha m v [1/s]
  Real localDamping = 0;                  ///< force -alpha |f| sign(v), component by component [-]
  bool kineticDamping = false;            ///< stops all motion where the kinetic energy has a peak
  Real dampingFrom = 0;                   ///< [s]
  std::optional<Real> dampingUntil;       ///< [s]
  std::optional<Real> dampingEnergyRatio; ///< kinetic over internal energy at which it ends [-]
  std::optional<Real> dampingForceRatio;  ///< unbalanced over applied force at which it ends [-]
  TimeCard time;
  std::vector<StageCard> stages;
  OutputCard output;
  HistoryCard history;
  CheckpointCard checkpoint;
  std::string partitionMethod = "multijagged"; ///< multijagged | rcb | rib | hsfc | hypergraph
  std::string partitionBalance = "cost";       ///< cost | nodes
  std::string rebalance = "auto";              ///< during the run: never | auto | always
  int rebalanceEvery = 500;                    ///< cycles from one look to the next
  Real rebalanceAbove = 1.1;                   ///< largest over mean work of a rank [-]
};
} // namespace coplane
