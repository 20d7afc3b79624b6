#pragma once

#include <coplane_element/ElementBlock.hpp>

#include <functional>
#include <random>
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

/// Unit square or cube of n elements along each edge, all nodes moved by up to `distortion` element
/// sizes.
inline TestMesh distorted(ElementType type, int n, Real distortion, unsigned seed = 7)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<Real> push(-distortion / n, distortion / n);
  const bool flat = type == ElementType::Quad4;
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
        const int o = (k * m + j) * m + i;
        for (const int c : {o, o + 1, o + m + 1, o + m})
          mesh.connectivity.push_back(c);
        if (!flat)
          for (const int c : {o, o + 1, o + m + 1, o + m})
            mesh.connectivity.push_back(c + m * m);
      }
  return mesh;
}

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
