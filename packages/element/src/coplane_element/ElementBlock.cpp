#include <coplane_core/Error.hpp>
#include <coplane_core/Lanes.hpp>
#include <coplane_element/ElementBlock.hpp>
#include <coplane_element/ElementKernel.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace coplane
{
namespace
{
template <ElementType type>
Real volumeOf(const ConstTable<int>& connectivity, int element, const ConstNodeVectors& x)
{
  using M = Modes<type>;
  Real modes[M::dimension][M::count], b[M::dimension][M::gradients];
  for (int i = 0; i < M::dimension; ++i)
  {
    Real corner[M::nodes];
    for (int c = 0; c < M::nodes; ++c)
      corner[c] = x(connectivity(element, c), i) - x(connectivity(element, 0), i);
    M::fromCorners(corner, modes[i]);
  }
  M::volumeGradient(modes, b);
  return M::volume(modes, b);
}

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
                           const BulkViscosity& viscosity, const std::vector<int>& connectivity)
    : type_(type), law_(law), hourglass_(hourglass), viscosity_(viscosity)
{
  const int nodes = topology(type).nodes;
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
  const int rows =
      withType(type, [](auto t) { return Modes<t()>::hourglass * Modes<t()>::dimension; });
  hourglassForce_ = Values("hourglassForce", rows, padded);
  hourglassViscousForce_ =
      Values("hourglassViscousForce", hourglass.viscosity > 0 ? rows : 0, padded);
}

void ElementBlock::initialise(const ConstNodeVectors& x)
{
  const bool flat = topology(type_).dimension == 2;
  const Real rho = coplane::density(law_);
  for (int e = 0; e < int(mass_.extent(0)); ++e)
  {
    const Real volume = withType(type_, [&](auto t) { return volumeOf<t()>(connectivity_, e, x); });
    referenceVolume_(e) = volume_(e) = volume;
    referenceLength_(e) = flat ? std::sqrt(volume) : std::cbrt(volume);
    mass_(e) = rho * volume;
  }
  forEachState([](const char*, int, const Values& values) { Kokkos::deep_copy(values, 0.0); });
  Kokkos::deep_copy(tangent_, 1.0);
  Kokkos::deep_copy(alive_, 1.0);
  eroded_.clear();
  Kokkos::deep_copy(cornerForce_, 0.0);
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
}

void ElementBlock::update(const ConstNodeVectors& x, const ConstNodeVectors& v, Real dt)
{
  if (count_ == 0)
    return;
  const LinearElastic& elastic = elasticity(law_);
  const ElementKernelData data{x,
                               v,
                               dt,
                               hourglass_,
                               viscosity_,
                               lameLambda(elastic),
                               elastic.shearModulus,
                               pWaveModulus(elastic),
                               soundSpeed(law_),
                               int(mass_.extent(0)) / laneCount,
                               &law_,
                               connectivity_,
                               mass_,
                               referenceVolume_,
                               referenceLength_,
                               stress_,
                               history_,
                               tangent_,
                               hourglassForce_,
                               hourglassViscousForce_,
                               compression_,
                               energies_,
                               cornerForce_,
                               stableStep_,
                               volume_};
  switch (type_)
  {
  case ElementType::Tri3:
    updateTri3(data);
    break;
  case ElementType::Quad4:
    updateQuad4(data);
    break;
  case ElementType::Tet4:
    updateTet4(data);
    break;
  case ElementType::Hex8:
    updateHex8(data);
    break;
  }
  for (const Eroded& eroded : eroded_)
    restore(eroded);
}

void ElementBlock::erode(int element)
{
  for (const Values& values :
       {stress_, hourglassForce_, hourglassViscousForce_, compression_, energies_, alive_})
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
