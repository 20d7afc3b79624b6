#pragma once

#include <coplane_element/ElementBlock.hpp>

#include <functional>
#include <initializer_list>
#include <random>
#include <string>
#include <utility>
#include <vector>

// Small meshes and nodal fields for the tests of this package.
namespace coplane::testMeshes
{
struct TestMesh
{
  ElementType type;
  NodeVectors x;
  std::vector<int> connectivity;
  std::vector<bool> interior; ///< nodes inside the unit square or cube
  int nodes() const { return int(x.extent(0)); }
  int corners() const { return topology(type).nodes; }
};

inline bool isFlat(ElementType type)
{
  return topology(type).dimension == 2;
}

/// Unit square or cube of n cells along each edge, all nodes moved by up to `distortion` cell
/// sizes. A cell is one quadrilateral or hexahedron, two triangles or six tetrahedra.
inline TestMesh distorted(ElementType type, int n, Real distortion, unsigned seed = 7)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<Real> push(-distortion / n, distortion / n);
  const bool flat = isFlat(type);
  const int m = n + 1, layers = flat ? 1 : m;
  TestMesh mesh{type, NodeVectors("x", m * m * layers), {}, {}};
  for (int k = 0; k < layers; ++k)
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < m; ++i)
      {
        const int node = (k * m + j) * m + i;
        const auto inside = [n](int a) { return a > 0 && a < n; };
        mesh.interior.push_back(inside(i) && inside(j) && (flat || inside(k)));
        mesh.x(node, 0) = Real(i) / n + push(random);
        mesh.x(node, 1) = Real(j) / n + push(random);
        mesh.x(node, 2) = flat ? 0 : Real(k) / n + push(random);
      }
  for (int k = 0; k < (flat ? 1 : n); ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
      {
        const int o = (k * m + j) * m + i, far = o + m + 1, up = m * m;
        const auto add = [&](std::initializer_list<int> corners)
        { mesh.connectivity.insert(mesh.connectivity.end(), corners); };
        if (type == ElementType::Quad4 || type == ElementType::Hex8)
          add({o, o + 1, far, o + m});
        if (type == ElementType::Hex8)
          add({o + up, o + 1 + up, far + up, o + m + up});
        if (type == ElementType::Tri3)
          for (const auto& [a, b] : {std::pair{o + 1, far}, {far, o + m}})
            add({o, a, b});
        if (type ==
            ElementType::Tet4) // paths along the edges from one end of a diagonal to the other
          for (const auto& [a, b] : {std::pair{1, far - o}, {m, m + up}, {up, up + 1}})
            add({o, o + a, o + b, far + up});
        if (type == ElementType::Tet4)
          for (const auto& [a, b] : {std::pair{m, far - o}, {up, m + up}, {1, up + 1}})
            add({o, o + b, o + a, far + up});
      }
  return mesh;
}

/// One element, the first of the distorted cell; other nodes belong to nothing.
inline TestMesh single(ElementType type, Real distortion, unsigned seed = 7)
{
  TestMesh mesh = distorted(type, 1, distortion, seed);
  mesh.connectivity.resize(mesh.corners());
  return mesh;
}

/// Adds the forces of mean tensions, with nodal pressure, of a block alone.
inline void addOwnTensions(ElementBlock& block, const NodeVectors& x)
{
  if (block.options().form != ElementForm::NodalPressure)
    return;
  Array<Real> tension("tension", x.extent(0)), volume("volume", x.extent(0));
  for (int e = 0; e < block.count(); ++e)
    for (int c = 0; c < int(block.connectivity().extent(1)); ++c)
    {
      tension(block.connectivity()(e, c)) += block.meanTension()(0, e);
      volume(block.connectivity()(e, c)) += block.volume(e);
    }
  for (int n = 0; n < int(x.extent(0)); ++n)
    tension(n) = volume(n) > 0 ? tension(n) / volume(n) : 0;
  block.addNodalTension(x, tension);
}

/// A step of a block alone: with nodal pressure, dilatations come from its own elements.
inline void advance(ElementBlock& block, const NodeVectors& x, const NodeVectors& v, Real dt)
{
  Array<Real> dilatation;
  if (block.options().form == ElementForm::NodalPressure && dt > 0)
  {
    block.findVolumeChanges(x, v, dt);
    dilatation = Array<Real>("dilatation", x.extent(0));
    Array<Real> volume("volume", x.extent(0));
    for (int e = 0; e < block.count(); ++e)
      for (int c = 0; c < int(block.connectivity().extent(1)); ++c)
      {
        dilatation(block.connectivity()(e, c)) += block.volumeChanges()(0, e);
        volume(block.connectivity()(e, c)) += block.volumeChanges()(1, e);
      }
    for (int n = 0; n < int(x.extent(0)); ++n)
      dilatation(n) = volume(n) > 0 ? dilatation(n) / volume(n) : 0;
  }
  block.update(x, v, dt, dilatation);
  addOwnTensions(block, x);
}

struct Formulation
{
  ElementType type;
  ElementOptions options;
};

