#include <coplane_core/Error.hpp>
#include <coplane_core/Lanes.hpp>
#include <coplane_element/ElementBlock.hpp>
#include <coplane_element/FullKernel.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace coplane
{
namespace
{
/// Volumes and masses of an element, from the positions of its corners.
template <ElementType type>
struct Measures
{
  using M = Modes<type>;
  Real modes[M::dimension][M::count], b[M::dimension][M::gradients];
  Real area = 0, volume = 0; ///< in two dimensions the area of the section; [m^2], [m^3]
  Real share[M::nodes];      ///< int N_I dV, where masses of corners differ [m^3]

  Measures(const ConstTable<int>& connectivity, int element, const ConstNodeVectors& x)
  {
    for (int i = 0; i < M::dimension; ++i)
    {
      Real corner[M::nodes];
      for (int c = 0; c < M::nodes; ++c)
        corner[c] = x(connectivity(element, c), i) - x(connectivity(element, 0), i);
      M::fromCorners(corner, modes[i]);
    }
    M::volumeGradient(modes, b);
    area = volume = M::volume(modes, b);
    for (Real& part : share)
      part = volume / M::nodes;
  }

  /// Of the ring of which the element is a section; returns the volumes of the points of
  /// quadrilaterals. r: radii of the corners [m]
  std::array<Real, 8> revolve(const Real* r)
  {
    if constexpr (type == ElementType::Tri3)
    {
      volume = 0;
      for (int c = 0; c < 3; ++c)
        volume += share[c] = 2 * pi * area / 12 * (r[c] + (r[0] + r[1] + r[2]));
    }
    else if constexpr (type == ElementType::Quad4)
    {
      Real mean = 0;
      for (int c = 0; c < 4; ++c)
        mean += 0.25 * r[c];
      return atPoints(
          [&](const Real(&p)[3]) {
            return 2 * pi *
                   (mean + modes[0][0] * p[0] + modes[0][1] * p[1] + modes[0][2] * p[0] * p[1]);
          });
    }
    return {};
  }

  /// Shares and volume by Gauss points; calls weight(point) for a factor. Returns the volumes of
  /// the points.
  template <class Weight>
  std::array<Real, 8> atPoints(const Weight& weight)
  {
    std::array<Real, 8> parts{};
    if constexpr (type == ElementType::Quad4 || type == ElementType::Hex8)
    {
      using Points = GaussPoints<type>;
      volume = 0;
      for (Real& part : share)
        part = 0;
      for (int q = 0; q < Points::count; ++q)
      {
        Real p[3];
        gaussPoint(q, p);
        Vec3 slope[3] = {{}, {}, {0, 0, 1}}; // columns: dx/dxi_k
        for (int i = 0; i < M::dimension; ++i)
        {
          Real s[3];
          Points::slopes(modes[i], p, s);
          for (int k = 0; k < M::dimension; ++k)
            slope[k][i] = s[k];
        }
        parts[q] = weight(p) * dot(cross(slope[0], slope[1]), slope[2]);
        volume += parts[q];
        static constexpr int sign[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                           {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
        for (int c = 0; c < M::nodes; ++c)
        {
          Real shape = 1;
          for (int k = 0; k < M::dimension; ++k)
            shape *= 0.5 * (1 + sign[c][k] * p[k]);
          share[c] += shape * parts[q];
        }
      }
    }
    return parts;
  }
};

/// Increment of the volume over a step, and the volume in its middle.
template <ElementType type, bool revolved>
struct VolumeChanges
{
  using M = Modes<type>;
  ElementKernelData data;
  ElementBlock::Values changes;

  [[gnu::noinline]] void operator()(const int batch) const
  {
    const int first = batch * laneCount;
    Lanes x[M::dimension][M::count], v[M::dimension][M::count], radius(0.0), speed(0.0);
    gatherModes<M>(data.connectivity, data.x, first, x, revolved ? &radius : nullptr);
    gatherModes<M>(data.connectivity, data.v, first, v, revolved ? &speed : nullptr);
    for (int i = 0; i < M::dimension; ++i)
      for (int k = 0; k < M::count; ++k)
        x[i][k] -= Lanes(0.5 * data.dt) * v[i][k];
    Lanes b[M::dimension][M::gradients], sum(0.0), volume;
    if constexpr (revolved)
    {
      Lanes hoop[M::gradients + 1];
      volume = Revolved<type>::volumeGradient(x, radius - Lanes(0.5 * data.dt) * speed, b, hoop);
      sum = speed * hoop[M::gradients];
      for (int k = 0; k < M::gradients; ++k)
        sum += v[0][k] * hoop[k];
    }
    else
    {
      M::volumeGradient(x, b);
      volume = M::volume(x, b);
    }
    for (int i = 0; i < M::dimension; ++i)
      for (int k = 0; k < M::gradients; ++k)
        sum += v[i][k] * b[i][k];
    store(Lanes(M::nodes * data.dt) * sum, &changes(0, first));
    store(volume, &changes(1, first));
  }
};

/// Calls f with the type as a constant.
template <class F>
auto withType(ElementType type, F&& f)
{
  switch (type)
  {
  case ElementType::Tri3:
    return f(std::integral_constant<ElementType, ElementType::Tri3>{});
  case ElementType::Quad4:
    return f(std::integral_constant<ElementType, ElementType::Quad4>{});
  case ElementType::Tet4:
    return f(std::integral_constant<ElementType, ElementType::Tet4>{});
  default:
    return f(std::integral_constant<ElementType, ElementType::Hex8>{});
  }
}
} // namespace

ElementBlock::ElementBlock(ElementType type, const Material& law, const HourglassOptions& hourglass,
                           const BulkViscosity& viscosity, const std::vector<int>& connectivity,
                           const ElementOptions& options)
    : type_(type), law_(law), hourglass_(hourglass), viscosity_(viscosity), options_(options)
{
  const int nodes = topology(type).nodes;
  const int dim = topology(type).dimension;
  const bool simplex = nodes == dim + 1;
  const bool full = isFullyIntegrated(options.form);
  const bool revolved = options.geometry == Geometry::Axisymmetric;
  if (simplex ? full || options.form == ElementForm::AssumedStrain
              : options.form == ElementForm::NodalPressure)
    fail(ExitCode::Internal, "element block: {} has no such form", topology(type).exodusName);
  if (revolved && dim == 3)
    fail(ExitCode::Internal, "element block: {} is not axisymmetric", topology(type).exodusName);
  // Neither the strain nor an assumed strain leaves anything to the options of one point.
  if (options.form != ElementForm::OnePoint)
    hourglass_ = {0, 0};
  if (connectivity.size() % nodes != 0)
    fail(ExitCode::Internal, "element block: {} node indices are no multiple of {} for {}",
         connectivity.size(), nodes, topology(type).exodusName);
  count_ = int(connectivity.size() / nodes);
  const int padded = (count_ + laneCount - 1) / laneCount * laneCount;

  connectivity_ = Table<int>("connectivity", padded, nodes);
  for (int e = 0; e < padded; ++e)
    for (int c = 0; c < nodes; ++c)
      connectivity_(e, c) = connectivity[std::size_t(std::min(e, count_ - 1)) * nodes + c];

  mass_ = Array<Real>("mass", padded);
  referenceVolume_ = Array<Real>("referenceVolume", padded);
  referenceLength_ = Array<Real>("referenceLength", padded);
  volume_ = Array<Real>("volume", padded);
  stableStep_ = Array<Real>("stableStep", padded);
  cornerForce_ = CornerVectors("cornerForce", padded, nodes);
  stress_ = Values("stress", 6, padded);
  historyNames_ = historyNames(law);
  history_ = Values("history", historyNames_.size(), padded);
  tangent_ = Values("tangent", 2, padded);
  compression_ = Values("compression", 2, padded);
  energies_ = Values("energies", elementEnergies, padded);
  alive_ = Values("alive", 1, padded);
  // Rings of assumed strain have two hoop forces besides.
  const int rows =
      withType(type, [](auto t) { return Modes<t()>::hourglass * Modes<t()>::dimension; }) +
      (revolved && options.form == ElementForm::AssumedStrain ? 2 : 0);
  hourglassForce_ = Values("hourglassForce", full ? 0 : rows, padded);
  hourglassViscousForce_ =
      Values("hourglassViscousForce", hourglass_.viscosity > 0 ? rows : 0, padded);
  const int points = full ? nodes : 0;
  const int components = dim == 3 ? 6 : 4;
  cornerMass_ = Values("cornerMass", full || revolved ? nodes : 0, padded);
  pointMass_ = Values("pointMass", points, padded);
  pointStress_ = Values("pointStress", points * components, padded);
  pointHistory_ = Values("pointHistory", points * historyNames_.size(), padded);
  pointEnergy_ = Values("pointEnergy", points, padded);
  const bool tracked = options.rate == ObjectiveRate::GreenNaghdi;
  deformation_ = Values("deformation", tracked ? std::max(points, 1) * dim * dim : 0, padded);
  const bool nodal = options.form == ElementForm::NodalPressure;
  volumeRatio_ = Values("volumeRatio", nodal ? 1 : 0, padded);
  volumeChanges_ = Values("volumeChanges", nodal ? 2 : 0, padded);
}

void ElementBlock::initialise(const ConstNodeVectors& x)
{
  const bool flat = topology(type_).dimension == 2;
  for (int e = 0; e < int(mass_.extent(0)); ++e)
  {
    const Real size = withType(type_, [&](auto t) { return measure<t()>(e, x); });
    referenceLength_(e) = flat ? std::sqrt(size) : std::cbrt(size);
  }
  forEachState([](const char*, int, const Values& values) { Kokkos::deep_copy(values, 0.0); });
  Kokkos::deep_copy(tangent_, 1.0);
  Kokkos::deep_copy(alive_, 1.0);
  eroded_.clear();
  Kokkos::deep_copy(cornerForce_, 0.0);
  for (int e = 0; e < int(mass_.extent(0)); ++e)
    setInitialStress(e, {});
  Kokkos::deep_copy(volumeRatio_, 1.0);
  const int dim = topology(type_).dimension;
  for (int k = 0; k < int(deformation_.extent(0)); ++k)
    if (k % (dim * dim) % (dim + 1) == 0)
      for (int e = 0; e < int(mass_.extent(0)); ++e)
        deformation_(k, e) = 1;
}

/// Returns the area in two dimensions, else the volume.
template <ElementType type>
Real ElementBlock::measure(int e, const ConstNodeVectors& x)
{
  const Real rho = coplane::density(law_);
  Measures<type> measures(connectivity_, e, x);
  std::array<Real, 8> parts{};
  if (options_.geometry == Geometry::Axisymmetric)
  {
    Real radii[Modes<type>::nodes];
    for (int c = 0; c < Modes<type>::nodes; ++c)
      radii[c] = x(connectivity_(e, c), 0);
    parts = measures.revolve(radii);
  }
  else if (isFullyIntegrated(options_.form))
    parts = measures.atPoints([](const Real(&)[3]) { return 1.0; });
  for (int q = 0; q < int(pointMass_.extent(0)); ++q)
    pointMass_(q, e) = rho * parts[std::size_t(q)];
  referenceVolume_(e) = volume_(e) = measures.volume;
  mass_(e) = rho * measures.volume;
  for (int c = 0; c < int(cornerMass_.extent(0)); ++c)
    cornerMass_(c, e) = rho * measures.share[c];
  return measures.area;
}

void ElementBlock::setInitialStress(const SymTensor& stress)
{
  for (int e = 0; e < int(mass_.extent(0)); ++e)
    setInitialStress(e, stress);
}

void ElementBlock::setInitialStress(int element, const SymTensor& s)
{
  if (topology(type_).dimension == 2 && (s.yz != 0 || s.zx != 0))
    fail(ExitCode::Deck,
         "initial stress: yz = {} Pa and zx = {} Pa, but elements in plane strain carry neither. "
         "Set both to 0.",
         s.yz, s.zx);
  const Real values[6] = {s.xx, s.yy, s.zz, s.xy, s.yz, s.zx};
  for (int k = 0; k < 6; ++k)
    stress_(k, element) = values[k];
  const auto start = initialHistory(law_, s);
  const int rows = int(history_.extent(0));
  for (int k = 0; k < rows; ++k)
    history_(k, element) = start[std::size_t(k)];
  for (int k = 0; k < int(pointHistory_.extent(0)); ++k)
    pointHistory_(k, element) = start[std::size_t(k % rows)];
  const int components = topology(type_).dimension == 3 ? 6 : 4;
  for (int k = 0; k < int(pointStress_.extent(0)); ++k)
    pointStress_(k, element) = values[k % components];
}

void ElementBlock::findVolumeChanges(const ConstNodeVectors& x, const ConstNodeVectors& v, Real dt)
{
  if (count_ == 0)
    return;
  const ElementKernelData data = kernelData(x, v, dt);
  const auto changes = volumeChanges_;
  const bool revolved = options_.geometry == Geometry::Axisymmetric;
  const auto run = [&](auto type, auto isRevolved)
  {
    parallelFor("coplane::element::volumeChanges", data.batches,
                VolumeChanges<type(), isRevolved()>{data, changes});
  };
  if (type_ == ElementType::Tet4)
    run(std::integral_constant<ElementType, ElementType::Tet4>{}, std::false_type{});
  else if (revolved)
    run(std::integral_constant<ElementType, ElementType::Tri3>{}, std::true_type{});
  else
    run(std::integral_constant<ElementType, ElementType::Tri3>{}, std::false_type{});
}

ElementKernelData ElementBlock::kernelData(const ConstNodeVectors& x, const ConstNodeVectors& v,
                                           Real dt) const
{
  const LinearElastic& elastic = elasticity(law_);
  ElementKernelData data;
  data.x = x;
  data.v = v;
  data.dt = dt;
  data.options = options_;
  data.hourglass = hourglass_;
  data.viscosity = viscosity_;
  data.lambda = lameLambda(elastic);
  // The bounds of the stable step divide by it; a gas has none.
  data.shearModulus = std::max(elastic.shearModulus, 1e-6 * pWaveModulus(elastic));
  data.pWaveModulus = pWaveModulus(elastic);
  data.soundSpeed = soundSpeed(law_);
  data.batches = int(mass_.extent(0)) / laneCount;
  data.material = &law_;
  data.connectivity = connectivity_;
  data.mass = mass_;
  data.referenceVolume = referenceVolume_;
  data.referenceLength = referenceLength_;
  data.stress = stress_;
  data.history = history_;
  data.tangent = tangent_;
  data.hourglassForce = hourglassForce_;
  data.hourglassViscousForce = hourglassViscousForce_;
  data.compression = compression_;
  data.energies = energies_;
  data.cornerForce = cornerForce_;
  data.stableStep = stableStep_;
  data.volume = volume_;
  data.cornerMass = cornerMass_;
  data.deformation = deformation_;
  data.volumeRatio = volumeRatio_;
  data.pointMass = pointMass_;
  data.pointStress = pointStress_;
  data.pointHistory = pointHistory_;
  data.pointEnergy = pointEnergy_;
  return data;
}

void ElementBlock::update(const ConstNodeVectors& x, const ConstNodeVectors& v, Real dt,
                          const ConstArray<Real>& nodalDilatation)
{
  if (count_ == 0)
    return;
  ElementKernelData data = kernelData(x, v, dt);
  data.nodalDilatation = nodalDilatation;
  if (options_.form == ElementForm::NodalPressure && dt > 0 && nodalDilatation.extent(0) == 0)
    fail(ExitCode::Internal, "element block: nodal dilatations are missing");
  const bool revolved = options_.geometry == Geometry::Axisymmetric;
  const bool full = isFullyIntegrated(options_.form);
  switch (type_)
  {
  case ElementType::Tri3:
    revolved ? updateRevolvedTri3(data) : updateTri3(data);
    break;
  case ElementType::Quad4:
    if (full)
      revolved ? updateFullRevolvedQuad4(data) : updateFullQuad4(data);
    else
      revolved ? updateRevolvedQuad4(data) : updateQuad4(data);
    break;
  case ElementType::Tet4:
    updateTet4(data);
    break;
  case ElementType::Hex8:
    full ? updateFullHex8(data) : updateHex8(data);
    break;
  }
  for (const Eroded& eroded : eroded_)
    restore(eroded);
}

void ElementBlock::erode(int element)
{
  for (const Values& values : {stress_, hourglassForce_, hourglassViscousForce_, compression_,
                               energies_, pointStress_, pointEnergy_, alive_})
    for (std::size_t row = 0; row < values.extent(0); ++row)
      values(row, element) = 0;
  Eroded eroded{element, volume_(element), {}};
  forEachState(
      [&](const char*, int rows, const Values& values)
      {
        for (int row = 0; row < rows; ++row)
          eroded.state.push_back(values(row, element));
      });
  restore(eroded);
  eroded_.push_back(std::move(eroded));
}

void ElementBlock::restore(const Eroded& eroded)
{
  const int e = eroded.element;
  std::size_t i = 0;
  forEachState(
      [&](const char*, int rows, const Values& values)
      {
        for (int row = 0; row < rows; ++row)
          values(row, e) = eroded.state[i++];
      });
  volume_(e) = eroded.volume;
  stableStep_(e) = infinity;
  for (std::size_t corner = 0; corner < cornerForce_.extent(1); ++corner)
    for (int c = 0; c < 3; ++c)
      cornerForce_(e, corner, c) = 0;
}

Real ElementBlock::pressure(int e) const
{
  return -(stress_(0, e) + stress_(1, e) + stress_(2, e)) / 3;
}

Real ElementBlock::vonMises(int e) const
{
  const Real p = pressure(e);
  const Real xx = stress_(0, e) + p, yy = stress_(1, e) + p, zz = stress_(2, e) + p;
  const Real xy = stress_(3, e), yz = stress_(4, e), zx = stress_(5, e);
  return std::sqrt(1.5 * (xx * xx + yy * yy + zz * zz + 2 * (xy * xy + yz * yz + zx * zx)));
}

int ElementBlock::historyRow(const std::string& name) const
{
  const auto found = std::find(historyNames_.begin(), historyNames_.end(), name);
  return found == historyNames_.end() ? -1 : int(found - historyNames_.begin());
}

ConstArray<Real> ElementBlock::viscousPressure() const
{
  return ConstArray<Real>(compression_.data() + compression_.extent(1), compression_.extent(1));
}

Real ElementBlock::smallestStableStep() const
{
  const ConstArray<Real> step = stableStep_;
  return parallelMin(
      "coplane::element::smallestStableStep", count_,
      KOKKOS_LAMBDA(const int e) { return step(e); });
}

int ElementBlock::invertedElement() const
{
  const ConstArray<Real> step = stableStep_;
  const Real none = count_;
  const Real lowest = parallelMin(
      "coplane::element::invertedElement", count_,
      KOKKOS_LAMBDA(const int e) { return step(e) > 0 ? none : Real(e); });
  return lowest < none ? int(lowest) : -1;
}
} // namespace coplane
