#include <coplane_contact/FaceTable.hpp>

#include <algorithm>

namespace coplane
{
int FaceTable::place(GlobalId id) const
{
  const auto ghosts = all_.begin() + std::ptrdiff_t(local_.size());
  auto found = findFace(all_.begin(), ghosts, id);
  if (found == ghosts)
    found = findFace(ghosts, all_.end(), id);
  return found != all_.end() ? int(found - all_.begin()) : -1;
}

void FaceTable::list(const std::vector<GhostFace>& ghosts, const NodeLayout& layout)
{
  all_ = local_;
  const auto localNode = [&](GlobalId id) { return layout.localNode(id); };
  for (const GhostFace& ghost : ghosts)
    all_.push_back(toFace(ghost, localNode));
  table_ =
      Array<Face>(Kokkos::ViewAllocateWithoutInitializing("coplane::contact::faces"), all_.size());
  std::copy(all_.begin(), all_.end(), table_.data());
}
} // namespace coplane