/// Every form in plane strain and in three dimensions, and every objective rate with some form.
inline std::vector<Formulation> allFormulations()
{
  using F = ElementForm;
  using R = ObjectiveRate;
  std::vector<Formulation> list;
  for (const ElementType type : {ElementType::Quad4, ElementType::Hex8})
    for (const F form :
         {F::OnePoint, F::AssumedStrain, F::FullIntegration, F::FullIntegrationPlain})
      list.push_back({type, {form}});
  for (const ElementType type : {ElementType::Tri3, ElementType::Tet4})
    for (const F form : {F::OnePoint, F::NodalPressure})
      list.push_back({type, {form}});
  for (const ElementType type :
       {ElementType::Tri3, ElementType::Quad4, ElementType::Tet4, ElementType::Hex8})
    list.push_back({type, {F::OnePoint, R::GreenNaghdi}});
  list.push_back({ElementType::Quad4, {F::OnePoint, R::Jaumann}});
  list.push_back({ElementType::Hex8, {F::OnePoint, R::Jaumann}});
  list.push_back({ElementType::Quad4, {F::FullIntegration, R::GreenNaghdi}});
  list.push_back({ElementType::Hex8, {F::FullIntegration, R::GreenNaghdi}});
  return list;
}

/// Bodies of revolution.
inline std::vector<Formulation> revolvedFormulations()
{
  constexpr auto hughesWinget = ObjectiveRate::HughesWinget;
  constexpr auto revolved = Geometry::Axisymmetric;
  return {
      {ElementType::Tri3, {ElementForm::OnePoint, hughesWinget, revolved}},
      {ElementType::Tri3, {ElementForm::NodalPressure, hughesWinget, revolved}},
      {ElementType::Quad4, {ElementForm::OnePoint, hughesWinget, revolved}},
      {ElementType::Quad4, {ElementForm::AssumedStrain, hughesWinget, revolved}},
      {ElementType::Quad4, {ElementForm::FullIntegration, hughesWinget, revolved}},
      {ElementType::Quad4, {ElementForm::FullIntegrationPlain, hughesWinget, revolved}},
      {ElementType::Quad4, {ElementForm::FullIntegration, ObjectiveRate::GreenNaghdi, revolved}}};
}

inline std::vector<Formulation> allOf(std::vector<Formulation> list,
                                      const std::vector<Formulation>& more)
{
  list.insert(list.end(), more.begin(), more.end());
  return list;
}

/// The distorted unit square or cube; bodies of revolution half a metre off their axis.
inline TestMesh meshOf(const Formulation& f, int n, Real distortion, unsigned seed = 7)
{
  TestMesh mesh = distorted(f.type, n, distortion, seed);
  if (f.options.geometry == Geometry::Axisymmetric)
    for (int node = 0; node < mesh.nodes(); ++node)
      mesh.x(node, 0) += 0.5;
  return mesh;
}

/// Those of which `holds`.
template <class Predicate>
std::vector<Formulation> those(std::vector<Formulation> list, const Predicate& holds)
{
  list.erase(std::remove_if(list.begin(), list.end(), [&](const auto& f) { return !holds(f); }),
             list.end());
  return list;
}

inline std::string nameOf(const Formulation& f)
{
  const char* forms[] = {"OnePoint", "AssumedStrain", "Full", "FullPlain", "NodalPressure"};
  const char* rates[] = {"", "Jaumann", "GreenNaghdi"};
  return std::string(topology(f.type).exodusName) + forms[int(f.options.form)] +
         rates[int(f.options.rate)] +
         (f.options.geometry == Geometry::Axisymmetric ? "Revolved" : "");
}

/// For INSTANTIATE_TEST_SUITE_P.
inline const auto nameOfParam = [](const auto& info) { return nameOf(info.param); };

constexpr ElementType allTypes[] = {ElementType::Tri3, ElementType::Quad4, ElementType::Tet4,
                                    ElementType::Hex8};

inline NodeVectors field(const ConstNodeVectors& x, const std::function<Vec3(const Vec3&)>& f)
{
  NodeVectors result("field", x.extent(0));
  for (int node = 0; node < int(x.extent(0)); ++node)
    set(result, node, f(at(x, node)));
  return result;
}

inline NodeVectors plus(const ConstNodeVectors& x, Real factor, const ConstNodeVectors& v)
{
  NodeVectors result("sum", x.extent(0));
  for (int node = 0; node < int(x.extent(0)); ++node)
    set(result, node, at(x, node) + factor * at(v, node));
  return result;
}

/// Sum of corner forces per node [N].
inline NodeVectors nodalForces(const ElementBlock& block, int nodes)
{
  NodeVectors f("f", nodes);
  const auto corner = block.cornerForce();
  for (int e = 0; e < block.count(); ++e)
    for (int c = 0; c < int(block.connectivity().extent(1)); ++c)
      for (int i = 0; i < 3; ++i)
        f(block.connectivity()(e, c), i) += corner(e, c, i);
  return f;
}

inline Real largest(const ConstNodeVectors& v)
{
  Real value = 0;
  for (int node = 0; node < int(v.extent(0)); ++node)
    value = std::max(value, norm(at(v, node)));
  return value;
}

inline const BulkViscosity noViscosity{0, 0};
} // namespace coplane::testMeshes
