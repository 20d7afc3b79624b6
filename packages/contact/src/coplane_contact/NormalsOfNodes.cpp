#include <coplane_contact/detail/NormalsOfNodes.hpp>

#include <algorithm>

namespace coplane
{
namespace
{
bool same(const Vec3& a, const Vec3& b)
{
  return a.x == b.x && a.y == b.y && a.z == b.z;
}
} // namespace

void NormalsOfNodes::add(int node, const Vec3& normal)
{
  int i = 0;
  for (; i < most() && !same(this->normal(node, i), {}); ++i)
    if (same(this->normal(node, i), normal))
      return;
  if (i == most())
    grow();
  set(normals_[i], node, normal);
}

bool NormalsOfNodes::has(int node, const Vec3& normal) const
{
  return std::any_of(normals_.begin(), normals_.end(),
                     [&](const NodeVectors& of) { return same(at(of, node), normal); });
}

void NormalsOfNodes::refresh(const NodeLayout& layout)
{
  for (const int wanted = int(layout.comm().max(std::int64_t(most()))); most() < wanted;)
    grow();
  for (int i = 0; i < most(); i += 2)
    layout.refresh(normals_[i], normals_[std::min(i + 1, most() - 1)]);
}

void NormalsOfNodes::grow()
{
  normals_.emplace_back("coplane::contact::normalsOfNodes", nodes_);
}
} // namespace coplane
