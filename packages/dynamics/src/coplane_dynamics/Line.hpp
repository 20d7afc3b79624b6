#pragma once

#include <coplane_core/Real.hpp>
#include <coplane_core/StateHash.hpp>
#include <coplane_core/Vec3.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace coplane
{
// Bolts, cables, tie rods and bars of reinforcement: docs/theory/lines.md. In two dimensions areas,
// forces, stiffnesses and strengths are those of one metre out of the plane.

/// The bar: elastic, plastic with linear isotropic hardening, torn from a strain on. It flows at
/// the larger of the hardened yield stress and the first one times (rate / reference)^exponent;
/// bent, at the plastic moment times that of its outermost fibre.
struct LineSection
{
  Real area = 0;                 ///< [m^2]
  Real youngsModulus = 0;        ///< [Pa]
  Real yieldStress = infinity;   ///< [Pa]
  Real hardeningModulus = 0;     ///< yield stress over plastic strain [Pa]
  Real ruptureStrain = infinity; ///< in tension, plastic and elastic together [-]
  bool compression = true;       ///< false: goes slack
  Real diameter = 0;             ///< of round bars, which bend; 0: without stiffness across [m]
  Real rateExponent = 0;         ///< 0: the rate does not matter [-]
  Real referenceRate = 1e-4;     ///< of plastic strain, up to which it does not matter [1/s]
};

/// The grout between bar and host: force over slip, elastic and then constant.
struct LineBond
{
  Real stiffness = 0;       ///< force over slip and length [N/m^2]
  Real strength = infinity; ///< force over length without pressure [N/m]
  Real friction = 0;        ///< what the pressure of the host on the perimeter adds [-]
  Real perimeter = 0;       ///< [m]
};

/// What a bar gives against sliding of a joint that it crosses.
struct LineDowel
{
  Real stiffness = 0;       ///< [N/m]
  Real strength = infinity; ///< [N]
};

struct LinePoint
{
  Vec3 place{};     ///< in the mesh as it is at t = 0 [m]
  bool tied = true; ///< no slip there
  Real bonded = 0;  ///< length of grout that belongs to it, where it is not tied [m]
};

struct LineSetup
{
  std::string name, where;
  LineSection section;
  LineBond bond;
  std::optional<LineDowel> dowel;
  std::vector<LinePoint> points;  ///< two at least
  std::array<bool, 2> mirrored{}; ///< the first, the last point lies on a plane of symmetry
  int bare = 0;                   ///< segments from the first point on without grout, nor dowels
  Real pretension = 0;            ///< [N]
  Real pretensionTime = 0;        ///< over which it grows from the installation on [s]
  Real from = 0;                  ///< installed at this time ... [s]
  int stage = 0;                  ///< ... and in this stage
  Real until = infinity;          ///< taken out at this time, with what it stores [s]
};

/// Energies of lines [J].
struct LineEnergy
{
  Real work = 0;       ///< all that has come: from the hosts, and by pretension
  Real pretension = 0; ///< the part of it by pretension
  Real stored = 0;     ///< elastic, in bars, grout and dowels
  Real plastic = 0;    ///< lost in bars
  Real bond = 0;       ///< lost by slip
  Real dowel = 0;      ///< lost by sliding of dowels
  Real rupture = 0;    ///< lost where bars tore, hosts died or a line was taken out
  /// What the discrete motion leaves over.
  Real remainder() const { return work - stored - plastic - bond - dowel - rupture; }
  LineEnergy& operator+=(const LineEnergy& other);
};

/// What a line's points know of their hosts, one for each, and then two for each dowel.
struct LineHosts
{
  std::vector<Vec3> x;        ///< [m]
  std::vector<char> alive;    ///< whether the element is there
  std::vector<Real> pressure; ///< on the bar; points only [Pa]
};

/// The part of v that is normal to a direction.
inline Vec3 across(const Vec3& v, const Vec3& along)
{
  return v - dot(v, along) * along;
}

/// One line without mass. Its points lie in elements, their hosts, and move with them; the bar
/// slips along itself by an amount at each point that leaves it in equilibrium:
///
///     T_i - T_(i-1) = B(slip_i)      T_i along the chord from point i to the next
///
/// That is the minimum of the energy of bar and grout over the slips, so that what the hosts get,
/// +-T_i at the ends of every chord, is its derivative by their places. The forces of a line have
/// no resultant and no moment. With a diameter it bends at its points, elastic and plastic.
class Line
{
public:
  /// @param dowels segments that cross a joint, in ascending order
  Line(const LineSetup& setup, const std::vector<int>& dowels);

  /// To the time t, at which the hosts are here: slips, forces, energies.
  /// @param dt the step that ends at t; 0 at the start, where pretension is no work [s]
  void advance(const LineHosts& hosts, Real t, Real dt, int stage);

  /// On the hosts: of the points, and two for each dowel [N].
  const std::vector<Vec3>& forces() const { return forces_; }
  /// Bound on the sum of the absolute values of a row of the stiffness, in the same order [N/m].
  const std::vector<Real>& stiffness() const { return stiffness_; }
  /// Of what lies beyond planes of symmetry on the first and the last point [N m].
  const std::array<Vec3, 2>& outerMoments() const { return outerMoments_; }
  LineEnergy energy() const;

  const std::string& name() const { return name_; }
  const LineSection& section() const { return section_; }
  bool bends() const { return section_.diameter > 0; }
  bool installed() const { return installed_; } ///< also when it has been taken out again
  bool removed() const { return removed_; }
  /// Whether it is installed, pulled on or taken out between t and `end`, in this stage [s].
  bool willChange(Real t, Real end, int stage) const;

  struct Point
  {
    int index = 0; ///< in the setup
    bool tied = true;
    Real bonded = 0; ///< [m]
    Real slip = 0;   ///< of the bar in its host, along the line [m]
    Real plasticSlip = 0;
    Real bondForce = 0; ///< of the host against the slip [N]
    Vec3 moment{};      ///< by which the bar resists being bent there [N m]
    Vec3 axis{};        ///< about which it is bent, or was before it came near to straight [-]
  };
  /// From a point that has a host to the next that has one.
  struct Segment
  {
    Real length = 0; ///< of the bar [m]
    Real chord = 0;  ///< between its ends when it was installed [m]
    Real strain = 0; ///< with that of pretension [-]
    Real plasticStrain = 0;
    Real hardening = 0; ///< accumulated plastic strain [-]
    Real force = 0;     ///< tension positive [N]
    Real broken = 0;    ///< 1: torn
  };
  struct Dowel
  {
    int segment = 0; ///< between points `segment` and `segment` + 1 of the setup
    Real gone = 0;   ///< 1: torn, or without hosts
    Vec3 sliding{};  ///< of the far side relative to the near one, across the line [m]
    Vec3 plastic{};  ///< the lost part of it [m]
    Vec3 force{};    ///< on the near side [N]
  };
  const std::vector<Point>& points() const { return points_; }
  const std::vector<Segment>& segments() const { return segments_; }
  const std::vector<Dowel>& dowels() const { return dowels_; }
  Vec3 place(int index) const { return x_[std::size_t(index)]; }
  struct Extremes
  {
    Real greatestForce = 0, leastForce = 0; ///< of a segment so far [N]
    Real greatestSlip = 0;                  ///< without its sign [m]
    Real timeOfGreatestForce = 0;           ///< [s]
  };
  const Extremes& extremes() const { return extremes_; }
  int broken() const; ///< segments that have torn
  /// Steps whose slips have not been found to round-off.
  Real unbalanced() const { return unbalanced_; }

  void save(std::vector<Real>& numbers) const;
  /// Moves `numbers` past what it has taken.
  void restore(const Real*& numbers);
  void addTo(StateHash& hash, std::uint64_t field, GlobalId id) const;

private:
  struct Trial;
  struct Hinge;
  template <class Self, class F>
  static void forEachNumber(Self& self, F&& number);
  void install(const LineHosts& hosts, Real time);
  void takeOut(const LineHosts& hosts);
  bool detachFromDead(const LineHosts& hosts);
  void remove(std::size_t point);
  std::vector<Real> chords(const std::vector<Vec3>& x) const;
  Vec3 directionOf(std::size_t segment, const std::vector<Vec3>& x) const;
  Real prestrainAt(Real t) const;
  Real slipStrength(const Point& point, const LineHosts& hosts) const;
  void evaluate(const std::vector<Real>& chords, const std::vector<Real>& strengths, Real prestrain,
                Trial& trial) const;
  void solve(const std::vector<Real>& chords, const std::vector<Real>& strengths, Real prestrain,
             Trial& trial);
  struct Flow;
  Flow flowOf(Real stress, Real hardening, Real dt) const;
  /// What flows in a step, p, by trial - stiffness p = yield max(1, p / reference)^exponent.
  /// @param trial more than `yield`
  Real flowAtRate(Real trial, Real stiffness, Real yield, Real reference) const;
  bool slideDowels(const LineHosts& hosts);
  std::optional<std::size_t> segmentOver(int index) const;
  bool bendsAt(std::size_t point) const;
  bool isTornAt(std::size_t point) const; ///< a segment beside it
  Hinge hingeAt(std::size_t point, const std::vector<Vec3>& x) const;
  Real bendingLength(std::size_t point) const;    ///< of the bar, which bends there [m]
  Real bendingStiffness(std::size_t point) const; ///< moment over angle [N m]
  /// With the force that the bar has now [N m].
  Real plasticMoment(std::size_t point) const;
  struct BendingLosses
  {
    Real plastic = 0, rupture = 0; ///< rupture: of bars that are torn, or folded [J]
  };
  /// Moments where the hosts are now.
  BendingLosses bend(const std::vector<Vec3>& x, Real dt);
  void addBendingForces(const std::vector<Vec3>& x);
  void addBendingStiffness(const std::vector<Vec3>& x);
  Real storedByBending() const; ///< [J]
  void findForces(const std::vector<Vec3>& x);
  void findStiffness(const std::vector<Vec3>& x);
  Real hostWork(const std::vector<Vec3>& x) const;
  Real axialStiffness() const { return section_.area * section_.youngsModulus; } ///< [N]

  std::string name_;
  LineSection section_;
  LineBond bond_;
  LineDowel dowel_;
  Real pretension_, pretensionTime_, from_, until_;
  int stage_;
  std::array<bool, 2> mirrored_;
  int lastIndex_; ///< of the last point in the setup

  bool installed_ = false, removed_ = false;
  Real installTime_ = 0; ///< [s]
  Real prestrain_ = 0;
  std::vector<Point> points_;     ///< with a host
  std::vector<Segment> segments_; ///< one less
  std::vector<Dowel> dowels_;
  std::vector<Vec3> x_, forces_; ///< at the last time
  std::array<Vec3, 2> outerMoments_{};
  std::array<Vec3, 2> ends_{}; ///< directions beyond planes of symmetry, from the installation on
  std::vector<Real> stiffness_;
  LineEnergy energy_; ///< but for `stored`
  Extremes extremes_;
  Real unbalanced_ = 0;
};
} // namespace coplane
