#include <coplane_core/Error.hpp>
#include <coplane_core/Lanes.hpp>
#include <coplane_element/ElementBlock.hpp>
#include <coplane_element/detail/ElementShape.hpp>
#include <coplane_element/detail/GaussPoints.hpp>

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
template <ElementType type, Geometry geometry>
struct VolumeChanges
{
  using Shape = ElementShape<type, geometry>;
  using Field = typename Shape::Field;
  ElementKernelData data;

  [[gnu::noinline]] void operator()(const int batch) const
  {
    const int first = batch * laneCount;
    Field x, v;
    Shape::gather(data, first, x, v);
    Field middle;
    Shape::findMiddle(x, v, data.dt, middle);
    const typename Shape::Gradient g = Shape::gradientAt(middle);
    Lanes sum(0.0);
    if constexpr (Shape::revolved)
    {
      sum = v.mean * g.hoop[Shape::gradients];
      for (int k = 0; k < Shape::gradients; ++k)
        sum += v.modes[0][k] * g.hoop[k];
    }
    for (int i = 0; i < Shape::dim; ++i)
      for (int k = 0; k < Shape::gradients; ++k)
        sum += v.modes[i][k] * g.b[i][k];
    store(Lanes(Shape::nodes * data.dt) * sum, &data.volumeChanges(0, first));
    store(g.volume, &data.volumeChanges(1, first));
  }
};

/// Adds the forces of mean tensions, the mean of those at the corners.
template <ElementType type, Geometry geometry>
struct NodalTension
{
  using Shape = ElementShape<type, geometry>;
  using M = Modes<type>;
  using Field = typename Shape::Field;
  ElementKernelData data;

  [[gnu::noinline]] void operator()(const int batch) const
  {
    const int first = batch * laneCount;
    Field x, v;
    Shape::gather(data, first, x, v);
    const typename Shape::Gradient g = Shape::gradientAt(x);
    const int* const node = &data.connectivity(first, 0);
    Lanes sum(0.0);
    for (int c = 0; c < M::nodes; ++c)
      sum += Lanes([&](auto lane) { return data.nodalTension(node[int(lane) * M::nodes + c]); });
    const Lanes tension = Lanes(1.0 / M::nodes) * sum;
    Real force[M::dimension][M::nodes][laneCount];
    for (int i = 0; i < M::dimension; ++i)
    {
      Lanes modes[M::count], mean(0.0);
      for (int k = 0; k < M::count; ++k)
        modes[k] = k < Shape::gradients ? Lanes(0.0) - tension * g.b[i][k] : Lanes(0.0);
      if constexpr (Shape::revolved)
        if (i == 0)
        {
          for (int k = 0; k < Shape::gradients; ++k)
            modes[k] -= tension * g.hoop[k];
          mean = Lanes(0.0) - tension * g.hoop[Shape::gradients];
        }
      Lanes corners[M::nodes];
      M::toCorners(modes, corners);
      for (int c = 0; c < M::nodes; ++c)
        store(corners[c] + mean, force[i][c]);
    }
    storeForces<M, true>(data, first, force);
  }
};

