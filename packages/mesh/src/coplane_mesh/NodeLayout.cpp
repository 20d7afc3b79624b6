#include <coplane_mesh/NodeLayout.hpp>

#include <algorithm>

namespace coplane
{
NodeLayout::NodeLayout(const Comm& comm, const RankMesh& mesh)
    : comm_(&comm), owned_(mesh.ownedNodes), ofElements_(mesh.nodes()), ids_(mesh.nodeIds)
{
  for (int i = 0; i < size(); ++i)
    localNodes_.emplace(ids_[i], i);
  rebuild();
}

int NodeLayout::localNode(GlobalId id) const
{
  const auto found = localNodes_.find(id);
  return found == localNodes_.end() ? -1 : found->second;
}

bool NodeLayout::setGhostNodes(const std::vector<GlobalId>& ids)
{
  std::vector<GlobalId> wanted;
  for (const GlobalId id : ids)
  {
    const int node = localNode(id);
    if (node < 0 || node >= ofElements_)
      wanted.push_back(id);
  }
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  const bool same = int(wanted.size()) == size() - ofElements_ &&
                    std::equal(wanted.begin(), wanted.end(), ids_.begin() + ofElements_);
  if (comm_->max(std::int64_t(!same)) == 0)
    return false;
  for (int i = ofElements_; i < size(); ++i)
    localNodes_.erase(ids_[i]);
  ids_.resize(ofElements_);
  for (const GlobalId id : wanted)
  {
    localNodes_.emplace(id, size());
    ids_.push_back(id);
  }
  rebuild();
  return true;
}

void NodeLayout::rebuild()
{
  const int copies = size() - owned_;
  from_ = Table<Real>("coplane::mesh::ownedRows", owned_, 6);
  to_ = Table<Real>("coplane::mesh::copiedRows", copies, 6);
  import_.reset();
  if (comm_->size() > 1)
    import_.emplace(*comm_, std::vector<GlobalId>(ids_.begin(), ids_.begin() + owned_),
                    std::vector<GlobalId>(ids_.begin() + owned_, ids_.end()));
}

void NodeLayout::refresh(const NodeVectors& x, const NodeVectors& v) const
{
  if (!import_)
    return;
  const auto from = from_;
  const auto to = to_;
  const int owned = owned_;
  parallelFor(
      "coplane::mesh::packNodes", owned_, KOKKOS_LAMBDA(const int i) {
        for (int c = 0; c < 3; ++c)
        {
          from(i, c) = x(i, c);
          from(i, 3 + c) = v(i, c);
        }
      });
  import_->move(from_, to_);
  parallelFor(
      "coplane::mesh::unpackNodes", int(to_.extent(0)), KOKKOS_LAMBDA(const int i) {
        for (int c = 0; c < 3; ++c)
        {
          x(owned + i, c) = to(i, c);
          v(owned + i, c) = to(i, 3 + c);
        }
      });
}

void NodeLayout::refresh(const Array<Real>& values) const
{
  if (!import_)
    return;
  Table<Real> from("coplane::mesh::ownedValues", owned_, 1);
  Table<Real> to("coplane::mesh::copiedValues", size() - owned_, 1);
  for (int i = 0; i < owned_; ++i)
    from(i, 0) = values(i);
  import_->move(from, to);
  for (int i = owned_; i < size(); ++i)
    values(i) = to(i - owned_, 0);
}
} // namespace coplane