/// A kernel of triangles or tetrahedra over all batches.
template <template <ElementType, Geometry> class Kernel>
void forSimplices(const char* name, ElementType type, const ElementKernelData& data)
{
  const auto run = [&](const auto& kernel) { parallelFor(name, data.batches, kernel); };
  if (type == ElementType::Tet4)
    run(Kernel<ElementType::Tet4, Geometry::PlaneStrain>{data});
  else if (data.options.geometry == Geometry::Axisymmetric)
    run(Kernel<ElementType::Tri3, Geometry::Axisymmetric>{data});
  else
    run(Kernel<ElementType::Tri3, Geometry::PlaneStrain>{data});
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
/// All zero, those that the options need not empty.
/// @param columns elements, a multiple of laneCount; rows of the law's history
ElementArrays arraysOf(ElementType type, const ElementOptions& options,
                       const HourglassOptions& hourglass, int columns, int historyRows)
{
  using Values = ElementTable;
  const int nodes = topology(type).nodes;
  const int dim = topology(type).dimension;
  const bool full = isFullyIntegrated(options.form);
  const bool revolved = options.geometry == Geometry::Axisymmetric;
  ElementArrays arrays;
  arrays.connectivity = Table<int>("connectivity", columns, nodes);
  arrays.mass = Array<Real>("mass", columns);
  arrays.referenceVolume = Array<Real>("referenceVolume", columns);
  arrays.referenceLength = Array<Real>("referenceLength", columns);
  arrays.volume = Array<Real>("volume", columns);
  arrays.stableStep = Array<Real>("stableStep", columns);
  arrays.cornerForce = ElementArrays::CornerVectors("cornerForce", columns, nodes);
  arrays.stress = Values("stress", 6, columns);
  arrays.history = Values("history", historyRows, columns);
  arrays.tangent = Values("tangent", 2, columns);
  arrays.compression = Values("compression", 2, columns);
  arrays.energies = Values("energies", elementEnergies, columns);
  // Rings of assumed strain have two hoop forces besides.
  const int rows =
      withType(type, [](auto t) { return Modes<t()>::hourglass * Modes<t()>::dimension; }) +
      (revolved && options.form == ElementForm::AssumedStrain ? 2 : 0);
  arrays.hourglassForce = Values("hourglassForce", full ? 0 : rows, columns);
  arrays.hourglassViscousForce =
      Values("hourglassViscousForce", hourglass.viscosity > 0 ? rows : 0, columns);
  const int points = full ? nodes : 0;
  const int components = dim == 3 ? tensorRows<3> : tensorRows<2>;
  arrays.cornerMass = Values("cornerMass", full || revolved ? nodes : 0, columns);
  arrays.pointMass = Values("pointMass", points, columns);
  arrays.pointStress = Values("pointStress", points * components, columns);
  arrays.pointHistory = Values("pointHistory", points * historyRows, columns);
  arrays.pointEnergy = Values("pointEnergy", points, columns);
  const bool tracked = options.rate == ObjectiveRate::GreenNaghdi;
  arrays.deformation =
      Values("deformation", tracked ? std::max(points, 1) * dim * dim : 0, columns);
  const bool nodal = options.form == ElementForm::NodalPressure;
  arrays.volumeRatio = Values("volumeRatio", nodal ? 1 : 0, columns);
  arrays.ownTension = Values("ownTension", nodal ? 1 : 0, columns);
  arrays.volumeChanges = Values("volumeChanges", nodal ? 3 : 0, columns);
  arrays.meanTension = Values("meanTension", nodal ? 1 : 0, columns);
  return arrays;
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
  if (simplex ? full || options.form == ElementForm::AssumedStrain
              : options.form == ElementForm::NodalPressure)
    fail(ExitCode::Internal, "element block: {} has no such form", topology(type).exodusName);
  if (options.geometry == Geometry::Axisymmetric && dim == 3)
    fail(ExitCode::Internal, "element block: {} is not axisymmetric", topology(type).exodusName);
  // Neither the strain nor an assumed strain leaves anything to the options of one point.
  if (options.form != ElementForm::OnePoint)
    hourglass_ = {0, 0};
  if (connectivity.size() % nodes != 0)
    fail(ExitCode::Internal, "element block: {} node indices are no multiple of {} for {}",
         connectivity.size(), nodes, topology(type).exodusName);
  count_ = int(connectivity.size() / nodes);
  const int padded = (count_ + laneCount - 1) / laneCount * laneCount;
  historyNames_ = historyNames(law);
  arrays_ = arraysOf(type, options, hourglass_, padded, int(historyNames_.size()));
  alive_ = Values("alive", 1, padded);
  // What pads the last batch is a copy of the last element.
  for (int e = 0; e < padded; ++e)
    for (int c = 0; c < nodes; ++c)
      arrays_.connectivity(e, c) = connectivity[std::size_t(std::min(e, count_ - 1)) * nodes + c];
}

void ElementBlock::initialise(const ConstNodeVectors& x, Real time)
{
  came_ = time;
  const bool flat = topology(type_).dimension == 2;
  const int nodes = topology(type_).nodes;
  centres_.assign(arrays_.mass.extent(0), {});
  for (int e = 0; e < int(arrays_.mass.extent(0)); ++e)
  {
    const Real size = withType(type_, [&](auto t) { return measure<t()>(e, x); });
    arrays_.referenceLength(e) = flat ? std::sqrt(size) : std::cbrt(size);
    for (int c = 0; c < nodes; ++c)
      centres_[std::size_t(e)] += (1.0 / nodes) * at(x, arrays_.connectivity(e, c));
  }
  forEachState([](const char*, int, const Values& values) { values.fill(0); });
  arrays_.tangent.fill(1);
  alive_.fill(1);
  eroded_.clear();
  Kokkos::deep_copy(arrays_.cornerForce, 0.0);
  for (int e = 0; e < int(arrays_.mass.extent(0)); ++e)
    setInitialStress(e, {});
  arrays_.volumeRatio.fill(1);
  const int dim = topology(type_).dimension;
  for (int k = 0; k < int(arrays_.deformation.extent(0)); ++k)
    if (k % (dim * dim) % (dim + 1) == 0)
      for (int e = 0; e < int(arrays_.mass.extent(0)); ++e)
        arrays_.deformation(k, e) = 1;
}

/// Returns the area in two dimensions, else the volume.
template <ElementType type>
Real ElementBlock::measure(int e, const ConstNodeVectors& x)
{
  const Real rho = coplane::density(law_);
  Measures<type> measures(arrays_.connectivity, e, x);
  std::array<Real, 8> parts{};
  if (options_.geometry == Geometry::Axisymmetric)
  {
    Real radii[Modes<type>::nodes];
    for (int c = 0; c < Modes<type>::nodes; ++c)
      radii[c] = x(arrays_.connectivity(e, c), 0);
    parts = measures.revolve(radii);
  }
  else if (isFullyIntegrated(options_.form))
    parts = measures.atPoints([](const Real(&)[3]) { return 1.0; });
  for (int q = 0; q < int(arrays_.pointMass.extent(0)); ++q)
    arrays_.pointMass(q, e) = rho * parts[std::size_t(q)];
  arrays_.referenceVolume(e) = arrays_.volume(e) = measures.volume;
  arrays_.mass(e) = rho * measures.volume;
  for (int c = 0; c < int(arrays_.cornerMass.extent(0)); ++c)
    arrays_.cornerMass(c, e) = rho * measures.share[c];
  return measures.area;
}

void ElementBlock::setInitialStress(const SymTensor& stress)
{
  for (int e = 0; e < int(arrays_.mass.extent(0)); ++e)
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
    arrays_.stress(k, element) = values[k];
  if (arrays_.ownTension.extent(0) > 0)
    arrays_.ownTension(0, element) = (s.xx + s.yy + s.zz) / 3;
  const auto start = initialHistory(law_, s, centres_[std::size_t(element)], came_);
  const int rows = int(arrays_.history.extent(0));
  for (int k = 0; k < rows; ++k)
    arrays_.history(k, element) = start[std::size_t(k)];
  for (int k = 0; k < int(arrays_.pointHistory.extent(0)); ++k)
    arrays_.pointHistory(k, element) = start[std::size_t(k % rows)];
  const int components = topology(type_).dimension == 3 ? tensorRows<3> : tensorRows<2>;
  for (int k = 0; k < int(arrays_.pointStress.extent(0)); ++k)
    arrays_.pointStress(k, element) = values[k % components];
}

void ElementBlock::findVolumeChanges(const ConstNodeVectors& x, const ConstNodeVectors& v, Real dt)
{
  if (count_ > 0)
    forSimplices<VolumeChanges>("coplane::element::volumeChanges", type_, kernelData(x, v, dt));
}

void ElementBlock::addNodalTension(const ConstNodeVectors& x, const ConstArray<Real>& nodalTension)
{
  if (count_ == 0)
    return;
  ElementKernelData data = kernelData(x, x, 0);
  data.nodalTension = nodalTension;
  forSimplices<NodalTension>("coplane::element::nodalTension", type_, data);
  for (const Eroded& eroded : eroded_)
    restore(eroded);
}

Real ElementBlock::workLeftToNodes(int element) const
{
  return options_.form == ElementForm::NodalPressure
             ? 0.5 * arrays_.meanTension(0, element) * arrays_.volumeChanges(2, element)
             : 0;
}

ElementKernelData ElementBlock::kernelData(const ConstNodeVectors& x, const ConstNodeVectors& v,
                                           Real dt) const
{
  const LinearElastic& elastic = elasticity(law_);
  ElementKernelData data{arrays_};
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
  data.batches = int(arrays_.mass.extent(0)) / laneCount;
  data.material = &law_;
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
  end(element, 0);
}

void ElementBlock::takeOut(int element)
{
  end(element, -1);
}

void ElementBlock::end(int element, Real mark)
{
  for (const Values& values :
       {arrays_.stress, arrays_.hourglassForce, arrays_.hourglassViscousForce, arrays_.compression,
        arrays_.energies, arrays_.pointStress, arrays_.pointEnergy, alive_})
    for (std::size_t row = 0; row < values.extent(0); ++row)
      values(row, element) = 0;
  alive_(0, element) = mark;
  Eroded eroded{element, arrays_.volume(element), {}};
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
  arrays_.volume(e) = eroded.volume;
  arrays_.stableStep(e) = infinity;
  for (std::size_t corner = 0; corner < arrays_.cornerForce.extent(1); ++corner)
    for (int c = 0; c < 3; ++c)
      arrays_.cornerForce(e, corner, c) = 0;
}

namespace
{
// One element of an array into a place of another one of the same shape.
void copyColumn(const ElementTable& from, int source, const ElementTable& to, int place)
{
  for (std::size_t row = 0; row < from.extent(0); ++row)
    to(row, place) = from(row, source);
}
void copyColumn(const Array<Real>& from, int source, const Array<Real>& to, int place)
{
  to(place) = from(source);
}
void copyColumn(const ElementArrays::CornerVectors& from, int source,
                const ElementArrays::CornerVectors& to, int place)
{
  for (std::size_t corner = 0; corner < from.extent(1); ++corner)
    for (int c = 0; c < 3; ++c)
      to(place, corner, c) = from(source, corner, c);
}
} // namespace

ElementBlock ElementBlock::part(const std::vector<int>& elements) const
{
  if (options_.form == ElementForm::NodalPressure)
    fail(ExitCode::Internal, "element block: nodal pressures have no parts");
  std::vector<int> connectivity;
  for (const int e : elements)
    for (std::size_t c = 0; c < arrays_.connectivity.extent(1); ++c)
      connectivity.push_back(arrays_.connectivity(e, c));
  ElementBlock made(type_, law_, hourglass_, viscosity_, connectivity, options_);
  made.alive_.fill(1);
  give(elements, made);
  return made;
}

void ElementBlock::give(const std::vector<int>& elements, ElementBlock& part) const
{
  // What pads the last batch is a copy of the last element.
  const int padded = int(part.arrays_.mass.extent(0)), last = int(elements.size()) - 1;
  ElementArrays::forEachOfBoth(arrays_, part.arrays_,
                               [&](const auto& from, const auto& to)
                               {
                                 for (int i = 0; i < padded; ++i)
                                   copyColumn(from, elements[std::size_t(std::min(i, last))], to,
                                              i);
                               });
}

void ElementBlock::take(const std::vector<int>& elements, const ElementBlock& part)
{
  ElementArrays::forEachOfBoth(part.arrays_, arrays_,
                               [&](const auto& from, const auto& to)
                               {
                                 for (int i = 0; i < int(elements.size()); ++i)
                                   copyColumn(from, i, to, elements[std::size_t(i)]);
                               });
}

Real ElementBlock::chemicalEnergy(int e) const
{
  const Jwl* const explosive = std::get_if<Jwl>(&law_);
  return explosive ? explosive->energy * arrays_.history(Jwl::BurnFraction, e) *
                         arrays_.referenceVolume(e)
                   : 0;
}

Real ElementBlock::pressure(int e) const
{
  return -(arrays_.stress(0, e) + arrays_.stress(1, e) + arrays_.stress(2, e)) / 3;
}

Real ElementBlock::vonMises(int e) const
{
  const Real p = pressure(e);
  const Real xx = arrays_.stress(0, e) + p, yy = arrays_.stress(1, e) + p,
             zz = arrays_.stress(2, e) + p;
  const Real xy = arrays_.stress(3, e), yz = arrays_.stress(4, e), zx = arrays_.stress(5, e);
  return std::sqrt(1.5 * (xx * xx + yy * yy + zz * zz + 2 * (xy * xy + yz * yz + zx * zx)));
}

int ElementBlock::historyRow(const std::string& name) const
{
  const auto found = std::find(historyNames_.begin(), historyNames_.end(), name);
  return found == historyNames_.end() ? -1 : int(found - historyNames_.begin());
}

Real ElementBlock::smallestStableStep() const
{
  const ConstArray<Real> step = arrays_.stableStep;
  return parallelMin(
      "coplane::element::smallestStableStep", count_,
      KOKKOS_LAMBDA(const int e) { return step(e); });
}

int ElementBlock::invertedElement() const
{
  const ConstArray<Real> step = arrays_.stableStep;
  const Real none = count_;
  const Real lowest = parallelMin(
      "coplane::element::invertedElement", count_,
      KOKKOS_LAMBDA(const int e) { return step(e) > 0 ? none : Real(e); });
  return lowest < none ? int(lowest) : -1;
}
} // namespace coplane
